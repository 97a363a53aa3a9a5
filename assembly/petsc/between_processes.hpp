#pragma once
// Rows of blocks that processes have, and what they tell each other of them.
#include <mpi.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <span>
#include <type_traits>
#include <vector>

namespace lacon {

/// What each process has for each of the others changes places. @param given for each process  @return from each of them
template <class T>
std::vector<std::vector<T>> exchanged(MPI_Comm processes, const std::vector<std::vector<T>>& given) {
  static_assert(std::is_trivially_copyable_v<T>);
  const auto n = static_cast<int>(given.size());
  std::vector<int> sent(n), got(n), sent_from(n), got_from(n);
  for (int p = 0; p < n; ++p) sent[p] = static_cast<int>(given[p].size());
  MPI_Alltoall(sent.data(), 1, MPI_INT, got.data(), 1, MPI_INT, processes);
  std::exclusive_scan(sent.begin(), sent.end(), sent_from.begin(), 0);
  std::exclusive_scan(got.begin(), got.end(), got_from.begin(), 0);
  std::vector<T> all, came(got_from.back() + got.back());
  for (const std::vector<T>& part : given) all.insert(all.end(), part.begin(), part.end());
  MPI_Datatype item;
  MPI_Type_contiguous(sizeof(T), MPI_BYTE, &item);
  MPI_Type_commit(&item);
  MPI_Alltoallv(all.data(), sent.data(), sent_from.data(), item, came.data(), got.data(), got_from.data(), item, processes);
  MPI_Type_free(&item);
  std::vector<std::vector<T>> made(n);
  for (int p = 0; p < n; ++p) made[p].assign(came.begin() + got_from[p], came.begin() + got_from[p] + got[p]);
  return made;
}

/// Numbers of all processes, one after the other.
struct Numbers {
  std::vector<std::int32_t> first;  ///< of each process, and their end

  /// @param own how many the process has
  static Numbers of(MPI_Comm processes, std::int32_t own) {
    int n = 1;
    MPI_Comm_size(processes, &n);
    Numbers made{std::vector<std::int32_t>(n + 1, 0)};
    MPI_Allgather(&own, 1, MPI_INT32_T, made.first.data() + 1, 1, MPI_INT32_T, processes);
    std::partial_sum(made.first.begin(), made.first.end(), made.first.begin());
    return made;
  }
  int n_processes() const { return static_cast<int>(first.size()) - 1; }
  int owner_of(std::int32_t number) const {
    return static_cast<int>(std::ranges::upper_bound(first, number) - first.begin()) - 1;
  }
};

/// Rows of others that a process wants to know.
class Halo {
 public:
  /// @param rows of all processes  @param wanted  numbers of others, ascending
  Halo(MPI_Comm processes, const Numbers& rows, std::span<const std::int32_t> wanted) : processes_(processes) {
    int own = 0;
    MPI_Comm_rank(processes, &own);
    std::vector<std::vector<std::int32_t>> asked(rows.n_processes());
    for (const std::int32_t row : wanted) asked[rows.owner_of(row)].push_back(row);
    given_ = exchanged(processes, asked);
    for (std::vector<std::int32_t>& of_one : given_)
      for (std::int32_t& row : of_one) row -= rows.first[own];
  }
  /// What others say of the wanted rows, in their order. @param say  appends what there is to say of an own row, from 0
  template <class T, class Say>
  std::vector<T> ask(const Say& say) const {
    std::vector<std::vector<T>> told(given_.size());
    for (std::size_t p = 0; p < given_.size(); ++p)
      for (const std::int32_t row : given_[p]) say(row, told[p]);
    std::vector<T> heard;
    for (const std::vector<T>& of_one : exchanged(processes_, told)) heard.insert(heard.end(), of_one.begin(), of_one.end());
    return heard;
  }

 private:
  MPI_Comm processes_;
  std::vector<std::vector<std::int32_t>> given_;  ///< own rows that each process wants to know
};

}  // namespace lacon
