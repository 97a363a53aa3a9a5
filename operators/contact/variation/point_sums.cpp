#include "lacon/operators/contact/variation/point_sums.hpp"

#include <cblas.h>

#include <algorithm>
#include <cstring>

namespace lacon::variations {

void PointProducts::start(int lefts, int rights) {
  lefts_ = lefts, rights_ = rights, count_ = 0;
  left_.resize(static_cast<std::size_t>(lefts * room)), right_.resize(static_cast<std::size_t>(rights * room));
  sum_.assign(static_cast<std::size_t>(lefts * rights), 0.0);
}

void PointProducts::flush() {
  if (count_ > 0 && lefts_ > 0)
    cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasTrans, lefts_, rights_, count_, 1.0, left_.data(), room, right_.data(), room,
                1.0, sum_.data(), rights_);
  count_ = 0;
}

namespace {

double sum_of(const Lanes& lane) {
  double sum = 0;
  for (int l = 0; l < LACON_LANES; ++l) sum += lane[l];
  return sum;
}

}  // namespace

template <int D>
void PointSums<D>::start(const ContactCellGeometry& cell, int n_corners, bool second, const std::array<double, R * R>& sides,
                         const PlaneOfSlave* plane) {
  cell_ = &cell, plane_ = plane;
  slaves_ = catalog::cell(cell.slave).n_nodes, masters_ = catalog::cell(cell.master).n_nodes, n_corners_ = n_corners;
  const bool smooth = !cell.slave_normals.empty();
  columns_ = D * (slaves_ + masters_ + (smooth ? slaves_ : 0));
  second_ = second, sides_ = sides;
  std::memset(&sums_, 0, sizeof sums_);
  if (!second) return;
  of_skins_.start(slaves_ + masters_, D * columns_);
  of_slaves_.start(slaves_, D * columns_);
  of_normals_.start(smooth ? slaves_ : 0, D * columns_);
  of_corners_.start(n_corners, R * columns_);
  of_means_.start(plane ? 3 : 0, columns_);
  of_offs_.start(plane ? 3 : 0, 2 * columns_);
}

template <int D>
void PointSums<D>::start_simplex(const std::array<int, D>& corners, double factor) {
  corners_ = corners, factor_ = factor;
}

template <int D>
void PointSums<D>::end_simplex() {
  const auto take = [](auto& to, auto& from, std::size_t count) {
    auto* const values = reinterpret_cast<double*>(&to);
    auto* const sums = reinterpret_cast<double*>(&from);
    for (std::size_t i = 0; i < count; ++i) values[i] = sum_of(lanes(sums, static_cast<std::int64_t>(i)));
    std::fill_n(sums, count * LACON_LANES, 0.0);
  };
  take(simplex_.value, sums_.value, 1);
  take(simplex_.gradient, sums_.gradient, static_cast<std::size_t>(columns_));
  take(simplex_.of_corner, sums_.of_corner, D * R);
  if (second_) take(simplex_.corner_pairs, sums_.corner_pairs, D * D * R * R);
  if (!plane_) return;
  take(simplex_.of_directions, sums_.of_directions, 6);
  take(simplex_.of_sides, sums_.of_sides, 6);
  take(simplex_.of_origin, sums_.of_origin, 3);
  take(simplex_.of_mean, sums_.of_mean, 3);
  if (!second_) return;
  take(simplex_.corner_by_c, sums_.corner_by_c, D * 2);
  take(simplex_.corner_by_e, sums_.corner_by_e, D * 3);
}

template <int D>
void PointSums<D>::end() {
  if (!second_) return;
  for (PointProducts* products : {&of_skins_, &of_slaves_, &of_normals_, &of_corners_, &of_means_, &of_offs_})
    products->flush();
  const auto columns = static_cast<std::size_t>(columns_), slaves = static_cast<std::size_t>(slaves_ * D) * columns,
             skins = static_cast<std::size_t>((slaves_ + masters_) * D) * columns;
  nodes_.assign(columns * columns, 0.0);
  std::copy_n(of_skins_.sum(), skins, nodes_.begin());
  for (std::size_t i = 0; i < slaves; ++i) nodes_[i] += of_slaves_.sum()[i];
  std::copy_n(of_normals_.sum(), columns * columns - skins, nodes_.begin() + static_cast<std::ptrdiff_t>(skins));
  for (int a = 0; a < slaves_ && plane_; ++a) {
    for (int d = 0; d < 3; ++d) turned_[a][d] = sum_of(sums_.turned[a][d]);
    for (int i = 0; i < 2; ++i) held_[i][a] = sum_of(sums_.held[i][a]);
  }
  for (int d = 0; d < 3; ++d) second_of_mean_[d] = sum_of(sums_.second_of_mean[d]);
}

template class PointSums<2>;
template class PointSums<3>;

}  // namespace lacon::variations
