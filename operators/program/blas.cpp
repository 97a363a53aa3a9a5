#include "lacon/operators/program/blas.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <string>

#include "lacon/structures/openblas.hpp"

namespace lacon {
namespace {

/// Generations of kernels, in the order of what they can do.
enum Generation { sse, sse4_2, avx, avx2, avx512 };

/// OpenBLAS's names of kernels; those that are not here are of the first generation.
constexpr struct {
  std::string_view name;
  Generation generation;
} kernels[] = {{"Nehalem", sse4_2},  {"Sandybridge", avx},   {"Bulldozer", avx},        {"Piledriver", avx},
               {"Steamroller", avx}, {"Excavator", avx2},    {"Haswell", avx2},         {"Zen", avx2},
               {"SkylakeX", avx512}, {"Cooperlake", avx512}, {"SapphireRapids", avx512}};

std::string text_of(const char* function) {
  char* (*const call)() = openblas<char*()>(function);
  const char* const text = call ? call() : nullptr;
  return text ? text : "";
}

}  // namespace

Processor present_processor() {
  Processor processor;
#if defined(__x86_64__)
  __builtin_cpu_init();
  processor.is_amd = __builtin_cpu_is("amd");
  processor.sse4_2 = __builtin_cpu_supports("sse4.2");
  processor.avx = __builtin_cpu_supports("avx");
  processor.avx2 = __builtin_cpu_supports("avx2");
  processor.fma = __builtin_cpu_supports("fma");
  processor.avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512cd") &&
                     __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq") &&
                     __builtin_cpu_supports("avx512vl");
#endif
  return processor;
}

std::string_view better_kernel(std::string_view taken, const Processor& processor) {
  const struct {
    std::string_view name;
    Generation generation;
    bool can;
  } choices[] = {{"SkylakeX", avx512, processor.avx512},
                 {processor.is_amd ? "Zen" : "Haswell", avx2, processor.avx2 && processor.fma},
                 {"Sandybridge", avx, processor.avx},
                 {"Nehalem", sse4_2, processor.sse4_2}};
  const auto* const known =
      std::find_if(std::begin(kernels), std::end(kernels), [&](const auto& k) { return k.name == taken; });
  const Generation present = known == std::end(kernels) ? sse : known->generation;
  for (const auto& choice : choices)
    if (choice.can) return choice.generation > present ? choice.name : std::string_view();
  return {};
}

void set_up_blas(char** argv) {
  const std::string taken = text_of("openblas_get_corename");
  if (taken.empty()) return;
  const bool has_others = text_of("openblas_get_config").find("DYNAMIC_ARCH") != std::string::npos;
  if (has_others && !std::getenv("OPENBLAS_CORETYPE")) {
    const std::string_view better = better_kernel(taken, present_processor());
    if (!better.empty()) {
      setenv("OPENBLAS_CORETYPE", std::string(better).c_str(), 0);
      execv("/proc/self/exe", argv);  // comes back where the system has no such file: then the kernel stays
    }
  }
  if (!std::getenv("OPENBLAS_NUM_THREADS"))
    if (void (*const set_threads)(int) = openblas<void(int)>("openblas_set_num_threads")) set_threads(1);
}

std::optional<Blas> present_blas() {
  const std::string config = text_of("openblas_get_config");
  if (config.empty()) return std::nullopt;
  int (*const threads)() = openblas<int()>("openblas_get_num_threads");
  const std::size_t version_end = config.find(' ', std::string_view("OpenBLAS ").size());
  return Blas{config.substr(0, version_end), text_of("openblas_get_corename"), threads ? threads() : 1};
}

}  // namespace lacon
