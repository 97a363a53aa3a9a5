#pragma once
// Pairing of two surfaces: which part of which slave cell sees which master cell, and where its integration points go.
// METHOD.md 3.3 and 3.4.1; what is decided otherwise here, and why, is in README.md.
#include <algorithm>
#include <array>
#include <compare>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "lacon/elements/contact_cells.hpp"
#include "lacon/pairing/steepness.hpp"
#include "lacon/pairing/surface.hpp"

namespace lacon {

class WaysWhenAsked;

/// Every tolerance of pairing. All are dimensionless.
struct PairingTolerances {
  double sliver = 1e-14;      ///< a contact cell is dropped below this fraction of its slave cell
  double degenerate = 1e-12;  ///< a cell is degenerate whose tangent is shorter than this, relative to its surface or to itself
  /// Of the slave cell: a line of a master that lies this near to an edge of the slave does not move what it bounds. The edge
  /// does: between both nothing is integrated, and whatever lies on their other side sees the edge too.
  double coincident = 1e-12;
  double box =
      1e-12;  ///< boxes of the search tree grow by this fraction of the master surface: round-off must not hide a couple
  double ray = 1e-11;  ///< an image must lie on the normal of its point to this fraction of the couple's extent
  // in space
  double flat = 1e-10;     ///< a facet is flat below this turn of the normal
  double straight = 1e-6;  ///< an edge is straight below this bulge over its length: also in a file of seven or eight digits
  /// Below this turn of the normal four triangles of a flat slave are enough: polygons are wrong by a tenth of it, in gaps.
  double nearly_flat = 1e-3;
  double overlap =
      1e-12;             ///< two masters hide one another where their polygons share more than this fraction of the slave cell
  double margin = 0.25;  ///< an image may lie outside its curved cell by this much of the reference cell
};

/// In space: how the polygon of a contact cell hangs on the nodes, for whoever differentiates it. It lies in a triangle of the
/// slave's chart; places in it are barycentric coordinates of the second and third vertex. Without vertices it need not be
/// known: what the polygons of a slave cell do adds up to nothing, and points may keep their places on the slave.
struct PolygonTrace {
  /// What an edge lies on: an edge of the triangle, or the side on which the slave's normals pass a line of a master.
  struct Line {
    std::int32_t master = -1;  ///< cell of the master surface; -1: the triangle's own edge, from vertex `edge` on
    int edge = 0;
    std::array<double, 2> from{}, to{};  ///< reference coordinates of the line's ends on the master
  };
  bool plane = true;                                ///< the chart is the slave's mean plane, otherwise its reference cell
  std::array<std::array<double, 2>, 3> triangle{};  ///< reference coordinates of its vertices on the slave
  std::vector<std::array<double, 2>> vertex;        ///< of the polygon
  std::vector<Line> line;                           ///< from each vertex to the next
  /// Of each integration point: it lies in the triangle of the vertices 0, last - 1 and last, at these coordinates.
  struct Point {
    std::int32_t last;
    double r, s;
    double weight;  ///< of the rule, times the couple's share: the point's own has the triangle's area, which may be zero, as
                    ///< factor
  };
  std::vector<Point> point;
};

/// A master is a wall for a slave where the cosine between the slave's normal and the opposite of the master's is less: 60
/// degrees off facing it, or more, whatever round-off makes of teeth that have this angle. A face goes over into another one by
/// as much (free_ends.hpp).
inline constexpr double wall_cosine = 0.502;

/// A slave cell and a master cell, by their numbers in the two surfaces.
struct Couple {
  std::int32_t slave, master;

  auto operator<=>(const Couple&) const = default;
};

struct PairingOptions {
  PairingTolerances tolerances;
  bool brute_force = false;  ///< try every couple instead of searching: the oracle of the tests
  /// Largest |gap| in the middle of what a couple has in common, in diameters of the larger of its two cells (COEF_MULT_APPA);
  /// not positive: no limit. What both cells have moved since Surface::rest comes on top.
  double distance_limit = -1;
  /// Likewise of an overlap alone, where distances have no limit, behind which normals reach through a body; not positive: no
  /// limit. It is multiplied by the cosine of the angle between both normals: a wall is met inside a body only by who looks
  /// through it. Of two bodies whose thickness is known (Surface::thickness) it is no more than half of both together, or half
  /// a diameter. What the couple has come closer along the normal of either since Surface::rest comes on top.
  double depth_limit = -1;
  /// Likewise of couples of one body (Surface::body) whose master lay behind the slave by more than that at rest: it is the
  /// other side of the body, seen through it. Not positive: no such limit.
  double own_depth_limit = 0.25;
  /// Couples that give no contact cell, sorted: masters that lie far behind others of the same patch. The caller owns them.
  std::span<const Couple> left_out = {};
  /// Of each slave cell the faces of the master that are in front of it, as `faces` numbers them; null: unknown. Where there
  /// are some it gets no contact cell with masters of other faces that were walls (was_wall()). The caller owns both.
  const Ragged<std::int32_t>* in_front = nullptr;
  std::span<const std::int32_t> faces = {};  ///< of each master cell
  /// Ways through bodies at the present coordinates, by their whole skins, with Surface::body; null: by what both skins are of
  /// these. The caller owns them.
  const WaysWhenAsked* ways = nullptr;
  /// Angle between the slave's normal and the opposite of the master's, in degrees, from which on a couple counts less and less
  /// (steepness.hpp); 90: none does.
  double steep_angle = 85;
  /// Drop slivers of a slave cell that see masters far away, past the ends of others that are near (detail::drop_past_ends). No
  /// use where gaps are not differentiated: there they do no harm, and a gap leaps where one goes.
  bool drops_slivers = true;
  /// In space: integrate every couple to this degree whatever its facets ask for (integration_degree() in
  /// chart_points.hpp); 0: what they ask for. To measure what a degree leaves.
  int degree = 0;
  /// Width of the band at both ends of a slave cell in which its cover ends slowly (fading.hpp), in reference coordinates; 0:
  /// no such band. Ends that lie inside of a patch have none: what one cell of it loses there the next one loses as well.
  double fading = 0;
  bool traced = false;  ///< in space: give the traces too. Flat slaves are then cut as those that are nearly flat
};

/// Whether a master was a wall for a slave where that was decided (Surface::walls).
bool was_wall(const Surface& slave, std::size_t slave_cell, const Surface& master, std::size_t master_cell);

/// The cosine of `steep_angle`, exactly 0 for 90 degrees.
double steep_cosine(const PairingOptions& options);

/// Why a couple of cells that see each other gives no contact cell, or a smaller one.
enum class Rejection : std::uint8_t {
  facing_away,        ///< n_e . n_m >= 0: the master shows its back
  hidden,             ///< all or a part of it lies behind another master that is nearer along the normal, or behind a body
  sliver,             ///< smaller than PairingTolerances::sliver, or than next to nothing past the end of what is near
  degenerate_slave,   ///< slave cells (not couples) without a normal: zero length, folded, coordinates not finite
  degenerate_master,  ///< master cells (not couples) of zero length or with coordinates that are not finite
  no_image,           ///< an integration point has no image on the master along the slave's normal
  too_far,            ///< beyond PairingOptions::distance_limit
  too_steep,          ///< its share is nothing: PairingOptions::steep_angle
  too_deep,           ///< an overlap beyond that, or beyond PairingOptions::depth_limit
  other_side,         ///< an overlap beyond PairingOptions::own_depth_limit
  far_behind,         ///< PairingOptions::left_out
  wall                ///< PairingOptions::in_front
};
inline constexpr int n_rejections = 12;
std::string_view rejection_name(Rejection rejection);

/// A couple that pairing gave up, or a part of it. A degenerate cell stands alone: the other one is -1.
struct RejectedCouple {
  std::int32_t slave = -1, master = -1;  ///< cells of the two surfaces
  Rejection reason{};

  auto operator<=>(const RejectedCouple&) const = default;
};

struct Pairing {
  /// `slave` and `master` number the cells of the two surfaces. Sorted by slave cell, then along it.
  ContactCells cells;
  std::vector<PolygonTrace> traces;  ///< of each contact cell, where PairingOptions::traced asks for them
  /// Every couple once for each reason; sorted.
  std::vector<RejectedCouple> rejected;

  /// Put another one, of later slave cells, behind.
  void append(const Pairing& other);

  std::int64_t count(Rejection reason) const {
    return std::count_if(rejected.begin(), rejected.end(), [&](const RejectedCouple& r) { return r.reason == reason; });
  }
};

/// Pair two surfaces of the same dimension: SEG2 and SEG3 in the plane, TRIA3, TRIA6, QUAD4, QUAD8 and QUAD9 in space. The
/// result does not depend on the order of cells or nodes, and has the same bits in every run. On one slave cell contact cells
/// never overlap; where masters cover it they leave no gap. Throws std::invalid_argument for other cells and for dimensions
/// that differ.
Pairing pair(const Surface& slave, const Surface& master, const PairingOptions& options = {});

/// The same in parts, for memory that does not grow with the skins and for several threads: masters are examined once, then any
/// range of slave cells can be paired.
class PairingInParts {
 public:
  /// The surfaces must outlive it, and stay as they are. Throws as pair().
  PairingInParts(const Surface& slave, const Surface& master, const PairingOptions& options = {});
  ~PairingInParts();
  PairingInParts(const PairingInParts&) = delete;
  PairingInParts& operator=(const PairingInParts&) = delete;

  /// What pair() finds for the slave cells first <= i < last; degenerate masters come with cell 0. Several threads may call
  /// this at a time. @param[out] found its memory is used again
  /// @param order of the derivatives that traces are for: 1, or 2 for second ones too
  void pair(std::size_t first, std::size_t last, Pairing& found, int order = 2);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace lacon
