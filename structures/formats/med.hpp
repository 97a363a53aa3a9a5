#pragma once
// Meshes and fields in MED files (HDF5), read and written without libmed. README.md beside says what is where.
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "lacon/structures/field.hpp"
#include "lacon/structures/mesh.hpp"

namespace lacon {

namespace hdf5 {
class Group;
}

/// Names of the meshes of a MED file, sorted. Throws MED_1 (no such file), MED_2 (not MED), MED_3 (version).
std::vector<std::string> med_mesh_names(const std::filesystem::path& file);

/// Read a mesh of a MED file of version 2.1 to 4.1: the one of this name, or the first where `name` is empty.
/// Cells are numbered by type in the order of CellType, in file order within a type; nodes in file order. A group is the union
/// of the families that name it. A mesh whose file says 3 coordinates, but which has no 3D cell and z = 0 everywhere, is 2D.
/// Throws MED_1 to MED_10.
Mesh read_med_mesh(const std::filesystem::path& file, std::string_view name = {});

/// The integration points of the cells of one type: MED wants to know them with a field at integration points.
struct MedPoints {
  std::vector<double> points;   ///< (n, dimension), reference coordinates as in catalog/cells.toml
  std::vector<double> weights;  ///< (n)
};

/// Finds the integration points of a field on the cells of a type, given their number.
using MedRule = std::function<MedPoints(CellType, int n_points)>;

/// A MED 4.1 file while it is being written; write_med() hands it out.
class MedFile {
 public:
  explicit MedFile(const hdf5::Group& root);

  /// Put a mesh into the file, or find it there: the same nodes and cells under the same name are written once, and get the
  /// groups of `mesh`. Where another mesh has the name, the mesh is called `<name>_2`, and so on. Throws MED_12 (name too
  /// long).
  /// @return the name it has in the file
  std::string add_mesh(const Mesh& mesh, std::string_view name);

  /// Put one step of a field into the file; what the field has at this step on the same nodes or cells is replaced.
  /// Components that exist on the same rows make one MED field, `name`; those that exist elsewhere make further ones,
  /// `<name>_<component>`. A field on a part of the mesh gets a profile. Where a field of another mesh, with other components
  /// or of another owner has the name, the field is called `<name>_2`, and so on; FORMAT_2 tells of other owners.
  /// @param mesh_name as add_mesh() returned it
  /// @param step (NDT and NOR), negative for none @param rule only for gauss_points; without it these cannot be written
  /// @param owner what steps of one field have in common; the file keeps it
  /// @return the names in the file
  std::vector<std::string> add_field(const Mesh& mesh, std::string_view mesh_name, const Field& field, std::string_view name,
                                     std::int64_t step, const MedRule& rule = {}, std::string_view owner = {});

 private:
  std::string field_group(const std::string& name, std::string_view mesh_name, const std::vector<std::string>& components,
                          std::string_view owner);
  hdf5::Group entity(const hdf5::Group& step, const std::string& name, const std::string& profile,
                     const std::string& localisation);
  std::string profile(const std::string& type, const std::vector<std::int32_t>& numbers);
  std::string localisation(const catalog::CellRow& row, const MedPoints& points);

  const hdf5::Group& root_;
  std::map<std::vector<std::int32_t>, std::string> profiles_;
};

/// Write a MED file, with what `write` puts into it; with `append`, a file that is there keeps what it holds, otherwise it is
/// replaced. It changes wholly or not at all.
/// Throws BASE_3 (not writable), and on appending MED_1, MED_2 (what is there is not MED), MED_13 (not version 4.1).
void write_med(const std::filesystem::path& file, bool append, const std::function<void(MedFile&)>& write);

}  // namespace lacon
