#pragma once
// The result of a computation as it grows: fields and parameters of the instants that are kept. From the first solved instant
// on its index is in the base, and replaced with each further one, so that whatever ends the computation loses none of them.
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "lacon/operators/contact/contact_field.hpp"
#include "lacon/operators/evolution/evolution.hpp"
#include "lacon/operators/evolution/observers/observation.hpp"
#include "lacon/operators/evolution/origin.hpp"
#include "lacon/operators/evolution/state_fields.hpp"

namespace lacon {

/// ARCHIVAGE: which instants and fields are kept. The first and the last instant always are.
class ArchiveChoice {
 public:
  ArchiveChoice(const Keywords& keywords, const Base& base);
  bool keeps(double instant, std::int64_t step) const { return instants_.has(instant, step); }
  bool keeps(const std::string& field) const { return !excluded_.contains(field); }

 private:
  ChosenInstants instants_;
  std::set<std::string> excluded_;
};

/// What a file of masters holds, docs/structures.md section 3.
void write(const hdf5::Group& group, const PairedMasters& masters);

class Archive : public EvolutionObserver {
 public:
  /// With `reuse` the instants of the result up to the initial state are taken over: throws EVOLUTION_12 where that cannot be.
  /// @param tables stored with the result as they are at the time, by name; all arguments must outlive it
  /// @param resumes resume() follows, which knows what was taken over
  Archive(const Order& order, const Base& base, const Present& present, const std::optional<Origin>& origin,
          std::function<std::map<std::string, Table>()> tables, bool resumes = false);

  void start(double instant) override;
  void begin(double instant) override;
  void iterate(double instant, const IterationReport& report) override;
  void accept(const SolvedInstant& solved) override;
  /// The result as it is, with what this computation has taken over.
  void save(const hdf5::Group& group) const override;
  void resume(const hdf5::Group& group) override;
  /// Whether this instant is the last that is kept.
  bool ends_with(double instant) const { return !result_.instants.empty() && result_.instants.back() == instant; }
  /// Where no instant was kept before a failure, the base stays as it was.
  void end(bool completed) override;

 private:
  /// Negative pivots of the last factorisation of an instant, and how many were to be expected; -1 where nothing was
  /// factorised.
  struct Pivots {
    std::int64_t found = -1, expected = -1;
  };
  void go_on(const Order& order, const std::optional<Origin>& origin);
  void number_zones();
  void add(double instant, int iterations);
  void store(bool complete);
  void add_masters(std::int64_t number);
  void discard();
  void add_balance(const std::vector<ZoneBalance>& zones);
  static void add_table(Result& result, const std::string& name, const Table& table);
  void put(const std::string& parameter, double value);
  const Base& base_;
  Present present_;
  FieldMakers fields_;
  std::function<std::map<std::string, Table>()> tables_;
  ArchiveChoice choice_;
  std::vector<std::size_t> zone_numbers_;  ///< in the result's parameters, of each zone
  Pivots pivots_;
  Result result_;
  std::size_t taken_over_ = 0;  ///< instants of a result that goes on
  std::size_t there_ = 0;       ///< instants in the index of a computation that goes on: it does not get fewer
  bool stored_ = false;         ///< an index with instants of this computation is in the base
};

}  // namespace lacon
