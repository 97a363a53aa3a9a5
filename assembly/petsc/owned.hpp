#pragma once
// What of PETSc is destroyed with its owner, and errors of PETSc.
#include <petscksp.h>

#include <string>
#include <utility>

namespace lacon {

template <class Object, PetscErrorCode (*destroy)(Object*)>
class Owned {
 public:
  Owned() = default;
  Owned(Owned&& other) noexcept : object_(std::exchange(other.object_, nullptr)) {}
  Owned& operator=(Owned&& other) noexcept {
    std::swap(object_, other.object_);
    return *this;
  }
  ~Owned() { destroy(&object_); }
  operator Object() const { return object_; }
  Object* out() { return &object_; }

 private:
  Object object_ = nullptr;
};
using OwnedMat = Owned<Mat, MatDestroy>;
using OwnedVec = Owned<Vec, VecDestroy>;
using OwnedKsp = Owned<KSP, KSPDestroy>;
using OwnedPc = Owned<PC, PCDestroy>;
using OwnedScatter = Owned<VecScatter, VecScatterDestroy>;
using OwnedIs = Owned<IS, ISDestroy>;

/// One more owner.
inline OwnedMat referenced(Mat matrix) {
  OwnedMat owned;
  PetscObjectReference(reinterpret_cast<PetscObject>(matrix));
  *owned.out() = matrix;
  return owned;
}

/// Throws what PETSc says where a call of it failed.
void checked(PetscErrorCode code);
/// What LACON_PETSC_OPTIONS of the user says stands.
void set_option(const std::string& name, const std::string& value);
/// From now on calls of PETSc that fail print nothing, and checked() tells what was wrong.
void catch_errors();

}  // namespace lacon
