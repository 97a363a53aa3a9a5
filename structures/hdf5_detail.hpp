#pragma once
// What the sources of hdf5.hpp share.
#include <string>
#include <string_view>

namespace lacon::hdf5 {

/// `what`, and what the system said when HDF5's last call failed: ": No space left on device".
std::string with_system_reason(std::string_view what);

/// HDF5 writes what it still holds of an object when that is closed, and says once if it cannot.
struct FailedCloses {
  int count = 0;
  std::string reason;  ///< of the last one
};

/// Of this thread, ever.
const FailedCloses& failed_closes();

}  // namespace lacon::hdf5
