// A small fuzzer for any compiler: every file of a corpus, then changes of them for some seconds.
//   fuzz_targets TARGET SECONDS FOLDER
// FUZZ_SEED of the environment makes other changes. Without sanitizers and without looking at what the input reaches, it finds
// what tests should notice; run finds more.
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <random>
#include <vector>

#include "fuzz.hpp"

namespace {

using Input = std::vector<std::uint8_t>;
namespace fs = std::filesystem;

Input last;  ///< what is being tried

/// Whatever ends the process, the input that did it is in the file "broken_input".
void keep_last(int signal) {
  const int file = ::open("broken_input", O_WRONLY | O_CREAT | O_TRUNC, 0644);
  const bool kept = file >= 0 && ::write(file, last.data(), last.size()) == static_cast<ssize_t>(last.size());
  constexpr char words[] = "the input is in broken_input\n";
  if (kept && ::write(2, words, sizeof words - 1) < 0) ::_exit(1);
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void attempt(const lacon::fuzz::Target& target, Input input) {
  last = std::move(input);
  try {
    target.run(last);
  } catch (const std::exception& error) {
    lacon::fuzz::broken(std::string("an exception gets out: ") + error.what());
  }
}

class Mutator {
 public:
  explicit Mutator(const std::vector<Input>& corpus) : corpus_(corpus) {}

  Input next() {
    Input input = corpus_[below(corpus_.size())];
    for (std::size_t n = 1 + below(4); n > 0; --n) change(input);
    return input;
  }

 private:
  std::size_t below(std::size_t n) { return n == 0 ? 0 : random_() % n; }

  void change(Input& input) {
    static constexpr std::string_view numbers[] = {"0",     "-1",  "1",         "4294967295", "9223372036854775807",
                                                   "1e308", "nan", "2147483648"};
    const std::size_t at = below(input.size() + 1), size = std::min<std::size_t>(1 + below(16), input.size() - at);
    const auto from = input.begin() + static_cast<std::ptrdiff_t>(at), to = from + static_cast<std::ptrdiff_t>(size);
    const Input& other = corpus_[below(corpus_.size())];
    switch (below(7)) {
      case 0:  // a bit
        if (size > 0) *from = static_cast<std::uint8_t>(*from ^ 1u << below(8));
        break;
      case 1:  // a byte
        if (size > 0) *from = static_cast<std::uint8_t>(below(256));
        break;
      case 2:
        input.erase(from, to);
        break;
      case 3: {  // twice
        const Input piece(from, to);
        input.insert(from, piece.begin(), piece.end());
        break;
      }
      case 4: {  // a piece of another
        const std::size_t first = below(other.size()), length = std::min<std::size_t>(below(64), other.size() - first);
        input.insert(from, other.begin() + static_cast<std::ptrdiff_t>(first),
                     other.begin() + static_cast<std::ptrdiff_t>(first + length));
        break;
      }
      case 5: {  // a number that is seldom meant
        const std::string_view number = numbers[below(std::size(numbers))];
        input.erase(from, to);
        input.insert(input.begin() + static_cast<std::ptrdiff_t>(at), number.begin(), number.end());
        break;
      }
      default:
        input.resize(at);  // cut off
    }
  }

  const std::vector<Input>& corpus_;
  static unsigned seed() {
    const char* const given = std::getenv("FUZZ_SEED");
    return given ? static_cast<unsigned>(std::atoi(given)) : 1;
  }

  std::mt19937 random_{seed()};
};

}  // namespace

int main(int argc, char** argv) {
  const lacon::fuzz::Target* const target = argc == 4 ? lacon::fuzz::find_target(argv[1]) : nullptr;
  if (!target) {
    std::fprintf(stderr, "fuzz_targets TARGET SECONDS FOLDER\n");
    return 2;
  }
  for (const int signal : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL}) std::signal(signal, keep_last);
  lacon::set_message_sink([](const lacon::Message&) {});
  std::vector<Input> corpus;
  std::vector<fs::path> files(fs::directory_iterator(argv[3]), fs::directory_iterator{});
  std::sort(files.begin(), files.end());
  for (const fs::path& path : files) {
    std::ifstream file(path, std::ios::binary);
    corpus.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
    std::printf("%s\n", path.filename().c_str());
    std::fflush(stdout);
    attempt(*target, corpus.back());
  }
  Mutator mutator(corpus);
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(std::atof(argv[2]));
  long runs = 0;
  while (std::chrono::steady_clock::now() < end) attempt(*target, mutator.next()), ++runs;
  std::printf("%zu files, %ld changes of them\n", files.size(), runs);
}
