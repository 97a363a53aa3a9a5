#pragma once
// The polygon of a contact cell in space as a function of the nodes.
#include <array>
#include <vector>

#include "lacon/operators/contact/variation/gap_variation.hpp"
#include "lacon/operators/contact/variation/variations.hpp"

// The polygon lies in a triangle of the slave's chart, whose vertices have fixed reference coordinates; a place in it is two
// barycentric coordinates b. A line of a master passes the slave's normals on the side of s(b) = sum b_k s_k,
// s_k = ((q - p) x n_k) . (x_k - p) at the triangle's vertices k.

namespace lacon::variations {

/// The unit normal at a vertex of the triangle, its place, with derivatives by the unknowns.
struct TriangleVertex {
  Shapes<3> phi;
  Interpolated<3> at;
  Vector<3> x, n;
  double length;                                                          ///< of the normal that n is the direction of
  Vector<3> of_place = Vector<3>::Zero(), of_normal = Vector<3>::Zero();  ///< derivatives of the gap by x and n
  // where second derivatives are wanted
  Rows<3> dn;
  Row stretch;                           ///< of that length, relative
  Vector<3> turned = Vector<3>::Zero();  ///< the factor of dn x dx
};

/// A line that cuts the triangle: coefficients l with l . b = 0 on it.
struct CuttingLine {
  Vector<3> l = Vector<3>::Zero();
  bool moves = false;
  bool foreign = false;                         ///< of another master than the one that the polygon sees
  Vector<3> from = l, along = l;                ///< p and q - p
  int n_nodes = 0;                              ///< of the cell that it is drawn on
  std::array<int, max_skin_nodes> column{};     ///< of these
  std::array<double, max_skin_nodes> p{}, q{};  ///< factors of these
  Vector<3> of_l = Vector<3>::Zero();           ///< the derivative of the gap by l
  Rows<3> dl;                                   ///< where second derivatives are wanted
  int own_column = -1;                          ///< first of its coefficients, where these are unknowns by themselves
  bool varies() const { return moves || own_column >= 0; }
};

/// Lines that keep their place do not move with the nodes. Second derivatives have their coefficients as unknowns behind all
/// others.
class PolygonVariation {
 public:
  PolygonVariation(const ContactCellGeometry& cell, bool second);

  const TriangleVertex& vertex(int k) const { return vertices_[static_cast<std::size_t>(k)]; }

  /// Add what the corners do. @param of_corners the derivative by them  @param[in,out] gradient by the unknowns
  void add_gradient(const Row& of_corners, Row& gradient);

  /// With those of lines that keep their place.
  Eigen::Index n_unknowns() const { return n_; }
  /// Derivatives of the corners by the unknowns, (2 corners, n_unknowns()).
  Matrix corners() const;

  /// Add their second derivatives, after add_gradient(). @param form of n_unknowns()
  void add_second(QuadraticForm& form);

  /// The coefficients of lines that keep their place, after add_gradient(): what the gap does by them, and they by the nodes.
  std::vector<OwnUnknown> own_unknowns() const;

 private:
  struct Corner {
    Vector<3> b;                         ///< all three barycentric coordinates
    std::array<std::size_t, 2> lines{};  ///< that meet here
    Eigen::Matrix2d inverse;             ///< of J, by which both equations depend on the last two coordinates
    Rows<2> row;
    bool moves = false;
    Vector<2> of_equations = Vector<2>::Zero();  ///< factors of d2(l . b)
  };

  bool is_smooth() const { return !cell_.slave_normals.empty(); }

  TriangleVertex vertex_at(int k) const;

  /// The derivative of the gap by the normal of which n is the direction.
  static Vector<3> of_unscaled(const TriangleVertex& at) { return (at.of_normal - at.of_normal.dot(at.n) * at.n) / at.length; }

  CuttingLine line(std::size_t k);

  void take_corner(std::size_t k);

  /// Add sum of_l_k d2 s_k, but for d2n. With S = sum of_l n, Q = sum of_l dn it is 2 (dq - dp) . (sum of_l (dn x (x - p) +
  /// n x dx) - S x dp) - 2 dp . ((q - p) x Q), and the factor of dn x dx, which a vertex sums up.
  void add_second_of_line(const CuttingLine& line, QuadraticForm& form);

  void add_second_of_vertex(const TriangleVertex& at, QuadraticForm& form) const;

  const ContactCellGeometry& cell_;
  const PolygonTrace& trace_;
  int n_, first_normal_;
  bool second_;
  std::array<TriangleVertex, 3> vertices_;
  std::vector<CuttingLine> lines_;
  std::vector<Rows<3>> still_;  ///< what derivatives of l would be, of each line that keeps its place
  std::vector<Corner> corners_;
};

}  // namespace lacon::variations
