#include "lacon/operators/contact/contact_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "lacon/catalog/messages.hpp"
#include "lacon/elements/reference.hpp"
#include "lacon/operators/contact/boundary.hpp"
#include "lacon/operators/contact/facets.hpp"
#include "lacon/operators/contact/facing.hpp"
#include "lacon/pairing/free_ends.hpp"
#include "lacon/pairing/normals.hpp"
#include "lacon/pairing/thickness.hpp"
#include "lacon/structures/bodies.hpp"
#include "lacon/structures/displacement.hpp"
#include "lacon/structures/memory.hpp"
#include "lacon/structures/parallel.hpp"

namespace lacon {
namespace {

/// Coordinates of a cell's nodes, (n_nodes, dimension), to `out`, which moves behind them.
void copy_points(const Mesh& mesh, std::span<const double> coordinates, std::int32_t cell, int dimension, double*& out) {
  for (const std::int32_t node : mesh.cells[cell])
    out = std::copy_n(coordinates.data() + 3 * std::ptrdiff_t{node}, dimension, out);
}

/// Some of the contact cells, without their polygons.
void select(const ContactCells& cells, std::span<const std::int32_t> members, ContactCells& some) {
  some.clear();
  some.dimension = cells.dimension;
  const std::ptrdiff_t reference = cells.dimension - 1;
  const auto append = [](const std::vector<double>& from, std::ptrdiff_t first, std::ptrdiff_t last, std::vector<double>& to) {
    to.insert(to.end(), from.begin() + first, from.begin() + last);
  };
  for (const std::int32_t c : members) {
    const std::int64_t first = cells.offset[c], last = cells.offset[c + 1];
    some.slave.push_back(cells.slave[c]);
    some.master.push_back(cells.master[c]);
    append(cells.weight, first, last, some.weight);
    append(cells.slave_point, first * reference, last * reference, some.slave_point);
    append(cells.master_point, first * reference, last * reference, some.master_point);
    some.offset.push_back(static_cast<std::int64_t>(some.weight.size()));
  }
}

/// The first `size` numbers of an array that only grows.
template <class Number>
std::span<Number> room(std::vector<Number>& numbers, std::size_t size) {
  if (numbers.size() < size) numbers.resize(size);
  return {numbers.data(), size};
}

/// A batch without arrays: those that are not given are not wanted.
lacon_contact_batch batch_of(std::size_t n_cells, int n_slave_nodes, int n_master_nodes, int dimension, bool current_jacobian) {
  lacon_contact_batch batch{};
  batch.struct_size = sizeof(batch);
  batch.n_cells = static_cast<std::int32_t>(n_cells);
  batch.n_slave_nodes = n_slave_nodes;
  batch.n_master_nodes = n_master_nodes;
  batch.dimension = dimension;
  batch.current_jacobian = current_jacobian ? 1 : 0;
  return batch;
}

constexpr std::size_t block = 128;  // slave cells that a thread takes at a time
constexpr double grazed = 1e-4;     // of a patch: a part of it whose points have no say
// Bodies that are pressed on one another overlap by a fraction of a facet, coarse curved skins and press fits by one or two.
// What is deeper a normal meets beyond the body: the far side of a skin that is slave as a whole, the end of another body.
constexpr double deepest_overlap = 4;  // diameters of the larger cell of a couple
// Of the reference coordinate of a slave cell, -1 to 1: wide enough for the stiffness that forces have across it, pressure
// times gap over its width, to be less than that of the body, narrow enough to be a tenth of a per mille of what a patch is
// covered by.
constexpr double fading = 2e-3;
constexpr double coverage_round_off = 1e-12;  // covered fractions above 1 by no more than this are 1

/// Room for what is still to come. @param whole what will have come behind `first` in the end, over what has come so far
template <class T>
void make_room(std::vector<T>& array, std::size_t first, double whole) {
  const double more = whole * static_cast<double>(array.size() - first);
  reserve_pages(array, first + static_cast<std::size_t>(more), first + static_cast<std::size_t>(1.05 * more));
}

}  // namespace

/// Contact cells of one slave element (which says the kernel and the kind of cell) and one kind of master cell, for one call of
/// the kernel, and what it says of them. Its arrays serve one block after another.
struct ContactGeometry::Alike {
  std::int32_t element;
  CellType master_type;
  std::vector<std::int32_t> members;  ///< contact cells of the block
  ContactCells some;                  ///< these, where the block has others too
  std::vector<double> slave_shape, slave_gradient, master_shape, slave_initial, slave, master, slave_normal;
  std::vector<double> point_gap, gap, measure, current_measure, coupling, offset, offset_integral;
  std::vector<std::int32_t> error;
};

/// Some slave cells of a zone, as one thread works on them.
struct ContactGeometry::Block {
  Pairing pairing;
  std::vector<Alike> groups;
};

ContactGeometry::ContactGeometry(const Mesh& mesh, const Model& model, const Contact& contact, Registry& registry)
    : mesh_(mesh),
      model_(model),
      contact_(contact),
      registry_(registry),
      coordinates_(mesh.coordinates),
      rest_(mesh.coordinates) {
  const Bodies bodies(mesh);
  for (std::int32_t node = 0; node < static_cast<std::int32_t>(mesh.n_nodes()); ++node) body_.push_back(bodies.of(node));
  const std::size_t n = mesh.patches->size();
  gap_.assign(n, 0.0);
  size_ = weight_ = covered_ = whole_ = coverage_ = smallest_gap_ = largest_gap_ = gap_;
  beside_wall_.assign(n, false);
  straight_.assign(n, 1);
  zone_of_.assign(n, -1);
  rejected_.assign(n_rejections, 0);

  std::map<std::int32_t, std::int32_t> slave_of_cell;
  for (std::size_t s = 0; s < contact_.slaves.size(); ++s)
    slave_of_cell[contact_.slaves[s].cell] = static_cast<std::int32_t>(s);
  boundary_ = boundary_of(mesh, model, contact, body_, coordinates_);
  const WaysThrough ways({&boundary_});
  for (const ContactZone& data : contact_.zones) {
    Zone zone{.slaves = {},
              .masters = data.master,
              .slave = surface_of(mesh, data.slave, coordinates_),
              .master = surface_of(mesh, data.master, coordinates_),
              .current_jacobian = data.jacobian == "ACTUALISE",
              .pairing = {.distance_limit = data.distance_limit,
                          .depth_limit = data.distance_limit > 0 ? -1 : deepest_overlap,
                          .drops_slivers = !contact.frozen_gap}};
    zone.slave.rest = zone.master.rest = rest_;
    zone.slave.body = zone.master.body = body_;
    zone.slave_thickness = thickness(zone.slave, ways);
    zone.master_thickness = thickness(zone.master, ways);
    zone.slave.thickness = zone.slave_thickness;
    zone.master.thickness = zone.master_thickness;
    for (const std::int32_t cell : data.slave) zone.slaves.push_back(slave_of_cell.at(cell));
    for (std::size_t i = 0; i < zone.masters.size(); ++i) zone.places[zone.masters[i]] = static_cast<std::int32_t>(i);
    for (const std::int32_t patch : data.patches) zone_of_[patch] = static_cast<std::int32_t>(zones_.size());
    if (!contact.frozen_gap) {
      zone.pairing.fading = fading;
      std::vector<std::int32_t> patches;
      for (const std::int32_t slave : zone.slaves) patches.push_back(contact.slaves[slave].patch);
      zone.inner = inner_nodes(zone.slave, patches);
      zone.slave.inner = zone.inner;
      zone.free_ends = free_ends(zone.master);
      zone.master.free_ends = zone.free_ends;
      zone.faces = faces(zone.master);
      zone.one_face = std::ranges::all_of(zone.faces, [](std::int32_t face) { return face == 0; });
    }
    zones_.push_back(std::move(zone));
  }
  if (contact.smoothing && !contact.frozen_gap)
    for (const Zone& zone : zones_) normal_variations_.emplace_back(zone.slave);
  for (const SlaveElement& slave : contact_.slaves) {
    size_[slave.patch] += cell_extent(mesh, slave.cell);
    const lacon_kernel*& kernel = kernels_[model_.element[slave.cell]];
    if (!kernel) kernel = &kernel_of(slave.cell);
  }

  if (mesh.dimension == 3)
    for (double& size : size_) size = std::sqrt(size);
  measure_slaves();
  check_radii();
}

void ContactGeometry::note(std::int32_t error, const SlaveElement& slave) {
  if (error == LACON_BAD_RADIUS)
    over_axis_ = slave.cell;
  else if (error != LACON_FINE)
    no_normal(slave);
}

void ContactGeometry::no_normal(const SlaveElement& slave) const {
  fail("EVOLUTION_3",
       {{"cell", cell_name(slave.cell)},
        {"group", contact_.zones[static_cast<std::size_t>(zone_of(static_cast<std::size_t>(slave.patch)))].slave_group}});
}

void ContactGeometry::check_radii() const {
  if (over_axis_) fail("EVOLUTION_8", {{"cell", cell_name(*over_axis_)}});
}

const lacon_kernel& ContactGeometry::kernel_of(std::int32_t cell) const {
  const std::int32_t element = model_.element[cell];
  const catalog::ElementRow* row = element < 0 ? nullptr : registry_.find_element(model_.elements[element]);
  if (!row) fail("PLUGIN_4", {{"element", element < 0 ? "none, on cell " + cell_name(cell) : model_.elements[element]}});
  return registry_.kernel(*row, "RIGI_CONT", LACON_CONTACT);
}

void ContactGeometry::measure_slaves() {
  const int dimension = mesh_.dimension;
  std::fill(whole_.begin(), whole_.end(), 0.0);
  std::map<std::int32_t, std::vector<std::int32_t>> by_element;  // one kernel, one kind of cell
  for (std::size_t s = 0; s < contact_.slaves.size(); ++s)
    by_element[model_.element[contact_.slaves[s].cell]].push_back(static_cast<std::int32_t>(s));
  for (const auto& [element, members] : by_element) {
    const CellType type = mesh_.types[contact_.slaves[members.front()].cell];
    const lacon_kernel& kernel = *kernels_.at(element);
    // each cell on itself: the kernel says what its measure is
    const Tabulation table = tabulate(type, measuring_rule(type));
    std::vector<std::int64_t> offset{0};
    const std::size_t width = static_cast<std::size_t>(table.n_nodes) * dimension;
    std::vector<double> weight, shape, gradient, initial(block * width), current(block * width), size(block);
    std::vector<std::int32_t> error(block);
    for (std::size_t i = 0; i < std::min(block, members.size()); ++i) {
      weight.insert(weight.end(), table.weight.begin(), table.weight.end());
      shape.insert(shape.end(), table.shape.begin(), table.shape.end());
      gradient.insert(gradient.end(), table.gradient.begin(), table.gradient.end());
      offset.push_back(static_cast<std::int64_t>(weight.size()));
    }
    for (std::size_t first = 0; first < members.size(); first += block) {
      const auto some = std::span(members).subspan(first, std::min(block, members.size() - first));
      double *to_initial = initial.data(), *to_current = current.data();
      for (const std::int32_t s : some) {
        copy_points(mesh_, mesh_.coordinates, contact_.slaves[s].cell, dimension, to_initial);
        copy_points(mesh_, coordinates_, contact_.slaves[s].cell, dimension, to_current);
      }
      std::fill(error.begin(), error.end(), LACON_FINE);
      lacon_contact_batch batch = batch_of(some.size(), table.n_nodes, table.n_nodes, dimension, true);
      batch.offset = offset.data();
      batch.weight = weight.data();
      batch.slave_shape = batch.master_shape = shape.data();
      batch.slave_gradient = gradient.data();
      batch.slave_initial = initial.data();
      batch.slave = batch.master = current.data();
      batch.current_measure = size.data();
      batch.error = error.data();
      kernel.contact(&batch);
      for (std::size_t i = 0; i < some.size(); ++i) {
        const SlaveElement& slave = contact_.slaves[some[i]];
        note(error[i], slave);
        whole_[slave.patch] += size[i];
      }
    }
  }
}

void ContactGeometry::rest_at(std::span<const double> displacement) {
  const std::vector<double> before = rest_;
  displace(mesh_, displacement, mesh_.dimension, rest_);
  keep_left_out(rest_ == before);
  decide_walls({});
  cuts_end_ = true;
  mirror();
}

bool ContactGeometry::keeps_cuts() const {
  return std::ranges::any_of(zones_, [](const Zone& zone) { return std::ranges::any_of(zone.cuts, &SlaveCut::kept); });
}

std::vector<std::int32_t> ContactGeometry::cuts() const {
  std::vector<std::int32_t> all;
  for (const Zone& zone : zones_)
    for (const SlaveCut& cut : zone.cuts) all.insert(all.end(), {cut.steps, cut.curved, cut.affine});
  return all;
}

void ContactGeometry::set_cuts(std::span<const std::int32_t> cuts) {
  if (cuts.empty()) return;
  cuts_end_ = false;
  auto next = cuts.begin();
  for (Zone& zone : zones_) {
    zone.cuts.clear();
    for (std::size_t i = 0; i < zone.slave.size(); ++i, next += 3)
      zone.cuts.push_back({.steps = static_cast<std::uint8_t>(next[0]), .curved = next[1] != 0, .affine = next[2] != 0});
    zone.slave.cuts = zone.cuts;
  }
}

void ContactGeometry::update(std::span<const double> displacement, std::vector<ZonePairing>* records) {
  displace(mesh_, displacement, mesh_.dimension, coordinates_);
  look(records);
}

void ContactGeometry::look(std::vector<ZonePairing>* records) {
  over_axis_.reset();
  measure_slaves();
  cells_.clear();
  coupling_.clear();
  std::fill(rejected_.begin(), rejected_.end(), 0);
  too_deep_.assign(zones_.size(), {});
  for (std::vector<double>* sums : {&gap_, &weight_, &covered_}) std::fill(sums->begin(), sums->end(), 0.0);
  std::fill(smallest_gap_.begin(), smallest_gap_.end(), std::numeric_limits<double>::infinity());
  std::fill(largest_gap_.begin(), largest_gap_.end(), -std::numeric_limits<double>::infinity());
  std::fill(straight_.begin(), straight_.end(), 1);
  walls_.clear();
  beside_wall_.assign(n_patches(), false);
  if (records) records->clear();
  normals_.resize(zones_.size());
  if (std::exchange(cuts_end_, false) && mesh_.dimension == 3)
    for (Zone& zone : zones_) {
      zone.cuts.assign(zone.slave.size(), {});
      zone.slave.cuts = zone.cuts;
    }
  const WaysWhenAsked ways({&boundary_});
  for (Zone& zone : zones_) {
    const auto z = static_cast<std::size_t>(&zone - zones_.data());
    zone.slave.normals = {};
    if (contact_.smoothing) normals_[z] = nodal_normals(zone.slave);
    zone.slave.normals = normals_[z];
    // a few blocks for each thread at a time: points of a large skin are never in memory together
    PairingOptions options = zone.pairing;
    options.ways = &ways;
    PairingInParts pairing(zone.slave, zone.master, options);
    ZonePairing* const record = records ? &records->emplace_back() : nullptr;
    const std::size_t n_blocks = n_loop_blocks(zone.slave.size(), block), threads = n_threads();
    const std::size_t first_cell = cells_.size(), first_coupling = coupling_.size();
    std::vector<Block> blocks(std::min(threads == 1 ? 1 : 8 * threads, n_blocks));
    for (std::size_t done = 0; done < n_blocks; done += blocks.size()) {
      const std::size_t some = std::min(blocks.size(), n_blocks - done);
      parallel_for(some, 1, [&](const LoopBlock& one) {
        Block& b = blocks[one.index];
        const std::size_t first = (done + one.index) * block;
        pairing.pair(first, std::min(first + block, zone.slave.size()), b.pairing);
        integrate(zone, b.pairing.cells, b.groups);
      });
      for (std::size_t i = 0; i < some; ++i) add(zone, blocks[i], record);
      // grown by doubling alone these arrays would take up to three times their size
      if (done < n_blocks / 8 && done + some >= n_blocks / 8) {
        const double whole = static_cast<double>(n_blocks) / static_cast<double>(done + some);
        make_room(cells_, first_cell, whole);
        make_room(coupling_, first_coupling, whole);
      }
    }
  }
  for (std::size_t p = 0; p < gap_.size(); ++p) {
    if (weight_[p] > 0) gap_[p] /= weight_[p];
    coverage_[p] = whole_[p] > 0 ? covered_[p] / whole_[p] : 0;
    // what is above 1 by more is an error of quadrature or of pairing, and shows
    if (coverage_[p] > 1 && coverage_[p] <= 1 + coverage_round_off) coverage_[p] = 1;
  }
}

void ContactGeometry::integrate(const Zone& zone, const ContactCells& cells, std::vector<Alike>& groups) const {
  for (Alike& group : groups) group.members.clear();
  Alike* group = nullptr;
  for (std::int32_t c = 0; c < static_cast<std::int32_t>(cells.size()); ++c) {
    const std::int32_t element = model_.element[contact_.slaves[zone.slaves[cells.slave[c]]].cell];
    const CellType master_type = zone.master.types[cells.master[c]];
    if (!group || group->element != element || group->master_type != master_type) {
      // in the order of kinds, whatever blocks were there before
      const auto key = [](const Alike& g) { return std::pair(g.element, g.master_type); };
      const auto place =
          std::find_if(groups.begin(), groups.end(), [&](const Alike& g) { return key(g) >= std::pair(element, master_type); });
      const bool there = place != groups.end() && key(*place) == std::pair(element, master_type);
      group = &*(there ? place : groups.insert(place, Alike{.element = element, .master_type = master_type}));
    }
    group->members.push_back(c);
  }
  for (Alike& g : groups) {
    if (g.members.empty()) continue;
    const bool all = g.members.size() == cells.size();
    if (!all) select(cells, g.members, g.some);
    evaluate(zone, all ? cells : g.some, g);
  }
}

void ContactGeometry::evaluate(const Zone& zone, const ContactCells& cells, Alike& group) const {
  const int dimension = mesh_.dimension;
  const auto slave_cell = [&](std::size_t c) { return contact_.slaves[zone.slaves[cells.slave[c]]].cell; };
  const std::size_t n = cells.size(), points = cells.weight.size();
  const CellType slave_type = mesh_.types[slave_cell(0)];
  const int ns = catalog::cell(slave_type).n_nodes, nm = catalog::cell(group.master_type).n_nodes;

  shape_functions(slave_type, cells.slave_point, room(group.slave_shape, points * ns));
  shape_gradients(slave_type, cells.slave_point, room(group.slave_gradient, points * ns * (dimension - 1)));
  shape_functions(group.master_type, cells.master_point, room(group.master_shape, points * nm));

  const std::span<const double> normals = zone.slave.normals;
  double *initial = room(group.slave_initial, n * ns * dimension).data(), *slave = room(group.slave, n * ns * dimension).data(),
         *master = room(group.master, n * nm * dimension).data(),
         *normal = room(group.slave_normal, normals.empty() ? 0 : n * ns * dimension).data();
  for (std::size_t c = 0; c < n; ++c) {
    copy_points(mesh_, mesh_.coordinates, slave_cell(c), dimension, initial);
    copy_points(mesh_, coordinates_, slave_cell(c), dimension, slave);
    copy_points(mesh_, coordinates_, zone.masters[cells.master[c]], dimension, master);
    if (!normals.empty()) copy_points(mesh_, normals, slave_cell(c), dimension, normal);
  }

  std::fill_n(room(group.error, n).begin(), n, LACON_FINE);
  lacon_contact_batch batch = batch_of(n, ns, nm, dimension, zone.current_jacobian);
  batch.offset = cells.offset.data();
  batch.weight = cells.weight.data();
  batch.slave_shape = group.slave_shape.data();
  batch.slave_gradient = group.slave_gradient.data();
  batch.master_shape = group.master_shape.data();
  batch.slave_initial = group.slave_initial.data();
  batch.slave = group.slave.data();
  batch.master = group.master.data();
  batch.slave_normal = normals.empty() ? nullptr : group.slave_normal.data();
  batch.point_gap = room(group.point_gap, points).data();
  batch.gap = room(group.gap, n).data();
  batch.measure = room(group.measure, n).data();
  batch.current_measure = room(group.current_measure, n).data();
  batch.coupling = room(group.coupling, n * (ns + nm) * dimension).data();
  batch.error = group.error.data();
  kernels_.at(group.element)->contact(&batch);
  const auto number = static_cast<std::size_t>(&zone - zones_.data());
  if (has_offset(number)) offset_gaps(number, cells, batch, group);
}

void ContactGeometry::offset_gaps(std::size_t zone, const ContactCells& cells, lacon_contact_batch batch, Alike& group) const {
  const std::span<double> at_point = room(group.offset, cells.weight.size()),
                          integral = room(group.offset_integral, cells.size());
  const auto n = static_cast<std::size_t>(batch.n_slave_nodes);
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const auto nodes = mesh_.cells[contact_.slaves[zones_[zone].slaves[cells.slave[c]]].cell];
    for (auto p = static_cast<std::size_t>(cells.offset[c]); p < static_cast<std::size_t>(cells.offset[c + 1]); ++p) {
      double offset = 0;
      for (std::size_t a = 0; a < n; ++a)
        offset += batch.slave_shape[p * n + a] * offsets_[zone][static_cast<std::size_t>(nodes[a])];
      batch.point_gap[p] -= offset;
      at_point[p] = cells.weight[p] * offset;
    }
  }
  // the measure with these weights is the integral of the offset
  double* const gap = batch.gap;
  batch.weight = at_point.data();
  batch.measure = integral.data();
  batch.point_gap = batch.gap = batch.current_measure = batch.coupling = nullptr;
  kernels_.at(group.element)->contact(&batch);
  for (std::size_t c = 0; c < cells.size(); ++c) gap[c] -= integral[c];
}

void ContactGeometry::add(const Zone& zone, const Block& block_of_zone, ZonePairing* record) {
  const ContactCells& cells = block_of_zone.pairing.cells;
  for (const RejectedCouple& couple : block_of_zone.pairing.rejected) {
    if (couple.reason == Rejection::degenerate_slave) no_normal(contact_.slaves[zone.slaves[couple.slave]]);
    ++rejected_[static_cast<std::size_t>(couple.reason)];
    if (couple.reason == Rejection::wall) {
      walls_.emplace_back(zone.slaves[couple.slave], zone.masters[couple.master]);
      beside_wall_[static_cast<std::size_t>(contact_.slaves[walls_.back().first].patch)] = true;
    }
    if (couple.reason != Rejection::too_deep) continue;
    TooDeep& deep = too_deep_[static_cast<std::size_t>(&zone - zones_.data())];
    if (deep.count++ == 0) deep.slave = contact_.slaves[zone.slaves[couple.slave]].cell;
  }
  std::size_t recorded_points = 0, recorded = 0;
  if (record) {
    recorded_points = record->point_gap.size();
    recorded = record->gap.size();
    record->pairing.append(block_of_zone.pairing);
    record->point_gap.resize(recorded_points + cells.weight.size());
    record->gap.resize(recorded + cells.size());
    record->measure.resize(recorded + cells.size());
  }
  for (const Alike& group : block_of_zone.groups) {
    if (group.members.empty()) continue;
    const CellType slave_type = mesh_.types[contact_.slaves[zone.slaves[cells.slave[group.members.front()]]].cell];
    const std::ptrdiff_t width =
        std::ptrdiff_t{catalog::cell(slave_type).n_nodes + catalog::cell(group.master_type).n_nodes} * mesh_.dimension;
    auto at = static_cast<std::int64_t>(coupling_.size());
    coupling_.insert(coupling_.end(), group.coupling.begin(),
                     group.coupling.begin() + static_cast<std::ptrdiff_t>(group.members.size()) * width);
    const double* point_gap = group.point_gap.data();
    for (std::size_t i = 0; i < group.members.size(); ++i, at += width) {
      const std::int32_t c = group.members[i], s = zone.slaves[cells.slave[c]], patch = contact_.slaves[s].patch;
      note(group.error[i], contact_.slaves[s]);
      gap_[patch] += group.gap[i];
      weight_[patch] += group.measure[i];
      covered_[patch] += group.current_measure[i];
      const std::int64_t n_points = cells.offset[c + 1] - cells.offset[c];
      const double* const first_gap = std::exchange(point_gap, point_gap + n_points);
      const auto [least, most] = std::minmax_element(first_gap, point_gap);
      cells_.push_back(
          {s, zone.masters[cells.master[c]], cells.master[c], group.gap[i], group.current_measure[i], *least, *most, at});
      for (const double gap : std::span(first_gap, point_gap)) {
        // a wall that is grazed, as beside a corner, is as good as not there
        if (group.current_measure[i] > grazed * whole_[patch]) smallest_gap_[patch] = std::min(smallest_gap_[patch], gap);
        largest_gap_[patch] = std::max(largest_gap_[patch], std::abs(gap));
      }
      if (catalog::cell(slave_type).order > 1 || catalog::cell(group.master_type).order > 1) straight_[patch] = 0;
      if (!record) continue;
      std::copy_n(first_gap, n_points,
                  record->point_gap.begin() + static_cast<std::ptrdiff_t>(recorded_points) + cells.offset[c]);
      record->gap[recorded + c] = group.gap[i] / group.measure[i];
      record->measure[recorded + c] = group.current_measure[i];
    }
  }
}

}  // namespace lacon
