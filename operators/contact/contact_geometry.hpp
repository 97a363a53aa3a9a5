#pragma once
// The contact cells of all zones at a geometry: gaps, couplings and coverage of the patches (METHOD.md 3.4 and 3.5). It knows
// neither multipliers nor equations, so that a look at the pairing needs no solver.
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "lacon/elements/reference.hpp"
#include "lacon/elements/registry.hpp"
#include "lacon/operators/contact/kept_pairing.hpp"
#include "lacon/operators/contact/mirrors.hpp"
#include "lacon/operators/contact/variation/gap_variation.hpp"
#include "lacon/operators/contact/variation/normal_variation.hpp"
#include "lacon/pairing/pairing.hpp"
#include "lacon/structures/concepts.hpp"

namespace lacon {

/// What pairing found in one zone, for whom wants to look at it.
struct ZonePairing {
  Pairing pairing;                ///< cells by their number in the zone
  std::vector<double> point_gap;  ///< of each integration point
  std::vector<double> gap;        ///< of each contact cell, average
  std::vector<double> measure;    ///< of each contact cell, current geometry
};

/// A slave cell that has gone through a master.
struct GoneThrough {
  std::int32_t cell;
  double sizes;  ///< how deep its middle lies behind that master, in sizes of its patch
};

/// A patch and a master that it sees, or does not.
struct PatchMaster {
  std::int32_t patch, master;  ///< `master` is a cell of the mesh

  auto operator<=>(const PatchMaster&) const = default;
};

/// What decides on the masters that patches do not see (left_out.cpp).
struct LeftOut {
  bool operator==(const LeftOut&) const = default;
  std::set<PatchMaster> far;       ///< masters that are left out
  std::set<PatchMaster> in_front;  ///< the first masters of faces that are in front of a patch, which sees no walls of others
};

class ContactGeometry {
 public:
  struct Zone {
    std::vector<std::int32_t> slaves;   ///< index into Contact::slaves of each cell of `slave`
    std::vector<std::int32_t> masters;  ///< mesh cell of each cell of `master`
    std::vector<std::uint8_t> inner;    ///< Surface::inner of the slave
    std::vector<SlaveCut> cuts;         ///< Surface::cuts of the slave: in space, since it was at rest
    std::vector<EndPlane> planes;
    std::vector<std::uint8_t> mirrored;                     ///< Surface::mirrored of the master
    bool goes_on_flush = false;                             ///< go_on_where_flush()
    std::vector<std::uint8_t> flush;                        ///< of these, what it adds
    std::vector<std::array<std::int32_t, 4>> neighbours;    ///< edge_neighbours() of the master
    std::vector<std::uint8_t> free_ends;                    ///< Surface::free_ends of the master
    std::vector<Couple> left_out;                           ///< PairingOptions::left_out
    std::map<std::int32_t, std::int32_t> places;            ///< in `master` of cells of the mesh
    std::vector<std::int32_t> faces;                        ///< PairingOptions::faces
    bool one_face = true;                                   ///< of the master: there are no walls
    std::vector<double> slave_thickness, master_thickness;  ///< Surface::thickness, before anything has moved
    Ragged<std::int32_t> in_front;                          ///< PairingOptions::in_front
    Surface slave, master;
    bool current_jacobian = false;
    PairingOptions pairing;
  };
  /// A contact cell with what its kernel gave.
  struct Cell {
    std::int32_t slave;     ///< index into Contact::slaves
    std::int32_t master;    ///< cell of the mesh
    std::int32_t place;     ///< of the master in its zone
    double gap;             ///< integral
    double measure;         ///< current geometry
    double least, most;     ///< gaps at its integration points
    std::int64_t coupling;  ///< first entry in coupling()
  };
  /// Couples of a zone that were left out for being too deep.
  struct TooDeep {
    std::int64_t count = 0;
    std::int32_t slave = -1;  ///< cell of the mesh, of the first of them
  };
  /// The derivatives of the integrated gap of one contact cell, or of all of a slave cell, by the nodes that it depends on.
  struct Variation {
    std::int32_t slave = -1;          ///< index into Contact::slaves
    std::vector<std::int32_t> nodes;  ///< those of the slave skin first
    int n_slave_nodes = 0;            ///< of these: the slave cell's own come first
    GapVariation of_gap;              ///< (nodes, dimension)
  };

  /// On the initial geometry, not yet paired. All arguments must outlive it. Throws EVOLUTION_3 for a slave cell without
  /// normal, EVOLUTION_8 for one beyond the axis.
  ContactGeometry(const Mesh& mesh, const Model& model, const Contact& contact, Registry& registry);
  ContactGeometry(const ContactGeometry&) = delete;
  ContactGeometry& operator=(const ContactGeometry&) = delete;

  /// The displacement of the last state in equilibrium; at first the bodies are at their initial places. Cells of the bodies
  /// may overlap by what they have moved since, however deep that is, and by no more than some facets else (unless
  /// COEF_MULT_APPA gives a limit): further off a normal has left the body on its other side. @param displacement (n_nodes,
  /// mesh.dimension)
  void rest_at(std::span<const double> displacement);
  /// Whether slave cells in space are cut more finely than their present shapes ask for; let the next update() cut them as
  /// these do.
  bool keeps_cuts() const;
  void renew_cuts() { cuts_end_ = true; }
  /// How slave cells in space have been cut since then (Surface::cuts), of all zones, for set_cuts() of another process:
  /// steps, curved, affine of each; empty in the plane.
  std::vector<std::int32_t> cuts() const;
  void set_cuts(std::span<const std::int32_t> cuts);

  /// Masters that a patch sees in part, half its size or more behind the others of it, and walls beside a face of the master
  /// that is in front of it (left_out.cpp), are left out from now on, until the patch sees them otherwise: a gap that is an
  /// average over both would keep it open. Contact cells are those of the last update() without them.
  /// @return whether the patches see others than before
  bool choose_masters();

  /// Of a zone a slave cell that has gone through a master since the bodies were at rest and lies deep behind it, or beyond the
  /// far side of the body, where pairing may see nothing of it (crossings.cpp).
  std::optional<GoneThrough> gone_through(std::size_t zone) const;

  /// Let masters go on where both skins end in one plane: normals that lean over it by what facets leave, or a face that bulges
  /// a little more than the other one, would miss them there, now more, now less. Not with VARIATION_JEU='FIGEE'.
  void find_ends(std::span<const HeldDirection> held);

  /// Let masters go on where free faces of both bodies are flush too, as of plates without lateral strain: forces jump where
  /// they pass each other, and no iterate is in equilibrium there. Now where they are flush at present, from the next state at
  /// rest on where they are then.
  /// @return whether there are such that did not go on; contact cells are those with them
  bool go_on_where_flush();

  KeptPairing kept() const;
  /// Begin as another one, perhaps of other zones, has gone on: what has no place here is passed over.
  void keep(const KeptPairing& kept);
  /// Where bodies were when it was decided what is a wall for which slave cell, (n_nodes, 3), for decide_walls() of another
  /// process; empty: at rest.
  std::span<const double> walls_decided_at() const { return walls_at_; }
  void decide_walls(std::span<const double> coordinates);

  /// By what the gaps of each zone are smaller than what its cells leave, from the next update() on: (n_nodes), interpolated on
  /// the slave; empty: by nothing.
  void set_offsets(std::vector<std::vector<double>> offsets) { offsets_ = std::move(offsets); }

  /// Pair on the current geometry, integrate gaps and couplings. @param displacement (n_nodes, mesh.dimension)
  /// @param records gets one entry a zone. Throws EVOLUTION_3.
  void update(std::span<const double> displacement, std::vector<ZonePairing>* records = nullptr);

  /// The derivatives of the contact cells of some patches at the geometry of the last update(); its couplings with
  /// VARIATION_JEU='FIGEE', and where they are the first derivatives because slave and masters coincide.
  /// @param order of the derivatives wanted of each patch: 0 (none of its cells), 1, 2
  /// @param still patches on which the ends of masters keep their places: they are not differentiated; empty: none
  std::vector<Variation> vary(std::span<const std::int8_t> order, const std::vector<bool>& still = {}) const;

  /// An iterate may reach over the axis of revolution on its way, a solution may not: throws EVOLUTION_8.
  void check_radii() const;

  std::span<const double> coordinates() const { return coordinates_; }  ///< (n_nodes, 3), current
  const std::vector<Zone>& zones() const { return zones_; }
  const std::vector<Cell>& cells() const { return cells_; }
  /// For each contact cell: (nodes of the slave, then of the master; dimension)
  const std::vector<double>& coupling() const { return coupling_; }

  std::size_t n_patches() const { return gap_.size(); }
  std::int32_t zone_of(std::size_t patch) const { return zone_of_[patch]; }  ///< -1 for none
  double gap(std::size_t patch) const { return gap_[patch]; }                ///< average, positive when open
  std::span<const double> gaps() const { return gap_; }                      ///< likewise, of all patches
  /// At an integration point, infinite without any; those of masters that are seen by a ten thousandth of the patch do not
  /// count.
  double smallest_gap(std::size_t patch) const { return smallest_gap_[patch]; }
  /// Length of a patch, in space the root of its area, at the initial geometry.
  const std::vector<double>& sizes() const { return size_; }
  std::span<const double> measures() const { return covered_; }          ///< covered(), of all patches
  double covered(std::size_t patch) const { return covered_[patch]; }    ///< measure, current geometry
  double whole(std::size_t patch) const { return whole_[patch]; }        ///< measure, current geometry
  double coverage(std::size_t patch) const { return coverage_[patch]; }  ///< covered over whole
  /// Whether walls beside what is in front of it are left out (left_out.cpp).
  bool is_beside_wall(std::size_t patch) const { return beside_wall_[patch]; }
  /// How many couples pairing rejected, for each `Rejection`, summed over the zones.
  std::span<const std::int64_t> rejected() const { return rejected_; }
  const TooDeep& too_deep(std::size_t zone) const { return too_deep_[zone]; }

 private:
  struct Alike;
  struct Block;
  /// update() at the present coordinates.
  void look(std::vector<ZonePairing>* records = nullptr);
  /// What is to be left out of what `cells_` has. @param before what is or was
  LeftOut to_leave_out(const LeftOut& before) const;
  /// Of the angle between a slave's normal and the opposite of a master's.
  /// @param slave index into Contact::slaves @param master cell of the mesh
  double facing_cosine(std::int32_t slave, std::int32_t master, std::span<const double> coordinates) const;
  /// Whether, of what patches look at, walls have turned to face them since that was decided, or others have turned away.
  bool walls_have_turned() const;
  const Zone& zone_of(const Cell& cell) const;
  /// The first master of the face that a contact cell lies on.
  std::int32_t face_of(const Cell& cell) const;
  /// Whether other faces in front, instead of those as now, may change `cells_`.
  bool other_walls(const std::set<PatchMaster>& in_front) const;
  /// From the next look() on.
  void leave_out(LeftOut what);
  /// Whether at an edge of a master the skin ends for a slave cell, or goes on with what is far behind, or with a wall.
  /// @param slave, master cells of the zone
  bool ends_at(const Zone& zone, std::size_t slave, std::size_t master, int edge) const;
  /// The bodies are at rest. @param same_rest where they last were: instants begin again as they did
  void keep_left_out(bool same_rest);
  /// Gaps and couplings of the contact cells of a block. @param[in,out] groups gets a group of each kind, some of them perhaps
  /// empty
  void integrate(const Zone& zone, const ContactCells& cells, std::vector<Alike>& groups) const;
  /// The same for cells of one kind.
  void evaluate(const Zone& zone, const ContactCells& cells, Alike& group) const;
  /// Whether a patch and its masters are one surface: gaps are zero all over, so that neither borders nor turning normals
  /// change their integral.
  bool coincides(std::size_t patch) const;
  Variation frozen_variation(const Cell& cell) const;
  /// Take the offset off gaps that a kernel gave. @param batch as the kernel had it
  void offset_gaps(std::size_t zone, const ContactCells& cells, lacon_contact_batch batch, Alike& group) const;
  bool has_offset(std::size_t zone) const { return zone < offsets_.size() && !offsets_[zone].empty(); }
  /// One of the contact cells of a zone, paired with traces; by the slave's nodal normals too. @param still the cover keeps its
  /// place
  Variation variation(std::size_t zone, const Pairing& found, std::size_t place, bool second, bool still) const;
  /// Nodal normals hang on the nodes around: the slave's own nodes, those, then the others. @param slave cell of the zone
  void chain_normals(std::size_t zone, std::size_t slave, Variation& variation) const;
  /// Sum up what the kernels gave.
  void add(const Zone& zone, const Block& block_of_zone, ZonePairing* record);
  /// What a kernel says of a slave cell.
  void note(std::int32_t error, const SlaveElement& slave);
  [[noreturn]] void no_normal(const SlaveElement& slave) const;  ///< throws EVOLUTION_3
  /// Masters go on where slaves still ended in their planes when they were at rest.
  void mirror();
  /// Surface::mirrored of a zone, with what is flush.
  void add_flush(Zone& zone);
  /// Measures of whole patches, in the measure of the kernels' coverage (with r in axisymmetry).
  void measure_slaves();
  /// The contact kernel of a slave cell's element.
  const lacon_kernel& kernel_of(std::int32_t cell) const;

  const Mesh& mesh_;
  const Model& model_;
  const Contact& contact_;
  Registry& registry_;
  std::map<std::int32_t, const lacon_kernel*> kernels_;  ///< of the slaves' elements
  std::vector<double> coordinates_;                      ///< (n_nodes, 3), current
  std::vector<double> rest_;                             ///< likewise, at rest
  std::vector<double> walls_at_;                         ///< walls_decided_at()
  std::vector<std::int32_t> body_;                       ///< (n_nodes): Bodies::of
  Surface boundary_;                                     ///< of the bodies: boundary_of()
  std::vector<Zone> zones_;
  std::vector<std::vector<double>> normals_;  ///< of each zone, at the nodes (LISSAGE)
  std::vector<std::vector<double>> offsets_;  ///< likewise
  std::vector<NormalVariation> normal_variations_;
  std::vector<Cell> cells_;
  std::vector<double> coupling_;
  std::vector<double> size_, gap_, weight_, covered_, whole_, coverage_, smallest_gap_;  ///< of each patch
  std::vector<double> largest_gap_;                           ///< likewise, either way, at all points
  std::vector<std::uint8_t> straight_;                        ///< likewise: no cell is of the second order
  std::vector<std::pair<std::int32_t, std::int32_t>> walls_;  ///< left out: index into Contact::slaves, cell of the mesh
  std::vector<bool> beside_wall_;                             ///< (n_patches): whether it would see one of these
  std::vector<std::int32_t> zone_of_;
  std::vector<std::int64_t> rejected_;
  std::vector<TooDeep> too_deep_;          ///< of each zone
  LeftOut left_out_, left_out_at_rest_;    ///< choose_masters(): now, and when the bodies were at rest
  bool cuts_end_ = true;                   ///< with the next update()
  std::optional<std::int32_t> over_axis_;  ///< a slave cell with a negative radius
};

}  // namespace lacon
