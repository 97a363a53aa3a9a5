#pragma once
// Physical quantities with their components, and what fields of results hold: rows of quantities.toml.
#include <span>
#include <string_view>

namespace lacon::catalog {

struct QuantityRow {
  std::string_view name;
  std::span<const std::string_view> components;
};

/// A field of results that goes by this name is of one of these types, "NOEU_DEPL_R".
struct ResultFieldRow {
  std::string_view name;
  std::span<const std::string_view> types;
};

std::span<const QuantityRow> quantities();
std::span<const ResultFieldRow> result_fields();

}  // namespace lacon::catalog
