#include "lacon/assembly/petsc_processes.hpp"

#include <chrono>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <utility>
#include <vector>

#include "lacon/assembly/processes/host.hpp"
#include "lacon/assembly/processes/shared_memory.hpp"
#include "lacon/catalog/messages.hpp"

namespace lacon {

void PetscProcesses::start() {
  if (ranks_) return;
  if (keeps_) fail_as_ended();
  std::vector<std::string> command;
  if (program_.n_ranks > 1 || !program_.hosts.empty())
    command = {"mpirun",
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
  if (!program_.hosts.empty()) command.insert(command.end(), {"--host", program_.hosts});
  const SharedMemory mark(sizeof(std::int64_t));  // the first of them has to see it
  const std::int64_t number = std::chrono::steady_clock::now().time_since_epoch().count();
  std::memcpy(mark.data(), &number, sizeof number);
  command.insert(command.end(), {program_.program, program_.algorithm, program_.preconditioner,
                                 std::to_string(program_.iterations), mark.path(), std::to_string(number)});
  ranks_ = std::make_unique<Companion>(command);
  std::istringstream said(ranks_->answer());
  std::string word;
  if (!(said >> word)) {
    const std::string end = ranks_->end();
    const bool started = ranks_->has_started();
    ranks_.reset();
    // PETSc's libraries or mpirun are missing, or what these need of the machine is
    fail(started ? "SOLVER_10" : "SOLVER_6", {{"reason", program_.program + ": " + end}});
  }
  if (word != "ready") {
    std::string host;
    said >> host;
    ranks_.reset();
    fail("SOLVER_11", {{"host", host}, {"here", own_host()}});
  }
  said >> machines_;
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
