#pragma once
// What of a symmetric matrix other processes have: entries between unknowns of nodes, the imposed ones among them.
#include <functional>
#include <span>
#include <vector>

namespace lacon {

class SparseMatrix;

class RowsElsewhere {
 public:
  virtual ~RowsElsewhere() = default;
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
  /// The whole matrix in this process. @param here what it has of it, with its multipliers
  virtual SparseMatrix whole(const SparseMatrix& here) const = 0;
};

}  // namespace lacon
