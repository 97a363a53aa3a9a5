// Pairing in space.
#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>

#include "lacon/pairing/chart_points.hpp"
#include "lacon/pairing/masters.hpp"
#include "lacon/pairing/target.hpp"

// The normal of the slave at xi passes a directed edge (a, b) of a master on the side that the sign of
//     s(xi) = ((b - a) x n(xi)) . (x_e(xi) - a)
// tells; it crosses a convex master that faces the slave where s >= 0 for all its edges. So a slave is cut into convex pieces
// of a *chart* (slave_facet.hpp), s is an affine function on each piece, and a master keeps what half-planes leave of it. Two
// masters that share an edge have the same s but for the sign, to the last bit. Nothing is projected onto an extrapolated
// slave.

namespace lacon {
namespace {

using namespace space;

/// The master skin, and what is kept of each of its facets.
struct MastersInSpace {
  std::vector<FacetKind> facets;  ///< filled while `skin` examines them
  detail::Masters<3> skin;

  MastersInSpace(const Surface& slave, const Surface& master, const PairingOptions& options,
                 std::vector<RejectedCouple>& rejected)
      : facets(master.size()),
        skin(slave, master, options, rejected,
             [this, &master, &options, polygon = std::vector<Vec3>()](std::size_t cell, double size) mutable {
               return examine(master, cell, size, options, polygon);
             }) {}

 private:
  std::optional<Box<3>> examine(const Surface& master, std::size_t cell, double size, const PairingOptions& options,
                                std::vector<Vec3>& polygon) {
    const PairingTolerances& tolerances = options.tolerances;
    const Facet f = detail::finite(master, cell) ? facet(master, cell, tolerances.straight, options.traced) : Facet{};
    facets[cell] = f;
    const Map3::Value at = f.x({0, 0});
    if (!(f.size > tolerances.degenerate * size) || !(norm(f.normal) > 0) ||
        !(std::abs(dot(cross(at.d1, at.d2), f.normal)) > tolerances.degenerate * f.size * f.size))
      return std::nullopt;
    Box<3> box = Box<3>::empty();
    outline(f, f.nodes, polygon);
    polygon.push_back(f.x(probes(f.family).back()).x);
    for (const Vec3 p : polygon) {
      const Vec3 x = p + f.origin;
      box.add(std::array{x.x, x.y, x.z}.data());
    }
    return box;
  }
};

class PairerInSpace final : public detail::CellPairer {
 public:
  explicit PairerInSpace(std::shared_ptr<const MastersInSpace> masters) : masters_(std::move(masters)) {}

  void pair(std::size_t cell, Pairing& found, int order) override {
    slave_ = static_cast<std::int32_t>(cell);
    found_ = &found;
    e.set(masters_->skin.slave, cell, masters_->skin.slave_extent, tolerances());
    if (e.degenerate) {
      reject(-1, Rejection::degenerate_slave);
      return;
    }
    mean_normal_ = mean_normal();
    if (!options().traced || !e.whole() || !is_smooth_over_whole(order)) find_kept(options().traced);
    for (const View* const view : kept) integrate(*view);
  }

 private:
  const PairingOptions& options() const { return masters_->skin.options; }
  const PairingTolerances& tolerances() const { return masters_->skin.options.tolerances; }
  const FacetKind& master(std::int32_t m) const { return masters_->facets[static_cast<std::size_t>(m)]; }
  Nodes nodes_of_master(std::int32_t m) const {
    return nodes_of(masters_->skin.master, static_cast<std::size_t>(m), e.f.origin);
  }
  void reject(std::int32_t m, Rejection reason) { found_->rejected.push_back({slave_, m, reason}); }

  View* new_view(std::int32_t piece, std::int32_t m, double far = 0) {
    if (n_stored == store.size()) store.emplace_back();
    View& view = store[n_stored++];
    view.piece = piece;
    view.master = m;
    view.far = far;
    return &view;
  }

  /// What of the slave sees which master. @return whether one of them hides another
  bool find_kept(bool traced) {
    traced_ = traced;
    e.lay_out(traced);
    sliver_ = tolerances().sliver * e.chart_area;
    edges_.clear();
    find_views();
    drop_far_views();
    return keep_nearest();
  }

  /// Whether the integral over a whole slave, flat and under flat masters, has the derivatives that it has in triangles:
  /// masters cover all of it and are one surface there, so that the gap is the same on both sides of each line that divides the
  /// slave. Such lines do not change the integral where they move, to first order; to second order neither if masters lie in
  /// one plane.
  bool is_smooth_over_whole(int order) {
    if (find_kept(false) || kept.empty()) return false;
    constexpr double round_off = 1e-12, least_convex = 0.9;
    double covered = 0;
    const FacetKind& first = master(kept[0]->master);
    const Vec3 origin = nodes_of_master(kept[0]->master)[0];
    for (const View* const view : kept) {
      const FacetKind& f = master(view->master);
      covered += double_area(view->region.polygon);
      if (!f.straight || !f.plane || f.mirrored != 0 || f.order != first.order || f.distortion > least_convex ||
          share(view->master) < 1)
        return false;
      const Nodes nodes = nodes_of_master(view->master);
      for (int i = 0; i < f.n_vertices; ++i)
        if (order > 1 && std::abs(dot(first.normal, nodes[i] - origin)) > round_off * f.size) return false;
    }
    if (std::abs(covered - e.chart_area) > round_off * e.chart_area) return false;
    return std::none_of(kept.begin(), kept.end(), [&](const View* view) { return is_open_inside(view->master); });
  }

  /// Whether an edge of a master passes through the slave, and no other master that is kept goes on behind it.
  bool is_open_inside(std::int32_t m) const {
    const auto& skin = masters_->skin.master.nodes;
    const auto vertices = [&](std::int32_t of) {
      return skin[static_cast<std::size_t>(of)].first(static_cast<std::size_t>(master(of).n_vertices));
    };
    const auto own = vertices(m);
    const Nodes nodes = nodes_of_master(m);
    for (std::size_t i = 0; i < own.size(); ++i) {
      const std::size_t next = (i + 1) % own.size();
      const auto goes_on = [&](const View* other) {
        const auto its = vertices(other->master);
        for (std::size_t k = 0; k < its.size(); ++k)
          if (its[k] == own[next] && its[(k + 1) % its.size()] == own[i]) return true;
        return false;
      };
      if (std::none_of(kept.begin(), kept.end(), goes_on) && passes_through(nodes[i], nodes[next])) return true;
    }
    return false;
  }

  /// Whether a line lies in part within the slave, which is one flat piece.
  bool passes_through(Vec3 a, Vec3 b) const {
    const Vec2 from{dot(a, e.e1), dot(a, e.e2)}, to{dot(b, e.e1), dot(b, e.e2)};
    const Polygon& border = e.pieces[0].polygon;
    double enters = 0, leaves = 1;
    for (std::size_t i = 0; i < border.size(); ++i) {
      const Vec2 along = border[(i + 1) % border.size()] - border[i];
      const double least = tolerances().coincident * e.chart_diameter * norm(along),
                   at_first = cross(along, from - border[i]) - least, at_last = cross(along, to - border[i]) - least;
      if (at_first <= 0 && at_last <= 0) return false;
      if (at_first < 0) enters = std::max(enters, at_first / (at_first - at_last));
      if (at_last < 0) leaves = std::min(leaves, at_first / (at_first - at_last));
    }
    return enters < leaves;
  }

  /// Every part of the slave that sees a master, whatever lies in front of it.
  void find_views() {
    views.clear();
    n_stored = 0;
    masters_->skin.visit([&](const Box<3>& box) { return e.touches(box); }, [&](std::int32_t m) { look_at(m); });
  }

  void look_at(std::int32_t m) {
    FacetKind f = master(m);
    if (!traced_ && f.straight) f.whole_edge.fill(true);
    cut_in_parts(f, nodes_of_master(m), e, polygon, parts);
    find_pieces_near();
    if (near_.empty()) return;
    if (traced_) name_edges(m);
    bool couples = false, away = false, thin = false;
    for (const Part& part : parts) {
      const Vec3 area = area_vector(part);
      const Extent extent(part);
      for (const std::size_t p : near_) {
        const Piece& piece = e.pieces[p];
        if (!piece.reach.touches(extent.centre, extent.half)) continue;
        const bool faces = dot(area, piece.normal) < 0;
        if (faces || !e.constant) {
          see(e, piece, part, true, seen, scratch);
          if (double_area(seen.polygon) > sliver_) {
            couples = true;
            if (!(share(m) > tolerances().sliver)) {
              reject(m, Rejection::too_steep);
            } else {
              views.push_back(new_view(static_cast<std::int32_t>(p), m));
              std::swap(views.back()->region, seen);
            }
            continue;
          }
          thin = thin || !seen.polygon.empty();
        }
        if (faces || away || couples) continue;
        see(e, piece, part, false, seen, scratch);
        away = double_area(seen.polygon) > sliver_;
      }
    }
    if (!couples && away) reject(m, Rejection::facing_away);
    if (!couples && !away && thin) reject(m, Rejection::sliver);
  }

  /// The box around parts: its middle, and the halves of its sides.
  struct Extent {
    Vec3 centre, half;

    explicit Extent(std::span<const Part> parts) {
      Box<3> box = Box<3>::empty();
      for (const Part& part : parts)
        for (int i = 0; i < part.n; ++i) box.add(std::array{part.p[i].x, part.p[i].y, part.p[i].z}.data());
      const Vec3 low{box.low[0], box.low[1], box.low[2]}, high{box.high[0], box.high[1], box.high[2]};
      centre = 0.5 * (low + high), half = 0.5 * (high - low);
    }
    explicit Extent(const Part& part) : Extent(std::span(&part, 1)) {}
  };

  /// The pieces whose normals may meet some part of the master at hand.
  void find_pieces_near() {
    near_.clear();
    const Extent extent(parts);
    for (std::size_t p = 0; p < e.pieces.size(); ++p)
      if (e.pieces[p].reach.touches(extent.centre, extent.half)) near_.push_back(p);
  }

  double share(std::int32_t m) const { return share_of_couple(cosine(m), masters_->skin.steep).value; }
  /// Of the angle between the mean normal of the slave and the opposite of the master's.
  double cosine(std::int32_t m) const { return -dot(mean_normal_, master(m).normal); }

  /// Of the slave's outline, or of its nodal normals.
  Vec3 mean_normal() const {
    const Surface& slave = masters_->skin.slave;
    if (slave.normals.empty()) return e.n;
    Vec3 sum{};
    for (const std::int32_t node :
         slave.nodes[static_cast<std::size_t>(slave_)].first(static_cast<std::size_t>(e.f.n_vertices)))
      sum = sum + vector_at(slave.normals.data() + 3 * static_cast<std::size_t>(node));
    return (1 / norm(sum)) * sum;
  }

  /// Remember the edges of the parts of a master, and let their half-planes know them.
  void name_edges(std::int32_t m) {
    const FacetKind& f = master(m);
    outline_places(f, outline_places_);
    const Vec2 centre = probes(f.family).back();
    const auto place = [&](const Part& part, int i) {
      const std::int32_t at = part.place[static_cast<std::size_t>(i % part.n)];
      const Vec2 eta = at < 0 ? centre : outline_places_[static_cast<std::size_t>(at)];
      return std::array{eta.x, eta.y};
    };
    for (Part& part : parts)
      for (int i = 0; i < part.n; ++i) {
        part.line[static_cast<std::size_t>(i)] = static_cast<std::int32_t>(edges_.size());
        edges_.push_back({.master = m, .edge = 0, .from = place(part, i), .to = place(part, i + 1)});
      }
  }

  /// The gap at a point of a view, or infinity where there is no image.
  double gap(const View& view, Vec2 y) const {
    const SlaveFacet::Place place = e.place(y, tolerances());
    const Target target(master(view.master), nodes_of_master(view.master), e);
    const std::optional<Vec2> image = place.found ? target.image(y, place.xi, tolerances()) : std::nullopt;
    return image ? target.gap(place.xi, *image) : std::numeric_limits<double>::infinity();
  }

  void drop_far_views() {
    const double own = diameter(e.f.nodes, e.f.n_vertices);
    std::erase_if(views, [&](View* view) {
      const Surface &slave_skin = masters_->skin.slave, &master_skin = masters_->skin.master;
      const auto slave_cell = static_cast<std::size_t>(slave_), master_cell = static_cast<std::size_t>(view->master);
      if (const auto reason = detail::left_out(options(), slave_skin, slave_cell, master_skin, master_cell)) {
        reject(view->master, *reason);
        return true;
      }
      const Nodes nodes = nodes_of_master(view->master);
      const double other = diameter(nodes, master(view->master).n_vertices);
      const detail::CoupleSize size =
          detail::size_of(slave_skin, slave_cell, master_skin, master_cell, std::max(own, other), cosine(view->master));
      // the way from x_e to its image by the first nodes; a quadratic cell may bulge
      const auto reach = [](const FacetKind& f) { return (f.order == 1 ? 1 : 1.25) * f.size; };
      const double largest = norm(nodes[0] - e.f.nodes[0]) + reach(e.f) + reach(master(view->master));
      if (detail::within_limits(options(), largest, size)) return false;
      const Vec2 y = middle(view->region.polygon);
      const double found = gap(*view, y);
      if (!std::isfinite(found)) return false;
      const Vec3 n = mean_normal_, m = master(view->master).normal;
      const double moved = detail::give_way(options(), slave_skin, slave_cell, master_skin, master_cell,
                                            {.slave = {n.x, n.y, n.z}, .master = {m.x, m.y, m.z}});
      auto limit = detail::beyond_limits(options(), found, size, moved);
      if (detail::may_be_through_bodies(options(), found, size, moved)) view->far = found;
      if (!limit && view->far < 0 && is_through_bodies(*view)) limit = Rejection::too_deep;
      if (limit) reject(view->master, *limit);
      return limit.has_value();
    });
  }

  double share(const View& view) const { return double_area(view.region.polygon) / e.chart_area; }

  /// Of a view that is far away.
  bool is_through_bodies(const View& view) const {
    const Vec2 xi = e.place(middle(view.region.polygon), tolerances()).xi;
    return masters_->skin.is_through_bodies(share(view), static_cast<std::size_t>(slave_), e.f.origin + e.f.x(xi).x,
                                            e.direction(xi), static_cast<std::size_t>(view.master), view.far);
  }

  /// Where several masters cover a part of the slave, the nearest along the normal keeps it. @return whether there are such
  bool keep_nearest() {
    std::sort(views.begin(), views.end(), sooner);
    kept.clear();
    bool any_hidden = false;
    for (View* const first : views) {
      todo.assign(1, first);
      while (!todo.empty()) {
        View* const view = todo.back();
        todo.pop_back();
        if (stays_whole(*view, any_hidden)) kept.push_back(view);
      }
    }
    if (options().drops_slivers)
      detail::drop_past_ends(
          kept, [](const View* v) { return v->far; }, [&](const View* v) { return share(*v); },
          [&](const View* v) { return is_through_bodies(*v); }, [&](const View* v, Rejection why) { reject(v->master, why); });
    if (any_hidden) std::sort(kept.begin(), kept.end(), sooner);
    return any_hidden;
  }

  /// Settle a view with those that are kept: where it is the nearer one they give way; where it is not, what is left of it goes
  /// to `todo`.
  bool stays_whole(const View& view, bool& any_hidden) {
    const double overlap = tolerances().overlap * e.chart_area;
    const double strip = 0.25 * overlap / e.chart_diameter;  // a common strip of this width is less than `overlap`
    for (std::size_t k = 0; k < kept.size(); ++k) {
      const View& old = *kept[k];
      if (old.piece != view.piece || separated(old.region, view.region, strip)) continue;
      const Region both = intersection(old.region, view.region);
      if (double_area(both.polygon) <= overlap) continue;
      const Vec2 y = middle(both.polygon);
      const auto candidate = [&](const View& other) {
        return detail::Candidate{other.master, gap(other, y), master(other.master).size};
      };
      const bool old_wins = detail::comes_before(masters_->skin.master, candidate(old), candidate(view), e.f.size);
      const View &winner = old_wins ? old : view, &loser = old_wins ? view : old;
      reject(loser.master, Rejection::hidden);
      any_hidden = true;
      left.clear();
      subtract(loser.region, winner.region, sliver_, left);
      if (!old_wins) kept.erase(kept.begin() + static_cast<std::ptrdiff_t>(k));
      for (Region& region : left) {
        View* const part = new_view(loser.piece, loser.master, loser.far);
        std::swap(part->region, region);
        if (old_wins)
          todo.push_back(part);
        else
          kept.insert(kept.begin() + static_cast<std::ptrdiff_t>(k++), part);
      }
      if (old_wins) return false;
      --k;  // wraps at 0, and the loop steps back to it
    }
    return true;
  }

  /// Integration points of a view and their images: a contact cell, if all of them have one.
  void integrate(const View& view) {
    const FacetKind& f = master(view.master);
    const Target target(f, nodes_of_master(view.master), e);
    const bool in_one = options().traced && !traced_;
    const int degree = options().degree > 0 ? options().degree
                       : in_one
                           ? integration_degree(e, f) + of_derivatives(e.f.type, f.type, !masters_->skin.slave.normals.empty())
                           : integration_degree(e, f);
    place_points(view.region.polygon, degree, exact_polygons(e, f), traced_, points);
    const std::size_t n_points = points.weight.size();
    points.y.insert(points.y.end(), view.region.polygon.begin(), view.region.polygon.end());  // vertices behind them
    e.places(points.y, tolerances(), lines, meetings, places);
    target.images(std::span(points.y).first(n_points), places, tolerances(), lines, images);
    if (!std::all_of(places.begin(), places.end(), [](const SlaveFacet::Place& place) { return place.found; }) ||
        !std::all_of(images.begin(), images.end(), [](const Meeting& image) { return image.found; })) {
      reject(view.master, Rejection::no_image);
      return;
    }
    append_cell(view.master, n_points);
    if (traced_)
      trace(view);
    else if (options().traced)
      found_->traces.emplace_back();
  }

  /// What the polygon of a view hangs on.
  void trace(const View& view) {
    const Piece& piece = e.pieces[static_cast<std::size_t>(view.piece)];
    const Polygon &corners = view.region.polygon, &triangle = piece.polygon;
    PolygonTrace& trace = found_->traces.emplace_back();
    trace.plane = e.plane;
    for (std::size_t k = 0; k < 3; ++k) trace.triangle[k] = {piece.xi[k].x, piece.xi[k].y};
    const auto within = [](Vec2 y, Vec2 origin, Vec2 u, Vec2 v) {
      const double area = cross(u, v);
      return area == 0 ? std::array{0.0, 0.0} : std::array{cross(y - origin, v) / area, cross(u, y - origin) / area};
    };
    for (const Vec2 y : corners)
      trace.vertex.push_back(within(y, triangle[0], triangle[1] - triangle[0], triangle[2] - triangle[0]));
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const Vec2 from = corners[k], to = corners[(k + 1) % corners.size()];
      // the line that both ends are nearest to
      double least = std::numeric_limits<double>::infinity();
      PolygonTrace::Line& line = trace.line.emplace_back();
      for (int i = 0; i < 3; ++i) {
        const Vec2 along = triangle[(static_cast<std::size_t>(i) + 1) % 3] - triangle[static_cast<std::size_t>(i)],
                   a = triangle[static_cast<std::size_t>(i)];
        const double distance = std::max(std::abs(cross(along, from - a)), std::abs(cross(along, to - a))) / norm(along);
        if (distance < least) least = distance, line = {.master = -1, .edge = i};
      }
      const double coincident = tolerances().coincident * e.chart_diameter;
      if (least <= coincident) continue;
      // where a line of another master coincides with one of its own, as of masters that lie mirrored to each other, the edge
      // moves with its own one: so does the part of this master on the other side
      bool own = false;
      for (const HalfPlane& half : view.region.halves) {
        const double distance = std::max(std::abs(half(from)), std::abs(half(to))) / norm(half.slope);
        const PolygonTrace::Line& candidate = edges_[static_cast<std::size_t>(half.line)];
        const bool is_own = candidate.master == view.master && distance <= coincident;
        if (own ? is_own && distance < least : is_own || distance < least) least = distance, line = candidate, own = is_own;
      }
    }
    const double counted = share(view.master);
    for (const ChartPoints::InFan& point : points.fan)
      trace.point.push_back({point.last, point.r, point.s, point.weight * counted});
  }

  /// @param n_points of `places`, the others are vertices
  void append_cell(std::int32_t m, std::size_t n_points) {
    ContactCells& cells = found_->cells;
    const std::size_t n_before = cells.weight.size();
    cells.slave_point.resize(2 * (n_before + n_points));
    cells.master_point.resize(2 * (n_before + n_points));
    cells.weight.resize(n_before + n_points);
    const double counted = share(m);
    std::size_t at = 2 * n_before;
    for (std::size_t i = 0; i < n_points; ++i, at += 2) {
      const Vec2 xi = places[i].xi, eta = images[i].xi;
      cells.slave_point[at] = xi.x, cells.slave_point[at + 1] = xi.y;
      cells.master_point[at] = eta.x, cells.master_point[at + 1] = eta.y;
      cells.weight[at / 2] = points.weight[i] * places[i].scale * counted;
    }
    for (const SlaveFacet::Place& place : std::span(places).subspan(n_points)) {
      cells.vertex.push_back(place.xi.x);
      cells.vertex.push_back(place.xi.y);
    }
    cells.slave.push_back(slave_);
    cells.master.push_back(m);
    cells.offset.push_back(static_cast<std::int64_t>(cells.weight.size()));
    cells.vertex_offset.push_back(static_cast<std::int64_t>(cells.vertex.size() / 2));
  }

  std::shared_ptr<const MastersInSpace> masters_;
  // of the slave cell at hand
  std::int32_t slave_ = -1;
  bool traced_ = false;  ///< it is cut as derivatives by polygons ask for
  Pairing* found_ = nullptr;
  SlaveFacet e;
  double sliver_ = 0;   ///< double area below which nothing is kept
  Vec3 mean_normal_{};  ///< unit
  // used again for every slave cell
  std::vector<Vec3> polygon;
  std::vector<Part> parts;
  std::vector<std::size_t> near_;
  std::deque<View> store;
  std::size_t n_stored = 0;
  std::vector<View*> views, kept, todo;
  std::vector<Region> left;
  Region seen;
  Polygon scratch;
  ChartPoints points;
  std::vector<Line> lines;
  std::vector<Meeting> meetings, images;
  std::vector<SlaveFacet::Place> places;
  std::vector<PolygonTrace::Line> edges_;  ///< of masters that were looked at, where traces are wanted
  std::vector<Vec2> outline_places_;
};

}  // namespace

detail::MakeCellPairer detail::pair_in_space(const Surface& slave, const Surface& master, const PairingOptions& options,
                                             std::vector<RejectedCouple>& rejected) {
  return [masters = std::make_shared<const MastersInSpace>(slave, master, options, rejected)] {
    return std::make_unique<PairerInSpace>(masters);
  };
}

}  // namespace lacon
