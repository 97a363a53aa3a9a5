#pragma once
// Nodes and cells that an occurrence of a load's factor keyword names, and the values it gives them.
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "lacon/elements/registry.hpp"
#include "lacon/structures/base.hpp"

namespace lacon {

/// What loads are made on.
struct LoadScene {
  const Mesh& mesh;
  const Model& model;
  Registry& registry;
  const Base& base;
  std::vector<unsigned> dofs;      ///< of each node: bit i for unknown i of unknowns()
  std::vector<char> is_of_a_body;  ///< whether a node belongs to an element that resists

  /// The element of a cell, or nullptr.
  const catalog::ElementRow* element(std::int32_t cell) const;
  /// Throws CHARGE_2 where the node has no element, CHARGE_3 where it lacks the unknown.
  void check_dof(std::int32_t node, std::string_view component, const std::string& source) const;
  /// Every unknown that a node of the model has, by name.
  std::string names_of(unsigned dofs) const;
};

LoadScene make_scene(const Mesh& mesh, const Model& model, Registry& registry, const Base& base);

/// Names of what nodes may have for unknowns, in the order of the quantity: DX, DY, DZ first.
std::span<const std::string_view> unknowns();

/// Nodes, or cells, with the keyword that names them.
struct NamedPlaces {
  std::string source;
  std::vector<std::int32_t> members;
};

/// TOUT, GROUP_MA, GROUP_NO and NOEUD, whose names may have a suffix (GROUP_NO_1), without the nodes that are left out. Throws
/// MESH_1, MESH_2, CHARGE_1.
std::vector<NamedPlaces> named_nodes(const LoadScene& scene, const Keywords& factor, const std::string& suffix = "");

/// TOUT (or no place at all) and GROUP_MA. @param fits whether a cell of the model can carry the load, for TOUT
std::vector<NamedPlaces> named_cells(const LoadScene& scene, const Keywords& factor,
                                     const std::function<bool(std::int32_t)>& fits);

std::string show(const LoadScene& scene, const LoadValue& value);

/// What a load has been given so far: each component of a node or a cell has one value. Of two occurrences of one factor
/// keyword the later one wins, as in code_aster; one occurrence and two factor keywords may not give different values.
class GivenTerms {
 public:
  /// @param conflict message for two values: CHARGE_4 or CHARGE_5
  GivenTerms(const LoadScene& scene, std::string_view conflict, std::vector<LoadTerm>& terms)
      : scene_(scene), conflict_(conflict), terms_(terms) {}
  ~GivenTerms();  ///< CHARGE_20: what later occurrences have replaced
  GivenTerms(const GivenTerms&) = delete;
  GivenTerms& operator=(const GivenTerms&) = delete;
  /// Enter a value. @param place "node N5"
  void add(std::int32_t number, const std::string& place, const std::string& component, const LoadValue& value,
           const std::string& source);

 private:
  struct Given {
    std::size_t term;  ///< of `terms_`
    std::string source;
  };
  const LoadScene& scene_;
  std::string_view conflict_;
  std::vector<LoadTerm>& terms_;
  std::map<std::pair<std::int32_t, std::string>, Given> given_;
  std::int64_t replaced_ = 0;
  std::string first_replaced_, last_source_;  ///< "DX of the node N5", and the keyword that replaced it
};

}  // namespace lacon
