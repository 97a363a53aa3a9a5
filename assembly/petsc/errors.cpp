// What PETSc says where something goes wrong, and options.
#include <new>
#include <stdexcept>
#include <string>
#include <utility>

#include "lacon/assembly/petsc/owned.hpp"

namespace lacon {
namespace {

std::string last_error;

PetscErrorCode note_error(MPI_Comm, int, const char* function, const char*, PetscErrorCode code, PetscErrorType type,
                          const char* text, void*) {
  if (type == PETSC_ERROR_INITIAL) {
    last_error = text && *text ? text : "error " + std::to_string(code);
    last_error += std::string(" (") + function + ")";
  }
  return code;
}

}  // namespace

void checked(PetscErrorCode code) {
  if (code == PETSC_ERR_MEM) throw std::bad_alloc();
  if (code) throw std::runtime_error("PETSc: " + std::exchange(last_error, std::string()));
}

void set_option(const std::string& name, const std::string& value) {
  PetscBool known = PETSC_FALSE;
  checked(PetscOptionsHasName(nullptr, nullptr, name.c_str(), &known));
  if (!known) checked(PetscOptionsSetValue(nullptr, name.c_str(), value.c_str()));
}

void catch_errors() { checked(PetscPushErrorHandler(note_error, nullptr)); }

}  // namespace lacon
