#include "lacon/operators/contact/pairing_view.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "lacon/catalog/wording.hpp"
#include "lacon/elements/reference.hpp"
#include "lacon/operators/contact/contact_geometry.hpp"
#include "lacon/structures/vector.hpp"

namespace lacon {
namespace {

/// A layer while it is drawn: cells with their own nodes, and a value of some fields for each.
class Drawing {
 public:
  Drawing(std::string name, const Mesh& mesh) : layer_{.name = std::move(name), .mesh = {}, .fields = {}} {
    layer_.mesh.dimension = mesh.dimension;
  }

  using Values = std::vector<std::pair<const char*, double>>;

  /// @param group that the cell enters @param values a field that one cell has and another has not does not live there
  void add(CellType type, std::span<const Vec3> points, const std::string& group, const Values& values) {
    std::vector<std::int32_t> nodes;
    for (const Vec3& point : points) {
      nodes.push_back(static_cast<std::int32_t>(layer_.mesh.n_nodes()));
      layer_.mesh.coordinates.insert(layer_.mesh.coordinates.end(), {point.x, point.y, point.z});
    }
    const auto cell = static_cast<std::int32_t>(layer_.mesh.n_cells());
    layer_.mesh.add_cell(type, nodes);
    auto& groups = layer_.mesh.cell_groups;
    auto at = std::ranges::find(groups, group, &Group::name);
    if (at == groups.end()) at = groups.insert(at, Group{group, {}});
    at->members.push_back(cell);
    for (const auto& [name, value] : values) put(name, {name}, cell, {&value, 1});
  }

  /// Components of the cell that came last.
  void put_last(const char* name, const std::vector<std::string>& components, std::span<const double> values) {
    put(name, components, static_cast<std::int32_t>(layer_.mesh.n_cells()) - 1, values);
  }

  bool empty() const { return layer_.mesh.n_cells() == 0; }
  PairingLayer take() { return std::move(layer_); }

 private:
  void put(const char* name, const std::vector<std::string>& components, std::int32_t cell, std::span<const double> values) {
    auto field = std::ranges::find(layer_.fields, std::string_view(name), &Field::name);
    if (field == layer_.fields.end())
      field = layer_.fields.insert(
          field, Field{.name = name, .quantity = "NEUT_R", .location = Location::cells, .components = components});
    field->support.push_back(cell);
    field->values.insert(field->values.end(), values.begin(), values.end());
  }

  PairingLayer layer_;
};

/// A cell of the mesh at the current geometry.
class Places {
 public:
  Places(const Mesh& mesh, std::span<const double> coordinates) : mesh_(mesh), coordinates_(coordinates) {}

  std::vector<Vec3> nodes(std::int32_t cell) const {
    std::vector<Vec3> points;
    for (const std::int32_t node : mesh_.cells[static_cast<std::size_t>(cell)])
      points.push_back(vector_at(coordinates_.data() + 3 * std::ptrdiff_t{node}));
    return points;
  }
  /// The image of a reference point.
  Vec3 at(std::int32_t cell, std::span<const double> xi) const {
    const std::vector<Vec3> corners = nodes(cell);
    std::vector<double> shape(corners.size());
    shape_functions(mesh_.types[static_cast<std::size_t>(cell)], xi, shape);
    Vec3 image{};
    for (std::size_t a = 0; a < corners.size(); ++a) image = image + shape[a] * corners[a];
    return image;
  }
  /// The mean of the vertices.
  Vec3 middle(std::int32_t cell) const {
    const std::vector<Vec3> corners = nodes(cell);
    const auto n = static_cast<std::size_t>(mesh_.row(static_cast<std::size_t>(cell)).n_vertices);
    Vec3 sum{};
    for (std::size_t a = 0; a < n; ++a) sum = sum + corners[a];
    return sum / static_cast<double>(n);
  }

 private:
  const Mesh& mesh_;
  std::span<const double> coordinates_;
};

/// What is said of one zone, with all its numbers turned into those of the mesh.
class ZoneView {
 public:
  ZoneView(const Mesh& mesh, const Contact& contact, const ContactGeometry& geometry, std::size_t zone,
           const ZonePairing& record)
      : mesh_(mesh),
        contact_(contact),
        geometry_(geometry),
        number_(zone),
        zone_(geometry.zones()[zone]),
        record_(record),
        places_(mesh, geometry.coordinates()) {}

  void draw_pairs(Drawing& drawing) const {
    const ContactCells& cells = record_.pairing.cells;
    const auto reference = static_cast<std::size_t>(mesh_.dimension - 1);
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const SlaveElement& slave = slave_of(c);
      const auto first = static_cast<std::size_t>(cells.vertex_offset[c]),
                 end = static_cast<std::size_t>(cells.vertex_offset[c + 1]);
      std::vector<Vec3> corners;
      for (std::size_t v = first; v < end; ++v)
        corners.push_back(places_.at(slave.cell, std::span(cells.vertex).subspan(v * reference, reference)));
      const Drawing::Values values = {
          {"ZONE", number_ + 1.0},
          {"PATCH", slave.patch + 1.0},
          {"SLAVE", slave.cell + 1.0},
          {"MASTER", master_of(c) + 1.0},
          {"GAP", record_.gap[c]},
          {"MEASURE", record_.measure[c]},
          {"FRACTION", record_.measure[c] / geometry_.whole(static_cast<std::size_t>(slave.patch))}};
      const std::string group = name("PAIRS");
      if (mesh_.dimension == 2) {
        if (mesh_.row(static_cast<std::size_t>(slave.cell)).order == 2) {
          const double middle = (cells.vertex[first] + cells.vertex[first + 1]) / 2;
          corners.push_back(places_.at(slave.cell, {&middle, 1}));
        }
        drawing.add(corners.size() == 3 ? CellType::SEG3 : CellType::SEG2, corners, group, values);
      } else if (corners.size() <= 4) {
        drawing.add(corners.size() == 3 ? CellType::TRIA3 : CellType::QUAD4, corners, group, values);
      } else {
        for (std::size_t v = 2; v < corners.size(); ++v)
          drawing.add(CellType::TRIA3, std::array{corners[0], corners[v - 1], corners[v]}, group, values);
      }
    }
  }

  /// @param state CONT_ELEM by slave cell: status and pressure
  void draw_skins(Drawing& drawing, const std::map<std::int32_t, std::array<double, 2>>& state) const {
    std::vector<double> slave_couples(zone_.slaves.size()), master_couples(zone_.masters.size());
    std::vector<double> slave_rejected = slave_couples, master_rejected = master_couples;
    for (const auto& [couple, measure] : couples()) {
      ++slave_couples[static_cast<std::size_t>(couple.first)];
      ++master_couples[static_cast<std::size_t>(couple.second)];
    }
    for (const RejectedCouple& couple : record_.pairing.rejected) {
      if (couple.slave >= 0) ++slave_rejected[static_cast<std::size_t>(couple.slave)];
      if (couple.master >= 0) ++master_rejected[static_cast<std::size_t>(couple.master)];
    }
    for (std::size_t s = 0; s < zone_.slaves.size(); ++s) {
      const SlaveElement& slave = contact_.slaves[static_cast<std::size_t>(zone_.slaves[s])];
      const auto patch = static_cast<std::size_t>(slave.patch);
      Drawing::Values values = {{"ZONE", number_ + 1.0},       {"CELL", slave.cell + 1.0},
                                {"COUPLES", slave_couples[s]}, {"REJECTED", slave_rejected[s]},
                                {"PATCH", slave.patch + 1.0},  {"COVERAGE", geometry_.coverage(patch)},
                                {"GAP", geometry_.gap(patch)}};
      if (geometry_.covered(patch) == 0) values.pop_back();  // a gap to nothing
      if (const auto known = state.find(slave.cell); known != state.end()) {
        values.emplace_back("STATUS", known->second[0]);
        values.emplace_back("PRESSURE", known->second[1]);
      }
      drawing.add(mesh_.types[static_cast<std::size_t>(slave.cell)], places_.nodes(slave.cell), name("SLAVE"), values);
    }
    for (std::size_t m = 0; m < zone_.masters.size(); ++m)
      drawing.add(mesh_.types[static_cast<std::size_t>(zone_.masters[m])], places_.nodes(zone_.masters[m]), name("MASTER"),
                  {{"ZONE", number_ + 1.0},
                   {"CELL", zone_.masters[m] + 1.0},
                   {"COUPLES", master_couples[m]},
                   {"REJECTED", master_rejected[m]}});
  }

  void draw_points(Drawing& drawing) const {
    const ContactCells& cells = record_.pairing.cells;
    const auto reference = static_cast<std::size_t>(mesh_.dimension - 1);
    static const std::vector<std::string> axes = {"DX", "DY", "DZ"};
    const std::vector<std::string> components(axes.begin(), axes.begin() + mesh_.dimension);
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const SlaveElement& slave = slave_of(c);
      for (auto p = static_cast<std::size_t>(cells.offset[c]); p < static_cast<std::size_t>(cells.offset[c + 1]); ++p) {
        const Vec3 x = places_.at(slave.cell, std::span(cells.slave_point).subspan(p * reference, reference));
        const Vec3 image = places_.at(master_of(c), std::span(cells.master_point).subspan(p * reference, reference));
        drawing.add(CellType::POI1, {&x, 1}, name("POINTS"),
                    {{"ZONE", number_ + 1.0},
                     {"PATCH", slave.patch + 1.0},
                     {"SLAVE", slave.cell + 1.0},
                     {"MASTER", master_of(c) + 1.0},
                     {"GAP", record_.point_gap[p]},
                     {"WEIGHT", cells.weight[p]}});
        const Vec3 difference = image - x;
        const std::array way = {difference.x, difference.y, difference.z};
        drawing.put_last("TO_MASTER", components, std::span(way).first(components.size()));
      }
    }
  }

  void draw_rejected(Drawing& drawing) const {
    for (const RejectedCouple& couple : record_.pairing.rejected) {
      std::vector<Vec3> ends;
      Drawing::Values values = {{"ZONE", number_ + 1.0}};
      if (couple.slave >= 0) {
        ends.push_back(places_.middle(rejected_slave(couple).cell));
        values.emplace_back("SLAVE", rejected_slave(couple).cell + 1.0);
      }
      if (couple.master >= 0) {
        ends.push_back(places_.middle(rejected_master(couple)));
        values.emplace_back("MASTER", rejected_master(couple) + 1.0);
      }
      values.emplace_back("REASON", static_cast<double>(couple.reason));
      drawing.add(ends.size() == 2 ? CellType::SEG2 : CellType::POI1, ends, std::string(rejection_name(couple.reason)), values);
    }
  }

  void report(std::vector<std::string>& lines) const {
    const ContactZone& data = contact_.zones[number_];
    double covered = 0, whole = 0;
    for (const std::int32_t patch : data.patches) {
      covered += geometry_.covered(static_cast<std::size_t>(patch));
      whole += geometry_.whole(static_cast<std::size_t>(patch));
    }
    lines.push_back("  " + part("zone_pairing", {{"zone", std::to_string(number_ + 1)},
                                                 {"slave", data.slave_group},
                                                 {"master", data.master_group},
                                                 {"slaves", std::to_string(zone_.slaves.size())},
                                                 {"patches", std::to_string(data.patches.size())},
                                                 {"masters", std::to_string(zone_.masters.size())},
                                                 {"cells", std::to_string(record_.pairing.cells.size())},
                                                 {"covered", fmt::format("{:.6g}", covered)},
                                                 {"whole", fmt::format("{:.6g}", whole)},
                                                 {"percent", fmt::format("{:.4g}", whole > 0 ? 100 * covered / whole : 0)}}));
    std::vector<std::string> counts;
    for (int r = 0; r < n_rejections; ++r)
      if (const auto n = record_.pairing.count(static_cast<Rejection>(r)); n > 0)
        counts.push_back(fmt::format("{} {}", n, rejection_words(static_cast<Rejection>(r))));
    if (!counts.empty())
      lines.push_back("    " + part("couples_rejected", {{"reasons", fmt::format("{}", fmt::join(counts, ", "))}}));
    report_patches(lines);
  }

 private:
  /// Below it a patch is named as not wholly covered: the measures of curved facets are those of a quadrature.
  static constexpr double whole_coverage = 1 - 1e-4;
  static constexpr std::size_t most_patches = 10;

  const SlaveElement& slave_of(std::size_t contact_cell) const {
    return contact_
        .slaves[static_cast<std::size_t>(zone_.slaves[static_cast<std::size_t>(record_.pairing.cells.slave[contact_cell])])];
  }
  std::int32_t master_of(std::size_t contact_cell) const {
    return zone_.masters[static_cast<std::size_t>(record_.pairing.cells.master[contact_cell])];
  }
  const SlaveElement& rejected_slave(const RejectedCouple& couple) const {
    return contact_.slaves[static_cast<std::size_t>(zone_.slaves[static_cast<std::size_t>(couple.slave)])];
  }
  std::int32_t rejected_master(const RejectedCouple& couple) const {
    return zone_.masters[static_cast<std::size_t>(couple.master)];
  }
  std::string name(const char* role) const { return fmt::format("{}_{}", role, number_ + 1); }

  /// (slave, master), numbers of the zone, and what they have in common: a curved slave meets a master in several contact
  /// cells.
  std::map<std::pair<std::int32_t, std::int32_t>, double> couples() const {
    std::map<std::pair<std::int32_t, std::int32_t>, double> measures;
    const ContactCells& cells = record_.pairing.cells;
    for (std::size_t c = 0; c < cells.size(); ++c) measures[{cells.slave[c], cells.master[c]}] += record_.measure[c];
    return measures;
  }

  /// The patches that are not wholly covered, the least covered first.
  void report_patches(std::vector<std::string>& lines) const {
    std::vector<std::int32_t> partial;
    for (const std::int32_t patch : contact_.zones[number_].patches)
      if (geometry_.coverage(static_cast<std::size_t>(patch)) < whole_coverage) partial.push_back(patch);
    std::ranges::stable_sort(partial, {},
                             [&](std::int32_t patch) { return geometry_.coverage(static_cast<std::size_t>(patch)); });
    std::map<std::int32_t, std::vector<std::string>> told;  // of the patches that are named
    for (std::size_t i = 0; i < std::min(partial.size(), most_patches); ++i) told[partial[i]];
    const auto tell = [&](const SlaveElement& slave, std::string text) {
      if (const auto patch = told.find(slave.patch); patch != told.end()) patch->second.push_back(std::move(text));
    };
    for (const auto& [couple, measure] : couples()) {
      const SlaveElement& slave =
          contact_.slaves[static_cast<std::size_t>(zone_.slaves[static_cast<std::size_t>(couple.first)])];
      tell(slave,
           part("cell_on_cell",
                {{"slave", cell_name(slave.cell)},
                 {"master", cell_name(zone_.masters[static_cast<std::size_t>(couple.second)])},
                 {"said", fmt::format("{:.4g} %", 100 * measure / geometry_.whole(static_cast<std::size_t>(slave.patch)))}}));
    }
    for (const RejectedCouple& couple : record_.pairing.rejected)
      if (couple.slave >= 0 && couple.master >= 0)
        tell(rejected_slave(couple), part("cell_on_cell", {{"slave", cell_name(rejected_slave(couple).cell)},
                                                           {"master", cell_name(rejected_master(couple))},
                                                           {"said", rejection_words(couple.reason)}}));
    for (const std::int32_t patch : partial) {
      const auto text = told.find(patch);
      if (text == told.end()) break;
      lines.push_back(
          "    " +
          part("patch_covered", {{"patch", std::to_string(patch + 1)},
                                 {"percent", fmt::format("{:.4g}", 100 * geometry_.coverage(static_cast<std::size_t>(patch)))},
                                 {"said", text->second.empty() ? part("no_master_along_normals")
                                                               : fmt::format("{}", fmt::join(text->second, "; "))}}));
    }
    if (partial.size() > most_patches)
      lines.push_back("    " + part("more_patches", {{"count", std::to_string(partial.size() - most_patches)}}));
  }

  const Mesh& mesh_;
  const Contact& contact_;
  const ContactGeometry& geometry_;
  std::size_t number_;
  const ContactGeometry::Zone& zone_;
  const ZonePairing& record_;
  Places places_;
};

}  // namespace

PairingView view_pairing(const Mesh& mesh, const Model& model, const Contact& contact, Registry& registry,
                         const ViewedInstant& instant) {
  ContactGeometry geometry(mesh, model, contact, registry);
  const std::vector<double> nowhere(mesh.n_nodes() * static_cast<std::size_t>(mesh.dimension), 0.0);
  std::vector<ZonePairing> records;
  const std::span<const double> displacement = instant.displacement.empty() ? nowhere : instant.displacement;
  geometry.find_ends(instant.held);
  geometry.rest_at(displacement);
  geometry.keep(instant.kept);
  geometry.set_offsets(instant.offsets);
  geometry.update(displacement);
  geometry.choose_masters();
  geometry.update(displacement, &records);

  std::map<std::int32_t, std::array<double, 2>> state;
  if (const std::optional<Field>& cont_elem = instant.cont_elem) {
    const auto status = static_cast<std::size_t>(cont_elem->component("CONT"));
    const auto pressure = static_cast<std::size_t>(cont_elem->component("PRES"));
    for (std::size_t i = 0; i < cont_elem->support.size(); ++i)
      state[cont_elem->support[i]] = {cont_elem->at(i, status), cont_elem->at(i, pressure)};
  }
  PairingView view;
  Drawing pairs("PAIRS", mesh), skins("SKINS", mesh), points("POINTS", mesh), rejected("REJECTED", mesh);
  for (std::size_t z = 0; z < records.size(); ++z) {
    const ZoneView zone(mesh, contact, geometry, z, records[z]);
    zone.draw_pairs(pairs);
    zone.draw_skins(skins, state);
    zone.draw_points(points);
    zone.draw_rejected(rejected);
    zone.report(view.report);
  }
  for (Drawing* drawing : {&pairs, &skins, &points, &rejected})
    if (!drawing->empty()) view.layers.push_back(drawing->take());
  return view;
}

std::string rejection_words(Rejection rejection) {
  std::string name(rejection_name(rejection));
  std::ranges::replace(name, ' ', '_');
  return part(name);
}

}  // namespace lacon
