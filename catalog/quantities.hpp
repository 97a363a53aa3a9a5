#pragma once
// Physical quantities and their components: rows of quantities.toml.
#include <span>
#include <string_view>

namespace lacon::catalog {

struct QuantityRow {
  std::string_view name;
  std::span<const std::string_view> components;
};

std::span<const QuantityRow> quantities();

}  // namespace lacon::catalog
