#pragma once
// plugin.toml: the rows that a plug-in brings. The file may be wrong in any way.
#include <deque>
#include <filesystem>
#include <string>
#include <vector>

#include "lacon/catalog/behaviours.hpp"
#include "lacon/catalog/elements.hpp"

namespace lacon {

/// An element row, with what it refers to.
struct OwnedElement {
  std::vector<std::string_view> dofs, stress;
  std::vector<catalog::KernelRow> kernels;
  catalog::ElementRow row{};
  std::string file;
};

/// The kernel of the bodies of one modelisation under one behaviour.
struct LawRow {
  std::string_view modelisation;
  std::string_view option;  ///< "VMIS_ISOT_LINE/PETIT"
  std::string_view kernel;  ///< "plug-in/kernel"
  std::string file;
};

/// Rows of all plug-ins. They stay where they are, and so do the texts.
struct PluginRows {
  std::deque<OwnedElement> elements;
  std::deque<catalog::RelationRow> relations;
  std::deque<catalog::DeformationRow> deformations;
  std::deque<LawRow> laws;

  std::string_view keep(std::string text) { return texts.emplace_back(std::move(text)); }
  std::deque<std::string> texts;
};

/// Add the rows of a file. @param plugins names of those that were found
/// Throws PLUGIN_1 for a file that is no plugin.toml, PLUGIN_2 for a row that is wrong by itself.
void read_plugin_rows(const std::filesystem::path& file, const std::vector<std::string>& plugins, PluginRows& rows);

/// Throw PLUGIN_1.
[[noreturn]] void bad_plugin(const std::filesystem::path& file, const std::string& reason);

}  // namespace lacon
