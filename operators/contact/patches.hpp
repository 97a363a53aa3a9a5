#pragma once
// What each patch carries from instant to instant. A quantity is one row here: its start (zero), its place in CONT_ELEM, and
// where it is archived and found again follow from the row.
#include <cstdint>
#include <vector>

namespace lacon {

enum class Status : std::int8_t { unpaired = -1, open = 0, active = 1 };

/// Covered fraction of a patch that takes contact; of one beside a wall that it does not see, where the sliver of a crest
/// carries all; and of one that keeps contact.
inline constexpr double taking_coverage = 2e-2, least_crest = 1e-3, least_coverage = 1e-5;

/// Statuses and quantities of the patches: what a time step starts from and what is restored when it is cut.
struct Patchwise {
  std::vector<Status> status;
  std::vector<double> lambda;  ///< LAGS_C: the pressure, negative in compression

  Patchwise() = default;
  explicit Patchwise(std::size_t n_patches);
};

struct PatchQuantity {
  const char* component;                   ///< of CONT_ELEM
  std::vector<double> Patchwise::*values;  ///< (n_patches)
};

inline constexpr PatchQuantity patch_quantities[] = {
    {.component = "PRES", .values = &Patchwise::lambda},
};

inline Patchwise::Patchwise(std::size_t n_patches) : status(n_patches, Status::unpaired) {
  for (const PatchQuantity& quantity : patch_quantities) (this->*quantity.values).assign(n_patches, 0.0);
}

}  // namespace lacon
