#include "lacon/operators/contact/contact_edge.hpp"

#include <algorithm>
#include <numbers>
#include <set>
#include <utility>

namespace lacon {
namespace {

constexpr double boldest = 4;  // times as many layers as in the last iteration: a secant that is nearly level says little

}  // namespace

std::int32_t EdgeCourse::layers(const std::vector<std::vector<std::int32_t>>& neighbours,
                                const std::vector<std::size_t>& pulled, double force) const {
  std::int32_t most = 1;
  for (const std::size_t patch : pulled)
    for (const std::int32_t next : neighbours[patch]) {
      const auto before = last_.find(static_cast<std::size_t>(next));
      if (before == last_.end() || !(before->second.force > force)) continue;
      const double secant = force / (before->second.force - force);
      most = std::max(most, static_cast<std::int32_t>(before->second.layers * std::min(secant, boldest)));
    }
  return most;
}

void EdgeCourse::note(const std::vector<std::size_t>& opened, double force, std::int32_t layers) {
  for (const std::size_t patch : opened) now_[patch] = {force, layers};
}

void EdgeCourse::next() {
  last_ = std::move(now_);
  now_.clear();
}

std::vector<std::size_t> behind_the_edge(const std::vector<std::vector<std::int32_t>>& neighbours,
                                         const std::vector<double>& force, const std::vector<bool>& pulled,
                                         const std::vector<bool>& pressed, EdgeCourse* course) {
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
    const double pull = sum;
    const std::int32_t least = course ? course->layers(neighbours, layer, pull) : 1;
    std::int32_t layers = 0;
    std::vector<std::size_t> edge;
    for (double largest = sum; !layer.empty();) {
      ++layers;
      edge.insert(edge.end(), layer.begin(), layer.end());
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
        if (layers < least || sum / parts + force[patch] > enough) {
          seen[patch] = true;
          layer.push_back(patch);
          left += sum / parts + force[patch];
        }
      largest *= static_cast<double>(layer.size()) / parts;
      sum = left;
      opened.insert(opened.end(), layer.begin(), layer.end());
    }
    if (course) course->note(edge, pull, layers);
  }
  if (course) course->next();
  return opened;
}

}  // namespace lacon
