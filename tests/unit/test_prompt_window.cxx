// That a render which VTK's CPU mapper divides among threads looks whether to go on until all are through.
#include "prompt_window.h"

#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkNew.h"
#include "vtkRenderWindow.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

using namespace brume::app;

namespace
{

/// A window that is never shown, and how often it looked.
struct Watched
{
  Watched()
  {
    vtkNew<vtkCallbackCommand> observer;
    observer->SetClientData(this);
    observer->SetCallback(
      [](vtkObject*, unsigned long, void* data, void*)
      {
        auto* self = static_cast<Watched*>(data);
        if (++self->looks == self->last)
        {
          self->window->SetAbortRender(1);
        }
      });
    this->window->AddObserver(vtkCommand::AbortCheckEvent, observer);
  }

  vtkSmartPointer<vtkRenderWindow> window = make_prompt_window();
  std::atomic<int> looks{ 0 };
  int last = -1; ///< the look that ends the render
};

}

TEST(PromptWindow, LooksWhileOthersWork)
{
  Watched watched;
  constexpr int rows = 3;
  constexpr int looks_a_row = 5;
  share_rows(watched.window, 2, rows);
  EXPECT_EQ(watched.window->CheckAbortStatus(), 0);
  EXPECT_EQ(watched.looks, 1) << "only the last row waits";
  std::atomic<bool> over{ false };
  std::atomic<int> begun{ 0 };
  std::thread other(
    [&]
    {
      // Each row takes as long as so many looks.
      for (int row = 0; row < rows && !over; ++row)
      {
        while (watched.looks < looks_a_row * (row + 1) && !over)
        {
          std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        ++begun;
        EXPECT_EQ(watched.window->GetAbortRender(), 0);
      }
    });
  EXPECT_EQ(watched.window->CheckAbortStatus(), 0);
  EXPECT_EQ(begun, rows);
  EXPECT_GE(watched.looks, rows * looks_a_row);
  over = true;
  other.join();
  const int looks = watched.looks;
  share_rows(watched.window, 0, 0);
  EXPECT_EQ(watched.window->CheckAbortStatus(), 0);
  EXPECT_EQ(watched.looks, looks + 1);
}

TEST(PromptWindow, EndsWhileItWaits)
{
  Watched watched;
  watched.last = 6;
  share_rows(watched.window, 1, 1000000);
  EXPECT_EQ(watched.window->CheckAbortStatus(), 1);
  EXPECT_EQ(watched.looks, 6);
  EXPECT_EQ(watched.window->GetAbortRender(), 1) << "the others go on";
}

TEST(PromptWindow, DoesNotWaitForWhoTellsNothing)
{
  Watched watched;
  share_rows(watched.window, 1, 1000000);
  EXPECT_EQ(watched.window->CheckAbortStatus(), 0);
  EXPECT_GT(watched.looks, 2);
}
