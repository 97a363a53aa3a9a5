#pragma once
// Where bodies that nothing holds come to rest: on the patches that their load leads them to.
#include <cstddef>
#include <span>
#include <vector>

#include "lacon/assembly/loose_motions.hpp"
#include "lacon/operators/contact/contact_state.hpp"
#include "lacon/operators/evolution/newton/equilibrium.hpp"

namespace lacon {

/// As rigid bodies they move by what the last system does not resist, along their load, until near patches
/// (ContactState::may_hold) stop them: the most work that gaps, linear in the motions, allow. Those patches that push then, and
/// others that touch.
/// @param motions LooseMotions::of the system  @param step of the imposed displacements
/// @return nothing where the load does no work along the motions, or near patches do not stop them
std::vector<std::size_t> patches_under_load(const ContactState& contact, const Patchwise& patches,
                                            const Equilibrium& equilibrium, const LooseMotions& motions,
                                            std::span<const double> step);

}  // namespace lacon
