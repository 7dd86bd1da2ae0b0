#include "prompt_window.h"

#include "vtkCommand.h"
#include "vtkObjectFactory.h"
#include "vtkXOpenGLRenderWindow.h"

namespace brume::app
{

namespace
{

class PromptWindow : public vtkXOpenGLRenderWindow
{
public:
  static PromptWindow* New();
  vtkTypeMacro(PromptWindow, vtkXOpenGLRenderWindow);

  int CheckAbortStatus() override
  {
    if (!this->InAbortCheck)
    {
      this->InAbortCheck = 1;
      this->InvokeEvent(vtkCommand::AbortCheckEvent);
      this->InAbortCheck = 0;
    }
    return this->AbortRender;
  }
};
vtkStandardNewMacro(PromptWindow);

}

vtkSmartPointer<vtkRenderWindow> make_prompt_window()
{
  return vtkSmartPointer<PromptWindow>::New();
}

}
