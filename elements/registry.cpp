#include "lacon/elements/registry.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/elements/plugin_rows.hpp"
#include "lacon/structures/executable.hpp"

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
  const fs::path folder = executable().parent_path().parent_path() / "lib" / "lacon" / "plugins";
  return fs::is_directory(folder, error) ? folder : fs::path();
}

// ---------------------------------------------------------------------------------------------------- opening libraries

/// What is wrong with a kernel of a plug-in's table; empty if nothing is.
std::string defect(const lacon_kernel& kernel) {
  if (!kernel.name || !*kernel.name) return part("kernel_without_name");
  const auto said = [&](std::string_view what) { return part(what, {{"kernel", kernel.name}}); };
  const std::vector<std::string_view> unknowns(kernel.unknowns, kernel.unknowns + n_names(kernel.unknowns));
  if (kernel.unknowns && unknowns.empty()) return said("kernel_without_unknowns");
  for (const std::string_view unknown : unknowns)
    if (std::count(unknowns.begin(), unknowns.end(), unknown) > 1)
      return part("kernel_names_twice", {{"kernel", kernel.name}, {"unknown", std::string(unknown)}});
  switch (kernel.kind) {
    case LACON_SOLID:
      if (!kernel.parameters) return said("kernel_without_parameters");
      return kernel.solid ? "" : said("kernel_without_function");
    case LACON_LOAD:
      if (!kernel.parameters) return said("kernel_without_values");
      return kernel.load ? "" : said("kernel_without_function");
    case LACON_CONTACT:
      return kernel.contact ? "" : said("kernel_without_function");
    default:
      return part("kernel_of_unknown_kind", {{"kernel", kernel.name}, {"kind", std::to_string(kernel.kind)}});
  }
}

void open(Plugin& plugin) {
  if (plugin.table) return;
  const fs::path file = plugin.library_file();
  std::unique_ptr<void, CloseLibrary> library(dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL));
  if (!library) {
    const char* reason = dlerror();
    bad_plugin(file, reason ? reason : part("it_cannot_be_opened"));
  }
  const auto entry = reinterpret_cast<const lacon_plugin_table* (*)()>(dlsym(library.get(), "lacon_plugin"));
  if (!entry) bad_plugin(file, part("no_entry"));
  const lacon_plugin_table* table = entry();
  if (!table) bad_plugin(file, part("entry_returns_nothing"));
  if (table->abi != LACON_ABI)
    bad_plugin(file, part("another_abi", {{"found", std::to_string(table->abi)}, {"expected", std::to_string(LACON_ABI)}}));
  if (table->solid_batch_size != sizeof(lacon_solid_batch) || table->load_batch_size != sizeof(lacon_load_batch) ||
      table->contact_batch_size != sizeof(lacon_contact_batch))
    bad_plugin(file, part("batches_of_other_sizes"));
  if (table->n_kernels < 1 || !table->kernels) bad_plugin(file, part("no_kernels"));
  for (std::int32_t k = 0; k < table->n_kernels; ++k)
    if (const std::string reason = defect(table->kernels[k]); !reason.empty()) bad_plugin(file, reason);
  plugin.library = std::move(library);
  plugin.table = table;
}

std::string kind_name(int kind) {
  return part(kind == LACON_SOLID ? "for_solid_elements" : kind == LACON_LOAD ? "for_loads" : "for_contact");
}

}  // namespace

struct Registry::State {
  std::vector<Plugin> plugins;
  PluginRows brought;
  std::vector<const catalog::ElementRow*> rows;
  std::vector<const catalog::RelationRow*> relations;
  std::vector<const catalog::DeformationRow*> deformations;

  void add_plugins(const fs::path& folder) {
    for (const fs::path& found : plugins_in(folder)) {
      const std::string name = found.filename().string();
      const auto same = std::find_if(plugins.begin(), plugins.end(), [&](const Plugin& p) { return p.name == name; });
      if (same == plugins.end())
        plugins.push_back({name, found, nullptr, nullptr});
      else if (same->folder != found)
        bad_plugin(found, part("plugin_of_this_name", {{"folder", same->folder.string()}}));
    }
  }

  /// The kernel of an option of an element, "plug-in/kernel": of its own row, or of a [[law]]; empty where there is none.
  std::string_view kernel_name(const catalog::ElementRow& element, std::string_view option) const {
    for (const catalog::KernelRow& row : element.kernels)
      if (row.option == option) return row.kernel;
    if (element.role == catalog::Role::solid)
      for (const LawRow& law : brought.laws)
        if (law.modelisation == element.modelisation && law.option == option) return law.kernel;
    return {};
  }

  void read_rows();
  void check_behaviours() const;
};

namespace {

[[noreturn]] void refuse_row(const std::string& file, const std::string& row, const std::string& reason) {
  fail("PLUGIN_2", {{"file", file}, {"row", row}, {"reason", reason}});
}

template <class Row>
const Row* named(const std::vector<const Row*>& rows, std::string_view name) {
  const auto at = std::find_if(rows.begin(), rows.end(), [&](const Row* row) { return row->name == name; });
  return at == rows.end() ? nullptr : *at;
}

/// Make rows known; none may be there already. @param rows without those before `first`, which are known
template <class Row, class Rows>
void enter(std::vector<const Row*>& known, const Rows& rows, std::size_t first, const std::string& kind,
           const std::string& file) {
  for (std::size_t i = first; i < rows.size(); ++i) {
    if (named(known, rows[i].name)) refuse_row(file, kind + " " + std::string(rows[i].name), part("row_of_this_name"));
    known.push_back(&rows[i]);
  }
}

}  // namespace

void Registry::State::read_rows() {
  for (const catalog::ElementRow& row : catalog::elements()) rows.push_back(&row);
  for (const catalog::RelationRow& row : catalog::relations()) relations.push_back(&row);
  for (const catalog::DeformationRow& row : catalog::deformations()) deformations.push_back(&row);
  std::vector<std::string> names;
  for (const Plugin& plugin : plugins) names.push_back(plugin.name);
  for (const Plugin& plugin : plugins) {
    std::error_code error;
    if (!fs::exists(plugin.rows_file(), error)) continue;
    const std::string file = plugin.rows_file().string();
    const std::size_t first_relation = brought.relations.size(), first_deformation = brought.deformations.size();
    read_plugin_rows(plugin.rows_file(), names, brought);
    enter(relations, brought.relations, first_relation, "relation", file);
    enter(deformations, brought.deformations, first_deformation, "deformation", file);
  }
  for (const OwnedElement& owned : brought.elements) {
    if (named(rows, owned.row.name)) refuse_row(owned.file, "element " + std::string(owned.row.name), part("row_of_this_name"));
    rows.push_back(&owned.row);
  }
  check_behaviours();
}

/// Behaviours are of what exists, and a law is the only one of its kind.
void Registry::State::check_behaviours() const {
  const auto missing = [&](std::string_view option) -> std::string {
    const std::size_t slash = option.find('/');
    const std::string_view relation = option.substr(0, slash), deformation = option.substr(slash + 1);
    if (!named(relations, relation)) return part("no_relation", {{"name", std::string(relation)}});
    if (!named(deformations, deformation)) return part("no_deformation", {{"name", std::string(deformation)}});
    return {};
  };
  for (const OwnedElement& owned : brought.elements)
    for (const catalog::KernelRow& kernel : owned.kernels)
      if (kernel.option.find('/') != std::string_view::npos && !missing(kernel.option).empty())
        refuse_row(
            owned.file, "element " + std::string(owned.row.name),
            part("option_of_no_behaviour", {{"option", std::string(kernel.option)}, {"reason", missing(kernel.option)}}));
  for (const LawRow& law : brought.laws) {
    const auto refuse = [&](const std::string& reason) { refuse_row(law.file, "law " + std::string(law.option), reason); };
    if (const std::string reason = missing(law.option); !reason.empty()) refuse(reason);
    const auto body = std::find_if(rows.begin(), rows.end(), [&](const catalog::ElementRow* row) {
      return row->modelisation == law.modelisation && row->role == catalog::Role::solid;
    });
    if (body == rows.end()) refuse(part("no_solid_modelisation", {{"name", std::string(law.modelisation)}}));
    if (kernel_name(**body, law.option) != law.kernel)
      refuse(part("has_its_kernel_already", {{"name", std::string(law.modelisation)}}));
  }
}

Registry::Registry(std::span<const fs::path> folders) : state_(std::make_unique<State>()) {
  std::vector<fs::path> asked(folders.begin(), folders.end());
  for (fs::path& folder : path_from_environment()) asked.push_back(std::move(folder));
  for (const fs::path& folder : asked) {
    if (plugins_in(folder).empty()) bad_plugin(folder, part("folder_without_plugin"));
    state_->add_plugins(folder);
  }
  if (const fs::path installed = folder_beside_executable(); !installed.empty()) state_->add_plugins(installed);

  state_->read_rows();
}

Registry::~Registry() = default;

const catalog::ElementRow* Registry::find_element(std::string_view name) const { return named(state_->rows, name); }

const catalog::RelationRow* Registry::find_relation(std::string_view name) const { return named(state_->relations, name); }

const catalog::DeformationRow* Registry::find_deformation(std::string_view name) const {
  return named(state_->deformations, name);
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
  return !state_->kernel_name(element, option).empty();
}

const lacon_kernel& Registry::kernel(const catalog::ElementRow& element, std::string_view option, lacon_kernel_kind kind) {
  const auto reasoned = [&](const std::string& reason) {
    return Error(
        message("PLUGIN_3", {{"element", std::string(element.name)}, {"option", std::string(option)}, {"reason", reason}}));
  };
  const std::string_view found = state_->kernel_name(element, option);
  if (found.empty()) throw reasoned(part("no_row_names_a_kernel"));
  const std::size_t slash = found.find('/');
  const std::string_view plugin_name = found.substr(0, slash), kernel_name = found.substr(slash + 1);
  const auto plugin =
      std::find_if(state_->plugins.begin(), state_->plugins.end(), [&](const Plugin& p) { return p.name == plugin_name; });
  if (plugin == state_->plugins.end()) throw reasoned(part("plugin_not_found", {{"name", std::string(plugin_name)}}));
  open(*plugin);
  for (std::int32_t k = 0; k < plugin->table->n_kernels; ++k) {
    const lacon_kernel& kernel = plugin->table->kernels[k];
    if (kernel.name != kernel_name) continue;
    if (kernel.kind != kind)
      throw reasoned(part("kernel_for_another", {{"kernel", std::string(found)},
                                                 {"file", plugin->library_file().string()},
                                                 {"found", kind_name(kernel.kind)},
                                                 {"wanted", kind_name(kind)}}));
    for (const std::string_view unknown : unknowns_of(element, kernel))
      if (std::find(element.dofs.begin(), element.dofs.end(), unknown) == element.dofs.end())
        throw reasoned(part(
            "kernel_on_another_unknown",
            {{"kernel", std::string(found)}, {"file", plugin->library_file().string()}, {"unknown", std::string(unknown)}}));
    return kernel;
  }
  throw reasoned(
      part("plugin_without_kernel", {{"file", plugin->library_file().string()}, {"kernel", std::string(kernel_name)}}));
}

std::vector<std::string_view> unknowns_of(const catalog::ElementRow& element, const lacon_kernel& kernel) {
  if (kernel.unknowns) return {kernel.unknowns, kernel.unknowns + n_names(kernel.unknowns)};
  const auto displacements = element.dofs.first(static_cast<std::size_t>(catalog::dimension_of(element.geometry)));
  return {displacements.begin(), displacements.end()};
}

int n_names(const char* const* names) {
  int count = 0;
  while (names && names[count]) ++count;
  return count;
}

}  // namespace lacon
