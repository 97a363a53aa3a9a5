#pragma once
// The equilibrium of bodies, loads and contact at a state: forces, matrix, and what the integration points hold
// (METHOD.md 5.3).
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "lacon/operators/contact/contact_state.hpp"
#include "lacon/operators/evolution/newton/convergence.hpp"
#include "lacon/operators/evolution/newton/matrix_choice.hpp"
#include "lacon/operators/evolution/newton/moving_covers.hpp"
#include "lacon/operators/evolution/problem/heat.hpp"
#include "lacon/operators/evolution/problem/prestrain.hpp"
#include "lacon/operators/evolution/problem/reference_forces.hpp"
#include "lacon/operators/evolution/problem/relations.hpp"
#include "lacon/operators/evolution/problem/static_problem.hpp"
#include "lacon/operators/evolution/problem/system.hpp"

namespace lacon::hdf5 {
class Group;
}

namespace lacon {

class SolidParts;

class Equilibrium {
 public:
  explicit Equilibrium(const StaticProblem& problem) : Equilibrium(problem, nullptr) {}
  /// @param parts processes that have the cells, or nothing: parts_of()
  Equilibrium(const StaticProblem& problem, std::shared_ptr<SolidParts> parts);
  Equilibrium(const Equilibrium&) = delete;
  Equilibrium& operator=(const Equilibrium&) = delete;

  /// Displacements, multipliers, stresses and variables zero; no statuses.
  StaticState natural_state() const;
  /// Let a state have the temperatures of an instant, where some act. @return whether that is so
  bool heat(double instant, StaticState& state);
  /// Temperatures and initial strains that assemblies from now on take: as a state has them. load() takes those of an instant.
  void strain_as(const StaticState& state);
  /// Whether there are strains without stress, thermal or initial ones, or were in a state.
  bool strains_freely(const StaticState& state) const { return heat_.acts() || prestrain_.acts(state); }
  /// A state that laws without a memory start from; until then it is the natural one.
  void start_from(const StaticState& state) { origin_ = state; }
  /// Stresses that a computation begins with: displacements from there on do not tell what round-off their forces have.
  void begin_stressed(const StaticState& state) { first_forces_ = summed_forces(problem_, state); }
  const std::optional<StaticState>& origin() const { return origin_; }
  /// Take the loads of an instant; the contact is paired anew where its skins' offsets change (has_new_gaps()). Throws LOAD_1,
  /// LOAD_6 where they contradict each other.
  /// @return the change of what is imposed, (n_nodes, n_components), 0 elsewhere
  std::vector<double> load(double instant, const StaticState& state);
  /// Whether what acts goes on from an instant to the next as it went from the one before, rather than back; not said where
  /// temperatures or initial strains act.
  bool load_goes_on(double before, double last, double instant, const StaticState& state) const;
  /// The same state with no law that flows (INDIPLAS), so that a step begins elastically.
  StaticState at_rest(const StaticState& state) const;
  /// Take the offsets of the skins at an instant. @return whether they are others than before
  bool offset_skins(double instant);
  /// Contact cells at these displacements; nothing without contact. @param displacement (n_nodes, n_components)
  void pair(std::span<const double> displacement);
  /// The displacement of the last state in equilibrium, from which contact goes on.
  void rest_at(std::span<const double> displacement) {
    if (contact_) contact_->rest_at(displacement);
  }
  /// ContactGeometry::choose_masters; false without contact
  bool choose_masters();
  /// ContactGeometry::keep
  void keep(const KeptPairing& kept) {
    if (contact_) contact_->keep(kept);
  }
  /// ContactGeometry::go_on_where_flush; false without contact
  bool go_on_where_flush() { return contact_ && contact_->go_on_where_flush(); }
  /// ContactGeometry::renew_cuts
  void renew_cuts() { contact_->renew_cuts(); }
  /// ContactState::keep_cover, let_covers_go
  void keep_cover(std::size_t patch) { contact_->keep_cover(patch); }
  void let_covers_go() {
    if (contact_) contact_->let_covers_go();
  }
  /// The patches of the last state in equilibrium: contact that glides (GLISSIERE) keeps what was closed.
  void keep_gliding(const Patchwise& patches) {
    if (contact_) contact_->keep_gliding(patches);
  }
  /// Forces, matrix, stresses and variables at a state that is paired. @param previous the last one in equilibrium
  void assemble(const StaticState& state, const StaticState& previous, NewtonMatrix wanted);

  /// Put a spring to each of these degrees of freedom into the matrix, about as stiff as what is around it: an increment meets
  /// it, forces and the equilibrium know nothing of it.
  void hold(std::span<const std::int64_t> dofs);
  /// Likewise to all nodes. @param springs by equation of a node
  void resist(std::span<const double> springs);

  /// What the next instant depends on beside the state, for another process that goes on with the same bits.
  void save(const hdf5::Group& group) const;
  /// Be as save() left it. @param state solved last  @param rest displacements at the instant before
  void resume(const hdf5::Group& group, const StaticState& state, std::span<const double> rest);

  /// Add a solution of the system to a state. @param step of the imposed displacements
  /// @return the increment of all unknowns of nodes, (n_nodes, n_components)
  std::vector<double> add(std::span<const double> solution, std::span<const double> step, StaticState& state) const;
  /// The right side of the system, (n_equations). @param step of the imposed displacements
  std::vector<double> right_side(std::span<const double> step) const { return system_.right_side(external_, step); }

  /// What the matrix of the last assembly lacks of kept covers.
  std::vector<MovingCover> moving_covers(const StaticState& state, std::span<const double> step) const;

  /// Of the last load() or assembly: external forces, (n_nodes, n_components), and behind them what rows of multipliers are to
  /// be.
  const std::vector<double>& external() const { return external_; }

  /// Power of the unbalanced forces of the last assembly along a solution of the system.
  double power(std::span<const double> solution) const;
  /// Power of the forces by which the matrix resists a solution, along it; multipliers have no part in it.
  double resistance(std::span<const double> solution) const;
  std::int64_t first_multiplier() const { return system_.first_multiplier(); }  ///< equations from it on: relations and patches

  /// Measure what is unbalanced by the reference of its degree of freedom too, where that is above zero
  /// (reference_forces.hpp).
  void measure_by(std::vector<double> reference_forces) { reference_forces_ = std::move(reference_forces); }
  /// What the last assembly says of the balance of `state`.
  ForceFigures forces(const StaticState& state, const StaticState& previous) const;
  /// What is left of the forces at the last assembly, internal less external, (n_nodes, n_components); 0 where nothing is
  /// unknown.
  std::vector<double> unbalanced() const;
  /// What stresses and springs resist with at the last assembly, (n_nodes, n_components). @param state of that assembly
  std::vector<double> internal_forces(const StaticState& state) const;
  MotionFigures motion(std::span<const double> increment, const StaticState& state) const;
  /// Active patches and relations that have an equation: the negative pivots of a stable equilibrium.
  std::int64_t n_constraints(const StaticState& state) const;
  bool touches(const StaticState& state) const { return contact_ && contact_->n_constraints(state.patches) > 0; }
  /// Whether the gaps of active patches have second derivatives.
  bool curves(const StaticState& state) const { return touches(state) && !problem_.contact->frozen_gap; }
  /// A degree of freedom and its body in words: "N12 DX of TOOL".
  std::string place(std::int64_t dof) const;
  /// The degrees of freedom of nodes among the unknowns of these equations, ascending.
  std::vector<std::int64_t> dofs_of(std::span<const std::int64_t> equations) const;
  /// The unknowns of these equations in words: the first of each body, and relations.
  std::string names(std::span<const std::int64_t> equations) const;

  const System& system() const { return system_; }
  void on_new_graph(std::function<void(const VertexGraph&)> use) { system_.on_new_graph(std::move(use)); }
  const ContactState* contact() const { return contact_ ? &*contact_ : nullptr; }
  /// Let a state have what the points hold at the last assembly.
  void hold_points(StaticState& state) const;
  /// Where processes have the cells, hand them what the points of a state hold.
  void hand_out(StaticState& state) const;
  NewtonMatrix matrix() const { return matrix_; }                                   ///< of the last assembly
  std::optional<std::int32_t> cell_inside_out() const { return cell_inside_out_; }  ///< that the last assembly found
  bool has_new_gaps() const { return has_new_gaps_; }                               ///< since the last assembly
  bool is_linear() const { return linear_; }                                        ///< the stiffness never changes
  bool has_memory() const { return has_memory_; }                                   ///< a law has
  bool is_symmetric() const { return system_.is_symmetric(); }
  bool makes_symmetric() const;  ///< of a tangent that is not, the matrix has the symmetric part
  bool has_variables() const;    ///< a law has internal variables
  /// Whether internal variables of the last assembly are not those of the last state in equilibrium: the law flows.
  bool flows(const StaticState& previous) const;

 private:
  void start(bool keeps_stiffness);
  void add_solids(const StaticState& state, const StaticState& previous, SolidMatrix wanted);
  void add_solids_of_parts(const StaticState& state, const StaticState& previous, SolidMatrix wanted);
  /// Temperatures and initial strains of an instant.
  void strain(double instant);
  void add_springs(const StaticState& state, bool with_matrix);
  void add_following_loads(const StaticState& state);
  void add_contact(const StaticState& state);

  const StaticProblem& problem_;
  Heat heat_;
  Prestrain prestrain_;
  Relations relations_;
  std::shared_ptr<SolidParts> parts_;
  Ragged<std::int32_t> elements_;  ///< nodes of each element that has a matrix here
  System system_;
  std::optional<ContactState> contact_;
  bool linear_ = true, has_memory_ = false;
  bool has_stiffness_ = false;                       ///< a linear stiffness is in the matrix
  NewtonMatrix matrix_{.solid = SolidMatrix::none};  ///< of which kind it is
  std::vector<PointValues> points_;                  ///< at the last assembly; empty where processes have the cells
  std::optional<StaticState> origin_;
  std::optional<std::int32_t> cell_inside_out_;
  std::optional<double> instant_;  ///< that of the loads
  std::vector<double> given_;      ///< at that instant: dead forces, and behind them what the multipliers' rows are to be
  std::vector<double> external_;   ///< the same with following forces at the last evaluation
  double extent_ = 0;              ///< largest coordinate of the mesh
  std::vector<double> reference_forces_;      ///< (n_nodes, n_components), or nothing
  std::vector<double> first_forces_;          ///< summed_forces() of the first stresses
  std::vector<std::vector<double>> offsets_;  ///< of the skins, ContactOffsets::at
  bool has_new_gaps_ = false;
};

}  // namespace lacon
