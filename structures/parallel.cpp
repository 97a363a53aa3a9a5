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
  const std::size_t n_blocks = n_loop_blocks(n_items, block_size);
  const auto block = [&](std::size_t i) { return LoopBlock{i, i * block_size, std::min((i + 1) * block_size, n_items)}; };
  const std::size_t threads = in_loop ? 1 : std::min(n_threads(), n_blocks);
  if (threads <= 1) {
    const LoopWorker worker = new_worker();
    for (std::size_t i = 0; i < n_blocks; ++i) {
      worker.work(block(i));
      if (worker.in_turn) worker.in_turn(block(i));
    }
    return;
  }
  // A thread whose block has not its turn yet leaves it, with its worker, to whoever brings the turn there, and goes on with
  // another block and a spare worker. Blocks are taken in ascending order: whichever block throws, all before it have been
  // taken, and are worked on to their end.
  std::vector<LoopWorker> workers;
  while (workers.size() < 2 * threads) workers.push_back(new_worker());
  std::mutex mutex;  // of all that follows
  std::condition_variable has_spare;
  std::vector<const LoopWorker*> spare;
  for (const LoopWorker& worker : workers) spare.push_back(&worker);
  std::map<std::size_t, const LoopWorker*> finished;  // by block, waiting for its turn
  std::size_t next = 0, turn = 0, end = n_blocks;     // end: behind the last block, or the first that threw
  bool in_turn = false;
  std::exception_ptr first_error;
  const auto thrown_by = [&](std::size_t i) {
    if (i >= end) return;
    end = i;
    first_error = std::current_exception();
  };
  const auto take = [&] {
    in_loop = true;
    std::unique_lock lock(mutex);
    const auto call = [&](const std::function<void(const LoopBlock&)>& part, std::size_t i) {
      lock.unlock();
      try {
        part(block(i));
        lock.lock();
      } catch (...) {
        lock.lock();
        thrown_by(i);
      }
    };
    while (next < end) {
      if (spare.empty()) {
        has_spare.wait(lock);
        continue;
      }
      const LoopWorker* worker = spare.back();
      spare.pop_back();
      const std::size_t own = next++;
      call(worker->work, own);
      if (!worker->in_turn) {
        spare.push_back(worker);
        continue;
      }
      finished.emplace(own, worker);
      for (auto at = finished.find(turn); !in_turn && turn < end && at != finished.end(); at = finished.find(turn)) {
        worker = at->second;
        finished.erase(at);
        in_turn = true;
        call(worker->in_turn, turn);
        in_turn = false;
        ++turn;
        spare.push_back(worker);
        has_spare.notify_one();
      }
    }
    has_spare.notify_all();  // there is nothing left to wait for
    in_loop = false;
  };
  {
    std::vector<std::jthread> others;
    try {
      while (others.size() + 1 < threads) others.emplace_back(take);
    } catch (const std::system_error&) {  // no more threads to be had: those that there are do all the work
    }
    take();
  }
  if (first_error) std::rethrow_exception(first_error);
}

void parallel_for(std::size_t n_items, std::size_t block_size, const std::function<void(const LoopBlock&)>& work) {
  parallel_in_turn(n_items, block_size, [&] { return LoopWorker{work, nullptr}; });
}

}  // namespace lacon
