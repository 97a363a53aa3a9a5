#pragma once
// Processes that may have cells (solid_parts.hpp): those of PETSc, or those that share a factor of MUMPS.
#include <new>
#include <string>
#include <string_view>

#include "lacon/catalog/messages.hpp"

namespace lacon {

/// What they answer where something goes wrong: the first word of failed WHY, or the whole.
inline constexpr std::string_view has_failed = "failed ", no_memory = "no memory";
/// WHY.
inline std::string reason_of(std::string_view answer) {
  return std::string(answer.starts_with(has_failed) ? answer.substr(has_failed.size()) : answer);
}
/// Throws std::bad_alloc or SOLVER_8 where an answer is another one than done.
inline void require_done(const std::string& answer) {
  if (answer == no_memory) throw std::bad_alloc();
  if (answer != "done") fail("SOLVER_8", {{"reason", reason_of(answer)}});
}

class PartProcesses {
 public:
  virtual ~PartProcesses() = default;
  virtual int size() const = 0;
  /// On which they run: known when they do.
  virtual int machines() const { return 1; }

  /// Start them, unless they run. Throws SOLVER_6, SOLVER_8, also where they have ended with what nobody else has.
  virtual void start() = 0;
  /// Say a line to all of them (cells.hpp) and wait until each has done it. @return done, or why not  Throws SOLVER_8 where one
  /// has ended.
  virtual std::string ask(const std::string& line) = 0;
  /// From now on they have what nobody else has: they are not started a second time.
  virtual void keep() = 0;
};

}  // namespace lacon
