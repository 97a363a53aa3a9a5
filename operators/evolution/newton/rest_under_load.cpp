#include "lacon/operators/evolution/newton/rest_under_load.hpp"

#include <algorithm>
#include <cmath>

#include "lacon/assembly/least_distance.hpp"

namespace lacon {
namespace {

constexpr double no_work = 1e-6;  // of what all loads could do: round-off, or forces that iterations leave
constexpr double no_row = 1e-9;   // of a unit motion: what it changes a gap by
constexpr double far = 1e3;       // of the reach of motions that rest: where the load would lead bodies that nothing stops
constexpr double reach = 1e3;     // of the widest gap and patch

}  // namespace

std::vector<std::size_t> patches_under_load(const ContactState& contact, const Patchwise& patches,
                                            const Equilibrium& equilibrium, const LooseMotions& motions,
                                            std::span<const double> step) {
  const Eigen::VectorXd work = motions.work(equilibrium.right_side(step));
  double most = 0;  // that loads could do
  for (std::size_t dof = 0; work.size() > 0 && dof < step.size(); ++dof)
    if (const double force = equilibrium.external()[dof]; force != 0)
      most += std::abs(force) * motions.by(static_cast<std::int64_t>(dof)).norm();
  if (most == 0 || work.norm() <= no_work * most) return {};
  std::vector<std::size_t> near;
  double widest = 0;
  for (std::size_t p = 0; p < contact.n_patches(); ++p)
    if (contact.may_hold(p, patches)) {
      near.push_back(p);
      widest = std::max(widest, contact.patch_size(p));
    }
  const System& system = equilibrium.system();
  const std::vector<GapRow> gaps = contact.gap_rows(near);
  Eigen::MatrixXd rows(std::ssize(near), work.size());
  Eigen::VectorXd bounds(std::ssize(near));
  std::vector<std::size_t> stopping;
  for (std::size_t i = 0; i < near.size(); ++i) {
    const Eigen::Index at = std::ssize(stopping);
    const double covered = contact.geometry().covered(near[i]);
    Eigen::VectorXd row = Eigen::VectorXd::Zero(rows.cols());
    double gap = gaps[i].gap;
    for (std::size_t k = 0; k < gaps[i].unknowns.size(); ++k) {
      const std::int64_t dof = system.unknown(gaps[i].unknowns[k].vertex, gaps[i].unknowns[k].component);
      if (system.equation(dof) >= 0)
        row += gaps[i].derivative[k] * motions.by(dof);
      else
        gap += gaps[i].derivative[k] * step[static_cast<std::size_t>(dof)];
    }
    row /= covered;
    if (row.norm() <= no_row) continue;
    rows.row(at) = row;
    bounds[at] = -gap / covered;
    stopping.push_back(near[i]);
  }
  rows.conservativeResize(std::ssize(stopping), Eigen::NoChange);
  bounds.conservativeResize(std::ssize(stopping));
  const Eigen::VectorXd aim = far * reach * widest * work.normalized();
  const auto rest = least_distance(rows, bounds, aim);
  if (!rest || rest->point.norm() > reach * widest) return {};
  const Eigen::VectorXd left = rows * rest->point - bounds;
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < stopping.size(); ++i)
    if (const auto at = static_cast<Eigen::Index>(i); rest->forces[at] > 0 || contact.is_as_near(stopping[i], left[at]))
      found.push_back(stopping[i]);
  return found;
}

}  // namespace lacon
