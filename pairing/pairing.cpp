// What pairing in the plane and in space have in common.
#include "lacon/pairing/pairing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>

#include "lacon/pairing/detail.hpp"
#include "lacon/structures/parallel.hpp"
#include "lacon/structures/vector.hpp"

namespace lacon {
namespace {

void check(const Surface& surface, int dimension) {
  if (surface.dimension != dimension)
    throw std::invalid_argument("pairing: a surface of dimension " + std::to_string(surface.dimension) +
                                " cannot be paired with one of dimension " + std::to_string(dimension));
  if (dimension != 2 && dimension != 3)
    throw std::invalid_argument("pairing: surfaces of dimension " + std::to_string(dimension) + " cannot be paired");
  for (const CellType type : surface.types)
    if (catalog::cell(type).dimension != dimension - 1)
      throw std::invalid_argument("pairing: a cell " + std::string(catalog::cell(type).name) + " cannot be paired " +
                                  (dimension == 2 ? "in the plane" : "in space"));
}

}  // namespace

namespace detail {

bool finite(const Surface& surface, std::size_t cell) {
  return std::all_of(surface.nodes[cell].begin(), surface.nodes[cell].end(), [&](std::int32_t node) {
    for (int d = 0; d < surface.dimension; ++d)
      if (!std::isfinite(surface.coordinates[3 * node + d]) ||
          (!surface.normals.empty() && !std::isfinite(surface.normals[3 * node + d])))
        return false;
    return true;
  });
}

double give_way(const PairingOptions& options, const Surface& slave, std::size_t slave_cell, const Surface& master,
                std::size_t master_cell, const CoupleNormals& normals) {
  struct Motion {
    std::array<double, 2> least{}, most{};  ///< along both normals
    double longest = 0;
  };
  const auto motion_of = [&](const Surface& skin, std::size_t cell) {
    if (skin.rest.empty()) return Motion{};
    Motion motion{.least = {INFINITY, INFINITY}, .most = {-INFINITY, -INFINITY}};
    for (const std::int32_t node : skin.nodes[cell]) {
      std::array<double, 2> along{};
      double square = 0;
      for (int d = 0; d < 3; ++d) {
        const double moved = skin.coordinates[3 * node + d] - skin.rest[3 * node + d];
        along[0] += moved * normals.slave[d];
        along[1] += moved * normals.master[d];
        square += moved * moved;
      }
      for (int k = 0; k < 2; ++k) {
        motion.least[k] = std::min(motion.least[k], along[k]);
        motion.most[k] = std::max(motion.most[k], along[k]);
      }
      motion.longest = std::max(motion.longest, std::sqrt(square));
    }
    return motion;
  };
  const Motion of_slave = motion_of(slave, slave_cell), of_master = motion_of(master, master_cell);
  const double both = of_slave.longest + of_master.longest;
  if (options.distance_limit > 0) return both;
  double closer = of_slave.most[0] - of_master.least[0];
  const double cosine = -std::inner_product(normals.slave.begin(), normals.slave.end(), normals.master.begin(), 0.0);
  if (cosine > 0) closer = std::max(closer, (of_master.most[1] - of_slave.least[1]) / cosine);
  return std::clamp(closer, 0.0, both);
}

namespace {

std::span<const double> rest_of(const Surface& skin) { return skin.rest.empty() ? skin.coordinates : skin.rest; }

Vec3 normal_at_rest(const Surface& skin, std::size_t cell) {
  return normal_of(skin.types[cell], skin.nodes[cell], rest_of(skin));
}

Vec3 middle_at_rest(const Surface& skin, std::size_t cell) { return middle_of(skin.nodes[cell], rest_of(skin)); }

bool of_one_body(const Surface& slave, std::size_t slave_cell, const Surface& master, std::size_t master_cell) {
  return !slave.body.empty() && !master.body.empty() && body_of(slave, slave_cell) == body_of(master, master_cell);
}

}  // namespace

CoupleSize size_of(const Surface& slave, std::size_t slave_cell, const Surface& master, std::size_t master_cell,
                   double diameter, double cosine) {
  CoupleSize size{.diameter = diameter, .cosine = cosine};
  if (of_one_body(slave, slave_cell, master, master_cell))
    size.behind =
        dot(normal_at_rest(slave, slave_cell), middle_at_rest(slave, slave_cell) - middle_at_rest(master, master_cell));
  else if (!slave.thickness.empty() && !master.thickness.empty())
    size.half = 0.5 * (slave.thickness[slave_cell] + master.thickness[master_cell]);
  size.of_two_bodies = !slave.body.empty() && !master.body.empty() && !of_one_body(slave, slave_cell, master, master_cell);
  return size;
}

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

constexpr double within_coarse = 0.5;  // diameters: so deep may points lie inside whose patch is closed on average

/// The deepest overlap of a couple that has not moved. Near sides of two bodies overlap by little, and a far side lies behind
/// the other one by what both are thick: half of that is as far from the one as from the other. Of foils that are thin against
/// their cells a near side may lie as deep.
double deepest(const PairingOptions& options, const CoupleSize& couple) {
  if (options.distance_limit > 0) return options.distance_limit * couple.diameter;
  if (!(options.depth_limit > 0)) return infinite;
  return std::min(options.depth_limit * couple.diameter * std::max(couple.cosine, 0.0),
                  std::max(couple.half, within_coarse * couple.diameter));
}

/// Likewise of one body, whose other side the master is; infinite of others.
double deepest_in_itself(const PairingOptions& options, const CoupleSize& couple) {
  const double limit = options.own_depth_limit * couple.diameter;
  return options.own_depth_limit > 0 && couple.behind > limit ? limit : infinite;
}

}  // namespace

std::optional<Rejection> left_out(const PairingOptions& options, const Surface& slave, std::size_t slave_cell,
                                  const Surface& master, std::size_t master_cell) {
  const Couple couple{static_cast<std::int32_t>(slave_cell), static_cast<std::int32_t>(master_cell)};
  if (std::ranges::binary_search(options.left_out, couple)) return Rejection::far_behind;
  if (!options.in_front) return std::nullopt;
  const auto in_front = (*options.in_front)[slave_cell];
  if (in_front.empty() || std::ranges::count(in_front, options.faces[master_cell]) > 0) return std::nullopt;
  return was_wall(slave, slave_cell, master, master_cell) ? std::optional(Rejection::wall) : std::nullopt;
}

bool within_limits(const PairingOptions& options, double largest_gap, const CoupleSize& couple) {
  return !(options.distance_limit > 0 && largest_gap > options.distance_limit * couple.diameter) &&
         largest_gap <= std::min(deepest(options, couple), deepest_in_itself(options, couple)) &&
         !may_be_through_bodies(options, largest_gap, couple, 0) && !may_be_through_bodies(options, -largest_gap, couple, 0);
}

bool may_be_through_bodies(const PairingOptions& options, double gap, const CoupleSize& couple, double moved) {
  if (!(options.depth_limit > 0) || options.distance_limit > 0 || !couple.of_two_bodies) return false;
  const double coarse = within_coarse * couple.diameter;
  return gap > coarse || -gap > std::min(coarse, couple.half) + moved;
}

std::optional<Rejection> beyond_limits(const PairingOptions& options, double gap, const CoupleSize& couple, double moved) {
  if (options.distance_limit > 0 && gap > options.distance_limit * couple.diameter + moved) return Rejection::too_far;
  if (-gap > deepest_in_itself(options, couple)) return Rejection::other_side;
  if (-gap > deepest(options, couple) + moved) return Rejection::too_deep;
  return std::nullopt;
}

namespace {

/// An end (in the plane) or edge (in space) of a cell where its skin ends or folds.
struct FreeEnd {
  Vec3 place;   ///< a point of it
  Vec3 inward;  ///< unit, into the cell, at a right angle to it
};

std::vector<FreeEnd> free_ends_of(const Surface& skin, std::size_t cell) {
  std::vector<FreeEnd> ends;
  if (skin.free_ends.empty()) return ends;
  const auto at = [&](int i) {
    return vector_at(skin.coordinates.data() + 3 * std::ptrdiff_t{skin.nodes[cell][static_cast<std::size_t>(i)]});
  };
  const int n = skin.dimension == 2 ? 2 : catalog::cell(skin.types[cell]).n_vertices;
  Vec3 middle{};
  for (int i = 0; i < n; ++i) middle = middle + at(i) / static_cast<double>(n);
  for (int i = 0; i < n; ++i) {
    if ((skin.free_ends[cell] >> i & 1) == 0) continue;
    Vec3 inward = middle - at(i);
    if (skin.dimension == 3) {
      const Vec3 along = at((i + 1) % n) - at(i);
      inward = inward - (dot(inward, along) / dot(along, along)) * along;
    }
    ends.push_back({at(i), inward / norm(inward)});
  }
  return ends;
}

/// Whether a free end of each of two cells is near to one of the other, with the two cells on different sides.
bool ends_meet(const Surface& skin, std::int32_t one, std::int32_t other, double near) {
  constexpr double opposite = -0.5;  // cosine
  const std::vector<FreeEnd> own = free_ends_of(skin, static_cast<std::size_t>(one));
  const std::vector<FreeEnd> others = own.empty() ? own : free_ends_of(skin, static_cast<std::size_t>(other));
  for (const FreeEnd& a : own)
    for (const FreeEnd& b : others)
      if (dot(a.inward, b.inward) < opposite && std::abs(dot(b.place - a.place, a.inward)) < near) return true;
  return false;
}

}  // namespace

bool comes_before(const Surface& masters, const Candidate& one, const Candidate& other, double size) {
  constexpr double hair = 0.25;    // of the smallest cell
  constexpr double as_near = 0.1;  // of the slave cell
  const double apart = std::abs(one.gap - other.gap);
  if (apart > 0 &&
      !(apart <= as_near * size && ends_meet(masters, one.master, other.master, hair * std::min({size, one.size, other.size}))))
    return std::abs(one.gap) < std::abs(other.gap);
  const auto place = [&](const Candidate& candidate) {
    const Vec3 at = middle_at_rest(masters, static_cast<std::size_t>(candidate.master));
    return std::tuple(at.x, at.y, at.z, candidate.master);
  };
  return place(one) < place(other);
}

}  // namespace detail

bool was_wall(const Surface& slave, std::size_t slave_cell, const Surface& master, std::size_t master_cell) {
  const auto normal = [](const Surface& skin, std::size_t cell) {
    return normal_of(skin.types[cell], skin.nodes[cell], skin.walls.empty() ? detail::rest_of(skin) : skin.walls);
  };
  return -dot(normal(slave, slave_cell), normal(master, master_cell)) < wall_cosine;
}

double steep_cosine(const PairingOptions& options) {
  return options.steep_angle < 90 ? std::cos(options.steep_angle * std::numbers::pi / 180) : 0;
}

std::string_view rejection_name(Rejection rejection) {
  static constexpr std::string_view names[n_rejections] = {"facing away",       "hidden",     "sliver",     "degenerate slave",
                                                           "degenerate master", "no image",   "too far",    "too steep",
                                                           "too deep",          "other side", "far behind", "wall"};
  return names[static_cast<std::size_t>(rejection)];
}

void Pairing::append(const Pairing& other) {
  cells.append(other.cells);
  traces.insert(traces.end(), other.traces.begin(), other.traces.end());
  rejected.insert(rejected.end(), other.rejected.begin(), other.rejected.end());
}

Pairing pair(const Surface& slave, const Surface& master, const PairingOptions& options) {
  constexpr std::size_t block = 64;  // slave cells that a thread pairs at a time
  PairingInParts pairing(slave, master, options);
  std::vector<Pairing> parts(std::max<std::size_t>(n_loop_blocks(slave.size(), block), 1));
  parts[0].cells.dimension = slave.dimension;
  if (slave.size() == 0) pairing.pair(0, 0, parts[0]);
  parallel_for(slave.size(), block, [&](const LoopBlock& cells) { pairing.pair(cells.first, cells.last, parts[cells.index]); });
  for (std::size_t i = 1; i < parts.size(); ++i) parts[0].append(parts[i]);
  return std::move(parts[0]);
}

struct PairingInParts::Implementation {
  int dimension;
  std::vector<RejectedCouple> degenerate_masters;
  detail::MakeCellPairer make;
  std::mutex mutex;
  std::vector<std::unique_ptr<detail::CellPairer>> free;  // as many as threads have been here at a time

  std::unique_ptr<detail::CellPairer> take() {
    const std::lock_guard lock(mutex);
    if (free.empty()) return make();
    std::unique_ptr<detail::CellPairer> pairer = std::move(free.back());
    free.pop_back();
    return pairer;
  }
  void give_back(std::unique_ptr<detail::CellPairer> pairer) {
    const std::lock_guard lock(mutex);
    free.push_back(std::move(pairer));
  }
};

PairingInParts::PairingInParts(const Surface& slave, const Surface& master, const PairingOptions& options)
    : implementation_(std::make_unique<Implementation>()) {
  check(slave, slave.dimension);
  check(master, slave.dimension);
  implementation_->dimension = slave.dimension;
  const auto prepare = slave.dimension == 2 ? detail::pair_in_plane : detail::pair_in_space;
  implementation_->make = prepare(slave, master, options, implementation_->degenerate_masters);
}

PairingInParts::~PairingInParts() = default;

void PairingInParts::pair(std::size_t first, std::size_t last, Pairing& found, int order) {
  found.cells.clear();
  found.traces.clear();
  found.cells.dimension = implementation_->dimension;
  found.rejected.clear();
  if (first == 0) found.rejected = implementation_->degenerate_masters;
  std::unique_ptr<detail::CellPairer> pairer = implementation_->take();
  for (std::size_t cell = first; cell < last; ++cell) pairer->pair(cell, found, order);
  implementation_->give_back(std::move(pairer));
  std::sort(found.rejected.begin(), found.rejected.end());
  found.rejected.erase(std::unique(found.rejected.begin(), found.rejected.end()), found.rejected.end());
}

}  // namespace lacon
