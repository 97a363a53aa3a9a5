#pragma once
// The plug-ins that were found, their kernels and the catalogue rows that they bring.
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lacon/catalog/behaviours.hpp"
#include "lacon/catalog/elements.hpp"
#include "lacon/elements/plugin.h"

namespace lacon {

/// Kernels and rows by name. Built-in rows come from the catalogue, others from the plugin.toml of plug-ins.
/// Not for several threads at once; the kernels that it hands out are, and live as long as the registry.
class Registry {
 public:
  /// Looks in `folders`, then LACON_PLUGIN_PATH (separated by colons), then the folder installed beside the executable,
  /// <executable>/../../lib/lacon/plugins. Each of them is a plug-in, or holds plug-ins. A library is opened when one of its
  /// kernels is first asked for. Throws PLUGIN_1 (with the file) for a folder without plug-in, a bad plugin.toml, or a name
  /// that is there twice, PLUGIN_2 for a row that names a cell, rule, component, behaviour or plug-in that does not exist, or
  /// is there already.
  explicit Registry(std::span<const std::filesystem::path> folders = {});
  ~Registry();
  Registry(const Registry&) = delete;
  Registry& operator=(const Registry&) = delete;

  /// The row of this name ("D_PLAN/TRIA3"), or nullptr.
  const catalog::ElementRow* find_element(std::string_view name) const;
  /// The row of a cell under a modelisation, or nullptr.
  const catalog::ElementRow* find_element(std::string_view modelisation, CellType cell) const;
  std::vector<std::string> modelisations() const;
  /// The row of a RELATION or DEFORMATION of COMPORTEMENT, or nullptr.
  const catalog::RelationRow* find_relation(std::string_view name) const;
  const catalog::DeformationRow* find_deformation(std::string_view name) const;

  /// The kernel that serves an option of an element. Throws PLUGIN_3 where no row, plug-in or kernel serves it, or the kernel
  /// is of another kind than the caller's or works on unknowns that the element lacks; PLUGIN_1 for a library that cannot be
  /// opened or was built for another ABI.
  const lacon_kernel& kernel(const catalog::ElementRow& element, std::string_view option, lacon_kernel_kind kind);
  bool has_kernel(const catalog::ElementRow& element, std::string_view option) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The unknowns of each node that a kernel works on for an element: those that it names, or the displacements.
std::vector<std::string_view> unknowns_of(const catalog::ElementRow& element, const lacon_kernel& kernel);

/// How many names there are in a list of plugin.h, which ends with NULL and may be NULL itself.
int n_names(const char* const* names);

}  // namespace lacon
