#pragma once
// The keywords of every command: rows of commands/*.toml, as much of them as an operator needs to check its order.
#include <span>
#include <string_view>

namespace lacon::catalog {

struct KeywordRow {
  std::string_view command;
  std::string_view path;  ///< "ZONE/GROUP_MA_ESCL"
  std::string_view type;  ///< "factor", "text", "real", ...
  bool mandatory;
  bool has_default;
  bool multiple;  ///< a list in the order
};

/// Rows of one command follow each other; a factor keyword comes before what it holds.
std::span<const KeywordRow> keywords();

}  // namespace lacon::catalog
