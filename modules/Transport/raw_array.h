// Memory for many numbers that are all written before any is read.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>

namespace brume
{

/// As a std::vector of numbers, but what it holds at first is anything at all. Setting the 15 million
/// nodes of a large light volume to 0 takes one thread 40 ms, most of it in pages that are touched
/// first; so the threads that write them do that.
template <class T>
class RawArray
{
public:
  RawArray() = default;
  RawArray(RawArray&& other) noexcept
    : Data(std::move(other.Data))
    , Size(std::exchange(other.Size, 0))
  {
  }
  RawArray& operator=(RawArray&& other) noexcept
  {
    this->Data = std::move(other.Data);
    this->Size = std::exchange(other.Size, 0);
    return *this;
  }

  /// Of this size, with other contents if that is another; the same contents if not.
  void resize(std::size_t size)
  {
    if (size != this->Size)
    {
      this->Data.reset(size > 0 ? new T[size] : nullptr);
      this->Size = size;
    }
  }
  std::size_t size() const { return this->Size; }
  T* data() { return this->Data.get(); }
  const T* data() const { return this->Data.get(); }

private:
  std::unique_ptr<T[]> Data;
  std::size_t Size = 0;
};

}
