#pragma once
// OBSERVATION and SUIVI_DDL: values of fields at chosen places, kept in a table or printed as the computation goes.
#include <functional>
#include <map>
#include <optional>
#include <ostream>
#include <span>
#include <string>
#include <vector>

#include "lacon/operators/evolution/evolution.hpp"
#include "lacon/operators/evolution/state_fields.hpp"
#include "lacon/operators/program/study_function.hpp"
#include "lacon/structures/base.hpp"

namespace lacon {

/// The instants that INST, LIST_INST (with PRECISION and CRITERE) or every so many steps name.
class ChosenInstants {
 public:
  /// @param steps keyword of the number of steps: "PAS_ARCH"
  ChosenInstants(const Keywords& keywords, const Base& base, std::string_view steps);
  bool has(double instant, std::int64_t step) const;
  /// Those that are named, lie within the steps of a computation and are none of them. @param steps ascending
  std::vector<double> missing(std::span<const double> steps) const;

 private:
  bool is_at(double instant, double listed) const;

  std::int64_t every_;
  bool listed_;
  std::vector<double> instants_;
  double precision_;
  bool relative_;
};

/// EVOLUTION_56: instants that ARCHIVAGE and OBSERVATION of a computation name and that it will not come to.
void tell_missing_instants(const Keywords& keywords, const Base& base, std::span<const double> steps);

/// One occurrence of OBSERVATION or SUIVI_DDL: what it looks at.
class Observer {
 public:
  /// Throws MESH_1, MESH_2 (groups), OBSERVATION_5 (nodes, cells that do not exist).
  Observer(const Keywords& keywords, const Base& base, const Mesh& mesh, std::string name);

  struct Value {
    std::string component;  ///< empty for a formula
    std::int32_t node = -1, cell = -1, point = -1;
    double value;
    Field::Presence presence = Field::there;
  };
  /// Values at the current instant. Throws OBSERVATION_1 to OBSERVATION_4 where the field has not what is looked at.
  std::vector<Value> look(const FieldMakers& fields) const;
  bool has_formula() const { return formula_.has_value(); }
  /// A row of the table of observations for each value.
  void add_rows(Table& table, const std::vector<Value>& values, std::int64_t number, double instant) const;
  /// A line for each value.
  void print(std::ostream& out, const std::vector<Value>& values) const;

 private:
  std::vector<std::size_t> components_of(const Field& field) const;
  std::vector<Value> collect(const Field& field) const;
  void collect_row(const Field& field, const std::vector<std::size_t>& components, std::size_t row, const Value& place,
                   std::vector<Value>& values) const;
  std::vector<Value> of_cell(const Field& field, const std::vector<std::size_t>& components, std::size_t i) const;
  std::vector<Value> of_formula(const std::vector<Value>& values) const;
  void check_place(const Field& field) const;

  Keywords keywords_;
  std::string name_;
  std::vector<char> nodes_, cells_;  ///< of the mesh: looked at
  std::optional<StudyFunction> formula_;
};

/// Every OBSERVATION and SUIVI_DDL of a computation, and the table they fill.
class Observations : public EvolutionObserver {
 public:
  /// @param fields of the present instant
  Observations(const Keywords& keywords, const Base& base, const Mesh& mesh, FieldMakers fields);

  /// Look at the initial state: fills in rows where OBSE_ETAT_INIT says so, and refuses at once what cannot be looked at.
  void start(double instant) override;
  void accept(const SolvedInstant& solved) override;
  void save(const hdf5::Group& group) const override;
  void resume(const hdf5::Group& group) override;
  /// The table, nothing without OBSERVATION.
  const std::optional<Table>& table() const { return table_; }

 private:
  struct Watch {
    Observer observer;
    std::optional<ChosenInstants> instants;  ///< none: SUIVI_DDL
    bool initial;
    std::int64_t count = 0;
  };
  void record(Watch& watch, double instant);

  FieldMakers fields_;
  std::vector<Watch> watches_;
  std::optional<Table> table_;
};

}  // namespace lacon
