// Mappers in several threads, and mappers that are cancelled.
#include "hard_case.h"

#include "../support/transport_scenes.h"
#include "../support/vtk_scenes.h"

#include "vtkBrumePathTraceMapper.h"
#include "vtkBrumeRayMarchMapper.h"

#include "vtkCallbackCommand.h"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

using brume::Film;
using brume_tests::HardCase;
using transport_scenes::same_bits;

namespace
{

template <class Mapper>
struct Stage
{
  vtkSmartPointer<vtkVolume> volume;
  vtkNew<Mapper> mapper;
  vtkNew<vtkCamera> camera;

  Stage(int type, double opacity)
    : volume(vtk_scenes::volume_of(opacity))
  {
    mapper->SetInputData(vtk_scenes::ball_image(type, 24));
    volume->SetMapper(mapper);
    vtk_scenes::look_at(camera, volume->GetCenter(), 80.0);
    vtkBrumeVolumeMapper::ResetClippingRange(volume, camera);
  }
  void take_few_paths()
  {
    if (auto* paths = vtkBrumePathTraceMapper::SafeDownCast(mapper.Get()))
    {
      paths->SetSamplesPerPixel(4);
    }
  }
  bool draw(Film& film) { return mapper->RenderFilm(volume, camera, nullptr, film); }
};

}

TEST(Mappers, AtOnce)
{
  HardCase at_once("Machines",
    "two mappers that draw two scenes in two threads, march and paths",
    "VTK's own objects are not for two threads; anything static in a mapper would be written by "
    "both",
    "the same bits as alone");
  for (int turn = 0; turn < 3; ++turn)
  {
    Stage<vtkBrumeRayMarchMapper> march(VTK_FLOAT, 0.5);
    Stage<vtkBrumePathTraceMapper> paths(VTK_UNSIGNED_SHORT, 0.3);
    Stage<vtkBrumeRayMarchMapper> march_alone(VTK_FLOAT, 0.5);
    Stage<vtkBrumePathTraceMapper> paths_alone(VTK_UNSIGNED_SHORT, 0.3);
    paths.take_few_paths();
    paths_alone.take_few_paths();
    Film a(48, 48), b(48, 48), c(48, 48), d(48, 48);
    ASSERT_TRUE(march_alone.draw(a));
    ASSERT_TRUE(paths_alone.draw(b));
    std::thread one([&] { march.draw(c); });
    std::thread two([&] { paths.draw(d); });
    one.join();
    two.join();
    at_once.holds(same_bits(a, c), "the same bits", "vtkBrumeRayMarchMapper");
    at_once.holds(same_bits(b, d), "the same bits", "vtkBrumePathTraceMapper");
  }
}

namespace
{

template <class Mapper>
void cancel(HardCase& cancelled, const std::string& name)
{
  Stage<Mapper> fresh(VTK_SHORT, 0.5);
  Stage<Mapper> kept(VTK_SHORT, 0.5);
  fresh.take_few_paths();
  kept.take_few_paths();
  Film film(40, 40);
  ASSERT_TRUE(fresh.draw(film));
  struct Count
  {
    int calls = 0;
    int moment = 1;
  } count;
  vtkNew<vtkCallbackCommand> stop;
  stop->SetClientData(&count);
  stop->SetCallback(
    [](vtkObject* caller, unsigned long, void* data, void*)
    {
      auto* now = static_cast<Count*>(data);
      if (++now->calls >= now->moment)
      {
        Mapper::SafeDownCast(caller)->AbortExecuteOn();
      }
    });
  int times = 0;
  for (; count.moment < 64; count.moment += 1 + count.moment / 2)
  {
    Film again(40, 40);
    count.calls = 0;
    const unsigned long tag = kept.mapper->AddObserver(vtkCommand::ProgressEvent, stop);
    const bool completed = kept.draw(again);
    kept.mapper->RemoveObserver(tag);
    times += !completed;
    ASSERT_TRUE(kept.draw(again));
    cancelled.holds(same_bits(film, again), "the same bits after", name);
  }
  EXPECT_GT(times, 0) << name;
}

}

TEST(Mappers, Cancelled)
{
  HardCase cancelled("Machines",
    "a mapper that is cancelled from its progress event",
    "the user turns the view while it draws: what it keeps between pictures must not be half of "
    "one",
    "the next picture is the same bits as a new mapper's");
  cancel<vtkBrumeRayMarchMapper>(cancelled, "vtkBrumeRayMarchMapper");
  cancel<vtkBrumePathTraceMapper>(cancelled, "vtkBrumePathTraceMapper");
}
