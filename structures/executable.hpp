#pragma once
// Where this program is: what it needs lies beside it, in a build tree as where it is installed.
#include <filesystem>

namespace lacon {

/// This program's file: as the system knows it, or, where /proc is not mounted, as it was started. Empty where neither is
/// known.
std::filesystem::path executable();

}  // namespace lacon
