#pragma once
// What the files of several concepts have in common.
#include <algorithm>
#include <string>
#include <vector>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/structures/concepts.hpp"
#include "lacon/structures/hdf5.hpp"
#include "lacon/structures/mesh.hpp"

namespace lacon::storage {

[[noreturn]] inline void refuse(const hdf5::Group& group, const std::string& reason) {
  fail("BASE_2", {{"file", group.path().string()}, {"reason", reason}});
}

template <class T>
void write_ragged(const hdf5::Group& group, const std::string& name, const Ragged<T>& rows) {
  group.write(name + "/offset", rows.offset);
  group.write(name + "/values", rows.values);
}

/// @param capacity that of the two vectors, given the number of values
template <class T>
Ragged<T> read_ragged(const hdf5::Group& group, const std::string& offset, const std::string& values,
                      std::size_t (*capacity)(std::size_t) = nullptr) {
  Ragged<T> rows;
  rows.offset = group.read<std::int64_t>(offset, capacity);
  rows.values = group.read<T>(values, capacity);
  bool sound =
      !rows.offset.empty() && rows.offset.front() == 0 && rows.offset.back() == static_cast<std::int64_t>(rows.values.size());
  for (std::size_t i = 1; sound && i < rows.offset.size(); ++i) sound = rows.offset[i] >= rows.offset[i - 1];
  if (!sound) refuse(group, part("does_not_fit", {{"what", offset}, {"other", values}}));
  return rows;
}

template <class T>
Ragged<T> read_ragged(const hdf5::Group& group, const std::string& name) {
  return read_ragged<T>(group, name + "/offset", name + "/values");
}

/// Texts that repeat, as a list of the different ones and a number into it.
class Names {
 public:
  std::int32_t number(const std::string& name) {
    const auto at = std::find(names_.begin(), names_.end(), name);
    if (at == names_.end()) names_.push_back(name);
    return static_cast<std::int32_t>(std::find(names_.begin(), names_.end(), name) - names_.begin());
  }
  const std::vector<std::string>& all() const { return names_; }

 private:
  std::vector<std::string> names_;
};

/// `value` and, where some are functions, `function` and `function_index`.
void write_load_values(const hdf5::Group& group, const std::vector<LoadValue>& values);
std::vector<LoadValue> read_load_values(const hdf5::Group& group);

}  // namespace lacon::storage
