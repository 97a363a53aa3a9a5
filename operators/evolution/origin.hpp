#pragma once
// ETAT_INIT: the instant of another computation, or of the one that goes on, from which a computation starts.
#include <optional>

#include "lacon/structures/base.hpp"

namespace lacon {

struct Origin {
  Result result;
  std::int64_t order;
  double instant;
};

/// @param keywords of the command; nothing where it has no ETAT_INIT with EVOL_NOLI. Throws FIELDS_1 to FIELDS_3 where the
/// result has no such instant.
std::optional<Origin> origin_of(const Keywords& keywords, const Base& base);

}  // namespace lacon
