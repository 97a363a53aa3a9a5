#include "lacon/assembly/petsc_processes.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <initializer_list>
#include <iostream>
#include <new>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "lacon/assembly/mpirun/own_folder.hpp"
#include "lacon/assembly/processes/host.hpp"
#include "lacon/assembly/processes/shared_memory.hpp"
#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"

namespace lacon {
namespace {

/// Variables of the environment by which mpirun is set, or takes itself to be in a batch job; some of them where there are
/// many.
std::string variables_of_mpirun() {
  constexpr int most = 6;
  int count = 0;
  std::string names;
  for (char** text = environ; *text; ++text) {
    const std::string_view variable(*text);
    const auto begins = [&](std::string_view name) { return variable.starts_with(name); };
    if (std::ranges::none_of(std::initializer_list<std::string_view>{"OMPI_MCA_", "PMIX_MCA_", "SLURM_"}, begins)) continue;
    if (++count > most) return names + ", ...";
    names += (names.empty() ? "" : ", ") + std::string(variable.substr(0, variable.find('=')));
  }
  return names;
}

/// By what may have ended them on this machine.
std::string remedy_here() {
  rlimit memory{};
  getrlimit(RLIMIT_AS, &memory);
  if (memory.rlim_cur == RLIM_INFINITY) return part("mpi_look_at_machine");
  return part("mpi_look_at_memory", {{"limit", std::to_string(memory.rlim_cur >> 10)}});
}

/// What to do about processes of MPI that have ended before they had begun.
std::string remedy(const std::string& hosts) {
  const std::string most_likely = hosts.empty() ? remedy_here() : part("mpi_look_at_hosts", {{"hosts", hosts}});
  const std::string variables = variables_of_mpirun();
  return variables.empty() ? most_likely : part("mpi_look_at_variables", {{"remedy", most_likely}, {"names", variables}});
}

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
         {{"reason", part("few_open_files", {{"limit", std::to_string(files.rlim_cur)}, {"needed", std::to_string(needed)}})},
          {"remedy", part("mpi_look_at_machine")}});
}

}  // namespace

bool PetscProcesses::have_mpirun() {
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (access((std::filesystem::path(folder) / "mpirun").c_str(), X_OK) == 0) return true;
  return false;
}

void PetscProcesses::start() {
  if (ranks_) return;
  if (keeps_) fail_as_ended();
  try {
    start_ranks();
  } catch (const std::system_error& error) {
    fail("SOLVER_10", {{"reason", error.what()}, {"remedy", remedy({})}});
  }
}

void PetscProcesses::start_ranks() {
  std::vector<std::string> command;
  if (program_.n_ranks > 1 || !program_.hosts.empty()) {
    if (!have_mpirun()) {
      const char* const path = std::getenv("PATH");
      fail("SOLVER_18", {{"count", std::to_string(program_.n_ranks)}, {"path", path ? path : ""}});
    }
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
  const std::string reason = program_.program + ": " + end_of_ranks();
  const bool started = ranks_->has_started(), killed = ranks_->was_killed();
  ranks_.reset();
  if (!started) fail("SOLVER_6", {{"reason", reason}});
  if (killed) fail("SOLVER_8", {{"reason", reason}});
  // PETSc's libraries are missing, or what these or mpirun need of the machine is
  fail("SOLVER_10", {{"reason", reason}, {"remedy", remedy(program_.hosts)}});
}

std::string PetscProcesses::ask(const std::string& line) {
  if (!ranks_) fail_as_ended();
  return checked(ranks_->ask(line));
}

std::string PetscProcesses::answer() { return checked(ranks_->answer()); }

std::string PetscProcesses::checked(std::string answer) {
  const bool have_failed = answer == no_memory || answer.starts_with(has_failed);
  if (!answer.empty() && (!have_failed || program_.n_ranks == 1)) return answer;
  end_ = end_of_ranks();  // the rank that has failed ends the others, whose own answers may be on their way
  ranks_.reset();
  if (have_failed && !keeps_) return answer;
  if (answer == no_memory) throw std::bad_alloc();
  if (have_failed) end_ = reason_of(answer);
  fail_as_ended();
}

/// How they have ended. If lacon_mpirun was killed nobody has removed its folders; mpirun, whose output was at its end, is
/// gone.
std::string PetscProcesses::end_of_ranks() {
  std::string end = ranks_->end();
  if (ranks_->was_killed())
    for (const std::filesystem::path& above : {folder_of_sessions(), std::filesystem::path(folder_of_memory)})
      OwnFolder::remove_left(above);
  return end;
}

void PetscProcesses::fail_as_ended() const { fail("SOLVER_8", {{"reason", end_}}); }

}  // namespace lacon
