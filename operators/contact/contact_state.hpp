#pragma once
// Contact of a computation at a geometry: the statuses of the patches, the rows of their multipliers, and the figures by which
// a user trusts them (METHOD.md 3.6, 3.7). It knows neither loads nor equations: what it adds is handed to whoever numbers
// unknowns.
#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "lacon/operators/contact/contact_edge.hpp"
#include "lacon/operators/contact/contact_geometry.hpp"
#include "lacon/operators/contact/patches.hpp"
#include "lacon/operators/contact/pressure_alternation.hpp"
#include "lacon/operators/contact/pressure_rows.hpp"
#include "lacon/structures/vector.hpp"

namespace lacon {

struct ContactTolerances {
  double unpaired = 1e-14;            ///< covered fraction of a patch below which it has no master
  double bare = 1e-9;                 ///< fraction of a patch that no master covers, above round-off
  double initial_gap = 1e-6;          ///< CONTACT_INIT='INTERPENETRE': largest gap, over the smallest edge
  double lambda_round_off = 1e-10;    ///< of the largest |lambda|: below it a sign means nothing
  double gap_round_off = 1e-14;       ///< of the size of the mesh
  double starting_gap = 0.1;          ///< CONTACT_INIT='OUI': of h, largest gap that closes at once, where a patch has no more
  double holding_gap = 0.5;           ///< of h: average gap up to which a patch may hold a body that is loose otherwise
  double as_near = 1e-3;              ///< of h: by how much gaps of patches that hold it together may differ
  double held_overlap = 1e-6;         ///< of h: an overlap of a locked patch that is worth an alarm
  double pierced = 0.05;              ///< of h: likewise of points of another active patch, whose average is closed
  double pierced_open = 0.04;         ///< of h: of points of an open patch, which nothing keeps out of the master
  double pierced_at_rest = 0.0005;    ///< of h: likewise, where nothing presses
  double missed_depth = 0.005;        ///< of h: likewise, where others press
  double far_behind = 0.5;            ///< of h: by how much parts of one patch may see masters at different distances
  double missed_pressure = 0.1;       ///< of the largest: what such points would press with, worth an alarm
  double alternating = 0.1;           ///< of the pressure: by how much neighbours may differ to opposite sides
  double scattered = 0.2, few = 0.6;  ///< likewise, where open ones among them count, and how many of them all press
  double scatter = 0.3;               ///< likewise, of triangles of curved skins, to whichever side
  double stiffer = 2;                 ///< how many times as stiff as its master a slave is that answers bending by pressures
  double unpressed = 0.3;             ///< of what a pressure presses in: how deep it leaves points inside that are pressed flat
  double touching = 1e-8;             ///< of h: an overlap of patches without contact that is round-off
};

/// What the contact of a zone does at an instant: the figures by which a user trusts it.
struct ZoneBalance {
  std::string slave_group, master_group;
  std::int64_t active = 0, open = 0, unpaired = 0;
  Vec3 on_slave{}, on_master{};   ///< resultants of the contact forces
  Vec3 moment{};                  ///< of all contact forces of the zone about the origin: zero where they balance
  double covered = 0, whole = 0;  ///< measure of the slave skin, current geometry
  double work = 0;                ///< largest |lambda g|: zero where contact and gap exclude each other
};

/// Locked patches that lie inside their master: no pressure can part them.
struct HeldOverlap {
  std::int64_t count = 0;
  std::size_t deepest = 0;  ///< patch
  double gap = 0;           ///< of it
};

/// Points of a patch that lie inside its master although its gap, an average, is closed or open.
struct PiercedPatch {
  std::size_t patch;
  double depth;  ///< of its deepest point, over h
  double gap;    ///< average
};

/// Patches that are as near to their master as any others of a body.
struct NearestPatches {
  std::vector<std::size_t> patches;  ///< the nearest of all first
  std::int32_t node;                 ///< of the body
  bool tips = false;                 ///< it is in contact beside them, and tips onto them
};

/// Patches that carry most of a zone's force, though the contact on them is smaller than they are.
struct CoarseContact {
  std::size_t patch;  ///< that of the largest force
  double share;       ///< of the zone's force that they carry
  double times;       ///< what that patch's deepest point lies inside, over what its pressure presses in
};

/// An open patch of which a part lies inside its master, and the rest sees another one far behind.
struct SplitPatch {
  std::size_t patch;
  double share;  ///< of the patch: the part inside
  double depth;  ///< of this part, on average
  double far;    ///< average gap of the rest
};

/// A patch without contact that lies inside its master.
struct UncheckedOverlap {
  std::size_t patch;
  double depth;  ///< of its deepest point
};

/// What contact needs to know of the bodies under the skins.
struct ContactBodies {
  /// Young's modulus of a cell, or nothing where it has no elastic material.
  std::function<std::optional<double>(std::int32_t cell)> modulus;
  std::vector<std::uint8_t> free;   ///< (n_nodes, dimension): 1 where a displacement is an unknown
  std::vector<HeldDirection> held;  ///< what loads give of displacements
};

/// An unknown of contact: vertex v < n_nodes is node v with its displacements, vertex n_nodes + p is patch p with its
/// multipliers (assembly/numbering.hpp).
struct ContactUnknown {
  std::int64_t vertex;
  int component;
};

/// What one contact cell, or a patch without any, adds to the system.
struct ContactTerm {
  std::span<const ContactUnknown> unknowns;  ///< (n)
  std::span<const double> matrix;            ///< (n (n + 1) / 2): lower triangle, row by row
  std::span<const double> residual;          ///< (n)
};

/// The integrated gap of a patch, and its derivatives by displacements.
struct GapRow {
  double gap = 0;
  std::vector<ContactUnknown> unknowns;  ///< one may come several times
  std::vector<double> derivative;        ///< (unknowns)
};

/// What the matrix lacks where the end of a cover that is kept moves, column row^T: the end moves by `row` times displacements,
/// and changes residuals by `column` times that.
struct CoverEnd {
  std::vector<ContactUnknown> unknowns;
  std::vector<double> column, row;  ///< (unknowns)
};

class ContactState {
 public:
  /// All arguments must outlive it. Throws EVOLUTION_2 for a slave body without modulus, and what ContactGeometry throws.
  ContactState(const Mesh& mesh, const Model& model, const Contact& contact, Registry& registry, ContactBodies bodies);

  /// ContactGeometry::rest_at
  void rest_at(std::span<const double> displacement) { geometry_.rest_at(displacement); }
  /// ContactGeometry::renew_cuts
  void renew_cuts() { geometry_.renew_cuts(); }
  /// ContactGeometry::choose_masters
  bool choose_masters();
  /// ContactGeometry::go_on_where_flush
  bool go_on_where_flush();
  /// ContactGeometry::keep
  void keep(const KeptPairing& kept) { geometry_.keep(kept); }
  /// ContactGeometry::decide_walls
  void decide_walls(std::span<const double> coordinates) { geometry_.decide_walls(coordinates); }
  /// ContactGeometry::set_cuts
  void set_cuts(std::span<const std::int32_t> cuts) { geometry_.set_cuts(cuts); }
  /// What was in contact at the last state in equilibrium, which zones with GLISSIERE='OUI' keep in contact.
  void keep_gliding(const Patchwise& patches);
  /// ContactGeometry::set_offsets
  void set_offsets(std::vector<std::vector<double>> offsets) { geometry_.set_offsets(std::move(offsets)); }
  /// From now on the cover of a patch keeps its place in the derivatives of its gap: pressure acts along normals alone. Forces
  /// stay balanced, for rigid motions leave the gap as it is, but are no derivatives of it where a master ends on the patch.
  void keep_cover(std::size_t patch) { keeps_cover_[patch] = true; }
  bool keeps_cover(std::size_t patch) const { return keeps_cover_[patch]; }
  /// Patches of which that makes no difference, without master or covered wholly, no longer keep it.
  void let_covers_go();
  /// Pair on the current geometry, integrate gaps and couplings. @param displacement (n_nodes, dimension)
  void update_geometry(std::span<const double> displacement);
  /// Statuses at the first instant (METHOD.md 3.7), multipliers zero.
  Patchwise initial() const;
  /// Statuses from lambda + rho g. @return how many have changed
  std::int64_t update_statuses(Patchwise& patches) const;
  /// Open patches behind those that are pulled open (contact_edge.hpp). @param before statuses that the multipliers belong to
  /// @param course of the iterations of an instant
  /// @return how many
  std::int64_t open_behind_edges(const std::vector<Status>& before, Patchwise& patches, EdgeCourse* course = nullptr) const;

  /// Differentiate the gaps of active patches at the present geometry, for what follows.
  /// @param second whether evaluate() is to have the second derivatives, lambda d2G/du2, in its matrix
  void linearise(const Patchwise& patches, bool second);

  /// The gaps of some patches at the present geometry, (patches).
  std::vector<GapRow> gap_rows(std::span<const std::size_t> patches) const;
  /// Whether a patch without contact may take it, its gap being at most `reach` of h; whether an active one may lose it.
  bool may_close(std::size_t patch, const Patchwise& patches, double reach) const;
  bool may_open(std::size_t patch, const Patchwise& patches) const;
  /// The pressure that an integrated gap of a covered patch counts as in its status: rho over what is covered.
  double pressure_of_gap(std::size_t patch) const { return rho_[patch] / geometry_.covered(patch); }
  /// Round-off of the integrated gap of a patch.
  double gap_round_off(std::size_t patch) const { return gap_tolerance_ * geometry_.covered(patch); }

  /// Pairs of vertices that contact couples: patch and node, and nodes that meet in second derivatives.
  std::vector<std::pair<std::int64_t, std::int64_t>> coupled_vertices() const;
  /// Call `use` for all that adds to contact forces and the multipliers' rows.
  void evaluate(const Patchwise& patches, const std::function<void(const ContactTerm&)>& use) const;
  /// In the plane: the ends of kept covers, where second derivatives are there.
  std::vector<CoverEnd> moving_ends(const Patchwise& patches) const;
  /// Contact forces on the bodies, (n_nodes, dimension): -lambda dG/du.
  std::vector<double> forces(const Patchwise& patches) const;

  /// Largest |g_T| / h over the active patches that have an equation.
  double constraint_residual(const Patchwise& patches) const;
  /// Average gaps over h, (patches); 0 of those of which too little is covered to take contact.
  std::vector<double> gaps_over_size() const;
  /// Whether patches that press have other gaps or another cover than before, or statuses change.
  /// @param gaps, covered ContactGeometry::gaps() and measures() then
  bool presses_otherwise(std::span<const double> gaps, std::span<const double> covered, const Patchwise& patches) const;
  /// Whether some gap closes within so many increments more that change it as the last one has. @param before gaps_over_size()
  bool closes_within(int increments, std::span<const double> before) const;
  /// The part of an increment, which has led to the present geometry, where the first open patch has come `depth` sizes deep
  /// into its master; 1 where none lies deeper than `limit` that did not when it began. @param before gaps_over_size() there
  double part_to_depth(const Patchwise& patches, std::span<const double> before, double limit, double depth) const;
  /// Forces and statuses of each zone.
  std::vector<ZoneBalance> balance(const Patchwise& patches) const;
  /// The strain that the pressure on a patch makes in the bodies under it: |lambda| times their flexibility.
  double strain(std::size_t patch, const Patchwise& patches) const {
    return rho_[patch] > 0 ? std::abs(patches.lambda[patch]) / (rho_[patch] * size_[patch]) : 0;
  }
  /// Active patches that have an equation: the number of negative pivots to expect.
  std::int64_t n_constraints(const Patchwise& patches) const;
  /// Whether every displacement in a patch's row is imposed: its multiplier is then undetermined and keeps its value.
  bool is_locked(std::size_t patch) const { return locked_[patch]; }
  /// Whether its master covers as much of it as an active patch needs.
  bool is_covered(std::size_t patch) const { return geometry_.coverage(patch) >= least_coverage; }
  /// Or as one that takes contact.
  bool takes_contact(std::size_t patch) const {
    return geometry_.coverage(patch) >= (geometry_.is_beside_wall(patch) ? least_crest : taking_coverage);
  }
  /// Whether its master ends on it.
  bool is_covered_in_part(std::size_t patch) const {
    return is_covered(patch) && geometry_.coverage(patch) < 1 - tolerances_.bare;
  }
  HeldOverlap held_overlap() const;
  /// Whether an open patch may hold a body that is loose otherwise: its gap is within ContactTolerances::holding_gap.
  bool may_hold(std::size_t patch, const Patchwise& patches) const;
  /// Whether it would but that its master covers less than `taking_coverage` of it; no wall is beside it.
  bool lacks_cover(std::size_t patch, const Patchwise& patches) const;
  /// Whether gaps of patches that hold a body together may differ by so much.
  bool is_as_near(std::size_t patch, double difference) const { return difference <= tolerances_.as_near * size_[patch]; }
  /// A node of the loose body that meets at a patch: of its own, or of a master's; -1 where there is none.
  std::int32_t node_at(std::size_t patch, const std::function<bool(std::int32_t node)>& is_loose) const;
  /// For each of some loose bodies, in each zone where no patch holds it: the patches that are nearest to their master and
  /// may_hold() it; where patches hold them in all zones, those that are nearest across other directions;
  /// where there are none, those far from what presses: feet of a body that tips.
  /// @param loose bodies, numbered as body_of(node) does
  std::vector<NearestPatches> nearest_to_hold(const Patchwise& patches, const std::set<std::int32_t>& loose,
                                              const std::function<std::int32_t(std::int32_t node)>& body_of) const;
  /// Of a zone the patch that is pierced deepest, over its size, where that is worth an alarm.
  /// @param at_rest nothing presses in this zone: less is
  std::optional<PiercedPatch> pierced(std::int32_t zone, const Patchwise& patches, bool at_rest) const;
  /// Of a zone the open patch that is pierced deepest among those around which nothing presses, where that is worth an alarm: a
  /// contact that the averages of coarse patches miss. @param strain the largest that the zone has made; the depth over h is
  /// the strain of the pressure that would close it
  std::optional<PiercedPatch> missed(std::int32_t zone, const Patchwise& patches, double strain) const;
  /// Of a zone the open patch of which a part lies deepest inside its master, where the other part alone keeps it open.
  /// @param strain as for missed()
  std::optional<SplitPatch> split(std::int32_t zone, const Patchwise& patches, double strain) const;
  /// Of a zone, where patches that are not pressed flat, with others around them that are open, carry most of its force.
  std::optional<CoarseContact> coarse(std::int32_t zone, const Patchwise& patches) const;
  /// Of a zone, where its pressures alternate by so much that it is worth an alarm.
  /// @param has_facets whether its skins are curved and their cells are not; asked where rows alternate, or triangles are
  /// scattered
  std::optional<AlternatingPressures> alternation(std::int32_t zone, const Patchwise& patches,
                                                  const std::function<bool()>& has_facets) const;
  /// Whether the body of a patch is several times as stiff as what it faces.
  bool resists_its_master(std::size_t patch) const {
    return rho_[patch] * size_[patch] * own_[patch] < 1 / (1 + tolerances_.stiffer);  // own_ / (own_ + that of the master)
  }
  bool presses(std::int32_t zone, const Patchwise& patches) const;
  /// What round-off of coordinates makes of the pressures of a zone's active patches, over the largest of them: patches that
  /// are pulled or pressed by less stay what they are. Nothing without a pressure.
  std::optional<double> undecided(std::int32_t zone, const Patchwise& patches) const;
  /// Of a zone, over its patches: strain().
  double largest_strain(std::int32_t zone, const Patchwise& patches) const;
  /// Of a zone with RESOLUTION='NON' the patch that its master has pierced deepest, by more than TOLE_INTERP.
  std::optional<UncheckedOverlap> unchecked_overlap(std::int32_t zone) const;

  const ContactGeometry& geometry() const { return geometry_; }
  std::size_t n_patches() const { return geometry_.n_patches(); }
  /// h
  double patch_size(std::size_t patch) const { return size_[patch]; }
  /// The smallest h of a patch.
  double smallest_patch() const { return *std::min_element(size_.begin(), size_.end()); }

 private:
  /// What hangs on the contact cells alone.
  void note_geometry();
  /// Whether an open patch is within ContactTolerances::holding_gap of its master.
  bool is_near(std::size_t patch, const Patchwise& patches) const;
  /// Of a zone the patch that is pierced deepest, over its size, and by more than a limit of its own.
  std::optional<PiercedPatch> deepest(std::int32_t zone, const std::function<double(std::size_t patch)>& limit) const;

  const Mesh& mesh_;
  const Contact& contact_;
  const ContactTolerances tolerances_;
  ContactGeometry geometry_;
  std::vector<std::uint8_t> free_;
  std::vector<double> smallest_edge_;                    ///< of each zone
  const std::vector<double>& size_ = geometry_.sizes();  ///< h of each patch: |T| in 2D, sqrt |T| in 3D, initial geometry
  std::vector<double> flexibility_;                      ///< 1 / E of the body below each cell of a master skin, 0 elsewhere
  std::vector<double> own_;                              ///< likewise of each patch
  std::vector<double> rho_;                            ///< stiffness of both bodies, in series, under a pressure on each patch
  std::vector<std::vector<std::int32_t>> neighbours_;  ///< patches of its zone that share a node with each patch
  std::vector<PressureAlternation> alternations_;      ///< of each zone
  std::vector<PressureRows> rows_;                     ///< likewise
  std::vector<bool> locked_;
  std::vector<bool> held_open_;                         ///< of each patch: SANS_GROUP_NO, RESOLUTION='NON'
  std::vector<bool> gliding_;                           ///< of each patch: keeps its contact (GLISSIERE)
  std::vector<bool> keeps_cover_;                       ///< of each patch: keep_cover()
  std::vector<ContactGeometry::Variation> variations_;  ///< of contact cells of active patches
  bool second_ = false;                                 ///< they have second derivatives
  double gap_tolerance_ = 0;
};

}  // namespace lacon
