#pragma once
// Files that a process may have open: memory that others see takes one for each piece, and a program that is talked with two.

namespace lacon {

/// Throws SOLVER_17 where this error of the system is that no more files may be open.
void refuse_too_few_files(int error);

}  // namespace lacon
