#pragma once
// The master skin, examined once for all slave cells: what the plane and space have in common of it.
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "lacon/pairing/box_tree.hpp"
#include "lacon/pairing/detail.hpp"
#include "lacon/pairing/thickness.hpp"
#include "lacon/structures/parallel.hpp"

namespace lacon::detail {

/// The diagonal of the box around a skin, but for cells that are not finite.
template <int D>
double extent(const Surface& surface) {
  Box<D> box = Box<D>::empty();
  for (std::size_t cell = 0; cell < surface.size(); ++cell)
    if (finite(surface, cell))
      for (const std::int32_t node : surface.nodes[cell])
        box.add(surface.coordinates.data() + 3 * static_cast<std::size_t>(node));
  if (!(box.low[0] <= box.high[0])) return 0;
  double sum = 0;
  for (int d = 0; d < D; ++d) sum += (box.high[d] - box.low[d]) * (box.high[d] - box.low[d]);
  return std::sqrt(sum);
}

template <int D>
struct Masters {
  const Surface &slave, &master;
  PairingOptions options;
  double slave_extent = 0;
  double steep;                      ///< steep_cosine()
  std::vector<std::int32_t> usable;  ///< cells that are not degenerate, and what the tree has as items
  BoxTree<D> tree;

  /// @param examine(cell, extent of the skin): the box of what a normal may pass, or nothing for a degenerate cell; every
  /// thread has a copy of its own
  template <class Examine>
  Masters(const Surface& slave_skin, const Surface& master_skin, const PairingOptions& pairing_options,
          std::vector<RejectedCouple>& rejected, const Examine& examine)
      : slave(slave_skin),
        master(master_skin),
        options(pairing_options),
        slave_extent(extent<D>(slave_skin)),
        steep(steep_cosine(pairing_options)),
        tree(boxes_of_usable(rejected, examine)) {
    if (!options.ways) own_ways_ = std::make_unique<WaysWhenAsked>(std::vector{&slave, &master});
  }

  /// Whether a couple that is further apart, or deeper in each other, than cells are large is seen through bodies:
  /// - one that overlaps where the straight way from a point of the slave to one of the master, behind it, leaves the body of
  ///   the slave, and the way back that of the master, so that both are far sides, or sides of a pocket. A thin body that lies
  ///   inside of another one, as a spring in its free shape, is left on one of these ways alone. That is enough for slivers of
  ///   a slave cell, which see past a corner;
  /// - one that is apart where the way leaves either body before its end, or the slave's at its end: a flank of the next tooth.
  /// @param share of the slave cell  @param normal of the slave at `from`, unit
  bool is_through_bodies(double share, std::size_t slave_cell, Vec3 from, Vec3 normal, std::size_t master_cell,
                         double gap) const {
    const WaysThrough& ways = (options.ways ? *options.ways : *own_ways_)();
    const std::int32_t own = body_of(slave, slave_cell), other = body_of(master, master_cell);
    if (gap > 0) {
      constexpr double near = 0.2, at_its_end = 1.05;  // of the way: facets are taken as flat, and those at both ends may bulge
      const Vec3 start = from + near * gap * normal;
      return ways.to_leave(own, start, normal) < (at_its_end - near) * gap ||
             ways.to_leave(other, start, normal) < (1 - 2 * near) * gap;
    }
    const bool slave_is_left = ways.to_leave(own, from, -1.0 * normal) < -gap,
               master_is_left = ways.to_leave(other, from + gap * normal, normal) < -gap;
    return share < past_a_corner ? slave_is_left || master_is_left : slave_is_left && master_is_left;
  }

  /// Call couple(cell) for every master whose box `touches(box)`, or for all of them.
  template <class Touches, class Couple>
  void visit(const Touches& touches, const Couple& couple) const {
    if (options.brute_force)
      for (const std::int32_t m : usable) couple(m);
    else
      tree.visit(touches, [&](std::int32_t i) { couple(usable[static_cast<std::size_t>(i)]); });
  }

 private:
  std::unique_ptr<WaysWhenAsked> own_ways_;  ///< where there is no PairingOptions::ways

  template <class Examine>
  std::vector<Box<D>> boxes_of_usable(std::vector<RejectedCouple>& rejected, const Examine& examine) {
    const double size = extent<D>(master), margin = options.tolerances.box * size;
    std::vector<std::optional<Box<D>>> found(master.size());
    parallel_for(master.size(), block, [&](const LoopBlock& cells) {
      Examine own = examine;
      for (std::size_t cell = cells.first; cell < cells.last; ++cell) found[cell] = own(cell, size);
    });
    std::vector<Box<D>> boxes;
    for (std::size_t cell = 0; cell < master.size(); ++cell) {
      if (!found[cell]) {
        rejected.push_back({-1, static_cast<std::int32_t>(cell), Rejection::degenerate_master});
        continue;
      }
      Box<D>& box = boxes.emplace_back(*found[cell]);
      for (int d = 0; d < D; ++d) {
        box.low[d] -= margin;
        box.high[d] += margin;
      }
      usable.push_back(static_cast<std::int32_t>(cell));
    }
    return boxes;
  }

  static constexpr std::size_t block = 512;  // cells that a thread examines at a time
};

}  // namespace lacon::detail
