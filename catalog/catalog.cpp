#include <algorithm>
#include <cstdlib>

#include "lacon/catalog/cells.hpp"
#include "lacon/catalog/contact.hpp"
#include "lacon/catalog/cuts.hpp"
#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/refinements.hpp"
#include "lacon/catalog/text.hpp"
#include "lacon/catalog/wording.hpp"

namespace lacon::catalog {

std::optional<CellType> find_cell(std::string_view name) {
  for (const CellRow& row : cells())
    if (row.name == name) return row.type;
  return std::nullopt;
}

const PatchRow* find_patch(int kind) {
  for (const PatchRow& row : patches())
    if (row.kind == kind) return &row;
  return nullptr;
}

const SlaveRow* find_slave(int kind, int rank) {
  for (const SlaveRow& row : slaves())
    if (row.kind == kind && row.rank == rank) return &row;
  return nullptr;
}

const CutRow* find_cut(CellType skin, CellType body, std::string_view option) {
  for (const CutRow& row : cuts())
    if (row.skin == skin && row.body == body && (row.option.empty() || row.option == option)) return &row;
  return nullptr;
}

const RefinementRow* find_refinement(CellType cell) {
  for (const RefinementRow& row : refinements())
    if (row.cell == cell) return &row;
  return nullptr;
}

}  // namespace lacon::catalog

namespace lacon {
namespace {

void ignore(const Message&) {}
MessageSink sink = ignore;

/// `text` with every {name} replaced by its value.
std::string fill(std::string_view text, std::string_view id, std::initializer_list<MessageValue> values) {
  std::string filled;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text[at] == '{' ? text.find('}', at) : std::string_view::npos;
    if (end == std::string_view::npos) {
      filled += text[at++];
      continue;
    }
    const std::string_view name = text.substr(at + 1, end - at - 1);
    const auto value = std::find_if(values.begin(), values.end(), [&](const MessageValue& v) { return v.first == name; });
    if (value == values.end())
      throw std::logic_error("message " + std::string(id) + " misses a value for {" + std::string(name) + "}");
    filled += as_utf8(value->second);  // damaged names too are text that can be shown
    at = end + 1;
  }
  return filled;
}

/// The row of this name; null without one.
template <typename Row>
const Row* find(std::span<const Row> rows, std::string_view Row::*key, std::string_view name) {
  const auto found = std::find_if(rows.begin(), rows.end(), [&](const Row& row) { return row.*key == name; });
  return found == rows.end() ? nullptr : &*found;
}

bool in_french() {
  static const bool french = [] {
    for (const char* const variable : {"LC_ALL", "LC_MESSAGES", "LANG"})
      if (const char* const value = std::getenv(variable); value && *value) return std::string_view(value).starts_with("fr");
    return false;
  }();
  return french;
}

}  // namespace

Message message(std::string_view id, std::initializer_list<MessageValue> values) {
  const catalog::MessageRow* const row = find(catalog::messages(), &catalog::MessageRow::id, id);
  if (!row) throw std::logic_error("message " + std::string(id) + " is not in the catalogue");
  const catalog::WordingRow* const french =
      in_french() ? find(catalog::french_messages(), &catalog::WordingRow::id, id) : nullptr;
  return {row->severity, std::string(id), fill(french ? french->text : row->text, id, values),
          fill(french ? french->advice : row->advice, id, values)};
}

std::string part(std::string_view name, std::initializer_list<MessageValue> values) {
  const catalog::PartRow* const row = find(catalog::parts(), &catalog::PartRow::name, name);
  if (!row) throw std::logic_error("the part " + std::string(name) + " of messages is not in the catalogue");
  return fill(in_french() ? row->french : row->english, name, values);
}

void fail(std::string_view id, std::initializer_list<MessageValue> values) { throw Error(message(id, values)); }

void set_message_sink(MessageSink new_sink) { sink = new_sink ? new_sink : ignore; }

void inform(std::string_view id, std::initializer_list<MessageValue> values) { sink(message(id, values)); }
void inform(const Message& said) { sink(said); }

}  // namespace lacon
