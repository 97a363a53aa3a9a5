# Headers of the standard library, of fmt and of Eigen that most sources begin with, read once for all of them: a quarter of what a room takes
# to compile. Other builds than Release do without, so that dev finds what a source leaves out; and so does ccache, which would keep nothing.
if(CCACHE OR NOT CMAKE_BUILD_TYPE STREQUAL "Release")
  set(CMAKE_DISABLE_PRECOMPILE_HEADERS ON)
endif()
file(CONFIGURE OUTPUT "${PROJECT_BINARY_DIR}/precompiled.cpp" CONTENT "")
add_library(lacon_precompiled OBJECT "${PROJECT_BINARY_DIR}/precompiled.cpp")
target_link_libraries(lacon_precompiled PRIVATE Eigen3::Eigen fmt::fmt)
target_precompile_headers(lacon_precompiled PRIVATE <Eigen/Dense> <fmt/format.h> <fmt/ranges.h> <algorithm> <array> <chrono> <cmath> <filesystem>
  <fstream> <functional> <map> <memory> <numeric> <optional> <ranges> <set> <span> <string> <utility> <variant> <vector>)

# lacon_precompiled(target): a library that uses fmt, and is compiled with the options that all have
function(lacon_precompiled target)
  if(NOT CMAKE_DISABLE_PRECOMPILE_HEADERS)
    target_precompile_headers(${target} REUSE_FROM lacon_precompiled)
    target_compile_options(${target} PRIVATE "$<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds;-Wno-stringop-overflow>")  # false, as -Wrestrict: of headers that are no system's any more
  endif()
endfunction()
