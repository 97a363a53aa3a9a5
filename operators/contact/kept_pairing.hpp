#pragma once
// What looking at bodies has decided and keeps from instant to instant, for another process or computation to go on with.
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

namespace lacon::hdf5 {
class Group;
}

namespace lacon {

struct KeptPairing {
  std::vector<std::int32_t> left_out;  ///< choose_masters(): patch and master, a cell of the mesh, of each
  std::vector<std::int32_t> in_front;  ///< likewise: patch and the first master of a face that is in front of it
  std::vector<std::int32_t> flush;     ///< go_on_where_flush(): a patch of the zone, a master (-1: the zone alone), its edges
};

/// What is not empty of it, as data sets `left_out`, `in_front` and `flush` (docs/structures.md).
void write(const hdf5::Group& group, const KeptPairing& kept);
/// Empty where there is none.
KeptPairing read_kept_pairing(const hdf5::Group& group);

/// What the file of masters beside a field CONT_ELEM keeps for a computation to go on with.
struct KeptContact {
  std::vector<std::int64_t> covers;  ///< patches that keep their cover
  KeptPairing pairing;
};
/// Empty where there is no file, as of a result that another command made, and where it cannot be read: then BASE_8 tells what
/// is done without it. @param without a part of the message
KeptContact read_kept_contact(const std::filesystem::path& field, std::string_view without);

/// "CONT_ELEM_3.masters.h5" of "CONT_ELEM_3.h5", the file of an instant that has it.
std::filesystem::path path_of_masters(std::filesystem::path field);

}  // namespace lacon
