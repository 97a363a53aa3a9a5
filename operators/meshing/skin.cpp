#include "lacon/operators/meshing/skin.hpp"

#include "lacon/operators/meshing/quality.hpp"

namespace lacon {

Side SkinSides::operator[](std::int32_t skin_cell) const {
  const std::vector<BodyCell> bodies = body_cells(mesh_, around_, static_cast<std::size_t>(skin_cell));
  if (bodies.size() > 1) return Side::between;
  if (bodies.empty()) return Side::alone;
  const auto body = static_cast<std::size_t>(bodies[0].cell);
  const double volume = central_jacobian(mesh_.types[body], mesh_.cells[body], mesh_.coordinates);
  if (volume == 0) return Side::alone;
  return bodies[0].match.outward == (volume > 0) ? Side::outward : Side::inward;
}

}  // namespace lacon
