#include "lacon/operators/program/machine.hpp"

#include <sys/resource.h>

#include <fstream>
#include <string_view>

namespace lacon {

std::string program_version() { return LACON_VERSION; }

std::string processor_name() {
  std::ifstream told("/proc/cpuinfo");
  for (std::string line; std::getline(told, line);) {
    const std::size_t colon = line.find(": ");
    if (std::string_view(line).starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return {};
}

std::int64_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return std::int64_t{1024} * usage.ru_maxrss;  // Linux counts kilobytes
}

}  // namespace lacon
