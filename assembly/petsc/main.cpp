// lacon_petsc: the ranks of PETSc, which an operator starts and talks with over standard input and output (exchange.hpp).
#include <fcntl.h>
#include <malloc.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <memory>
#include <new>
#include <sstream>
#include <string>
#include <system_error>
#include <utility>

#include "lacon/assembly/parts/cells.hpp"
#include "lacon/assembly/petsc/krylov.hpp"
#include "lacon/assembly/petsc/machines.hpp"
#include "lacon/assembly/processes/host.hpp"
#include "lacon/structures/openblas.hpp"

namespace {

using lacon::Cells, lacon::Krylov, lacon::KrylovOptions, lacon::KrylovResult, lacon::BlockSystem, lacon::Lender, lacon::LoanUse,
    lacon::Machines, lacon::SharedMemory;

int own_rank() {
  int rank = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  return rank;
}
bool is_first() { return own_rank() == 0; }
int n_ranks() {
  int n = 1;
  MPI_Comm_size(PETSC_COMM_WORLD, &n);
  return n;
}

/// The next line of standard input, which the first rank reads, for all of them; empty at its end. They wait asleep: the
/// operator works meanwhile.
std::string next_line() {
  std::string line;
  if (is_first()) std::getline(std::cin, line);
  int size = static_cast<int>(line.size()), there = 0;
  MPI_Request request;
  for (MPI_Ibcast(&size, 1, MPI_INT, 0, PETSC_COMM_WORLD, &request); !there;) {
    MPI_Test(&request, &there, MPI_STATUS_IGNORE);
    if (!there) usleep(200);
  }
  line.resize(static_cast<std::size_t>(size));
  MPI_Bcast(line.data(), size, MPI_CHAR, 0, PETSC_COMM_WORLD);
  return line;
}

/// What standard output was. PETSc's own words (-info, -log_view, -ksp_monitor of LACON_PETSC_OPTIONS) go where errors go.
std::FILE* answers = nullptr;

bool keep_answers_apart() {
  answers = fdopen(fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1), "w");
  return answers && dup2(STDERR_FILENO, STDOUT_FILENO) >= 0;
}
void say(const std::string& line) {
  std::fprintf(answers, "%s\n", line.c_str());
  std::fflush(answers);
}

void answer(const std::string& line) {
  MPI_Barrier(PETSC_COMM_WORLD);  // what others have written is there
  if (is_first()) say(line);
}

/// What is done while it is there is counted by itself: -log_view of LACON_PETSC_OPTIONS shows it under this name.
class Stage {
 public:
  explicit Stage(const char* name) {
    PetscLogStage stage = -1;
    lacon::checked(PetscLogStageGetId(name, &stage));
    if (stage < 0) lacon::checked(PetscLogStageRegister(name, &stage));
    lacon::checked(PetscLogStagePush(stage));
  }
  ~Stage() { PetscLogStagePop(); }
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;
};

std::unique_ptr<Krylov> taken(const Lender& lender, const std::string& path, const Cells& cells, const KrylovOptions& options,
                              lacon::Multigrid& multigrid) {
  const auto loan = lender.borrow(path, LoanUse::read);
  lacon::OwnEntries entries;
  if (const lacon::ElementPart* const part = cells.part()) entries = {.matrix = &part->matrix(), .place = part->place()};
  return std::make_unique<Krylov>(BlockSystem::in(loan->memory()), std::move(entries), options, multigrid);
}

std::string solved(const Lender& lender, Krylov& krylov, double share, const std::string& path) {
  const auto loan = lender.borrow(path, LoanUse::write);
  const KrylovResult found = krylov.solve(loan->memory().numbers(), share);
  loan->give_back();
  std::ostringstream line;
  line.precision(2);
  line << (found.failure.empty() ? "converged " : "diverged ") << found.iterations << ' ' << found.residual << ' '
       << found.failure;
  return line.str();
}

/// Large arrays that are given back go back to the system: Open MPI has them kept for ever, for networks that work on memory
/// by themselves, and the matrices of a preconditioner on its way are as large as what is left in the end. Vectors do not:
/// they come and go with every solution, and fresh pages take longer than what is done with them.
void give_back_at_once() {
  constexpr int large = 1 << 25;  // bytes; more malloc does not take
  mallopt(M_MMAP_MAX, 1 << 16);
  mallopt(M_MMAP_THRESHOLD, large);
  mallopt(M_TRIM_THRESHOLD, large);
}

/// SOLVEUR says how PETSc solves, not what is there for other programs (PETSC_OPTIONS, .petscrc): its options are those of
/// LACON_PETSC_OPTIONS.
bool set_up_petsc() {
  for (const char* const others : {"PETSC_OPTIONS", "PETSC_OPTIONS_YAML"}) unsetenv(others);
  if (const char* const own = std::getenv("LACON_PETSC_OPTIONS")) setenv("PETSC_OPTIONS", own, 1);
  char name[] = "lacon_petsc", no_files[] = "-skip_petscrc";
  char* words[] = {name, no_files, nullptr};
  char** all = words;
  int count = 2;
  return PetscInitialize(&count, &all, nullptr, nullptr) == 0;
}

/// Whether memory is there that holds this number.
bool sees(const std::string& path, std::int64_t number) {
  try {
    const SharedMemory memory = SharedMemory::open(path);
    return memory.size() == sizeof number && std::memcmp(memory.data(), &number, sizeof number) == 0;
  } catch (const std::exception&) {
    return false;
  }
}

void serve(const KrylovOptions& options) {
  const Machines machines(PETSC_COMM_WORLD);
  answer("ready " + std::to_string(machines.count()));
  lacon::Multigrid multigrid;
  std::unique_ptr<Krylov> krylov;
  Cells cells(own_rank(), n_ranks(), machines);
  const auto give_up = [&](const std::string& why) {
    say(why);
    if (n_ranks() > 1) MPI_Abort(PETSC_COMM_WORLD, 1);  // others may be anywhere: what is left of them is of no use
    krylov.reset();
    multigrid.forget();
  };
  for (std::string line = next_line(); !line.empty(); line = next_line()) {
    const std::string path = line.substr(line.rfind(' ') + 1);
    try {
      if (line == "forget") {
        krylov.reset();
        if (multigrid.is_old()) multigrid.forget();
        malloc_trim(0);  // what it had goes back to the system
        answer("forgotten");
      } else if (line.starts_with("set up ")) {
        const Stage stage("set up");
        krylov = taken(machines, path, cells, options, multigrid);
        answer("taken");
        krylov->set_up();
        malloc_trim(0);  // what was freed between other pieces too: what MPI's threads take in between decides how much
        answer("ready");
      } else if (cells.obey(line)) {
        answer("done");
      } else {
        const Stage stage("solve");
        answer(solved(machines, *krylov, std::stod(line.substr(line.find(' '))), path));
      }
    } catch (const std::bad_alloc&) {
      give_up("no memory");
    } catch (const std::exception& error) {
      give_up(std::string("failed ") + error.what());
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 6) {
    std::fputs("usage: lacon_petsc ALGORITHM PRECONDITIONER ITERATIONS MEMORY NUMBER (started by operators)\n", stderr);
    return 2;
  }
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  setenv("LACON_THREADS", "1", 1);                                 // processes are what works at the same time here
  if (const char* const folder = std::getenv("LACON_MPI_MEMORY"))  // of lacon_mpirun, on its machine
    setenv("OMPI_MCA_btl_vader_backing_directory", folder, 0);
  if (!std::getenv("PMIX_NAMESPACE"))  // a process by itself, which mpirun has not started, needs no files of a session
    setenv("OMPI_MCA_orte_create_session_dirs", "0", 0);
  if (!keep_answers_apart()) return 4;
  try {
    lacon::reserve_blas_memory();
  } catch (const std::bad_alloc&) {
    return 4;  // before it has begun: the operator names the limit
  }
  if (!set_up_petsc()) return 4;
  lacon::catch_errors();
  give_back_at_once();
  int is_seen = is_first() && sees(argv[4], std::stoll(argv[5]));
  MPI_Bcast(&is_seen, 1, MPI_INT, 0, PETSC_COMM_WORLD);
  if (is_seen)
    serve({.algorithm = argv[1], .preconditioner = argv[2], .iterations = std::stoi(argv[3])});
  else
    answer("elsewhere " + lacon::own_host());
  PetscFinalize();
}
