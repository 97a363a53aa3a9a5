#include "lacon/assembly/processes/shared_memory.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <new>
#include <system_error>
#include <utility>

#include "lacon/assembly/processes/open_files.hpp"

namespace lacon {
namespace {

int checked(int status, const char* what) {
  if (status < 0) refuse_too_few_files(errno);
  if (status < 0) throw std::system_error(errno, std::generic_category(), what);
  return status;
}

}  // namespace

SharedMemory::SharedMemory(std::size_t bytes) : SharedMemory() {  // from here on the destructor closes what there is
  size_ = bytes;
  file_ = checked(memfd_create("lacon", MFD_CLOEXEC), "memfd_create");
  checked(ftruncate(file_, static_cast<off_t>(bytes)), "ftruncate");
  map();
}

SharedMemory SharedMemory::open(const std::string& path) {
  SharedMemory memory;
  memory.file_ = checked(::open(path.c_str(), O_RDWR | O_CLOEXEC), path.c_str());
  struct stat about = {};
  checked(fstat(memory.file_, &about), path.c_str());
  memory.size_ = static_cast<std::size_t>(about.st_size);
  memory.map();
  return memory;
}

void SharedMemory::map() {
  if (size_ == 0) return;
  void* const at = mmap(nullptr, size_, PROT_READ | PROT_WRITE, MAP_SHARED, file_, 0);
  if (at == MAP_FAILED && errno == ENOMEM) throw std::bad_alloc();
  if (at == MAP_FAILED) throw std::system_error(errno, std::generic_category(), "mmap");
  data_ = static_cast<std::byte*>(at);
}

SharedMemory::SharedMemory(SharedMemory&& other) noexcept
    : file_(std::exchange(other.file_, -1)), size_(std::exchange(other.size_, 0)), data_(std::exchange(other.data_, nullptr)) {}

SharedMemory::~SharedMemory() {
  if (data_) munmap(data_, size_);
  if (file_ >= 0) close(file_);
}

std::string SharedMemory::path() const { return "/proc/" + std::to_string(getpid()) + "/fd/" + std::to_string(file_); }

}  // namespace lacon
