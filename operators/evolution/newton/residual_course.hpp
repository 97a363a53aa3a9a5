#pragma once
// How the residual of an instant changes from iteration to iteration, and what that says of a failure.
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace lacon {

/// Order of the last residuals from which on their end is near, whatever was before.
inline constexpr double quadratic = 1.5;

class ResidualCourse {
 public:
  void start() { *this = {}; }
  /// @param place where it is largest
  void add(double residual, std::int64_t place = -1);
  bool finite() const;
  /// By which factor it has changed in an iteration, the geometric mean of the last three at most; nothing before there are
  /// two.
  std::optional<double> ratio() const;
  /// How many iterations before the last it was smaller than there, at its least; nothing where it never was. The first does
  /// not count: bodies that have not met yet have next to no forces.
  std::optional<std::size_t> smaller_before() const;
  /// Observed order of the last three, where they fall.
  std::optional<double> order() const;
  /// Whether the last iteration has left a tenth of it, or the last three less than a third each: round-off does not fall so.
  bool falls() const;
  /// How many iterations more make the last one this part of itself, if it goes on to fall as it did last: of an order, where
  /// that is `quadratic`, or by the ratio; 1 at least. Nothing where it does not fall.
  std::optional<int> iterations_to(double part) const;
  /// After how many iterations residuals come back, two whole periods long; nothing where they do not.
  std::optional<std::size_t> period() const;
  /// Whether the last six are the same, to a hundredth.
  bool stands() const;
  /// Whether of so many the later half is no less than those before them, none is near its end, and the last one no way down.
  bool wanders(int iterations) const;
  /// Whether so many have left more than half of it, all together.
  bool drags(int iterations) const;
  /// How many of the last iterations have each left more than the one before.
  int growths() const;
  /// In how many iterations up to the last it has been largest at the same place.
  int stays() const { return stays_; }
  /// How it changes in words; empty before it has.
  std::string words() const;

 private:
  std::vector<double> residuals_;
  std::int64_t place_ = -1;
  int stays_ = 0;
};

}  // namespace lacon
