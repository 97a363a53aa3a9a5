#pragma once
// The contact of a computation at the current geometry: statuses, and what contact cells add to the system.
// METHOD.md 3.4 to 3.7 with the conventions of DESIGN.md, section 3.
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "lacon/operators/evolution/contact_geometry.hpp"
#include "lacon/operators/evolution/static_problem.hpp"
#include "lacon/operators/evolution/system.hpp"

namespace lacon {

enum class Status : std::int8_t { unpaired = -1, open = 0, active = 1 };

/// Statuses and multipliers of the patches: what a time step starts from and what is restored when it is cut.
struct Patchwise {
  std::vector<Status> status;
  std::vector<double> lambda;
};

struct ContactTolerances {
  double unpaired = 1e-14;          ///< covered fraction of a patch below which it has no master
  double least_coverage = 1e-5;     ///< covered fraction that an active patch needs
  double initial_gap = 1e-6;        ///< CONTACT_INIT='INTERPENETRE': largest gap, over the smallest edge
  double lambda_round_off = 1e-10;  ///< of the largest |lambda|: below it a sign means nothing
  double gap_round_off = 1e-14;     ///< of the size of the mesh
  double held_overlap = 1e-6;       ///< of h: an overlap of a locked patch that is worth an alarm
};

/// What the contact of a zone does at an instant: the figures by which a user trusts it.
struct ZoneBalance {
  std::string slave_group, master_group;
  std::int64_t active = 0, open = 0, unpaired = 0;
  std::array<double, 3> on_slave{}, on_master{};  ///< resultants of the contact forces
  std::array<double, 3> moment{};  ///< of all contact forces of the zone about the origin: zero where they balance
  double covered = 0, whole = 0;   ///< measure of the slave skin, current geometry
  double work = 0;                 ///< largest |lambda g|: zero where contact and gap exclude each other
};

/// Locked patches that lie inside their master: no pressure can part them.
struct HeldOverlap {
  std::int64_t count = 0;
  std::size_t deepest = 0;  ///< patch
  double gap = 0;           ///< of it
};

class ContactState {
 public:
  explicit ContactState(const StaticProblem& problem);

  /// Pair on the current geometry, integrate gaps and couplings. @param displacement (n_nodes, dimension)
  void update_geometry(std::span<const double> displacement);
  /// Statuses at the first instant (METHOD.md 3.7), multipliers zero.
  Patchwise initial() const;
  /// Statuses from lambda + rho g. @return how many have changed
  std::int64_t update_statuses(Patchwise& patches) const;

  /// Pairs of vertices that the multipliers' rows couple.
  std::vector<Coupling> couplings() const;
  /// Add contact forces and the multipliers' rows.
  void assemble(const Patchwise& patches, System& system) const;

  /// Largest |g_T| / h over the active patches that have an equation.
  double constraint_residual(const Patchwise& patches) const;
  /// Forces and statuses of each zone.
  std::vector<ZoneBalance> balance(const Patchwise& patches) const;
  /// Active patches that have an equation: the number of negative pivots to expect.
  std::int64_t n_constraints(const Patchwise& patches) const;
  /// Whether every displacement in a patch's row is imposed: its multiplier is then undetermined and keeps its value.
  bool is_locked(std::size_t patch) const { return locked_[patch]; }

  HeldOverlap held_overlap() const;

  /// Throws EVOLUTION_8 where a slave cell reaches over the axis of revolution.
  void check_radii() const { geometry_.check_radii(); }
  double gap(std::size_t patch) const { return geometry_.gap(patch); }  ///< average, positive when open
  double coverage(std::size_t patch) const {
    return geometry_.coverage(patch);
  }  ///< covered over whole measure, current geometry
  std::size_t n_patches() const { return geometry_.n_patches(); }
  /// The smallest h of a patch.
  double smallest_patch() const { return *std::min_element(size_.begin(), size_.end()); }
  /// How many couples pairing rejected, for each `Rejection`, summed over the zones.
  std::span<const std::int64_t> rejected() const { return geometry_.rejected(); }

 private:
  const StaticProblem& problem_;
  const Contact& contact_;
  const ContactTolerances tolerances_;
  ContactGeometry geometry_;
  std::vector<double> smallest_edge_;  ///< of each zone
  std::vector<double> size_;           ///< h of each patch: |T| in 2D, sqrt |T| in 3D, initial geometry
  std::vector<double> rho_;            ///< E / h of each patch
  std::vector<bool> locked_;
  double gap_tolerance_ = 0;
};

}  // namespace lacon
