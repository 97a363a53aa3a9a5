#include <algorithm>

#include "lacon/catalog/wording.hpp"
#include "lacon/structures/storage/pieces.hpp"
#include "lacon/structures/storage/storage.hpp"

namespace lacon::storage {

ElementCharacteristics read_element_characteristics(const hdf5::Group& root) {
  ElementCharacteristics characteristics{.model = root.text("model"), .mesh = root.text("mesh"), .springs = {}};
  const auto first = root.read<std::int32_t>("springs/first"), second = root.read<std::int32_t>("springs/second");
  const auto stiffness = root.read<double>("springs/stiffness");
  if (second.size() != first.size() || stiffness.size() != 6 * first.size())
    refuse(root, part("is_inconsistent", {{"what", "springs"}}));
  for (std::size_t i = 0; i < first.size(); ++i) {
    Spring& spring = characteristics.springs.emplace_back(Spring{.first = first[i], .second = second[i]});
    std::copy_n(stiffness.begin() + static_cast<std::ptrdiff_t>(6 * i), 6, spring.stiffness.begin());
  }
  return characteristics;
}

void write(const hdf5::Group& root, const ElementCharacteristics& characteristics) {
  root.set("model", characteristics.model);
  root.set("mesh", characteristics.mesh);
  std::vector<std::int32_t> first, second;
  std::vector<double> stiffness;
  for (const Spring& spring : characteristics.springs) {
    first.push_back(spring.first);
    second.push_back(spring.second);
    stiffness.insert(stiffness.end(), spring.stiffness.begin(), spring.stiffness.end());
  }
  root.write("springs/first", first);
  root.write("springs/second", second);
  root.write("springs/stiffness", stiffness, {first.size(), 6});
}

std::vector<std::string> references(const ElementCharacteristics& characteristics) {
  return {characteristics.model, characteristics.mesh};
}

}  // namespace lacon::storage
