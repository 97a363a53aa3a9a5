#pragma once
// MACR_ADAP_MAIL: uniform refinement.
#include "lacon/structures/mesh.hpp"
#include "lacon/structures/order.hpp"

namespace lacon {

/// The mesh MAILLAGE_NP1; prints a summary on stdout. Errors: see operators/meshing/refine.hpp, and KEYWORD_18 for an
/// ADAPTATION that is not RAFFINEMENT_UNIFORME.
Mesh macr_adap_mail(const Mesh& mesh, const Keywords& keywords);

}  // namespace lacon
