// What is kept of zones goes into a group and comes back.
#include "lacon/operators/evolution/observers/zone_records.hpp"

#include <gtest/gtest.h>

#include <filesystem>

namespace lacon {
namespace {

struct Seen {
  double instant;
  std::size_t patch;
  bool in_rows;
  template <class Use>
  void for_each_member(const Use& use) {
    use("instant", instant), use("patch", patch), use("in_rows", in_rows);
  }
};

TEST(ZoneRecords, ComeBackAsTheyWere) {
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "lacon_zone_records_test.h5";
  const std::map<std::int32_t, Seen> seen{{7, {0.1, 1234567890123, true}}, {-2, {1.0 / 3, 0, false}}};
  const std::map<std::int32_t, double> depths{{3, 0.25}};
  const std::map<std::int32_t, Seen> none;
  const std::set<std::size_t> zones{5, 9};
  hdf5::write_whole(file, [&](const hdf5::Group& group) {
    save_zones(group, "seen", seen);
    save_zones(group, "depths", depths);
    save_zones(group, "none", none);
    save_zones(group, "zones", zones);
  });
  const hdf5::Reader group(file);
  std::map<std::int32_t, Seen> found{{1, {}}}, nothing{{1, {}}};
  resume_zones(group, "seen", found);
  ASSERT_EQ(found.size(), 2U);
  for (const auto& [zone, expected] : seen) {
    EXPECT_EQ(found.at(zone).instant, expected.instant);
    EXPECT_EQ(found.at(zone).patch, expected.patch);
    EXPECT_EQ(found.at(zone).in_rows, expected.in_rows);
  }
  resume_zones(group, "none", nothing);
  EXPECT_TRUE(nothing.empty());
  std::map<std::int32_t, double> depths_found;
  resume_zones(group, "depths", depths_found);
  EXPECT_EQ(depths_found, depths);
  std::set<std::size_t> zones_found{1};
  resume_zones(group, "zones", zones_found);
  EXPECT_EQ(zones_found, zones);
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace lacon
