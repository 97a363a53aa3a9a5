#include "lacon/operators/evolution/linear_solver.hpp"

#include <string>

#include "lacon/assembly/mumps_engine.hpp"
#include "lacon/catalog/messages.hpp"

namespace lacon {

std::unique_ptr<Engine> engine_of(const Keywords& solver, const Base& base) {
  if (const std::string method = solver.text("METHODE"); method != "MUMPS") inform("EVOLUTION_24", {{"method", method}});
  using Use = MumpsOptions::Use;
  using Memory = MumpsOptions::Memory;
  const auto use = [](bool always) { return always ? Use::always : Use::never; };
  const std::string acceleration = solver.text("ACCELERATION"), memory = solver.text("GESTION_MEMOIRE");
  return std::make_unique<MumpsEngine>(
      MumpsOptions{.memory_margin = static_cast<int>(solver.integer("PCENT_PIVOT")),
                   .residual_tolerance = solver.real("RESI_RELA"),
                   .single_precision = solver.has("MIXER_PRECISION") ? use(solver.yes("MIXER_PRECISION")) : Use::where_it_pays,
                   .low_rank = acceleration == "AUTO" ? Use::where_it_pays : use(acceleration.starts_with("LR")),
                   .low_rank_threshold = solver.real("LOW_RANK_SEUIL"),
                   .memory = memory == "OUT_OF_CORE" ? Memory::out_of_core
                             : memory == "IN_CORE"   ? Memory::in_core
                                                     : Memory::where_needed,
                   .folder = base.folder() / "factor.partial"});
}

}  // namespace lacon
