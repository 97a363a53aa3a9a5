#include "lacon/assembly/ordering.hpp"

#include <metis.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <functional>
#include <numeric>
#include <span>
#include <utility>

#include "lacon/assembly/counts.hpp"
#include "lacon/assembly/metis_status.hpp"

namespace lacon {
namespace {

/// Vertices from which on two processes are worth it: of 18 000 halves made a factor worse (16 iterations for 5).
constexpr idx_t least_halved = 30'000;
/// Of even halves, how much larger than the mean one may be: in thousandths. METIS takes 200 for any.
constexpr idx_t unevenness = 30;

/// A graph as METIS takes it: vertices that have equations, without gaps.
struct MetisGraph {
  std::vector<idx_t> offset{0}, adjacent;
  idx_t size() const { return static_cast<idx_t>(offset.size()) - 1; }
};

struct Options {
  std::array<idx_t, METIS_NOPTIONS> values{};
  explicit Options(idx_t seed = 1) {
    METIS_SetDefaultOptions(values.data());
    values[METIS_OPTION_SEED] = seed;  // the same bits in every run
  }
};

/// Nested dissection. @param[out] place of each vertex
void order(MetisGraph& graph, std::span<idx_t> place) {
  std::iota(place.begin(), place.end(), 0);
  if (graph.adjacent.empty()) return;
  Options options;
  idx_t n = graph.size();
  std::vector<idx_t> inverse(place.size());
  check_metis(METIS_NodeND(&n, graph.offset.data(), graph.adjacent.data(), nullptr, options.values.data(), inverse.data(),
                           place.data()),
              "METIS_NodeND");
}

/// Some vertices of a graph and the edges between them.
MetisGraph subgraph(const MetisGraph& of, std::span<const idx_t> vertices) {
  std::vector<idx_t> number(of.offset.size(), -1);
  for (std::size_t i = 0; i < vertices.size(); ++i) number[vertices[i]] = static_cast<idx_t>(i);
  MetisGraph graph;
  for (const idx_t v : vertices) {
    for (idx_t k = of.offset[v]; k < of.offset[v + 1]; ++k)
      if (const idx_t w = number[of.adjacent[k]]; w >= 0) graph.adjacent.push_back(w);
    graph.offset.push_back(static_cast<idx_t>(graph.adjacent.size()));
  }
  return graph;
}

/// Numbers that a copy of this process finds at the same time: METIS knows no threads.
class FoundElsewhere {
 public:
  /// @param find writes all of them
  FoundElsewhere(std::span<idx_t> numbers, std::function<void(std::span<idx_t>)> find)
      : numbers_(numbers), find_(std::move(find)), bytes_(numbers.size_bytes() + 1) {
    void* const memory = mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) return;
    memory_ = static_cast<idx_t*>(memory);
    const pid_t parent = getpid();
    process_ = fork();
    if (process_ != 0) return;
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(1);
    try {
      find_({memory_, numbers.size()});
      is_done() = 1;
    } catch (...) {  // whoever waits finds them himself, and tells
    }
    _exit(0);
  }
  ~FoundElsewhere() {
    wait_for_its_end();
    if (memory_) munmap(memory_, bytes_);
  }
  FoundElsewhere(const FoundElsewhere&) = delete;
  FoundElsewhere& operator=(const FoundElsewhere&) = delete;

  /// Found here, where there was no other process or it ended too early.
  void wait() {
    wait_for_its_end();
    if (memory_ && is_done())
      std::copy_n(memory_, numbers_.size(), numbers_.begin());
    else
      find_(numbers_);
  }

 private:
  void wait_for_its_end() {
    while (process_ > 0 && waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
    }
    process_ = -1;
  }
  char& is_done() { return reinterpret_cast<char*>(memory_)[numbers_.size_bytes()]; }

  std::span<idx_t> numbers_;
  std::function<void(std::span<idx_t>)> find_;
  std::size_t bytes_;
  idx_t* memory_ = nullptr;
  pid_t process_ = -1;
};

/// The half of each vertex, 0 or 1; 2: it separates them.
void separate(MetisGraph& graph, Halves halves, idx_t seed, std::span<idx_t> part) {
  Options options(seed);
  if (halves == Halves::even) options.values[METIS_OPTION_UFACTOR] = unevenness;
  idx_t n = graph.size(), size = 0;
  check_metis(METIS_ComputeVertexSeparator(&n, graph.offset.data(), graph.adjacent.data(), nullptr, options.values.data(),
                                           &size, part.data()),
              "METIS_ComputeVertexSeparator");
}

/// Nested dissection by two processes: the smaller one of two separators first, and then each half.
void order_halves(MetisGraph& graph, Halves halves, std::span<idx_t> place) {
  std::vector<idx_t> part(place.size()), other(place.size());
  {
    FoundElsewhere second(other, [&](std::span<idx_t> found) { separate(graph, halves, 2, found); });
    separate(graph, halves, 1, part);
    second.wait();
  }
  if (std::ranges::count(other, 2) < std::ranges::count(part, 2)) part = other;
  constexpr std::size_t n_parts = 3;  // two halves, and the separator
  std::array<std::vector<idx_t>, n_parts> vertices, places;
  for (idx_t v = 0; v < graph.size(); ++v) vertices[part[v]].push_back(v);
  std::array<MetisGraph, n_parts> graphs;
  for (std::size_t p = 0; p < n_parts; ++p) {
    graphs[p] = subgraph(graph, vertices[p]);
    places[p].resize(vertices[p].size());
  }
  {
    FoundElsewhere second(places[1], [&](std::span<idx_t> found) { order(graphs[1], found); });
    order(graphs[0], places[0]);
    order(graphs[2], places[2]);
    second.wait();
  }
  idx_t first = 0;
  for (std::size_t p = 0; p < n_parts; ++p) {
    for (std::size_t i = 0; i < vertices[p].size(); ++i) place[vertices[p][i]] = first + places[p][i];
    first += static_cast<idx_t>(vertices[p].size());
  }
}

}  // namespace

std::vector<std::int32_t> elimination_order(const VertexGraph& of, OrderIn where, Halves halves) {
  const Numbering& numbering = of.numbering;
  const std::int64_t n_vertices = numbering.n_vertices();

  // METIS must not see vertices that have no equations
  std::vector<idx_t> compact(n_vertices, -1);
  std::vector<std::int32_t> vertices;
  for (std::int32_t v = 0; v < n_vertices; ++v)
    if (numbering.first[v + 1] > numbering.first[v]) {
      compact[v] = static_cast<idx_t>(vertices.size());
      vertices.push_back(v);
    }
  MetisGraph graph;
  for (const std::int32_t v : vertices) {
    for (const std::int32_t w : of.neighbours[v])
      if (compact[w] >= 0) graph.adjacent.push_back(compact[w]);
    graph.offset.push_back(narrow_count<idx_t>(std::ssize(graph.adjacent), "counted_neighbours"));
  }
  const idx_t n = graph.size();
  std::vector<idx_t> place(n);
  const bool in_halves = where == OrderIn::two_processes && n >= least_halved;
  in_halves ? order_halves(graph, halves, place) : order(graph, place);

  // (place, 1 behind it for a moved multiplier) sorts the vertices
  std::vector<std::pair<idx_t, bool>> key(n);
  for (idx_t i = 0; i < n; ++i) {
    key[i] = {place[i], false};
    if (vertices[i] < numbering.n_nodes) continue;
    for (idx_t k = graph.offset[i]; k < graph.offset[i + 1]; ++k)
      if (place[graph.adjacent[k]] > key[i].first) key[i] = {place[graph.adjacent[k]], true};
  }
  std::vector<idx_t> sorted(n);
  std::iota(sorted.begin(), sorted.end(), 0);
  std::stable_sort(sorted.begin(), sorted.end(), [&](idx_t a, idx_t b) { return key[a] < key[b]; });

  std::vector<std::int32_t> order(numbering.n_equations());
  std::int32_t next = 0;
  for (const idx_t i : sorted)
    for (std::int64_t e = numbering.first[vertices[i]]; e < numbering.first[vertices[i] + 1]; ++e) order[e] = next++;
  return order;
}

}  // namespace lacon
