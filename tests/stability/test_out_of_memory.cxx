// Memory that runs out at any allocation: nothing is half made, and the next picture is the right
// one.
#include "artists.h"
#include "hard_case.h"

#include "../support/vtk_scenes.h"

#include "vtkBrumePathTraceMapper.h"
#include "vtkBrumeRayMarchMapper.h"

#include "vtkTestErrorObserver.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

using namespace stability;
using brume_tests::HardCase;

namespace
{

std::atomic<long> left_to_fail{ -1 };         ///< allocations until one fails; below 0: none does
std::atomic<std::size_t> largest{ SIZE_MAX }; ///< what is larger fails
std::atomic<long> counted{ 0 };

void* allocate(std::size_t bytes, std::size_t alignment)
{
  ++counted;
  const bool fails =
    bytes > largest || (left_to_fail.load() >= 0 && left_to_fail.fetch_sub(1) == 0);
  void* memory = fails ? nullptr
                 : alignment > alignof(std::max_align_t)
                   ? std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment)
                   : std::malloc(bytes ? bytes : 1);
  if (!memory)
  {
    throw std::bad_alloc();
  }
  return memory;
}

}

void* operator new(std::size_t bytes)
{
  return allocate(bytes, 0);
}
void* operator new[](std::size_t bytes)
{
  return allocate(bytes, 0);
}
void* operator new(std::size_t bytes, std::align_val_t alignment)
{
  return allocate(bytes, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t bytes, std::align_val_t alignment)
{
  return allocate(bytes, static_cast<std::size_t>(alignment));
}
// Of all forms, or a sanitizer's own would meet free().
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept
try
{
  return allocate(bytes, 0);
}
catch (const std::bad_alloc&)
{
  return nullptr;
}
void* operator new[](std::size_t bytes, const std::nothrow_t&) noexcept
{
  return operator new(bytes, std::nothrow);
}
void operator delete(void* memory, const std::nothrow_t&) noexcept
{
  std::free(memory);
}
void operator delete[](void* memory, const std::nothrow_t&) noexcept
{
  std::free(memory);
}
void operator delete(void* memory) noexcept
{
  std::free(memory);
}
void operator delete[](void* memory) noexcept
{
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept
{
  std::free(memory);
}
void operator delete[](void* memory, std::size_t) noexcept
{
  std::free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept
{
  std::free(memory);
}
void operator delete[](void* memory, std::align_val_t) noexcept
{
  std::free(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept
{
  std::free(memory);
}
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept
{
  std::free(memory);
}

TEST(OutOfMemory, AtAnyAllocation)
{
  HardCase memory("Machines",
    "memory that runs out at the n-th allocation of a picture, n from 1 to the last",
    "what is half made when an exception passes is taken for whole by the next picture",
    "`std::bad_alloc`, and the next picture by the same object is the same bits as a new object's");
  constexpr int width = 12;
  constexpr int height = 9;
  const std::vector<Artist> fresh = artists();
  const std::vector<Artist> kept = artists();
  for (std::size_t i = 0; i < fresh.size(); ++i)
  {
    Film film(width, height);
    counted = 0;
    ASSERT_TRUE(fresh[i].draw(film, 2, {}));
    const long all = counted;
    Film again(width, height);
    for (long n = 0; n <= all; n += 1 + n / 4)
    {
      // As new, and with what it has kept.
      for (const Artist& artist : { artists()[i], kept[i] })
      {
        bool told = false;
        left_to_fail = n;
        try
        {
          artist.draw(again, 2, {});
          told = left_to_fail >= 0; // it never came to n
        }
        catch (const std::bad_alloc&)
        {
          told = true;
        }
        const bool done = left_to_fail.exchange(-1) >= 0;
        memory.holds(told || done, "told", artist.name);
        EXPECT_TRUE(artist.draw(again, 2, {}));
        memory.holds(same_bits(film, again), "the same bits after", artist.name);
      }
    }
  }
}

namespace
{

/// A mapper with all that it needs for a picture.
template <class Mapper>
struct Stage
{
  vtkSmartPointer<vtkImageData> image = vtk_scenes::ball_image(VTK_FLOAT, 40);
  vtkSmartPointer<vtkVolume> volume = vtk_scenes::volume_of();
  vtkNew<Mapper> mapper;
  vtkNew<vtkCamera> camera;
  vtkNew<vtkTest::ErrorObserver> errors;

  Stage()
  {
    mapper->AddObserver(vtkCommand::ErrorEvent, errors);
    mapper->SetInputData(image);
    volume->SetMapper(mapper);
    vtk_scenes::look_at(camera, volume->GetCenter(), 100.0);
    vtkBrumeVolumeMapper::ResetClippingRange(volume, camera);
    if (auto* paths = vtkBrumePathTraceMapper::SafeDownCast(mapper.Get()))
    {
      paths->SetSamplesPerPixel(1);
    }
  }
  bool draw(Film& film) { return mapper->RenderFilm(volume, camera, nullptr, film); }
};

template <class Mapper>
void starve(HardCase& memory, const std::string& name)
{
  Stage<Mapper> fresh;
  Film film(32, 32);
  ASSERT_TRUE(fresh.draw(film));
  int starved = 0;
  Stage<Mapper> kept;
  for (std::size_t most = 1 << 20; most >= 1 << 12; most /= 2)
  {
    Stage<Mapper> one;
    for (Stage<Mapper>* stage : { &one, &kept })
    {
      Film again(32, 32);
      stage->image->Modified();
      largest = most;
      const bool drawn = stage->draw(again);
      largest = SIZE_MAX;
      if (!drawn)
      {
        ++starved;
        memory.refuses(stage->errors->GetErrorMessage(), "out of memory", name);
      }
      stage->errors->Clear();
      EXPECT_TRUE(stage->draw(again)) << stage->errors->GetErrorMessage();
      memory.holds(same_bits(film, again), "the same bits after", name);
    }
  }
  EXPECT_GT(starved, 2);
}

}

TEST(OutOfMemory, Mappers)
{
  HardCase memory("Machines",
    "memory for nothing larger than 1 MB to 4 kB, in a mapper",
    "VTK's pipeline knows no exceptions: one that leaves a mapper ends the program",
    "an error that says so, and the next picture by the same mapper is the same bits as a new "
    "one's");
  starve<vtkBrumeRayMarchMapper>(memory, "vtkBrumeRayMarchMapper");
  starve<vtkBrumePathTraceMapper>(memory, "vtkBrumePathTraceMapper");
}
