#pragma once
// Memory of the operator, as a process that it has started gets it: by its path, where both are on one machine.
#include <memory>
#include <string>
#include <utility>

#include "lacon/assembly/processes/shared_memory.hpp"

namespace lacon {

enum class LoanUse { read, write };

/// The memory itself, or a copy on another machine.
class Loan {
 public:
  explicit Loan(SharedMemory memory) : memory_(std::move(memory)) {}
  virtual ~Loan() = default;
  Loan(const Loan&) = delete;
  Loan& operator=(const Loan&) = delete;

  const SharedMemory& memory() const { return memory_; }
  /// A copy gets what the operator has written since.
  virtual void renew() {}
  /// The operator gets what was written into copies. No two processes may have written at the same place.
  virtual void give_back() {}

 private:
  SharedMemory memory_;
};

/// What processes on one machine need; of all these functions, and of those of their loans, all of them call each at the same
/// time.
class Lender {
 public:
  virtual ~Lender() = default;
  /// @param reader the only process that needs it; -1: all do. For the others a copy is empty  Throws as SharedMemory.
  virtual std::unique_ptr<Loan> borrow(const std::string& path, LoanUse /*use*/, int /*reader*/ = -1) const {
    return std::make_unique<Loan>(SharedMemory::open(path));
  }
};

}  // namespace lacon
