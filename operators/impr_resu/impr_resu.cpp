#include "lacon/operators/impr_resu/impr_resu.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <tuple>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/elements/reference.hpp"
#include "lacon/operators/contact/offsets.hpp"
#include "lacon/operators/contact/pairing_view.hpp"
#include "lacon/operators/fields/expected.hpp"
#include "lacon/operators/fields/selection.hpp"
#include "lacon/structures/displacement.hpp"
#include "lacon/structures/formats/gmsh.hpp"
#include "lacon/structures/formats/listing.hpp"
#include "lacon/structures/formats/mail.hpp"
#include "lacon/structures/formats/med.hpp"
#include "lacon/structures/formats/text_file.hpp"
#include "lacon/structures/formats/vtu.hpp"

namespace lacon {
namespace {

namespace fs = std::filesystem;

/// What files call a mesh: as its variable, or where none holds it by its type.
std::string label_of_mesh(const Base& base, const std::string& id) { return base.label(id).empty() ? "MESH" : base.label(id); }

/// Concepts that several occurrences of RESU share are read once.
class Concepts {
 public:
  explicit Concepts(const Base& base) : base_(base) {}

  const Mesh& mesh(const std::string& id) {
    auto [at, is_new] = meshes_.try_emplace(id);
    if (is_new) at->second = base_.mesh(id);
    return at->second;
  }
  const Result& result(const std::string& id) {
    auto [at, is_new] = results_.try_emplace(id);
    if (is_new) at->second = base_.result(id);
    return at->second;
  }
  /// RESULTAT, or CHAM_GD as a result whose one field it is, under its own name. Throws CREACHAMP_12 for a field
  /// of functions.
  std::pair<std::string, const Result&> source(const Keywords& one) {
    const std::string id = one.concept_id(one.has("CHAM_GD") ? "CHAM_GD" : "RESULTAT");
    if (!one.has("CHAM_GD")) return {id, result(id)};
    auto [at, is_new] = results_.try_emplace(id);
    if (is_new) {
      const Field field = base_.field_head(id);
      if (field.quantity.ends_with("_F")) fail("CREACHAMP_12", {{"field", base_.label(id)}, {"keyword", one.path("CHAM_GD")}});
      Result& result = at->second;
      result.label = base_.label(id).empty() ? field.quantity : base_.label(id);  // no variable holds it
      result.mesh = field.mesh;
      result.orders = {field.order};
      result.instants = {field.instant};
      result.fields[result.label][field.order] = base_.file(id).filename().string();
    }
    return {id, at->second};
  }

 private:
  const Base& base_;
  std::map<std::string, Mesh> meshes_;
  std::map<std::string, Result> results_;
};

/// The integration points that a field on cells of this type has, where the reference cells know a rule of so many.
std::optional<MedPoints> points_of(CellType type, int n_points) {
  try {
    const Rule& rule = integration_rule(catalog::cell(type).family, n_points);
    return MedPoints{rule.points, rule.weights};
  } catch (const std::logic_error&) {
    return std::nullopt;
  }
}

/// The part of a field at integration points whose points MED can be told; a plug-in may have points of its own.
bool med_knows_points(const Mesh& mesh, const Field& field) {
  for (std::size_t i = 0; i < field.support.size(); ++i) {
    const CellType type = mesh.types[static_cast<std::size_t>(field.support[i])];
    const auto n = static_cast<int>(field.offset[i + 1] - field.offset[i]);
    if (n > 0 && !points_of(type, n)) return false;
  }
  return true;
}

/// "U____DEPL at 3 instants", counted over the visits.
class Written {
 public:
  void add(const std::string& name) {
    if (count_[name]++ == 0) names_.push_back(name);
  }
  void lines(const std::string& file, std::vector<std::string>& lines) const {
    for (const std::string& name : names_) {
      const int n = count_.at(name);
      lines.push_back(fmt::format("{}{}: {}", name, n > 1 ? part("at_instants", {{"count", std::to_string(n)}}) : "", file));
    }
  }

 private:
  std::vector<std::string> names_;
  std::map<std::string, int> count_;
};

/// Tells which fields of an occurrence come as means of cells: those at integration points, with VTU those at nodes of cells
/// too.
class Means {
 public:
  Means(std::string label, std::string format) : label_(std::move(label)), format_(std::move(format)) {}
  void add(const Field& field) {
    if (field.location == Location::gauss_points || (field.location == Location::cell_nodes && format_ == "VTU"))
      fields_.insert(field.name);
  }
  void tell() const {
    if (fields_.empty()) return;
    inform("IMPR_10", {{"label", label_}, {"format", format_}, {"fields", fmt::format("{}", fmt::join(fields_, ", "))}});
  }

 private:
  std::string label_, format_;
  std::set<std::string> fields_;
};

/// The pairing at an instant of a result, or of a contact before any.
struct PrintedPairing {
  std::string id;  ///< of the result or the contact
  std::string label;
  std::int64_t order = -1;  ///< of a result
  double instant = 0;
  PairingView view;

  std::string title() const {
    if (order < 0) return part("pairing_at_start", {{"label", label}});
    return part("pairing_at_instant", {{"label", label}, {"instant", fmt::format("{:g}", instant)}});
  }
};

bool means_pairing(const Keywords& one) { return one.has("CONTACT") || (one.has("PAIRING") && one.yes("PAIRING")); }

/// An occurrence of RESU may have fields beside MAILLAGE.
bool has_fields(const Keywords& one) { return one.has("RESULTAT") || one.has("CHAM_GD"); }

/// A contact with what its pairing is viewed by.
struct ViewedContact {
  ViewedContact(const Base& base, const Mesh& mesh, const std::string& id)
      : contact(base.contact(id)), model(contact.completed(base.model(contact.model))), offsets(mesh, contact, base) {}
  Contact contact;
  Model model;
  ContactOffsets offsets;
};

/// Visit what an occurrence of RESU with CONTACT or PAIRING='OUI' means, of a result the instants with contact. Throws IMPR_7
/// where there is none.
void each_pairing(const Order& order, const Base& base, Concepts& concepts, const Keywords& one,
                  const std::function<void(PrintedPairing&&)>& visit) {
  Registry registry(order.plugins);
  if (one.has("CONTACT")) {
    const std::string id = one.concept_id("CONTACT");
    const Mesh& mesh = concepts.mesh(base.contact(id).mesh);
    const ViewedContact viewed(base, mesh, id);
    visit({id, base.label(id), -1, 0,
           view_pairing(mesh, viewed.model, viewed.contact, registry, {.offsets = viewed.offsets.at(0)})});
    return;
  }
  const std::string result_id = one.concept_id("RESULTAT");
  const Result& result = concepts.result(result_id);
  std::vector<std::int64_t> orders = selected_orders(base, result, one);
  std::erase_if(orders, [&](std::int64_t number) { return result.stage(number).contact.empty(); });
  if (orders.empty()) fail("IMPR_7", {{"keyword", one.path("PAIRING")}, {"label", result.label}});
  const Mesh& mesh = concepts.mesh(result.mesh);
  std::map<std::string, ViewedContact> contacts;
  for (const std::int64_t number : orders) {
    const std::string& id = result.stage(number).contact;
    const ViewedContact& viewed = contacts.try_emplace(id, base, mesh, id).first->second;
    const Field depl = base.field(result, "DEPL", number);
    std::vector<Load> loads;
    for (const ResultLoad& load : result.stage(number).loads) loads.push_back(base.load(load.load));
    ViewedInstant instant{.displacement = nodal_displacements(mesh, depl, mesh.dimension),
                          .held = held_directions(mesh, loads),
                          .offsets = viewed.offsets.at(depl.instant)};
    if (const auto files = result.fields.find("CONT_ELEM"); files != result.fields.end() && files->second.contains(number)) {
      instant.cont_elem = base.field(result, "CONT_ELEM", number);
      instant.kept = read_kept_contact(base.folder() / files->second.at(number), "shown_without_masters").pairing;
    }
    visit({result_id, result.label, number, depl.instant, view_pairing(mesh, viewed.model, viewed.contact, registry, instant)});
  }
}

void append_report(const PrintedPairing& printed, std::vector<std::string>& report) {
  report.push_back(printed.title());
  report.insert(report.end(), printed.view.report.begin(), printed.view.report.end());
}

/// Whose a field in a file is: variables of several results, made in a loop or in functions, may have one name.
std::string owner_in_file(const Base& base, const std::string& id, const Field& field) {
  return base.folder().filename().string() + "/" + id + "/" + field.name;
}

void print_med(const Order& order, const Base& base, Concepts& concepts, const fs::path& file, bool append, Written& written,
               std::vector<std::string>& report) {
  write_med(file, append, [&](MedFile& med) {
    for (const Keywords& one : order.keywords.factors("RESU")) {
      if (means_pairing(one)) {
        each_pairing(order, base, concepts, one, [&](PrintedPairing&& printed) {
          for (PairingLayer& layer : printed.view.layers) {
            const std::string name = med.add_mesh(
                layer.mesh, printed.label + "_" + layer.name + (printed.order < 0 ? "" : fmt::format("_{}", printed.order)));
            for (Field& field : layer.fields) {
              field.instant = printed.instant;
              med.add_field(layer.mesh, name, field, name + "_" + field.name, printed.order, {},
                            owner_in_file(base, printed.id, field));
            }
            written.add(part("pairing_layer_of", {{"layer", layer.name}, {"label", printed.label}}));
          }
          append_report(printed, report);
        });
        continue;
      }
      if (one.has("MAILLAGE")) {
        const std::string id = one.concept_id("MAILLAGE");
        written.add(part("mesh") + " " + med.add_mesh(concepts.mesh(id), label_of_mesh(base, id)));
        if (!has_fields(one)) continue;
      }
      const auto& [id, result] = concepts.source(one);
      const Mesh& mesh = concepts.mesh(result.mesh);
      const std::string mesh_name = med.add_mesh(mesh, label_of_mesh(base, result.mesh));
      each_field(base, result, mesh, one, [&](PrintedField&& printed) {
        const Field& field = printed.field;
        if (field.location == Location::gauss_points && !med_knows_points(mesh, field)) {
          inform("IMPR_6", {{"label", result.label}, {"field", field.name}});
          return;
        }
        const auto rule = [](CellType type, int n) { return points_of(type, n).value(); };
        for (const std::string& name :
             med.add_field(mesh, mesh_name, field, printed.name_in_med, field.order, rule, owner_in_file(base, id, field)))
          written.add(part("field") + " " + name);
      });
    }
  });
}

/// Fields of one result at one instant come into one file, whatever occurrences name them.
/// Each layer of a pairing has a collection of its own, `<stem>_pairs.pvd`.
fs::path print_vtu(const Order& order, const Base& base, Concepts& concepts, const fs::path& file, bool append,
                   Written& written, std::vector<std::string>& report) {
  struct Step {
    std::string label;
    double instant = 0;
    std::string mesh;
    std::vector<NamedField> fields;
  };
  std::map<std::tuple<std::size_t, std::int64_t>, Step> steps;  // by first occurrence of the label, order
  std::vector<std::string> labels;
  const auto rank = [&](const std::string& id) {
    const auto at = std::find(labels.begin(), labels.end(), id);
    if (at == labels.end()) return labels.push_back(id), labels.size() - 1;
    return static_cast<std::size_t>(at - labels.begin());
  };
  std::map<std::string, std::vector<VtuStep>> layers;
  for (const Keywords& one : order.keywords.factors("RESU")) {
    if (means_pairing(one)) {
      each_pairing(order, base, concepts, one, [&](PrintedPairing&& printed) {
        for (PairingLayer& layer : printed.view.layers) {
          std::vector<NamedField> fields;
          for (Field& field : layer.fields) fields.push_back({field.name, std::move(field)});
          std::string name = layer.name;
          std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
          layers[name].push_back({printed.label, printed.instant, vtu_text(layer.mesh, fields)});
        }
        append_report(printed, report);
      });
      continue;
    }
    if (one.has("MAILLAGE") && !has_fields(one)) {  // files with fields hold their mesh
      const std::string id = one.concept_id("MAILLAGE");
      steps[{rank(id), -1}] = {base.label(id), 0, id, {}};
      written.add(part("mesh") + " " + base.label(id));
      continue;
    }
    const auto& [id, result] = concepts.source(one);
    Means means(result.label, "VTU");
    each_field(base, result, concepts.mesh(result.mesh), one, [&](PrintedField&& printed) {
      means.add(printed.field);
      Step& step = steps[{rank(id), printed.field.order}];
      step.label = result.label;
      step.instant = printed.field.instant;
      step.mesh = result.mesh;
      const std::string name = printed.field.name;
      written.add(part("field_of", {{"field", name}, {"result", result.label}}));
      const auto same = std::count_if(step.fields.begin(), step.fields.end(), [&](const NamedField& f) {
        return f.name == name || f.name.starts_with(name + "_part_");
      });
      step.fields.push_back({same == 0 ? name : fmt::format("{}_part_{}", name, same + 1), std::move(printed.field)});
    });
    means.tell();
  }
  std::vector<VtuStep> texts;
  for (const auto& [key, step] : steps)
    texts.push_back({step.label, step.instant, vtu_text(concepts.mesh(step.mesh), step.fields)});
  for (const auto& [name, own] : layers) {
    const fs::path beside = file.parent_path() / (file.stem().string() + "_" + name + ".pvd");
    report.push_back(fmt::format("{}: {}", part("pairing_layer", {{"layer", name}}), write_vtu(beside, append, own).string()));
  }
  return texts.empty() && !layers.empty() ? file : write_vtu(file, append, texts);
}

void print_listing(const Order& order, const Base& base, Concepts& concepts, const fs::path& file, bool append,
                   Written& written) {
  std::ostringstream out;
  std::error_code error;
  if (append && fs::exists(file, error)) out << read_text(file);
  for (const Keywords& one : order.keywords.factors("RESU")) {
    if (means_pairing(one)) {
      each_pairing(order, base, concepts, one, [&](PrintedPairing&& printed) {
        out << '\n' << printed.title() << '\n';
        for (const std::string& line : printed.view.report) out << line << '\n';
        written.add(part("pairing_of", {{"label", printed.label}}));
      });
      continue;
    }
    if (one.has("MAILLAGE")) {
      const std::string id = one.concept_id("MAILLAGE");
      out << '\n' << part("mesh") << ' ' << base.label(id) << '\n';
      list_mesh(out, concepts.mesh(id), one.yes("INFO_MAILLAGE"));
      written.add(part("mesh") + " " + base.label(id));
      if (!has_fields(one)) continue;
    }
    const Result& result = concepts.source(one).second;
    const Mesh& mesh = concepts.mesh(result.mesh);
    FieldListing what;
    what.coordinates = one.yes("IMPR_COOR");
    what.greatest = one.has("VALE_MAX");
    what.least = one.has("VALE_MIN");
    what.values = !what.greatest && !what.least;
    each_field(base, result, mesh, one, [&](PrintedField&& printed) {
      list_field(out, mesh, printed.field,
                 one.has("CHAM_GD") ? part("field") + " " + printed.field.name
                                    : part("listed_field", {{"result", result.label}, {"field", printed.field.name}}),
                 what);
      written.add(part("field_of", {{"field", printed.field.name}, {"result", result.label}}));
    });
  }
  TextFiles files;
  files.write(file, out.str());
  files.commit();
}

/// One mesh as code_aster's text, or as gmsh's with the fields that live on it; what this run wrote to a .msh file stays before
/// its further fields. Throws IMPR_8 for fields as code_aster's text, and for a second mesh, also one beside what this run
/// wrote.
void print_mesh_file(const Order& order, const Base& base, Concepts& concepts, const fs::path& file, bool append,
                     Written& written) {
  const bool gmsh = order.keywords.text("FORMAT") == "GMSH";
  std::error_code error;
  const bool goes_on = append && fs::exists(file, error);
  std::string mesh_id, text = goes_on ? read_text(file) : "";
  const auto text_of_mesh = [&](const std::string& id) {
    return gmsh ? gmsh_mesh_text(concepts.mesh(id)) : mail_text(concepts.mesh(id), label_of_mesh(base, id));
  };
  for (const Keywords& one : order.keywords.factors("RESU")) {
    const auto refuse = [&](const char* keyword, const char* what) {
      fail("IMPR_8", {{"keyword", one.path(keyword)}, {"what", part(what)}});
    };
    if (means_pairing(one)) refuse(one.has("CONTACT") ? "CONTACT" : "PAIRING", "a_pairing");
    const char* const source = one.has("CHAM_GD") ? "CHAM_GD" : one.has("RESULTAT") ? "RESULTAT" : "MAILLAGE";
    if (!gmsh && has_fields(one)) refuse(source, "fields");
    const std::string id = has_fields(one) ? concepts.source(one).second.mesh : one.concept_id("MAILLAGE");
    const Mesh& mesh = concepts.mesh(id);
    if (!mesh_id.empty() && mesh_id != id) refuse(source, "second_mesh");
    const auto is_in_file = [&] {
      if (gmsh && has_fields(one)) return mesh_id == id || is_gmsh_text_of(text, mesh);
      return text.starts_with(text_of_mesh(id));  // its groups too
    };
    if (goes_on && !is_in_file()) refuse(source, "second_mesh");
    if (mesh_id.empty() && !goes_on) text += text_of_mesh(id);
    if (!has_fields(one) || (mesh_id.empty() && !goes_on)) written.add(part("mesh") + " " + base.label(id));
    mesh_id = id;
    if (!has_fields(one)) continue;
    const auto& [source_id, result] = concepts.source(one);
    Means means(result.label, "GMSH");
    each_field(base, result, mesh, one, [&](PrintedField&& printed) {
      means.add(printed.field);
      const std::string name = one.has("CHAM_GD") ? printed.field.name : result.label + "_" + printed.field.name;
      const std::string own = gmsh_view_name(text, name, owner_in_file(base, source_id, printed.field), file);
      text += gmsh_field_text(mesh, printed.field, own);
      written.add(part("field_of", {{"field", printed.field.name}, {"result", result.label}}));
    });
    means.tell();
  }
  TextFiles files;
  files.write(file, text);
  files.commit();
}

/// What an occurrence of RESU shows, or is about.
std::string mesh_of(const Base& base, Concepts& concepts, const Keywords& one) {
  if (one.has("CONTACT")) return base.contact(one.concept_id("CONTACT")).mesh;
  return has_fields(one) ? concepts.source(one).second.mesh : one.concept_id("MAILLAGE");
}

/// INFO_MAILLAGE of files that do not list the mesh themselves: lines of its counts, each mesh once.
void tell_meshes(const Order& order, const Base& base, Concepts& concepts, std::vector<std::string>& lines) {
  std::set<std::string> told;
  for (const Keywords& one : order.keywords.factors("RESU")) {
    if (!one.yes("INFO_MAILLAGE")) continue;
    const std::string id = mesh_of(base, concepts, one);
    if (!told.insert(id).second) continue;
    std::istringstream listed([&] {
      std::ostringstream out;
      list_mesh(out, concepts.mesh(id), true);
      return out.str();
    }());
    lines.push_back(part("mesh") + " " + base.label(id));
    for (std::string line; std::getline(listed, line);) lines.push_back(line);
  }
}

/// Throws IMPR_9 for keywords of listings in the order of another file.
void refuse_words_of_listings(const Order& order) {
  for (const Keywords& one : order.keywords.factors("RESU"))
    for (const char* word : {"IMPR_COOR", "VALE_MAX", "VALE_MIN"})
      if (one.has(word) && one.yes(word))
        fail("IMPR_9", {{"keyword", one.path(word)}, {"format", order.keywords.text("FORMAT")}});
}

}  // namespace

std::vector<std::string> impr_resu(const Order& order, const Base& base) {
  const std::int64_t unit = order.keywords.integer("UNITE");
  fs::path file = order.unit(unit);
  const bool append = order.append.contains(static_cast<int>(unit));
  const std::string format = order.keywords.text("FORMAT");
  Concepts concepts(base);
  Written written;
  std::vector<std::string> lines;
  for (const Keywords& one : order.keywords.factors("RESU"))
    check_own_mesh(base, mesh_of(base, concepts, one), order.keywords, "", "MODELE");
  if (format != "RESULTAT") {
    refuse_words_of_listings(order);
    tell_meshes(order, base, concepts, lines);
  }
  if (format == "MED")
    print_med(order, base, concepts, file, append, written, lines);
  else if (format == "VTU")
    file = print_vtu(order, base, concepts, file, append, written, lines);
  else if (format == "GMSH" || format == "ASTER")
    print_mesh_file(order, base, concepts, file, append, written);
  else
    print_listing(order, base, concepts, file, append, written);
  written.lines(file.string(), lines);
  return lines;
}

}  // namespace lacon
