#include "lacon/structures/executable.hpp"

#include <sys/auxv.h>

namespace lacon {

std::filesystem::path executable() {
  std::error_code error;
  const std::filesystem::path known = std::filesystem::read_symlink("/proc/self/exe", error);
  if (!error) return known;
  const auto* const started = reinterpret_cast<const char*>(getauxval(AT_EXECFN));
  return started ? std::filesystem::canonical(started, error) : std::filesystem::path();
}

}  // namespace lacon
