#pragma once
// The processes of PETSc: lacon_petsc, which mpirun starts where there are several. They iterate, and have the cells of a large
// study (parts/solid_parts.hpp).
#include <memory>
#include <string>

#include "lacon/assembly/processes/companion.hpp"

namespace lacon {

struct PetscProgram {
  std::string program;  ///< lacon_petsc
  std::string algorithm, preconditioner;
  int iterations = 500;
  int n_ranks = 1;
};

class PetscProcesses {
 public:
  explicit PetscProcesses(PetscProgram program) : program_(std::move(program)) {}
  int size() const { return program_.n_ranks; }

  /// Start them, unless they run. Throws SOLVER_6, SOLVER_8 where they have ended with what nobody else has.
  void start();
  /// Say a line and wait for the answer. Throws SOLVER_8 where they have ended.
  std::string ask(const std::string& line);
  /// The next line of their own. Throws likewise.
  std::string answer();
  /// From now on they have what nobody else has: they are not started a second time.
  void keep() { keeps_ = true; }

 private:
  [[noreturn]] void fail_as_ended() const;
  std::string checked(std::string answer);

  PetscProgram program_;
  std::unique_ptr<Companion> ranks_;
  bool keeps_ = false;
  std::string end_;  ///< how they have ended
};

}  // namespace lacon
