// The entry of libFuzzer, which has a main() of its own. The environment's FUZZ_TARGET names the target.
#include <cstdlib>

#include "fuzz.hpp"

namespace {
const lacon::fuzz::Target* target = nullptr;
}

extern "C" int LLVMFuzzerInitialize(int* /*argc*/, char*** /*argv*/) {
  const char* const name = std::getenv("FUZZ_TARGET");
  target = lacon::fuzz::find_target(name ? name : "");
  if (!target) lacon::fuzz::broken("FUZZ_TARGET names no target");
  lacon::set_message_sink([](const lacon::Message&) {});
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  target->run({data, size});
  return 0;
}
