#pragma once
// The Newton table: the peer's columns and words, and beside them the constraint residual, negative pivots and time.
#include <array>
#include <ostream>
#include <string>
#include <vector>

#include "lacon/operators/evolution/evolution.hpp"
#include "lacon/operators/evolution/state_fields.hpp"

namespace lacon {

class NewtonTable : public EvolutionObserver {
 public:
  /// @param where show at which degree of freedom the residual is largest (AFFICHAGE/INFO_RESIDU)
  /// @param reference show the residual over the reference of its degree of freedom (RESI_REFE_RELA)
  /// @param rejections show what pairing rejected, and why (INFO=2)
  NewtonTable(std::ostream& out, const Present& present, bool where, bool reference, bool rejections)
      : out_(out), present_(present), where_(where), reference_(reference), rejections_(rejections) {}

  void begin(double instant) override;
  void iterate(double instant, const IterationReport& report) override;
  /// The proof lines: what each zone transmits, and that it balances.
  void accept(const SolvedInstant& solved) override;

 private:
  std::vector<const struct NewtonColumn*> shown() const;
  void rule();
  void prove(const ContactState& contact);
  std::string components(Vec3 vector) const;

  std::ostream& out_;
  Present present_;
  bool where_, reference_, rejections_;
};

}  // namespace lacon
