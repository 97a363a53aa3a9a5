#include "lacon/operators/evolution/observers/progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lacon/catalog/wording.hpp"
#include "lacon/operators/program/program.hpp"
#include "lacon/operators/program/terminal.hpp"

namespace lacon {
namespace {

constexpr std::chrono::milliseconds between{100};

}  // namespace

double share_of_list(const std::vector<double>& instants, double instant) {
  if (instants.size() < 2 || instant >= instants.back()) return 1;
  const auto next = std::upper_bound(instants.begin(), instants.end(), instant);
  if (next == instants.begin()) return 0;
  const auto before = next - 1;
  return (static_cast<double>(before - instants.begin()) + (instant - *before) / (*next - *before)) /
         static_cast<double>(instants.size() - 1);
}

std::string in_words(double seconds) {
  const auto whole = static_cast<long long>(std::llround(std::max(seconds, 0.0)));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

std::string progress_text(double instant, int iteration, const std::string& phase, double share, double gone,
                          std::optional<double> left) {
  return part("progress_line", {{"instant", fmt::format("{:.6g}", instant)},
                                {"iteration", std::to_string(iteration)},
                                {"phase", fmt::format("{:<15}", phase)},
                                {"share", fmt::format("{:3.0f}", std::floor(100 * share))},
                                {"gone", in_words(gone)}}) +
         (left ? part("progress_left", {{"time", in_words(*left)}}) : "");
}

Progress::Progress(const std::vector<double>& instants) : instants_(instants) {
  if (!has_terminal_line()) return;
  watch_phases([this](const std::string& phase) {
    phase_ = phase;
    if (first_share_) show(false);
  });
}

Progress::~Progress() { watch_phases({}); }

void Progress::begin(double instant) {
  if (!has_terminal_line()) return;
  instant_ = instant;
  iteration_ = 0;
  if (!first_share_) {  // what went before it is there already, or is the initial state
    const auto next = std::lower_bound(instants_.begin(), instants_.end(), instant);
    first_share_ = share_ = next == instants_.begin() ? 0 : share_of_list(instants_, *(next - 1));
    start_ = Clock::now();
  }
  show(true);
}

void Progress::iterate(double /*instant*/, const IterationReport& report) {
  if (!has_terminal_line()) return;
  iteration_ = report.iteration + 1;
  show(true);
}

void Progress::accept(const SolvedInstant& solved) {
  if (has_terminal_line()) share_ = share_of_list(instants_, solved.instant);
}

void Progress::end(bool /*completed*/) { hide_terminal_line(); }

void Progress::show(bool at_once) {
  const Clock::time_point now = Clock::now();
  if (!at_once && now - shown_ < between) return;
  shown_ = now;
  const double gone = std::chrono::duration<double>(now - start_).count(), done = share_ - *first_share_;
  const auto left = done > 0 ? std::optional(gone * (1 - share_) / done) : std::nullopt;
  show_terminal_line(progress_text(instant_, iteration_, phase_, share_, gone, left));
}

}  // namespace lacon
