#include "lacon/operators/evolution/newton/equilibrium.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "lacon/assembly/solid_step.hpp"
#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/operators/evolution/newton/prediction.hpp"
#include "lacon/operators/evolution/problem/parts.hpp"
#include "lacon/operators/program/program.hpp"
#include "lacon/structures/bodies.hpp"
#include "lacon/structures/hdf5.hpp"

namespace lacon {
namespace {

constexpr double vanishing_displacement = 1e-8;  // of the smallest patch, or of the mesh
// A sum of n terms is off by about sqrt(n) units of round-off of each (Higham, Mary, A new approach to probabilistic rounding
// error analysis, 2019).
constexpr double round_off = std::numeric_limits<double>::epsilon();
constexpr double far_beyond = 1e8;  // times the round-off of a degree of freedom: a force there is one

/// Nodes of every element that has a matrix. @param with_solids or only of the others
Ragged<std::int32_t> nodes_of_elements(const StaticProblem& problem, bool with_solids) {
  Ragged<std::int32_t> nodes;
  const auto add = [&](const ElementSet& set) {
    for (const std::int32_t cell : set.cells) nodes.push_back(problem.mesh.cells[cell]);
  };
  for (const ElementSet& set : problem.solids)
    if (with_solids) add(set);
  for (const Spring& spring : problem.springs) {
    const std::array ends = {spring.first, spring.second};
    nodes.push_back(std::span(ends).first(spring.second < 0 ? 1 : 2));
  }
  for (const TimedLoad& load : problem.loads)
    for (const LoadedCells& loaded : load.following) add(loaded.set);
  return nodes;
}

ContactBodies bodies_of(const StaticProblem& problem) {
  ContactBodies bodies{.modulus = [&problem](std::int32_t cell) -> std::optional<double> {
                         return problem.materials->has(cell) ? problem.materials->find(cell, "ELAS/E") : std::nullopt;
                       },
                       .free = {},
                       .held = problem.held};
  for (std::int64_t node = 0; node < problem.numbering.n_nodes; ++node)
    for (int d = 0; d < problem.dimension; ++d) bodies.free.push_back(problem.numbering.of(node, d) >= 0);
  return bodies;
}

}  // namespace

Equilibrium::Equilibrium(const StaticProblem& problem, std::shared_ptr<SolidParts> parts)
    : problem_(problem),
      heat_(problem),
      prestrain_(problem),
      relations_(problem),
      parts_(std::move(parts)),
      elements_(nodes_of_elements(problem, !parts_)),
      system_(problem.numbering, elements_, symmetry_of(problem), parts_.get()),
      extent_(largest_entry(problem.mesh.coordinates)) {
  if (problem.contact) contact_.emplace(problem.mesh, problem.model, *problem.contact, *problem.registry, bodies_of(problem));
  if (problem.contact) offsets_.resize(problem.contact->zones.size());
  linear_ = !problem.has_following_loads();
  for (const ElementSet& set : problem.solids) {
    linear_ = linear_ && set.linear;
    has_memory_ = has_memory_ || set.kernel->has_memory;
  }
  if (!parts_) points_ = natural_state().points;
  if (heat_.changes_stiffness()) linear_ = false;
}

StaticState Equilibrium::natural_state() const {
  StaticState state;
  state.displacement.assign(problem_.n_dofs(), 0.0);
  state.relations.assign(relations_.size(), 0.0);
  if (parts_) {
    state.kept = parts_->natural();
    return state;
  }
  for (const ElementSet& set : problem_.solids) state.points.push_back(natural_points(set));
  return state;
}

bool Equilibrium::heat(double instant, StaticState& state) {
  if (!heat_.acts()) return false;
  if (!parts_) {
    heat_.move_to(instant, state.points);
    return true;
  }
  std::vector<PointValues> points(parts_->n_sets());
  heat_.move_to(instant, points);
  state.kept = parts_->heated(*state.kept, points);
  return true;
}

void Equilibrium::strain_as(const StaticState& state) {
  if (parts_) return parts_->strain_as(*state.kept);
  for (std::size_t s = 0; s < points_.size(); ++s)
    for (const PointQuantityRow& row : point_quantities)
      if (row.is_given) points_[s].*row.values = state.points[s].*row.values;
}

void Equilibrium::strain(double instant) {
  if (!parts_) {
    heat_.move_to(instant, points_);
    prestrain_.move_to(instant, points_);
    return;
  }
  std::vector<PointValues> points(parts_->n_sets());
  heat_.move_to(instant, points);
  prestrain_.move_to(instant, points);
  parts_->strain(points);
}

std::vector<double> Equilibrium::load(double instant, const StaticState& state) {
  const std::vector<double> values = problem_.imposed_values(instant), relations = relations_.values(instant, values);
  instant_ = instant;
  strain(instant);
  if (offset_skins(instant)) {
    pair(state.displacement);
    has_new_gaps_ = true;
  }
  given_ = problem_.dead_force(instant);
  given_.resize(problem_.n_dofs() + problem_.n_patches(), 0.0);
  given_.insert(given_.end(), relations.begin(), relations.end());
  external_ = given_;
  problem_.following_forces(instant, state.displacement, false,
                            [&](std::span<const std::int64_t> dofs, std::span<const double> force, std::span<const double>) {
                              for (std::size_t i = 0; i < dofs.size(); ++i) external_[dofs[i]] += force[i];
                            });
  std::vector<double> step(problem_.n_dofs(), 0.0);
  for (std::size_t dof = 0; dof < step.size(); ++dof)
    if (problem_.imposed[dof]) step[dof] = values[dof] - state.displacement[dof];
  return step;
}

bool Equilibrium::load_goes_on(double before, double last, double instant, const StaticState& state) const {
  if (strains_freely(state)) return false;
  const auto course = [&](const auto& load) { return goes_on(load(before), load(last), load(instant)); };
  try {
    const double imposed = course([&](double at) { return problem_.imposed_values(at); }),
                 forces = course([&](double at) { return problem_.external_force(at, state.displacement); });
    return std::min(imposed, forces) >= 0 && std::max(imposed, forces) > 0;
  } catch (const Error&) {  // a load need not have a value at the instant of the initial state
    return false;
  }
}

StaticState Equilibrium::at_rest(const StaticState& state) const {
  StaticState still = state;
  if (state.kept && has_variables()) still.kept = parts_->at_rest(*state.kept);
  for (std::size_t s = 0; s < still.points.size(); ++s) stop_flow(problem_.solids[s], still.points[s].variable);
  return still;
}

bool Equilibrium::offset_skins(double instant) {
  if (!contact_ || !problem_.offsets) return false;
  std::vector<std::vector<double>> offsets = problem_.offsets->at(instant);
  if (offsets == offsets_) return false;
  offsets_ = std::move(offsets);
  contact_->set_offsets(offsets_);
  return true;
}

void Equilibrium::pair(std::span<const double> displacement) {
  if (!contact_) return;
  const Phase phase("pairing");
  contact_->update_geometry(displacement);
  add_to_count("pairings", 1);
  add_to_count("contact cells", static_cast<double>(contact_->geometry().cells().size()));
}

bool Equilibrium::choose_masters() {
  if (!contact_) return false;
  const Phase phase("pairing");
  return contact_->choose_masters();
}

void Equilibrium::assemble(const StaticState& state, const StaticState& previous, NewtonMatrix wanted) {
  matrix_ = wanted;
  has_new_gaps_ = false;
  const bool keeps_stiffness = linear_ && has_stiffness_;
  if (contact_) {
    const Phase phase("contact");
    contact_->linearise(state.patches, wanted.curved);
  }
  start(keeps_stiffness);
  add_solids(state, previous, keeps_stiffness ? SolidMatrix::none : wanted.solid);
  add_springs(state, !keeps_stiffness && wanted.solid != SolidMatrix::none);
  add_following_loads(state);
  if (linear_ && !keeps_stiffness) system_.stiffness_is_complete();
  has_stiffness_ = true;
  relations_.assemble(state.relations, state.displacement, system_);
  add_contact(state);
}

void Equilibrium::start(bool keeps_stiffness) {
  std::vector<Coupling> couplings = relations_.couplings();
  if (contact_)
    for (const auto& [patch, node] : contact_->coupled_vertices())
      couplings.push_back({static_cast<std::int32_t>(patch), static_cast<std::int32_t>(node)});
  system_.start(couplings, keeps_stiffness);
}

void Equilibrium::add_solids(const StaticState& state, const StaticState& previous, SolidMatrix wanted) {
  const Phase phase("elements");
  if (parts_) return add_solids_of_parts(state, previous, wanted);
  cell_inside_out_.reset();
  for (std::size_t s = 0; s < problem_.solids.size(); ++s) {
    const ElementSet& set = problem_.solids[s];
    const StaticState* const from = set.kernel->has_memory ? &previous : origin_ ? &*origin_ : nullptr;
    const SolidStart start = from ? SolidStart{from->displacement, &from->points[s]} : SolidStart{};
    const auto add = [&](const ElementValues& element) {
      if (element.symmetric)
        system_.add(element.dofs, element.matrix, element.force);
      else
        system_.add_unsymmetric(element.dofs, element.matrix, element.force);
    };
    const auto inverted = evaluate_step(set, problem_.mesh, state.displacement, points_[s], start, wanted, add);
    if (!cell_inside_out_) cell_inside_out_ = inverted;
  }
}

void Equilibrium::add_solids_of_parts(const StaticState& state, const StaticState& previous, SolidMatrix wanted) {
  const SolidParts::Start first = origin_ ? SolidParts::Start{origin_->displacement, origin_->kept.get()} : SolidParts::Start{};
  const SolidParts::Start before =
      has_memory_ ? SolidParts::Start{previous.displacement, previous.kept.get()} : SolidParts::Start{};
  cell_inside_out_ = parts_->evaluate(state.displacement, wanted, before, first);
  const std::span<const double> force = parts_->force();
  for (std::size_t dof = 0; dof < force.size(); ++dof) system_.residual()[dof] += force[dof];
}

void Equilibrium::hold_points(StaticState& state) const {
  if (parts_)
    state.kept = parts_->keep();
  else
    state.points = points_;
}

void Equilibrium::hand_out(StaticState& state) const {
  if (!parts_ || state.kept) return;
  state.kept = parts_->put(state.points);
  state.points.clear();
}

void Equilibrium::add_springs(const StaticState& state, bool with_matrix) {
  const int d = problem_.dimension;
  std::vector<std::int64_t> dofs;
  std::vector<double> force, matrix;
  for (const Spring& spring : problem_.springs) {
    const int ends = spring.second < 0 ? 1 : 2;
    const auto stiffness = [&](int i, int j) {  // of both ends: K, -K
      const int a = std::max(i % d, j % d), b = std::min(i % d, j % d);
      return (i / d == j / d ? 1 : -1) * spring.stiffness[static_cast<std::size_t>(a * (a + 1) / 2 + b)];
    };
    dofs.clear(), matrix.clear();
    for (const std::int32_t node : {spring.first, spring.second})
      for (int i = 0; i < d && node >= 0; ++i) dofs.push_back(std::int64_t{node} * problem_.n_components() + i);
    force.assign(dofs.size(), 0.0);
    for (int i = 0; i < ends * d; ++i)
      for (int j = 0; j < ends * d; ++j) {
        force[i] += stiffness(i, j) * state.displacement[dofs[j]];
        if (with_matrix && j <= i) matrix.push_back(stiffness(i, j));
      }
    system_.add(dofs, matrix, force);
  }
}

void Equilibrium::add_following_loads(const StaticState& state) {
  if (!instant_ || !problem_.has_following_loads()) return;
  external_ = given_;
  std::vector<double> matrix, nothing;
  problem_.following_forces(*instant_, state.displacement, true,
                            [&](std::span<const std::int64_t> dofs, std::span<const double> force, std::span<const double> by) {
                              for (std::size_t i = 0; i < dofs.size(); ++i) external_[dofs[i]] += force[i];
                              matrix.assign(by.begin(), by.end());
                              for (double& entry : matrix) entry = -entry;
                              nothing.assign(dofs.size(), 0.0);
                              system_.add(dofs, matrix, nothing);
                            });
}

void Equilibrium::add_contact(const StaticState& state) {
  if (!contact_) return;
  const Phase phase("contact");
  std::vector<std::int64_t> unknowns;
  contact_->evaluate(state.patches, [&](const ContactTerm& term) {
    unknowns.clear();
    for (const ContactUnknown& unknown : term.unknowns) unknowns.push_back(system_.unknown(unknown.vertex, unknown.component));
    system_.add(unknowns, term.matrix, term.residual);
  });
}

void Equilibrium::hold(std::span<const std::int64_t> dofs) {
  const std::vector<SparseMatrix::RowSize> rows = system_.matrix().row_sizes(system_.first_multiplier());
  for (const std::int64_t dof : dofs) system_.add_diagonal(dof, rows[static_cast<std::size_t>(system_.equation(dof))].sum);
}

void Equilibrium::resist(std::span<const double> springs) {
  for (std::size_t dof = 0; dof < problem_.n_dofs(); ++dof)
    if (const std::int64_t e = problem_.numbering.equation[dof]; e >= 0)
      system_.add_diagonal(static_cast<std::int64_t>(dof), springs[static_cast<std::size_t>(e)]);
}

std::vector<double> Equilibrium::add(std::span<const double> solution, std::span<const double> step, StaticState& state) const {
  std::vector<double> increment(step.begin(), step.end());
  for (std::size_t dof = 0; dof < increment.size(); ++dof)
    if (const std::int64_t e = problem_.numbering.equation[dof]; e >= 0) increment[dof] = solution[e];
  for (std::size_t dof = 0; dof < increment.size(); ++dof) state.displacement[dof] += increment[dof];
  for (std::size_t r = 0; r < relations_.size(); ++r)
    state.relations[r] += solution[system_.equation(relations_.unknown(r, system_))];
  for (std::size_t p = 0; p < state.patches.lambda.size(); ++p)
    state.patches.lambda[p] += solution[problem_.numbering.of_patch(static_cast<std::int64_t>(p))];
  return increment;
}

double Equilibrium::power(std::span<const double> solution) const {
  const std::vector<double> unbalanced = right_side(std::vector<double>(problem_.n_dofs(), 0.0));
  return std::inner_product(unbalanced.begin(), unbalanced.begin() + system_.first_multiplier(), solution.begin(), 0.0);
}

double Equilibrium::resistance(std::span<const double> solution) const {
  std::vector<double> motion(solution.begin(), solution.end()), force(motion.size());
  std::fill(motion.begin() + system_.first_multiplier(), motion.end(), 0.0);
  system_.matrix().multiply(motion, force);
  return std::inner_product(motion.begin(), motion.end(), force.begin(), 0.0);
}

bool Equilibrium::makes_symmetric() const {
  return is_symmetric() && std::any_of(problem_.solids.begin(), problem_.solids.end(),
                                       [](const ElementSet& set) { return set.kernel->unsymmetric; });
}

bool Equilibrium::has_variables() const {
  return std::any_of(problem_.solids.begin(), problem_.solids.end(),
                     [](const ElementSet& set) { return set.n_variables() > 0; });
}

bool Equilibrium::flows(const StaticState& previous) const {
  if (parts_) return has_variables() && parts_->flows(*previous.kept);
  for (std::size_t s = 0; s < points_.size(); ++s)
    if (has_flowed(problem_.solids[s], points_[s].variable, previous.points[s].variable)) return true;
  return false;
}

ForceFigures Equilibrium::forces(const StaticState& state, const StaticState& previous) const {
  const std::vector<double>& residual = system_.residual();
  const auto width = static_cast<std::size_t>(problem_.n_components()), d = static_cast<std::size_t>(problem_.dimension);
  ForceFigures figures;
  const auto refer_to = [&](const std::vector<double>& forces, std::size_t n_components) {
    figures.reference = std::max(figures.reference, largest_entry(forces));
    figures.reference_vector = std::max(figures.reference_vector, longest_force(forces, n_components, d));
  };
  const std::vector<double> held = relations_.forces(state.relations),
                            pushed = contact_ ? contact_->forces(state.patches) : std::vector<double>();
  refer_to(held, width);
  refer_to(pushed, d);
  std::vector<double> left(problem_.n_dofs(), 0.0), acting(problem_.n_dofs(), 0.0);
  // displacements that went to zero leave the round-off of those before them; a body that turns has that of its turn
  const double moved = std::max({longest_displacement(state.displacement, width, d),
                                 longest_displacement(previous.displacement, width, d), vanishing_displacement * extent_});
  const std::vector<SparseMatrix::RowSize> rows = system_.matrix().row_sizes(system_.first_multiplier());
  for (std::size_t dof = 0; dof < problem_.n_dofs(); ++dof) {
    const double unbalanced = std::abs(residual[dof] - external_[dof]);
    if (problem_.imposed[dof]) {
      acting[dof] = unbalanced;
    } else if (const std::int64_t equation = problem_.numbering.equation[dof]; equation >= 0) {
      acting[dof] = external_[dof];
      left[dof] = unbalanced;
      if (!std::isfinite(unbalanced))
        return {.unbalanced = unbalanced,
                .worst_dof = static_cast<std::int64_t>(dof),
                .significant = unbalanced,
                .over_own = unbalanced,
                .unbalanced_vector = unbalanced};
      if (!reference_forces_.empty() && reference_forces_[dof] > 0)
        figures.over_own = std::max(figures.over_own, unbalanced / reference_forces_[dof]);
      if (unbalanced > figures.unbalanced || figures.worst_dof < 0) {
        figures.unbalanced = unbalanced;
        figures.worst_dof = static_cast<std::int64_t>(dof);
      }
      const SparseMatrix::RowSize& row = rows[static_cast<std::size_t>(equation)];
      const double summed = row.sum * moved + (first_forces_.empty() ? 0.0 : first_forces_[dof]);
      const double noise = round_off * std::sqrt(row.entries) * summed;
      if (!(unbalanced <= noise) || !std::isfinite(noise))  // displacements that overflow excuse nothing
        figures.significant = std::max(figures.significant, unbalanced);
      const std::size_t node = dof / width, component = dof % width;
      const double pressed = pushed.empty() || component >= d ? 0 : pushed[node * d + component];
      for (const double force : {external_[dof], held[dof], pressed})
        if (std::abs(force) > far_beyond * noise) figures.felt = std::max(figures.felt, std::abs(force));
    }
  }
  figures.unbalanced_vector = longest_force(left, width, d);
  refer_to(acting, width);
  return figures;
}

std::vector<double> Equilibrium::unbalanced() const {
  std::vector<double> forces(problem_.n_dofs(), 0.0);
  for (std::size_t dof = 0; dof < forces.size(); ++dof)
    if (!problem_.imposed[dof] && problem_.numbering.equation[dof] >= 0) forces[dof] = system_.residual()[dof] - external_[dof];
  return forces;
}

std::vector<double> Equilibrium::internal_forces(const StaticState& state) const {
  const std::vector<double>& residual = system_.residual();
  std::vector<double> forces(residual.begin(), residual.begin() + static_cast<std::ptrdiff_t>(problem_.n_dofs()));
  const std::vector<double> held = relations_.forces(state.relations);
  for (std::size_t dof = 0; dof < forces.size(); ++dof) forces[dof] -= held[dof];
  if (!contact_) return forces;
  const std::vector<double> pushed = contact_->forces(state.patches);
  const auto d = static_cast<std::size_t>(problem_.dimension), width = static_cast<std::size_t>(problem_.n_components());
  for (std::size_t i = 0; i < pushed.size(); ++i) forces[i / d * width + i % d] += pushed[i];
  return forces;
}

MotionFigures Equilibrium::motion(std::span<const double> increment, const StaticState& state) const {
  const auto width = static_cast<std::size_t>(problem_.n_components()), d = static_cast<std::size_t>(problem_.dimension);
  return {.increment = longest_displacement(increment, width, d),
          .whole = longest_displacement(state.displacement, width, d),
          .vanishing = contact_ ? vanishing_displacement * contact_->smallest_patch() : 0.0};
}

std::int64_t Equilibrium::n_constraints(const StaticState& state) const {
  return relations_.n_constraints() + (contact_ ? contact_->n_constraints(state.patches) : 0);
}

std::string Equilibrium::place(std::int64_t dof) const {
  const auto node = static_cast<std::int32_t>(dof / problem_.n_components());
  return part("one_of_another", {{"one", problem_.dof_name(dof)}, {"other", Bodies(problem_.mesh).name_at(node)}});
}

std::vector<std::int64_t> Equilibrium::dofs_of(std::span<const std::int64_t> equations) const {
  const std::set<std::int64_t> among(equations.begin(), equations.end());
  std::vector<std::int64_t> dofs;
  for (std::size_t dof = 0; dof < problem_.n_dofs(); ++dof)
    if (problem_.numbering.equation[dof] >= 0 && among.contains(problem_.numbering.equation[dof]))
      dofs.push_back(static_cast<std::int64_t>(dof));
  return dofs;
}

std::string Equilibrium::names(std::span<const std::int64_t> equations) const {
  std::string names;
  constexpr std::size_t most = 5;
  std::size_t shown = 0;
  const Bodies bodies(problem_.mesh);
  std::map<std::int32_t, std::int64_t> first_of;  // of each body that is loose
  for (const std::int64_t dof : dofs_of(equations))
    first_of.emplace(bodies.of(static_cast<std::int32_t>(dof / problem_.n_components())), dof);
  for (const auto& [body, dof] : first_of)
    if (shown < most)
      names += (shown++ ? ", " : "") + part("dof_of_body", {{"dof", problem_.dof_name(dof)}, {"body", bodies.name_at(body)}});
  std::set<std::string> told;  // many relations of one keyword have one name
  for (std::size_t r = 0; r < relations_.size() && shown < most; ++r)
    if (std::count(equations.begin(), equations.end(), system_.equation(relations_.unknown(r, system_))) > 0)
      if (const std::string name = relations_.name(r); told.insert(name).second) names += (shown++ ? ", " : "") + name;
  return names.empty() ? part("contact_multipliers") : names;
}

void Equilibrium::save(const hdf5::Group& group) const {
  group.set("solid_matrix", static_cast<std::int64_t>(matrix_.solid));
  group.set("curved_matrix", std::int64_t{matrix_.curved});
  if (instant_) group.set("instant", *instant_);
  std::vector<std::int32_t> couplings;
  for (const Coupling& coupling : system_.couplings()) couplings.insert(couplings.end(), {coupling.a, coupling.b});
  group.write("couplings", couplings);
  if (!first_forces_.empty()) group.write("first_forces", first_forces_);
  if (!contact_) return;
  group.write("slave_cuts", contact_->geometry().cuts());
  write(group, contact_->geometry().kept());
  const std::span<const double> walls = contact_->geometry().walls_decided_at();
  if (!walls.empty()) group.write("walls_at", std::vector<double>(walls.begin(), walls.end()));
}

void Equilibrium::resume(const hdf5::Group& group, const StaticState& state, std::span<const double> rest) {
  const auto saved = group.read<std::int32_t>("couplings");
  std::vector<Coupling> couplings;
  for (std::size_t i = 0; i + 1 < saved.size(); i += 2) couplings.push_back({saved[i], saved[i + 1]});
  if (group.has("first_forces")) first_forces_ = group.read<double>("first_forces");
  system_.start(couplings, linear_ && has_stiffness_);
  if (group.has_attribute("instant")) load(group.real("instant"), state);
  rest_at(rest);
  if (contact_ && group.has("slave_cuts")) contact_->set_cuts(group.read<std::int32_t>("slave_cuts"));
  if (contact_) contact_->keep(read_kept_pairing(group));
  if (contact_ && group.has("walls_at")) contact_->decide_walls(group.read<double>("walls_at"));
  pair(state.displacement);
  assemble(state, state, {static_cast<SolidMatrix>(group.integer("solid_matrix")), group.integer("curved_matrix") != 0});
}

}  // namespace lacon
