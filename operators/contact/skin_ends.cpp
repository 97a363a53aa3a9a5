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
      zone.neighbours = edge_neighbours(zone.master);
      zone.planes = end_planes(zone.slave, zone.master, held);
    }
  mirror();
}

void ContactGeometry::mirror() {
  for (Zone& zone : zones_) {
    zone.mirrored = mirrored_edges(zone.planes, zone.master, rest_);
    zone.flush.clear();
    if (zone.goes_on_flush) zone.flush = flush_edges(zone.planes, zone.master, rest_);
    add_flush(zone);
  }
}

void ContactGeometry::add_flush(Zone& zone) {
  add_bits(zone.flush, zone.mirrored);
  zone.master.mirrored = zone.mirrored;
}

bool ContactGeometry::go_on_where_flush() {
  bool any = false;
  for (Zone& zone : zones_)
    if (add_bits(flush_edges(zone.planes, zone.master, coordinates_), zone.flush)) {
      any = zone.goes_on_flush = true;
      add_flush(zone);
    }
  if (any) look();
  return any;
}

}  // namespace lacon
