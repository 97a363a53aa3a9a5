#pragma once
// Internal variables of a result whose laws have none: code_aster's results have V1 = 0 then.
#include "lacon/elements/registry.hpp"
#include "lacon/structures/base.hpp"

namespace lacon {

/// Whether a law of a stage has internal variables on some element of the result's model. Where VARI_ELGA is missing all the
/// same it was not kept.
bool laws_have_variables(const Base& base, const Result& result, const ResultStage& stage, Registry& registry);
/// The same of any stage.
bool laws_have_variables(const Base& base, const Result& result, Registry& registry);

/// VARI_ELGA where no law has internal variables. @param stress SIEF_ELGA of the same instant
Field zero_variables(Field stress);

}  // namespace lacon
