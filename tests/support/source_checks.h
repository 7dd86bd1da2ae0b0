// What every source of volumes must do: pieces that equal the whole, and an end when it is told so.
#pragma once

#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkExecutive.h"
#include "vtkImageAlgorithm.h"
#include "vtkImageData.h"
#include "vtkNew.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace brume_tests
{

inline void count_progress(vtkObject*, unsigned long, void* counter, void*)
{
  ++*static_cast<int*>(counter);
}

inline void abort_at_once(vtkObject* caller, unsigned long, void*, void*)
{
  static_cast<vtkAlgorithm*>(caller)->SetAbortExecute(1);
}

/// Every voxel of pieces of odd sizes equals that voxel of the whole.
inline void expect_pieces_equal_the_whole(vtkImageAlgorithm* whole, vtkImageAlgorithm* parts)
{
  whole->Update();
  vtkImageData* all = whole->GetOutput();
  int extent[6];
  all->GetExtent(extent);
  std::vector<int> cuts[3];
  for (int a = 0; a < 3; ++a)
  {
    const int end = extent[2 * a + 1] + 1;
    cuts[a] = { 0, end / 3 + 1, end - 2, end };
  }
  vtkIdType compared = 0;
  for (int c = 0; c < 27; ++c)
  {
    const int i[3] = { c % 3, c / 3 % 3, c / 9 };
    int piece[6];
    for (int a = 0; a < 3; ++a)
    {
      piece[2 * a] = cuts[a][i[a]];
      piece[2 * a + 1] = cuts[a][i[a] + 1] - 1;
    }
    parts->UpdateExtent(piece);
    vtkImageData* part = parts->GetOutput();
    ASSERT_LE(part->GetNumberOfPoints(), all->GetNumberOfPoints() / 3) << "only the piece was made";
    for (int z = piece[4]; z <= piece[5]; ++z)
      for (int y = piece[2]; y <= piece[3]; ++y)
        for (int x = piece[0]; x <= piece[1]; ++x)
        {
          ASSERT_EQ(part->GetScalarComponentAsDouble(x, y, z, 0),
            all->GetScalarComponentAsDouble(x, y, z, 0))
            << x << ' ' << y << ' ' << z;
          ++compared;
        }
  }
  EXPECT_EQ(compared, all->GetNumberOfPoints());
}

inline void expect_abort_and_recovery(vtkImageAlgorithm* source)
{
  vtkNew<vtkCallbackCommand> abort;
  abort->SetCallback(abort_at_once);
  const unsigned long tag = source->AddObserver(vtkCommand::ProgressEvent, abort);
  source->Update();
  EXPECT_EQ(source->GetOutput()->GetNumberOfPoints(), 0);
  source->RemoveObserver(tag);
  source->Update();
  EXPECT_GT(source->GetOutput()->GetNumberOfPoints(), 0);
}

/// What a source says is wrong with it when it is updated; empty if nothing is.
inline std::string error_of(vtkAlgorithm* source)
{
  std::string text;
  vtkNew<vtkCallbackCommand> listen;
  listen->SetClientData(&text);
  listen->SetCallback([](vtkObject*, unsigned long, void* data, void* message)
    { *static_cast<std::string*>(data) += static_cast<const char*>(message); });
  const unsigned long tag = source->AddObserver(vtkCommand::ErrorEvent, listen);
  const unsigned long also = source->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, listen);
  source->Update();
  source->RemoveObserver(tag);
  source->GetExecutive()->RemoveObserver(also);
  return text;
}

}
