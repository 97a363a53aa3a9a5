// Functions by points, as operators evaluate them.
#include <gtest/gtest.h>

#include <cmath>

#include "lacon/catalog/messages.hpp"
#include "lacon/structures/concepts.hpp"

namespace lacon {
namespace {

Function line(std::string scale, std::string left) {
  Function function;
  function.parameter = "X";
  function.interpolation[0] = std::move(scale);
  function.extension_left = std::move(left);
  function.extension_right = "LINEAIRE";
  function.x = {1, std::exp(1)};
  function.y = {1, 2};
  return function;
}

TEST(Functions, a_parameter_by_logarithms_ends_at_zero) {
  const Function function = line("LOG", "LINEAIRE");
  EXPECT_NEAR(function(std::exp(-3), "F"), -2, 1e-14);
  EXPECT_NEAR(function(std::exp(2), "F"), 3, 1e-14);
  for (const double at : {0.0, -1.0}) {
    try {
      function(at, "F");
      ADD_FAILURE() << at;
    } catch (const Error& error) {
      EXPECT_EQ(error.message().id, "DEFI_FONCTION_9");
    }
  }
}

TEST(Functions, a_constant_goes_on_beyond_what_logarithms_reach) {
  EXPECT_EQ(line("LOG", "CONSTANT")(-1, "F"), 1);
  EXPECT_NEAR(line("LIN", "LINEAIRE")(-1, "F"), 1 - 2 / (std::exp(1) - 1), 1e-14);
}

}  // namespace
}  // namespace lacon
