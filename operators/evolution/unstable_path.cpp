#include "lacon/operators/evolution/unstable_path.hpp"

#include <utility>

#include "lacon/structures/hdf5.hpp"

namespace lacon {

bool UnstablePath::begin() {
  present_ = std::exchange(next_, Attempt::first);
  follows_ = present_ == Attempt::follows || (present_ == Attempt::first && at_once_ > 0);
  return follows_;
}

bool UnstablePath::fail(bool left) {
  if (present_ != Attempt::first || !(follows_ || left)) return false;
  next_ = follows_ ? Attempt::looks : Attempt::follows;
  at_once_ = 0;
  return true;
}

void UnstablePath::solve(bool unstable) {
  if (!follows_ || !unstable) {  // a stable one is found
    at_once_ = 0;
    next_time_ = 1;
  } else if (present_ == Attempt::follows) {
    at_once_ = next_time_;
    next_time_ *= 2;
  } else {
    --at_once_;
  }
}

void UnstablePath::save(const hdf5::Group& group) const {
  group.set("at_once", at_once_);
  group.set("next_time", next_time_);
}

void UnstablePath::resume(const hdf5::Group& group) {
  at_once_ = group.integer("at_once");
  next_time_ = group.integer("next_time");
}

}  // namespace lacon
