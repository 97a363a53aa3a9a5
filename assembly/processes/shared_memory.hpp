#pragma once
// Memory that two processes see: one makes it, the other opens it by its path. It has no name that could be left behind.
#include <cstddef>
#include <span>
#include <string>

namespace lacon {

class SharedMemory {
 public:
  /// Zeros. Throws std::bad_alloc and std::system_error, also from open().
  explicit SharedMemory(std::size_t bytes);
  /// That of another process of the same machine, to be written as well.
  static SharedMemory open(const std::string& path);
  ~SharedMemory();
  SharedMemory(SharedMemory&& other) noexcept;
  SharedMemory& operator=(SharedMemory&&) = delete;
  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;

  std::byte* data() const { return data_; }
  std::size_t size() const { return size_; }
  std::span<double> numbers() const { return {reinterpret_cast<double*>(data_), size_ / sizeof(double)}; }
  /// For another process, as long as this one keeps the memory.
  std::string path() const;

 private:
  SharedMemory() = default;
  void map();

  int file_ = -1;
  std::size_t size_ = 0;
  std::byte* data_ = nullptr;
};

}  // namespace lacon
