#pragma once
// The frame of every operator's main(): command line, order, messages, timings, exit status.
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "lacon/catalog/messages.hpp"
#include "lacon/structures/base.hpp"
#include "lacon/structures/order.hpp"

namespace CLI {
class App;
}

namespace lacon {

/// An operator that is asked to end (a signal) has the status of an internal error, as where the signal ends it at once.
enum ExitStatus { done = 0, user_error = 2, solution_failed = 3, internal_error = 4 };

/// What an operator does with its order.
using Operator = std::function<void(const Order&, const Base&)>;

/// Run `work` on the order that the command line names. Prints messages on stderr, writes --status FILE, never throws.
/// @return the exit status of DESIGN.md, "operators/"
int run_program(int argc, char** argv, std::string_view name, std::string_view what_it_does, const Operator& work);

/// Whether the command line names an order (a file *.json); what also works on files alone is otherwise a tool.
bool takes_order(int argc, char** argv);

/// Run `work` of a program that takes files instead of an order, once `app` has read its options from the command line.
/// Messages and exit status as for run_program(); --status and --verbose are there too.
int run_tool(int argc, char** argv, CLI::App& app, const std::function<void()>& work);

/// What this program has said so far.
const std::vector<Message>& messages_so_far();

/// From now on `watch` is told the name of each phase that begins.
void watch_phases(std::function<void(const std::string&)> watch);

/// A phase begins whose time will be added when it is known; a Phase says it by itself.
void begin_phase(const std::string& name);
/// Seconds of each phase so far.
std::map<std::string, double> phases_so_far();

/// Add to a phase of the operator's timings.
void add_to_phase(std::string name, double seconds);

/// Add to a count that the operator reports beside its timings: factorisations, iterations of GMRES.
void add_to_count(std::string name, double amount);

/// The time from construction to destruction goes to the phase `name` of the operator's timings.
class Phase {
 public:
  explicit Phase(std::string name);
  ~Phase();
  Phase(const Phase&) = delete;
  Phase& operator=(const Phase&) = delete;

 private:
  std::string name_;
  double start_;
};

}  // namespace lacon
