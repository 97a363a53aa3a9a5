#pragma once
// Files that are written wholly or not at all: as `<file>.partial`, renamed when they are whole.
#include <filesystem>
#include <functional>

namespace lacon {

/// Refuse a file that cannot be written so: its folder is not there, or something else has its name. A renamed file would
/// replace a device, such as /dev/null. Throws BASE_3.
void check_replaceable(const std::filesystem::path& file);

/// Have `make` write `<file>.partial`, which then gets the name of `file`; nothing is left of one that fails. Throws BASE_3,
/// and what `make` throws.
void write_as_partial(const std::filesystem::path& file, const std::function<void(const std::filesystem::path&)>& make);

}  // namespace lacon
