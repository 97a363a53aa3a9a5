#pragma once
// Processes that may have cells (solid_parts.hpp): those of PETSc, or those that share a factor of MUMPS.
#include <string>

namespace lacon {

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
