#include "lacon/operators/contact/facet_gap.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

namespace lacon {
namespace {

// Radians, between a cell and the normals at its vertices: where they turn by more, half the angle of ten edges a turn, they
// are means of what meets at a corner, and stand for no curve.
constexpr double corner = 0.32;
constexpr double negligible = 1e-5;      // of the radius
constexpr double mean_of_arc = 2.0 / 3;  // height of an arc on average over its largest

/// How some nodes move: all together, and the root of the mean square of what they do beside it.
struct Motion {
  std::vector<double> mean;
  double deviation;
};

Motion motion(const std::set<std::int32_t>& nodes, std::span<const double> displacement, std::size_t dimension) {
  Motion found{std::vector<double>(dimension, 0.0), 0};
  double squares = 0;
  for (const std::int32_t node : nodes)
    for (std::size_t k = 0; k < dimension; ++k) {
      const double value = displacement[static_cast<std::size_t>(node) * dimension + k];
      found.mean[k] += value / static_cast<double>(nodes.size());
      squares += value * value;
    }
  squares /= static_cast<double>(nodes.size());
  for (const double value : found.mean) squares -= value * value;
  found.deviation = std::sqrt(std::max(squares, 0.0));
  return found;
}

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// The contact cells of a patch.
struct Couples {
  double missing = 0, curvature = 0;  // sums
  int count = 0;
  std::vector<std::int32_t> slaves, masters;  // cells of the mesh
};

}  // namespace

const FacetGaps::Bulges& FacetGaps::bulges(std::int32_t number) {
  const auto [found, is_new] = bulges_.try_emplace(number);
  if (!is_new) return found->second;
  const ContactGeometry::Zone& zone = contact_.geometry().zones()[static_cast<std::size_t>(number)];
  const auto add = [&](Surface skin, const auto& cell_of) {
    skin.coordinates = mesh_.coordinates;
    const std::vector<Bulge> of_skin = missing_bulge(skin);
    for (std::size_t i = 0; i < of_skin.size(); ++i)
      if (of_skin[i].turn < corner) found->second[cell_of(i)] = of_skin[i];
  };
  add(zone.slave, [&](std::size_t i) { return definition_.slaves[static_cast<std::size_t>(zone.slaves[i])].cell; });
  add(zone.master, [&](std::size_t i) { return zone.masters[i]; });
  return found->second;
}

std::optional<FacetGap> FacetGaps::of(std::int32_t zone, const Patchwise& patches, std::span<const double> displacement) {
  const ContactGeometry& geometry = contact_.geometry();
  const Bulges& bulges = this->bulges(zone);
  std::map<std::int32_t, Couples> of_patch;
  for (const ContactGeometry::Cell& cell : geometry.cells()) {
    const SlaveElement& element = definition_.slaves[static_cast<std::size_t>(cell.slave)];
    if (geometry.zone_of(static_cast<std::size_t>(element.patch)) != zone) continue;
    const auto slave = bulges.find(element.cell), master = bulges.find(cell.master);
    if (slave == bulges.end() || master == bulges.end()) continue;
    Couples& couples = of_patch[element.patch];
    couples.missing += slave->second.missing + master->second.missing;
    couples.curvature += std::max(std::abs(slave->second.curvature), std::abs(master->second.curvature));
    ++couples.count;
    couples.slaves.push_back(element.cell);
    couples.masters.push_back(cell.master);
  }
  std::vector<double> gaps, curvatures, strains;
  std::set<std::int32_t> slave_nodes, master_nodes;
  for (const auto& [number, couples] : of_patch) {
    const auto patch = static_cast<std::size_t>(number);
    const double gap = mean_of_arc * couples.missing / couples.count;
    const bool active = patches.status[patch] == Status::active;
    if (!active && !(contact_.is_covered(patch) && geometry.gap(patch) < gap)) continue;
    gaps.push_back(gap);
    curvatures.push_back(couples.curvature / couples.count);
    strains.push_back(active ? contact_.strain(patch, patches) : 0);
    for (const std::int32_t cell : couples.slaves) slave_nodes.insert(mesh_.cells[cell].begin(), mesh_.cells[cell].end());
    for (const std::int32_t cell : couples.masters) master_nodes.insert(mesh_.cells[cell].begin(), mesh_.cells[cell].end());
  }
  if (gaps.empty()) return std::nullopt;
  const double gap = median(gaps), curvature = median(curvatures);
  if (std::abs(gap) * curvature < negligible) return std::nullopt;
  const auto dimension = static_cast<std::size_t>(mesh_.dimension);
  const Motion slave = motion(slave_nodes, displacement, dimension), master = motion(master_nodes, displacement, dimension);
  double apart = 0;
  for (std::size_t k = 0; k < dimension; ++k) apart = std::hypot(apart, slave.mean[k] - master.mean[k]);
  return FacetGap{gap, std::max(slave.deviation + master.deviation + apart, median(strains) / (2 * curvature))};
}

}  // namespace lacon
