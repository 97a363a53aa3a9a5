#include "lacon/operators/program/blas.hpp"

#include <gtest/gtest.h>

namespace lacon {
namespace {

constexpr Processor sse3{}, nehalem{.sse4_2 = true}, sandy_bridge{.sse4_2 = true, .avx = true},
    haswell{.sse4_2 = true, .avx = true, .avx2 = true, .fma = true},
    sapphire_rapids{.sse4_2 = true, .avx = true, .avx2 = true, .fma = true, .avx512 = true},
    piledriver{.is_amd = true, .sse4_2 = true, .avx = true, .fma = true},
    zen3{.is_amd = true, .sse4_2 = true, .avx = true, .avx2 = true, .fma = true},
    zen5{.is_amd = true, .sse4_2 = true, .avx = true, .avx2 = true, .fma = true, .avx512 = true},
    without_fma{.sse4_2 = true, .avx = true, .avx2 = true};

// OpenBLAS keeps its choice where that uses what the processor can do; where it has taken a kernel of an older generation, the
// newest one takes its place that the processor has all instructions for.
TEST(BetterKernel, IsTheNewestThatTheProcessorCanRun) {
  const struct {
    const char* what;
    std::string_view taken;
    Processor processor;
    std::string_view better;
  } rows[] = {
      {"Intel 6/207, unknown to 0.3.21", "Prescott", sapphire_rapids, "SkylakeX"},
      {"the same where a hypervisor hides AVX-512", "Prescott", haswell, "Haswell"},
      {"known", "SkylakeX", sapphire_rapids, ""},
      {"known, with bf16", "Cooperlake", sapphire_rapids, ""},
      {"a later release", "SapphireRapids", sapphire_rapids, ""},
      {"known", "Haswell", haswell, ""},
      {"taken for what it is not", "Nehalem", haswell, "Haswell"},
      {"known", "Sandybridge", sandy_bridge, ""},
      {"unknown", "Core2", sandy_bridge, "Sandybridge"},
      {"AVX2 without FMA", "Prescott", without_fma, "Sandybridge"},
      {"known", "Nehalem", nehalem, ""},
      {"unknown, no AVX", "Prescott", nehalem, "Nehalem"},
      {"plain SSE3", "Prescott", sse3, ""},
      {"AMD, unknown", "Barcelona", zen3, "Zen"},
      {"AMD, unknown", "Prescott", zen3, "Zen"},
      {"AMD, known", "Zen", zen3, ""},
      {"AMD family 26, taken for one without AVX-512", "Zen", zen5, "SkylakeX"},
      {"AMD, taken for Intel's", "Haswell", zen3, ""},
      {"AMD, known: FMA, but no AVX2", "Piledriver", piledriver, ""},
      {"a name that is not in the table", "Atom", sse3, ""},
  };
  for (const auto& row : rows) EXPECT_EQ(better_kernel(row.taken, row.processor), row.better) << row.what << ", " << row.taken;
}

// Every choice is a name that is left alone once it is taken: the program is started again once.
TEST(BetterKernel, IsGoodEnoughOnceTaken) {
  for (const Processor& processor :
       {sse3, nehalem, sandy_bridge, haswell, sapphire_rapids, piledriver, zen3, zen5, without_fma, present_processor()})
    if (const std::string_view better = better_kernel("Prescott", processor); !better.empty()) {
      EXPECT_EQ(better_kernel(better, processor), "") << better;
    }
}

}  // namespace
}  // namespace lacon
