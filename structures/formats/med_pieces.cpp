#include "lacon/structures/formats/med_pieces.hpp"

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"

namespace lacon::med {

void set_int(const hdf5::Group& group, const char* name, std::int64_t value) {
  group.set(name, static_cast<std::int32_t>(value));
}

void set_text(const hdf5::Group& group, const char* name, std::string_view value) {
  const hdf5::Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, value.size() + 1);
  const hdf5::Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  if (group.has_attribute(name)) H5Adelete(group.id(), name);
  const hdf5::Handle attribute(H5Acreate2(group.id(), name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  const std::string text(value);
  if (attribute < 0 || H5Awrite(attribute, type, text.c_str()) < 0)
    fail("BASE_3", {{"file", group.path().string()}, {"reason", part("attribute_not_written", {{"name", name}})}});
}

std::string in_columns(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) {
    std::string column = name.substr(0, 16);
    column.resize(16, ' ');
    text += column;
  }
  return text;
}

void check_name(const hdf5::Group& root, const std::string& what, std::string_view name, std::size_t length, bool is_link) {
  if (name.empty() || name.size() > length || (is_link && name.find('/') != std::string_view::npos))
    fail("MED_12",
         {{"file", root.path().string()}, {"what", what}, {"name", std::string(name)}, {"length", std::to_string(length)}});
}

std::map<CellType, CellList> by_type(const Mesh& mesh) {
  std::map<CellType, CellList> cells;
  for_each_run(mesh, [&](const catalog::CellRow& row, std::size_t first, std::size_t size) {
    CellList& list = cells[row.type];
    list.runs.push_back({static_cast<std::int32_t>(first), static_cast<std::int32_t>(size)});
    list.size += size;
  });
  return cells;
}

}  // namespace lacon::med
