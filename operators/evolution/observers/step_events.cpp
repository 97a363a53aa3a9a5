#include "lacon/operators/evolution/observers/step_events.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"

namespace lacon {
namespace {

/// Of values that are solved for, relative: by no more than that a change which is VALE_REF exceeds it.
constexpr double slack_of_limit = 1e-9;

std::string place_of(const Observer::Value& value) {
  if (value.node >= 0) return node_name(value.node);
  return part("point_of_cell", {{"point", std::to_string(value.point + 1)}, {"cell", cell_name(value.cell)}});
}

}  // namespace

StepEvents::StepEvents(const std::vector<StepEvent>& events, const Base& base, const Mesh& mesh, FieldMakers fields)
    : fields_(std::move(fields)) {
  for (const StepEvent& event : events) {
    if (event.event == "RESI_MAXI")
      largest_residual_ = event.limit;
    else if (event.event == "DIVE_RESI")
      may_diverge_ = false;
    else
      increments_.push_back(
          {event.limit, Observer(Keywords(nlohmann::json::parse(event.place), "DEFI_LIST_INST/ECHEC/"), base, mesh, {}), {}});
  }
}

void StepEvents::start(double /*instant*/) { remember(); }

void StepEvents::begin(double /*instant*/) { before_ = {}; }

void StepEvents::iterate(double instant, const IterationReport& report) {
  if (largest_residual_ && report.maxi > *largest_residual_)
    fail("STEP_1", {{"residual", fmt::format("{:.6g}", report.maxi)},
                    {"limit", fmt::format("{:.6g}", *largest_residual_)},
                    {"instant", fmt::format("{:.9g}", instant)}});
  if (!may_diverge_ && report.iteration >= 2 && std::min(report.maxi, before_[0]) > before_[1])
    fail("STEP_4", {{"residual", fmt::format("{:.6g}", report.maxi)},
                    {"before", fmt::format("{:.6g}, {:.6g}", before_[1], before_[0])},
                    {"instant", fmt::format("{:.9g}", instant)}});
  before_ = {report.maxi, before_[0]};
}

void StepEvents::judge(double instant) {
  for (const IncrementLimit& increment : increments_) {
    const std::vector<Observer::Value> now = increment.observer.look(fields_);
    for (std::size_t i = 0; i < now.size(); ++i)
      if (const double before = increment.last[i].value, change = std::abs(now[i].value - before);
          change - increment.limit > slack_of_limit * std::max({increment.limit, std::abs(before), std::abs(now[i].value)}))
        fail("STEP_2", {{"component", now[i].component},
                        {"place", place_of(now[i])},
                        {"change", fmt::format("{:.6g}", change)},
                        {"limit", fmt::format("{:.6g}", increment.limit)},
                        {"instant", fmt::format("{:.9g}", instant)}});
  }
}

void StepEvents::accept(const SolvedInstant& /*solved*/) { remember(); }

void StepEvents::resume(const hdf5::Group& /*group*/) { remember(); }

void StepEvents::remember() {
  for (IncrementLimit& increment : increments_) increment.last = increment.observer.look(fields_);
}

}  // namespace lacon
