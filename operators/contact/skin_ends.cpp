// Where both skins of a zone end in one plane, as a computation goes on.
#include <span>
#include <vector>

#include "lacon/operators/contact/contact_geometry.hpp"

namespace lacon {
namespace {

/// @return whether that has changed `all`
bool add_bits(std::span<const std::uint8_t> more, std::vector<std::uint8_t>& all) {
  bool any = false;
  if (all.size() < more.size()) all.resize(more.size(), 0);
  for (std::size_t i = 0; i < more.size(); ++i) {
    any = any || (more[i] & ~all[i]) != 0;
    all[i] |= more[i];
  }
  return any;
}

}  // namespace

void ContactGeometry::find_ends(std::span<const HeldDirection> held) {
  if (!contact_.frozen_gap)
    for (Zone& zone : zones_) {
      zone.border = border_edges(zone.master);
      zone.planes = end_planes(zone.slave, zone.master, held);
    }
  mirror();
}

void ContactGeometry::mirror() {
  for (Zone& zone : zones_) {
    zone.mirrored = mirrored_edges(zone.planes, zone.master, rest_);
    if (zone.goes_on_flush) add_bits(flush_edges(zone.planes, zone.master, rest_), zone.mirrored);
    zone.master.mirrored = zone.mirrored;
  }
}

bool ContactGeometry::go_on_where_flush() {
  bool any = false;
  for (Zone& zone : zones_)
    if (add_bits(flush_edges(zone.planes, zone.master, coordinates_), zone.mirrored)) {
      zone.master.mirrored = zone.mirrored;
      any = zone.goes_on_flush = true;
    }
  if (any) look();
  return any;
}

std::vector<std::int32_t> ContactGeometry::flush() const {
  std::vector<std::int32_t> all;
  for (const Zone& zone : zones_) all.push_back(zone.goes_on_flush ? 1 : 0);
  return all;
}

void ContactGeometry::set_flush(std::span<const std::int32_t> zones) {
  for (std::size_t z = 0; z < zones.size(); ++z) zones_[z].goes_on_flush = zones[z] != 0;
  mirror();
}

}  // namespace lacon
