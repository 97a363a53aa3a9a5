#include "lacon/operators/contact/contact_edge.hpp"

#include <algorithm>
#include <numbers>
#include <set>

namespace lacon {

std::vector<std::size_t> behind_the_edge(const std::vector<std::vector<std::int32_t>>& neighbours,
                                         const std::vector<double>& force, const std::vector<bool>& pulled,
                                         const std::vector<bool>& pressed) {
  std::vector<std::size_t> opened;
  std::vector<bool> seen(pulled.size(), false);
  for (std::size_t start = 0; start < pulled.size(); ++start) {
    if (!pulled[start] || seen[start]) continue;
    // patches that are pulled together: their force is the first of the sum
    std::vector<std::size_t> layer{start};
    seen[start] = true;
    for (std::size_t i = 0; i < layer.size(); ++i)
      for (const std::int32_t next : neighbours[layer[i]])
        if (pulled[next] && !seen[next]) seen[next] = true, layer.push_back(static_cast<std::size_t>(next));
    double sum = 0;
    for (const std::size_t patch : layer) sum += force[patch];
    for (double largest = sum; !layer.empty();) {
      std::set<std::size_t> behind;
      for (const std::size_t patch : layer)
        for (const std::int32_t next : neighbours[patch])
          if (pressed[next] && !seen[next]) behind.insert(static_cast<std::size_t>(next));
      // each of them stands against its part of the sum
      const auto parts = static_cast<double>(behind.size());
      const double enough = largest / parts / std::numbers::sqrt2;
      layer.clear();
      double left = 0;
      for (const std::size_t patch : behind)
        if (sum / parts + force[patch] > enough) {
          seen[patch] = true;
          layer.push_back(patch);
          left += sum / parts + force[patch];
        }
      largest *= static_cast<double>(layer.size()) / parts;
      sum = left;
      opened.insert(opened.end(), layer.begin(), layer.end());
    }
  }
  return opened;
}

}  // namespace lacon
