#include "lacon/structures/parallel.hpp"

#include <algorithm>
#include <charconv>
#include <condition_variable>
#include <cstdlib>
#include <exception>
#include <functional>
#include <map>
#include <mutex>
#include <string_view>
#include <system_error>
#include <thread>
#include <vector>

#include "lacon/catalog/messages.hpp"

namespace lacon {
namespace {

thread_local bool in_loop = false;

struct Blocks {
  std::size_t n_items, block_size;
  std::size_t count() const { return n_loop_blocks(n_items, block_size); }
  LoopBlock operator[](std::size_t i) const { return {i, i * block_size, std::min((i + 1) * block_size, n_items)}; }
};

/// A loop in several threads. A thread whose block has not its turn yet leaves it, with its worker, to whoever brings the turn
/// there, and goes on with another block and a spare worker. Blocks are taken in ascending order: whichever block throws, all
/// before it have been taken, and are worked on to their end.
class LoopInTurn {
 public:
  LoopInTurn(const Blocks& blocks, std::size_t threads, const std::function<LoopWorker()>& new_worker)
      : blocks_(blocks), end_(blocks.count()) {
    while (workers_.size() < 2 * threads) workers_.push_back(new_worker());
    for (const LoopWorker& worker : workers_) spare_.push_back(&worker);
  }

  /// In this thread and others. Throws what the first block that throws does.
  void run(std::size_t threads) {
    {
      std::vector<std::jthread> others;
      try {
        while (others.size() + 1 < threads) others.emplace_back([this] { take_blocks(); });
      } catch (const std::system_error&) {  // no more threads to be had: those that there are do all the work
      }
      take_blocks();
    }
    if (first_error_) std::rethrow_exception(first_error_);
  }

 private:
  using Lock = std::unique_lock<std::mutex>;

  void take_blocks() {
    in_loop = true;
    Lock lock(mutex_);
    while (next_ < end_) {
      if (spare_.empty())
        has_spare_.wait(lock);
      else
        work(lock);
    }
    has_spare_.notify_all();  // there is nothing left to wait for
    in_loop = false;
  }

  /// On the next block, and in turn on all that have waited for it.
  void work(Lock& lock) {
    const LoopWorker* const worker = spare_.back();
    spare_.pop_back();
    const std::size_t own = next_++;
    call(lock, worker->work, own);
    if (!worker->in_turn) {
      spare_.push_back(worker);
      return;
    }
    finished_.emplace(own, worker);
    for (auto at = finished_.find(turn_); !in_turn_ && turn_ < end_ && at != finished_.end(); at = finished_.find(turn_)) {
      const LoopWorker* const waited = at->second;
      finished_.erase(at);
      in_turn_ = true;
      call(lock, waited->in_turn, turn_);
      in_turn_ = false;
      ++turn_;
      spare_.push_back(waited);
      has_spare_.notify_one();
    }
  }

  /// Without the lock; what is thrown ends the loop at this block.
  void call(Lock& lock, const std::function<void(const LoopBlock&)>& part, std::size_t i) {
    lock.unlock();
    try {
      part(blocks_[i]);
      lock.lock();
    } catch (...) {
      lock.lock();
      if (i >= end_) return;
      end_ = i;
      first_error_ = std::current_exception();
    }
  }

  const Blocks blocks_;
  std::vector<LoopWorker> workers_;
  std::mutex mutex_;  // of all that follows
  std::condition_variable has_spare_;
  std::vector<const LoopWorker*> spare_;
  std::map<std::size_t, const LoopWorker*> finished_;  // by block, waiting for its turn
  std::size_t next_ = 0, turn_ = 0, end_;              // end: behind the last block, or the first that threw
  bool in_turn_ = false;
  std::exception_ptr first_error_;
};

}  // namespace

std::size_t n_threads() {
  const char* const value = std::getenv("LACON_THREADS");
  if (!value) return 1;
  const std::string_view text = value;
  std::size_t count = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (error != std::errc() || end != text.data() + text.size() || count < 1) fail("THREADS_1", {{"value", value}});
  return count;
}

void parallel_in_turn(std::size_t n_items, std::size_t block_size, const std::function<LoopWorker()>& new_worker) {
  const Blocks blocks{n_items, block_size};
  const std::size_t threads = in_loop ? 1 : std::min(n_threads(), blocks.count());
  if (threads > 1) {
    LoopInTurn(blocks, threads, new_worker).run(threads);
    return;
  }
  const LoopWorker worker = new_worker();
  for (std::size_t i = 0; i < blocks.count(); ++i) {
    worker.work(blocks[i]);
    if (worker.in_turn) worker.in_turn(blocks[i]);
  }
}

void parallel_for(std::size_t n_items, std::size_t block_size, const std::function<void(const LoopBlock&)>& work) {
  parallel_in_turn(n_items, block_size, [&] { return LoopWorker{work, nullptr}; });
}

}  // namespace lacon
