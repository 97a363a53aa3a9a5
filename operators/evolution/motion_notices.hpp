#pragma once
// Tells what laws of small displacements are asked for beyond them.
#include <set>
#include <vector>

#include "lacon/operators/evolution/bodies.hpp"
#include "lacon/operators/evolution/evolution.hpp"
#include "lacon/operators/evolution/state_fields.hpp"

namespace lacon {

class MotionNotices : public EvolutionObserver {
 public:
  explicit MotionNotices(const Present& present) : present_(present), bodies_(present.problem.mesh) {}

  /// EVOLUTION_59: a body whose cells, a tenth of them or more, have turned or are strained by too much for
  /// DEFORMATION='PETIT', once a body.
  void accept(const SolvedInstant& solved) override;
  void save(const hdf5::Group& group) const override;
  void resume(const hdf5::Group& group) override;

 private:
  Present present_;
  Bodies bodies_;
  std::set<std::int32_t> told_;  ///< bodies
};

}  // namespace lacon
