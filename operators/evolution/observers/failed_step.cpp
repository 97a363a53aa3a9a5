#include "lacon/operators/evolution/observers/failed_step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "lacon/catalog/wording.hpp"
#include "lacon/operators/evolution/observers/archive.hpp"
#include "lacon/structures/hdf5.hpp"
#include "lacon/structures/names.hpp"
#include "lacon/structures/storage/storage.hpp"

namespace lacon {
namespace {

/// Statuses and residuals go round with periods of two or three iterations: two whole rounds of the longer one.
constexpr std::size_t most = 6;

/// Pressure over the modulus of elasticity.
constexpr double beyond_all_solids = 0.5;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

bool is_finite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

std::optional<double> instant_in(const std::filesystem::path& file) {
  std::error_code error;
  if (!exists(file, error)) return std::nullopt;
  try {
    return hdf5::Reader(file).real("instant");
  } catch (const Error&) {
    return -std::numeric_limits<double>::infinity();  // whatever it was, the next instant takes its place
  }
}

}  // namespace

FailedStep::FailedStep(const Order& order, const Base& base, const Present& present, double begins, double ends)
    : order_(order),
      base_(base),
      present_(present),
      file_(base.result_folder() / failed_step_file),
      begins_(begins),
      ends_(ends),
      there_(instant_in(file_)) {}

void FailedStep::begin(double /*instant*/) { iterates_.clear(); }

void FailedStep::iterate(double /*instant*/, const IterationReport& report) {
  if (!std::isfinite(report.maxi) || report.converged()) return;  // numbers that nobody can draw, or that nobody asks for
  if (iterates_.size() == most) iterates_.pop_front();
  iterates_.push_back({.iteration = report.iteration,
                       .rela = report.rela,
                       .maxi = report.maxi,
                       .changes = static_cast<double>(report.status_changes),
                       .displacement = present_.state.displacement,
                       .unbalanced = present_.unbalanced(),
                       .contact = {},
                       .masters = {}});
  if (!present_.contact) return;
  const Contact& contact = *present_.problem.contact;
  const ContactGeometry& geometry = present_.contact->geometry();
  iterates_.back().contact = contact_field(contact, geometry, present_.state.patches);
  iterates_.back().masters = paired_masters(present_.problem.mesh, contact, geometry);
}

void FailedStep::failed(double instant, const Error& error) {
  if (error.message().severity != 'S') return;
  // of the shortest step, and there of the first attempt; those that search increments or last for more iterations end anywhere
  if (failure_ && instant >= failure_->instant && !failure_->tries_again && !is_of_the_machine(error.message())) return;
  const FailureNature nature = nature_of(error);
  failure_.emplace(Failure{.instant = instant,
                           .message = error.message(),
                           .tries_again = nature.led_astray || nature.stayed_unstable,
                           .iterates = std::exchange(iterates_, {})});
  std::deque<Iterate>& kept = failure_->iterates;
  // an iteration that cannot be judged (a cell is none any more) has moved the bodies all the same
  const std::vector<double>& moved = present_.state.displacement;
  if (kept.empty() || moved == kept.back().displacement || !is_finite(moved)) return;
  if (kept.size() == most) kept.pop_front();
  kept.push_back({.iteration = kept.back().iteration + 1,
                  .rela = unknown,
                  .maxi = unknown,
                  .changes = unknown,
                  .displacement = moved,
                  .unbalanced = {},
                  .contact = {},
                  .masters = {}});
}

void FailedStep::accept(const SolvedInstant& solved) {
  begins_ = solved.instant;
  failure_.reset();
  if (there_ && solved.instant >= *there_ * (1 - 1e-12)) remove();
}

void FailedStep::end(bool completed) {
  if (completed) remove();
  if (completed || !failure_ || failure_->iterates.empty()) return;
  try {
    store();
    stored_ = true;
  } catch (const Error&) {
    // a full disk: what is told is why the step failed
  }
}

std::string FailedStep::large_load() const {
  double young = 0;
  for (const ElementSet& set : present_.problem.solids)
    for (const std::int32_t cell : set.cells)
      young = std::max(young, present_.problem.materials->find(cell, "ELAS/E").value_or(0));
  const Pressure pressure = [&] {
    try {
      return largest_pressure(present_.problem, ends_);
    } catch (const Error&) {  // a function that does not reach so far: what is told is why the step failed
      return Pressure();
    }
  }();
  if (!(young > 0 && pressure.value > beyond_all_solids * young)) return "";
  return part("load_is_large", {{"value", fmt::format("{:.4g}", pressure.value)},
                                {"cell", cell_name(pressure.cell)},
                                {"times", fmt::format("{:.2g}", pressure.value / young)},
                                {"young", fmt::format("{:.4g}", young)}});
}

void FailedStep::tell(const Error& error) const {
  Message message = error.message();
  const bool by_load = message.severity == 'S' && !is_of_the_machine(message);
  if (const std::string load = by_load ? large_load() : ""; !load.empty())
    message.advice = load + (message.advice.empty() ? "" : "; " + message.advice);
  if (!stored_) throw Error(std::move(message));
  message.advice += (message.advice.empty() ? "" : "; ") +
                    part("iterates_are_kept",
                         {{"base", base_.folder().filename().string()}, {"count", std::to_string(failure_->iterates.size())}});
  throw Error(std::move(message));
}

void FailedStep::store() const {
  const StaticProblem& problem = present_.problem;
  hdf5::write_sealed(file_, [&](const hdf5::Group& root) {
    root.set("lacon_type", std::string_view("failed_step"));
    root.set("format", storage::format);
    root.set("label", order_.result_label);
    root.set("model", order_.keywords.concept_id("MODELE"));
    root.set("mesh", problem.model.mesh);
    root.set("contact", order_.keywords.optional_concept("CONTACT").value_or(""));
    root.set("begins", begins_);
    root.set("instant", failure_->instant);
    root.set("message", failure_->message.id);
    root.set("text", failure_->message.text);
    std::vector<std::int64_t> iterations;
    std::vector<double> rela, maxi, changes;
    for (const Iterate& iterate : failure_->iterates) {
      iterations.push_back(iterate.iteration);
      rela.push_back(iterate.rela);
      maxi.push_back(iterate.maxi);
      changes.push_back(iterate.changes);
    }
    root.write("iteration", iterations);
    const hdf5::Group parameters = root.create("parameters"), fields = root.create("fields");
    parameters.write("resi_glob_rela", rela);
    parameters.write("resi_glob_maxi", maxi);
    if (present_.contact) parameters.write("status_changes", changes);
    const auto put = [&](const Iterate& iterate, const char* name, Field field) {
      field.name = name;
      field.mesh = problem.model.mesh;
      field.order = iterate.iteration;
      field.instant = failure_->instant;
      write_field_content(fields.create(fmt::format("{}/{}", field.name, iterate.iteration)), field);
    };
    for (const Iterate& iterate : failure_->iterates) {
      put(iterate, "DEPL", nodal_field(problem, iterate.displacement));
      if (!iterate.unbalanced.empty()) put(iterate, "RESI_NOEU", nodal_field(problem, iterate.unbalanced));
      if (!iterate.contact) continue;
      put(iterate, "CONT_ELEM", *iterate.contact);
      write(fields.create(fmt::format("CONT_ELEM/{}/masters", iterate.iteration)), *iterate.masters);
    }
  });
}

void FailedStep::remove() {
  if (!there_) return;
  std::error_code error;
  std::filesystem::remove(file_, error);
  there_.reset();
}

}  // namespace lacon
