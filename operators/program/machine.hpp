#pragma once
// What a computation runs on and what it has taken, for who asks later.
#include <cstdint>
#include <string>

namespace lacon {

/// The version of Lacon, "0.1.0".
std::string program_version();

/// The processor as the system names it, "AMD EPYC 7763 64-Core Processor"; empty where it does not.
std::string processor_name();

/// The most memory that this process has had, in bytes.
std::int64_t peak_memory();

}  // namespace lacon
