#include "lacon/assembly/mpirun/own_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <string>
#include <system_error>

#include "lacon/assembly/processes/host.hpp"

namespace lacon {
namespace {

constexpr const char* beginning = "lacon_mpi.";
constexpr const char* lock_file = "host";

/// What the file of a lock says: on a disk of several machines, locks may be known to each of them alone.
std::string text_of(int file) {
  char text[256];
  const ssize_t size = pread(file, text, sizeof text, 0);
  return size > 0 ? std::string(text, static_cast<std::size_t>(size)) : std::string();
}

/// Remove a folder of this user and machine that nobody has locked.
void remove_if_left(const std::filesystem::path& folder) {
  struct stat about = {};
  if (lstat(folder.c_str(), &about) != 0 || !S_ISDIR(about.st_mode) || about.st_uid != geteuid()) return;
  const int lock = open((folder / lock_file).c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW);
  if (lock < 0) return;
  std::error_code ignored;
  if (text_of(lock) == own_host() && flock(lock, LOCK_EX | LOCK_NB) == 0) std::filesystem::remove_all(folder, ignored);
  close(lock);
}

}  // namespace

std::filesystem::path folder_of_sessions() {
  for (const char* name : {"TMPDIR", "TEMP", "TMP"})
    if (const char* const folder = std::getenv(name); folder && *folder) return folder;
  return "/tmp";
}

void OwnFolder::remove_left(const std::filesystem::path& above) {
  std::error_code error;
  std::filesystem::directory_iterator entry(above, error);
  for (const std::filesystem::directory_iterator end; !error && entry != end; entry.increment(error))
    if (entry->path().filename().string().starts_with(beginning)) remove_if_left(entry->path());
}

OwnFolder::OwnFolder(const std::filesystem::path& above) {
  remove_left(above);
  std::string made = above / (std::string(beginning) + "XXXXXX");
  if (!mkdtemp(made.data())) return;
  path_ = made;
  lock_ = open((path_ / lock_file).c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  const std::string host = own_host();
  // who reads this host finds the lock taken; without a lock nobody may tell whether it is left
  if (lock_ >= 0 && flock(lock_, LOCK_EX) == 0 && write(lock_, host.data(), host.size()) < 0) return;
}

OwnFolder::~OwnFolder() {
  std::error_code ignored;
  if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
  if (lock_ >= 0) close(lock_);
}

}  // namespace lacon
