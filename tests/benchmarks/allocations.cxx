#include "allocations.h"

#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <new>

namespace
{

std::atomic<std::size_t> live{ 0 };
std::atomic<std::size_t> peak{ 0 };

void* counted(void* memory)
{
  if (!memory)
  {
    throw std::bad_alloc();
  }
  const std::size_t now = live += malloc_usable_size(memory);
  std::size_t before = peak;
  while (before < now && !peak.compare_exchange_weak(before, now))
  {
  }
  return memory;
}

void release(void* memory)
{
  if (memory)
  {
    live -= malloc_usable_size(memory);
    std::free(memory);
  }
}

}

// The forms that the library's others call.
void* operator new(std::size_t size)
{
  return counted(std::malloc(size ? size : 1));
}
void* operator new(std::size_t size, std::align_val_t alignment)
{
  const auto a = static_cast<std::size_t>(alignment);
  return counted(std::aligned_alloc(a, (size + a - 1) / a * a));
}
void operator delete(void* memory) noexcept
{
  release(memory);
}
void operator delete(void* memory, std::size_t) noexcept
{
  release(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept
{
  release(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept
{
  release(memory);
}

namespace benchmarks
{

std::size_t live_bytes()
{
  return live;
}
std::size_t peak_bytes()
{
  return peak;
}
void reset_peak()
{
  peak = live.load();
}

}
