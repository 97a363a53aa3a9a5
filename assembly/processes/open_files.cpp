#include "lacon/assembly/processes/open_files.hpp"

#include <sys/resource.h>

#include <cerrno>
#include <string>

#include "lacon/catalog/messages.hpp"

namespace lacon {

void refuse_too_few_files(int error) {
  if (error != EMFILE) return;
  rlimit files{};
  getrlimit(RLIMIT_NOFILE, &files);
  fail("SOLVER_17", {{"limit", std::to_string(files.rlim_cur)}});
}

}  // namespace lacon
