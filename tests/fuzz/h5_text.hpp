#pragma once
// HDF5 files as text, which a fuzzer can change without making them unreadable at once. A line is an object:
//   /cells/nodes i4 [2,4] 0 1 2 3 4 5 6 7      a dataset; values that are missing are zeros, and none is written where none is
//   given /cells@types s [2] SEG2 QUAD4              an attribute of a group or dataset; without [..] a scalar /cells group
// Types: i1 u1 i4 i8 f8; s: text of any length; t16: text of 16 bytes. A 'c' behind [..]: stored in chunks. %20 in a text is
// the byte 32, % alone an empty text. What HDF5 refuses is left out.
#include <string>
#include <string_view>

namespace lacon::fuzz {

/// The bytes of the HDF5 file that a text describes.
std::string h5_from_text(std::string_view text);

}  // namespace lacon::fuzz
