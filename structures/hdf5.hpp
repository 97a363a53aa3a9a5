#pragma once
// HDF5 behind one small RAII wrapper. Every failure is a lacon::Error (BASE_2 on reading, BASE_3 on writing) that names the
// file.
#include <hdf5.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace lacon::hdf5 {

/// Owns one HDF5 identifier.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle() = default;
  Handle(hid_t id, Close close) : id_(id), close_(close) {}
  Handle(Handle&& other) noexcept : id_(other.id_), close_(other.close_) { other.id_ = H5I_INVALID_HID; }
  Handle& operator=(Handle&& other) noexcept;
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle();
  operator hid_t() const { return id_; }

 private:
  hid_t id_ = H5I_INVALID_HID;
  Close close_ = nullptr;
};

template <class T>
hid_t native_type();
template <>
inline hid_t native_type<double>() {
  return H5T_NATIVE_DOUBLE;
}
template <>
inline hid_t native_type<std::int64_t>() {
  return H5T_NATIVE_INT64;
}
template <>
inline hid_t native_type<std::int32_t>() {
  return H5T_NATIVE_INT32;
}
template <>
inline hid_t native_type<std::int8_t>() {
  return H5T_NATIVE_INT8;
}
template <>
inline hid_t native_type<std::uint8_t>() {
  return H5T_NATIVE_UINT8;
}

/// A group of an open file (the root group among them). Names may be paths, "cells/nodes".
class Group {
 public:
  const std::filesystem::path& path() const { return path_; }
  hid_t id() const { return id_; }

  bool has(std::string_view name) const;      ///< a link of this name
  std::vector<std::string> children() const;  ///< names, in alphabetical order
  Group open(std::string_view name) const;
  Group create(std::string_view name) const;  ///< with creation order tracked and indexed (MED needs it)
  bool is_group(std::string_view name) const;

  std::vector<hsize_t> shape(std::string_view name) const;
  /// @param capacity that of the vector, given the number of values
  template <class T>
  std::vector<T> read(std::string_view name, std::size_t (*capacity)(std::size_t) = nullptr) const;
  std::vector<std::string> read_strings(std::string_view name) const;
  template <class T>
  void write(std::string_view name, std::span<const T> values, std::vector<hsize_t> shape = {}) const;
  template <class T>
  void write(std::string_view name, const std::vector<T>& values, std::vector<hsize_t> shape = {}) const {
    write(name, std::span<const T>(values), std::move(shape));
  }
  void write_strings(std::string_view name, const std::vector<std::string>& values) const;

  /// A large dataset of `columns` columns of the same length, one behind the other, in parts of rows that stay in the cache:
  /// `visit(first row, values)` sees these rows column by column, and the number of rows is values.size() / columns. A dataset
  /// in chunks is one part.
  template <class T>
  void read_columns(std::string_view name, std::size_t columns,
                    const std::function<void(std::size_t first, std::span<const T> values)>& visit) const;
  /// The same for writing: `fill` sets the values of a part.
  template <class T>
  void write_columns(std::string_view name, std::size_t rows, std::size_t columns,
                     const std::function<void(std::size_t first, std::span<T> values)>& fill) const;
  /// A large dataset, some rows at a time: whole ones, of as many values as its shape says behind the number of rows.
  template <class T>
  void write_rows(std::string_view name, const std::vector<hsize_t>& shape,
                  const std::function<void(std::size_t first, std::span<T> values)>& fill) const;

  bool has_attribute(std::string_view name) const;
  std::int64_t integer(std::string_view name) const;
  double real(std::string_view name) const;
  std::string text(std::string_view name) const;  ///< fixed or variable length
  std::vector<std::string> attribute_strings(std::string_view name) const;
  std::vector<std::string> attributes() const;  ///< names
  bool attribute_is_text(std::string_view name) const;
  template <class T>
  requires std::is_arithmetic_v<T>
  void set(std::string_view name, T value) const;  ///< scalar of exactly this type
  void set(std::string_view name, std::string_view value) const;
  void set(std::string_view name, const std::vector<std::string>& values) const;

 protected:
  Group(Handle id, std::filesystem::path path, bool writing);
  [[noreturn]] void refuse(std::string_view what) const;
  Handle new_dataset(std::string_view name, hid_t type, const std::vector<hsize_t>& shape) const;
  /// Write a dataset in parts of rows. @param select(space, first row, number of rows) in the space of the file
  template <class T>
  void write_parts(std::string_view name, const std::vector<hsize_t>& shape, std::size_t rows, std::size_t width,
                   const std::function<void(hid_t, std::size_t, std::size_t)>& select,
                   const std::function<void(std::size_t first, std::span<T> values)>& fill) const;

  Handle id_;
  std::filesystem::path path_;
  bool writing_ = false;
};

/// Whose a file is: those of a base have seals, those of others end as they please.
enum class Origin { base, elsewhere };

/// Open for reading; throws BASE_2 where the file is missing or is not HDF5, of a base BASE_5 where it is not what its seal
/// says (seal.hpp).
class Reader : public Group {
 public:
  explicit Reader(const std::filesystem::path& file, Origin origin = Origin::base);

 private:
  Handle file_;
};

/// Create `file` with what `write` puts into it: under the name `<file>.partial`, renamed when it is whole.
/// With `copy_of` the new file starts as a copy of that one. Throws BASE_3.
void write_whole(const std::filesystem::path& file, const std::function<void(const Group&)>& write,
                 const std::filesystem::path& copy_of = {});
/// The same for a file of a base, which is sealed.
void write_sealed(const std::filesystem::path& file, const std::function<void(const Group&)>& write);
/// The same of many small things, which are put together in memory: a call of the system for each would take longer.
void write_sealed_at_once(const std::filesystem::path& file, const std::function<void(const Group&)>& write);

}  // namespace lacon::hdf5
