#pragma once
// Names in files of other programs.
#include <filesystem>
#include <set>
#include <string>

namespace lacon {

/// `name`, or `name_2`, `name_3`, ...: the first that `fits`.
template <class Fits>
std::string free_name(const std::string& name, Fits fits) {
  std::string candidate = name;
  for (int k = 2; !fits(candidate); ++k) candidate = name + "_" + std::to_string(k);
  return candidate;
}

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
