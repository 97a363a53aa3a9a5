#pragma once
// Functions of a study as operators use them: by points (DEFI_FONCTION) or as a Python expression (FORMULE), at many points at
// once.
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "lacon/structures/base.hpp"
#include "lacon/structures/order.hpp"

namespace lacon {

/// A parameter of a function with its values at n points: n of them, or one that holds everywhere.
struct ParameterValues {
  std::string_view name;  ///< "X"
  std::span<const double> values;
};

/// A concept of type function or formula. Formulae are evaluated by the launcher, at the other end of a pipe that the operator
/// inherits (docs/structures.md, section 5): every call is one question, so ask for all points at once.
class StudyFunction {
 public:
  /// Throws BASE_1, BASE_2, BASE_4 (the concept is neither function nor formula).
  StudyFunction(const Base& base, std::string_view id);

  const std::string& id() const { return id_; }
  const std::string& label() const { return label_; }
  const std::vector<std::string>& parameters() const { return parameters_; }
  bool depends_on(std::string_view parameter) const;
  /// Throws FUNCTION_2 where it has a parameter that is none of `known`. @param keyword names the function in the message
  void check_parameters(std::span<const std::string_view> known, std::string_view keyword) const;

  /// Values at n points. @param known parameters of the points, more of them than it needs too
  /// Throws FUNCTION_2 (a parameter is missing), FUNCTION_1 (outside its points), FORMULE_2 (no value at a point), FORMULE_6
  /// (a formula, and no launcher).
  std::vector<double> values(std::size_t n, std::span<const ParameterValues> known) const;
  /// The value at one point of one parameter: an instant.
  double value(std::string_view parameter, double at) const;

 private:
  std::string id_, label_;
  std::vector<std::string> parameters_;
  std::variant<Function, Formula> rule_;
};

/// What a keyword gives: a number, or a function of X, Y, Z and INST. Throws FUNCTION_2.
LoadValue value_of(const Base& base, const Keywords& keywords, std::string_view keyword);

}  // namespace lacon
