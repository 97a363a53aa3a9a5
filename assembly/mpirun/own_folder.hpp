#pragma once
// A folder for files that others leave behind: it goes with whom it belongs to, and where that one is killed with the next one
// made.
#include <filesystem>

namespace lacon {

class OwnFolder {
 public:
  /// Make one below a folder, and remove those there whose processes of this machine have died. Where it cannot be made its
  /// path is empty.
  explicit OwnFolder(const std::filesystem::path& above);
  ~OwnFolder();
  OwnFolder(const OwnFolder&) = delete;
  OwnFolder& operator=(const OwnFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  int lock_ = -1;  ///< of a file within; the kernel gives it up whatever ends this process
};

}  // namespace lacon
