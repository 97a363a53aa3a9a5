#pragma once
// What an operator and the processes that have its cells both see all the time: vectors of nodal values, and what each of the
// processes found.
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

#include "lacon/assembly/processes/shared_memory.hpp"
#include "lacon/catalog/messages.hpp"

namespace lacon {

/// What a process found while it evaluated its elements.
struct alignas(double) PartReport {
  std::int32_t set, cell;  ///< the first that is turned inside out, by its number in the mesh; -1: none
  std::int32_t flows;      ///< whether internal variables are others than those of a state
  std::int32_t failed;     ///< with the error that follows
  double change;           ///< ElementPart::change()
  char severity, id[31];
  char text[1000], advice[500];

  void take(const Message& message) {
    failed = 1;
    severity = message.severity;
    const auto copy = [](std::string_view from, std::span<char> to) {
      const std::size_t size = std::min(from.size(), to.size() - 1);
      std::memcpy(to.data(), from.data(), size);
      to[size] = 0;
    };
    copy(message.id, id);
    copy(message.text, text);
    copy(message.advice, advice);
  }
  Message message() const { return {severity, id, text, advice}; }
};

struct Board {
  std::span<PartReport> report;                      ///< of each process
  std::span<double> displacement, previous, origin;  ///< (n_dofs) each, for the processes
  std::span<double> force, other;                    ///< (n_dofs) each, from them: each writes at its own nodes

  static std::size_t bytes(int n_parts, std::int64_t n_dofs) {
    return sizeof(PartReport) * static_cast<std::size_t>(n_parts) + 5 * sizeof(double) * static_cast<std::size_t>(n_dofs);
  }
  static Board in(const SharedMemory& memory, int n_parts) {
    static_assert(sizeof(PartReport) % sizeof(double) == 0);
    Board board;
    board.report = {reinterpret_cast<PartReport*>(memory.data()), static_cast<std::size_t>(n_parts)};
    auto* next = reinterpret_cast<double*>(memory.data() + board.report.size_bytes());
    const std::size_t n = (memory.size() - board.report.size_bytes()) / sizeof(double) / 5;
    for (std::span<double>* const values : {&board.displacement, &board.previous, &board.origin, &board.force, &board.other}) {
      *values = {next, n};
      next += n;
    }
    return board;
  }
};

}  // namespace lacon
