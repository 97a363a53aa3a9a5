#include "lacon/operators/meshing/skin.hpp"

#include "lacon/operators/meshing/quality.hpp"

namespace lacon {

Side SkinSides::operator[](std::int32_t skin_cell) const {
  const std::vector<BodyCell> found = bodies(skin_cell);
  if (found.size() > 1) return Side::between;
  if (found.empty()) return Side::alone;
  const auto body = static_cast<std::size_t>(found[0].cell);
  const double volume = central_jacobian(mesh_.types[body], mesh_.cells[body], mesh_.coordinates);
  if (volume == 0) return Side::alone;
  return found[0].match.outward == (volume > 0) ? Side::outward : Side::inward;
}

}  // namespace lacon
