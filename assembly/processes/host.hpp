#pragma once
// The machine that a process runs on.
#include <unistd.h>

#include <climits>
#include <string>

namespace lacon {

/// Its name.
inline std::string own_host() {
  char name[HOST_NAME_MAX + 1] = {};
  gethostname(name, HOST_NAME_MAX);
  return name;
}

}  // namespace lacon
