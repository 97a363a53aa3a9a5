#include "lacon/operators/evolution/newton/prediction.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "lacon/structures/hdf5.hpp"

namespace lacon {
namespace {

constexpr double round_off = 1e-10;  // of forces and imposed displacements
constexpr int tries = 3;             // iterations that have to make forces smaller than where they began
constexpr int most = 15;  // that are given to them, for from a near start a few are enough; more while forces go on falling
constexpr double falls = 0.75;  // by this factor an iteration, as they do near a limit point from wherever it begins

/// Figures of an extrapolation of some numbers: what it misses, and how far they go.
struct Miss {
  double missed = 0, moved = 0, size = 0;
  void add(double predicted, double found, double before) {
    missed += (predicted - found) * (predicted - found);
    moved += (found - before) * (found - before);
    size += found * found;
  }
  bool moves() const { return moved > round_off * round_off * size; }
  bool is_near() const { return missed <= (moves() ? moved : round_off * round_off * size); }
};

}  // namespace

double goes_on(std::span<const double> before, std::span<const double> last, std::span<const double> next) {
  double product = 0, was = 0, will_be = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const double change = last[i] - before[i], next_change = next[i] - last[i];
    product += change * next_change;
    was += change * change;
    will_be += next_change * next_change;
  }
  return std::abs(product) > round_off * std::sqrt(was) * std::sqrt(will_be) ? product : 0;
}

void Prediction::note(double start, const KnownState& previous, KnownState solved, bool led) {
  if (pause_.left > 0) --pause_.left;
  if (led) pause_.next = shortest;
  while (!known_.empty() && known_.back().displacement != previous.displacement) known_.pop_back();
  if (known_.empty()) {
    known_.push_back(previous);
    known_.back().instant = start;
  }
  came_near_ = false;
  if (reaches(previous.displacement)) {
    const std::vector<double> there = at(solved.instant).displacement;
    Miss miss;
    for (std::size_t i = 0; i < there.size(); ++i)
      if (!imposed_[i]) miss.add(there[i], solved.displacement[i], previous.displacement[i]);
    came_near_ = miss.is_near();
  }
  known_.push_back(std::move(solved));
  if (known_.size() > 2) known_.erase(known_.begin());
}

void Prediction::mislead() {
  pause_.begin();
  ++pause_.left;  // this one
}

bool Prediction::leads_astray(int iterations, double residual, double before, double at_start) {
  if (residual < falls * before) return false;
  return iterations >= most || (iterations >= tries && !(residual < at_start));
}

std::optional<std::pair<double, double>> Prediction::last_motion() const {
  if (known_.size() < 2) return std::nullopt;
  return std::pair(known_.front().instant, known_.back().instant);
}

bool Prediction::reaches(std::span<const double> displacement) const {
  return known_.size() == 2 && known_.back().instant > known_.front().instant &&
         std::ranges::equal(known_.back().displacement, displacement);
}

bool Prediction::serves(double instant, std::span<const double> displacement, std::span<const double> step,
                        std::span<const double> force) const {
  if (pause_.left > 0 || !came_near_ || !reaches(displacement) || known_.front().force.empty()) return false;
  const KnownState there = at(instant);
  Miss motion, load;
  for (std::size_t i = 0; i < step.size(); ++i)
    if (imposed_[i]) motion.add(there.displacement[i], displacement[i] + step[i], displacement[i]);
  for (std::size_t i = 0; i < force.size(); ++i) load.add(there.force[i], force[i], known_.back().force[i]);
  return (motion.moves() || load.moves()) && motion.is_near() && load.is_near();
}

KnownState Prediction::at(double instant) const {
  const KnownState &first = known_.front(), &last = known_.back();
  const double factor = (instant - last.instant) / (last.instant - first.instant);
  KnownState found = last;
  found.instant = instant;
  const auto go_on = [&](std::vector<double> KnownState::*member) {
    const std::vector<double>&from = first.*member, &to = last.*member;
    for (std::size_t i = 0; i < from.size(); ++i) (found.*member)[i] += factor * (to[i] - from[i]);
  };
  go_on(&KnownState::displacement);
  go_on(&KnownState::pressure);
  go_on(&KnownState::force);
  return found;
}

void Prediction::save(const hdf5::Group& group) const {
  group.set("came_near", std::int64_t{came_near_});
  group.set("pause", pause_.left);
  group.set("next_pause", pause_.next);
  group.set("states", static_cast<std::int64_t>(known_.size()));
  for (std::size_t s = 0; s < known_.size(); ++s) {
    const hdf5::Group state = group.create(std::to_string(s));
    state.set("instant", known_[s].instant);
    state.write("displacement", known_[s].displacement);
    state.write("pressure", known_[s].pressure);
    state.write("force", known_[s].force);
  }
}

void Prediction::resume(const hdf5::Group& group) {
  came_near_ = group.integer("came_near") != 0;
  pause_.left = group.integer("pause");
  pause_.next = group.integer("next_pause");
  known_.clear();
  for (std::int64_t s = 0; s < group.integer("states"); ++s) {
    const hdf5::Group state = group.open(std::to_string(s));
    known_.push_back({state.real("instant"), state.read<double>("displacement"), state.read<double>("pressure"),
                      state.read<double>("force")});
  }
}

}  // namespace lacon
