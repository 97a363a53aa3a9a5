// Loaded first (LD_PRELOAD): a disk that is full after so many bytes, that fails one of the writes, or that takes half of what
// it is given, whoever of a study's processes writes. LACON_TEST_DISK names a file that holds a Disk.
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>

namespace {

struct Disk {
  std::atomic<int64_t> bytes_left;
  std::atomic<int64_t> writes;  ///< so far
  int64_t fails;                ///< this one of them, from 1; 0: none
  int64_t halves;               ///< whether a write takes half of its bytes
};

Disk* disk() {
  static Disk* const found = [] {
    const char* name = getenv("LACON_TEST_DISK");
    const int file = name ? open(name, O_RDWR | O_CLOEXEC) : -1;
    void* page = file < 0 ? MAP_FAILED : mmap(nullptr, sizeof(Disk), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    if (file >= 0) close(file);
    return page == MAP_FAILED ? nullptr : static_cast<Disk*>(page);
  }();
  return found;
}

/// How many of `size` bytes the disk still takes; all, if this is no file.
ssize_t taken(int file, size_t size) {
  struct stat about;
  if (size == 0 || !disk() || fstat(file, &about) != 0 || !S_ISREG(about.st_mode)) return static_cast<ssize_t>(size);
  if (++disk()->writes == disk()->fails) {
    errno = EIO;
    return -1;
  }
  if (disk()->halves) size = (size + 1) / 2;
  int64_t left = disk()->bytes_left, some;
  do some = std::min<int64_t>(left, static_cast<int64_t>(size));
  while (!disk()->bytes_left.compare_exchange_weak(left, left - some));
  if (some > 0) return some;
  errno = ENOSPC;
  return -1;
}

template <class Function>
Function real(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" {
ssize_t write(int file, const void* bytes, size_t size) {
  const ssize_t some = taken(file, size);
  return some < 0 ? -1 : real<decltype(&write)>("write")(file, bytes, static_cast<size_t>(some));
}
ssize_t pwrite(int file, const void* bytes, size_t size, off_t at) {
  const ssize_t some = taken(file, size);
  return some < 0 ? -1 : real<decltype(&pwrite)>("pwrite")(file, bytes, static_cast<size_t>(some), at);
}
ssize_t pwrite64(int file, const void* bytes, size_t size, off64_t at) {
  const ssize_t some = taken(file, size);
  return some < 0 ? -1 : real<decltype(&pwrite64)>("pwrite64")(file, bytes, static_cast<size_t>(some), at);
}
ssize_t writev(int file, const iovec* parts, int n) {
  ssize_t sum = 0;
  for (int i = 0; i < n; ++i) {
    const ssize_t some = write(file, parts[i].iov_base, parts[i].iov_len);
    if (some < 0) return sum > 0 ? sum : -1;
    sum += some;
    if (static_cast<size_t>(some) < parts[i].iov_len) break;
  }
  return sum;
}
}
