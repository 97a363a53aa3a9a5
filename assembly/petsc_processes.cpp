#include "lacon/assembly/petsc_processes.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <sstream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "lacon/assembly/processes/host.hpp"
#include "lacon/assembly/processes/shared_memory.hpp"
#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"

namespace lacon {
namespace {

/// mpirun that has too few files open waits for ever. Throws SOLVER_10.
void make_room_for_files(int n_processes) {
  const auto needed = static_cast<rlim_t>(6 * n_processes + 28);
  rlimit files{};
  getrlimit(RLIMIT_NOFILE, &files);
  if (files.rlim_cur >= needed) return;
  files.rlim_cur = std::min(files.rlim_max, needed);
  setrlimit(RLIMIT_NOFILE, &files);
  if (files.rlim_cur < needed)
    fail("SOLVER_10",
         {{"reason", part("few_open_files", {{"limit", std::to_string(files.rlim_cur)}, {"needed", std::to_string(needed)}})}});
}

}  // namespace

void PetscProcesses::start() {
  if (ranks_) return;
  if (keeps_) fail_as_ended();
  try {
    start_ranks();
  } catch (const std::system_error& error) {
    fail("SOLVER_10", {{"reason", error.what()}});
  }
}

void PetscProcesses::start_ranks() {
  std::vector<std::string> command;
  if (program_.n_ranks > 1 || !program_.hosts.empty()) {
    make_room_for_files(program_.n_ranks);
    command = {std::filesystem::path(program_.program).replace_filename("lacon_mpirun"),
               "mpirun",
               "-n",
               std::to_string(program_.n_ranks),
               "--oversubscribe",
               "--bind-to",
               "none",
               "--mca",
               "btl_vader_single_copy_mechanism",
               "none",
               "--mca",
               "mpi_yield_when_idle",  // others may need the cores
               "1"};
  }
  if (!program_.hosts.empty()) command.insert(command.end(), {"--host", program_.hosts});
  const SharedMemory mark(sizeof(std::int64_t));  // the first of them has to see it
  const std::int64_t number = std::chrono::steady_clock::now().time_since_epoch().count();
  std::memcpy(mark.data(), &number, sizeof number);
  command.insert(command.end(), {program_.program, program_.algorithm, program_.preconditioner,
                                 std::to_string(program_.iterations), mark.path(), std::to_string(number)});
  ranks_ = std::make_unique<Companion>(command);
  const std::string first = first_answer();
  if (first.empty()) fail_without_start();
  std::istringstream said(first);
  std::string word, host;
  said >> word;
  if (word == "ready") {
    said >> machines_;
    return;
  }
  std::getline(said >> std::ws, host);
  ranks_.reset();
  fail("SOLVER_11", {{"host", host}, {"here", own_host()}});
}

/// What MPI says before is for the user.
std::string PetscProcesses::first_answer() {
  std::string line = ranks_->answer();
  for (; !line.empty() && !line.starts_with("ready ") && !line.starts_with("elsewhere "); line = ranks_->answer())
    std::cerr << line << '\n';
  return line;
}

void PetscProcesses::fail_without_start() {
  const std::string end = ranks_->end();
  // where nobody has killed them PETSc's libraries or mpirun are missing, or what these need of the machine is
  const char* const message = !ranks_->has_started() ? "SOLVER_6" : ranks_->was_killed() ? "SOLVER_8" : "SOLVER_10";
  ranks_.reset();
  fail(message, {{"reason", program_.program + ": " + end}});
}

std::string PetscProcesses::ask(const std::string& line) {
  if (!ranks_) fail_as_ended();
  return checked(ranks_->ask(line));
}

std::string PetscProcesses::answer() { return checked(ranks_->answer()); }

std::string PetscProcesses::checked(std::string answer) {
  if (!answer.empty()) return answer;
  end_ = ranks_->end();
  ranks_.reset();
  fail_as_ended();
}

void PetscProcesses::fail_as_ended() const { fail("SOLVER_8", {{"reason", end_}}); }

}  // namespace lacon
