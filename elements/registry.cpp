#include "lacon/elements/registry.hpp"

#include <dlfcn.h>

#include <toml++/toml.h>
#include <algorithm>
#include <cstdlib>
#include <deque>
#include <set>
#include <stdexcept>
#include <utility>

#include "lacon/catalog/cells.hpp"
#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/quantities.hpp"
#include "lacon/elements/reference.hpp"

namespace lacon {
namespace {

namespace fs = std::filesystem;

struct CloseLibrary {
  void operator()(void* handle) const { dlclose(handle); }
};

struct Plugin {
  std::string name;
  fs::path folder;
  std::unique_ptr<void, CloseLibrary> library;
  const lacon_plugin_table* table = nullptr;

  fs::path library_file() const { return folder / ("lib" + name + ".so"); }
  fs::path rows_file() const { return folder / "plugin.toml"; }
};

/// An element row of a plugin.toml, with the texts that it refers to.
struct OwnedRow {
  std::deque<std::string> texts;  // a deque: its items stay where they are
  std::vector<std::string_view> dofs, stress;
  std::vector<catalog::KernelRow> kernels;
  catalog::ElementRow row{};
  std::string plugin_file;

  std::string_view keep(std::string text) { return texts.emplace_back(std::move(text)); }
};

[[noreturn]] void bad_plugin(const fs::path& file, const std::string& reason) {
  fail("PLUGIN_1", {{"file", file.string()}, {"reason", reason}});
}

std::string in_quotes(std::string_view text) { return "'" + std::string(text) + "'"; }

// ---------------------------------------------------------------------------------------------------- finding plug-ins

bool is_plugin(const fs::path& folder) {
  std::error_code error;
  return fs::exists(folder / "plugin.toml", error) || fs::exists(folder / ("lib" + folder.filename().string() + ".so"), error);
}

/// The plug-ins in a folder: itself, or its sub-folders by name.
std::vector<fs::path> plugins_in(const fs::path& given) {
  std::error_code error;
  const fs::path folder = fs::canonical(given, error);
  if (error) bad_plugin(given, error.message());
  if (is_plugin(folder)) return {folder};
  std::vector<fs::path> found;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
    if (is_plugin(entry.path())) found.push_back(entry.path());
  if (error) bad_plugin(given, error.message());
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<fs::path> path_from_environment() {
  const char* value = std::getenv("LACON_PLUGIN_PATH");
  std::vector<fs::path> folders;
  for (std::string_view rest = value ? value : ""; !rest.empty();) {
    const std::size_t end = std::min(rest.find(':'), rest.size());
    if (end > 0) folders.emplace_back(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return folders;
}

/// The folder of the built-in plug-ins, installed or in the build tree; empty where there is none.
fs::path folder_beside_executable() {
  std::error_code error;
  const fs::path executable = fs::read_symlink("/proc/self/exe", error);
  const fs::path folder = executable.parent_path().parent_path() / "lib" / "lacon" / "plugins";
  return fs::is_directory(folder, error) ? folder : fs::path();
}

// ---------------------------------------------------------------------------------------------------- reading rows

/// One [[element]] table of a plugin.toml, which may be wrong in any way.
class RowReader {
 public:
  RowReader(const fs::path& file, const toml::table& table) : file_(file), table_(table) {
    element_ = "in line " + std::to_string(table.source().begin.line);
    element_ = text("modelisation");
    const std::set<std::string_view> known = {"modelisation", "phenomenon", "role",   "geometry", "stress_state",
                                              "points",       "dofs",       "stress", "kernels"};
    for (const auto& [key, value] : table)
      if (!known.contains(key.str())) fail_row("it has the key " + in_quotes(key.str()) + ", which no element has");
  }

  [[noreturn]] void fail_row(const std::string& reason) const {
    fail("PLUGIN_2", {{"file", file_.string()}, {"element", element_}, {"reason", reason}});
  }

  /// Rows for each cell that the table names in `points`.
  void read(const std::vector<Plugin>& plugins, std::vector<std::unique_ptr<OwnedRow>>& rows) {
    const catalog::Role role = choice<catalog::Role>("role", {{"solid", catalog::Role::solid}, {"skin", catalog::Role::skin}});
    const auto geometry = choice<catalog::Geometry>(
        "geometry",
        {{"plane", catalog::Geometry::plane}, {"axis", catalog::Geometry::axis}, {"space", catalog::Geometry::space}});
    catalog::StressState state = catalog::StressState::full;
    if (role == catalog::Role::solid && geometry == catalog::Geometry::plane)
      state = choice<catalog::StressState>("stress_state", {{"plane_strain", catalog::StressState::plane_strain},
                                                            {"plane_stress", catalog::StressState::plane_stress}});
    else if (table_.contains("stress_state"))
      fail_row("it has a 'stress_state', which solids in the plane alone have");
    const toml::table* points = table_["points"].as_table();
    if (!points || points->empty()) fail_row("it lacks the table 'points' (cell = number of integration points)");
    const std::string modelisation = element_;
    for (const auto& [key, value] : *points) {
      const std::string cell_name(key.str());
      element_ = modelisation + "/" + cell_name;
      const std::optional<CellType> cell = catalog::find_cell(cell_name);
      if (!cell) fail_row("the cell " + in_quotes(cell_name) + " does not exist");
      auto owned = std::make_unique<OwnedRow>();
      owned->plugin_file = file_.string();
      owned->row = {owned->keep(element_),
                    owned->keep(modelisation),
                    owned->keep(text("phenomenon")),
                    *cell,
                    role,
                    geometry,
                    state,
                    rule_size(*cell, value),
                    {},
                    {},
                    {}};
      if (catalog::cell(*cell).dimension + (role == catalog::Role::skin ? 1 : 0) != catalog::dimension_of(geometry))
        fail_row("a cell of this dimension is no " + text("role") + " of its geometry");
      owned->dofs = components("dofs", "DEPL_R", *owned);
      check_displacements(owned->dofs, geometry);
      owned->stress = components("stress", "SIEF_R", *owned);
      read_kernels(plugins, *owned);
      owned->row.dofs = owned->dofs;
      owned->row.stress = owned->stress;
      owned->row.kernels = owned->kernels;
      rows.push_back(std::move(owned));
    }
  }

 private:
  std::string text(std::string_view key) const {
    const std::optional<std::string> value = table_[key].value_exact<std::string>();
    if (!value || value->empty()) fail_row("it lacks the text " + in_quotes(key));
    return *value;
  }

  template <class Value>
  Value choice(std::string_view key, std::initializer_list<std::pair<std::string_view, Value>> choices) const {
    const std::string given = text(key);
    std::string known;
    for (const auto& [name, value] : choices) {
      if (name == given) return value;
      known += (known.empty() ? "" : ", ") + in_quotes(name);
    }
    fail_row("its " + std::string(key) + " " + in_quotes(given) + " is none of " + known);
  }

  /// Kernels, loads and contact take the first unknowns of a node for its displacement.
  void check_displacements(std::span<const std::string_view> dofs, catalog::Geometry geometry) const {
    constexpr std::string_view displacements[] = {"DX", "DY", "DZ"};
    const std::span wanted = std::span(displacements).first(static_cast<std::size_t>(catalog::dimension_of(geometry)));
    std::string names;
    for (const std::string_view name : wanted) names += (names.empty() ? "" : ", ") + in_quotes(name);
    if (!std::ranges::equal(dofs, wanted))
      fail_row("its 'dofs' are not the displacements of its geometry, " + names + ", in this order");
  }

  int rule_size(CellType cell, const toml::node& node) const {
    const std::optional<std::int64_t> n = node.value_exact<std::int64_t>();
    try {
      if (n && *n > 0 && *n < 100000) return integration_rule(catalog::cell(cell).family, static_cast<int>(*n)).size();
    } catch (const std::logic_error&) {  // told below, with the file
    }
    fail_row("there is no integration rule of " + (n ? std::to_string(*n) : std::string("this number of")) +
             " points on this cell");
  }

  std::vector<std::string_view> components(std::string_view key, std::string_view quantity, OwnedRow& owned) const {
    const auto known = std::find_if(catalog::quantities().begin(), catalog::quantities().end(),
                                    [&](const auto& q) { return q.name == quantity; });
    const toml::array* array = table_[key].as_array();
    if (!array) fail_row("it lacks the list " + in_quotes(key));
    std::vector<std::string_view> names;
    for (const toml::node& node : *array) {
      const std::string name = node.value_exact<std::string>().value_or("");
      if (std::find(known->components.begin(), known->components.end(), name) == known->components.end())
        fail_row(in_quotes(key) + " names " + in_quotes(name) + ", which is no component of " + std::string(quantity));
      if (std::find(names.begin(), names.end(), name) != names.end())
        fail_row(in_quotes(key) + " names " + in_quotes(name) + " twice");
      names.push_back(owned.keep(name));
    }
    return names;
  }

  void read_kernels(const std::vector<Plugin>& plugins, OwnedRow& owned) const {
    const toml::table* kernels = table_["kernels"].as_table();
    if (!kernels) fail_row("it lacks the table 'kernels' (option = \"plug-in/kernel\")");
    for (const auto& [option, node] : *kernels) {
      const std::string value = node.value_exact<std::string>().value_or("");
      const std::size_t slash = value.find('/');
      const std::string plugin = value.substr(0, slash);
      if (slash == std::string::npos || slash == 0 || slash + 1 == value.size())
        fail_row("its kernel of " + std::string(option.str()) + ", " + in_quotes(value) +
                 ", is not of the form 'plug-in/kernel'");
      if (std::none_of(plugins.begin(), plugins.end(), [&](const Plugin& p) { return p.name == plugin; }))
        fail_row("its kernel of " + std::string(option.str()) + " is in the plug-in " + in_quotes(plugin) +
                 ", which was not found");
      owned.kernels.push_back({owned.keep(std::string(option.str())), owned.keep(value)});
    }
  }

  const fs::path& file_;
  const toml::table& table_;
  std::string element_;
};

void read_rows(const fs::path& file, const std::vector<Plugin>& plugins, std::vector<std::unique_ptr<OwnedRow>>& rows) {
  toml::table content;
  try {
    content = toml::parse_file(file.string());
  } catch (const toml::parse_error& error) {
    bad_plugin(file, std::string(error.description()) + " (line " + std::to_string(error.source().begin.line) + ")");
  }
  for (const auto& [key, value] : content) {
    if (key.str() != "element" || !value.is_array_of_tables())
      bad_plugin(file, in_quotes(key.str()) + " is not a list of [[element]] tables");
    for (const toml::node& node : *value.as_array()) RowReader(file, *node.as_table()).read(plugins, rows);
  }
}

// ---------------------------------------------------------------------------------------------------- opening libraries

/// What is wrong with a kernel of a plug-in's table; empty if nothing is.
std::string defect(const lacon_kernel& kernel) {
  if (!kernel.name || !*kernel.name) return "one of its kernels has no name";
  const std::string name = "its kernel " + in_quotes(kernel.name);
  switch (kernel.kind) {
    case LACON_SOLID:
      if (!kernel.parameters) return name + " has no list of parameters";
      return kernel.solid ? "" : name + " has no function";
    case LACON_LOAD:
      if (!kernel.parameters) return name + " has no list of values";
      return kernel.load ? "" : name + " has no function";
    case LACON_CONTACT:
      return kernel.contact ? "" : name + " has no function";
    default:
      return name + " is of the unknown kind " + std::to_string(kernel.kind);
  }
}

void open(Plugin& plugin) {
  if (plugin.table) return;
  const fs::path file = plugin.library_file();
  std::unique_ptr<void, CloseLibrary> library(dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL));
  if (!library) {
    const char* reason = dlerror();
    bad_plugin(file, reason ? reason : "it cannot be opened");
  }
  const auto entry = reinterpret_cast<const lacon_plugin_table* (*)()>(dlsym(library.get(), "lacon_plugin"));
  if (!entry) bad_plugin(file, "it has no function lacon_plugin");
  const lacon_plugin_table* table = entry();
  if (!table) bad_plugin(file, "its function lacon_plugin returns nothing");
  if (table->abi != LACON_ABI)
    bad_plugin(file, "it was built for the interface (ABI) " + std::to_string(table->abi) + ", this program has " +
                         std::to_string(LACON_ABI));
  if (table->solid_batch_size != sizeof(lacon_solid_batch) || table->load_batch_size != sizeof(lacon_load_batch) ||
      table->contact_batch_size != sizeof(lacon_contact_batch))
    bad_plugin(file, "its batches have other sizes than this program's");
  if (table->n_kernels < 1 || !table->kernels) bad_plugin(file, "it has no kernels");
  for (std::int32_t k = 0; k < table->n_kernels; ++k)
    if (const std::string reason = defect(table->kernels[k]); !reason.empty()) bad_plugin(file, reason);
  plugin.library = std::move(library);
  plugin.table = table;
}

const char* kind_name(int kind) { return kind == LACON_SOLID ? "solid elements" : kind == LACON_LOAD ? "loads" : "contact"; }

const catalog::KernelRow* find_option(const catalog::ElementRow& element, std::string_view option) {
  for (const catalog::KernelRow& row : element.kernels)
    if (row.option == option) return &row;
  return nullptr;
}

}  // namespace

struct Registry::State {
  std::vector<Plugin> plugins;
  std::vector<std::unique_ptr<OwnedRow>> owned;
  std::vector<const catalog::ElementRow*> rows;

  void add_plugins(const fs::path& folder) {
    for (const fs::path& found : plugins_in(folder)) {
      const std::string name = found.filename().string();
      const auto same = std::find_if(plugins.begin(), plugins.end(), [&](const Plugin& p) { return p.name == name; });
      if (same == plugins.end())
        plugins.push_back({name, found, nullptr, nullptr});
      else if (same->folder != found)
        bad_plugin(found, "another plug-in of this name is in '" + same->folder.string() + "'");
    }
  }
};

Registry::Registry(std::span<const fs::path> folders) : state_(std::make_unique<State>()) {
  std::vector<fs::path> asked(folders.begin(), folders.end());
  for (fs::path& folder : path_from_environment()) asked.push_back(std::move(folder));
  for (const fs::path& folder : asked) {
    if (plugins_in(folder).empty()) bad_plugin(folder, "the folder holds no plug-in");
    state_->add_plugins(folder);
  }
  if (const fs::path installed = folder_beside_executable(); !installed.empty()) state_->add_plugins(installed);

  for (const catalog::ElementRow& row : catalog::elements()) state_->rows.push_back(&row);
  for (const Plugin& plugin : state_->plugins) {
    std::error_code error;
    if (fs::exists(plugin.rows_file(), error)) read_rows(plugin.rows_file(), state_->plugins, state_->owned);
  }
  for (const auto& owned : state_->owned) {
    if (find_element(owned->row.name))
      fail("PLUGIN_2",
           {{"file", owned->plugin_file}, {"element", std::string(owned->row.name)}, {"reason", "another row has this name"}});
    state_->rows.push_back(&owned->row);
  }
}

Registry::~Registry() = default;

const catalog::ElementRow* Registry::find_element(std::string_view name) const {
  for (const catalog::ElementRow* row : state_->rows)
    if (row->name == name) return row;
  return nullptr;
}

const catalog::ElementRow* Registry::find_element(std::string_view modelisation, CellType cell) const {
  for (const catalog::ElementRow* row : state_->rows)
    if (row->modelisation == modelisation && row->cell == cell) return row;
  return nullptr;
}

std::vector<std::string> Registry::modelisations() const {
  std::vector<std::string> names;
  for (const catalog::ElementRow* row : state_->rows)
    if (std::find(names.begin(), names.end(), row->modelisation) == names.end()) names.emplace_back(row->modelisation);
  return names;
}

bool Registry::has_kernel(const catalog::ElementRow& element, std::string_view option) const {
  return find_option(element, option) != nullptr;
}

const lacon_kernel& Registry::kernel(const catalog::ElementRow& element, std::string_view option, lacon_kernel_kind kind) {
  const auto reasoned = [&](const std::string& reason) {
    return Error(
        message("PLUGIN_3", {{"element", std::string(element.name)}, {"option", std::string(option)}, {"reason", reason}}));
  };
  const catalog::KernelRow* row = find_option(element, option);
  if (!row) throw reasoned("its row names no kernel for it");
  const std::size_t slash = row->kernel.find('/');
  const std::string_view plugin_name = row->kernel.substr(0, slash), kernel_name = row->kernel.substr(slash + 1);
  const auto plugin =
      std::find_if(state_->plugins.begin(), state_->plugins.end(), [&](const Plugin& p) { return p.name == plugin_name; });
  if (plugin == state_->plugins.end()) throw reasoned("the plug-in " + in_quotes(plugin_name) + " was not found");
  open(*plugin);
  for (std::int32_t k = 0; k < plugin->table->n_kernels; ++k) {
    const lacon_kernel& kernel = plugin->table->kernels[k];
    if (kernel.name != kernel_name) continue;
    if (kernel.kind != kind)
      throw reasoned("the kernel " + in_quotes(row->kernel) + " of '" + plugin->library_file().string() + "' is for " +
                     kind_name(kernel.kind) + ", not for " + kind_name(kind));
    return kernel;
  }
  throw reasoned("the plug-in '" + plugin->library_file().string() + "' has no kernel " + in_quotes(kernel_name));
}

}  // namespace lacon
