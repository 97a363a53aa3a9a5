#pragma once
// The restart record of a result that grows: what another process needs to go on behind the last archived instant with the same
// bits. docs/structures.md, section 2.
#include <chrono>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "lacon/operators/evolution/evolution.hpp"
#include "lacon/operators/evolution/newton/equilibrium.hpp"
#include "lacon/operators/evolution/observers/archive.hpp"
#include "lacon/structures/hdf5.hpp"

namespace lacon {

/// The record that an order is to go on from; nothing where it is to begin, or where no process has come to an instant.
std::optional<hdf5::Reader> restart_record(const Order& order, const Base& base);
/// The instant of ETAT_INIT that the computation of a record began with.
std::optional<double> origin_in(const hdf5::Group& record);

void write(const hdf5::Group& group, const StaticState& state);
StaticState read_state(const hdf5::Group& group);

/// The observer behind the archive. The record is replaced when the archive has got an instant, as long as that takes half a
/// percent of the time: where instants go by in no time, it is that of one of the last. With LACON_RESTART_ALWAYS it is
/// replaced with each archived instant, whatever that takes. What is large in it, the base of the linear solver, lies in a file
/// beside it as long as it serves. Where the computation is complete the launcher removes it, when it has entered the result:
/// where it is ended before that, the next one gives the same order again.
class RestartRecord : public EvolutionObserver {
 public:
  /// @param observers that have something to remember, by name; all arguments must outlive it
  RestartRecord(const Base& base, std::optional<double> origin, InstantSolver& solver, const Archive& archive,
                std::map<std::string, EvolutionObserver*> observers);

  /// Bring solver and observers to where a record was written, and say its alarms again.
  /// @return the attempts until then. Throws EVOLUTION_31 where the record is not sound.
  Course go_on(const hdf5::Group& record);
  void accept(const SolvedInstant& solved) override;

 private:
  void take(const hdf5::Group& record);
  std::filesystem::path base_file(std::int64_t number) const;

  std::filesystem::path folder_;
  std::optional<double> origin_;
  InstantSolver& solver_;
  const Archive& archive_;
  std::map<std::string, EvolutionObserver*> observers_;
  std::int64_t stored_base_ = 0;
  std::chrono::steady_clock::time_point next_{};  ///< before which no record is written
};

}  // namespace lacon
