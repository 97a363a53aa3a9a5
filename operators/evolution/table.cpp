#include "lacon/operators/evolution/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace lacon {
namespace {

constexpr int width = 16;

struct Column {
  const char* title[3];
  std::string (*value)(const IterationReport&, const StaticProblem&);
  bool contact_only = false;
  bool where_only = false;
};

/// A number, and behind it an X as long as its criterion is not met.
std::string judged(double value, bool met) { return fmt::format("{:.5E} {}", value, met ? ' ' : 'X'); }

const Column columns[] = {
    {{"NEWTON", "ITERATION", ""}, [](const IterationReport& r, const StaticProblem&) { return fmt::format("{}{}", r.iteration, r.converged() ? ' ' : 'X'); }},
    {{"RESIDU", "RELATIF", "RESI_GLOB_RELA"}, [](const IterationReport& r, const StaticProblem&) { return judged(r.rela, r.rela_met); }},
    {{"RESIDU", "ABSOLU", "RESI_GLOB_MAXI"}, [](const IterationReport& r, const StaticProblem&) { return judged(r.maxi, r.maxi_met); }},
    {{"RESIDU", "MAXIMUM", "AU POINT"},
     [](const IterationReport& r, const StaticProblem& p) { return r.worst_dof < 0 ? std::string() : p.dof_name(r.worst_dof); },
     false, true},
    {{"OPTION", "ASSEMBLAGE", ""}, [](const IterationReport&, const StaticProblem&) { return std::string("TANGENTE"); }},
    {{"CONTACT", "NEWTON GENE", "VARI. CONT."},
     [](const IterationReport& r, const StaticProblem&) { return fmt::format("{} {}", r.status_changes, r.status_changes ? 'X' : ' '); }, true},
    {{"CONTACT", "NEWTON GENE", "CRIT. GEOM."},
     [](const IterationReport& r, const StaticProblem&) { return judged(r.geometry, r.geometry_met); }, true},
    {{"CONTACT", "MAX. GAP / SIZE", "ACTIVE PATCHES"},
     [](const IterationReport& r, const StaticProblem&) { return judged(r.constraint, r.constraint_met); }, true},
    {{"SOLVER", "NEGATIVE", "PIVOTS"},
     [](const IterationReport& r, const StaticProblem&) {
       return r.negative_pivots == r.constraints ? fmt::format("{}", r.negative_pivots) : fmt::format("{} of {}", r.negative_pivots, r.constraints);
     }},
    {{"TIME", "SECONDS", ""}, [](const IterationReport& r, const StaticProblem&) { return fmt::format("{:.4f}", r.seconds); }},
};

std::vector<const Column*> shown(const StaticProblem& problem, bool where) {
  std::vector<const Column*> list;
  for (const Column& column : columns)
    if ((!column.contact_only || problem.contact) && (!column.where_only || where)) list.push_back(&column);
  return list;
}

}  // namespace

void NewtonTable::rule() {
  out_ << ' ' << std::string(shown(problem_, where_).size() * (width + 1) + 1, '-') << '\n';
}

void NewtonTable::start(double instant) {
  out_ << fmt::format("\n Instant de calcul: {:.12e}\n", instant);
  rule();
  for (int i = 0; i < 3; ++i) {
    out_ << " |";
    for (const Column* column : shown(problem_, where_)) out_ << fmt::format("{:^{}}|", column->title[i], width);
    out_ << '\n';
  }
  rule();
  out_.flush();
}

void NewtonTable::line(const IterationReport& report) {
  out_ << " |";
  for (const Column* column : shown(problem_, where_)) out_ << fmt::format("{:>{}}|", column->value(report, problem_) + " ", width);
  out_ << std::endl;  // as it goes: a long computation shows where it is
}

void NewtonTable::finish(double instant, int iterations, const StaticState& state, const ContactState* contact) {
  rule();
  out_ << fmt::format(" Converged at the instant {:.9g} with {} iteration(s)", instant, iterations);
  if (contact) {
    std::int64_t active = 0, unpaired = 0;
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (std::size_t p = 0; p < contact->n_patches(); ++p) {
      unpaired += state.patches.status[p] == Status::unpaired;
      if (state.patches.status[p] != Status::active) continue;
      ++active;
      least = std::min(least, state.patches.lambda[p]);
      most = std::max(most, state.patches.lambda[p]);
    }
    const auto n = static_cast<std::int64_t>(contact->n_patches());
    out_ << fmt::format("; of {} patches {} in contact, {} open, {} without master", n, active, n - active - unpaired, unpaired);
    if (active) out_ << fmt::format("; LAGS_C from {:.9g} to {:.9g}", least, most);
  }
  out_ << std::endl;
}

}  // namespace lacon
