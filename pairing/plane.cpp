// Pairing in the plane.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <tuple>
#include <utility>

#include "lacon/elements/reference.hpp"
#include "lacon/pairing/fading.hpp"
#include "lacon/pairing/masters.hpp"
#include "lacon/pairing/overlaps.hpp"
#include "lacon/pairing/polynomial.hpp"
#include "lacon/structures/vector.hpp"

// Everything rests on one function. T(xi) is the slave's tangent, or what is at a right angle to its interpolated nodal
// normal; for a point q
//     f_q(xi) = (q - x_e(xi)) . T(xi)
// is positive where q lies ahead of the normal through x_e(xi), and negative where it lies behind. That normal crosses a
// master cell of ends a, b, the master facing the slave, exactly where f_a >= 0 > f_b. f_q is a polynomial of degree 1 to 4,
// and its sign changes are computed from the slave cell and q alone: two masters that share a node share the end of their
// intervals bit by bit.

namespace lacon {
namespace {

/// Of a vector, without squares that overflow.
double length(Vec2 a) { return std::hypot(a.x, a.y); }

/// A polynomial of degree 2 in the plane.
struct Curve {
  int degree = 1;
  std::array<Vec2, 3> c{};
  Vec2 operator()(double xi) const { return c[0] + xi * (c[1] + xi * c[2]); }
};

/// Through the values at -1 and 1 and, in a quadratic cell, at 0.
Curve interpolate(std::span<const Vec2> values) {
  const Vec2 mean = 0.5 * (values[0] + values[1]);
  const Vec2 slope = 0.5 * (values[1] - values[0]);
  if (values.size() == 2) return {1, {mean, slope, {}}};
  return {2, {values[2], slope, mean - values[2]}};
}

Polynomial operator*(const Curve& a, const Curve& b) {
  Polynomial p;
  p.degree = a.degree + b.degree;
  for (int i = 0; i <= a.degree; ++i)
    for (int j = 0; j <= b.degree; ++j) p.c[i + j] += dot(a.c[i], b.c[j]);
  return p;
}

/// p on [-1, 1] lies within the range of these coefficients (Bernstein).
std::array<double, Polynomial::max_degree + 1> bernstein(const Polynomial& p) {
  static constexpr double binomial[5][5] = {{1}, {1, 1}, {1, 2, 1}, {1, 3, 3, 1}, {1, 4, 6, 4, 1}};
  // coefficients of p(2 t - 1) by Horner's scheme, then from powers of t to Bernstein's basis
  std::array<double, 5> t{};
  for (int k = p.degree; k >= 0; --k) {
    for (int i = p.degree; i >= 0; --i) t[i] = (i > 0 ? 2 * t[i - 1] : 0) - t[i];
    t[0] += p.c[k];
  }
  std::array<double, 5> b{};
  for (int i = 0; i <= p.degree; ++i)
    for (int k = 0; k <= i; ++k) b[i] += binomial[i][k] / binomial[p.degree][k] * t[k];
  return b;
}

Vec2 point(const Surface& surface, std::int32_t node) {
  return {surface.coordinates[3 * node], surface.coordinates[3 * node + 1]};
}

using detail::finite;

/// A slave cell, in coordinates whose origin is its middle: differences of large coordinates are taken once, and exactly alike
/// for every master.
struct SlaveCell {
  Vec2 origin;
  Curve x;               ///< x_e - origin
  Curve tangent;         ///< T; (T_y, -T_x) points along the outward normal
  Polynomial x_tangent;  ///< x . T

  Polynomial ahead(Vec2 q) const {
    const Curve constant{0, {q - origin, {}, {}}};
    Polynomial f = x_tangent;
    const Polynomial qt = constant * tangent;
    for (int k = 0; k <= f.degree; ++k) f.c[k] = (k <= qt.degree ? qt.c[k] : 0) - f.c[k];
    return f;
  }
};

SlaveCell slave_cell(const Surface& surface, std::size_t cell) {
  const auto nodes = surface.nodes[cell];
  std::array<Vec2, 3> x, t;
  SlaveCell slave;
  slave.origin = 0.5 * (point(surface, nodes[0]) + point(surface, nodes[1]));
  for (std::size_t i = 0; i < nodes.size(); ++i) x[i] = point(surface, nodes[i]) - slave.origin;
  slave.x = interpolate(std::span(x).first(nodes.size()));
  if (surface.normals.empty()) {
    slave.tangent = {slave.x.degree - 1, {slave.x.c[1], 2.0 * slave.x.c[2], {}}};
  } else {
    for (std::size_t i = 0; i < nodes.size(); ++i) t[i] = {-surface.normals[3 * nodes[i] + 1], surface.normals[3 * nodes[i]]};
    slave.tangent = interpolate(std::span(t).first(nodes.size()));
  }
  slave.x_tangent = slave.x * slave.tangent;
  return slave;
}

bool degenerate(const SlaveCell& slave, const Surface& surface, double size, double tolerance) {
  const Curve derivative{slave.x.degree - 1, {slave.x.c[1], 2.0 * slave.x.c[2], {}}};
  const double longest = std::max(length(slave.x.c[1]), length(slave.x.c[2]));
  if (!(longest > tolerance * size)) return true;
  const auto vanishes = [&](const Curve& c, double scale) { return !(minimum(c * c) > tolerance * tolerance * scale * scale); };
  return vanishes(derivative, longest) || (!surface.normals.empty() && vanishes(slave.tangent, 1));
}

/// Which boxes may hold a point that a normal of the slave cell passes: none of those that lie ahead, or behind, of all of
/// them.
class Strip {
 public:
  explicit Strip(const SlaveCell& slave) : origin_(slave.origin), n_(slave.x_tangent.degree + 1) {
    Polynomial tx, ty;
    tx.degree = ty.degree = slave.x_tangent.degree;
    for (int k = 0; k <= slave.tangent.degree; ++k) {
      tx.c[k] = slave.tangent.c[k].x;
      ty.c[k] = slave.tangent.c[k].y;
    }
    tx_ = bernstein(tx), ty_ = bernstein(ty), offset_ = bernstein(slave.x_tangent);
  }
  bool touches(const Box<2>& box) const {
    const double x = 0.5 * (box.low[0] + box.high[0]) - origin_.x, y = 0.5 * (box.low[1] + box.high[1]) - origin_.y;
    const double half_x = 0.5 * (box.high[0] - box.low[0]), half_y = 0.5 * (box.high[1] - box.low[1]);
    bool all_ahead = true, all_behind = true;
    for (int k = 0; k < n_; ++k) {
      const double f = x * tx_[k] + y * ty_[k] - offset_[k];
      const double range = half_x * std::abs(tx_[k]) + half_y * std::abs(ty_[k]);
      all_ahead = all_ahead && f > range;
      all_behind = all_behind && f < -range;
    }
    return !all_ahead && !all_behind;
  }

 private:
  Vec2 origin_;
  int n_;
  std::array<double, 5> tx_, ty_, offset_;
};

/// Sign changes of f_q by node, computed once for each slave cell.
class Projections {
 public:
  explicit Projections(std::size_t n_nodes) : stamp_(n_nodes, -1), at_(n_nodes) {}
  void start(std::int32_t slave) {
    slave_ = slave;
    found_.clear();
  }
  const SignChanges& of(const SlaveCell& slave, const Surface& master, std::int32_t node) {
    if (stamp_[node] != slave_) {
      stamp_[node] = slave_;
      at_[node] = found_.size();
      found_.push_back(sign_changes(slave.ahead(point(master, node))));
    }
    return found_[at_[node]];
  }

 private:
  std::int32_t slave_ = -1;
  std::vector<std::int32_t> stamp_;
  std::vector<std::size_t> at_;
  std::vector<SignChanges> found_;
};

/// Call facing(a, b, end_a, end_b) and away(a, b) for the parts of [-1, 1] on which the normal crosses a master whose ends are
/// `first` and `second`; end_a and end_b say at which of its ends (0, 1) a and b are normals, or -1.
template <class Facing, class Away>
void crossings(const SignChanges& first, const SignChanges& second, const Facing& facing, const Away& away) {
  bool s1 = first.positive, s2 = second.positive;
  double a = -1;
  int end_a = -1;
  for (int i = 0, j = 0;;) {
    const double next1 = i < first.n ? first.at[i] : 1, next2 = j < second.n ? second.at[j] : 1;
    const double b = std::min(next1, next2);
    const int end_b = i < first.n && next1 <= next2 ? 0 : j < second.n ? 1 : -1;
    if (b > a && s1 && !s2) facing(a, b, end_a, end_b);
    if (b > a && !s1 && s2) away(a, b);
    a = b;
    end_a = end_b;
    if (i < first.n && next1 <= next2) {
      s1 = !s1;
      ++i;
    } else if (j < second.n) {
      s2 = !s2;
      ++j;
    } else {
      return;
    }
  }
}

struct Image {
  bool found = false;
  double xi = 0;   ///< on the master
  double gap = 0;  ///< (x_m - x) . n_e
};

/// Where the normal of the slave at xi meets the true master, curved if it is. The ends of the master lie on both sides of the
/// normal, but for round-off, or where the cover fades beyond them: then the image is near an end, moved by Newton's method.
/// @param beyond by how much, in reference coordinates
Image image(const SlaveCell& slave, double xi, const Surface& master, std::int32_t cell, const PairingTolerances& tolerances,
            double beyond = 0) {
  const auto nodes = master.nodes[cell];
  const Vec2 x = slave.x(xi), t = slave.tangent(xi);
  std::array<Vec2, 3> points;
  double size = length(x);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    points[i] = point(master, nodes[i]) - slave.origin - x;
    size = std::max(size, length(points[i]));
  }
  const Curve curve = interpolate(std::span(points).first(nodes.size()));
  const Polynomial h = curve * Curve{0, {(1 / length(t)) * t, {}, {}}};
  const SignChanges zero = sign_changes(h);
  Image image;
  if (zero.n > 0) {
    image.xi = zero.at[0];
  } else {
    const double end = std::abs(h(-1)) < std::abs(h(1)) ? -1 : 1;
    const Polynomial slope = h.derivative();
    double step = -h(end) / slope(end), at = end + step;
    for (int i = 0; i < 3 && std::abs(step) > tolerances.ray; ++i) at += step = -h(at) / slope(at);
    image.xi = std::abs(at - end) <= std::max(tolerances.ray, beyond) ? at : end;
  }
  image.found = std::abs(h(image.xi)) <= tolerances.ray * size;
  const Vec2 d = curve(image.xi);
  image.gap = (d.x * t.y - d.y * t.x) / length(t);
  return image;
}

/// The box of a master's ends, for where a normal passes between them decides, not where the cell bulges; nothing for a
/// degenerate one.
std::optional<Box<2>> box_of_ends(const Surface& master, std::size_t cell, double size, const PairingTolerances& tolerances) {
  if (!finite(master, cell)) return std::nullopt;
  const Vec2 a = point(master, master.nodes[cell][0]), b = point(master, master.nodes[cell][1]);
  if (!(length(b - a) > tolerances.degenerate * size)) return std::nullopt;
  Box<2> box = Box<2>::empty();
  box.add(std::array{a.x, a.y}.data());
  box.add(std::array{b.x, b.y}.data());
  return box;
}

using MastersInPlane = detail::Masters<2>;

/// How many points a contact cell gets. Where the master's mid node is not over the middle of its chord, but off by d / 4 of
/// the chord, the image is no polynomial of the slave's coordinate: its inverse map has a branch point (distortion() in
/// facet.hpp), and n points leave d^2n. On an arc d is zero.
int integration_points(const Surface& slave, std::size_t cell, const Surface& master, std::int32_t m) {
  const int least = slave.types[cell] == CellType::SEG2 && master.types[m] == CellType::SEG2 ? 3 : 4;
  if (master.types[m] == CellType::SEG2) return least;
  constexpr int polynomial = 5, most = 32;
  const auto nodes = master.nodes[m];
  const Vec2 a = point(master, nodes[0]), b = point(master, nodes[1]), chord = 0.5 * (b - a),
             bulge = point(master, nodes[2]) - 0.5 * (a + b);
  const double d = std::min(0.999, 2 * std::abs(dot(chord, bulge)) / dot(chord, chord));
  if (!(d > 1e-12)) return least;
  const double degree = polynomial + std::ceil(12 * std::numbers::ln10 / -std::log(d));
  return std::clamp(static_cast<int>(0.5 * (degree + 2)), least, most);
}

class PairerInPlane final : public detail::CellPairer {
 public:
  explicit PairerInPlane(std::shared_ptr<const MastersInPlane> masters)
      : masters_(std::move(masters)), projections(masters_->master.coordinates.size() / 3) {}

  void pair(std::size_t cell, Pairing& pairing, int /*order*/) override {
    const Surface &slave = masters_->slave, &master = masters_->master;
    const PairingOptions& options = masters_->options;
    const PairingTolerances& tolerances = options.tolerances;
    const auto slave_index = static_cast<std::int32_t>(cell);
    const SlaveCell e = finite(slave, cell) ? slave_cell(slave, cell) : SlaveCell{};
    if (degenerate(e, slave, masters_->slave_extent, tolerances.degenerate)) {
      pairing.rejected.push_back({slave_index, -1, Rejection::degenerate_slave});
      return;
    }
    const auto reject = [&](std::int32_t m, Rejection reason) { pairing.rejected.push_back({slave_index, m, reason}); };
    intervals.clear();
    projections.start(slave_index);
    const auto couple = [&](std::int32_t m) {
      const std::int32_t first = master.nodes[m][0], second = master.nodes[m][1];
      projections.of(e, master, first);  // both before a reference is kept: the second may move the first
      projections.of(e, master, second);
      const auto node_of = [&](int end) { return end < 0 ? -1 : end == 0 ? first : second; };
      double away = 0;
      crossings(
          projections.of(e, master, first), projections.of(e, master, second),
          [&](double a, double b, int end_a, int end_b) {
            const double middle = 0.5 * (a + b);
            Interval seen{a, b, m, node_of(end_a), node_of(end_b)};
            const Vec2 along = point(master, second) - point(master, first);
            const auto beyond_limits = [&]() -> std::optional<Rejection> {
              const double own = 2 * length(e.x.c[1]), other = length(along), diameter = std::max(own, other);
              // the way from x_e to its image by the middle of the slave and an end of the master, both of which may bulge
              const double largest = length(point(master, first) - e.origin) + own + 1.5 * other;
              const detail::CoupleSize size =
                  detail::size_of(slave, cell, master, static_cast<std::size_t>(m), diameter, cosine(e, m));
              if (detail::within_limits(options, largest, size)) return std::nullopt;
              const Vec2 t = e.tangent(-1) + e.tangent(1);
              const double moved = detail::give_way(
                  options, slave, cell, master, static_cast<std::size_t>(m),
                  {.slave = {t.y / length(t), -t.x / length(t), 0}, .master = {along.y / other, -along.x / other, 0}});
              const double gap = image(e, middle, master, m, tolerances).gap;
              const auto limit = detail::beyond_limits(options, gap, size, moved);
              if (detail::may_be_through_bodies(options, gap, size, moved)) seen.far = gap;
              if (limit || !(seen.far < 0) || !is_through_bodies(cell, e, seen)) return limit;
              return Rejection::too_deep;
            };
            if (!(share(e, m) > tolerances.sliver))
              reject(m, Rejection::too_steep);
            else if (const auto reason = detail::left_out(options, slave, cell, master, static_cast<std::size_t>(m)))
              reject(m, *reason);
            else if (const auto limit = beyond_limits())
              reject(m, *limit);
            else
              intervals.push_back(seen);
          },
          [&](double a, double b) { away += b - a; });
      if (away > 2 * tolerances.sliver) reject(m, Rejection::facing_away);
    };
    const Strip strip(e);
    masters_->visit([&](const Box<2>& box) { return strip.touches(box); }, couple);
    std::sort(intervals.begin(), intervals.end(),
              [](const Interval& i, const Interval& j) { return std::tie(i.a, i.b, i.master) < std::tie(j.a, j.b, j.master); });
    overlaps.resolve(
        intervals, tolerances.sliver, [&](double xi, std::int32_t m) { return image(e, xi, master, m, tolerances).gap; },
        [&](const Interval& one, double gap, const Interval& other, double other_gap) {
          const auto size_of = [&](std::int32_t m) {
            return length(point(master, master.nodes[m][1]) - point(master, master.nodes[m][0]));
          };
          return detail::comes_before(master, {one.master, gap, size_of(one.master)},
                                      {other.master, other_gap, size_of(other.master)}, 2 * length(e.x.c[1]));
        },
        [&](std::int32_t m) { reject(m, Rejection::hidden); });
    if (options.drops_slivers)
      detail::drop_past_ends(
          intervals, [](const Interval& i) { return i.far; }, [](const Interval& i) { return 0.5 * (i.b - i.a); },
          [&](const Interval& i) { return is_through_bodies(cell, e, i); },
          [&](const Interval& i, Rejection why) { reject(i.master, why); });

    for (std::size_t i = 0; i < intervals.size(); ++i) {
      const auto& [first, last, m, node_a, node_b, far] = intervals[i];
      const bool free_a = i == 0 || intervals[i - 1].b != first,
                 free_b = i + 1 == intervals.size() || intervals[i + 1].a != last;
      const double a = free_a && node_a >= 0 ? end_of_cover(cell, first) : first,
                   b = free_b && node_b >= 0 ? end_of_cover(cell, last) : last;
      if (!(b - a > 2 * tolerances.sliver)) {
        reject(m, Rejection::sliver);
        continue;
      }
      const Rule& rule = gauss_rule(integration_points(slave, cell, master, m));
      const double counted = share(e, m);
      ContactCells& cells = pairing.cells;
      const std::size_t before = cells.weight.size();
      bool complete = true;
      for (int g = 0; g < rule.size() && complete; ++g) {
        const double xi = 0.5 * (a + b) + 0.5 * (b - a) * rule.points[g];
        const Image on_master = image(e, xi, master, m, tolerances, a < first || b > last ? beyond_an_end : 0);
        complete = on_master.found;
        cells.slave_point.push_back(xi);
        cells.master_point.push_back(on_master.xi);
        cells.weight.push_back(0.5 * (b - a) * rule.weights[g] * counted);
      }
      if (!complete) {
        cells.slave_point.resize(before);
        cells.master_point.resize(before);
        cells.weight.resize(before);
        reject(m, Rejection::no_image);
        continue;
      }
      cells.slave.push_back(slave_index);
      cells.master.push_back(m);
      cells.offset.push_back(static_cast<std::int64_t>(cells.weight.size()));
      cells.vertex.insert(cells.vertex.end(), {a, b});
      cells.vertex_crossing.insert(cells.vertex_crossing.end(), {first, last});
      cells.vertex_node.push_back(first > -1 + tolerances.coincident ? node_a : -1);
      cells.vertex_node.push_back(last < 1 - tolerances.coincident ? node_b : -1);
      cells.vertex_offset.push_back(static_cast<std::int64_t>(cells.vertex.size()));
    }
  }

 private:
  static constexpr double beyond_an_end = 0.25;  // of a master: where the cover fades an image may lie there

  double share(const SlaveCell& slave, std::int32_t m) const {
    return share_of_couple(cosine(slave, m), masters_->steep).value;
  }

  /// Of a part that is far away.
  bool is_through_bodies(std::size_t cell, const SlaveCell& slave, const Interval& part) const {
    const double middle = 0.5 * (part.a + part.b);
    const Vec2 t = slave.tangent(middle), normal = (1 / length(t)) * Vec2{t.y, -t.x}, from = slave.origin + slave.x(middle);
    return masters_->is_through_bodies(0.5 * (part.b - part.a), cell, {from.x, from.y, 0}, {normal.x, normal.y, 0},
                                       static_cast<std::size_t>(part.master), part.far);
  }

  /// Of the angle between the mean normal of the slave and the opposite of the master's.
  double cosine(const SlaveCell& slave, std::int32_t m) const {
    const Surface& master = masters_->master;
    const Vec2 along = point(master, master.nodes[m][1]) - point(master, master.nodes[m][0]),
               t = slave.tangent(-1) + slave.tangent(1);
    return -dot(t, along) / (length(t) * length(along));
  }

  /// Where the cover ends that the normal through the last node of the masters cuts off at `crossing`.
  double end_of_cover(std::size_t cell, double crossing) const {
    const double width = masters_->options.fading;
    if (!(width > 0)) return crossing;
    const std::span<const std::uint8_t> inner = masters_->slave.inner;
    const bool inside =
        !inner.empty() && inner[static_cast<std::size_t>(masters_->slave.nodes[cell][crossing > 0 ? 1 : 0])] != 0;
    return inside ? crossing : faded_end(crossing, width).at;
  }

  std::shared_ptr<const MastersInPlane> masters_;
  // used again for every slave cell
  Projections projections;
  Overlaps overlaps;
  std::vector<Interval> intervals;
};

}  // namespace

detail::MakeCellPairer detail::pair_in_plane(const Surface& slave, const Surface& master, const PairingOptions& options,
                                             std::vector<RejectedCouple>& rejected) {
  const auto examine = [&master, tolerances = options.tolerances](std::size_t cell, double size) {
    return box_of_ends(master, cell, size, tolerances);
  };
  return [masters = std::make_shared<const MastersInPlane>(slave, master, options, rejected, examine)] {
    return std::make_unique<PairerInPlane>(masters);
  };
}

}  // namespace lacon
