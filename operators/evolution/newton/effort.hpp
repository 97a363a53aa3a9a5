#pragma once
// How hard an instant is tried.

namespace lacon {

enum class Effort {
  usual,
  searches,  ///< increments of iterations are searched along
  lasts,     ///< there may be many more iterations
  creeps,    ///< likewise, and what resists all motion leads them downhill (creep.hpp)
};

}  // namespace lacon
