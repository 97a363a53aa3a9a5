#pragma once
// A folder of its own for each test, meshes to write, and a way to spoil files.
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <string>

#include "lacon/catalog/messages.hpp"
#include "lacon/structures/formats/med.hpp"
#include "lacon/structures/hdf5.hpp"

namespace lacon::test {

class InFolder : public testing::Test {
 protected:
  void SetUp() override {
    const testing::TestInfo* info = testing::UnitTest::GetInstance()->current_test_info();
    std::string name = std::string(info->test_suite_name()) + "." + info->name();
    for (char& c : name)
      if (c == '/') c = '_';
    folder = std::filesystem::path(testing::TempDir()) / ("lacon_" + name);
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
  }
  void TearDown() override { std::filesystem::remove_all(folder); }

  std::filesystem::path folder;
};

/// One cell of each of these types, apart from each other, with the catalogue's reference nodes.
inline Mesh mesh_of(const std::vector<CellType>& types, int dimension = 3) {
  Mesh mesh;
  mesh.name = "MESH";
  mesh.dimension = dimension;
  std::vector<std::int32_t> nodes;
  for (std::size_t c = 0; c < types.size(); ++c) {
    const catalog::CellRow& row = catalog::cell(types[c]);
    const auto d = static_cast<std::size_t>(row.dimension);
    nodes.clear();
    for (std::size_t j = 0; j < static_cast<std::size_t>(row.n_nodes); ++j) {
      nodes.push_back(static_cast<std::int32_t>(mesh.n_nodes()));
      double x[3] = {0, 0, 0};
      for (std::size_t k = 0; k < d; ++k) x[k] = row.nodes[j * d + k];
      x[0] += 3.0 * static_cast<double>(c);
      if (dimension == 3) x[2] += 0.125;
      mesh.coordinates.insert(mesh.coordinates.end(), x, x + 3);
    }
    mesh.add_cell(types[c], nodes);
  }
  return mesh;
}

inline Mesh mesh_of_all_types() {
  std::vector<CellType> types;
  for (const catalog::CellRow& row : catalog::cells()) types.push_back(row.type);
  return mesh_of(types);
}

inline void write_mesh(const std::filesystem::path& file, const Mesh& mesh, const std::string& name) {
  write_med(file, true, [&](MedFile& med) { med.add_mesh(mesh, name); });
}

/// Change a file in place.
inline void edit(const std::filesystem::path& file, const std::function<void(const hdf5::Group&)>& change) {
  hdf5::write_whole(file, change, file);
}

inline void remove_link(const hdf5::Group& group, const std::string& name) {
  ASSERT_GE(H5Ldelete(group.id(), name.c_str(), H5P_DEFAULT), 0) << name;
}

inline void set_dataset_integer(const hdf5::Group& group, const std::string& dataset, const char* attribute,
                                std::int32_t value) {
  const hdf5::Handle set(H5Dopen2(group.id(), dataset.c_str(), H5P_DEFAULT), H5Dclose);
  if (H5Aexists(set, attribute) > 0) H5Adelete(set, attribute);
  const hdf5::Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const hdf5::Handle id(H5Acreate2(set, attribute, H5T_NATIVE_INT32, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  ASSERT_GE(H5Awrite(id, H5T_NATIVE_INT32, &value), 0);
}

/// A dataset of the same name, attribute NBR and place with other values.
template <class T>
void replace(const hdf5::Group& group, const std::string& dataset, const std::vector<T>& values, std::int32_t count) {
  remove_link(group, dataset);
  group.write(dataset, values);
  set_dataset_integer(group, dataset, "NBR", count);
}

/// The message that `work` throws.
template <class Work>
Message message_of(Work work) {
  try {
    work();
  } catch (const Error& error) {
    return error.message();
  }
  return {' ', "no error", "", ""};
}

}  // namespace lacon::test
