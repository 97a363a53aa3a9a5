#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "lacon/operators/affe_char/component_names.hpp"
#include "lacon/operators/affe_char/relations.hpp"
#include "lacon/structures/vector.hpp"

namespace lacon {
namespace {

using Terms = std::vector<RelationTerm>;

constexpr double same_place = 1e-9;  // of the size of a group: points that coincide, points on one line
constexpr Vec3 axis_of_space[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

Vec3 unit(Vec3 a) { return a / norm(a); }

Terms scaled(Terms terms, double factor) {
  for (RelationTerm& term : terms) term.coefficient *= factor;
  return terms;
}

void append(Terms& to, const Terms& terms) { to.insert(to.end(), terms.begin(), terms.end()); }

/// Each degree of freedom once; what cancels is left out.
Terms merged(const Terms& terms) {
  std::map<std::pair<std::int32_t, std::string>, double> sums;
  double largest = 0;
  for (const RelationTerm& term : terms) sums[{term.node, term.component}] += term.coefficient;
  for (const auto& [dof, coefficient] : sums) largest = std::max(largest, std::abs(coefficient));
  Terms made;
  for (const auto& [dof, coefficient] : sums)
    if (std::abs(coefficient) > 1e-14 * largest) made.push_back({dof.first, dof.second, coefficient});
  return made;
}

/// Points that move as one body. Up to three of them, the first, the one farthest from it and the one farthest from the line
/// through both, say how it turns; all others follow.
class RigidBody {
 public:
  RigidBody(std::span<const double> points, int dimension) : points_(points), dimension_(dimension) {}
  std::vector<Terms> relations();

 private:
  /// A component of the rotation: w . axis, as terms in the displacements of the reference points.
  struct Turn {
    Vec3 axis;
    Terms angle;
  };

  std::int32_t size() const { return static_cast<std::int32_t>(points_.size() / 3); }
  Vec3 at(std::int32_t i) const { return vector_at(points_.data() + 3 * std::ptrdiff_t{i}); }
  Vec3 from_first(std::int32_t i) const { return at(i) - at(0); }
  template <class Distance>
  std::int32_t farthest(const Distance& distance) const {
    std::int32_t best = 0;
    for (std::int32_t i = 1; i < size(); ++i)
      if (distance(i) > distance(best)) best = i;
    return best;
  }
  Terms relative(std::int32_t i, Vec3 direction) const;
  void enter(const Terms& terms);
  void find_turns();
  void find_turns_in_space(std::int32_t b, Vec3 e1);
  void let_follow(std::int32_t i);

  std::span<const double> points_;
  int dimension_;
  std::set<std::int32_t> references_{0};
  std::vector<Turn> turns_;
  std::vector<Terms> relations_;
};

/// (u_i - u_0) . direction
Terms RigidBody::relative(std::int32_t i, Vec3 direction) const {
  Terms terms;
  for (int d = 0; d < dimension_; ++d) {
    terms.push_back({i, translation[d], component(direction, d)});
    terms.push_back({0, translation[d], -component(direction, d)});
  }
  return terms;
}

void RigidBody::enter(const Terms& terms) {
  if (Terms made = merged(terms); !made.empty()) relations_.push_back(std::move(made));
}

void RigidBody::find_turns() {
  const std::int32_t b = farthest([&](std::int32_t i) { return norm(from_first(i)); });
  const double length = norm(from_first(b));
  if (!(length > 0)) return;  // all points are one
  references_.insert(b);
  const Vec3 e1 = unit(from_first(b));
  enter(relative(b, e1));
  if (dimension_ == 2)
    turns_ = {{{0, 0, 1}, scaled(relative(b, {-e1.y, e1.x, 0}), 1 / length)}};
  else
    find_turns_in_space(b, e1);
}

/// u_b - u_0 = length (w3 e2 - w2 e3). With c - a = p e1 + q e2, a the first point and c the third reference:
/// u_c - u_0 = w x (c - a) = -w3 q e1 + w3 p e2 + (w1 q - w2 p) e3.
void RigidBody::find_turns_in_space(std::int32_t b, Vec3 e1) {
  const double length = norm(from_first(b));
  const auto off_line = [&](std::int32_t i) { return norm(cross(from_first(i), e1)); };
  const std::int32_t c = farthest(off_line);
  const bool are_on_a_line = off_line(c) <= same_place * length;
  const Vec3 e2 = !are_on_a_line         ? unit(cross(cross(e1, from_first(c)), e1))
                  : std::abs(e1.x) < 0.9 ? unit(cross(e1, {1, 0, 0}))
                                         : unit(cross(e1, {0, 1, 0}));
  const Vec3 e3 = cross(e1, e2);
  const Terms w2 = scaled(relative(b, e3), -1 / length), w3 = scaled(relative(b, e2), 1 / length);
  turns_ = {{e2, w2}, {e3, w3}};
  if (are_on_a_line) return;
  references_.insert(c);
  const double p = dot(from_first(c), e1), q = dot(from_first(c), e2);
  Terms along = relative(c, e1), across = relative(c, e2), about = relative(c, e3);
  append(along, scaled(w3, q));
  append(across, scaled(w3, -p));
  enter(along);
  enter(across);
  append(about, scaled(w2, p));
  turns_.push_back({e1, scaled(about, 1 / q)});
}

/// u_i - u_0 = w x (x_i - x_0)
void RigidBody::let_follow(std::int32_t i) {
  for (int d = 0; d < dimension_; ++d) {
    const Vec3 direction = axis_of_space[d];
    Terms terms = relative(i, direction);
    for (const Turn& turn : turns_) append(terms, scaled(turn.angle, -dot(cross(turn.axis, from_first(i)), direction)));
    enter(terms);
  }
}

std::vector<Terms> RigidBody::relations() {
  if (size() < 2) return {};
  find_turns();
  for (std::int32_t i = 1; i < size(); ++i)
    if (!references_.contains(i)) let_follow(i);
  return std::move(relations_);
}

}  // namespace

std::vector<std::vector<RelationTerm>> rigid_relations(std::span<const double> points, int dimension) {
  return RigidBody(points, dimension).relations();
}

}  // namespace lacon
