#pragma once
// What tests/mutation/run includes in its copy of the tree: every mutant is there, and LACON_MUTANT says which one lives.
#include <cstdlib>
#include <type_traits>

namespace lacon::mutants {

inline const int living = [] {
  const char* number = std::getenv("LACON_MUTANT");
  return number ? std::atoi(number) : 0;
}();

/// What the compiler evaluates is the same in the whole run: no mutant lives there.
constexpr bool alive(int number) { return !std::is_constant_evaluated() && living == number; }

}  // namespace lacon::mutants
