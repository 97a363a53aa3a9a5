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

std::vector<std::int32_t> ContactGeometry::flush() const {
  std::vector<std::int32_t> all;
  for (std::int32_t z = 0; const Zone& zone : zones_) {
    if (zone.goes_on_flush) all.insert(all.end(), {z, -1, 0});
    for (std::size_t cell = 0; cell < zone.flush.size(); ++cell)
      if (zone.flush[cell] != 0) all.insert(all.end(), {z, static_cast<std::int32_t>(cell), zone.flush[cell]});
    ++z;
  }
  return all;
}

void ContactGeometry::set_flush(std::span<const std::int32_t> edges) {
  for (std::size_t i = 0; i + 2 < edges.size(); i += 3) {
    Zone& zone = zones_.at(static_cast<std::size_t>(edges[i]));
    zone.goes_on_flush = true;
    if (edges[i + 1] < 0) continue;
    zone.flush.resize(zone.master.size(), 0);
    zone.flush.at(static_cast<std::size_t>(edges[i + 1])) |= static_cast<std::uint8_t>(edges[i + 2]);
    add_flush(zone);
  }
}

}  // namespace lacon
