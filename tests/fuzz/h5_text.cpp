#include "h5_text.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <optional>
#include <vector>

#include "lacon/structures/hdf5.hpp"

namespace lacon::fuzz {
namespace {

using hdf5::Handle;

constexpr std::size_t most_values = 1 << 16;

/// The next word of a line, which is taken off.
std::string_view word(std::string_view& line) {
  line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
  const std::size_t end = std::min(line.find(' '), line.size());
  const std::string_view found = line.substr(0, end);
  line.remove_prefix(end);
  return found;
}

std::string decoded(std::string_view text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned code = 0;
    if (text[i] != '%') {
      plain += text[i];
    } else if (i + 2 < text.size() &&
               std::from_chars(text.data() + i + 1, text.data() + i + 3, code, 16).ptr == text.data() + i + 3) {
      plain += static_cast<char>(code);
      i += 2;
    }
  }
  return plain;
}

struct Line {
  std::string path, attribute, type;
  std::optional<std::vector<hsize_t>> shape;  ///< nothing: a scalar
  bool chunked = false;
  std::vector<std::string> values;

  std::size_t count() const {
    std::size_t n = 1;
    if (shape)
      for (const hsize_t extent : *shape)
        n = std::min<std::size_t>(n * std::min<hsize_t>(extent, most_values + 1), most_values + 1);
    return n;
  }
};

Line read_line(std::string_view text) {
  Line line;
  const std::string_view place = word(text);
  const std::size_t at = place.find('@');
  line.path = decoded(place.substr(0, at));
  if (at != std::string_view::npos) line.attribute = decoded(place.substr(at + 1));
  line.type = word(text);
  std::string_view rest = text;
  if (const std::string_view shape = word(rest); shape.starts_with('[')) {
    line.shape.emplace();
    const char* const end = shape.data() + shape.size();
    for (const char* p = shape.data() + 1; p < end;) {
      std::uint64_t extent = 0;
      const auto [stop, error] = std::from_chars(p, end, extent);
      if (error == std::errc() && line.shape->size() < 4) line.shape->push_back(extent);
      p = stop + 1;
    }
    line.chunked = shape.ends_with('c');
    text = rest;
  }
  for (std::string_view value = word(text); !value.empty(); value = word(text)) line.values.push_back(decoded(value));
  return line;
}

template <class T>
std::vector<T> numbers(const Line& line) {
  std::vector<T> values(line.count());
  for (std::size_t i = 0; i < std::min(values.size(), line.values.size()); ++i)
    std::from_chars(line.values[i].data(), line.values[i].data() + line.values[i].size(), values[i]);
  return values;
}

/// A dataset or an attribute, and what is written into it.
class Writer {
 public:
  Writer(hid_t root, const Line& line) : root_(root), line_(line) {}

  void write() {
    if (line_.type == "i1") write_numbers<std::int8_t>();
    if (line_.type == "u1") write_numbers<std::uint8_t>();
    if (line_.type == "i4") write_numbers<std::int32_t>();
    if (line_.type == "i8") write_numbers<std::int64_t>();
    if (line_.type == "f8") write_numbers<double>();
    if (line_.type == "s") write_texts();
    if (line_.type.starts_with('t')) write_fixed_texts();
  }

 private:
  bool has_values() const { return !line_.values.empty() && line_.count() <= most_values; }

  template <class T>
  void write_numbers() {
    const std::vector<T> values = has_values() ? numbers<T>(line_) : std::vector<T>{};
    put(hdf5::native_type<T>(), values.data());
  }

  void write_texts() {
    const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(type, H5T_VARIABLE);
    std::vector<const char*> pointers(has_values() ? line_.count() : 0, "");
    for (std::size_t i = 0; i < std::min(pointers.size(), line_.values.size()); ++i) pointers[i] = line_.values[i].c_str();
    put(type, pointers.data());
  }

  void write_fixed_texts() {
    std::size_t width = 0;
    std::from_chars(line_.type.data() + 1, line_.type.data() + line_.type.size(), width);
    width = std::min<std::size_t>(width, 256);
    const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
    if (width == 0 || H5Tset_size(type, width) < 0) return;
    std::string bytes(has_values() ? width * line_.count() : 0, ' ');
    for (std::size_t i = 0; i < line_.values.size() && (i + 1) * width <= bytes.size(); ++i)
      bytes.replace(i * width, std::min(width, line_.values[i].size()), line_.values[i].substr(0, width));
    put(type, bytes.data());
  }

  void put(hid_t type, const void* values) {
    const Handle space(line_.shape ? H5Screate_simple(static_cast<int>(line_.shape->size()), line_.shape->data(), nullptr)
                                   : H5Screate(H5S_SCALAR),
                       H5Sclose);
    if (space < 0) return;
    if (!line_.attribute.empty()) {
      const Handle object(H5Oopen(root_, line_.path.c_str(), H5P_DEFAULT), H5Oclose);
      const Handle made(H5Acreate2(object, line_.attribute.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
      if (made >= 0 && has_values()) H5Awrite(made, type, values);
      return;
    }
    const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
    H5Pset_create_intermediate_group(links, 1);
    const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    if (line_.chunked && line_.shape && !line_.shape->empty()) {
      std::vector<hsize_t> chunk = *line_.shape;
      for (hsize_t& extent : chunk) extent = std::clamp<hsize_t>(extent, 1, 4);
      H5Pset_chunk(creation, static_cast<int>(chunk.size()), chunk.data());
    }
    const Handle made(H5Dcreate2(root_, line_.path.c_str(), type, space, links, creation, H5P_DEFAULT), H5Dclose);
    if (made >= 0 && has_values()) H5Dwrite(made, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
  }

  hid_t root_;
  const Line& line_;
};

}  // namespace

std::string h5_from_text(std::string_view text) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fapl_core(access, 1 << 14, false);
  const Handle file(H5Fcreate("fuzz.h5", H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const Line line = read_line(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.path.empty()) continue;
    if (line.type == "group") {
      const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
      H5Pset_create_intermediate_group(links, 1);
      const Handle made(H5Gcreate2(file, line.path.c_str(), links, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
    } else {
      Writer(file, line).write();
    }
  }
  H5Fflush(file, H5F_SCOPE_LOCAL);
  std::string image(static_cast<std::size_t>(std::max<ssize_t>(0, H5Fget_file_image(file, nullptr, 0))), '\0');
  H5Fget_file_image(file, image.data(), image.size());
  return image;
}

}  // namespace lacon::fuzz
