#pragma once
// A vector to look at a matrix with where any does that favours no motion.
#include <cstddef>
#include <vector>

namespace lacon {

/// (n) of 1 and -1, the same in every run.
std::vector<double> any_signs(std::size_t n);

}  // namespace lacon
