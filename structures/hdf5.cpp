#include "lacon/structures/hdf5.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <utility>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/structures/hdf5_detail.hpp"
#include "lacon/structures/memory.hpp"

namespace lacon::hdf5 {
namespace {

/// What texts are converted in: HDF5's own megabyte costs more than to read the few that there are.
Handle small_buffer() {
  Handle transfer(H5Pcreate(H5P_DATASET_XFER), H5Pclose);
  H5Pset_buffer(transfer, 1 << 14, nullptr, nullptr);
  return transfer;
}

std::string zero_ended(std::string_view name) { return std::string(name); }

Handle string_type() {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, H5T_VARIABLE);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return type;
}

/// The number of values; the largest number where there are more.
std::size_t count(const std::vector<hsize_t>& shape) {
  std::size_t product = 1;
  for (const hsize_t extent : shape)
    if (extent == 0) return 0;
  for (const hsize_t extent : shape)
    if (__builtin_mul_overflow(product, extent, &product)) return std::numeric_limits<std::size_t>::max();
  return product;
}

// Limits of docs/trust.md: a small file may claim any size, or name one text many times.
constexpr std::size_t expansion = 64;          // times the size of its file that the values of a dataset may take
constexpr std::size_t always = 1 << 20;        // bytes that they may take in any case
constexpr std::size_t attribute_texts = 1000;  // of one attribute

/// How many bytes a dataset of the file of `object` may take in memory.
std::size_t most_bytes(hid_t object) {
  const Handle file(H5Iget_file_id(object), H5Fclose);
  hsize_t size = 0;
  H5Fget_filesize(file, &size);
  return std::max<std::size_t>(always, expansion * size);
}

bool fits(hid_t object, std::size_t count, std::size_t width) {
  return count <= always / std::max<std::size_t>(width, 1) || count <= most_bytes(object) / std::max<std::size_t>(width, 1);
}

/// What is wrong with the group, dataset or attribute of a name, by its row of parts.toml.
std::string about(std::string_view row, std::string_view name) { return part(row, {{"name", std::string(name)}}); }

/// Memory for texts of variable length, up to a limit.
struct Budget {
  std::size_t left;
  static void* take(std::size_t size, void* budget) {
    std::size_t& left = static_cast<Budget*>(budget)->left;
    if (size > left) return nullptr;
    left -= size;
    return std::malloc(size);
  }
  static void give_back(void* text, void* /*budget*/) { std::free(text); }
};

/// Strings out of `size` items that `read(memory type, buffer)` delivers, of fixed or variable length. Fixed ones lose
/// trailing blanks and zeros. @param transfer property list with which `read` reads
template <class Read>
bool read_texts(hid_t type, hid_t space, std::size_t size, hid_t transfer, Read read, std::vector<std::string>& texts) {
  if (H5Tget_class(type) != H5T_STRING) return false;
  texts.clear();
  if (H5Tis_variable_str(type) > 0) {
    const Handle memory = string_type();
    H5Tset_cset(memory, H5Tget_cset(type));
    std::vector<char*> buffer(size, nullptr);
    if (read(static_cast<hid_t>(memory), static_cast<void*>(buffer.data())) < 0) return false;
    for (const char* item : buffer) texts.emplace_back(item ? item : "");
    H5Dvlen_reclaim(memory, space, transfer, buffer.data());
    return true;
  }
  const std::size_t length = H5Tget_size(type);
  std::vector<char> buffer(size * length);
  const Handle memory(H5Tcopy(type), H5Tclose);
  if (read(static_cast<hid_t>(memory), static_cast<void*>(buffer.data())) < 0) return false;
  for (std::size_t i = 0; i < size; ++i) {
    std::string item(buffer.data() + i * length, length);
    item = item.substr(0, item.find('\0'));
    item.erase(item.find_last_not_of(' ') + 1);
    texts.push_back(std::move(item));
  }
  return true;
}

thread_local FailedCloses closes;

}  // namespace

const FailedCloses& failed_closes() { return closes; }

std::string with_system_reason(std::string_view what) {
  std::string reason;
  const auto find = [](unsigned, const H5E_error2_t* error, void* to) -> herr_t {
    static constexpr std::string_view before = "error message = '";
    const std::string_view text = error->desc ? error->desc : "";
    const std::size_t at = text.find(before), first = at + before.size();
    if (at == std::string_view::npos) return 0;
    *static_cast<std::string*>(to) = ": " + std::string(text.substr(first, text.find('\'', first) - first));
    return 1;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, find, &reason);
  return std::string(what) + reason;
}

Handle& Handle::operator=(Handle&& other) noexcept {
  std::swap(id_, other.id_);
  std::swap(close_, other.close_);
  return *this;
}

Handle::~Handle() {
  if (id_ < 0 || !close_ || close_(id_) >= 0) return;
  ++closes.count;
  closes.reason = with_system_reason(part("file_not_ended"));
}

Group::Group(Handle id, std::filesystem::path path, bool writing)
    : id_(std::move(id)), path_(std::move(path)), writing_(writing) {}

void Group::refuse(std::string_view what) const {
  fail(writing_ ? "BASE_3" : "BASE_2", {{"file", path_.string()}, {"reason", with_system_reason(what)}});
}

bool Group::has(std::string_view name) const {
  // every link on the way must exist: H5Lexists fails on a missing parent
  for (std::size_t at = name.find('/'); at != std::string_view::npos; at = name.find('/', at + 1))
    if (H5Lexists(id_, zero_ended(name.substr(0, at)).c_str(), H5P_DEFAULT) <= 0) return false;
  return H5Lexists(id_, zero_ended(name).c_str(), H5P_DEFAULT) > 0;
}

std::vector<std::string> Group::children() const {
  std::vector<std::string> names;
  const auto collect = [](hid_t, const char* name, const H5L_info_t*, void* list) -> herr_t {
    static_cast<std::vector<std::string>*>(list)->emplace_back(name);
    return 0;
  };
  if (H5Literate(id_, H5_INDEX_NAME, H5_ITER_INC, nullptr, collect, &names) < 0) refuse(part("hdf5_groups_unlisted"));
  return names;
}

bool Group::is_group(std::string_view name) const {
  H5O_info_t info;
  return has(name) && H5Oget_info_by_name(id_, zero_ended(name).c_str(), &info, H5P_DEFAULT) >= 0 &&
         info.type == H5O_TYPE_GROUP;
}

Group Group::open(std::string_view name) const {
  Handle group(is_group(name) ? H5Gopen2(id_, zero_ended(name).c_str(), H5P_DEFAULT) : H5I_INVALID_HID, H5Gclose);
  if (group < 0) refuse(about("hdf5_no_group", name));
  return Group(std::move(group), path_, writing_);
}

Group Group::create(std::string_view name) const {
  const Handle creation(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
  H5Pset_link_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
  const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(links, 1);
  Handle group(H5Gcreate2(id_, zero_ended(name).c_str(), links, creation, H5P_DEFAULT), H5Gclose);
  if (group < 0) refuse(about("hdf5_group_not_made", name));
  return Group(std::move(group), path_, writing_);
}

std::vector<hsize_t> Group::shape(std::string_view name) const {
  const Handle set(has(name) && !is_group(name) ? H5Dopen2(id_, zero_ended(name).c_str(), H5P_DEFAULT) : H5I_INVALID_HID,
                   H5Dclose);
  if (set < 0) refuse(about("hdf5_no_dataset", name));
  const Handle space(H5Dget_space(set), H5Sclose);
  std::vector<hsize_t> extents(static_cast<std::size_t>(std::max(0, H5Sget_simple_extent_ndims(space))));
  H5Sget_simple_extent_dims(space, extents.data(), nullptr);
  return extents;
}

template <class T>
std::vector<T> Group::read(std::string_view name, std::size_t (*capacity)(std::size_t)) const {
  const std::size_t size = count(shape(name));
  const Handle set(H5Dopen2(id_, zero_ended(name).c_str(), H5P_DEFAULT), H5Dclose);
  if (!fits(set, size, sizeof(T))) refuse(about("hdf5_dataset_large", name));
  std::vector<T> values;
  reserve_pages(values, size, capacity ? capacity(size) : size);
  values.resize(size);
  if (!values.empty() && H5Dread(set, native_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
    refuse(about("hdf5_dataset_unreadable", name));
  return values;
}

std::vector<std::string> Group::read_strings(std::string_view name) const {
  const std::size_t size = count(shape(name));
  const Handle set(H5Dopen2(id_, zero_ended(name).c_str(), H5P_DEFAULT), H5Dclose);
  const Handle type(H5Dget_type(set), H5Tclose);
  const Handle space(H5Dget_space(set), H5Sclose);
  std::vector<std::string> texts;
  if (size == 0) return texts;
  if (!fits(set, size, H5Tget_size(type))) refuse(about("hdf5_dataset_large", name));
  const Handle transfer = small_buffer();
  Budget budget{most_bytes(set)};
  H5Pset_vlen_mem_manager(transfer, Budget::take, &budget, Budget::give_back, nullptr);
  const auto read = [&](hid_t memory, void* buffer) { return H5Dread(set, memory, H5S_ALL, H5S_ALL, transfer, buffer); };
  if (!read_texts(type, space, size, transfer, read, texts)) refuse(about("hdf5_dataset_no_text", name));
  return texts;
}

Handle Group::new_dataset(std::string_view name, hid_t type, const std::vector<hsize_t>& shape) const {
  const Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose);
  const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(links, 1);
  return Handle(H5Dcreate2(id_, zero_ended(name).c_str(), type, space, links, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
}

template <class T>
void Group::write(std::string_view name, std::span<const T> values, std::vector<hsize_t> shape) const {
  if (shape.empty()) shape = {values.size()};
  const Handle set = new_dataset(name, native_type<T>(), shape);
  if (set < 0 || (!values.empty() && H5Dwrite(set, native_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0))
    refuse(about("hdf5_dataset_not_written", name));
}

namespace {

/// How many rows of `columns` columns of T fill two megabytes: more leave the cache, with less the page cache takes small
/// pieces of each column, which is dearer. Of no power of two, which would put all columns into the same places of the cache.
template <class T>
std::size_t rows_of_part(std::size_t columns) {
  return std::max<std::size_t>(1, 2'000'000 / (std::max<std::size_t>(1, columns) * sizeof(T)));
}

/// Select rows of every column in the space of a file.
void select_in_columns(hid_t file, std::size_t rows, std::size_t columns, std::size_t first, std::size_t size) {
  const hsize_t start = first, stride = rows, count = columns, block = size;
  if (size < rows) H5Sselect_hyperslab(file, H5S_SELECT_SET, &start, &stride, &count, &block);
}

/// The space of values in memory.
Handle space_of(std::size_t size) {
  const hsize_t all = size;
  return Handle(H5Screate_simple(1, &all, nullptr), H5Sclose);
}

}  // namespace

template <class T>
void Group::read_columns(std::string_view name, std::size_t columns,
                         const std::function<void(std::size_t, std::span<const T>)>& visit) const {
  const std::vector<hsize_t> extents = shape(name);
  const std::size_t rows = count(extents) / columns;
  const Handle set(H5Dopen2(id_, zero_ended(name).c_str(), H5P_DEFAULT), H5Dclose);
  if (!fits(set, count(extents), sizeof(T))) refuse(about("hdf5_dataset_large", name));
  const Handle space(H5Dget_space(set), H5Sclose);
  const Handle creation(H5Dget_create_plist(set), H5Pclose);
  const bool in_parts = extents.size() == 1 && H5Pget_layout(creation) == H5D_CONTIGUOUS;
  const std::size_t step = in_parts ? rows_of_part<T>(columns) : rows;
  std::vector<T> values;
  for (std::size_t first = 0; first < rows; first += step) {
    values.resize(std::min(step, rows - first) * columns);
    select_in_columns(space, rows, columns, first, values.size() / columns);
    const Handle memory = space_of(values.size());
    if (H5Dread(set, native_type<T>(), memory, space, H5P_DEFAULT, values.data()) < 0)
      refuse(about("hdf5_dataset_unreadable", name));
    visit(first, values);
  }
}

template <class T>
void Group::write_parts(std::string_view name, const std::vector<hsize_t>& shape, std::size_t rows, std::size_t width,
                        const std::function<void(hid_t, std::size_t, std::size_t)>& select,
                        const std::function<void(std::size_t, std::span<T>)>& fill) const {
  const Handle set = new_dataset(name, native_type<T>(), shape);
  const Handle space(H5Dget_space(set), H5Sclose);
  const std::size_t step = rows_of_part<T>(width);
  std::vector<T> values;
  bool written = set >= 0;
  for (std::size_t first = 0; written && width > 0 && first < rows; first += step) {
    const std::size_t size = std::min(step, rows - first);
    values.resize(size * width);
    fill(first, values);
    select(space, first, size);
    written = H5Dwrite(set, native_type<T>(), space_of(values.size()), space, H5P_DEFAULT, values.data()) >= 0;
  }
  if (!written) refuse(about("hdf5_dataset_not_written", name));
}

template <class T>
void Group::write_columns(std::string_view name, std::size_t rows, std::size_t columns,
                          const std::function<void(std::size_t, std::span<T>)>& fill) const {
  const auto select = [&](hid_t space, std::size_t first, std::size_t size) {
    select_in_columns(space, rows, columns, first, size);
  };
  write_parts<T>(name, {rows * columns}, rows, columns, select, fill);
}

template <class T>
void Group::write_rows(std::string_view name, const std::vector<hsize_t>& shape,
                       const std::function<void(std::size_t, std::span<T>)>& fill) const {
  const std::size_t rows = shape.front(), width = count(shape) / std::max<std::size_t>(1, rows);
  const auto select = [&](hid_t space, std::size_t first, std::size_t size) {
    std::vector<hsize_t> start(shape.size(), 0), some = shape;
    start.front() = first;
    some.front() = size;
    H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, some.data(), nullptr);
  };
  write_parts<T>(name, shape, rows, width, select, fill);
}

void Group::write_strings(std::string_view name, const std::vector<std::string>& values) const {
  std::vector<const char*> pointers;
  for (const std::string& value : values) pointers.push_back(value.c_str());
  const Handle type = string_type();
  const Handle set = new_dataset(name, type, {values.size()});
  if (set < 0 || (!values.empty() && H5Dwrite(set, type, H5S_ALL, H5S_ALL, small_buffer(), pointers.data()) < 0))
    refuse(about("hdf5_dataset_not_written", name));
}

bool Group::has_attribute(std::string_view name) const { return H5Aexists(id_, zero_ended(name).c_str()) > 0; }

namespace {

template <class T>
bool read_number(hid_t group, std::string_view name, T& value) {
  if (H5Aexists(group, zero_ended(name).c_str()) <= 0) return false;
  const Handle attribute(H5Aopen(group, zero_ended(name).c_str(), H5P_DEFAULT), H5Aclose);
  const Handle space(H5Aget_space(attribute), H5Sclose);
  return attribute >= 0 && H5Sget_simple_extent_npoints(space) == 1 && H5Aread(attribute, native_type<T>(), &value) >= 0;
}

Handle new_attribute(hid_t group, std::string_view name, hid_t type, hid_t space) {
  const std::string key(name);
  if (H5Aexists(group, key.c_str()) > 0) H5Adelete(group, key.c_str());
  return Handle(H5Acreate2(group, key.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
}

}  // namespace

std::int64_t Group::integer(std::string_view name) const {
  std::int64_t value = 0;
  if (!read_number(id_, name, value)) refuse(about("hdf5_no_integer", name));
  return value;
}

double Group::real(std::string_view name) const {
  double value = 0;
  if (!read_number(id_, name, value)) refuse(about("hdf5_no_real", name));
  return value;
}

std::vector<std::string> Group::attribute_strings(std::string_view name) const {
  std::vector<std::string> texts;
  if (has_attribute(name)) {
    const Handle attribute(H5Aopen(id_, zero_ended(name).c_str(), H5P_DEFAULT), H5Aclose);
    const Handle type(H5Aget_type(attribute), H5Tclose);
    const Handle space(H5Aget_space(attribute), H5Sclose);
    const auto size = static_cast<std::size_t>(H5Sget_simple_extent_npoints(space));
    const auto read = [&](hid_t memory, void* buffer) { return H5Aread(attribute, memory, buffer); };
    if (size > attribute_texts || !fits(attribute, size, H5Tget_size(type))) refuse(about("hdf5_attribute_large", name));
    if (size == 0 || read_texts(type, space, size, H5P_DEFAULT, read, texts)) return texts;
  }
  refuse(about("hdf5_no_text", name));
}

std::string Group::text(std::string_view name) const {
  const std::vector<std::string> texts = attribute_strings(name);
  if (texts.size() != 1) refuse(about("hdf5_not_one_text", name));
  return texts.front();
}

std::vector<std::string> Group::attributes() const {
  std::vector<std::string> names;
  const auto collect = [](hid_t, const char* name, const H5A_info_t*, void* list) -> herr_t {
    static_cast<std::vector<std::string>*>(list)->emplace_back(name);
    return 0;
  };
  if (H5Aiterate2(id_, H5_INDEX_NAME, H5_ITER_INC, nullptr, collect, &names) < 0) refuse(part("hdf5_attributes_unlisted"));
  return names;
}

bool Group::attribute_is_text(std::string_view name) const {
  if (!has_attribute(name)) return false;
  const Handle attribute(H5Aopen(id_, zero_ended(name).c_str(), H5P_DEFAULT), H5Aclose);
  const Handle type(H5Aget_type(attribute), H5Tclose);
  return H5Tget_class(type) == H5T_STRING;
}

template <class T>
requires std::is_arithmetic_v<T>
void Group::set(std::string_view name, T value) const {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle attribute = new_attribute(id_, name, native_type<T>(), space);
  if (attribute < 0 || H5Awrite(attribute, native_type<T>(), &value) < 0) refuse(about("attribute_not_written", name));
}

void Group::set(std::string_view name, std::string_view value) const {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle type = string_type();
  const Handle attribute = new_attribute(id_, name, type, space);
  const std::string text(value);
  const char* pointer = text.c_str();
  if (attribute < 0 || H5Awrite(attribute, type, &pointer) < 0) refuse(about("attribute_not_written", name));
}

void Group::set(std::string_view name, const std::vector<std::string>& values) const {
  std::vector<const char*> pointers;
  for (const std::string& value : values) pointers.push_back(value.c_str());
  const hsize_t size = values.size();
  const Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose);
  const Handle type = string_type();
  const Handle attribute = new_attribute(id_, name, type, space);
  if (attribute < 0 || (size > 0 && H5Awrite(attribute, type, pointers.data()) < 0))
    refuse(about("attribute_not_written", name));
}

#define LACON_HDF5_TYPE(T)                                                                                 \
  template std::vector<T> Group::read<T>(std::string_view, std::size_t(*)(std::size_t)) const;             \
  template void Group::write<T>(std::string_view, std::span<const T>, std::vector<hsize_t>) const;         \
  template void Group::read_columns<T>(std::string_view, std::size_t,                                      \
                                       const std::function<void(std::size_t, std::span<const T>)>&) const; \
  template void Group::write_columns<T>(std::string_view, std::size_t, std::size_t,                        \
                                        const std::function<void(std::size_t, std::span<T>)>&) const;      \
  template void Group::write_rows<T>(std::string_view, const std::vector<hsize_t>&,                        \
                                     const std::function<void(std::size_t, std::span<T>)>&) const;         \
  template void Group::set<T>(std::string_view, T) const;
LACON_HDF5_TYPE(double)
LACON_HDF5_TYPE(std::int64_t)
LACON_HDF5_TYPE(std::int32_t)
LACON_HDF5_TYPE(std::int8_t)
LACON_HDF5_TYPE(std::uint8_t)
#undef LACON_HDF5_TYPE

}  // namespace lacon::hdf5
