#pragma once
// Files that are written wholly or not at all: as `<file>.partial`, renamed when they are whole.
#include <filesystem>

namespace lacon {

/// Refuse a file that cannot be written so: its folder is not there, or something else has its name. A renamed file would
/// replace a device, such as /dev/null. Throws BASE_3.
void check_replaceable(const std::filesystem::path& file);

}  // namespace lacon
