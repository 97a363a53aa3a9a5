#pragma once
// Loops in several threads, with results that have the same bits for any number of threads.
#include <cstddef>
#include <functional>

namespace lacon {

/// Threads that a loop may take: the environment variable LACON_THREADS, which the launcher sets (`--threads`, `ncpus`); 1
/// without it. Throws THREADS_1 where it is not a number of at least 1.
std::size_t n_threads();

/// Consecutive items of a loop: first <= i < last.
struct LoopBlock {
  std::size_t index, first, last;
};

/// How many blocks the items make.
constexpr std::size_t n_loop_blocks(std::size_t n_items, std::size_t block_size) {
  return (n_items + block_size - 1) / block_size;
}

/// Call work(block) for each block of `block_size` items; the last block may be shorter. Items of a block do not depend on the
/// number of threads; the thread that a block falls to and the time when it does depend on chance. So the bits of a result are
/// always the same where a block writes nothing but its own items, or keeps sums in a place of its own, which the caller adds
/// up in the order of blocks afterwards. `work` sends no messages (inform()): their order would be left to chance.
///
/// An exception ends the loop: the caller gets that of the first block that throws, as from a plain loop. Blocks behind that
/// one may have been worked on. A loop inside `work` stays in its thread.
void parallel_for(std::size_t n_items, std::size_t block_size, const std::function<void(const LoopBlock&)>& work);

/// What is done with a block: first `work`, then `in_turn`, where it is set.
struct LoopWorker {
  std::function<void(const LoopBlock&)> work, in_turn;
};

/// Likewise, for sums in one place: in_turn(block) is called in the order of blocks and one at a time, while other threads work
/// on blocks behind it. It is that of the worker whose work(block) it follows, which keeps the block's results in between, and
/// may run in another thread. There are two workers a thread.
void parallel_in_turn(std::size_t n_items, std::size_t block_size, const std::function<LoopWorker()>& new_worker);

}  // namespace lacon
