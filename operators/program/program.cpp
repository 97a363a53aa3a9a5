#include "lacon/operators/program/program.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <vector>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/operators/program/blas.hpp"
#include "lacon/operators/program/checking.hpp"
#include "lacon/operators/program/ending.hpp"
#include "lacon/operators/program/terminal.hpp"

namespace lacon {
namespace {

/// What a run has said and where its time went: one operator is one process.
struct Outcome {
  std::vector<Message> messages;
  std::vector<std::pair<std::string, double>> seconds, counts;
  std::string command, source;
  bool verbose = false, checks = false;
  std::function<void(const std::string&)> phase_watch;
} outcome;

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

void print(const Message& message) {
  std::cout.flush();
  hide_terminal_line();
  std::cerr << '<' << message.severity << "> <" << message.id << "> " << message.text << '\n';
  if (message.severity != 'I') {
    if (!outcome.command.empty())
      std::cerr << "    " << part("label_where", {{"place", outcome.command + ", " + outcome.source}}) << '\n';
    if (!message.advice.empty()) std::cerr << "    " << part("label_do", {{"advice", message.advice}}) << '\n';
  }
  outcome.messages.push_back(message);
}

/// @return whether the file could be written
bool write_status(const std::string& file, int status) {
  nlohmann::json json{{"status", status}, {"messages", nlohmann::json::array()}};
  for (const Message& m : outcome.messages)
    json["messages"].push_back({{"severity", std::string(1, m.severity)}, {"id", m.id}, {"text", m.text}, {"do", m.advice}});
  const auto sums = [](const std::vector<std::pair<std::string, double>>& rows) {
    nlohmann::json sum = nlohmann::json::object();
    for (const auto& [name, value] : rows) sum[name] = sum.value(name, 0.0) + value;
    return sum;
  };
  json["seconds"] = sums(outcome.seconds);
  json["counts"] = sums(outcome.counts);
  if (!std::cerr) json["log_lost"] = true;
  if (const std::optional<Blas> blas = present_blas())
    json["blas"] = {{"library", blas->library}, {"kernel", blas->kernel}, {"threads", blas->threads}};
  std::ofstream out(file);
  out << json.dump(1) << '\n' << std::flush;
  return out.good();
}

/// Do the work, whatever it throws. @return the exit status
int guarded(const std::function<void()>& work) {
  try {
    work();
    return done;
  } catch (const Error& error) {
    print(error.message());
    if (ending()) return internal_error;  // as a launcher that gets the signal itself
    return error.message().severity == 'S' ? solution_failed : user_error;
  } catch (const std::bad_alloc&) {
    print(message("MEMORY_1"));
    return solution_failed;
  } catch (const std::exception& error) {
    print(message("INTERNAL_1", {{"reason", error.what()}}));
  }
  return internal_error;
}

std::string version() {
  const std::optional<Blas> blas = present_blas();
  return LACON_VERSION +
         (blas ? fmt::format("\n{}, kernel {}, {} thread(s)", blas->library, blas->kernel, blas->threads) : std::string());
}

/// A standard stream that the caller has closed leads nowhere, so that no file of the base gets its number; a file that grows
/// beyond the shell's limit (ulimit -f) cannot be written, as on a full disk.
void set_up_files() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(stream, F_GETFD) < 0) open("/dev/null", O_RDWR);
  std::signal(SIGXFSZ, SIG_IGN);
}

/// Read the command line, which adds the options that every program has, then do the work.
int run(int argc, char** argv, CLI::App& app, const std::function<void()>& work) {
  set_up_files();
  set_up_blas(argv);
  std::string status_file;
  app.add_option("--status", status_file, "write the outcome to this JSON file");
  app.add_flag("-v,--verbose", outcome.verbose, "say on stderr how long each phase took, and what was counted");
  app.set_version_flag("--version", version);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? done : user_error;
  }
  set_message_sink(print);
  end_with_launcher();
  set_up_terminal_line();
  const double start = now();
  const int status = guarded(work);
  std::cout.flush();
  hide_terminal_line();
  outcome.seconds.emplace_back("total", now() - start);
  if (status_file.empty() || write_status(status_file, status)) return status;
  print(message("BASE_3", {{"file", status_file}, {"reason", "--status: the file cannot be written"}}));
  return status == done ? static_cast<int>(user_error) : status;
}

}  // namespace

int run_program(int argc, char** argv, std::string_view name, std::string_view what_it_does, const Operator& work) {
  CLI::App app{std::string(what_it_does), std::string(name)};
  std::string file;
  app.add_option("order", file, "JSON order (docs/structures.md, section 4)")->required();
  app.add_flag("--check", outcome.checks, "refuse what the order would be refused for, and end before what takes long");
  return run(argc, argv, app, [&] {
    const Order order = read_order(file);
    outcome.command = order.command;
    outcome.source = order.source;
    if (outcome.verbose) fmt::print(stderr, "{}, {}\n", outcome.command, outcome.source);
    work(order, Base(order));
  });
}

bool takes_order(int argc, char** argv) {
  for (int i = 1; i < argc; ++i)
    if (std::string_view(argv[i]).ends_with(".json") && std::string_view(argv[i - 1]) != "--status") return true;
  return false;
}

int run_tool(int argc, char** argv, CLI::App& app, const std::function<void()>& work) {
  outcome.command = app.get_name();
  for (int i = 1; i < argc; ++i) outcome.source += (i > 1 ? " " : "") + std::string(argv[i]);
  return run(argc, argv, app, work);
}

bool only_checks() { return outcome.checks; }

const std::vector<Message>& messages_so_far() { return outcome.messages; }

void watch_phases(std::function<void(const std::string&)> watch) { outcome.phase_watch = std::move(watch); }

void begin_phase(const std::string& name) {
  if (outcome.phase_watch) outcome.phase_watch(name);
}

std::map<std::string, double> phases_so_far() {
  std::map<std::string, double> sums;
  for (const auto& [name, seconds] : outcome.seconds) sums[name] += seconds;
  return sums;
}

Phase::Phase(std::string name) : name_(std::move(name)), start_(now()) { begin_phase(name_); }
Phase::~Phase() { add_to_phase(std::move(name_), now() - start_); }

void add_to_phase(std::string name, double seconds) {
  if (outcome.verbose && seconds > 0) fmt::print(stderr, "  {:<24} {:12.6f} s\n", name, seconds);
  outcome.seconds.emplace_back(std::move(name), seconds);
}
void add_to_count(std::string name, double amount) {
  if (outcome.verbose && amount != 0) fmt::print(stderr, "  {:<24} {:12.6g}\n", name, amount);
  outcome.counts.emplace_back(std::move(name), amount);
}

}  // namespace lacon
