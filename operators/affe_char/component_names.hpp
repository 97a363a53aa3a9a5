#pragma once
// Names of components along the axes of space.
#include <string_view>

namespace lacon {

inline constexpr const char* translation[] = {"DX", "DY", "DZ"};
inline constexpr std::string_view force_along[] = {"FX", "FY", "FZ"};

}  // namespace lacon
