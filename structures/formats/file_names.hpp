#pragma once
// Names of meshes and groups as a file of another program has them.
#include <filesystem>
#include <set>
#include <string>

namespace lacon {

/// Hands the names of one file over as UTF-8, and says once, at the end of reading, which ones were not.
class FileNames {
 public:
  std::string read(std::string name);
  /// FORMAT_1, where a name was taken for Latin-1.
  void tell(const std::filesystem::path& file) const;

 private:
  std::set<std::string> converted_;
};

}  // namespace lacon
