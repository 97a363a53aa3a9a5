#include "lacon/operators/evolution/observers/restart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <span>

#include "lacon/catalog/messages.hpp"
#include "lacon/operators/program/program.hpp"

namespace lacon {
namespace {

namespace fs = std::filesystem;

constexpr const char* record_name = "restart.h5";
constexpr int patience = 200;  // times as long as a record takes, before the next one

void write_message(const hdf5::Group& group, const std::vector<Message>& messages) {
  std::vector<std::string> severities, ids, texts, advices;
  for (const Message& m : messages) {
    severities.emplace_back(1, m.severity);
    ids.push_back(m.id);
    texts.push_back(m.text);
    advices.push_back(m.advice);
  }
  group.write_strings("severity", severities);
  group.write_strings("id", ids);
  group.write_strings("text", texts);
  group.write_strings("do", advices);
}

std::vector<Message> read_messages(const hdf5::Group& group) {
  const auto severities = group.read_strings("severity"), ids = group.read_strings("id"), texts = group.read_strings("text"),
             advices = group.read_strings("do");
  std::vector<Message> messages;
  for (std::size_t i = 0; i < ids.size(); ++i) messages.push_back({severities.at(i).at(0), ids[i], texts.at(i), advices.at(i)});
  return messages;
}

void write_course(const hdf5::Group& group, const Course& course) {
  std::vector<double> instants, ratios, excesses;
  std::vector<std::int64_t> iterations, failed, depends, astray, left, stayed;
  std::vector<Message> failures;
  for (const Attempt& attempt : course) {
    instants.push_back(attempt.instant);
    iterations.push_back(attempt.iterations);
    failed.push_back(attempt.failure.has_value());
    if (!attempt.failure) continue;
    const FailureNature& nature = attempt.failure->nature();
    failures.push_back(attempt.failure->message());
    depends.push_back(nature.depends_on_step);
    astray.push_back(nature.led_astray);
    left.push_back(nature.left_unstable);
    stayed.push_back(nature.stayed_unstable);
    ratios.push_back(nature.ratio.value_or(NAN));
    excesses.push_back(nature.excess);
  }
  group.write("instant", instants);
  group.write("iterations", iterations);
  group.write("failed", failed);
  const hdf5::Group known = group.create("failures");
  write_message(known, failures);
  known.write("depends_on_step", depends);
  known.write("led_astray", astray);
  known.write("left_unstable", left);
  known.write("stayed_unstable", stayed);
  known.write("ratio", ratios);
  known.write("excess", excesses);
}

Course read_course(const hdf5::Group& group) {
  const auto instants = group.read<double>("instant");
  const auto iterations = group.read<std::int64_t>("iterations"), failed = group.read<std::int64_t>("failed");
  const hdf5::Group known = group.open("failures");
  const std::vector<Message> failures = read_messages(known);
  const auto depends = known.read<std::int64_t>("depends_on_step");
  const auto astray = known.read<std::int64_t>("led_astray"), left = known.read<std::int64_t>("left_unstable"),
             stayed = known.read<std::int64_t>("stayed_unstable");
  const auto ratios = known.read<double>("ratio"), excesses = known.read<double>("excess");
  Course course;
  std::size_t failure = 0;
  for (std::size_t i = 0; i < instants.size(); ++i) {
    course.push_back({.instant = instants[i], .iterations = static_cast<int>(iterations.at(i)), .failure = {}});
    if (!failed.at(i)) continue;
    FailureNature nature{.depends_on_step = depends.at(failure) != 0,
                         .ratio = {},
                         .excess = excesses.at(failure),
                         .led_astray = astray.at(failure) != 0,
                         .left_unstable = left.at(failure) != 0,
                         .stayed_unstable = stayed.at(failure) != 0};
    if (!std::isnan(ratios.at(failure))) nature.ratio = ratios[failure];
    course.back().failure.emplace(failures.at(failure++), nature);
  }
  return course;
}

/// Of all cells of a set, some at a time where processes have them.
void write_points(const hdf5::Group& group, const std::string& name, const StaticState& state, std::size_t set,
                  PointQuantity quantity) {
  std::vector<double> none;
  if (!state.kept) return group.write(name, values_of(state, set, quantity, none));
  const std::size_t width = state.kept->width(set, quantity);
  group.write_rows<double>(name, {state.kept->n_cells(set), width}, [&](std::size_t first, std::span<double> rows) {
    std::vector<CellRange> cells(state.n_sets());
    cells[set] = {first, rows.size() / width};
    std::ranges::copy(state.kept->values(quantity, cells)[set], rows.begin());
  });
}

std::vector<Message> alarms_so_far() {
  std::vector<Message> alarms;
  for (const Message& message : messages_so_far())
    if (message.severity == 'A') alarms.push_back(message);
  return alarms;
}

}  // namespace

std::optional<hdf5::Reader> restart_record(const Order& order, const Base& base) {
  std::error_code error;
  const fs::path file = base.result_folder() / record_name;
  if (!order.resume || !fs::exists(file, error)) return std::nullopt;
  try {
    return hdf5::Reader(file);
  } catch (const Error& failure) {
    fail("EVOLUTION_31", {{"reason", failure.message().text}});
  }
}

std::optional<double> origin_in(const hdf5::Group& record) {
  return record.has_attribute("origin") ? std::optional(record.real("origin")) : std::nullopt;
}

void write(const hdf5::Group& group, const StaticState& state) {
  group.write("displacement", state.displacement);
  group.write("relations", state.relations);
  std::vector<std::int8_t> status;
  for (const Status s : state.patches.status) status.push_back(static_cast<std::int8_t>(s));
  group.write("patches/status", status);
  for (const PatchQuantity& quantity : patch_quantities)
    group.write(std::string("patches/") + quantity.component, state.patches.*quantity.values);
  group.set("sets", static_cast<std::int64_t>(state.n_sets()));
  for (std::size_t s = 0; s < state.n_sets(); ++s) {
    for (const PointQuantityRow& row : point_quantities)
      if (!row.is_given || holds(state, s, row.quantity))
        write_points(group, fmt::format("points/{}/{}", s, row.name), state, s, row.quantity);
  }
}

StaticState read_state(const hdf5::Group& group) {
  StaticState state;
  state.displacement = group.read<double>("displacement");
  state.relations = group.read<double>("relations");
  for (const std::int8_t status : group.read<std::int8_t>("patches/status"))
    state.patches.status.push_back(static_cast<Status>(status));
  for (const PatchQuantity& quantity : patch_quantities)
    state.patches.*quantity.values = group.read<double>(std::string("patches/") + quantity.component);
  for (std::int64_t s = 0; s < group.integer("sets"); ++s) {
    PointValues& points = state.points.emplace_back();
    for (const PointQuantityRow& row : point_quantities)
      if (const std::string name = fmt::format("points/{}/{}", s, row.name); !row.is_given || group.has(name))
        points.*row.values = group.read<double>(name);
  }
  return state;
}

RestartRecord::RestartRecord(const Base& base, std::optional<double> origin, InstantSolver& solver, const Archive& archive,
                             std::map<std::string, EvolutionObserver*> observers)
    : folder_(base.result_folder()), origin_(origin), solver_(solver), archive_(archive), observers_(std::move(observers)) {}

fs::path RestartRecord::base_file(std::int64_t number) const { return folder_ / fmt::format("restart_base_{}.h5", number); }

Course RestartRecord::go_on(const hdf5::Group& record) {
  try {
    take(record);
    const std::vector<Message> told = messages_so_far();  // those of reading the problem, again
    for (const Message& alarm : read_messages(record.open("alarms")))
      if (std::ranges::none_of(told, [&](const Message& m) { return m.id == alarm.id && m.text == alarm.text; })) inform(alarm);
    return read_course(record.open("course"));
  } catch (const std::exception& failure) {
    fail("EVOLUTION_31", {{"reason", failure.what()}});
  }
}

void RestartRecord::take(const hdf5::Group& record) {
  stored_base_ = record.integer("base");
  std::optional<hdf5::Reader> base;
  if (stored_base_ > 0) base.emplace(base_file(stored_base_));
  solver_.resume(record.open("solver"), base ? &*base : nullptr);
  for (const auto& [name, observer] : observers_) observer->resume(record.open("observers/" + name));
}

void RestartRecord::accept(const SolvedInstant& solved) {
  using clock = std::chrono::steady_clock;
  const clock::time_point start = clock::now();
  if (!archive_.ends_with(solved.instant) || solved.last || start < next_) return;
  const Phase phase("restart record");
  const std::int64_t before = stored_base_, number = solver_.number_of_base();
  if (number > 0 && number != before)
    hdf5::write_sealed(base_file(number), [&](const hdf5::Group& root) { solver_.save_base(root); });
  hdf5::write_sealed(folder_ / record_name, [&](const hdf5::Group& root) {
    root.set("lacon_type", std::string_view("restart"));
    root.set("format", std::int64_t{1});
    root.set("base", number);
    if (origin_) root.set("origin", *origin_);
    write_course(root.create("course"), *solved.course);
    write_message(root.create("alarms"), alarms_so_far());
    solver_.save(root.create("solver"));
    for (const auto& [name, observer] : observers_) observer->save(root.create("observers/" + name));
  });
  stored_base_ = number;
  std::error_code error;
  if (before > 0 && before != number) fs::remove(base_file(before), error);
  if (!std::getenv("LACON_RESTART_ALWAYS")) next_ = clock::now() + patience * (clock::now() - start);
}

}  // namespace lacon
