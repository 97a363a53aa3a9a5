#pragma once
// The Newton table: the peer's columns and words, and beside them the constraint residual, negative pivots and time.
#include <array>
#include <ostream>
#include <string>

#include "lacon/operators/evolution/newton.hpp"

namespace lacon {

class NewtonTable {
 public:
  /// @param where show at which degree of freedom the residual is largest (AFFICHAGE/INFO_RESIDU)
  /// @param rejections show what pairing rejected, and why (INFO=2)
  NewtonTable(std::ostream& out, const StaticProblem& problem, bool where, bool rejections)
      : out_(out), problem_(problem), where_(where), rejections_(rejections) {}

  void start(double instant);
  void line(const IterationReport& report);
  /// The proof lines: what each zone transmits, and that it balances.
  void finish(double instant, int iterations, const StaticState& state, const ContactState* contact);

 private:
  void rule();
  std::string components(const std::array<double, 3>& vector) const;

  std::ostream& out_;
  const StaticProblem& problem_;
  bool where_, rejections_;
};

}  // namespace lacon
