#include "lacon/structures/formats/vtu.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <limits>
#include <sstream>
#include <type_traits>

#include "lacon/catalog/messages.hpp"
#include "lacon/structures/formats/parts.hpp"
#include "lacon/structures/formats/text_file.hpp"

namespace lacon {
namespace {

namespace fs = std::filesystem;

std::string base64(const std::vector<unsigned char>& bytes) {
  static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t n = std::min<std::size_t>(3, bytes.size() - i);
    unsigned long word = 0;
    for (std::size_t k = 0; k < 3; ++k) word = word << 8 | (k < n ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += k <= n ? digits[word >> (18 - 6 * k) & 63u] : '=';
  }
  return text;
}

std::string escaped(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      default:  // XML has no place for control characters, not even as references
        safe += static_cast<unsigned char>(c) < 0x20 ? '?' : c;
    }
  }
  return safe;
}

template <class T>
constexpr std::string_view vtk_name() {
  if constexpr (std::is_same_v<T, double>) return "Float64";
  if constexpr (std::is_same_v<T, std::int64_t>) return "Int64";
  return "UInt8";
}

/// An array: its length in bytes and its values, both in base64. @param components their names; empty: one without a name
template <class T>
void write_array(std::ostream& out, std::string_view name, const std::vector<T>& values,
                 const std::vector<std::string>& components = {}, std::size_t width = 1) {
  const std::uint64_t length = values.size() * sizeof(T);
  std::vector<unsigned char> bytes(sizeof length + length);
  std::memcpy(bytes.data(), &length, sizeof length);
  if (length > 0) std::memcpy(bytes.data() + sizeof length, values.data(), length);
  out << fmt::format("        <DataArray type=\"{}\" Name=\"{}\" format=\"binary\"", vtk_name<T>(), escaped(name));
  width = std::max(width, components.size());
  if (width > 1) out << fmt::format(" NumberOfComponents=\"{}\"", width);
  for (std::size_t k = 0; k < components.size(); ++k) out << fmt::format(" ComponentName{}=\"{}\"", k, escaped(components[k]));
  out << '>' << base64(bytes) << "</DataArray>\n";
}

void write_groups(std::ostream& out, const char* keyword, const std::vector<Group>& groups, std::size_t n) {
  for (const Group& group : groups) {
    std::vector<std::uint8_t> mask(n, 0);
    for (const std::int32_t member : group.members) mask[static_cast<std::size_t>(member)] = 1;
    write_array(out, std::string(keyword) + " " + group.name, mask);
  }
}

/// The parts of a field with their names. Displacements are an array of their own, for viewers take three components for a
/// vector.
std::vector<std::pair<std::string, FieldPart>> arrays_of(const Field& field, const std::string& name) {
  std::vector<std::pair<std::string, FieldPart>> arrays;
  for (const FieldPart& part : parts_of(field)) {
    const auto moves = [&](std::size_t k) {
      const std::string& component = field.components[k];
      return component == "DX" || component == "DY" || component == "DZ";
    };
    FieldPart displacements{{}, part.rows}, others{{}, part.rows};
    for (const std::size_t k : part.components) (moves(k) ? displacements : others).components.push_back(k);
    std::string own = part_name(field, part, name);
    if (displacements.components.empty() || others.components.empty()) {
      arrays.emplace_back(std::move(own), part);
      continue;
    }
    arrays.emplace_back(own, std::move(displacements));
    for (const std::size_t k : others.components) own += "_" + field.components[k];
    arrays.emplace_back(std::move(own), std::move(others));
  }
  return arrays;
}

/// The arrays of one field over `n` nodes or cells.
void write_field(std::ostream& out, const NamedField& named, std::size_t n) {
  const Field& field = named.field;
  const bool mean = !field.offset.empty();
  for (const auto& [own_name, part] : arrays_of(field, named.name)) {
    std::vector<std::string> components;
    for (const std::size_t k : part.components) components.push_back(field.components[k]);
    const std::size_t n_own = components.size();
    if (components == std::vector<std::string>{"DX", "DY"}) components.push_back("DZ");
    const std::size_t width = components.size();
    std::vector<double> values(n * width, std::numeric_limits<double>::quiet_NaN());
    std::vector<std::uint8_t> exists(n, 0);
    for (std::size_t i = 0; i < field.support.size(); ++i) {
      const std::size_t first = mean ? static_cast<std::size_t>(field.offset[i]) : i;
      const std::size_t end = mean ? static_cast<std::size_t>(field.offset[i + 1]) : i + 1;
      if (first == end || !part.rows[first]) continue;
      const auto at = static_cast<std::size_t>(field.support[i]);
      exists[at] = 1;
      for (std::size_t k = 0; k < width; ++k) {
        double sum = 0;
        for (std::size_t r = first; k < n_own && r < end; ++r) sum += field.at(r, part.components[k]);
        values[at * width + k] = sum / static_cast<double>(end - first);
      }
    }
    const std::string name = own_name + (mean ? "_MEAN" : "");
    write_array(out, name, values, components);
    if (std::find(exists.begin(), exists.end(), 0) != exists.end()) write_array(out, name + "_EXISTS", exists);
  }
}

}  // namespace

std::string vtu_text(const Mesh& mesh, const std::vector<NamedField>& fields) {
  std::ostringstream out;
  out << "<?xml version=\"1.0\"?>\n"
         "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
         "  <UnstructuredGrid>\n";
  out << fmt::format("    <Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n", mesh.n_nodes(), mesh.n_cells());
  out << "      <Points>\n";
  write_array(out, "Points", mesh.coordinates, {}, 3);
  out << "      </Points>\n      <Cells>\n";
  std::vector<std::int64_t> connectivity(mesh.cells.values.size());
  std::vector<std::uint8_t> types;
  for (std::size_t c = 0; c < mesh.n_cells(); ++c) {
    const catalog::CellRow& row = mesh.row(c);
    types.push_back(static_cast<std::uint8_t>(row.vtk_type));
    for (std::size_t j = 0; j < mesh.cells[c].size(); ++j)
      connectivity[static_cast<std::size_t>(mesh.cells.offset[c]) + static_cast<std::size_t>(row.vtk_permutation[j])] =
          mesh.cells[c][j];
  }
  write_array(out, "connectivity", connectivity);
  write_array(out, "offsets", std::vector<std::int64_t>(mesh.cells.offset.begin() + 1, mesh.cells.offset.end()));
  write_array(out, "types", types);
  out << "      </Cells>\n      <PointData>\n";
  for (const NamedField& named : fields)
    if (named.field.location == Location::nodes) write_field(out, named, mesh.n_nodes());
  write_groups(out, "GROUP_NO", mesh.node_groups, mesh.n_nodes());
  out << "      </PointData>\n      <CellData>\n";
  for (const NamedField& named : fields)
    if (named.field.location != Location::nodes) write_field(out, named, mesh.n_cells());
  write_groups(out, "GROUP_MA", mesh.cell_groups, mesh.n_cells());
  out << "      </CellData>\n    </Piece>\n  </UnstructuredGrid>\n</VTKFile>\n";
  return out.str();
}

fs::path write_vtu(const fs::path& file, bool append, const std::vector<VtuStep>& steps) {
  static constexpr std::string_view head =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n  <Collection>\n";
  static constexpr std::string_view tail = "  </Collection>\n</VTKFile>\n";
  const fs::path stem = file.parent_path() / file.stem();
  const fs::path collection = stem.string() + ".pvd";
  std::string list(head);
  std::error_code error;
  if (append && fs::exists(collection, error)) {
    list = read_text(collection);
    if (!list.starts_with(head) || !list.ends_with(tail)) fail("VTU_1", {{"file", collection.string()}});
    list.resize(list.size() - tail.size());
  }
  auto number = static_cast<std::size_t>(std::count(list.begin(), list.end(), '\n')) - 3;  // three lines of head
  TextFiles files;
  for (const VtuStep& step : steps) {
    const fs::path own = fmt::format("{}_{:04}.vtu", stem.string(), ++number);
    files.write(own, step.text);
    // of data sets of one instant and one part ParaView shows one alone
    const std::string instant = fmt::format("timestep=\"{:.17g}\"", step.instant);
    int part = 0;
    for (std::size_t at = list.find(instant); at != std::string::npos; at = list.find(instant, at + 1)) ++part;
    list += fmt::format("    <DataSet {} group=\"\" part=\"{}\" name=\"{}\" file=\"{}\"/>\n", instant, part, escaped(step.name),
                        escaped(own.filename().string()));
  }
  files.write(collection, list + std::string(tail));
  files.commit();
  return collection;
}

}  // namespace lacon
