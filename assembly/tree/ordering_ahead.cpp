#include "lacon/assembly/tree/ordering_ahead.hpp"

#include <algorithm>
#include <exception>
#include <sstream>
#include <string>

#include "lacon/assembly/ordering.hpp"
#include "lacon/assembly/tree/exchange.hpp"

namespace lacon {
namespace {

SharedOrder shared_order(const VertexGraph& graph, int n_processes, OrderIn where) {
  // more processes than two share uneven halves well, and the smallest separator is the least work
  const Halves halves = n_processes == 2 ? Halves::even : Halves::any;
  SharedOrder found{.order = elimination_order(graph, where, halves), .subtrees = {}};
  found.subtrees = independent_subtrees(graph, found.order, n_processes);
  return found;
}

}  // namespace

std::vector<double> order_in(const SharedMemory& memory) {
  const OrderMemory asked = OrderMemory::in(memory);
  Ragged<std::int32_t> neighbours;
  neighbours.offset.assign(asked.offset.begin(), asked.offset.end());
  neighbours.values.assign(asked.neighbours.begin(), asked.neighbours.end());
  Numbering numbering{.n_nodes = asked.sizes.nodes, .n_components = 0, .first = {}, .equation = {}};
  numbering.first.assign(asked.first.begin(), asked.first.end());
  const SharedOrder found = shared_order({neighbours, numbering}, asked.sizes.processes, OrderIn::two_processes);
  std::ranges::copy(found.order, asked.order.begin());
  std::ranges::copy(found.subtrees.of, asked.subtree.begin());
  std::vector<double> answer = {found.subtrees.whole.flops, found.subtrees.whole.entries, found.subtrees.longest};
  answer.insert(answer.end(), found.subtrees.process.begin(), found.subtrees.process.end());
  return answer;
}

OrderingAhead::~OrderingAhead() {
  if (memory_) at_work_->kill_first();
}

void OrderingAhead::begin(const VertexGraph& graph, MumpsProcesses& processes) noexcept try {
  if (memory_) return;
  processes.start();
  const OrderSizes sizes{.vertices = graph.numbering.n_vertices(),
                         .nodes = graph.numbering.n_nodes,
                         .neighbours = std::ssize(graph.neighbours.values),
                         .equations = graph.numbering.n_equations(),
                         .processes = processes.size()};
  SharedMemory memory(OrderMemory::bytes(sizes));
  std::copy_n(&sizes, 1, reinterpret_cast<OrderSizes*>(memory.data()));
  const OrderMemory asked = OrderMemory::in(memory);
  std::ranges::copy(graph.neighbours.offset, asked.offset.begin());
  std::ranges::copy(graph.numbering.first, asked.first.begin());
  std::ranges::copy(graph.neighbours.values, asked.neighbours.begin());
  if (!processes.tell_first("order " + memory.path())) return;
  memory_.emplace(std::move(memory));
  at_work_ = &processes;
} catch (const std::exception&) {  // take() does without them
}

std::vector<double> OrderingAhead::answer(MumpsProcesses& processes) {
  std::istringstream said(processes.answer_of_first());
  std::string word;
  std::vector<double> numbers;
  if (said >> word; word == "done")
    for (double number; said >> number;) numbers.push_back(number);
  return numbers;
}

SharedOrder OrderingAhead::take(const VertexGraph& graph, MumpsProcesses& processes) {
  for (;;) {
    const bool was_begun = memory_.has_value();
    begin(graph, processes);
    if (!memory_) return shared_order(graph, processes.size(), OrderIn::this_process);
    const std::vector<double> numbers = answer(processes);
    const SharedMemory memory = std::move(*memory_);
    memory_.reset();
    const OrderMemory asked = OrderMemory::in(memory);
    const bool is_the_same = std::ranges::equal(asked.offset, graph.neighbours.offset) &&
                             std::ranges::equal(asked.first, graph.numbering.first) &&
                             std::ranges::equal(asked.neighbours, graph.neighbours.values);
    if (is_the_same && !numbers.empty())
      return {.order = {asked.order.begin(), asked.order.end()},
              .subtrees = {.of = {asked.subtree.begin(), asked.subtree.end()},
                           .process = {numbers.begin() + 3, numbers.end()},
                           .whole = {.flops = numbers[0], .entries = numbers[1]},
                           .longest = numbers[2]}};
    if (!was_begun) return shared_order(graph, processes.size(), OrderIn::this_process);
  }
}

}  // namespace lacon
