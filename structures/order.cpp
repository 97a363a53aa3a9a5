#include "lacon/structures/order.hpp"

#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <utility>

#include "lacon/catalog/keywords.hpp"
#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"

namespace lacon {
namespace {

using nlohmann::json;

constexpr int deepest = 64;  // lists and objects within each other: an order has six

[[noreturn]] void wrong_type(const std::string& keyword, const std::string& expected) {
  fail("ORDER_4", {{"keyword", keyword}, {"expected", expected}});
}

/// Names directly below `prefix` ("" or "ZONE/") in the rows of a command.
struct Level {
  std::string_view command;
  std::string prefix;

  template <class Visit>
  void each(Visit visit) const {
    for (const catalog::KeywordRow& row : catalog::keywords())
      if (row.command == command && row.path.starts_with(prefix) && row.path.find('/', prefix.size()) == std::string_view::npos)
        visit(row, std::string(row.path.substr(prefix.size())));
  }
};

/// An order is complete (mandatory keywords, defaults) and holds only known keywords. Defaults inside a factor keyword count
/// only where it is given. `place` names the occurrence in messages.
void check(const json& keywords, const Level& level, const std::string& place) {
  std::set<std::string> known;
  level.each([&](const catalog::KeywordRow& row, const std::string& name) {
    known.insert(name);
    if (!keywords.contains(name)) {
      if (row.mandatory || (row.has_default && row.type != "factor")) fail("ORDER_2", {{"keyword", place + name}});
      return;
    }
    const json& value = keywords[name];
    if (row.type == "factor") {
      if (!value.is_array()) wrong_type(place + name, part("list_of_occurrences"));
      for (std::size_t i = 0; i < value.size(); ++i) {
        if (!value[i].is_object()) wrong_type(place + name, part("list_of_occurrences"));
        check(value[i], {level.command, level.prefix + name + "/"}, place + name + "[" + std::to_string(i + 1) + "]/");
      }
    } else if (row.multiple != value.is_array()) {
      wrong_type(place + name, part(row.multiple ? "a_list" : "a_single_value"));
    }
  });
  for (const auto& [name, value] : keywords.items())
    if (!known.contains(name)) fail("ORDER_3", {{"keyword", place + name}, {"command", std::string(level.command)}});
}

template <class T>
T get(const json& value, bool fits, const std::string& path, const char* expected) {
  if (!fits) wrong_type(path, part(expected));
  return value.get<T>();
}

/// Whether a number is an integer that 64 bits with a sign hold.
bool is_integer(const json& value) {
  return value.is_number_integer() &&
         !(value.is_number_unsigned() && value.get<std::uint64_t>() > std::numeric_limits<std::int64_t>::max());
}

std::string id_of(const json& value, const std::string& path) {
  if (!value.is_object() || !value.contains("concept") || !value["concept"].is_string()) wrong_type(path, part("a_concept"));
  return value["concept"].get<std::string>();
}

}  // namespace

Keywords::Keywords() : Keywords(json::object(), "") {}

Keywords::Keywords(json values, std::string prefix)
    : values_(std::make_shared<const json>(std::move(values))), prefix_(std::move(prefix)) {}

bool Keywords::has(std::string_view name) const { return values_->contains(name); }

bool Keywords::is_concept(std::string_view name) const { return has(name) && value(name).is_object(); }

const json& Keywords::value(std::string_view name) const {
  const auto at = values_->find(name);
  if (at == values_->end()) fail("ORDER_2", {{"keyword", path(name)}});
  return *at;
}

double Keywords::real(std::string_view name) const {
  const json& v = value(name);
  return get<double>(v, v.is_number(), path(name), "a_number");
}

std::int64_t Keywords::integer(std::string_view name) const {
  const json& v = value(name);
  return get<std::int64_t>(v, is_integer(v), path(name), "an_integer");
}

std::string Keywords::text(std::string_view name) const {
  const json& v = value(name);
  return get<std::string>(v, v.is_string(), path(name), "a_text");
}

std::vector<double> Keywords::reals(std::string_view name) const {
  std::vector<double> items;
  if (has(name))
    for (const json& v : value(name)) items.push_back(get<double>(v, v.is_number(), path(name), "list_of_numbers"));
  return items;
}

Vec3 Keywords::vector(std::string_view name, int dimension) const {
  std::vector<double> given = reals(name);
  if (given.size() != static_cast<std::size_t>(dimension))
    fail("KEYWORD_18",
         {{"keyword", path(name)}, {"expected", part("a_number_for_each_dimension", {{"count", std::to_string(dimension)}})}});
  given.resize(3, 0.0);
  return vector_at(given.data());
}

std::vector<std::int64_t> Keywords::integers(std::string_view name) const {
  std::vector<std::int64_t> items;
  if (has(name))
    for (const json& v : value(name)) items.push_back(get<std::int64_t>(v, is_integer(v), path(name), "list_of_whole_numbers"));
  return items;
}

std::vector<std::string> Keywords::texts(std::string_view name) const {
  std::vector<std::string> items;
  if (!has(name)) return items;
  if (value(name).is_string()) return {text(name)};
  for (const json& v : value(name)) items.push_back(get<std::string>(v, v.is_string(), path(name), "list_of_texts"));
  return items;
}

std::string Keywords::concept_id(std::string_view name) const { return id_of(value(name), path(name)); }

std::optional<double> Keywords::optional_real(std::string_view name) const {
  return has(name) ? std::optional(real(name)) : std::nullopt;
}

std::optional<std::int64_t> Keywords::optional_integer(std::string_view name) const {
  return has(name) ? std::optional(integer(name)) : std::nullopt;
}

std::optional<std::string> Keywords::optional_concept(std::string_view name) const {
  if (!has(name)) return std::nullopt;
  return concept_id(name);
}

std::vector<std::string> Keywords::concept_ids(std::string_view name) const {
  std::vector<std::string> ids;
  if (!has(name)) return ids;
  if (value(name).is_object()) return {concept_id(name)};
  for (const json& v : value(name)) ids.push_back(id_of(v, path(name)));
  return ids;
}

std::vector<Keywords> Keywords::factors(std::string_view name) const {
  std::vector<Keywords> occurrences;
  if (!has(name)) return occurrences;
  const json& list = value(name);
  for (std::size_t i = 0; i < list.size(); ++i)
    occurrences.emplace_back(list[i], path(name) + (list.size() > 1 ? "[" + std::to_string(i + 1) + "]/" : "/"));
  return occurrences;
}

Keywords Keywords::factor(std::string_view name) const {
  const std::vector<Keywords> occurrences = factors(name);
  if (occurrences.size() != 1) fail("KEYWORD_18", {{"keyword", path(name)}, {"expected", part("given_once")}});
  return occurrences.front();
}

std::filesystem::path Order::unit(std::int64_t number) const {
  const auto at = units.find(static_cast<int>(number));
  if (at == units.end()) fail("ORDER_5", {{"unit", std::to_string(number)}});
  return at->second;
}

Order parse_order(const json& order, const std::string& file) {
  const auto refuse = [&](const std::string& reason) { fail("ORDER_1", {{"file", file}, {"reason", reason}}); };
  Order parsed;
  try {
    if (order.at("format") != 1) refuse(part("order_of_another_format"));
    parsed.command = order.at("command").get<std::string>();
    parsed.base = order.at("base").get<std::string>();
    if (order.contains("result")) {
      parsed.result_id = order["result"].at("id").get<std::string>();
      parsed.result_label = order["result"].value("label", parsed.result_id);
      parsed.reuse = order["result"].value("reuse", false);
      parsed.resume = order["result"].value("resume", false);
    }
    const json units = order.value("units", json::object());  // named: items() refers to it
    for (const auto& [unit, path] : units.items()) parsed.units[std::stoi(unit)] = path.get<std::string>();
    for (const json& unit : order.value("append", json::array())) parsed.append.insert(std::stoi(unit.get<std::string>()));
    for (const json& folder : order.value("plugins", json::array())) parsed.plugins.emplace_back(folder.get<std::string>());
    parsed.source = order.value("source", file);
    parsed.keywords = Keywords(order.at("keywords"), "");
  } catch (const json::exception& error) {
    refuse(error.what());
  } catch (const std::logic_error&) {  // of std::stoi
    refuse(part("unit_is_no_number"));
  }
  if (!parsed.keywords.values().is_object()) refuse(part("keywords_are_no_object"));
  bool known = false;
  for (const catalog::KeywordRow& row : catalog::keywords()) known = known || row.command == parsed.command;
  if (!known) refuse(part("order_of_no_command", {{"command", parsed.command}}));
  check(parsed.keywords.values(), {parsed.command, ""}, "");
  return parsed;
}

Order read_order(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream) fail("ORDER_1", {{"file", file.string()}, {"reason", part("it_cannot_be_opened")}});
  const auto not_too_deep = [&](int depth, json::parse_event_t, const json&) {
    if (depth > deepest) fail("ORDER_1", {{"file", file.string()}, {"reason", part("nested_too_deeply")}});
    return true;
  };
  const json order = json::parse(stream, not_too_deep, false);
  if (order.is_discarded()) fail("ORDER_1", {{"file", file.string()}, {"reason", part("it_is_not_json")}});
  return parse_order(order, file.string());
}

}  // namespace lacon
