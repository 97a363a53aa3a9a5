#pragma once
// What is kept of zones, in a group of a base: every member of a record is a dataset, beside the numbers of the zones.
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "lacon/structures/hdf5.hpp"

namespace lacon {

/// A record is a number, or a struct that shows its members: use(name, member), numbers that a double holds.
template <class Record, class Use>
void for_each_member(Record& record, const Use& use) {
  if constexpr (std::is_arithmetic_v<Record>)
    use("value", record);
  else
    record.for_each_member(use);
}

template <class Record>
void save_zones(const hdf5::Group& parent, std::string_view name, const std::map<std::int32_t, Record>& records) {
  std::vector<std::int32_t> zones;
  std::map<std::string, std::vector<double>> members;
  for (auto [zone, record] : records) {
    zones.push_back(zone);
    for_each_member(record, [&](std::string_view member, auto& value) {
      members[std::string(member)].push_back(static_cast<double>(value));
    });
  }
  const hdf5::Group group = parent.create(name);
  group.write("zone", zones);
  for (const auto& [member, values] : members) group.write(member, values);
}

template <class Record>
void resume_zones(const hdf5::Group& parent, std::string_view name, std::map<std::int32_t, Record>& records) {
  const hdf5::Group group = parent.open(name);
  std::map<std::string, std::vector<double>> members;
  records.clear();
  for (const std::int32_t zone : group.read<std::int32_t>("zone")) {
    const std::size_t place = records.size();  // zones ascend
    for_each_member(records[zone], [&](std::string_view member, auto& value) {
      const auto [values, is_new] = members.try_emplace(std::string(member));
      if (is_new) values->second = group.read<double>(member);
      value = static_cast<std::remove_reference_t<decltype(value)>>(values->second.at(place));
    });
  }
}

/// Numbers alone, of zones or of others.
template <class Number>
void save_zones(const hdf5::Group& parent, std::string_view name, const std::set<Number>& numbers) {
  parent.write(name, std::vector<std::int64_t>(numbers.begin(), numbers.end()));
}

template <class Number>
void resume_zones(const hdf5::Group& parent, std::string_view name, std::set<Number>& numbers) {
  numbers.clear();
  for (const std::int64_t number : parent.read<std::int64_t>(name)) numbers.insert(static_cast<Number>(number));
}

}  // namespace lacon
