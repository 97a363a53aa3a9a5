#pragma once
// A folder for files that others leave behind: it goes with whom it belongs to, and where that one is killed with the next one
// made.
#include <filesystem>

namespace lacon {

/// Where Open MPI makes the folder of its session.
std::filesystem::path folder_of_sessions();
/// And what processes share.
constexpr const char* folder_of_memory = "/dev/shm";

class OwnFolder {
 public:
  /// Make one below a folder, once those that are left there are removed. Where it cannot be made its path is empty.
  explicit OwnFolder(const std::filesystem::path& above);
  ~OwnFolder();
  OwnFolder(const OwnFolder&) = delete;
  OwnFolder& operator=(const OwnFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// Remove those below a folder whose processes of this machine have died.
  static void remove_left(const std::filesystem::path& above);

 private:
  std::filesystem::path path_;
  int lock_ = -1;  ///< of a file within; the kernel gives it up whatever ends this process
};

}  // namespace lacon
