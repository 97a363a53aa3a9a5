#pragma once
// Where fields live: TYPE_CHAM, the rows of a field on a mesh or a model, and fields taken from one such place to another.
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lacon/operators/fields/cell_points.hpp"
#include "lacon/structures/field.hpp"

namespace lacon {

/// TYPE_CHAM, "NOEU_DEPL_R": where a field lives and its quantity. CART (one value a cell, whatever the model) is stored as
/// ELEM.
struct FieldType {
  std::string text;
  Location location;
  std::string quantity;

  bool of_functions() const { return quantity.ends_with("_F"); }
};

/// Throws CREACHAMP_1 for a text that is no such type.
FieldType field_type(const std::string& text);

/// Refuse a component that the quantity does not have: CREACHAMP_2. A quantity X_F has those of X_R, VARI_R any V1, V2 ...
void check_component(const FieldType& type, const std::string& component, const std::string& keyword);

/// A mesh, and where ELGA and ELEM are wanted a model on it.
class Ground {
 public:
  explicit Ground(const Mesh& mesh) : mesh_(mesh) {}
  Ground(const Mesh& mesh, ModelPoints& points) : mesh_(mesh), points_(&points) {}

  const Mesh& mesh() const { return mesh_; }
  ModelPoints* points() const { return points_; }
  /// Every node (of the model's cells where there is a model), every cell (of the model) with its rows.
  /// @return support and offset of a field at `location`. Throws CREACHAMP_3 for ELGA without model.
  std::pair<std::vector<std::int32_t>, std::vector<std::int64_t>> rows(Location location) const;

 private:
  const Mesh& mesh_;
  ModelPoints* points_ = nullptr;
};

/// A field on all of `ground` with these components, 0 and nowhere present.
Field empty_field(const Ground& ground, const FieldType& type, std::vector<std::string> components);

/// What is not there becomes 0, which exists.
void zero_where_absent(Field& field);

/// Without rows and components that are nowhere present.
Field without_empty_rows(const Field& field);

/// The place of each row's owner (node or cell number) in the field's support, -1 where it has none. @param count nodes or
/// cells of the mesh
std::vector<std::int64_t> places(const Field& field, std::size_t count);

/// What a nodal field has at a point.
struct PointValue {
  double value = 0;
  Field::Presence presence = Field::absent;  ///< a stand-in or a marker where that of a node has a part in it
};
/// The value of a component at a point of a cell. Nodes of no weight, but for round-off, have no part in it: the point is on a
/// node or a side without them; where one that has a part lacks the component it does not exist.
/// @param row_of_node of the field: places() @param weights of `nodes`
PointValue value_at(const Field& field, const std::vector<std::int64_t>& row_of_node, std::span<const std::int32_t> nodes,
                    std::span<const double> weights, std::size_t component);

/// The field taken to another location, on all of `ground`. To points: by the cell's shape functions from its nodes; from
/// points to nodes of cells: extrapolation.hpp; to nodes: the mean over the cells; to cells: the mean of the cell's nodes or
/// points; a cell's value is that of all its points and nodes. In a cell whose nodes lack a component it does not exist, unless
/// `zero_elsewhere`: then what is missing is 0, and it exists on all of the ground.
Field moved_to(const Ground& ground, const Field& field, const FieldType& type, bool zero_elsewhere);

}  // namespace lacon
