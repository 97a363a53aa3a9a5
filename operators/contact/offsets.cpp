#include "lacon/operators/contact/offsets.hpp"

namespace lacon {

ContactOffsets::ContactOffsets(const Mesh& mesh, const Contact& contact, const Base& base)
    : n_nodes_(mesh.n_nodes()), n_zones_(contact.zones.size()) {
  for (std::size_t z = 0; z < n_zones_; ++z) {
    const ContactZone& zone = contact.zones[z];
    for (const LoadValue* const value : {&zone.slave_offset, &zone.master_offset}) {
      if (*value == LoadValue{}) continue;
      Offset& offset = offsets_.emplace_back();
      offset.zone = z;
      offset.nodes = nodes_of_cells(mesh, zone.slave);
      offset.number = value->value;
      if (value->function.empty()) continue;
      offset.function = std::make_unique<const StudyFunction>(base, value->function);
      for (const std::int32_t node : offset.nodes) {
        const auto place = mesh.point(static_cast<std::size_t>(node));
        offset.x.push_back(place[0]), offset.y.push_back(place[1]), offset.z.push_back(place[2]);
      }
    }
  }
}

std::vector<std::vector<double>> ContactOffsets::at(double instant) const {
  std::vector<std::vector<double>> sums(n_zones_);
  for (const Offset& offset : offsets_) {
    std::vector<double>& sum = sums[offset.zone];
    sum.resize(n_nodes_, 0.0);
    std::vector<double> values(offset.nodes.size(), offset.number);
    if (offset.function) {
      const ParameterValues known[] = {{"X", offset.x}, {"Y", offset.y}, {"Z", offset.z}, {"INST", {&instant, 1}}};
      values = offset.function->values(values.size(), known);
    }
    for (std::size_t i = 0; i < values.size(); ++i) sum[static_cast<std::size_t>(offset.nodes[i])] += values[i];
  }
  return sums;
}

}  // namespace lacon
