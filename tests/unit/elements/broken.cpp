// One library for each thing that may be wrong with a plug-in; BROKEN_<defect> says which.
#include "lacon/elements/plugin.h"

namespace {

[[maybe_unused]] void nothing(const lacon_solid_batch*) {}
[[maybe_unused]] const char* const none[] = {nullptr};
[[maybe_unused]] const char* const twice[] = {"DX", "DY", "DX", nullptr};
[[maybe_unused]] const char* const foreign[] = {"DX", "DY", "TEMP", nullptr};

[[maybe_unused]] const lacon_kernel kernels[] = {{
#if defined(BROKEN_UNNAMED)
    nullptr, LACON_SOLID, nothing, nullptr, nullptr, none
#elif defined(BROKEN_NO_FUNCTION)
    "k", LACON_LOAD, nothing, nullptr, nullptr, none
#elif defined(BROKEN_KIND)
    "k", 9, nothing, nullptr, nullptr, none
#elif defined(BROKEN_PARAMETERS)
    "k", LACON_SOLID, nothing, nullptr, nullptr, nullptr
#elif defined(BROKEN_TWICE)
    "k", LACON_SOLID, nothing, nullptr, nullptr, none, nullptr, 0, 0, 0, twice
#elif defined(BROKEN_FOREIGN)
    "k", LACON_SOLID, nothing, nullptr, nullptr, none, nullptr, 0, 0, 0, foreign
#else
    "k", LACON_SOLID, nothing, nullptr, nullptr, none
#endif
}};

[[maybe_unused]] const lacon_plugin_table table = {
#if defined(BROKEN_ABI)
    77,
#else
    LACON_ABI,
#endif
#if defined(BROKEN_SIZES)
    8,
#else
    sizeof(lacon_solid_batch),
#endif
    sizeof(lacon_load_batch),
    sizeof(lacon_contact_batch),
    "broken",
#if defined(BROKEN_EMPTY)
    0,
#else
    1,
#endif
    kernels};

}  // namespace

#if defined(BROKEN_SYMBOL)
extern "C" const lacon_plugin_table* lacon_defined_nowhere(void);
#endif

#if !defined(BROKEN_NO_ENTRY)
extern "C" const lacon_plugin_table* lacon_plugin(void) {
#if defined(BROKEN_NULL)
  return nullptr;
#elif defined(BROKEN_SYMBOL)
  return lacon_defined_nowhere();
#else
  return &table;
#endif
}
#endif
