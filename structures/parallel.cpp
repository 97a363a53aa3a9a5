#include "lacon/structures/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <charconv>
#include <cstdlib>
#include <exception>
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

void parallel_for(std::size_t n_items, std::size_t block_size, const std::function<void(const LoopBlock&)>& work) {
  const std::size_t n_blocks = n_loop_blocks(n_items, block_size);
  const auto block = [&](std::size_t i) { return LoopBlock{i, i * block_size, std::min((i + 1) * block_size, n_items)}; };
  const std::size_t threads = in_loop ? 1 : std::min(n_threads(), n_blocks);
  if (threads <= 1) {
    for (std::size_t i = 0; i < n_blocks; ++i) work(block(i));
    return;
  }
  // blocks are taken in ascending order: whichever block throws, all before it have been taken, and are worked on to their end
  std::atomic<std::size_t> next = 0, end = n_blocks;
  std::mutex mutex;
  std::exception_ptr first_error;
  const auto take = [&] {
    in_loop = true;
    for (std::size_t i = next++; i < end; i = next++) try {
        work(block(i));
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (i < end) {
          end = i;
          first_error = std::current_exception();
        }
      }
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

}  // namespace lacon
