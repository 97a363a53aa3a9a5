// The driver: in which order solver and observers are called, and what a failure leaves.
#include "lacon/operators/evolution/evolution.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <array>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "lacon/catalog/messages.hpp"

namespace lacon {
namespace {

using testing::ElementsAre;

/// Solves steps up to a length, in two iterations, and writes down what it is asked.
class Solver : public InstantSolver {
 public:
  Solver(std::vector<std::string>& log, double longest) : log_(log), longest_(longest) {}
  int solve(double instant, const std::function<void(const IterationReport&)>& report) override {
    present_ = instant;
    for (int i = 0; i < 2; ++i) report({.iteration = i});
    if (instant - accepted_ > longest_ * (1 + 1e-12))
      fail("EVOLUTION_4", {{"instant", "1"}, {"iterations", "2"}, {"unmet", ""}, {"remedy", ""}});
    return 1;
  }
  void accept() override {
    accepted_ = present_;
    log_.push_back("accepted");
  }
  void go_back() override { log_.push_back("back"); }
  bool take(Effort now) override {
    if (now == Effort::lasts || now == Effort::creeps || std::exchange(effort, now) == now) return false;
    log_.push_back(now == Effort::searches ? "searches" : "searches no more");
    return true;
  }
  void stands_at(double instant) { accepted_ = instant; }

  Effort effort = Effort::usual;

 private:
  std::vector<std::string>& log_;
  double longest_, present_ = 0, accepted_ = 0;
};

class Witness : public EvolutionObserver {
 public:
  explicit Witness(std::vector<std::string>& log) : log_(log) {}
  void start(double instant) override { say("start", instant); }
  void begin(double instant) override { say("begin", instant); }
  void iterate(double instant, const IterationReport& report) override {
    log_.push_back(fmt::format("iterate {} {}", instant, report.iteration));
  }
  void judge(double instant) override {
    say("judge", instant);
    if (refuse) {
      refuse = false;
      fail("STEP_2", {{"component", ""}, {"place", ""}, {"change", ""}, {"limit", ""}, {"instant", ""}});
    }
  }
  void accept(const SolvedInstant& solved) override {
    log_.push_back(fmt::format("accept {} step {}{}", solved.instant, solved.step, solved.last ? " last" : ""));
    if (breaks) throw std::runtime_error("no room");
  }
  void end(bool completed) override { log_.push_back(completed ? "end" : "broken off"); }

  bool refuse = false, breaks = false;

 private:
  void say(const char* what, double instant) { log_.push_back(fmt::format("{} {}", what, instant)); }
  std::vector<std::string>& log_;
};

TimeSteps steps(std::vector<double> values, bool cut) {
  TimeSteps steps;
  steps.values = std::move(values);
  steps.action = {.cut = cut, .cut_into = 2, .cut_levels = 2};
  return steps;
}

TEST(Evolution, AnInstantIsTriedIteratedJudgedAndAccepted) {
  std::vector<std::string> log;
  Solver solver(log, 1);
  Witness witness(log);
  const std::array<EvolutionObserver*, 1> observers{&witness};
  evolve(steps({0, 1}, false), solver, observers);
  EXPECT_THAT(log, ElementsAre("start 0", "begin 1", "iterate 1 0", "iterate 1 1", "judge 1", "accepted",
                               "accept 1 step 1 last", "end"));
}

TEST(Evolution, ACutStepCountsAsOneOfTheList) {
  std::vector<std::string> log;
  Solver solver(log, 0.5);
  Witness witness(log);
  const std::array<EvolutionObserver*, 1> observers{&witness};
  evolve(steps({0, 1}, true), solver, observers);
  std::erase_if(log, [](const std::string& line) { return line.starts_with("iterate"); });
  EXPECT_THAT(log, ElementsAre("start 0", "begin 1", "back", "begin 0.5", "judge 0.5", "accepted", "accept 0.5 step 0",
                               "begin 1", "judge 1", "accepted", "accept 1 step 1 last", "end"));
}

TEST(Evolution, AnObserverThatRefusesASolvedInstantLetsTheStepBeCut) {
  std::vector<std::string> log;
  Solver solver(log, 1);
  Witness witness(log);
  witness.refuse = true;
  const std::array<EvolutionObserver*, 1> observers{&witness};
  TimeSteps asked = steps({0, 1}, false);
  asked.events.push_back({.event = "DELTA_GRANDEUR", .limit = 1, .place = "", .action = {.cut = true, .cut_into = 2}});
  evolve(asked, solver, observers);
  std::erase_if(log, [](const std::string& line) { return line.starts_with("iterate"); });
  EXPECT_THAT(log, ElementsAre("start 0", "begin 1", "judge 1", "back", "begin 0.5", "judge 0.5", "accepted",
                               "accept 0.5 step 0", "begin 1", "judge 1", "accepted", "accept 1 step 1 last", "end"));
}

std::vector<std::string> told;

// What another process has tried is repeated without a word, cuts and second attempts too.
TEST(Evolution, NobodyIsToldOfThePastAgain) {
  const auto sink = [](const Message& message) { told.push_back(message.id); };
  std::vector<std::string> log;
  Solver solver(log, 0.5);
  const TimeSteps asked = steps({0, 1, 2}, true);
  told.clear();
  set_message_sink(sink);
  evolve(asked, solver, {});
  EXPECT_THAT(told, ElementsAre("EVOLUTION_7", "EVOLUTION_7"));
  const InstantFailure failure({.severity = 'S', .id = "EVOLUTION_4", .text = "", .advice = ""}, {});
  const Course past{{.instant = 1, .iterations = 0, .failure = failure},
                    {.instant = 0.5, .iterations = 1, .failure = {}},
                    {.instant = 1, .iterations = 1, .failure = {}}};
  Solver other(log, 0.5);
  other.stands_at(1);
  told.clear();
  evolve(asked, other, {}, past);
  set_message_sink(nullptr);
  EXPECT_THAT(told, ElementsAre("EVOLUTION_7"));  // of the step to 2
}

// Increments are searched up to the end of a step of the list, whichever process began to.
TEST(Evolution, WhatIsSearchedInThePastIsSearchedOn) {
  const InstantFailure failure({.severity = 'S', .id = "EVOLUTION_4", .text = "", .advice = ""}, {});
  const Course past{{.instant = 1, .iterations = 0, .failure = failure},
                    {.instant = 0.5, .iterations = 0, .failure = failure},
                    {.instant = 0.5, .iterations = 1, .failure = {}}};
  std::vector<std::string> log;
  Solver solver(log, 1);
  Witness witness(log);
  const std::array<EvolutionObserver*, 1> observers{&witness};
  solver.stands_at(0.5);
  TimeSteps asked = steps({0, 1, 2}, true);
  asked.action.cut_levels = 1;
  set_message_sink([](const Message& message) { told.push_back(message.id); });
  told.clear();
  evolve(asked, solver, observers, past);
  set_message_sink(nullptr);
  std::erase_if(log, [](const std::string& line) { return line.starts_with("iterate") || line.starts_with("judge"); });
  EXPECT_THAT(log, ElementsAre("searches", "begin 1", "accepted", "accept 1 step 1", "searches no more", "begin 2", "accepted",
                               "accept 2 step 2 last", "end"));
  EXPECT_THAT(told, testing::IsEmpty());
}

TEST(Evolution, WhateverBreaksItOffEveryObserverIsTold) {
  std::vector<std::string> log;
  Solver solver(log, 0.1);
  Witness first(log), second(log);
  const std::array<EvolutionObserver*, 2> observers{&first, &second};
  EXPECT_THROW(evolve(steps({0, 1}, false), solver, observers), Error);
  ASSERT_GE(log.size(), 2U);
  EXPECT_THAT(std::vector(log.end() - 2, log.end()), ElementsAre("broken off", "broken off"));
  log.clear();
  Solver able(log, 1);
  first.breaks = true;
  EXPECT_THROW(evolve(steps({0, 1}, false), able, observers), std::runtime_error);
  EXPECT_THAT(std::vector(log.end() - 2, log.end()), ElementsAre("broken off", "broken off"));
}

}  // namespace
}  // namespace lacon
