#pragma once
// What writing the meshes and writing the fields of a MED file share.
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lacon/structures/formats/med_layout.hpp"

namespace lacon::med {

void set_int(const hdf5::Group& group, const char* name, std::int64_t value);
/// MED keeps text attributes as zero-ended strings of fixed length.
void set_text(const hdf5::Group& group, const char* name, std::string_view value);

/// A dataset of `columns` numbers for each of `count` nodes or cells, with the attributes that MED gives it.
/// @param fill as of hdf5::Group::write_columns()
template <class T, class Fill>
void write_numbers(const hdf5::Group& group, const char* name, std::size_t count, std::size_t columns, const Fill& fill) {
  group.write_columns<T>(name, count, columns, fill);
  const hdf5::Handle set(H5Dopen2(group.id(), name, H5P_DEFAULT), H5Dclose);
  const hdf5::Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  for (const auto& [attribute, value] :
       {std::pair("CGT", std::int32_t{1}), std::pair("NBR", static_cast<std::int32_t>(count))}) {
    const hdf5::Handle id(H5Acreate2(set, attribute, H5T_STD_I32LE, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    H5Awrite(id, H5T_NATIVE_INT32, &value);
  }
}

/// 16 characters each, one behind the other.
std::string in_columns(const std::vector<std::string>& names);

/// Throws MED_12. @param is_link the name becomes that of an HDF5 group, which cannot hold a '/'
void check_name(const hdf5::Group& root, const std::string& what, std::string_view name, std::size_t length,
                bool is_link = true);

/// Cells of one type, in the order of the mesh.
struct CellList {
  std::vector<Run> runs;
  std::size_t size = 0;
};

/// The cells of each type: what MED keeps together.
std::map<CellType, CellList> by_type(const Mesh& mesh);

/// Goes through the cells of a list in its order, some at a time.
class CellCursor {
 public:
  explicit CellCursor(const CellList& cells) : run_(cells.runs.begin()) {}

  /// The next `n` cells as runs. @param visit(place among them, first cell, how many)
  template <class Visit>
  void next(std::size_t n, const Visit& visit) {
    for (std::size_t place = 0; place < n;) {
      const std::size_t size = std::min(n - place, static_cast<std::size_t>(run_->size) - done_);
      visit(place, static_cast<std::size_t>(run_->first) + done_, size);
      place += size;
      done_ += size;
      if (done_ == static_cast<std::size_t>(run_->size)) ++run_, done_ = 0;
    }
  }

 private:
  std::vector<Run>::const_iterator run_;
  std::size_t done_ = 0;  ///< of this run
};

}  // namespace lacon::med
