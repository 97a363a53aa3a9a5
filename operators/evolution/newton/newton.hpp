#pragma once
// Newton's method for one instant: equilibrium, geometry, contact and behaviour in one loop (METHOD.md 3.2, 5.3).
#include <functional>
#include <initializer_list>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "lacon/assembly/loose_motions.hpp"
#include "lacon/assembly/saddle_point_solver.hpp"
#include "lacon/catalog/messages.hpp"
#include "lacon/operators/evolution/newton/creep.hpp"
#include "lacon/operators/evolution/newton/effort.hpp"
#include "lacon/operators/evolution/newton/equilibrium.hpp"
#include "lacon/operators/evolution/newton/forcing_term.hpp"
#include "lacon/operators/evolution/newton/line_search.hpp"
#include "lacon/operators/evolution/newton/linear_statuses.hpp"
#include "lacon/operators/evolution/newton/lost_masters.hpp"
#include "lacon/operators/evolution/newton/matrix_choice.hpp"
#include "lacon/operators/evolution/newton/prediction.hpp"
#include "lacon/operators/evolution/newton/residual_course.hpp"
#include "lacon/operators/evolution/newton/status_rule.hpp"
#include "lacon/operators/evolution/newton/unstable_path.hpp"
#include "lacon/structures/bodies.hpp"

namespace lacon {

struct NewtonOptions {
  ConvergenceCriteria criteria;
  std::vector<double> reference_forces = {};      ///< those of RESI_REFE_RELA, (n_nodes, n_components)
  int iterations = 10;                            ///< ITER_GLOB_MAXI; of each set, where statuses wait for its equilibrium
  SolidMatrix matrix = SolidMatrix::tangent;      ///< NEWTON/MATRICE
  SolidMatrix prediction = SolidMatrix::tangent;  ///< NEWTON/PREDICTION: of the first iteration of an instant
  /// PREDICTION='EXTRAPOLE': an instant starts where the motion of the last one leads to; TANGENTE and ELASTIQUE: where the
  /// last one ended; without it: as Prediction says
  std::optional<bool> extrapolates = false;
  double start = 0;                       ///< the instant of the initial state
  bool from_reference = false;            ///< its temperatures are those of reference, whatever they are at that instant
  std::optional<LineSearch> line_search;  ///< RECH_LINEAIRE
  bool cuts = false;                      ///< a step that fails is cut: no message advises it
};

class Newton {
 public:
  /// Criteria of contact are those of the problem's contact.
  Newton(const StaticProblem& problem, const NewtonOptions& options, std::unique_ptr<Engine> engine);

  /// The state before any load: displacements zero, statuses of CONTACT_INIT.
  StaticState initial_state();
  /// Begin with a state of another computation: statuses are those of CONTACT_INIT where `patches` is empty, multipliers of
  /// relations are found anew. Throws EVOLUTION_10 where its stresses are not those of the laws. @param label of the result it
  /// comes from
  /// @param as_given laws without a memory go on from it too: its stresses need not follow from its displacements
  void begin(StaticState& state, const std::string& label, bool as_given = false);

  /// Solve the instant, starting from `state`, which is in equilibrium. Calls `report` for each iteration.
  /// @return number of iterations. Throws an InstantFailure: EVOLUTION_4 (not converged), EVOLUTION_15, EVOLUTION_18 (cells
  /// that are no cells any more), SOLVER_3, EVOLUTION_42 (singular) ..., severity S. `state` is then between two instants.
  int solve(double instant, StaticState& state, const std::function<void(const IterationReport&)>& report);
  /// What solve() has found last belongs to the result: later instants start from it. @param state as it left it
  void accept(const StaticState& state);
  /// Go back to a state: contact, stresses and system are those of `state` again, as solve() needs them.
  void restart(const StaticState& state);
  /// What is done for every instant from now on: searching along increments is what RECH_LINEAIRE with METHODE='MIXTE' does.
  /// @return whether that is new
  bool take(Effort effort);

  /// For another process that goes on with the same bits: Equilibrium::save(), SaddlePointSolver::save().
  void save(const hdf5::Group& group) const;
  void resume(const hdf5::Group& group, const hdf5::Group* base, const StaticState& state, std::span<const double> rest);

  /// With those of the problem's contact.
  const ConvergenceCriteria& criteria() const { return options_.criteria; }
  const SaddlePointSolver& solver() const { return solver_; }
  const Equilibrium& equilibrium() const { return equilibrium_; }
  /// The state that laws without a memory start from, where it is not the natural one.
  const std::optional<StaticState>& origin() const { return equilibrium_.origin(); }
  void start_from(const StaticState& state) { equilibrium_.start_from(state); }
  /// Equilibrium::hand_out
  void hand_out(StaticState& state) const { equilibrium_.hand_out(state); }
  /// The contact at the last evaluation; nullptr without contact.
  const ContactState* contact() const { return equilibrium_.contact(); }
  /// Equilibrium::unbalanced, internal_forces
  std::vector<double> unbalanced() const { return equilibrium_.unbalanced(); }
  std::vector<double> internal_forces(const StaticState& state) const { return equilibrium_.internal_forces(state); }

 private:
  /// Let a state have the temperatures of the first instant, and laws without a memory start from it.
  void start_heated(StaticState& state);
  int iterate(double instant, StaticState& state, const std::function<void(const IterationReport&)>& report);
  /// Forget what was seen in the last one, and take the loads. @return the change of what is imposed: Equilibrium::load
  std::vector<double> begin_instant(double instant, const StaticState& state);
  /// Fill in residuals and criteria. @param increment of the iteration
  void judge(const StaticState& state, const StaticState& previous, std::span<const double> increment,
             IterationReport& line) const;
  /// The state is the solution: it gets what the points hold. Throws EVOLUTION_9 where cells are inside out.
  /// @param external forces as the instant began with them  @param line the last iteration
  void finish_instant(double instant, const StaticState& previous, StaticState& state, const std::vector<double>& external,
                      const IterationReport& line);
  /// Where the instant ends with a matrix that has taken the place of the consistent one: the pivots of that, at a solution.
  /// Nothing where it did not, they do not tell, or another factor is too much.
  std::optional<std::int64_t> consistent_pivots(const StaticState& previous, const StaticState& state);
  /// Whether what is solved is an equilibrium that is not stable: EVOLUTION_54, once.
  void note_stability();
  /// Whether round-off of what is stiff left more than is asked: EVOLUTION_69, once.
  void note_round_off();
  /// SaddlePointSolver::place_nodes
  void place_nodes(const StaticState& state);
  void assemble(const StaticState& state, const StaticState& previous, SolidMatrix asked);
  /// The solution of the present system. Where bodies are loose that are near to others, patches of `state` take contact
  /// first. Throws SOLVER_3 in the first iteration, EVOLUTION_42 in later ones.
  std::vector<double> solve_system(StaticState& state, const StaticState& previous, SolidMatrix asked,
                                   std::span<const double> step, const Accuracy& accuracy, IterationReport& line);
  /// Raise the resistance of the matrix to all motion until it is that of a minimum and no node moves by more than half of its
  /// cells, as far as it keeps them from that; cut the solution short where rows of contact ask for more.
  void resist(std::vector<double>& solution, StaticState& state, const StaticState& previous, SolidMatrix asked,
              std::span<const double> step, const Accuracy& accuracy, IterationReport& line,
              const std::function<void()>& assemble_again);
  /// Whether forces alone move a body by more than the model is large: next to nothing resists that, though no pivot is zero.
  bool flings(std::span<const double> solution, std::span<const double> step) const;
  /// What next to nothing resists, of bodies that no support, spring or relation holds.
  std::vector<LooseMotion> hardly_resisted();
  /// What the matrix lacks of kept covers (moving_covers.hpp), as far as it is worth its solutions.
  std::vector<MovingCover> moving_covers(const StaticState& state, std::span<const double> step) const;
  /// Go on with statuses that satisfy all patches of the linear system (linear_statuses.hpp), as long as they change from
  /// iteration to iteration. Where more are wrong than columns of the inverse are worth, all of them change and the system of
  /// these statuses is solved, again and again, for as long as fewer are wrong each time.
  /// @param[in,out] solution of the present ones; then of those that `state` has
  /// @param assemble_again lets the system be that of the statuses of `state`
  void fit_statuses(std::vector<double>& solution, std::span<const double> step, StaticState& state, const Accuracy& accuracy,
                    IterationReport& line, const std::function<void()>& assemble_again);
  void fit_by_columns(LinearStatuses& fitted, std::size_t affordable, std::span<const double> step, StaticState& state,
                      const Accuracy& accuracy, std::vector<double>& solution);
  /// Iterations for the present system that start from the solution of one nearby, and go as far as statuses ask for.
  SolutionReport solve_from(std::span<const double> near, std::span<const double> step, std::vector<double>& solution);
  /// Solve the system with what `solution` holds, in place. @param again with the matrix that was solved with last
  SolutionReport solve_linear(std::vector<double>& solution, const Accuracy& accuracy, bool again = false);
  void note_work(const SolutionReport& report);
  enum class Held { no, by_patches, by_springs };
  /// Hold bodies that are loose and near to others: the patches that their load leads them to (rest_under_load.hpp) take
  /// contact, or, where there are none, at first the nearest ones do, and EVOLUTION_20 says so. Where they are pulled and open
  /// again, nothing presses on the bodies: springs keep them where they are, in the matrix alone.
  /// @return by what more than before is held: by patches, some motions may be loose still
  Held hold(const std::vector<LooseMotion>& loose, std::span<const double> step, StaticState& state,
            const StaticState& previous, SolidMatrix asked);
  /// Patches, the first one nearest, by the loose bodies and the zones that they are of.
  std::vector<NearestPatches> by_zone(const std::vector<std::size_t>& patches, const std::set<std::int32_t>& loose) const;
  void take_contact(const std::vector<NearestPatches>& holds, StaticState& state);
  /// What pressures and gaps ask for at the state's geometry, in `line` how many patches want to change; nothing without
  /// contact.
  std::vector<Status> wanted_statuses(const StaticState& state, IterationReport& line);
  /// Whether a zone that touches would do so nowhere.
  bool parts_a_zone(const std::vector<Status>& before, const std::vector<Status>& wanted) const;
  /// Slave cells of patches, the first ones, with the skin they belong to.
  std::string cells_of(const std::vector<std::size_t>& patches) const;
  /// Patches near some loose bodies that would hold them, if more of them were covered; nothing where there are none.
  std::string too_little_covered(const std::vector<LooseMotion>& loose, const StaticState& state) const;
  /// How deep points of each zone lie in its master, over the size of their patch, where nothing presses there.
  std::vector<double> depths(const StaticState& state) const;
  /// Throws EVOLUTION_63 where a body has gone through another one in this instant.
  void fail_if_passed_through(double instant, const StaticState& state) const;
  /// Throws EVOLUTION_15 where no statuses satisfy all patches.
  void fail_if_endless(double instant) const;
  /// Patches that lose their master wherever they press keep their cover (lost_masters.hpp). Throws EVOLUTION_51 where they
  /// lose it all the same. @param before, wanted statuses of the iteration that ends, and of the next
  void keep_lost_masters(double instant, const std::vector<Status>& before, const std::vector<Status>& wanted,
                         const StaticState& state);
  /// Residuals go round, stand or drift: where they went round before in this instant, or stand or drift, or it has no
  /// iteration left, masters go on where both skins are flush, or else patches that press, and on which masters end, keep their
  /// cover.
  /// @return whether any does that did not
  bool keep_covers_that_sway(double instant, const StaticState& state, bool last);
  /// Near balance, pair as the present geometry asks for: masters that are far behind others and walls beside them are left
  /// out, those that no longer are come back; cuts of slave cells that iterates asked for, which the equilibrium does not,
  /// would make it another one on another way to it. What changes contact does so twice in an instant at most, for what is
  /// paired anew has another equilibrium.
  /// @return whether contact has changed
  bool pairs_anew(const IterationReport& line, const StaticState& state, const StaticState& previous);
  /// ContactState::keep_cover; EVOLUTION_50 says so once in a zone.
  void keep_cover(double instant, std::size_t patch);
  /// EVOLUTION_50 of patches that keep it in a state that is accepted: iterates far from it may have asked for others.
  void tell_of_covers();
  /// EVOLUTION_50 or 51
  Message about_cover(std::string_view id, double instant, std::size_t patch) const;
  /// Go on from `state` by the motion of the last instant, and to what is imposed, where that is asked for or serves.
  /// @param[in,out] step of imposed displacements, none where that is done
  void extrapolate(double instant, StaticState& state, std::vector<double>& step);
  /// Go back along an increment that goes too far (line_search.hpp), or to what lies between two iterates that come back; the
  /// geometry is paired where it ends.
  /// @param solution that `state` has moved by  @param increment of all unknowns of nodes, shortened as well
  void shorten(std::span<const double> solution, const StaticState& previous, StaticState& state,
               std::vector<double>& increment);
  /// Likewise, to where the first patch comes in by its size. Where bodies began in a few patches, as far as others have gone
  /// in deeper: under the whole load a few patches give way so far that their neighbourhood is no geometry to go on from. Where
  /// weak springs hold a body before it touches, if one lies ten times as deep: behind the other body.
  /// @param gaps ContactState::gaps_over_size() where the increment began
  void stay_shallow(std::span<const double> solution, std::span<const double> gaps, StaticState& state,
                    std::vector<double>& increment);
  /// Throws EVOLUTION_4. @param line the last iteration  @param previous the last equilibrium  @param changing a patch that
  /// changes its status in that iteration, if any does
  [[noreturn]] void fail_to_converge(double instant, const IterationReport& line, const StaticState& previous,
                                     std::size_t changing) const;
  /// What is known of a failure, one thing behind the other.
  static std::string said(std::initializer_list<std::string> what);
  /// What keeps the last iteration from being the solution, in words.
  std::string unmet_criteria(const IterationReport& line, std::size_t changing) const;
  bool diverges() const;
  /// Whether the residual is as small as it gets, and a smaller one is asked for.
  bool is_at_round_off(const IterationReport& line) const;
  /// Whether springs of the matrix alone hold a body, and the force on it is the same in each iteration: each moves it by as
  /// much again, and no contact is near enough to come.
  bool hangs_on_nothing() const;
  /// How many iterations more lead to the equilibrium, as far as the last ones say; nothing where they do not lead there.
  std::optional<int> iterations_left(const IterationReport& line) const;
  /// The one thing to do about it that fits. @param softened a law gave way in the last equilibrium (cell_motion.hpp)
  std::string remedy(const IterationReport& line, bool softened) const;

  /// What accept() has to know of the instant that is solved.
  struct Found {
    double instant = 0;
    KnownState before;
    std::vector<double> external;               ///< forces as the instant began with them
    std::optional<std::int64_t> negative;       ///< pivots of the last iteration; iterations of PETSc know none
    std::optional<std::int64_t> of_consistent;  ///< consistent_pivots()
    std::int64_t constraints = 0;
    double unbalanced = 0;  ///< forces over the largest, where that is round-off and more than asked
    std::int64_t worst_dof = -1;
  };

  const StaticProblem& problem_;
  NewtonOptions options_;
  Bodies bodies_;
  double extent_;                       ///< of the model
  std::set<std::int32_t> unsupported_;  ///< bodies that contact alone holds: free_bodies()
  LooseMotions loose_;
  Equilibrium equilibrium_;
  MatrixChoice choice_;
  StatusRule statuses_;
  EdgeCourse edges_;  ///< of the contacts that recede
  LostMasters lost_masters_;
  ForcingTerm forcing_;
  Prediction prediction_;
  bool elsewhere_ = false;      ///< it has led this instant to another start than the last state
  std::set<std::size_t> told_;  ///< patches that EVOLUTION_20 was about
  UnstablePath unstable_path_;
  Found found_;
  NewtonMatrix solved_with_;                     ///< that of the last iteration
  bool unstable_told_ = false;                   ///< EVOLUTION_54 was, or EVOLUTION_75
  bool round_off_told_ = false;                  ///< EVOLUTION_69 was
  std::map<std::int32_t, double> covers_since_;  ///< zones with covers that are kept since an instant that is not accepted yet
  std::set<std::int32_t> covers_told_;           ///< zones that EVOLUTION_50 was about
  ResidualCourse course_;                        ///< of the instant
  int times_held_ = 0;                           ///< in this instant: loose bodies
  int times_rested_ = 0;                         ///< likewise, by patches that their load leads them to
  int times_cut_ = 0, times_left_out_ = 0;       ///< in this instant: pairs_anew()
  bool looked_far_ = false;                      ///< in this instant: near balance, for what is to be left out
  bool goes_round_ = false;                      ///< residuals have come back: increments are searched (line_search.hpp)
  Effort effort_ = Effort::usual;
  std::optional<Creep> creep_;         ///< in an instant that is tried so
  bool resists_ = false;               ///< the matrix has its resistance
  bool other_covers_ = false;          ///< patches have begun to keep their cover: what follows has its own iterations
  int times_round_ = 0;                ///< in this instant: residuals have come back
  std::vector<double> depths_before_;  ///< depths() as the instant began
  bool comes_near_ = false;            ///< increments as the last one would close a gap before iterations end
  std::string hanging_;                ///< a body that springs alone hold in the last system
  std::string doubt_;                  ///< why a cheaper factor is no use, where it has not been told
  int settled_ = 0;                    ///< iterations in a row in which no status has changed
  SaddlePointSolver solver_;
};

}  // namespace lacon
