#pragma once
// How the residual of an instant changes from iteration to iteration, and what that says of a failure.
#include <optional>
#include <string>
#include <vector>

namespace lacon {

class ResidualCourse {
 public:
  void start() { residuals_.clear(); }
  void add(double residual) { residuals_.push_back(residual); }
  bool finite() const;
  /// By which factor it has changed in an iteration, the geometric mean of the last three at most; nothing before there are
  /// two.
  std::optional<double> ratio() const;
  /// Observed order of the last three, where they fall.
  std::optional<double> order() const;
  /// Both in words, with a semicolon before them; empty before there are any.
  std::string words() const;

 private:
  std::vector<double> residuals_;
};

}  // namespace lacon
