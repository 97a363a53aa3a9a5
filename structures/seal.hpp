#pragma once
// Seals of the files of a base: a checksum behind the content, where HDF5 does not look. HDF5 1.10 trusts what it reads, so
// that a byte that a disk or a copy has changed can crash it, or become a wrong number.
#include <filesystem>
#include <span>

namespace lacon {

/// Append the seal (docs/structures.md, section 1). Throws BASE_3.
void seal(const std::filesystem::path& file);
/// Make a file of a content, and its seal. Throws BASE_3.
void write_with_seal(const std::filesystem::path& file, std::span<const char> content);

/// Refuse a file whose content is not that of its seal, and one that has something else in the place of a seal, behind
/// the end that its superblock (of version 0, which Lacon writes) gives (BASE_5). One
/// that ends with its content passes: HDF5 tools drop the seal when they change a file. Each state of a file is looked at once
/// in a process.
void check_seal(const std::filesystem::path& file);

}  // namespace lacon
