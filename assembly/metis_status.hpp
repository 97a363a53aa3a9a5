#pragma once
// What METIS says of a call.
#include <metis.h>

#include <new>
#include <stdexcept>
#include <string>

namespace lacon {

inline void check_metis(int status, const char* function) {
  if (status == METIS_ERROR_MEMORY) throw std::bad_alloc();
  if (status != METIS_OK) throw std::runtime_error(std::string(function) + " returned " + std::to_string(status));
}

}  // namespace lacon
