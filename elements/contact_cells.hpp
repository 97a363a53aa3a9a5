#pragma once
// What pairing finds and contact kernels integrate over: one contact cell for each couple of a slave and a master cell.
#include <cstdint>
#include <vector>

namespace lacon {

/// Contact cells of one zone. Cell c has the points offset[c] to offset[c + 1].
struct ContactCells {
  int dimension = 2;                 ///< of the space; reference spaces of skins have one less
  std::vector<std::int32_t> slave;   ///< of each contact cell: index into Contact::slaves
  std::vector<std::int32_t> master;  ///< cell of the mesh
  std::vector<std::int64_t> offset{0};
  std::vector<double> slave_point;   ///< (points, dimension - 1): reference coordinates on the slave
  std::vector<double> master_point;  ///< (points, dimension - 1): their images on the master
  std::vector<double> weight;        ///< (points): weights in the slave's reference space
  std::vector<std::int64_t> vertex_offset{0};
  std::vector<double> vertex;  ///< (vertices, dimension - 1): the clipped polygon in the slave's reference space
  /// In the plane, of each vertex: the node of the master surface whose normal cuts the slave there; -1: an end of the slave
  std::vector<std::int32_t> vertex_node;
  /// Likewise where that normal crosses the slave: elsewhere than `vertex` where the cover fades (PairingOptions::fading)
  std::vector<double> vertex_crossing;

  std::size_t size() const { return slave.size(); }
  bool operator==(const ContactCells&) const = default;
  /// Put others behind.
  void append(const ContactCells& other) {
    const auto behind = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
    const auto shifted = [](auto& to, const auto& from) {
      const std::int64_t shift = to.back();
      for (std::size_t i = 1; i < from.size(); ++i) to.push_back(shift + from[i]);
    };
    behind(slave, other.slave), behind(master, other.master), behind(weight, other.weight), behind(vertex, other.vertex);
    behind(vertex_node, other.vertex_node), behind(vertex_crossing, other.vertex_crossing);
    behind(slave_point, other.slave_point), behind(master_point, other.master_point);
    shifted(offset, other.offset), shifted(vertex_offset, other.vertex_offset);
  }
  /// Empty, with the memory kept.
  void clear() {
    for (auto* numbers : {&slave, &master, &vertex_node}) numbers->clear();
    for (auto* values : {&slave_point, &master_point, &weight, &vertex, &vertex_crossing}) values->clear();
    for (auto* offsets : {&offset, &vertex_offset}) offsets->assign(1, 0);
  }
};

}  // namespace lacon
