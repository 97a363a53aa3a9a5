#include "lacon/operators/contact/kept_pairing.hpp"

#include <map>
#include <set>
#include <utility>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/operators/contact/contact_geometry.hpp"
#include "lacon/structures/hdf5.hpp"

namespace lacon {

void write(const hdf5::Group& group, const KeptPairing& kept) {
  if (!kept.left_out.empty()) group.write("left_out", kept.left_out);
  if (!kept.in_front.empty()) group.write("in_front", kept.in_front);
  if (!kept.flush.empty()) group.write("flush", kept.flush);
}

KeptPairing read_kept_pairing(const hdf5::Group& group) {
  KeptPairing kept;
  if (group.has("left_out")) kept.left_out = group.read<std::int32_t>("left_out");
  if (group.has("in_front")) kept.in_front = group.read<std::int32_t>("in_front");
  if (group.has("flush")) kept.flush = group.read<std::int32_t>("flush");
  return kept;
}

KeptContact read_kept_contact(const std::filesystem::path& field, std::string_view without) {
  const std::filesystem::path masters = path_of_masters(field);
  std::error_code error;
  if (!std::filesystem::exists(masters, error)) return {};
  try {
    const hdf5::Reader root(masters);
    if (const std::string found = root.text("lacon_type"); found != "masters")
      fail("BASE_7", {{"file", masters.string()}, {"found", found}, {"expected", "masters"}});
    KeptContact kept;
    if (root.has("kept_covers")) kept.covers = root.read<std::int64_t>("kept_covers");
    kept.pairing = read_kept_pairing(root);
    return kept;
  } catch (const Error& damage) {
    inform("BASE_8", {{"reason", damage.message().text}, {"without", part(without)}});
    return {};
  }
}

std::filesystem::path path_of_masters(std::filesystem::path field) { return field.replace_extension(".masters.h5"); }

KeptPairing ContactGeometry::kept() const {
  KeptPairing kept;
  for (const PatchMaster& one : left_out_.far) kept.left_out.insert(kept.left_out.end(), {one.patch, one.master});
  for (const PatchMaster& one : left_out_.in_front) kept.in_front.insert(kept.in_front.end(), {one.patch, one.master});
  for (const Zone& zone : zones_) {
    if (!zone.goes_on_flush) continue;
    const std::int32_t patch = contact_.slaves[zone.slaves.front()].patch;
    kept.flush.insert(kept.flush.end(), {patch, -1, 0});
    for (std::size_t cell = 0; cell < zone.flush.size(); ++cell)
      if (zone.flush[cell] != 0) kept.flush.insert(kept.flush.end(), {patch, zone.masters[cell], zone.flush[cell]});
  }
  return kept;
}

void ContactGeometry::keep(const KeptPairing& kept) {
  if (contact_.frozen_gap) return;
  const auto zone_of = [&](std::int32_t patch) -> Zone* {
    const bool here = patch >= 0 && static_cast<std::size_t>(patch) < n_patches() && zone_of_[patch] >= 0;
    return here ? &zones_[zone_of_[patch]] : nullptr;
  };
  const auto place = [](const Zone* zone, std::int32_t master) {
    const auto at = zone->places.find(master);
    return at == zone->places.end() ? -1 : at->second;
  };
  LeftOut left_out;
  const auto for_known = [&](const std::vector<std::int32_t>& pairs, const auto& visit) {
    for (std::size_t i = 0; i + 1 < pairs.size(); i += 2)
      if (const Zone* const zone = zone_of(pairs[i]); zone && place(zone, pairs[i + 1]) >= 0)
        visit(*zone, pairs[i], place(zone, pairs[i + 1]));
  };
  for_known(kept.left_out, [&](const Zone& zone, std::int32_t patch, std::int32_t master) {
    left_out.far.insert({patch, zone.masters[master]});
  });
  for_known(kept.in_front, [&](const Zone& zone, std::int32_t patch, std::int32_t master) {
    left_out.in_front.insert({patch, zone.masters[zone.faces[master]]});
  });
  left_out_at_rest_ = left_out;
  leave_out(std::move(left_out));
  for (std::size_t i = 0; i + 2 < kept.flush.size(); i += 3) {
    Zone* const zone = zone_of(kept.flush[i]);
    if (!zone) continue;
    zone->goes_on_flush = true;
    const std::int32_t cell = place(zone, kept.flush[i + 1]);
    if (cell < 0) continue;
    zone->flush.resize(zone->master.size(), 0);
    zone->flush[cell] |= static_cast<std::uint8_t>(kept.flush[i + 2]);
    add_flush(*zone);
  }
}

}  // namespace lacon
