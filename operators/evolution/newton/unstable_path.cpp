#include "lacon/operators/evolution/newton/unstable_path.hpp"

#include <utility>

#include "lacon/structures/hdf5.hpp"

namespace lacon {

bool UnstablePath::begin() {
  present_ = std::exchange(next_, Attempt::first);
  follows_ = present_ == Attempt::follows || (present_ == Attempt::first && at_once_.left > 0);
  return follows_;
}

bool UnstablePath::fail(bool left) {
  if (present_ != Attempt::first || !(follows_ || left)) return false;
  next_ = follows_ ? Attempt::looks : Attempt::follows;
  at_once_.left = 0;
  return true;
}

void UnstablePath::solve(bool unstable) {
  if (!follows_ || !unstable) {  // a stable one is found
    at_once_ = {};
  } else if (present_ == Attempt::follows) {
    at_once_.begin();
  } else {
    --at_once_.left;
  }
}

void UnstablePath::save(const hdf5::Group& group) const {
  group.set("at_once", at_once_.left);
  group.set("next_time", at_once_.next);
}

void UnstablePath::resume(const hdf5::Group& group) {
  at_once_.left = group.integer("at_once");
  at_once_.next = group.integer("next_time");
}

}  // namespace lacon
