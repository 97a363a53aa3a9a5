#pragma once
// The processes of PETSc: lacon_petsc, which mpirun starts where there are several. They iterate, and have the cells of a large
// study (parts/solid_parts.hpp).
#include <memory>
#include <string>

#include "lacon/assembly/parts/part_processes.hpp"
#include "lacon/assembly/processes/companion.hpp"

namespace lacon {

struct PetscProgram {
  std::string program;  ///< lacon_petsc
  std::string algorithm, preconditioner;
  int iterations = 500;
  int n_ranks = 1;
  std::string hosts;  ///< as mpirun takes them; empty: this machine, or those of the batch job
};

class PetscProcesses : public PartProcesses {
 public:
  /// Whether mpirun is where a shell would find it.
  static bool have_mpirun();
  explicit PetscProcesses(PetscProgram program) : program_(std::move(program)) {}
  int size() const override { return program_.n_ranks; }
  int machines() const override { return machines_; }

  void start() override;
  /// Where one of several has failed there are no more of them; behind that they are started anew, unless they keep something.
  std::string ask(const std::string& line) override;
  /// The next line of their own. Throws likewise.
  std::string answer();
  void keep() override { keeps_ = true; }

 private:
  [[noreturn]] void fail_as_ended() const;
  [[noreturn]] void fail_without_start();
  void start_ranks();
  std::string first_answer();
  std::string checked(std::string answer);
  std::string end_of_ranks();

  PetscProgram program_;
  std::unique_ptr<Companion> ranks_;
  bool keeps_ = false;
  int machines_ = 1;
  std::string end_;  ///< how they have ended
};

}  // namespace lacon
