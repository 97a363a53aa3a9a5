#pragma once
// The words of messages in the user's language: French where the first of LC_ALL, LC_MESSAGES and LANG that is set begins with
// "fr", otherwise English.
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>

#include "lacon/catalog/messages.hpp"

namespace lacon {

/// What a text is made of that is no message by itself: the row `name` of messages/parts.toml with its gaps filled. A name or a
/// gap that does not exist is a defect: std::logic_error.
std::string part(std::string_view name, std::initializer_list<MessageValue> values = {});

}  // namespace lacon

namespace lacon::catalog {

/// The words of a message (by its identifier) in another language.
struct WordingRow {
  std::string_view id;
  std::string_view text;
  std::string_view advice;
};

struct PartRow {
  std::string_view name;
  std::string_view english;
  std::string_view french;
};

std::span<const WordingRow> french_messages();
std::span<const PartRow> parts();

}  // namespace lacon::catalog
