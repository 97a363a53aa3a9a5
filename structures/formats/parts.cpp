#include "lacon/structures/formats/parts.hpp"

#include <algorithm>

namespace lacon {

std::vector<FieldPart> parts_of(const Field& field) {
  std::vector<FieldPart> parts;
  if (field.present.empty() && field.n_rows() > 0) {
    FieldPart& whole = parts.emplace_back(FieldPart{{}, std::vector<std::uint8_t>(field.n_rows(), 1)});
    for (std::size_t k = 0; k < field.n_components(); ++k) whole.components.push_back(k);
    return parts;
  }
  for (std::size_t k = 0; k < field.n_components(); ++k) {
    std::vector<std::uint8_t> rows(field.n_rows());
    for (std::size_t r = 0; r < rows.size(); ++r) rows[r] = field.has(r, k) ? 1 : 0;
    if (std::find(rows.begin(), rows.end(), 1) == rows.end()) continue;
    const auto same = std::find_if(parts.begin(), parts.end(), [&](const FieldPart& part) { return part.rows == rows; });
    if (same == parts.end())
      parts.push_back({{k}, std::move(rows)});
    else
      same->components.push_back(k);
  }
  return parts;
}

std::string part_name(const Field& field, const FieldPart& part, std::string_view name) {
  std::string text(name);
  const std::vector<FieldPart> parts = parts_of(field);
  if (parts.front().components != part.components)
    for (const std::size_t k : part.components) text += "_" + field.components[k];
  return text;
}

}  // namespace lacon
