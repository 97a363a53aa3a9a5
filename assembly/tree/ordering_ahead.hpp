#pragma once
// The order of elimination, found by a process that is to share the factor while the operator still evaluates the matrix: it
// takes METIS as long as all else that comes before a factorisation, and needs the pattern alone.
#include <optional>
#include <vector>

#include "lacon/assembly/processes/shared_memory.hpp"
#include "lacon/assembly/sparse_matrix.hpp"
#include "lacon/assembly/tree/mumps_processes.hpp"
#include "lacon/assembly/tree/subtrees.hpp"

namespace lacon {

/// An order of elimination (elimination_order()) and its independent_subtrees().
struct SharedOrder {
  std::vector<std::int32_t> order;
  Subtrees subtrees;
};

/// @param memory OrderMemory of a graph, which gets its order  @return the numbers of the answer (exchange.hpp)
std::vector<double> order_in(const SharedMemory& memory);

class OrderingAhead {
 public:
  OrderingAhead() = default;
  /// A process that still works on one is ended.
  ~OrderingAhead();
  OrderingAhead(const OrderingAhead&) = delete;
  OrderingAhead& operator=(const OrderingAhead&) = delete;
  /// Where none is being found yet. The processes, which must outlive this, are started, and are asked nothing else before
  /// take(), which does and tells what they cannot.
  void begin(const VertexGraph& graph, MumpsProcesses& processes) noexcept;
  /// What was begun, if it is of this graph; else it is begun now. Found here where no process can do it.
  SharedOrder take(const VertexGraph& graph, MumpsProcesses& processes);

 private:
  /// The numbers of the answer of the process that is at work; none where it has ended, or cannot.
  std::vector<double> answer(MumpsProcesses& processes);
  std::optional<SharedMemory> memory_;  ///< OrderMemory, while a process works on it
  MumpsProcesses* at_work_ = nullptr;   ///< likewise
};

}  // namespace lacon
