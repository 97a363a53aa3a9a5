#include "lacon/structures/seal.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <map>
#include <span>
#include <string_view>
#include <tuple>
#include <vector>

#include "lacon/catalog/messages.hpp"

namespace lacon {
namespace {

/// What stands behind the content: little-endian, as is all of HDF5's on the machines that this runs on.
struct Trailer {
  std::array<char, 8> mark = {'L', 'A', 'C', 'O', 'N', 'S', 'U', 'M'};
  std::uint64_t length = 0;  ///< of the content in bytes
  /// Fletcher's sums of its words of 8 bytes, the last one filled up with zeros, modulo 2^64: that of the words, and that of
  /// the first sum after each word, which sees their order.
  std::uint64_t sum = 0, sum_of_sums = 0;
};
static_assert(sizeof(Trailer) == 32);

void add(Trailer& sums, std::span<const std::uint64_t> words) {
  for (const std::uint64_t word : words) sums.sum_of_sums += sums.sum += word;
}

class OpenFile {
 public:
  OpenFile(const std::filesystem::path& path, int flags) : id_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {}
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  ~OpenFile() {
    if (id_ >= 0) ::close(id_);
  }
  explicit operator bool() const { return id_ >= 0; }

  /// Read `size` bytes at a place. @return whether they were there
  bool read(void* to, std::size_t size, std::uint64_t at) const {
    for (std::size_t done = 0; done < size;) {
      const ssize_t n = ::pread(id_, static_cast<char*>(to) + done, size - done, static_cast<off_t>(at + done));
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) return false;
      done += static_cast<std::size_t>(n);
    }
    return true;
  }
  bool write(const void* from, std::size_t size, std::uint64_t at) const {
    for (std::size_t done = 0; done < size;) {
      const ssize_t n = ::pwrite(id_, static_cast<const char*>(from) + done, size - done, static_cast<off_t>(at + done));
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) return false;
      done += static_cast<std::size_t>(n);
    }
    return true;
  }
  struct stat state() const {
    struct stat about = {};
    ::fstat(id_, &about);
    return about;
  }

 private:
  int id_;
};

/// Whether a file is longer than HDF5 says that it is: so it had a seal, whatever is there now. HDF5 cuts off what it does not
/// know where it changes a file; a disk that loses power may leave zeros.
bool is_longer_than_its_content(const OpenFile& file, std::uint64_t size) {
  constexpr std::string_view signature("\x89HDF\r\n\x1a\n\0", 9);  // with the version 0 of the superblock, which Lacon writes
  std::array<char, 48> head = {};
  if (size < head.size() || !file.read(head.data(), head.size(), 0) ||
      !std::string_view(head.data(), head.size()).starts_with(signature))
    return false;
  std::uint64_t end = 0;
  std::memcpy(&end, head.data() + 40, sizeof end);
  return size > end;
}

/// The trailer that belongs to the first `length` bytes. @return whether they could be read
bool sum_up(const OpenFile& file, std::uint64_t length, Trailer& made) {
  std::vector<std::uint64_t> words(1 << 15);  // stays in the cache
  const std::size_t most = words.size() * sizeof(words[0]);
  made = {};
  made.length = length;
  for (std::uint64_t at = 0; at < length; at += most) {
    const auto size = static_cast<std::size_t>(std::min<std::uint64_t>(most, length - at));
    const std::size_t n = (size + 7) / 8;
    words[n - 1] = 0;
    if (!file.read(words.data(), size, at)) return false;
    add(made, {words.data(), n});
  }
  return true;
}

}  // namespace

void seal(const std::filesystem::path& path) {
  const OpenFile file(path, O_RDWR);
  const auto length = static_cast<std::uint64_t>(file ? file.state().st_size : 0);
  Trailer trailer;
  if (!file || !sum_up(file, length, trailer) || !file.write(&trailer, sizeof trailer, length))
    fail("BASE_3", {{"file", path.string()}, {"reason", std::strerror(errno)}});
}

void write_with_seal(const std::filesystem::path& path, std::span<const char> content) {
  std::vector<std::uint64_t> words((content.size() + 7) / 8);
  std::memcpy(words.data(), content.data(), content.size());
  Trailer trailer;
  trailer.length = content.size();
  add(trailer, words);
  const OpenFile file(path, O_WRONLY | O_CREAT | O_TRUNC);
  if (!file || !file.write(content.data(), content.size(), 0) || !file.write(&trailer, sizeof trailer, trailer.length))
    fail("BASE_3", {{"file", path.string()}, {"reason", std::strerror(errno)}});
}

void check_seal(const std::filesystem::path& path) {
  const OpenFile file(path, O_RDONLY);
  if (!file) return;  // HDF5 says why
  const struct stat about = file.state();
  const auto size = static_cast<std::uint64_t>(about.st_size);
  Trailer found, own;
  const bool marked = size >= sizeof found && file.read(&found, sizeof found, size - sizeof found) && found.mark == own.mark;
  if (!marked && is_longer_than_its_content(file, size)) fail("BASE_5", {{"file", path.string()}});
  if (!marked) return;
  static std::map<std::filesystem::path, std::tuple<ino_t, off_t, time_t, long>> known;
  const std::tuple state(about.st_ino, about.st_size, about.st_mtim.tv_sec, about.st_mtim.tv_nsec);
  if (const auto seen = known.find(path); seen != known.end() && seen->second == state) return;
  const bool whole = sum_up(file, size - sizeof found, own);
  if (!whole || std::memcmp(&found, &own, sizeof own) != 0) fail("BASE_5", {{"file", path.string()}});
  known[path] = state;
}

}  // namespace lacon
