#include "lacon/assembly/tree/mumps_processes.hpp"

#include <algorithm>
#include <exception>
#include <sstream>
#include <stdexcept>
#include <system_error>

#include "lacon/assembly/processes/shared_memory.hpp"
#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/structures/executable.hpp"

namespace lacon {

void MumpsProcesses::start() {
  const auto runs = [](const auto& process) { return process->is_running(); };
  if (!processes_.empty() && (keeps_ || std::ranges::all_of(processes_, runs))) return;
  processes_.clear();
  if (keeps_) fail("SOLVER_8", {{"reason", end_}});
  std::string program = program_;
  if (program.empty()) program = executable().parent_path() / "lacon_mumps";
  try {
    for (int i = 0; i < n_; ++i)
      processes_.push_back(std::make_unique<Companion>(std::vector{program, std::to_string(i), std::to_string(n_)}));
    const SharedMemory shared(1);  // they see it where /proc is mounted
    for (const auto& process : processes_) {
      if (const bool is_ready = !process->answer().empty(); is_ready && process->ask("open " + shared.path()) == "done")
        continue;
      const std::string end = process->ask("forget").empty() ? process->end() : part("sees_no_memory");
      processes_.clear();
      fail("SOLVER_8", {{"reason", program + ": " + end}});
    }
  } catch (const std::system_error& error) {
    processes_.clear();
    fail("SOLVER_8", {{"reason", error.what()}});
  } catch (const Error&) {
    processes_.clear();
    throw;
  }
}

void MumpsProcesses::forget() noexcept {
  for (const auto& process : processes_) process->say("forget");
  for (const auto& process : processes_)
    if (process->answer().empty()) {
      end_ = process->end();
      processes_.clear();
      return;
    }
}

std::string MumpsProcesses::answer_of(int process) {
  const std::string answer = processes_[process]->answer();
  if (!answer.empty()) return answer;
  end_ = processes_[process]->end();
  processes_.clear();
  fail("SOLVER_8", {{"reason", end_}});
}

std::string MumpsProcesses::answer_of_first() {
  if (processes_.empty()) return {};
  std::string answer = processes_.front()->answer();
  if (answer.empty()) {
    end_ = processes_.front()->end();
    processes_.clear();
  }
  return answer;
}

std::string MumpsProcesses::ask(const std::string& line) {
  if (processes_.empty()) fail("SOLVER_8", {{"reason", end_.empty() ? part("cannot_be_started") : end_}});
  for (const auto& process : processes_) process->say(line);
  std::string answer = "done";
  for (int process = 0; process < n_; ++process)
    if (const std::string now = answer_of(process); now != "done") answer = now;
  return answer;
}

std::vector<std::vector<double>> MumpsProcesses::ask(const Question& question, std::span<const int> process,
                                                     const std::function<std::string(std::size_t)>& rest,
                                                     const std::function<void()>& meanwhile,
                                                     const std::function<void(std::size_t)>& answered) {
  if (processes_.empty()) fail("SOLVER_8", {{"reason", end_.empty() ? part("cannot_be_started") : end_}});
  for (std::size_t p = 0; p < process.size(); ++p) processes_[process[p]]->say(question.verb + rest(p));
  std::exception_ptr thrown;
  const auto call = [&](const auto& function, auto... arguments) {
    if (!function || thrown) return;
    try {
      function(arguments...);
    } catch (...) {
      thrown = std::current_exception();  // answers are on their way
    }
  };
  call(meanwhile);
  std::vector<std::vector<double>> found(process.size());
  bool has_memory = true;
  std::string failure;
  for (std::size_t p = 0; p < process.size(); ++p) {
    const std::string answer = answer_of(process[p]);
    std::istringstream said(answer);
    std::string word;
    said >> word;
    if (word == "done")
      for (double number; said >> number;) found[p].push_back(number);
    else if (answer == "no memory")
      has_memory = false;
    else
      failure = answer;
    if (has_memory && failure.empty()) call(answered, p);
  }
  if (!failure.empty()) throw std::runtime_error("lacon_mumps: " + failure);
  if (!has_memory) fail("SOLVER_2", {{"phase", question.phase}, {"equations", std::to_string(question.equations)}});
  if (thrown) std::rethrow_exception(thrown);
  return found;
}

}  // namespace lacon
