#include "prompt_window.h"

#include "vtkCommand.h"
#include "vtkObjectFactory.h"
#include "vtkXOpenGLRenderWindow.h"

#include <atomic>
#include <chrono>
#include <thread>

namespace brume::app
{

namespace
{

/// Between two looks of a thread that waits for others.
constexpr std::chrono::milliseconds pause(1);
/// Without a row begun: they do not tell what they do, and are not waited for.
constexpr std::chrono::seconds patience(2);

class PromptWindow : public vtkXOpenGLRenderWindow
{
public:
  static PromptWindow* New();
  vtkTypeMacro(PromptWindow, vtkXOpenGLRenderWindow);

  void share_rows(int own, int others);
  int CheckAbortStatus() override;
  int GetAbortRender() override;

private:
  void look();

  int Own = 0;
  int Others = 0;
  int OwnBegun = 0;
  std::atomic<int> OthersBegun{ 0 };
};
vtkStandardNewMacro(PromptWindow);

void PromptWindow::share_rows(int own, int others)
{
  this->Own = own;
  this->Others = others;
  this->OwnBegun = 0;
  this->OthersBegun = 0;
}

void PromptWindow::look()
{
  if (!this->InAbortCheck)
  {
    this->InAbortCheck = 1;
    this->InvokeEvent(vtkCommand::AbortCheckEvent);
    this->InAbortCheck = 0;
  }
}

int PromptWindow::CheckAbortStatus()
{
  this->look();
  if (++this->OwnBegun == this->Own)
  {
    using Clock = std::chrono::steady_clock;
    int begun = this->OthersBegun;
    Clock::time_point since = Clock::now();
    while (!this->AbortRender && begun < this->Others && Clock::now() - since < patience)
    {
      std::this_thread::sleep_for(pause);
      this->look();
      if (this->OthersBegun != begun)
      {
        begun = this->OthersBegun;
        since = Clock::now();
      }
    }
  }
  return this->AbortRender;
}

/// What the other threads ask before each row; this one asks CheckAbortStatus().
int PromptWindow::GetAbortRender()
{
  ++this->OthersBegun;
  return this->AbortRender;
}

}

vtkSmartPointer<vtkRenderWindow> make_prompt_window()
{
  return vtkSmartPointer<PromptWindow>::New();
}

void share_rows(vtkRenderWindow* prompt_window, int own, int others)
{
  if (auto* const window = PromptWindow::SafeDownCast(prompt_window))
  {
    window->share_rows(own, others);
  }
}

}
