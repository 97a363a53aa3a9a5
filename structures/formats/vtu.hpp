#pragma once
// Meshes and fields for ParaView: .vtu (one mesh at one instant) and .pvd (the list of them). README.md beside says what is
// where.
#include <filesystem>
#include <string>
#include <vector>

#include "lacon/structures/field.hpp"
#include "lacon/structures/mesh.hpp"

namespace lacon {

struct NamedField {
  std::string name;  ///< in the file
  Field field;
};

/// A .vtu as text: points, cells in the mesh's order, groups as arrays of 0 and 1 ("GROUP_MA Body", "GROUP_NO Left"), fields.
/// A field is NaN where it does not live, and an array `<name>_EXISTS` of 0 and 1 then says where it does. Components that live
/// on different rows make arrays of their own (parts.hpp). DX, DY become a vector with DZ = 0. Values at integration points and
/// at the nodes of cells, for which VTU has no place, become their mean in the cell, `<name>_MEAN`.
std::string vtu_text(const Mesh& mesh, const std::vector<NamedField>& fields);

/// One entry of a collection.
struct VtuStep {
  std::string name;  ///< of the mesh or result
  double instant = 0;
  std::string text;  ///< as vtu_text() gives it
};

/// Write steps and the collection that lists them: `<stem>.pvd` and `<stem>_0001.vtu`, ... where `file` is `<stem>.<anything>`.
/// With `append`, a collection that is there goes on. The new files take their names when all of them are written, the
/// collection last. Throws BASE_3 (not writable), VTU_1 (what is there is no collection).
/// @return the collection
std::filesystem::path write_vtu(const std::filesystem::path& file, bool append, const std::vector<VtuStep>& steps);

}  // namespace lacon
