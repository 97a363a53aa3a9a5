#pragma once
// Tells what laws are asked for beyond the displacements that they are for.
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "lacon/operators/evolution/evolution.hpp"
#include "lacon/operators/evolution/problem/cell_motion.hpp"
#include "lacon/operators/evolution/state_fields.hpp"
#include "lacon/structures/bodies.hpp"

namespace lacon {

class MotionNotices : public EvolutionObserver {
 public:
  explicit MotionNotices(const Present& present) : present_(present), bodies_(present.problem.mesh) {}

  /// EVOLUTION_59: a body whose cells, a tenth of them or more, have turned or are strained by too much for
  /// DEFORMATION='PETIT'; EVOLUTION_61: are compressed by more than what elasticity under Green-Lagrange strains resists more
  /// and more; once a body.
  void accept(const SolvedInstant& solved) override;
  void save(const hdf5::Group& group) const override;
  void resume(const hdf5::Group& group) override;

 private:
  /// Of the cells of such sets, by bodies that nothing was told of.
  std::map<std::int32_t, std::vector<CellMotion>> motions(bool (*is_one)(const ElementSet&)) const;
  void tell(std::string_view id, double instant, const CellMotion& motion, const std::string& what);

  Present present_;
  Bodies bodies_;
  std::set<std::int32_t> told_;  ///< bodies
};

}  // namespace lacon
