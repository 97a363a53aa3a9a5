#pragma once
// Processes on several machines: those beside the operator see its memory, on every other machine one process has a copy of it
// for all that run there.
#include <mpi.h>

#include <memory>
#include <string>

#include "lacon/assembly/processes/loan.hpp"

namespace lacon {

class Machines : public Lender {
 public:
  /// Collective. The first process of all is beside the operator.
  explicit Machines(MPI_Comm all);
  ~Machines() override;
  Machines(const Machines&) = delete;
  Machines& operator=(const Machines&) = delete;

  int count() const { return count_; }
  std::unique_ptr<Loan> borrow(const std::string& path, LoanUse use, int reader = -1) const override;

 private:
  friend class Copy;
  bool is_beside_operator() const { return beside_operator_; }
  SharedMemory copy_for(int reader, const std::string& path) const;
  SharedMemory copy_here(const std::string& path) const;

  MPI_Comm all_, here_ = MPI_COMM_NULL;  ///< here: processes of this machine
  MPI_Comm between_ = MPI_COMM_NULL;     ///< the first ones of all machines; null in others
  int count_ = 1;
  bool beside_operator_ = true;
};

}  // namespace lacon
