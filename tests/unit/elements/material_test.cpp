#include "lacon/elements/material.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "lacon/catalog/messages.hpp"

namespace {

using lacon::Error;
using lacon::Function;
using testing::HasSubstr;

constexpr double given_young = 2000;

/// The hardening curve of a material with E and these parameters of one more keyword.
std::vector<double> curve(const std::string& keyword, const std::map<std::string, std::variant<double, std::string>>& values,
                          const Function& function = {}) {
  lacon::MaterialField field;
  field.material = {0};
  lacon::Material material;
  material.laws["ELAS"]["E"] = given_young;
  for (const auto& [name, value] : values) material.laws[keyword][name] = value;
  const lacon::MaterialTable table(field, {material}, {"STEEL"}, {{"function_1", function}});
  return lacon::hardening_curve(table, 0, keyword, "D_PLAN/QUAD4");
}

Function tension() {
  Function test;
  test.parameter = "EPSI";
  test.x = {0.005, 0.015, 0.05};
  test.y = {10, 20, 30};
  return test;
}

std::vector<double> curve_of(const Function& test) { return curve("TRACTION", {{"SIGM", "function_1"}}, test); }

std::string refusal(const Function& test) {
  try {
    curve_of(test);
  } catch (const Error& error) {
    EXPECT_EQ(error.message().id, "BEHAVIOUR_2");
    EXPECT_THAT(error.message().text, HasSubstr("STEEL"));
    return error.message().text;
  }
  return "accepted";
}

// The tension curve behind SY has the slope ET = 1 / (1/E + 1/H): R(p) = SY + H p.
TEST(HardeningCurve, OfASlopeIsSeries) {
  const auto found = curve("ECRO_LINE", {{"SY", 10.0}, {"D_SIGM_EPSI", 500.0}});
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[0], 0);
  EXPECT_EQ(found[1], 10);
  EXPECT_NEAR(1 / (1 / given_young + 1 / found[2]), 500, 1e-10);
}

// Plastic strains are what the elastic ones leave of the points' strains; slopes go from point to point.
TEST(HardeningCurve, OfATensionTestGoesThroughItsPoints) {
  const Function test = tension();
  const auto found = curve_of(test);
  ASSERT_EQ(found.size(), 9U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(found[3 * i], test.x[i] - test.y[i] / given_young, 1e-15);
    EXPECT_EQ(found[3 * i + 1], test.y[i]);
  }
  EXPECT_NEAR(found[2], 10 / 0.005, 1e-9);
  EXPECT_NEAR(found[5], 10 / 0.03, 1e-9);
  EXPECT_TRUE(std::isnan(found[8])) << "it ends at its last point";
}

TEST(HardeningCurve, GoesOnAsItsFunctionDoes) {
  Function test = tension();
  test.extension_right = "CONSTANT";
  EXPECT_EQ(curve_of(test).back(), 0);
  test.extension_right = "LINEAIRE";
  EXPECT_NEAR(curve_of(test).back(), 10 / 0.03, 1e-9);
}

TEST(HardeningCurve, ThatMakesNoSenseIsRefused) {
  Function test = tension();
  test.parameter = "INST";
  EXPECT_THAT(refusal(test), HasSubstr("must be a function of EPSI, not of INST"));
  for (std::string* rule : {&test.interpolation[0], &test.interpolation[1]}) {
    test = tension();
    *rule = "LOG";
    EXPECT_THAT(refusal(test), HasSubstr("INTERPOL='LOG'"));
  }
  test = tension();
  test.x[0] = 0;
  EXPECT_THAT(refusal(test), HasSubstr("must start with the elastic limit"));
  test = tension();
  test.y[0] = 11;
  EXPECT_THAT(refusal(test), HasSubstr("gives the modulus 2200, ELAS/E is 2000"));
  test = tension();
  test.y[1] = 31;
  EXPECT_THAT(refusal(test), HasSubstr("between the strains 0.005 and 0.015"));
}

}  // namespace
