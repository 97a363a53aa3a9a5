#pragma once
// A tree of axis-aligned boxes: finds every box that a convex region may touch.
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

namespace lacon {

template <int D>
struct Box {
  std::array<double, D> low, high;

  static Box empty() {
    Box box;
    box.low.fill(std::numeric_limits<double>::infinity());
    box.high.fill(-std::numeric_limits<double>::infinity());
    return box;
  }
  /// Grow to hold a point. @param point (at least D)
  void add(const double* point) {
    for (int d = 0; d < D; ++d) {
      low[d] = std::min(low[d], point[d]);
      high[d] = std::max(high[d], point[d]);
    }
  }
  void add(const Box& box) {
    add(box.low.data());
    add(box.high.data());
  }
};

/// Built once on n boxes in O(n log n); which items a visit reports depends on their boxes alone, never on the tree's shape.
template <int D>
class BoxTree {
 public:
  explicit BoxTree(std::vector<Box<D>> boxes) : boxes_(std::move(boxes)), items_(boxes_.size()) {
    std::iota(items_.begin(), items_.end(), 0);
    if (items_.empty()) return;
    build(0, static_cast<std::int32_t>(items_.size()));
    std::vector<Box<D>> in_order;  // of the leaves: what a visit reads lies together
    in_order.reserve(boxes_.size());
    for (const std::int32_t item : items_) in_order.push_back(boxes_[item]);
    boxes_ = std::move(in_order);
  }

  /// Call `report(item)` for every item whose box `touches(box)`. `touches` must be monotone: true for a box if it is for one
  /// inside it.
  template <class Touches, class Report>
  void visit(const Touches& touches, const Report& report) const {
    if (nodes_.empty()) return;
    std::int32_t stack[64];
    int depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
      const Node& node = nodes_[static_cast<std::size_t>(stack[--depth])];
      if (!touches(node.box)) continue;
      if (node.right < 0) {
        for (std::int32_t i = node.first; i < node.last; ++i)
          if (touches(boxes_[i])) report(items_[i]);
      } else {
        stack[depth++] = node.right;
        stack[depth++] = static_cast<std::int32_t>(&node - nodes_.data()) + 1;
      }
    }
  }

 private:
  static constexpr std::int32_t leaf_size = 4;

  struct Node {
    Box<D> box;
    std::int32_t first, last;
    std::int32_t right;  ///< -1 for a leaf; the left child follows its parent
  };

  // Halves the items each time, so that the depth is at most log2(n) + 1, well below the stack of visit().
  std::int32_t build(std::int32_t first, std::int32_t last) {
    const auto at = static_cast<std::int32_t>(nodes_.size());
    Box<D> box = Box<D>::empty();
    for (std::int32_t i = first; i < last; ++i) box.add(boxes_[items_[i]]);
    nodes_.push_back({box, first, last, -1});
    if (last - first <= leaf_size) return at;
    int axis = 0;
    for (int d = 1; d < D; ++d)
      if (box.high[d] - box.low[d] > box.high[axis] - box.low[axis]) axis = d;
    const auto centre = [&](std::int32_t item) { return boxes_[item].low[axis] + boxes_[item].high[axis]; };
    const std::int32_t middle = first + (last - first) / 2;
    std::nth_element(items_.begin() + first, items_.begin() + middle, items_.begin() + last,
                     [&](std::int32_t a, std::int32_t b) { return std::pair(centre(a), a) < std::pair(centre(b), b); });
    build(first, middle);
    const std::int32_t right = build(middle, last);
    nodes_[at].right = right;
    return at;
  }

  std::vector<Box<D>> boxes_;  ///< of the items, by item while the tree is built, in the order of items_ then
  std::vector<std::int32_t> items_;
  std::vector<Node> nodes_;
};

}  // namespace lacon
