#include "lacon/structures/files.hpp"

#include <system_error>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"

namespace lacon {

namespace fs = std::filesystem;

void check_replaceable(const fs::path& file) {
  const auto refuse = [&](const std::string& reason) { fail("BASE_3", {{"file", file.string()}, {"reason", reason}}); };
  std::error_code error;
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, error)) refuse(part("file_no_folder", {{"folder", folder.string()}}));
  const fs::file_status found = fs::status(file, error);
  if (fs::is_directory(found)) refuse(part("file_is_folder"));
  if (fs::exists(found) && !fs::is_regular_file(found)) refuse(part("file_is_device"));
}

void write_as_partial(const fs::path& file, const std::function<void(const fs::path&)>& make) {
  check_replaceable(file);
  const fs::path partial = file.string() + ".partial";
  std::error_code error;
  try {
    make(partial);
    fs::rename(partial, file, error);
    if (error) fail("BASE_3", {{"file", file.string()}, {"reason", error.message()}});
  } catch (...) {
    fs::remove(partial, error);
    throw;
  }
}

}  // namespace lacon
