#pragma once
// What of a symmetric matrix other processes have: entries between unknowns of nodes, the imposed ones among them.
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "lacon/structures/mesh.hpp"

namespace lacon {

class SparseMatrix;

class RowsElsewhere {
 public:
  virtual ~RowsElsewhere() = default;
  /// Another number as soon as values may be others.
  virtual std::int64_t version() const = 0;
  /// The product with unknowns of nodes, or that of magnitudes. @param x (n_nodes, n_components)  @return likewise
  virtual std::span<const double> product(std::span<const double> x, bool magnitudes) const = 0;
  /// Some of them at once, each with the bits of product(); the last one is that of magnitudes.
  /// @param fill zeros (n_nodes, n_components, n_columns)  @param use products, likewise, as long as it runs
  virtual void products(int n_columns, const std::function<void(std::span<double>)>& fill,
                        const std::function<void(std::span<const double>)>& use) const = 0;
  /// Sums of |a_ij| and how many there are, in rows of unknowns of nodes over columns that are equations, (n_nodes, width).
  struct Sizes {
    std::span<const double> sum, entries;
  };
  virtual Sizes row_sizes() const = 0;
  /// The diagonal, and the largest |a_ij| d_i d_j of a row. @param d, @return (n_nodes, n_components)
  virtual std::span<const double> diagonal() const = 0;
  virtual std::span<const double> row_maxima(std::span<const double> d) const = 0;
  /// From now on changes are those from what the matrix is now; the largest one of an entry, over its row's and its column's
  /// diagonal, squared.
  virtual void remember() const = 0;
  virtual double change() const = 0;
  /// Neighbours of each vertex in the whole matrix. @param here what this process has of it, with its multipliers
  virtual Ragged<std::int32_t> graph(const SparseMatrix& here) const = 0;
  /// The whole matrix in this process. @param here what it has of it, with its multipliers
  virtual SparseMatrix whole(const SparseMatrix& here) const = 0;
};

}  // namespace lacon
