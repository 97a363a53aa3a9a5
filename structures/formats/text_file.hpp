#pragma once
// Text files that are written wholly or not at all, several at once if need be.
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lacon {

/// The content of a file; throws BASE_2.
std::string read_text(const std::filesystem::path& file);

/// The first bytes of a mesh file, `count` or fewer; throws MED_1 where there is no such file, or nothing in it.
std::string first_bytes(const std::filesystem::path& mesh_file, std::size_t count);

/// Files written as `<file>.partial`; commit() gives them their names, in the order of writing. What is not committed
/// disappears.
class TextFiles {
 public:
  TextFiles() = default;
  TextFiles(const TextFiles&) = delete;
  TextFiles& operator=(const TextFiles&) = delete;
  ~TextFiles();

  /// Throws BASE_3.
  void write(const std::filesystem::path& file, std::string_view text);
  void commit();

 private:
  std::vector<std::pair<std::filesystem::path, std::filesystem::path>> files_;  ///< partial, final
};

}  // namespace lacon
