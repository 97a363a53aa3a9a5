#pragma once
// In the plane: what a slave cell sees of each master, and which one keeps a part that several cover.
#include <algorithm>
#include <cstdint>
#include <tuple>
#include <vector>

namespace lacon {

/// A part of a slave cell that sees one master.
struct Interval {
  double a, b;
  std::int32_t master;
  std::int32_t node_a, node_b;  ///< whose normals end it; -1: the slave itself ends there
  double far = 0;               ///< the gap in its middle, where detail::may_be_through_bodies() says so
};

/// Where several masters cover a part of a slave cell, the nearest along the normal keeps it.
class Overlaps {
 public:
  /// @param[in,out] intervals sorted by (a, b)
  /// @param gap(xi, master)  @param wins(interval, its gap, other one, its gap): whether the first keeps a part
  template <class Gap, class Wins, class Hidden>
  void resolve(std::vector<Interval>& intervals, double sliver, const Gap& gap, const Wins& wins, const Hidden& hidden) {
    bool any = false;
    double end = -1;
    for (const Interval& i : intervals) {
      any = any || i.a < end;
      end = std::max(end, i.b);
    }
    if (!any) return;
    breaks_.clear();
    result_.clear();
    for (const Interval& i : intervals) breaks_.insert(breaks_.end(), {Break{i.a, i.node_a}, Break{i.b, i.node_b}});
    std::sort(breaks_.begin(), breaks_.end(), [](Break x, Break y) { return std::tie(x.at, x.node) < std::tie(y.at, y.node); });
    breaks_.erase(std::unique(breaks_.begin(), breaks_.end(), [](Break x, Break y) { return x.at == y.at; }), breaks_.end());
    lost_.assign(intervals.size(), 0.0);
    for (std::size_t k = 0; k + 1 < breaks_.size(); ++k) {
      const double a = breaks_[k].at, b = breaks_[k + 1].at;
      const auto covers = [&](const Interval& i) { return i.a <= a && i.b >= b; };
      const auto n = std::count_if(intervals.begin(), intervals.end(), covers);
      if (n == 0) continue;
      std::size_t nearest = intervals.size();
      double its_gap = 0;
      for (std::size_t i = 0; i < intervals.size(); ++i)
        if (covers(intervals[i])) {
          const double own = n == 1 ? 0 : gap(0.5 * (a + b), intervals[i].master);
          if (nearest == intervals.size() || wins(intervals[i], own, intervals[nearest], its_gap)) nearest = i, its_gap = own;
        }
      for (std::size_t i = 0; i < intervals.size(); ++i)
        if (i != nearest && covers(intervals[i])) lost_[i] += b - a;
      if (!result_.empty() && result_.back().b == a && result_.back().master == intervals[nearest].master) {
        result_.back().b = b;
        result_.back().node_b = breaks_[k + 1].node;
      } else {
        const Interval& kept = intervals[nearest];
        result_.push_back({a, b, kept.master, breaks_[k].node, breaks_[k + 1].node, kept.far});
      }
    }
    for (std::size_t i = 0; i < intervals.size(); ++i)
      if (lost_[i] > 2 * sliver) hidden(intervals[i].master);
    intervals.swap(result_);
  }

 private:
  struct Break {
    double at;
    std::int32_t node;
  };
  std::vector<Break> breaks_;
  std::vector<double> lost_;
  std::vector<Interval> result_;
};

}  // namespace lacon
