#pragma once
// Where a computation is, on the terminal of the user who waits for it (program/terminal.hpp).
#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "lacon/operators/evolution/evolution.hpp"

namespace lacon {

/// How far an instant is in a list of instants, from 0 at the first to 1 at the last: each interval counts the same.
double share_of_list(const std::vector<double>& instants, double instant);

/// "1 min 20 s", two units at most.
std::string in_words(double seconds);

/// What the line says. @param left seconds that remain, where that can be guessed
std::string progress_text(double instant, int iteration, const std::string& phase, double share, double gone,
                          std::optional<double> left);

/// Keeps the line of the terminal up to date with each phase, at most ten times a second. Nothing without terminal.
class Progress : public EvolutionObserver {
 public:
  explicit Progress(const std::vector<double>& instants);
  ~Progress() override;
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void begin(double instant) override;
  void iterate(double instant, const IterationReport& report) override;
  void accept(const SolvedInstant& solved) override;
  void end(bool completed) override;

 private:
  using Clock = std::chrono::steady_clock;
  void show(bool at_once);

  const std::vector<double>& instants_;
  double instant_ = 0;
  int iteration_ = 0;
  std::string phase_;
  std::optional<double> first_share_;  ///< of what was there when the first instant of this process began
  double share_ = 0;                   ///< of the instants that are solved
  Clock::time_point start_ = Clock::now(), shown_{};
};

}  // namespace lacon
