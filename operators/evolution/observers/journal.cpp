#include "lacon/operators/evolution/observers/journal.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "lacon/operators/evolution/observers/failed_step.hpp"
#include "lacon/operators/program/blas.hpp"
#include "lacon/operators/program/machine.hpp"
#include "lacon/operators/program/program.hpp"
#include "lacon/structures/parallel.hpp"

namespace lacon {
namespace {

const char* const name = "journal.jsonl";

/// A number that JSON does not have becomes null.
nlohmann::json limit_of(const std::optional<double>& criterion) { return criterion ? nlohmann::json(*criterion) : nullptr; }

nlohmann::json machine() {
  nlohmann::json told = {
      {"lacon", program_version()}, {"processor", processor_name()}, {"threads", n_threads()}, {"blas", nullptr}};
  if (const std::optional<Blas> blas = present_blas()) told["blas"] = blas->library + ", kernel " + blas->kernel;
  return told;
}

}  // namespace

Journal::Journal(const std::filesystem::path& result, const TimeSteps& steps, double begins,
                 const ConvergenceCriteria& criteria, const Present& present)
    : folder_(result), present_(present), start_(std::chrono::steady_clock::now()) {
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  out_.open(folder_ / name, std::ios::app);
  nlohmann::json limits = {{"rela", limit_of(criteria.resi_glob_rela)},
                           {"maxi", limit_of(criteria.resi_glob_maxi)},
                           {"refe", limit_of(criteria.resi_refe_rela)}};
  if (present.contact) limits.update({{"geometry", criteria.resi_geom}, {"constraint", criteria.constraint}});
  // behind a line that a process which was killed has left half-written
  out_ << '\n'
       << nlohmann::json{{"event", "start"},
                         {"from", begins},
                         {"instants", steps.values},
                         {"limits", limits},
                         {"patches", present.contact ? present.contact->n_patches() : 0},
                         {"machine", machine()},
                         {"since",
                          std::chrono::duration_cast<std::chrono::seconds>(std::chrono::system_clock::now().time_since_epoch())
                              .count()}}
       << std::endl;
}

double Journal::seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

void Journal::begin(double instant) {
  out_ << nlohmann::json{{"event", "begin"}, {"instant", instant}, {"at", seconds()}} << std::endl;
}

void Journal::iterate(double instant, const IterationReport& report) {
  nlohmann::json line = {{"event", "iteration"},
                         {"instant", instant},
                         {"iteration", report.iteration},
                         {"rela", report.rela},
                         {"maxi", report.maxi},
                         {"refe", report.refe},
                         {"factorised", report.solution.factorised},
                         {"converged", report.converged()},
                         {"seconds", report.seconds},
                         {"at", seconds()}};
  if (report.worst_dof >= 0) line["worst"] = present_.problem.dof_name(report.worst_dof);
  if (present_.contact) {
    const std::vector<Status>& status = present_.state.patches.status;
    line.update({{"changes", report.status_changes},
                 {"active", std::count(status.begin(), status.end(), Status::active)},
                 {"geometry", report.geometry},
                 {"constraint", report.constraint}});
  }
  out_ << line << std::endl;
}

void Journal::accept(const SolvedInstant& solved) {
  out_ << nlohmann::json{{"event", "solved"}, {"instant", solved.instant}, {"iterations", solved.iterations},
                         {"at", seconds()},   {"phases", phases_so_far()}, {"memory", peak_memory()}}
       << std::endl;
}

void Journal::end(bool completed) {
  out_ << nlohmann::json{{"event", "end"}, {"completed", completed}, {"at", seconds()}} << std::endl;
  if (completed || exists(folder_ / "index.h5") || exists(folder_ / failed_step_file)) return;
  out_.close();
  std::error_code error;
  std::filesystem::remove(folder_ / name, error);
  std::filesystem::remove(folder_, error);  // only where it is empty
}

}  // namespace lacon
