#pragma once
// The plug-ins that were found, their kernels and the catalogue rows that they bring.
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lacon/catalog/elements.hpp"
#include "lacon/elements/plugin.h"

namespace lacon {

/// Kernels by name and element rows by name. Built-in rows come from the catalogue, others from the plugin.toml of plug-ins.
class Registry {
 public:
  /// Looks in `folders`, then LACON_PLUGIN_PATH, then the folder installed beside the executable. A library is opened when one
  /// of its kernels is first asked for. Throws PLUGIN_1 (with the file) for a bad plugin.toml, PLUGIN_2 for a row that names an
  /// unknown cell.
  explicit Registry(std::span<const std::filesystem::path> folders = {});
  ~Registry();
  Registry(const Registry&) = delete;
  Registry& operator=(const Registry&) = delete;

  /// The row of this name ("D_PLAN/TRIA3"), or nullptr.
  const catalog::ElementRow* find_element(std::string_view name) const;
  /// The row of a cell under a modelisation, or nullptr.
  const catalog::ElementRow* find_element(std::string_view modelisation, CellType cell) const;
  std::vector<std::string> modelisations() const;

  /// The kernel that serves an option of an element; throws PLUGIN_1 or PLUGIN_3 (no such plug-in, kernel or option; wrong ABI).
  const lacon_kernel& kernel(const catalog::ElementRow& element, std::string_view option);
  bool has_kernel(const catalog::ElementRow& element, std::string_view option) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace lacon
