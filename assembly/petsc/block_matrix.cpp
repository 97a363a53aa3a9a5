#include "lacon/assembly/petsc/block_matrix.hpp"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <vector>

#include "lacon/assembly/petsc/aij_matrix.hpp"
#include "lacon/assembly/petsc/block_kernels.hpp"

namespace lacon {
namespace {

/// Entries of a sequential AIJ matrix. @param block_of  of its columns: which column of blocks, and which one there
template <class Real, class BlockOf>
BlockEntries<Real> gathered(Mat matrix, int rows, int columns, const BlockOf& block_of) {
  BlockEntries<Real> made{.rows = rows, .columns = columns};
  PetscInt n = 0;
  const PetscInt *offset = nullptr, *column = nullptr;
  const PetscScalar* value = nullptr;
  PetscBool done = PETSC_FALSE;
  checked(MatGetRowIJ(matrix, 0, PETSC_FALSE, PETSC_FALSE, &n, &offset, &column, &done));
  checked(MatSeqAIJGetArrayRead(matrix, &value));
  std::vector<std::int32_t> blocks;
  const int size = rows * columns;
  const auto all_of = [&](PetscInt first) {
    blocks.clear();
    const std::span<const PetscInt> of_first{column + offset[first], column + offset[first + 1]};
    for (int r = 0; r < rows; ++r) {
      const std::span<const PetscInt> own{column + offset[first + r], column + offset[first + r + 1]};
      if (r > 0 && std::ranges::equal(own, of_first)) continue;  // nearly always
      for (const PetscInt c : own)
        if (const std::int32_t block = block_of(c) / columns; blocks.empty() || blocks.back() != block) blocks.push_back(block);
    }
    if (std::ranges::is_sorted(blocks, std::less<>())) return;
    std::sort(blocks.begin(), blocks.end());
    blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
  };
  made.offset.reserve(n / rows + 1);
  for (PetscInt first = 0; first < n; first += rows) {
    all_of(first);
    made.offset.push_back(made.offset.back() + static_cast<std::int32_t>(blocks.size()));
  }
  made.column.reserve(made.offset.back());
  made.value.assign(static_cast<std::size_t>(made.offset.back()) * size + read_behind, 0);
  for (PetscInt first = 0; first < n; first += rows) {
    all_of(first);
    Real* const row = made.value.data() + made.column.size() * size;
    made.column.insert(made.column.end(), blocks.begin(), blocks.end());
    for (int r = 0; r < rows; ++r) {
      std::ptrdiff_t block = 0;
      for (PetscInt k = offset[first + r]; k < offset[first + r + 1]; ++k) {
        const std::int32_t at = block_of(column[k]);
        while (block < std::ssize(blocks) && blocks[block] < at / columns) ++block;
        if (block == std::ssize(blocks) || blocks[block] != at / columns)  // columns are in no order
          block = std::lower_bound(blocks.begin(), blocks.end(), at / columns) - blocks.begin();
        row[block * size + at % columns * rows + r] = static_cast<Real>(value[k]);
      }
    }
  }
  checked(MatSeqAIJRestoreArrayRead(matrix, &value));
  checked(MatRestoreRowIJ(matrix, 0, PETSC_FALSE, PETSC_FALSE, &n, &offset, &column, &done));
  return made;
}

/// What a shell has.
template <class Real>
struct Parts : SplitBlocks<Real> {
  const BlockKernels<Real>* kernels = nullptr;
  OwnedVec of_others;    ///< values of the columns of other processes
  OwnedScatter scatter;  ///< from all columns to these; null where there is one process
};

template <class Real>
Parts<Real>& parts_of(Mat shell) {
  void* context = nullptr;
  checked(MatShellGetContext(shell, &context));
  return *static_cast<Parts<Real>*>(context);
}

class Reading {
 public:
  explicit Reading(Vec vector) : vector_(vector) { checked(VecGetArrayRead(vector_, &values_)); }
  ~Reading() { VecRestoreArrayRead(vector_, &values_); }
  Reading(const Reading&) = delete;
  Reading& operator=(const Reading&) = delete;
  operator const double*() const { return values_; }

 private:
  Vec vector_;
  const double* values_ = nullptr;
};
class Writing {
 public:
  explicit Writing(Vec vector) : vector_(vector) { checked(VecGetArray(vector_, &values_)); }
  ~Writing() { VecRestoreArray(vector_, &values_); }
  Writing(const Writing&) = delete;
  Writing& operator=(const Writing&) = delete;
  operator double*() const { return values_; }

 private:
  Vec vector_;
  double* values_ = nullptr;
};

/// A product, counted by -log_view.
template <class Real>
void run(BlockProduct<Real> product, const BlockEntries<Real>& a, const double* x, double* y) {
  product(a, x, y);
  const auto stored = static_cast<double>(a.column.size()), n = static_cast<double>(a.offset.size() - 1);
  PetscLogFlops(2 * (a.is_half ? 2 * stored - n : stored) * a.rows * a.columns);
}

struct alignas(padded_size * sizeof(double)) Padded {
  double value[padded_size];
};
/// What a product with half a matrix works on, until a matrix is destroyed.
std::vector<Padded> padded_x, padded_y;

/// y += A x of half a symmetric matrix.
template <class Real>
void add_half(const Parts<Real>& parts, const double* x, double* y) {
  const int size = parts.own.rows;
  const std::size_t n = parts.own.offset.size() - 1;
  if (n == 0) return;
  padded_x.resize(n), padded_y.resize(n);
  for (std::size_t i = 0; i < n; ++i)
    for (int r = 0; r < padded_size; ++r) {
      padded_x[i].value[r] = r < size ? x[i * size + r] : 0;
      padded_y[i].value[r] = r < size ? y[i * size + r] : 0;
    }
  run(parts.kernels->add_half, parts.own, padded_x.data()->value, padded_y.data()->value);
  for (std::size_t i = 0; i < n; ++i)
    for (int r = 0; r < size; ++r) y[i * size + r] = padded_y[i].value[r];
}

/// y = A x, or y += A x.
template <class Real>
PetscErrorCode apply(Mat shell, Vec x, Vec y, bool adds) {
  const Parts<Real>& parts = parts_of<Real>(shell);
  if (parts.scatter) PetscCall(VecScatterBegin(parts.scatter, x, parts.of_others, INSERT_VALUES, SCATTER_FORWARD));
  if (parts.own.is_half) {
    if (!adds) PetscCall(VecSet(y, 0));
    add_half(parts, Reading(x), Writing(y));
  } else {
    run(adds ? parts.kernels->add : parts.kernels->multiply, parts.own, Reading(x), Writing(y));
  }
  if (!parts.scatter) return 0;
  PetscCall(VecScatterEnd(parts.scatter, x, parts.of_others, INSERT_VALUES, SCATTER_FORWARD));
  run(parts.kernels->add, parts.others, Reading(parts.of_others), Writing(y));
  return 0;
}

template <class Real>
PetscErrorCode multiply(Mat shell, Vec x, Vec y) {
  return apply<Real>(shell, x, y, false);
}

template <class Real>
PetscErrorCode multiply_add(Mat shell, Vec x, Vec y, Vec z) {
  if (y != z) PetscCall(VecCopy(y, z));
  return apply<Real>(shell, x, z, true);
}

template <class Real>
PetscErrorCode multiply_transposed(Mat shell, Vec x, Vec y) {
  const Parts<Real>& parts = parts_of<Real>(shell);
  PetscCall(VecSet(y, 0));
  if (parts.scatter) {
    PetscCall(VecSet(parts.of_others, 0));
    run(parts.kernels->add_transposed, parts.others, Reading(x), Writing(parts.of_others));
    PetscCall(VecScatterBegin(parts.scatter, parts.of_others, y, ADD_VALUES, SCATTER_REVERSE));
    PetscCall(VecScatterEnd(parts.scatter, parts.of_others, y, ADD_VALUES, SCATTER_REVERSE));
  }
  if (parts.own.is_half)
    add_half(parts, Reading(x), Writing(y));
  else
    run(parts.kernels->add_transposed, parts.own, Reading(x), Writing(y));
  return 0;
}

template <class Real>
PetscErrorCode diagonal(Mat shell, Vec y) {
  const BlockEntries<Real>& own = parts_of<Real>(shell).own;
  PetscCall(VecSet(y, 0));
  const Writing values(y);
  for (std::size_t i = 0; i + 1 < own.offset.size(); ++i)
    for (std::int32_t k = own.offset[i]; k < own.offset[i + 1]; ++k)
      if (own.column[k] == static_cast<std::int32_t>(i))
        for (int r = 0; r < own.rows; ++r)
          values[i * own.rows + r] = own.value[static_cast<std::size_t>(k) * own.rows * own.columns + r * (own.rows + 1)];
  return 0;
}

template <class Real>
PetscErrorCode destroy(Mat shell) {
  delete &parts_of<Real>(shell);
  padded_x = {}, padded_y = {};
  return 0;
}

template <class Function>
void set_operation(Mat shell, MatOperation operation, Function function) {
  checked(MatShellSetOperation(shell, operation, reinterpret_cast<void (*)()>(function)));
}

template <class Real>
const BlockKernels<Real>* kernels_for(int rows, int columns) {
  if constexpr (std::is_same_v<Real, float>)
    return single_kernels(rows, columns);
  else
    return double_kernels(rows, columns);
}

/// @param rows, columns of a block  @param n, m of own rows and own columns
template <class Real>
OwnedMat empty_shell(MPI_Comm processes, int rows, int columns, PetscInt n, PetscInt m) {
  auto parts = std::make_unique<Parts<Real>>();
  parts->kernels = kernels_for<Real>(rows, columns);
  if (!parts->kernels) throw std::logic_error("blocks without a kernel");
  OwnedMat shell;
  checked(MatCreateShell(processes, n, m, PETSC_DETERMINE, PETSC_DETERMINE, parts.release(), shell.out()));
  checked(MatSetBlockSizes(shell, rows, columns));
  set_operation(shell, MATOP_MULT, multiply<Real>);
  set_operation(shell, MATOP_MULT_ADD, multiply_add<Real>);
  set_operation(shell, MATOP_MULT_TRANSPOSE, multiply_transposed<Real>);
  set_operation(shell, MATOP_GET_DIAGONAL, diagonal<Real>);
  set_operation(shell, MATOP_DESTROY, destroy<Real>);
  return shell;
}

/// The values of an AIJ matrix in blocks.
template <class Real>
SplitBlocks<Real> blocks_of(Mat matrix, int rows, int columns) {
  SplitBlocks<Real> made;
  const auto as_it_is = [](PetscInt column) { return column; };
  PetscBool is_distributed = PETSC_FALSE;
  checked(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(matrix), MATMPIAIJ, &is_distributed));
  if (!is_distributed) {
    made.own = gathered<Real>(matrix, rows, columns, as_it_is);
    return made;
  }
  Mat own = nullptr, others = nullptr;
  const PetscInt* number = nullptr;
  PetscInt n_numbers = 0;
  checked(MatMPIAIJGetSeqAIJ(matrix, &own, &others, &number));
  made.own = gathered<Real>(own, rows, columns, as_it_is);
  checked(MatGetSize(others, nullptr, &n_numbers));
  std::vector<std::int32_t>& block = made.column_of_others;
  for (PetscInt c = 0; c < n_numbers; ++c) block.push_back(number[c] / columns);
  std::sort(block.begin(), block.end());
  block.erase(std::unique(block.begin(), block.end()), block.end());
  made.others = gathered<Real>(others, rows, columns, [&](PetscInt c) {
    const auto at = std::lower_bound(block.begin(), block.end(), number[c] / columns) - block.begin();
    return static_cast<PetscInt>(at) * columns + number[c] % columns;
  });
  return made;
}

/// The same blocks in single precision.
SplitBlocks<float> in_single_precision(const SplitBlocks<double>& blocks) {
  const auto rounded = [](const BlockEntries<double>& from) {
    return BlockEntries<float>{from.rows,   from.columns, from.is_half,
                               from.offset, from.column,  {from.value.begin(), from.value.end()}};
  };
  return {rounded(blocks.own), rounded(blocks.others), blocks.column_of_others};
}

/// A shell without values gets some.
template <class Real>
void fill(Mat shell, SplitBlocks<Real> blocks) {
  Parts<Real>& parts = parts_of<Real>(shell);
  static_cast<SplitBlocks<Real>&>(parts) = std::move(blocks);
  int n_processes = 1;
  MPI_Comm_size(PetscObjectComm(reinterpret_cast<PetscObject>(shell)), &n_processes);
  if (n_processes == 1) return;
  const auto n = static_cast<PetscInt>(parts.column_of_others.size());
  const int columns = parts.kernels->columns;
  OwnedIs from;
  OwnedVec all;
  parts.of_others = {};
  parts.scatter = {};
  checked(ISCreateBlock(PETSC_COMM_SELF, columns, n, parts.column_of_others.data(), PETSC_COPY_VALUES, from.out()));
  checked(VecCreateSeq(PETSC_COMM_SELF, n * columns, parts.of_others.out()));
  checked(MatCreateVecs(shell, all.out(), nullptr));
  checked(VecScatterCreate(all, from, parts.of_others, nullptr, parts.scatter.out()));
}

}  // namespace

OwnedMat in_blocks(SplitBlocks<double> rows) {
  const int size = rows.own.rows;
  const auto n = static_cast<PetscInt>(rows.own.offset.size() - 1) * size;
  OwnedMat shell = empty_shell<double>(PETSC_COMM_WORLD, size, size, n, n);
  fill(shell, std::move(rows));
  return shell;
}

OwnedMat in_blocks(SplitBlocks<float> rows, PetscInt n_columns) {
  const auto n = static_cast<PetscInt>(rows.own.offset.size() - 1) * rows.own.rows;
  OwnedMat shell = empty_shell<float>(PETSC_COMM_WORLD, rows.own.rows, rows.own.columns, n, n_columns);
  fill(shell, std::move(rows));
  return shell;
}

const SplitBlocks<double>& entries_of(Mat blocks) { return parts_of<double>(blocks); }

bool has_blocks(Mat matrix) {
  PetscInt rows = 0, columns = 0;
  PetscBool is_aij = PETSC_FALSE;
  checked(PetscObjectTypeCompareAny(reinterpret_cast<PetscObject>(matrix), &is_aij, MATSEQAIJ, MATMPIAIJ, ""));
  checked(MatGetBlockSizes(matrix, &rows, &columns));
  return is_aij && single_kernels(rows, columns) != nullptr;
}

OwnedMat in_single_blocks(Mat matrix) {
  PetscInt rows = 0, columns = 0, n = 0, m = 0;
  PetscBool is_shell = PETSC_FALSE;
  checked(MatGetBlockSizes(matrix, &rows, &columns));
  checked(MatGetLocalSize(matrix, &n, &m));
  checked(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(matrix), MATSHELL, &is_shell));
  OwnedMat shell = empty_shell<float>(PetscObjectComm(reinterpret_cast<PetscObject>(matrix)), rows, columns, n, m);
  fill(shell, is_shell ? in_single_precision(parts_of<double>(matrix)) : blocks_of<float>(matrix, rows, columns));
  return shell;
}

OwnedMat as_aij(Mat blocks) {
  const SplitBlocks<double>& entries = entries_of(blocks);
  const int size = entries.own.rows;
  const auto n_rows = static_cast<std::int32_t>(entries.own.offset.size() - 1);
  PetscInt first = 0;
  checked(MatGetOwnershipRangeColumn(blocks, &first, nullptr));
  struct Block {
    std::int32_t column;
    const double* value;
    int step_of_row, step_of_column;
  };
  std::vector<std::vector<Block>> rows(n_rows);
  for (std::int32_t i = 0; i < n_rows; ++i) {
    for (std::int32_t k = entries.own.offset[i]; k < entries.own.offset[i + 1]; ++k) {
      const std::int32_t j = entries.own.column[k];
      const double* const value = entries.own.value.data() + static_cast<std::int64_t>(k) * size * size;
      const bool by_rows = entries.own.is_half;
      rows[i].push_back({first / size + j, value, by_rows ? size : 1, by_rows ? 1 : size});
      if (entries.own.is_half && j != i) rows[j].push_back({first / size + i, value, 1, size});
    }
    if (entries.column_of_others.empty()) continue;
    for (std::int32_t k = entries.others.offset[i]; k < entries.others.offset[i + 1]; ++k)
      rows[i].push_back({entries.column_of_others[entries.others.column[k]],
                         entries.others.value.data() + static_cast<std::int64_t>(k) * size * size, 1, size});
  }
  std::size_t n_entries = 0;
  for (const std::vector<Block>& row : rows) n_entries += row.size() * size * size;
  if (n_entries > std::numeric_limits<PetscInt>::max()) throw std::length_error("PETSc: 2^31");
  std::vector<PetscInt> offset{0}, column;
  std::vector<double> value;
  column.reserve(n_entries), value.reserve(n_entries);
  for (std::vector<Block>& row : rows) {
    std::ranges::sort(row, {}, &Block::column);
    for (int r = 0; r < size; ++r) {
      for (const Block& block : row)
        for (int c = 0; c < size; ++c) {
          column.push_back(block.column * size + c);
          value.push_back(block.value[r * block.step_of_row + c * block.step_of_column]);
        }
      offset.push_back(static_cast<PetscInt>(column.size()));
    }
  }
  return aij_matrix(PetscObjectComm(reinterpret_cast<PetscObject>(blocks)), {offset, column, value}, n_rows * size, size);
}

}  // namespace lacon
