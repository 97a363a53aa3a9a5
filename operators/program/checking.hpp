#pragma once
// An operator that only looks at its order.

namespace lacon {

/// Whether the command line has --check: an operator that takes long (rows with `solves`) ends before that, with everything
/// read and built that may be refused, and stores nothing. Others do all of their work.
bool only_checks();

}  // namespace lacon
