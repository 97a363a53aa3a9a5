#include "lacon/assembly/parts/solid_parts.hpp"

#include <algorithm>
#include <cstring>
#include <functional>
#include <tuple>
#include <utility>

#include "lacon/assembly/parts/parcel.hpp"
#include "lacon/catalog/messages.hpp"

namespace lacon {
namespace {

std::vector<std::int32_t> cells_of(std::span<const ElementSet> sets) {
  std::vector<std::int32_t> cells;
  for (const ElementSet& set : sets) cells.insert(cells.end(), set.cells.begin(), set.cells.end());
  return cells;
}

/// What cells take of memory and time, about.
std::vector<std::int32_t> weights_of(std::span<const ElementSet> sets) {
  std::vector<std::int32_t> weights;
  for (const ElementSet& set : sets) weights.insert(weights.end(), set.cells.size(), set.n_nodes() * set.tabulation.n_points);
  return weights;
}

/// Of parcels, each of which is an open file.
constexpr int parcels_at_once = 16;

SharedMemory in_shared_memory(std::span<const std::byte> bytes) {
  SharedMemory memory(bytes.size());
  std::ranges::copy(bytes, memory.data());
  return memory;
}

}  // namespace

PartCells cells_of_part(const PartSource& source, int part) {
  const auto& [mesh, sets, numbering, partition, blocks] = source;
  PartCells made{.dimension = blocks.dimension};
  std::vector<std::int32_t> local(mesh.n_nodes(), -1);
  std::size_t at = 0;
  for (const ElementSet& set : sets) {
    PartSet& own = made.sets.emplace_back();
    own.element = set.row->name;
    own.option = set.option;
    own.curve = set.curve;
    for (std::size_t i = 0; i < set.cells.size(); ++i, ++at) {
      const auto nodes = mesh.cells[set.cells[i]];
      const bool is_own = partition.of_cell[at] == part;
      if (!is_own && std::ranges::none_of(nodes, [&](std::int32_t node) { return partition.of_node[node] == part; })) continue;
      own.number.push_back(set.cells[i]);
      own.at.push_back(static_cast<std::int32_t>(i));
      own.is_own.push_back(is_own);
      own.nodes.insert(own.nodes.end(), nodes.begin(), nodes.end());
      const auto width = static_cast<std::ptrdiff_t>(set.n_parameters), first = static_cast<std::ptrdiff_t>(i) * width;
      own.parameters.insert(own.parameters.end(), set.parameters.begin() + first, set.parameters.begin() + first + width);
      for (const std::int32_t node : nodes) local[node] = 0;
    }
  }
  for (const bool own : {true, false}) {
    for (std::int32_t node = 0; node < std::ssize(local); ++node) {
      if (local[node] < 0 || (partition.of_node[node] == part) != own) continue;
      local[node] = static_cast<std::int32_t>(made.node.size());
      made.node.push_back(node);
      const auto point = mesh.point(static_cast<std::size_t>(node));
      made.coordinates.insert(made.coordinates.end(), point.begin(), point.end());
      for (int i = 0; i < blocks.dimension; ++i) {
        const std::int64_t equation = numbering.of(node, i);
        made.equation.push_back(static_cast<std::int32_t>(equation));
        made.place.push_back(equation < 0 ? -1 : blocks.place[equation]);
      }
    }
    if (own) made.n_own = std::ssize(made.node);
  }
  for (PartSet& set : made.sets)
    for (std::int32_t& node : set.nodes) node = local[node];
  return made;
}

KeptPoints::~KeptPoints() { parts_->dropped_.push_back(number_); }
std::size_t KeptPoints::n_sets() const { return parts_->n_sets(); }
std::size_t KeptPoints::n_cells(std::size_t set) const { return parts_->sets_[set].cells.size(); }
std::size_t KeptPoints::width(std::size_t set, PointQuantity quantity) const { return width_of(parts_->sets_[set], quantity); }
std::vector<double> KeptPoints::values(std::size_t set, PointQuantity quantity) const {
  std::vector<CellRange> cells(n_sets());
  cells[set].count = n_cells(set);
  return std::move(values(quantity, cells)[set]);
}
std::vector<std::vector<double>> KeptPoints::values(PointQuantity quantity, std::span<const CellRange> cells) const {
  return parts_->values(number_, quantity, cells);
}

SolidParts::SolidParts(std::shared_ptr<PartProcesses> processes, const Mesh& mesh, std::span<const ElementSet> sets,
                       const Numbering& numbering, std::span<const std::string> unknowns,
                       std::span<const std::filesystem::path> plugins)
    : processes_(std::move(processes)),
      mesh_(mesh),
      sets_(sets),
      numbering_(numbering),
      partition_(partition(mesh, cells_of(sets), weights_of(sets), processes_->size())),
      blocks_(numbering, static_cast<int>(unknowns.size()), processes_->size(), partition_.of_node),
      holdings_(natural_holdings()),
      n_cells_(std::ssize(partition_.of_cell)) {
  processes_->start();
  const std::int64_t n_dofs = std::ssize(numbering.equation);
  memory_.emplace(Board::bytes(processes_->size(), n_dofs));
  board_ = Board::in(*memory_, processes_->size());
  ask("board " + memory_->path());
  for (int first = 0; first < processes_->size(); first += parcels_at_once) {  // they unpack theirs at the same time
    std::vector<SharedMemory> parcels;
    std::string line = "parts " + std::to_string(first);
    for (int part = first; part < std::min(first + parcels_at_once, processes_->size()); ++part) {
      PartCells cells = cells_of_part({mesh_, sets_, numbering_, partition_, blocks_}, part);
      cells.unknowns = {unknowns.begin(), unknowns.end()};
      for (const std::filesystem::path& folder : plugins) cells.plugins.push_back(folder);
      for (const PartSet& set : cells.sets) n_shared_ += std::ssize(set.at);
      Packing packing;
      packing(cells);
      line += ' ' + parcels.emplace_back(in_shared_memory(packing.bytes())).path();
    }
    ask(line);
  }
  processes_->keep();
  n_shared_ -= n_cells_;
}

void SolidParts::ask(const std::string& line) const {
  if (!dropped_.empty()) {
    std::string drop = "drop";
    for (const std::int64_t number : std::exchange(dropped_, {})) drop += ' ' + std::to_string(number);
    processes_->ask(drop);
  }
  require_done(processes_->ask(line));
}

std::optional<std::int32_t> SolidParts::evaluate(std::span<const double> displacement, SolidMatrix wanted,
                                                 const Start& previous, const Start& origin) {
  if (wanted != SolidMatrix::none) ++version_;
  std::ranges::copy(displacement, board_.displacement.begin());
  const auto number = [](const Start& start, std::span<double> values) {
    if (!start.points) return std::string("-1");
    std::ranges::copy(start.displacement, values.begin());
    return std::to_string(start.points->number());
  };
  const std::string from = number(previous, board_.previous), first = number(origin, board_.origin);
  ask("evaluate " + std::to_string(static_cast<int>(wanted)) + ' ' + from + ' ' + first);
  const PartReport* inside_out = nullptr;
  for (const PartReport& report : board_.report) {
    if (report.failed) throw Error(report.message());
    if (report.cell < 0) continue;
    if (!inside_out || std::tie(report.set, report.cell) < std::tie(inside_out->set, inside_out->cell)) inside_out = &report;
  }
  return inside_out ? std::optional(inside_out->cell) : std::nullopt;
}

std::int64_t SolidParts::kept(const std::string& verb, const std::string& more) const {
  const std::int64_t number = ++last_;
  ask(verb + ' ' + std::to_string(number) + more);
  return number;
}

KeptState SolidParts::shared(std::int64_t number, Holdings holdings) const {
  return std::make_shared<const KeptPoints>(shared_from_this(), number, std::move(holdings));
}

Holdings SolidParts::natural_holdings() const {
  Holdings holdings(sets_.size());
  for (auto& of_set : holdings)
    for (const PointQuantityRow& row : point_quantities) of_set[static_cast<std::size_t>(row.quantity)] = !row.is_given;
  return holdings;
}

KeptState SolidParts::keep() const { return shared(kept("keep"), holdings_); }
KeptState SolidParts::natural() const { return shared(kept("natural"), natural_holdings()); }
KeptState SolidParts::at_rest(const KeptPoints& state) const {
  return shared(kept("rest", ' ' + std::to_string(state.number())), state.holdings());
}

KeptState SolidParts::put(std::span<const PointValues> points) const {
  const std::int64_t number = kept("natural");
  Holdings holdings = natural_holdings();
  for (const PointQuantityRow& row : point_quantities) put(number, points, row, holdings);
  return shared(number, std::move(holdings));
}

KeptState SolidParts::heated(const KeptPoints& state, std::span<const PointValues> points) const {
  const std::int64_t number = kept("copy", ' ' + std::to_string(state.number()));
  Holdings holdings = state.holdings();
  for (const PointQuantity quantity : {PointQuantity::thermal, PointQuantity::parameter})
    put(number, points, point_quantities[static_cast<std::size_t>(quantity)], holdings);
  return shared(number, std::move(holdings));
}

void SolidParts::strain(std::span<const PointValues> points) {
  const auto is_given = [&](const PointQuantityRow& row) {
    return row.is_given &&
           std::ranges::any_of(points, [&](const PointValues& of_set) { return !(of_set.*row.values).empty(); });
  };
  if (holdings_ == natural_holdings() && std::ranges::none_of(point_quantities, is_given)) return;
  holdings_ = natural_holdings();
  ask("strain -1");
  for (const PointQuantityRow& row : point_quantities)
    if (row.is_given) put(-1, points, row, holdings_);
}

void SolidParts::strain_as(const KeptPoints& state) {
  if (holdings_ == natural_holdings() && holdings_ == state.holdings()) return;
  holdings_ = state.holdings();
  ask("strain " + std::to_string(state.number()));
}

void SolidParts::put(std::int64_t number, std::span<const PointValues> points, const PointQuantityRow& quantity,
                     Holdings& holdings) const {
  for (std::size_t s = 0; s < sets_.size(); ++s) {
    const std::vector<double>& values = points[s].*quantity.values;
    if (values.empty()) continue;
    const SharedMemory memory(values.size() * sizeof(double));
    std::ranges::copy(values, memory.numbers().begin());
    std::vector<CellRange> cells(sets_.size());
    cells[s].count = sets_[s].cells.size();
    exchange("put", number, quantity.quantity, cells, memory);
    holdings[s][static_cast<std::size_t>(quantity.quantity)] = true;
  }
}

std::vector<std::vector<double>> SolidParts::values(std::int64_t number, PointQuantity quantity,
                                                    std::span<const CellRange> cells) const {
  std::size_t size = 0;
  for (std::size_t s = 0; s < sets_.size(); ++s) size += cells[s].count * width_of(sets_[s], quantity);
  std::vector<std::vector<double>> found(sets_.size());
  if (size == 0) return found;
  const SharedMemory memory(size * sizeof(double));
  exchange("collect", number, quantity, cells, memory);
  std::span<const double> rest = memory.numbers();
  for (std::size_t s = 0; s < sets_.size(); ++s) {
    const std::size_t own = cells[s].count * width_of(sets_[s], quantity);
    found[s].assign(rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(own));
    rest = rest.subspan(own);
  }
  return found;
}

void SolidParts::exchange(const char* verb, std::int64_t number, PointQuantity quantity, std::span<const CellRange> cells,
                          const SharedMemory& memory) const {
  std::string line = verb;
  line += ' ' + std::to_string(number) + ' ' + std::to_string(static_cast<int>(quantity)) + ' ' + memory.path();
  for (const CellRange& some : cells) line += ' ' + std::to_string(some.first) + ' ' + std::to_string(some.count);
  ask(line);
}

bool SolidParts::flows(const KeptPoints& since) const {
  ask("flows " + std::to_string(since.number()));
  return std::ranges::any_of(board_.report, [](const PartReport& report) { return report.flows != 0; });
}

std::span<const double> SolidParts::product(std::span<const double> x, bool magnitudes) const {
  std::ranges::copy(x, board_.displacement.begin());
  ask(magnitudes ? "multiply 1" : "multiply 0");
  return board_.other;
}

void SolidParts::products(int n_columns, const std::function<void(std::span<double>)>& fill,
                          const std::function<void(std::span<const double>)>& use) const {
  const SharedMemory memory(2 * static_cast<std::size_t>(n_columns) * board_.displacement.size_bytes());
  const std::span<double> both = memory.numbers(), x = both.first(both.size() / 2);
  fill(x);
  ask("products " + std::to_string(n_columns) + ' ' + memory.path());
  use(both.subspan(x.size()));
}

RowsElsewhere::Sizes SolidParts::row_sizes() const {
  ask("measure");
  return {.sum = board_.force, .entries = board_.other};
}

std::span<const double> SolidParts::diagonal() const {
  ask("diagonal");
  return board_.other;
}

std::span<const double> SolidParts::row_maxima(std::span<const double> d) const {
  std::ranges::copy(d, board_.displacement.begin());
  ask("maxima");
  return board_.other;
}

void SolidParts::remember() const { ask("remember"); }

double SolidParts::change() const {
  ask("change");
  double largest = 0;
  for (const PartReport& report : board_.report) largest = std::max(largest, report.change);
  return largest;
}

Ragged<std::int32_t> SolidParts::graph(const SparseMatrix& here) const {
  Ragged<std::int32_t> elements;
  for (const ElementSet& set : sets_)
    for (const std::int32_t cell : set.cells) elements.push_back(mesh_.cells[cell]);
  std::vector<Coupling> couplings;
  for (std::size_t v = 0; v < here.neighbours().size(); ++v)
    for (const std::int32_t w : here.neighbours()[v])
      if (w < static_cast<std::int32_t>(v)) couplings.push_back({static_cast<std::int32_t>(v), w});
  return vertex_graph(numbering_.n_vertices(), elements, couplings);
}

SparseMatrix SolidParts::whole(const SparseMatrix& here) const {
  SparseMatrix all(graph(here), numbering_, Symmetry::symmetric);
  all.copy_rows(here, here.size());
  Packing packing;
  std::size_t n_rows = all.rows().size(), n_entries = static_cast<std::size_t>(all.n_entries());
  packing(n_rows)(n_entries);
  std::size_t bytes = packing.bytes().size() + n_rows * 8 + n_entries * 12;
  const SharedMemory memory(bytes);
  std::byte* next = memory.data();
  const auto put = [&](const void* from, std::size_t size) {
    std::memcpy(next, from, size);
    next += size;
  };
  put(packing.bytes().data(), packing.bytes().size());
  put(all.rows().data(), all.rows().size_bytes());
  double* const values = reinterpret_cast<double*>(next);
  put(all.values().data(), all.values().size_bytes());
  put(all.columns().data(), all.columns().size_bytes());
  ask("whole " + memory.path());
  all.restore({values, n_entries});
  return all;
}

}  // namespace lacon
