#pragma once
// What reading and writing MED share: names in the file, and the few HDF5 calls that only MED needs.
#include <hdf5.h>
#include <algorithm>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lacon/structures/hdf5.hpp"
#include "lacon/structures/known_size.hpp"
#include "lacon/structures/mesh.hpp"

namespace lacon::med {

inline constexpr std::string_view no_profile = "MED_NO_PROFILE_INTERNAL";
inline constexpr std::string_view no_step = "-0000000000000000001-0000000000000000001";
inline constexpr std::size_t group_name_length = 80;  ///< MED_LNAME_SIZE
inline constexpr std::size_t name_length = 64;        ///< MED_NAME_SIZE: meshes, families, fields, profiles

inline constexpr std::size_t largest_names = std::size_t{1} << 26;  ///< bytes of names that one family is read with

/// A scalar integer attribute of a dataset (Group has only those of groups), or -1.
inline std::int64_t dataset_integer(const hdf5::Group& group, std::string_view dataset, const char* attribute) {
  std::int64_t value = -1;
  const std::string name(dataset);
  const hdf5::Handle set(H5Dopen2(group.id(), name.c_str(), H5P_DEFAULT), H5Dclose);
  if (set >= 0 && H5Aexists(set, attribute) > 0) {
    const hdf5::Handle id(H5Aopen(set, attribute, H5P_DEFAULT), H5Aclose);
    H5Aread(id, H5T_NATIVE_INT64, &value);
  }
  return value;
}

/// Rows of fixed-width text, whatever type of bytes the file keeps them in. Trailing blanks and zeros are dropped.
inline std::vector<std::string> read_names(const hdf5::Group& group, std::string_view dataset) {
  std::vector<std::string> names;
  const std::string name(dataset);
  const hdf5::Handle set(H5Dopen2(group.id(), name.c_str(), H5P_DEFAULT), H5Dclose);
  if (set < 0) return names;
  const hdf5::Handle type(H5Dget_type(set), H5Tclose);
  const hdf5::Handle space(H5Dget_space(set), H5Sclose);
  if (H5Tis_variable_str(type) > 0) return names;
  const auto rows = static_cast<std::size_t>(std::max<hssize_t>(0, H5Sget_simple_extent_npoints(space)));
  std::size_t width = H5Tget_size(type);
  if (rows > largest_names / std::max<std::size_t>(width, 1)) return names;
  std::vector<char> bytes(rows * width);
  if (rows == 0 || H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()) < 0) return names;
  if (width == 1 || (rows == 1 && width > group_name_length)) width = group_name_length;  // one long row of bytes
  for (std::size_t at = 0; at + width <= bytes.size(); at += width) {
    std::string text(bytes.data() + at, width);
    text = text.substr(0, text.find('\0'));
    text.erase(text.find_last_not_of(' ') + 1);
    names.push_back(std::move(text));
  }
  return names;
}

/// Where the nodes of `n` cells of a type are in MED's order, node by node: local node j of cell c is at columns(...)[j] + c.
inline std::array<std::size_t, 27> columns(const catalog::CellRow& row, std::size_t n) {
  std::array<std::size_t, 27> first{};
  for (std::size_t j = 0; j < static_cast<std::size_t>(row.n_nodes); ++j)
    first[j] = static_cast<std::size_t>(row.med_permutation[j]) * n;
  return first;
}

/// Nodes or cells of consecutive numbers.
struct Run {
  std::int32_t first, size;
};

/// The mesh of this name of an open MED file; throws MED_6 to MED_10.
Mesh read_mesh(const hdf5::Group& root, const std::string& name);

/// Throws MED_1 and MED_2 where a file is not MED, MED_13 where it is MED of another version than is written.
void check_appendable(const std::filesystem::path& file);

}  // namespace lacon::med
