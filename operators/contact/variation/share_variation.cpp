// The share of a couple whose skins are nearly at a right angle, as a function of the nodes.
#include "lacon/operators/contact/variation/cell_variation.hpp"

// With the unit vectors a and m along the mean normals A of the slave's outline, or of its nodal normals, and M of the master,
// the cosine is c = -a . m, and
//     dc  = p . dA + q . dM,   p = -(m + c a) / |A|,   q = -(a + c m) / |M|,
//     d2c = p . d2A - 2 (p . dA) (a . dA) / |A| - c |da|^2 + q . d2M - 2 (q . dM) (m . dM) / |M| - c |dm|^2 - 2 da . dm.

namespace lacon::variations {
namespace {

/// The mean normal of a cell's outline, or of nodal normals.
template <int D>
class MeanNormal {
 public:
  Vector<D> n;    ///< unit
  double length;  ///< of what is differentiated

  /// @param nodes (vertices, D): places, or normals  @param first column of them among the unknowns
  MeanNormal(CellType type, std::span<const double> nodes, Eigen::Index first, bool of_outline)
      : nodes_(nodes), first_(first), vertices_(catalog::cell(type).n_vertices), of_outline_(of_outline) {
    n.setZero();
    for (int a = 0; a < vertices_; ++a) {
      if (!of_outline_)
        n += node(a);
      else if constexpr (D == 2)
        n += out_of((a == 0 ? -1 : 1) * node(a));
      else
        n += (node(a) - node(0)).cross(node(a + 1) - node(0));  // twice the area: the sum of x_a x x_(a + 1)
    }
    length = n.norm();
    n /= length;
  }

  Rows<D> rows(Eigen::Index n_unknowns) const {
    Rows<D> rows = Rows<D>::Zero(D, n_unknowns);
    for (int a = 0; a < vertices_; ++a) {
      auto own = rows.template middleCols<D>(first_ + D * a);
      if (!of_outline_) {
        own.setIdentity();
      } else if constexpr (D == 2) {
        const double side = a == 0 ? -1 : 1;
        own << 0, side, -side, 0;
      } else {
        const Vector<3> v = node(a + vertices_ - 1) - node(a + 1);
        own << 0, -v[2], v[1], v[2], 0, -v[0], -v[1], v[0], 0;
      }
    }
    return rows;
  }

  /// Add v . d2 of it.
  void add_second(const Vector<D>& v, QuadraticForm& form) const {
    if constexpr (D == 3) {
      const auto behind = static_cast<int>(first_) / 3;
      for (int a = 0; a < vertices_ && of_outline_; ++a)
        form.add_cross_of_nodes(2 * v, behind + a, behind + (a + 1) % vertices_);
    }
  }

 private:
  Vector<D> node(int a) const { return Eigen::Map<const Vector<D>>(nodes_.data() + D * (a % vertices_)); }

  std::span<const double> nodes_;
  Eigen::Index first_;
  int vertices_;
  bool of_outline_;
};

template <int D>
void vary_share_of(const ContactCellGeometry& cell, GapVariation& variation) {
  const auto n = static_cast<Eigen::Index>(variation.gradient.size());
  const bool smooth = !cell.slave_normals.empty();
  const MeanNormal<D> slave(cell.slave, smooth ? cell.slave_normals : cell.slave_nodes,
                            smooth ? n - static_cast<Eigen::Index>(cell.slave_normals.size()) : 0, !smooth),
      master(cell.master, cell.master_nodes, static_cast<Eigen::Index>(cell.slave_nodes.size()), true);
  const double c = -slave.n.dot(master.n);
  const Share share = share_of_couple(c, cell.steep);
  if (share.slope == 0) return;
  const Vector<D> p = -(master.n + c * slave.n) / slave.length, q = -(slave.n + c * master.n) / master.length;
  const Rows<D> of_slave = slave.rows(n), of_master = master.rows(n);
  const Row dc = p.transpose() * of_slave + q.transpose() * of_master;
  const double by_cosine = variation.gap * share.slope / share.value;  // what is there has the share as a factor
  Eigen::Map<Row> gradient(variation.gradient.data(), n);
  if (!variation.hessian.empty()) {
    QuadraticForm form(n);
    form.add(2 * share.slope / share.value, dc, gradient);
    form.add(variation.gap * share.curvature / share.value, dc, dc);
    const auto turn = [&](const MeanNormal<D>& of, const Rows<D>& rows, const Vector<D>& by) {
      const Row stretch = of.n.transpose() * rows / of.length;
      const Rows<D> turned = rows / of.length - of.n * stretch;
      form.add(-2 * by_cosine, stretch, Row(by.transpose() * rows));
      for (int i = 0; i < D; ++i) form.add(-by_cosine * c, turned.row(i), turned.row(i));
      of.add_second(by_cosine * by, form);
      return turned;
    };
    const Rows<D> da = turn(slave, of_slave, p), dm = turn(master, of_master, q);
    for (int i = 0; i < D; ++i) form.add(-2 * by_cosine, da.row(i), dm.row(i));
    Eigen::Map<Eigen::MatrixXd>(variation.hessian.data(), n, n) += form.matrix();
    for (MovingEnd& end : variation.ends) Eigen::Map<Row>(end.gradient.data(), n) += end.gap * share.slope / share.value * dc;
  }
  gradient += by_cosine * dc;
}

}  // namespace

void vary_share(const ContactCellGeometry& cell, GapVariation& variation) {
  if (cell.dimension == 2)
    vary_share_of<2>(cell, variation);
  else
    vary_share_of<3>(cell, variation);
}

}  // namespace lacon::variations
