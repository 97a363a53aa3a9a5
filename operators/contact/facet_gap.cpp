#include "lacon/operators/contact/facet_gap.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

#include "lacon/elements/reference.hpp"
#include "lacon/operators/contact/facing.hpp"
#include "lacon/pairing/normals.hpp"

namespace lacon {
namespace {

constexpr double negligible = 1e-5;    // of the radius
constexpr double explained = 1.5;      // largest overlap that facets make, over what they leave of the curves
constexpr double overlap_told = 1e-3;  // of h: what facets make that is worth an alarm
constexpr std::size_t fewest = 8;      // patches of a contact of which few press
constexpr double few = 0.6;            // of them

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

/// Call use(reference point, weight) for some points of a skin cell.
template <class Use>
void for_each_point(CellType type, const Use& use) {
  const Family family = catalog::cell(type).family;
  const Rule& rule = integration_rule(family, family == Family::SEG ? 4 : family == Family::TRIA ? 6 : 9);
  const auto dimension = static_cast<std::size_t>(rule.dimension);
  for (std::size_t p = 0; p < rule.weights.size(); ++p)
    use(std::span(rule.points).subspan(p * dimension, dimension), rule.weights[p]);
}

/// A cell of a skin and its nodes at one geometry.
class PlacedCell {
 public:
  PlacedCell(const Mesh& mesh, std::int32_t cell, std::span<const double> coordinates) : type_(mesh.types[cell]) {
    for (const std::int32_t node : mesh.cells[cell])
      for (std::size_t k = 0; k < 3; ++k) points_.push_back(coordinates[3 * static_cast<std::size_t>(node) + k]);
  }
  Vec3 at(std::span<const double> xi) const {
    shape_.resize(points_.size() / 3);
    shape_functions(type_, xi, shape_);
    Vec3 place{};
    for (std::size_t i = 0; i < shape_.size(); ++i) place = place + shape_[i] * vector_at(&points_[3 * i]);
    return place;
  }
  /// As long as the Jacobian.
  Vec3 normal(std::span<const double> xi) const { return cell_normal(type_, points_, xi); }
  /// The reference point where a line meets it; nothing beside it.
  std::optional<std::vector<double>> met_by(Vec3 place, Vec3 direction) const {
    constexpr int most_steps = 10;
    constexpr double edge = 1e-9, solved = 1e-12;
    const catalog::CellRow& row = catalog::cell(type_);
    const auto dimension = static_cast<std::size_t>(row.dimension);
    std::vector<double> xi(dimension, row.family == Family::TRIA ? 1.0 / 3 : 0.0), slopes(points_.size() / 3 * dimension);
    double along = 0;
    for (int step = 0; step < most_steps; ++step) {
      const Vec3 off = at(xi) - place - along * direction;
      shape_gradients(type_, xi, slopes);
      Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();  // in the plane the last equation is 0 = 0
      for (std::size_t d = 0; d < dimension; ++d) {
        Vec3 tangent{};
        for (std::size_t i = 0; i < shape_.size(); ++i)
          tangent = tangent + slopes[i * dimension + d] * vector_at(&points_[3 * i]);
        matrix.col(static_cast<Eigen::Index>(d)) = Eigen::Vector3d(tangent.x, tangent.y, tangent.z);
      }
      matrix.col(static_cast<Eigen::Index>(dimension)) = -Eigen::Vector3d(direction.x, direction.y, direction.z);
      const Eigen::Vector3d change = matrix.partialPivLu().solve(Eigen::Vector3d(off.x, off.y, off.z));
      if (!change.allFinite()) return std::nullopt;
      double moved = 0;
      for (std::size_t d = 0; d < dimension; ++d) {
        xi[d] -= change[static_cast<Eigen::Index>(d)];
        moved = std::max(moved, std::abs(change[static_cast<Eigen::Index>(d)]));
      }
      along -= change[static_cast<Eigen::Index>(dimension)];
      if (moved < solved) break;
    }
    const bool inside = row.family == Family::TRIA
                            ? xi[0] >= -edge && xi[1] >= -edge && xi[0] + xi[1] <= 1 + edge
                            : std::ranges::all_of(xi, [](double value) { return std::abs(value) <= 1 + edge; });
    return inside ? std::optional(xi) : std::nullopt;
  }

 private:
  CellType type_;
  std::vector<double> points_;
  mutable std::vector<double> shape_;
};

}  // namespace

const FacetGaps::Curves& FacetGaps::curves(std::int32_t number) {
  const auto [found, is_new] = curves_.try_emplace(number);
  Curves& curves = found->second;
  if (!is_new) return curves;
  const ContactGeometry::Zone& zone = contact_.geometry().zones()[static_cast<std::size_t>(number)];
  const auto add = [&](Surface skin, std::span<const std::int32_t> facet_of, const auto& cell_of, Arcs& to) {
    skin.coordinates = mesh_.coordinates;
    const std::vector<FacetArc> arcs = arcs_of_cells(skin, facet_of);
    for (std::size_t i = 0; i < arcs.size(); ++i) {
      if (!arcs[i].is_of_curve()) continue;
      const std::int32_t cell = cell_of(i);
      to.emplace(cell, arcs[i]);
      const PlacedCell placed(mesh_, cell, mesh_.coordinates);
      const double extent = cell_extent(mesh_, cell), size = skin.dimension == 2 ? extent : std::sqrt(extent);
      for_each_point(skin.types[i], [&](std::span<const double> xi, double) {
        if (std::abs(arcs[i].missing(placed.at(xi))) > overlap_told * size) curves.left_by.insert(cell);
      });
    }
  };
  std::vector<std::int32_t> patches, cells(zone.masters.size());
  for (const std::int32_t slave : zone.slaves) patches.push_back(definition_.slaves[static_cast<std::size_t>(slave)].patch);
  std::iota(cells.begin(), cells.end(), 0);
  add(
      zone.slave, patches, [&](std::size_t i) { return definition_.slaves[static_cast<std::size_t>(zone.slaves[i])].cell; },
      curves.slave);
  add(
      zone.master, cells, [&](std::size_t i) { return zone.masters[i]; }, curves.master);
  return curves;
}

const std::map<std::size_t, double>& FacetGaps::of_patches(std::int32_t zone) {
  const ContactGeometry& geometry = contact_.geometry();
  const Curves& curves = this->curves(zone);
  const auto [found, is_new] = of_patches_.try_emplace(zone);
  std::map<std::size_t, double>& of_patch = found->second;
  if (!is_new) return of_patch;
  if (curves.left_by.empty()) return of_patch;
  std::map<std::size_t, double> weights;
  for (const ContactGeometry::Cell& cell : geometry.cells()) {
    const SlaveElement& element = definition_.slaves[static_cast<std::size_t>(cell.slave)];
    const auto patch = static_cast<std::size_t>(element.patch);
    if (geometry.zone_of(patch) != zone) continue;
    const auto slave = curves.slave.find(element.cell), master = curves.master.find(cell.master);
    if (slave == curves.slave.end() || master == curves.master.end()) continue;
    of_patch.try_emplace(patch, 0.0);
    if (!curves.left_by.contains(element.cell) && !curves.left_by.contains(cell.master)) continue;
    const PlacedCell slave_at_rest(mesh_, element.cell, mesh_.coordinates),
        slave_now(mesh_, element.cell, geometry.coordinates()), master_at_rest(mesh_, cell.master, mesh_.coordinates),
        master_now(mesh_, cell.master, geometry.coordinates());
    for_each_point(mesh_.types[element.cell], [&](std::span<const double> xi, double of_rule) {
      const Vec3 normal = slave_now.normal(xi);
      const auto image = master_now.met_by(slave_now.at(xi), normal / norm(normal));
      if (!image) return;
      const double weight = of_rule * norm(normal);
      weights[patch] += weight;
      of_patch[patch] +=
          weight * (slave->second.missing(slave_at_rest.at(xi)) + master->second.missing(master_at_rest.at(*image)));
    });
  }
  for (auto& [patch, gap] : of_patch)
    if (const auto weight = weights.find(patch); weight != weights.end()) gap /= weight->second;
  return of_patch;
}

std::optional<FacetGap> FacetGaps::of(std::int32_t zone, const Patchwise& patches, std::span<const double> displacement) {
  const ContactGeometry& geometry = contact_.geometry();
  const std::map<std::size_t, double>& gaps = of_patches(zone);
  const Curves& curves = this->curves(zone);
  std::set<std::size_t> near;
  double sum = 0, area = 0;
  std::vector<double> strains;
  for (const auto& [patch, gap] : gaps) {
    const bool active = patches.status[patch] == Status::active;
    if (!active && !(contact_.is_covered(patch) && geometry.gap(patch) < gap)) continue;
    near.insert(patch);
    sum += geometry.whole(patch) * gap;
    area += geometry.whole(patch);
    strains.push_back(active ? contact_.strain(patch, patches) : 0);
  }
  if (near.empty()) return std::nullopt;
  std::set<std::int32_t> slave_nodes, master_nodes;
  std::vector<double> curvatures;
  for (const ContactGeometry::Cell& cell : geometry.cells()) {
    const SlaveElement& element = definition_.slaves[static_cast<std::size_t>(cell.slave)];
    const auto slave = curves.slave.find(element.cell), master = curves.master.find(cell.master);
    if (!near.contains(static_cast<std::size_t>(element.patch)) || slave == curves.slave.end() || master == curves.master.end())
      continue;
    curvatures.push_back(std::max(slave->second.curvature(), master->second.curvature()));
    slave_nodes.insert(mesh_.cells[element.cell].begin(), mesh_.cells[element.cell].end());
    master_nodes.insert(mesh_.cells[cell.master].begin(), mesh_.cells[cell.master].end());
  }
  const double gap = sum / area, curvature = median(curvatures);
  if (std::abs(gap) * curvature < negligible) return std::nullopt;
  const auto dimension = static_cast<std::size_t>(mesh_.dimension);
  const Motion slave = motion(slave_nodes, displacement, dimension), master = motion(master_nodes, displacement, dimension);
  double apart = 0;
  for (std::size_t k = 0; k < dimension; ++k) apart = std::hypot(apart, slave.mean[k] - master.mean[k]);
  return FacetGap{gap, std::max(slave.deviation + master.deviation + apart, median(strains) / (2 * curvature))};
}

std::optional<FacetOverlap> FacetGaps::overlap(std::int32_t zone) {
  const ContactGeometry& geometry = contact_.geometry();
  const std::map<std::size_t, double>& gaps = of_patches(zone);
  std::optional<FacetOverlap> worst;
  double by_facets = 0, whole = 0;
  for (const auto& [patch, left] : gaps) {
    const double depth = -geometry.gap(patch) / contact_.patch_size(patch);
    if (!contact_.is_covered(patch) || depth < overlap_told) continue;
    whole += geometry.whole(patch);
    if (geometry.gap(patch) < explained * left) continue;
    by_facets += geometry.whole(patch);
    if (!worst || depth > worst->depth) worst = FacetOverlap{patch, depth};
  }
  return 2 * by_facets >= whole ? worst : std::nullopt;
}

std::optional<AlternatingPressures> FacetGaps::few_press(std::int32_t zone, const Patchwise& patches) {
  const ContactGeometry& geometry = contact_.geometry();
  const std::map<std::size_t, double>& gaps = of_patches(zone);
  // of those that press
  double farthest = -std::numeric_limits<double>::infinity(), largest = 0;  // gap between curves; strain
  AlternatingPressures found{0, 0, AlternatingBy::few_patches};
  std::size_t pressing = 0, near = 0;
  for (const auto& [patch, gap] : gaps) {
    if (patches.status[patch] != Status::active) continue;
    ++pressing;
    farthest = std::max(farthest, geometry.gap(patch) - gap);
    if (const double strain = contact_.strain(patch, patches); strain >= largest) largest = strain, found.patch = patch;
  }
  for (const auto& [patch, gap] : gaps)
    near += patches.status[patch] == Status::active || (contact_.is_covered(patch) && geometry.gap(patch) - gap <= farthest);
  if (pressing == 0 || near < fewest) return std::nullopt;
  found.pressing = static_cast<double>(pressing) / static_cast<double>(near);
  found.share = 1 - found.pressing;
  return found.pressing < few ? std::optional(found) : std::nullopt;
}

}  // namespace lacon
