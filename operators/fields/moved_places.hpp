#pragma once
// What is said of moments and axes that take places where they are in the mesh, though displacements have moved them since.
#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "lacon/operators/fields/axes.hpp"
#include "lacon/structures/base.hpp"

namespace lacon {

/// Looks at the places of one command, at each instant, and tells the worst of them. post_releve_t.py has the same rules.
class MovedPlaces {
 public:
  using Places = std::vector<std::array<double, 3>>;

  MovedPlaces(const Base& base, const Result& result, const Mesh& mesh);

  /// Coordinates (n_nodes, 3) with the displacements of an instant; empty where it has none, and where MODI_MAILLAGE has moved
  /// the mesh by a field (DEFORME): then places are where somebody wants them.
  const std::vector<double>& at(std::int64_t order);

  /// Axes about a line at these places, of the mesh and now.
  void look_at_axes(const std::string& keyword, double instant, const Frame& frame, const Places& before, const Places& now);
  /// The moments of forces at these places about `origin`, of the mesh and now. @param forces sum of their magnitudes
  void look_at_moment(const std::string& keyword, double instant, const std::vector<double>& origin, const Places& before,
                      const Places& now, double forces, const std::array<double, 3>& found, const std::array<double, 3>& then);
  /// MODIREPERE_6 and POST_13, each once at most.
  void tell() const;

 private:
  struct Finding {
    double share = 0.05;  ///< of the largest radius or lever arm; less is not told
    std::string keyword;
    double instant = 0, angle = 0;
    std::array<double, 3> found{}, then{};
  };

  const Base& base_;
  const Result& result_;
  const Mesh& mesh_;
  double size_;  ///< of the mesh
  std::int64_t order_ = -1;
  std::vector<double> coordinates_;
  Finding axes_, moment_;
};

}  // namespace lacon
