#include "lacon/assembly/petsc/machines.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace lacon {
namespace {

/// Bytes of a message: MPI counts in int.
constexpr std::size_t most_at_once = std::size_t{1} << 28;
/// Bytes of a path, /proc/PROCESS/fd/NUMBER, with the zero behind it.
constexpr std::size_t most_of_name = 64;

/// @param send(first byte, how many)
template <class Send>
void in_messages(std::span<std::byte> bytes, const Send& send) {
  for (std::size_t at = 0; at < bytes.size(); at += most_at_once)
    send(bytes.data() + at, static_cast<int>(std::min(most_at_once, bytes.size() - at)));
}

int rank_in(MPI_Comm some) {
  int rank = 0;
  MPI_Comm_rank(some, &rank);
  return rank;
}

std::span<std::byte> bytes_of(const SharedMemory& memory) { return {memory.data(), memory.size()}; }

}  // namespace

/// Written bytes come back as what they differ in: where no two have written at the same place, the exclusive or of all
/// differences is what there is to change.
class Copy : public Loan {
 public:
  Copy(const Machines& machines, SharedMemory memory, LoanUse use) : Loan(std::move(memory)), machines_(machines) {
    if (use == LoanUse::write) note();
    MPI_Barrier(machines_.here_);  // each has it, which stays as long as one does, and nobody has written
  }
  void renew() override {
    if (machines_.between_ != MPI_COMM_NULL)
      in_messages(bytes_of(memory()),
                  [&](std::byte* first, int size) { MPI_Bcast(first, size, MPI_BYTE, 0, machines_.between_); });
    note();
    MPI_Barrier(machines_.here_);
  }
  void give_back() override {
    MPI_Barrier(machines_.here_);  // all have written
    if (machines_.between_ == MPI_COMM_NULL) return;
    const std::span<std::byte> bytes = bytes_of(memory());
    if (machines_.is_beside_operator()) {
      in_messages(bytes, [&](std::byte* first, int size) {
        MPI_Reduce(MPI_IN_PLACE, first, size, MPI_BYTE, MPI_BXOR, 0, machines_.between_);
      });
    } else {
      for (std::size_t i = 0; i < bytes.size(); ++i) before_[i] ^= bytes[i];
      in_messages(before_, [&](const std::byte* first, int size) {
        MPI_Reduce(first, nullptr, size, MPI_BYTE, MPI_BXOR, 0, machines_.between_);
      });
    }
  }

 private:
  /// What the copy is before anybody writes.
  void note() {
    if (machines_.between_ == MPI_COMM_NULL || machines_.is_beside_operator()) return;
    const std::span<const std::byte> bytes = bytes_of(memory());
    before_.assign(bytes.begin(), bytes.end());
  }

  const Machines& machines_;
  std::vector<std::byte> before_;
};

Machines::Machines(MPI_Comm all) : all_(all) {
  MPI_Comm_split_type(all, MPI_COMM_TYPE_SHARED, rank_in(all), MPI_INFO_NULL, &here_);
  const bool is_first = rank_in(here_) == 0;
  MPI_Comm_split(all, is_first ? 0 : MPI_UNDEFINED, rank_in(all), &between_);
  if (is_first) MPI_Comm_size(between_, &count_);
  int beside = is_first && rank_in(between_) == 0;
  MPI_Bcast(&count_, 1, MPI_INT, 0, here_);
  MPI_Bcast(&beside, 1, MPI_INT, 0, here_);
  beside_operator_ = beside != 0;
}

Machines::~Machines() {
  for (MPI_Comm* const some : {&here_, &between_})
    if (*some != MPI_COMM_NULL) MPI_Comm_free(some);
}

std::unique_ptr<Loan> Machines::borrow(const std::string& path, LoanUse use, int reader) const {
  if (count_ == 1) return Lender::borrow(path, use);
  if (reader >= 0) return std::make_unique<Loan>(copy_for(reader, path));
  return std::make_unique<Copy>(*this, copy_here(path), use);
}

SharedMemory Machines::copy_for(int reader, const std::string& path) const {
  const int rank = rank_in(all_);
  if (rank != 0 && rank != reader) return SharedMemory(0);
  if (rank == 0) {
    SharedMemory memory = SharedMemory::open(path);
    if (reader == 0) return memory;
    const std::uint64_t size = memory.size();
    MPI_Send(&size, 1, MPI_UINT64_T, reader, 0, all_);
    in_messages(bytes_of(memory), [&](std::byte* first, int n) { MPI_Send(first, n, MPI_BYTE, reader, 0, all_); });
    return SharedMemory(0);
  }
  std::uint64_t size = 0;
  MPI_Recv(&size, 1, MPI_UINT64_T, 0, 0, all_, MPI_STATUS_IGNORE);
  SharedMemory memory(size);
  in_messages(bytes_of(memory), [&](std::byte* first, int n) { MPI_Recv(first, n, MPI_BYTE, 0, 0, all_, MPI_STATUS_IGNORE); });
  return memory;
}

SharedMemory Machines::copy_here(const std::string& path) const {
  std::string name(most_of_name, 0);
  std::optional<SharedMemory> own;
  if (between_ != MPI_COMM_NULL) {
    if (beside_operator_) own.emplace(SharedMemory::open(path));
    std::uint64_t size = own ? own->size() : 0;
    MPI_Bcast(&size, 1, MPI_UINT64_T, 0, between_);
    if (!own) own.emplace(SharedMemory(size));
    in_messages(bytes_of(*own), [&](std::byte* first, int n) { MPI_Bcast(first, n, MPI_BYTE, 0, between_); });
    (beside_operator_ ? path : own->path()).copy(name.data(), name.size() - 1);
  }
  MPI_Bcast(name.data(), static_cast<int>(name.size()), MPI_CHAR, 0, here_);
  if (!own) own.emplace(SharedMemory::open(name.c_str()));
  return std::move(*own);
}

}  // namespace lacon
