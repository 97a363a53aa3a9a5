// What pairing in the plane and in space have in common.
#include "lacon/pairing/pairing.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "lacon/pairing/detail.hpp"

namespace lacon {
namespace {

void check(const Surface& surface, int dimension) {
  if (surface.dimension != dimension)
    throw std::invalid_argument("pairing: a surface of dimension " + std::to_string(surface.dimension) +
                                " cannot be paired with one of dimension " + std::to_string(dimension));
  if (dimension != 2 && dimension != 3)
    throw std::invalid_argument("pairing: surfaces of dimension " + std::to_string(dimension) + " cannot be paired");
  for (const CellType type : surface.types)
    if (catalog::cell(type).dimension != dimension - 1)
      throw std::invalid_argument("pairing: a cell " + std::string(catalog::cell(type).name) + " cannot be paired " +
                                  (dimension == 2 ? "in the plane" : "in space"));
}

}  // namespace

namespace detail {

bool finite(const Surface& surface, std::size_t cell) {
  return std::all_of(surface.nodes[cell].begin(), surface.nodes[cell].end(), [&](std::int32_t node) {
    for (int d = 0; d < surface.dimension; ++d)
      if (!std::isfinite(surface.coordinates[3 * node + d]) ||
          (!surface.normals.empty() && !std::isfinite(surface.normals[3 * node + d])))
        return false;
    return true;
  });
}

double smallest_cosine(const PairingOptions& options) {
  return options.largest_angle < 90 ? std::cos(options.largest_angle * std::numbers::pi / 180) : -1;
}

}  // namespace detail

std::string_view rejection_name(Rejection rejection) {
  static constexpr std::string_view names[n_rejections] = {"facing away",       "hidden",   "sliver",  "degenerate slave",
                                                           "degenerate master", "no image", "too far", "too steep"};
  return names[static_cast<std::size_t>(rejection)];
}

Pairing pair(const Surface& slave, const Surface& master, const PairingOptions& options) {
  Pairing whole;
  pair_in_blocks(slave, master, options, std::max<std::size_t>(slave.size(), 1),
                 [&](Pairing& pairing) { whole = std::move(pairing); });
  return whole;
}

void pair_in_blocks(const Surface& slave, const Surface& master, const PairingOptions& options, std::size_t block,
                    const std::function<void(Pairing&)>& take) {
  check(slave, slave.dimension);
  check(master, slave.dimension);
  Pairing pairing;
  pairing.cells.dimension = slave.dimension;
  const detail::EndOfCell end_of_cell = [&](std::size_t done) {
    if (done % block != 0 && done != slave.size()) return;
    std::vector<RejectedCouple>& rejected = pairing.rejected;
    std::sort(rejected.begin(), rejected.end());  // a search meets couples in its own order, and parts of one several times
    rejected.erase(std::unique(rejected.begin(), rejected.end()), rejected.end());
    take(pairing);
    pairing.cells.clear();
    rejected.clear();
  };
  (slave.dimension == 2 ? detail::pair_in_plane : detail::pair_in_space)(slave, master, options, pairing, end_of_cell);
  if (slave.size() == 0) end_of_cell(0);
}

}  // namespace lacon
