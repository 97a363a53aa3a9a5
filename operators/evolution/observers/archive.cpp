#include "lacon/operators/evolution/observers/archive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <nlohmann/json.hpp>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/operators/fields/selection.hpp"
#include "lacon/operators/program/program.hpp"
#include "lacon/structures/hdf5.hpp"
#include "lacon/structures/storage/storage.hpp"

namespace lacon {
namespace {

/// Remove the rows of a table whose INST is behind an instant.
void drop_behind(Table& table, double instant) {
  const auto named = [](const Table::Column& column) { return column.name == "INST"; };
  const std::vector<Table::Cell> instants = std::find_if(table.columns.begin(), table.columns.end(), named)->cells;
  for (Table::Column& column : table.columns) {
    std::vector<Table::Cell> kept;
    for (std::size_t row = 0; row < instants.size(); ++row)
      if (std::get<double>(instants[row]) <= instant) kept.push_back(column.cells[row]);
    column.cells = std::move(kept);
  }
}

}  // namespace

void write(const hdf5::Group& group, const PairedMasters& masters) {
  group.write("offset", masters.offset);
  group.write("cell", masters.cell);
  group.write("share", masters.share);
}

ArchiveChoice::ArchiveChoice(const Keywords& keywords, const Base& base) : instants_(keywords, base, "PAS_ARCH") {
  for (const std::string& name : keywords.texts("CHAM_EXCLU")) excluded_.insert(name);
}

Archive::Archive(const Order& order, const Base& base, const Present& present, const std::optional<Origin>& origin,
                 std::function<std::map<std::string, Table>()> tables, bool resumes)
    : base_(base),
      present_(present),
      fields_(fields_of(present)),
      tables_(std::move(tables)),
      choice_(order.keywords.factor("ARCHIVAGE"), base) {
  const Keywords& keywords = order.keywords;
  result_.label = order.result_label;
  result_.version = base.next_version();
  result_.model = keywords.concept_id("MODELE");
  result_.mesh = present.problem.model.mesh;
  result_.material_field = keywords.concept_id("CHAM_MATER");
  ResultStage& stage = result_.stages.front();
  stage.contact = keywords.optional_concept("CONTACT").value_or("");
  for (const Keywords& excit : keywords.factors("EXCIT"))
    stage.loads.push_back(
        {excit.concept_id("CHARGE"), excit.optional_concept("FONC_MULT").value_or(""), excit.text("TYPE_CHARGE")});
  stage.behaviour = keywords.values().value("COMPORTEMENT", nlohmann::json::array()).dump();
  std::string known;
  for (const auto& [name, make] : fields_) known += (known.empty() ? "" : ", ") + name;
  const Keywords archive = keywords.factor("ARCHIVAGE");
  for (const std::string& name : archive.texts("CHAM_EXCLU"))
    if (!fields_.contains(name) && name != "VARI_ELGA" && name != "CONT_ELEM" && name != "CONT_NOEU")  // which others have
      inform("EVOLUTION_58", {{"keyword", archive.path("CHAM_EXCLU")}, {"name", name}, {"known", known}});
  if (archive.has("DETR_NUME_SUIV") && !order.reuse) inform("EVOLUTION_62", {{"keyword", archive.path("DETR_NUME_SUIV")}});
  if (!resumes && (order.reuse || keywords.has("RESULTAT"))) go_on(order, origin);
  if (!resumes) number_zones();
}

void Archive::go_on(const Order& order, const std::optional<Origin>& origin) {
  const auto refuse = [&](const std::string& reason, const std::string& remedy) {
    fail("EVOLUTION_12", {{"label", result_.label}, {"reason", reason}, {"remedy", remedy}});
  };
  if (!order.reuse) refuse(part("result_without_reuse"), part("give_reuse_too"));
  if (!origin || order.keywords.factor("ETAT_INIT").concept_id("EVOL_NOLI") != order.result_id)
    refuse(part("state_not_from_result"), part("give_state", {{"label", result_.label}}));
  const Result& old = origin->result;
  const auto differs = [&](const std::string& what) {
    refuse(part("computed_with_another", {{"what", what}}), part("result_of_its_own"));
  };
  if (old.model != result_.model) differs("MODELE");
  if (old.material_field != result_.material_field) differs("CHAM_MATER");
  std::vector<std::int64_t> orders = old.orders;
  orders.erase(std::upper_bound(orders.begin(), orders.end(), origin->order), orders.end());
  if (orders.size() < old.orders.size() && !order.keywords.factor("ARCHIVAGE").has("DETR_NUME_SUIV"))
    refuse(part("instants_behind_order",
                {{"count", std::to_string(old.orders.size() - orders.size())}, {"order", std::to_string(origin->order)}}),
           part("remove_instants_behind"));
  const auto fields = old.fields;
  const std::int64_t version = result_.version;
  ResultStage stage = result_.stages.front();
  result_ = part_of(old, orders);
  result_.version = version;
  stage.first = origin->order + 1;
  const ResultStage& last = result_.stages.back();
  if (stage.contact != last.contact || stage.loads != last.loads || stage.behaviour != last.behaviour)
    result_.stages.push_back(std::move(stage));
  for (const auto& [name, files] : fields)
    for (const auto& [number, file] : files)
      if (number <= origin->order) result_.fields[name][number] = file;
  taken_over_ = result_.orders.size();
  for (auto& [name, table] : result_.tables) drop_behind(table, result_.instants.back());
}

/// A slave group has the same number at all instants, whatever the order of zones in the contact of a stage.
void Archive::number_zones() {
  if (!present_.problem.contact) return;
  const auto first = std::ranges::find_if(result_.stages, [](const ResultStage& stage) { return !stage.contact.empty(); });
  const std::vector<ContactZone> known = base_.contact(first->contact).zones;
  for (const ContactZone& zone : present_.problem.contact->zones)
    zone_numbers_.push_back(
        static_cast<std::size_t>(std::ranges::find(known, zone.slave_group, &ContactZone::slave_group) - known.begin()));
}

void Archive::start(double instant) {
  if (taken_over_ == 0) add(instant, 0);  // otherwise the initial state is an instant of the result that goes on
}

void Archive::begin(double /*instant*/) { pivots_ = {}; }

void Archive::iterate(double /*instant*/, const IterationReport& report) {
  if (const auto& found = report.solution.factorisation.negative_pivots) pivots_ = {*found, report.constraints};
}

void Archive::accept(const SolvedInstant& solved) {
  if (!choice_.keeps(solved.instant, solved.step) && !solved.last) return;
  add(solved.instant, solved.iterations);
  store(false);
}

void Archive::save(const hdf5::Group& group) const {
  group.set("label", result_.label);
  group.set("version", result_.version);
  group.set("taken_over", static_cast<std::int64_t>(taken_over_));
  storage::write(group, result_);
}

void Archive::resume(const hdf5::Group& group) {
  result_ = storage::read_result(group);
  result_.version = group.integer("version");
  number_zones();
  const hdf5::Reader found(base_.result_folder() / "index.h5");
  if (found.integer("version") == result_.version) there_ = found.shape("order").at(0);
  taken_over_ = static_cast<std::size_t>(group.integer("taken_over"));
  inform("EVOLUTION_32", {{"label", result_.label}, {"instant", fmt::format("{:.9g}", result_.instants.back())}});
  stored_ = true;
  store(false);
}

void Archive::end(bool completed) {
  if (completed)
    store(true);
  else if (!stored_ && taken_over_ == 0)
    discard();
}

void Archive::discard() {
  std::error_code error;
  for (const auto& [order, file] : result_.fields["CONT_ELEM"])
    std::filesystem::remove(path_of_masters(base_.folder() / file), error);
  base_.discard(result_);
}

void Archive::store(bool complete) {
  if (result_.orders.size() < there_) return;
  const Phase phase("archive");
  Result result = result_;
  result.complete = complete;
  for (const auto& [name, table] : tables_()) add_table(result, name, table);
  base_.store(result);
  stored_ = true;
}

void Archive::add(double instant, int iterations) {
  const Phase phase("archive");
  const std::int64_t number = result_.orders.empty() ? 0 : result_.orders.back() + 1;
  for (const auto& [name, make] : fields_) {
    if (!choice_.keeps(name)) continue;
    FieldRows rows = make();
    rows.field.order = number;
    rows.field.instant = instant;
    base_.add_field(result_, std::move(rows));
  }
  add_masters(number);
  if (present_.contact) add_balance(present_.contact->balance(present_.state.patches));
  put("newton_iterations", iterations);
  put("negative_pivots", static_cast<double>(pivots_.found));
  put("expected_negative_pivots", static_cast<double>(pivots_.expected));
  result_.orders.push_back(number);
  result_.instants.push_back(instant);
  for (auto& [name, values] : result_.parameters)  // of zones, where only other stages have a contact
    values.resize(result_.orders.size(), std::numeric_limits<double>::quiet_NaN());
}

/// A value of the instant that is being added.
void Archive::put(const std::string& parameter, double value) {
  std::vector<double>& values = result_.parameters[parameter];
  values.resize(result_.orders.size(), std::numeric_limits<double>::quiet_NaN());
  values.push_back(value);
}

/// Beside CONT_ELEM: what its patches were paired with, for who looks at it, and which of them keep their cover.
void Archive::add_masters(std::int64_t number) {
  if (!present_.contact || !choice_.keeps("CONT_ELEM")) return;
  const std::filesystem::path field = base_.folder() / result_.fields.at("CONT_ELEM").at(number);
  hdf5::write_sealed_at_once(path_of_masters(field), [&](const hdf5::Group& root) {
    root.set("lacon_type", std::string_view("masters"));
    root.set("format", storage::format);
    write(root, paired_masters(present_.problem.mesh, *present_.problem.contact, present_.contact->geometry()));
    std::vector<std::int64_t> kept;
    for (std::size_t p = 0; p < present_.contact->n_patches(); ++p)
      if (present_.contact->keeps_cover(p)) kept.push_back(static_cast<std::int64_t>(p));
    if (!kept.empty()) root.write("kept_covers", kept);
    write(root, present_.contact->geometry().kept());
  });
}

/// The proof lines as parameters of the instant: zone_1_slave_force_x, ...
void Archive::add_balance(const std::vector<ZoneBalance>& zones) {
  for (std::size_t z = 0; z < zones.size(); ++z) {
    const std::string name = "zone_" + std::to_string(zone_numbers_[z] + 1) + "_";
    const auto put = [&](const std::string& what, double value) { this->put(name + what, value); };
    for (int d = 0; d < 3; ++d) {
      const std::string axis(1, "xyz"[d]);
      put("slave_force_" + axis, component(zones[z].on_slave, d));
      put("master_force_" + axis, component(zones[z].on_master, d));
      put("moment_" + axis, component(zones[z].moment, d));
    }
    put("active", static_cast<double>(zones[z].active));
    put("open", static_cast<double>(zones[z].open));
    put("unpaired", static_cast<double>(zones[z].unpaired));
    put("covered", zones[z].covered);
    put("whole", zones[z].whole);
    put("largest_lambda_gap", zones[z].work);
  }
}

/// Behind what the result that goes on has in that table; NUME_REUSE counts its computations.
void Archive::add_table(Result& result, const std::string& name, const Table& table) {
  const auto [at, first] = result.tables.try_emplace(name, table);
  if (first) return;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    Table::Column& column = at->second.columns[c];
    std::vector<Table::Cell> cells = table.columns[c].cells;
    if (column.name == "NUME_REUSE" && !column.cells.empty())
      cells.assign(cells.size(), std::get<std::int64_t>(column.cells.back()) + 1);
    column.cells.insert(column.cells.end(), cells.begin(), cells.end());
  }
}

}  // namespace lacon
