#include "lacon/operators/evolution/observers/energy_balance.hpp"

#include <algorithm>

#include "lacon/structures/hdf5.hpp"

namespace lacon {

EnergyBalance::EnergyBalance(bool asked, const Present& present) : present_(present) {
  if (asked)
    table_ = Table::of({{"NUME_REUSE", "I"},
                        {"INST", "R"},
                        {"TRAV_EXT", "R"},
                        {"ENER_CIN", "R"},
                        {"ENER_TOT", "R"},
                        {"TRAV_AMOR", "R"},
                        {"TRAV_LIAI", "R"},
                        {"DISS_SCH", "R"}});
}

EnergyBalance::Forces EnergyBalance::forces(double instant) const {
  const std::vector<double>& motion = present_.state.displacement;
  return {motion, present_.problem.external_force(instant, motion), present_.internal_forces()};
}

void EnergyBalance::add_row(double instant) {
  table_->add({std::int64_t{0}, instant, of_external_, 0.0, of_internal_, 0.0, of_external_ - of_internal_, 0.0});
}

void EnergyBalance::start(double instant) {
  if (!table_) return;
  last_ = forces(instant);
  const auto is_zero = [](double force) { return force == 0; };
  if (std::all_of(last_.internal.begin(), last_.internal.end(), is_zero))  // nothing bears the loads yet
    std::fill(last_.external.begin(), last_.external.end(), 0.0);
  add_row(instant);
}

void EnergyBalance::accept(const SolvedInstant& solved) {
  if (!table_) return;
  Forces now = forces(solved.instant);
  for (std::size_t dof = 0; dof < now.motion.size(); ++dof) {
    const double half_way = (now.motion[dof] - last_.motion[dof]) / 2;
    of_external_ += (now.external[dof] + last_.external[dof]) * half_way;
    of_internal_ += (now.internal[dof] + last_.internal[dof]) * half_way;
  }
  last_ = std::move(now);
  add_row(solved.instant);
}

void EnergyBalance::save(const hdf5::Group& group) const {
  if (!table_) return;
  write_table(group.create("table"), *table_);
  group.write("motion", last_.motion);
  group.write("external", last_.external);
  group.write("internal", last_.internal);
  group.write("works", std::vector<double>{of_external_, of_internal_});
}

void EnergyBalance::resume(const hdf5::Group& group) {
  if (!table_) return;
  table_ = read_table(group.open("table"));
  last_ = {group.read<double>("motion"), group.read<double>("external"), group.read<double>("internal")};
  const auto works = group.read<double>("works");
  of_external_ = works.at(0);
  of_internal_ = works.at(1);
}

}  // namespace lacon
