#pragma once
// The Newton table: the peer's columns and words, and beside them the constraint residual, negative pivots and time.
#include <ostream>
#include <string>

#include "lacon/operators/evolution/newton.hpp"

namespace lacon {

class NewtonTable {
 public:
  /// @param where show at which degree of freedom the residual is largest (AFFICHAGE/INFO_RESIDU)
  NewtonTable(std::ostream& out, const StaticProblem& problem, bool where) : out_(out), problem_(problem), where_(where) {}

  void start(double instant);
  void line(const IterationReport& report);
  void finish(double instant, int iterations, const StaticState& state, const ContactState* contact);

 private:
  void rule();

  std::ostream& out_;
  const StaticProblem& problem_;
  bool where_;
};

}  // namespace lacon
