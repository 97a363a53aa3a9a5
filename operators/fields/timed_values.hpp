#pragma once
// Values of loads: numbers, and functions of place and time, evaluated at many points at once.
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "lacon/operators/program/study_function.hpp"

namespace lacon {

/// Numbers, some of which are functions of a point (X, Y, Z on the initial geometry) and of time (INST).
class TimedValues {
 public:
  explicit TimedValues(std::size_t n = 0) : values_(n, 0.0) {}

  void set(std::size_t i, double value) { values_[i] = value; }
  /// @param point (3)
  void set(std::size_t i, std::shared_ptr<const StudyFunction> function, std::span<const double> point);
  /// Evaluate what does not depend on time, once and for all.
  void settle();
  bool depends_on_time() const { return !parts_.empty(); }
  std::size_t size() const { return values_.size(); }
  /// Throws FUNCTION_1, FORMULE_2 where a function has no value.
  std::vector<double> at(double instant) const;

 private:
  /// The values of one function.
  struct Part {
    std::shared_ptr<const StudyFunction> function;
    std::vector<std::size_t> index;
    std::vector<double> x, y, z;
  };
  static void evaluate(const Part& part, double instant, std::vector<double>& values);

  std::vector<double> values_;
  std::vector<Part> parts_;
};

}  // namespace lacon
