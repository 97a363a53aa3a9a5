#pragma once
// A base: the folder of concepts that operators read and write.
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "lacon/structures/concepts.hpp"
#include "lacon/structures/field.hpp"
#include "lacon/structures/mesh.hpp"
#include "lacon/structures/order.hpp"
#include "lacon/structures/table.hpp"

namespace lacon {

/// Reads concepts by id, and writes the result of one order. Readers throw BASE_1 (no such concept), BASE_2 (unreadable) and
/// BASE_4 (another type). A writer leaves nothing half-written: it writes `<file>.partial` and renames.
class Base {
 public:
  explicit Base(const Order& order) : folder_(order.base), order_(&order) {}

  const std::filesystem::path& folder() const { return folder_; }
  std::filesystem::path file(std::string_view id) const;  ///< of a concept; of a result, its index
  std::string type(std::string_view id) const;            ///< "mesh"
  std::string label(std::string_view id) const;

  Mesh mesh(std::string_view id) const;
  Model model(std::string_view id) const;
  Material material(std::string_view id) const;
  MaterialField material_field(std::string_view id) const;
  Load load(std::string_view id) const;
  Contact contact(std::string_view id) const;
  ElementCharacteristics element_characteristics(std::string_view id) const;
  Function function(std::string_view id) const;
  Formula formula(std::string_view id) const;
  std::vector<double> list_of_reals(std::string_view id) const;
  TimeSteps time_steps(std::string_view id) const;  ///< of a time_steps or a list_of_reals
  Table table(std::string_view id) const;
  Field field(std::string_view id) const;       ///< a concept of its own
  Field field_head(std::string_view id) const;  ///< the same without its values: read_field_head()
  Result result(std::string_view id) const;

  /// The field of a result at an order; throws RESULT_1 where it has none.
  Field field(const Result& result, std::string_view name, std::int64_t order) const;

  /// Store the concept that the order asks for, under the order's result id.
  void store(const Mesh& mesh) const;
  void store(const Model& model) const;
  void store(const MaterialField& field) const;
  void store(const Load& load) const;
  void store(const Contact& contact) const;
  void store(const ElementCharacteristics& characteristics) const;
  void store(const Table& table) const;
  void store(const Field& field) const;
  /// The index of a result, behind the fields that it names. It may be stored again as the result grows: who reads it finds the
  /// one or the other.
  void store(const Result& result) const;
  /// The version that an index has that is stored now.
  std::int64_t next_version() const;

  /// The folder of the order's result.
  std::filesystem::path result_folder() const { return folder_ / order_->result_id; }
  /// Store a field file of the order's result and enter it in the index, which store(result) writes.
  void add_field(Result& result, FieldRows rows) const;
  /// Remove the field files of a result that will not be stored.
  void discard(const Result& result) const;

 private:
  std::filesystem::path folder_;
  const Order* order_;
};

}  // namespace lacon
