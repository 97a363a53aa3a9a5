#pragma once
// The dense algebra under the linear solver: OpenBLAS has kernels for several generations of processors, and takes an old one
// on a processor that it does not know.
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace lacon {

/// What of a processor decides on a kernel.
struct Processor {
  bool is_amd = false;
  bool sse4_2 = false, avx = false, avx2 = false, fma = false;
  bool avx512 = false;  ///< f, cd, bw, dq and vl
};

/// The processor that this runs on, with what the system lets it use.
Processor present_processor();

/// The kernel to take instead of the one that OpenBLAS has taken, by its names; empty where that one uses what the processor
/// can do.
std::string_view better_kernel(std::string_view taken, const Processor& processor);

/// Once, at the start of main(): where OpenBLAS is linked and its kernel is poorer than the processor allows, start this
/// program again with OPENBLAS_CORETYPE set, which OpenBLAS reads when it is loaded. One thread where OPENBLAS_NUM_THREADS does
/// not say otherwise: fronts are small, more of them only slow each other down. What the user has set stands.
void set_up_blas(char** argv);

struct Blas {
  std::string library;  ///< "OpenBLAS 0.3.21"
  std::string kernel;   ///< "SkylakeX"
  int threads = 1;
};

/// What this program calculates with; nothing where no OpenBLAS is linked.
std::optional<Blas> present_blas();

}  // namespace lacon
