#include "lacon/structures/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <charconv>
#include <condition_variable>
#include <cstdlib>
#include <exception>
#include <functional>
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
  // blocks are taken in ascending order: whichever block throws, all before it have been taken, and are worked on to their end
  std::atomic<std::size_t> next = 0, end = n_blocks;
  std::mutex mutex;  // of what follows, and of changes of `end`
  std::exception_ptr first_error;
  std::size_t turn = 0;
  std::condition_variable next_turn;
  const auto wait_for_turn = [&](std::size_t i) {  // false: it does not come, a block before has thrown
    std::unique_lock lock(mutex);
    next_turn.wait(lock, [&] { return turn == i || end <= i; });
    return turn == i;
  };
  const auto take = [&](const LoopWorker& worker) {
    in_loop = true;
    std::size_t i = n_blocks;
    try {
      while ((i = next++) < end) {
        worker.work(block(i));
        if (!worker.in_turn) continue;
        if (!wait_for_turn(i)) break;
        worker.in_turn(block(i));
        const std::lock_guard lock(mutex);
        ++turn;
        next_turn.notify_all();
      }
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (i < end) {
        end = i;
        first_error = std::current_exception();
      }
      next_turn.notify_all();
    }
    in_loop = false;
  };
  std::vector<LoopWorker> workers;
  while (workers.size() < threads) workers.push_back(new_worker());
  {
    std::vector<std::jthread> others;
    try {
      while (others.size() + 1 < threads) others.emplace_back(take, std::cref(workers[others.size() + 1]));
    } catch (const std::system_error&) {  // no more threads to be had: those that there are do all the work
    }
    take(workers.front());
  }
  if (first_error) std::rethrow_exception(first_error);
}

void parallel_for(std::size_t n_items, std::size_t block_size, const std::function<void(const LoopBlock&)>& work) {
  parallel_in_turn(n_items, block_size, [&] { return LoopWorker{work, nullptr}; });
}

}  // namespace lacon
