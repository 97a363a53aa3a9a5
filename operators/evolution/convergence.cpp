#include "lacon/operators/evolution/convergence.hpp"

#include <algorithm>
#include <cmath>

namespace lacon {
void judge_forces(const ConvergenceCriteria& criteria, const ForceFigures& forces, IterationReport& report) {
  report.maxi = forces.unbalanced;
  report.worst_dof = forces.worst_dof;
  report.rela =
      forces.unbalanced > 0 && std::isfinite(forces.unbalanced) ? forces.unbalanced / forces.reference : forces.unbalanced;
  report.rela_met = !criteria.resi_glob_rela || report.rela <= *criteria.resi_glob_rela || forces.significant == 0;
  report.maxi_met = !criteria.resi_glob_maxi || report.maxi <= *criteria.resi_glob_maxi;
  report.refe = forces.over_own;
  report.refe_met = !criteria.resi_refe_rela || report.refe <= *criteria.resi_refe_rela;
}

void judge_contact(const ConvergenceCriteria& criteria, const MotionFigures& motion, double constraint,
                   IterationReport& report) {
  report.geometry = motion.increment == 0 ? 0 : motion.increment / std::max(motion.whole, motion.vanishing);
  report.geometry_met = report.geometry <= criteria.resi_geom;
  report.constraint = constraint;
  report.constraint_met = report.constraint <= criteria.constraint;
}

}  // namespace lacon
