#include "lacon/operators/evolution/observers/interruption.hpp"

#include <fmt/format.h>

#include "lacon/catalog/messages.hpp"
#include "lacon/operators/program/ending.hpp"

namespace lacon {
namespace {

void end_at(double instant) {
  if (const char* const signal = ending())
    fail("EVOLUTION_30", {{"signal", signal}, {"instant", fmt::format("{:.9g}", instant)}});
}

}  // namespace

void Interruption::iterate(double instant, const IterationReport& report) {
  if (!report.converged()) end_at(instant);
}

void Interruption::accept(const SolvedInstant& solved) {
  if (!solved.last) end_at(solved.instant);
}

}  // namespace lacon
