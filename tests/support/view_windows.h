// A window of `brume view` under test: events by VTK's interactor, what it shows, what VTK
// complains of.
#pragma once

#include "view/view_window.h"
#include "view/viewer.h"

#include "vtkObjectFactory.h"
#include "vtkOutputWindow.h"
#include "vtkRenderWindow.h"
#include "vtkRenderWindowInteractor.h"
#include "vtkSmartPointer.h"
#include "vtkStringArray.h"
#include "vtkUnsignedCharArray.h"

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <malloc.h>
#include <mutex>
#include <string>
#include <vector>

namespace view_windows
{

using nlohmann::ordered_json;

/// What an environment variable says, or else this.
inline double number_of(const char* variable, double otherwise)
{
  const char* text = std::getenv(variable);
  return text ? std::atof(text) : otherwise;
}

/// VTK's errors and warnings while one of these lives, but for a mapper's word that it ignores a
/// setting of the scene, which is for the user. One at a time.
class Complaints
{
public:
  Complaints()
    : Former(vtkOutputWindow::GetInstance())
    , Kept(vtkSmartPointer<Keeper>::New())
  {
    vtkOutputWindow::SetInstance(this->Kept);
  }
  ~Complaints() { vtkOutputWindow::SetInstance(this->Former); }
  Complaints(const Complaints&) = delete;
  Complaints& operator=(const Complaints&) = delete;

  /// All so far; empty where there were none.
  std::string text() const
  {
    const std::lock_guard<std::mutex> lock(this->Kept->Lock);
    return this->Kept->Text;
  }

private:
  struct Keeper : vtkOutputWindow
  {
    static Keeper* New()
    {
      auto* keeper = new Keeper;
      keeper->InitializeObjectBase();
      return keeper;
    }
    void DisplayText(const char* text) override
    {
      const std::lock_guard<std::mutex> lock(this->Lock);
      if (!std::strstr(text, "is not supported and is ignored"))
      {
        this->Text += text;
      }
    }
    mutable std::mutex Lock;
    std::string Text;
  };
  vtkSmartPointer<vtkOutputWindow> Former;
  vtkSmartPointer<Keeper> Kept;
};

/// A ball of 24³ floats in a file, brighter toward +x, with a notch so that no turn of it looks the
/// same.
inline std::string ball_file(const std::string& path)
{
  std::ofstream file(path, std::ios::binary);
  file << "NRRD0004\ntype: float\ndimension: 3\nsizes: 24 24 24\nspacings: 1 1 1\n"
          "endian: little\nencoding: raw\n\n";
  for (int k = 0; k < 24; ++k)
  {
    for (int j = 0; j < 24; ++j)
    {
      for (int i = 0; i < 24; ++i)
      {
        const double r = std::hypot(i - 11.5, j - 11.5, k - 11.5);
        const bool notch = i > 13 && j > 13 && k > 9;
        const float v = r < 10.0 && !notch ? 100.0f + 5.0f * static_cast<float>(i) : 0.0f;
        file.write(reinterpret_cast<const char*>(&v), sizeof v);
      }
    }
  }
  return path;
}

/// What the heap holds, in megabytes, with what is mapped.
inline double heap_megabytes()
{
  malloc_trim(0);
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd) / 1e6;
}

/// Events as the interactor has them from its window. Places are pixels from the upper left corner.
class Hand
{
public:
  explicit Hand(vtkRenderWindowInteractor* interactor)
    : Interactor(interactor)
  {
  }
  void mouse(unsigned long event, int x, int y, bool shift = false, bool twice = false)
  {
    this->X = x;
    this->Y = y;
    this->set(false, shift, twice, nullptr);
    this->Interactor->InvokeEvent(event, nullptr);
  }
  void key(const std::string& symbol, bool control = false)
  {
    this->set(control, false, false, symbol.c_str());
    this->Interactor->InvokeEvent(vtkCommand::KeyPressEvent, nullptr);
    this->Interactor->InvokeEvent(vtkCommand::CharEvent, nullptr);
    this->Interactor->InvokeEvent(vtkCommand::KeyReleaseEvent, nullptr);
  }
  void drop(const std::string& path)
  {
    vtkNew<vtkStringArray> names;
    names->InsertNextValue(path);
    this->Interactor->InvokeEvent(vtkCommand::DropFilesEvent, names);
  }
  void tick() { this->Interactor->InvokeEvent(vtkCommand::TimerEvent, nullptr); }
  void resize(int width, int height)
  {
    this->Interactor->GetRenderWindow()->SetSize(width, height);
    this->Interactor->UpdateSize(width, height);
    this->Interactor->InvokeEvent(vtkCommand::ConfigureEvent, nullptr);
  }

private:
  void set(bool control, bool shift, bool twice, const char* symbol)
  {
    this->Interactor->SetEventInformationFlipY(
      this->X, this->Y, control, shift, symbol && !symbol[1] ? symbol[0] : 0, twice, symbol);
  }

  vtkRenderWindowInteractor* Interactor;
  int X = 0;
  int Y = 0;
};

/// The window's pixels, as they are: nothing is drawn for it.
inline brume::Bitmap pixels_of(vtkRenderWindow* window)
{
  const int* size = window->GetSize();
  brume::Bitmap bitmap{ size[0], size[1], {} };
  vtkNew<vtkUnsignedCharArray> bytes;
  window->GetPixelData(0, 0, size[0] - 1, size[1] - 1, 0, bytes);
  bitmap.rgb.assign(bytes->GetPointer(0), bytes->GetPointer(0) + bytes->GetNumberOfValues());
  return bitmap;
}

}
