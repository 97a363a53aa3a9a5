#include <algorithm>

#include "lacon/catalog/cells.hpp"
#include "lacon/catalog/contact.hpp"
#include "lacon/catalog/cuts.hpp"
#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/refinements.hpp"
#include "lacon/catalog/text.hpp"

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

}  // namespace

Message message(std::string_view id, std::initializer_list<MessageValue> values) {
  for (const catalog::MessageRow& row : catalog::messages())
    if (row.id == id) return {row.severity, std::string(id), fill(row.text, id, values), fill(row.advice, id, values)};
  throw std::logic_error("message " + std::string(id) + " is not in the catalogue");
}

void fail(std::string_view id, std::initializer_list<MessageValue> values) { throw Error(message(id, values)); }

void set_message_sink(MessageSink new_sink) { sink = new_sink ? new_sink : ignore; }

void inform(std::string_view id, std::initializer_list<MessageValue> values) { sink(message(id, values)); }
void inform(const Message& said) { sink(said); }

}  // namespace lacon
