// Reference cells and integration rules against what defines them.
#include "lacon/elements/reference.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <set>
#include <string_view>

#include "lacon/catalog/elements.hpp"
#include "solids.hpp"

namespace {

using lacon::CellType;
using lacon::Family;
using lacon::Rule;
using lacon::catalog::CellRow;

struct NamedCell : testing::TestWithParam<int> {
  const CellRow& cell() const { return lacon::catalog::cells()[static_cast<std::size_t>(GetParam())]; }

  std::vector<double> values(const std::vector<double>& xi) const {
    std::vector<double> n(static_cast<std::size_t>(cell().n_nodes));
    lacon::shape_functions(cell().type, xi, n);
    return n;
  }
  std::vector<double> gradients(const std::vector<double>& xi) const {
    std::vector<double> n(static_cast<std::size_t>(cell().n_nodes * cell().dimension));
    lacon::shape_gradients(cell().type, xi, n);
    return n;
  }
  /// Points inside the cell and around it (a pyramid's functions have a pole in the plane of its apex).
  std::vector<std::vector<double>> points() const {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> coordinate(-1.6, 1.6), below(-0.6, 0.8);
    std::vector<std::vector<double>> all(20, std::vector<double>(static_cast<std::size_t>(cell().dimension)));
    for (auto& point : all)
      for (std::size_t d = 0; d < point.size(); ++d)
        point[d] = cell().family == Family::PYRAM && d == 2 ? below(random) : coordinate(random);
    return all;
  }
};

TEST_P(NamedCell, ManyPointsAtOnceGetTheBitsOfEachByItself) {
  if (cell().dimension == 0) return;  // one point
  std::vector<double> all;
  for (const auto& xi : points()) all.insert(all.end(), xi.begin(), xi.end());
  const std::size_t n = points().size(), nodes = static_cast<std::size_t>(cell().n_nodes), axes = points()[0].size();
  for (const std::size_t some : {n, std::size_t{8}, std::size_t{3}, std::size_t{2}}) {
    std::vector<double> at_once(some * nodes), slopes_at_once(some * nodes * axes);
    lacon::shape_functions(cell().type, std::span(all).first(some * axes), at_once);
    lacon::shape_gradients(cell().type, std::span(all).first(some * axes), slopes_at_once);
    for (std::size_t p = 0; p < some; ++p) {
      const auto value = values(points()[p]), slope = gradients(points()[p]);
      for (std::size_t i = 0; i < value.size(); ++i) EXPECT_EQ(at_once[p * value.size() + i], value[i]) << cell().name;
      for (std::size_t i = 0; i < slope.size(); ++i) EXPECT_EQ(slopes_at_once[p * slope.size() + i], slope[i]) << cell().name;
    }
  }
}

// The functions are sums of at most 27 terms of size at most 1.6^6 / 8, or, in pyramids, 1.6^3 / 0.2.
constexpr double round_off = 27 * 50 * eps;

TEST_P(NamedCell, FunctionsSumUpToOneAndGradientsToZeroEverywhere) {
  for (const auto& xi : points()) {
    double sum = 0;
    for (const double value : values(xi)) sum += value;
    EXPECT_NEAR(sum, 1, round_off) << cell().name;
    const auto slopes = gradients(xi);
    for (int d = 0; d < cell().dimension; ++d) {
      double slope = 0;
      for (int a = 0; a < cell().n_nodes; ++a) slope += slopes[static_cast<std::size_t>(a * cell().dimension + d)];
      EXPECT_NEAR(slope, 0, 10 * round_off) << cell().name;
    }
  }
}

TEST_P(NamedCell, EachFunctionIsOneAtItsNodeAndZeroAtTheOthers) {
  for (int a = 0; a < cell().n_nodes; ++a) {
    const auto node =
        cell().nodes.subspan(static_cast<std::size_t>(a * cell().dimension), static_cast<std::size_t>(cell().dimension));
    const auto n = values({node.begin(), node.end()});
    for (int b = 0; b < cell().n_nodes; ++b) EXPECT_EQ(n[static_cast<std::size_t>(b)], a == b ? 1 : 0) << cell().name << a << b;
  }
}

TEST_P(NamedCell, GradientsAreTheDerivativesOfTheFunctionsInsideAndOutside) {
  const double h = 1e-5;
  for (const auto& xi : points()) {
    const auto slopes = gradients(xi);
    for (std::size_t d = 0; d < xi.size(); ++d) {
      auto before = xi, after = xi;
      before[d] -= h;
      after[d] += h;
      const auto low = values(before), high = values(after);
      for (std::size_t a = 0; a < low.size(); ++a)
        // h^2 / 6 times the third derivative (at most 6 x y / (1 - z)^4 in a pyramid), and round-off / h
        EXPECT_NEAR((high[a] - low[a]) / (2 * h), slopes[a * xi.size() + d], 1e-10 * 2e4 / 6 + round_off / h) << cell().name;
    }
  }
}

TEST_P(NamedCell, PolynomialsOfTheCellsDegreeAreReproduced) {
  const int order = cell().order;
  const auto polynomial = [&](std::span<const double> x) {
    double sum = 0.3, factor = 1;
    for (const double c : x) sum += (factor += 0.7) * (order == 1 ? c : c * c - 0.4 * c);
    for (std::size_t i = 0; order == 2 && i + 1 < x.size(); ++i) sum += 1.9 * x[i] * x[i + 1];
    return sum;
  };
  for (const auto& xi : points()) {
    const auto n = values(xi);
    double sum = 0;
    for (std::size_t a = 0; a < n.size(); ++a) sum += n[a] * polynomial(cell().nodes.subspan(a * xi.size(), xi.size()));
    EXPECT_NEAR(sum, polynomial(xi), 20 * round_off) << cell().name;
  }
}

/// The volume (area, length) of a cell whose nodes are `nodes`, reference coordinates permuted: det of the map integrated.
double oriented_measure(const CellRow& cell, std::span<const std::int8_t> order) {
  const std::map<Family, int> points = {{Family::SEG, 3},    {Family::TRIA, 6},   {Family::QUAD, 9}, {Family::TETRA, 15},
                                        {Family::PENTA, 21}, {Family::PYRAM, 27}, {Family::HEXA, 27}};
  const auto table = lacon::tabulate(cell.type, lacon::integration_rule(cell.family, points.at(cell.family)));
  const int dim = cell.dimension;
  double sum = 0;
  for (int p = 0; p < table.n_points; ++p) {
    double j[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int r = 0; r < dim; ++r)
      for (int s = 0; s < dim; ++s) {
        j[r][s] = 0;
        for (int a = 0; a < cell.n_nodes; ++a)
          j[r][s] += cell.nodes[static_cast<std::size_t>(order[static_cast<std::size_t>(a)] * dim + r)] *
                     table.gradient[static_cast<std::size_t>((p * cell.n_nodes + a) * dim + s)];
      }
    sum += table.weight[static_cast<std::size_t>(p)] *
           (j[0][0] * (j[1][1] * j[2][2] - j[1][2] * j[2][1]) - j[0][1] * (j[1][0] * j[2][2] - j[1][2] * j[2][0]) +
            j[0][2] * (j[1][0] * j[2][1] - j[1][1] * j[2][0]));
  }
  return sum;
}

TEST_P(NamedCell, TheMirrorTurnsItInsideOut) {
  if (cell().dimension == 0) {
    EXPECT_EQ(cell().n_nodes, 1);
    return;
  }
  std::vector<std::int8_t> same(static_cast<std::size_t>(cell().n_nodes));
  for (std::size_t a = 0; a < same.size(); ++a) same[a] = static_cast<std::int8_t>(a);
  const double measure = oriented_measure(cell(), same);
  const std::map<Family, double> measures = {{Family::SEG, 2},         {Family::TRIA, 0.5}, {Family::QUAD, 4},
                                             {Family::TETRA, 1.0 / 6}, {Family::PENTA, 1},  {Family::PYRAM, 4.0 / 3},
                                             {Family::HEXA, 8}};
  EXPECT_NEAR(measure, measures.at(cell().family), 100 * eps);
  EXPECT_NEAR(oriented_measure(cell(), cell().mirror), -measure, 100 * eps) << cell().name;
}

/// Vertices (1-based) around which MED puts the nodes behind its vertices: edges, faces, centre.
const std::map<std::string_view, std::vector<std::set<int>>> med_middles = {
    {"SEG3", {{1, 2}}},
    {"TRIA6", {{1, 2}, {2, 3}, {3, 1}}},
    {"QUAD8", {{1, 2}, {2, 3}, {3, 4}, {4, 1}}},
    {"QUAD9", {{1, 2}, {2, 3}, {3, 4}, {4, 1}, {1, 2, 3, 4}}},
    {"TETRA10", {{1, 2}, {2, 3}, {3, 1}, {1, 4}, {2, 4}, {3, 4}}},
    {"PENTA15", {{1, 2}, {2, 3}, {3, 1}, {4, 5}, {5, 6}, {6, 4}, {1, 4}, {2, 5}, {3, 6}}},
    {"PYRAM13", {{1, 2}, {2, 3}, {3, 4}, {4, 1}, {1, 5}, {2, 5}, {3, 5}, {4, 5}}},
    {"HEXA20", {{1, 2}, {2, 3}, {3, 4}, {4, 1}, {5, 6}, {6, 7}, {7, 8}, {8, 5}, {1, 5}, {2, 6}, {3, 7}, {4, 8}}},
    {"HEXA27",
     {{1, 2},
      {2, 3},
      {3, 4},
      {4, 1},
      {5, 6},
      {6, 7},
      {7, 8},
      {8, 5},
      {1, 5},
      {2, 6},
      {3, 7},
      {4, 8},
      {1, 2, 3, 4},
      {1, 2, 5, 6},
      {2, 3, 6, 7},
      {3, 4, 7, 8},
      {4, 1, 5, 8},
      {5, 6, 7, 8},
      {1, 2, 3, 4, 5, 6, 7, 8}}},
};

TEST_P(NamedCell, MedTurnsSolidsInsideOutAndNumbersMiddlesInItsOwnWay) {
  const CellRow& linear = lacon::catalog::cell(cell().linear);
  const auto vertices = cell().med_permutation.first(static_cast<std::size_t>(cell().n_vertices));
  if (cell().dimension > 0) {
    std::vector<std::int8_t> same(vertices.size());
    for (std::size_t a = 0; a < same.size(); ++a) same[a] = static_cast<std::int8_t>(a);
    const double measure = oriented_measure(linear, same);
    EXPECT_NEAR(oriented_measure(linear, vertices), cell().dimension == 3 ? -measure : measure, 100 * eps);
  }
  if (cell().order == 1) {
    EXPECT_EQ(cell().n_nodes, cell().n_vertices);
    return;
  }
  const auto& middles = med_middles.at(cell().name);
  ASSERT_EQ(static_cast<int>(middles.size()), cell().n_nodes - cell().n_vertices);
  for (int j = cell().n_vertices; j < cell().n_nodes; ++j) {
    const auto& around =
        middles[static_cast<std::size_t>(cell().med_permutation[static_cast<std::size_t>(j)] - cell().n_vertices)];
    for (int d = 0; d < cell().dimension; ++d) {
      double centre = 0;
      for (int a = 0; a < cell().n_vertices; ++a)
        if (around.contains(vertices[static_cast<std::size_t>(a)] + 1))
          centre += cell().nodes[static_cast<std::size_t>(a * cell().dimension + d)] / static_cast<double>(around.size());
      EXPECT_NEAR(cell().nodes[static_cast<std::size_t>(j * cell().dimension + d)], centre, 4 * eps)
          << cell().name << " node " << j + 1;
    }
  }
}

TEST_P(NamedCell, FacetsAreSeenFromOutside) {
  if (cell().dimension < 2) {
    EXPECT_EQ(cell().facets.size(), cell().dimension == 1 ? 2u : 0u);
    return;
  }
  const std::size_t dim = static_cast<std::size_t>(cell().dimension);
  std::vector<double> centre(dim, 0.0);
  for (int a = 0; a < cell().n_vertices; ++a)
    for (std::size_t d = 0; d < dim; ++d) centre[d] += cell().nodes[static_cast<std::size_t>(a) * dim + d] / cell().n_vertices;
  for (const auto& facet : cell().facets) {
    const CellRow& type = lacon::catalog::cell(facet.type);
    ASSERT_EQ(static_cast<int>(facet.nodes.size()), type.n_nodes);
    EXPECT_EQ(type.order, cell().order);
    const auto corner = [&](std::size_t k, std::size_t d) {
      return cell().nodes[static_cast<std::size_t>(facet.nodes[k]) * dim + d];
    };
    double normal[3] = {};
    if (dim == 2) {
      normal[0] = corner(1, 1) - corner(0, 1);
      normal[1] = corner(0, 0) - corner(1, 0);
    } else {
      double t[3], s[3];
      for (std::size_t d = 0; d < 3; ++d) {
        t[d] = corner(1, d) - corner(0, d);
        s[d] = corner(2, d) - corner(0, d);
      }
      for (std::size_t d = 0; d < 3; ++d) normal[d] = t[(d + 1) % 3] * s[(d + 2) % 3] - t[(d + 2) % 3] * s[(d + 1) % 3];
    }
    double outward = 0;
    for (std::size_t d = 0; d < dim; ++d) outward += normal[d] * (corner(0, d) - centre[d]);
    EXPECT_GT(outward, 0) << cell().name;
    for (int e = 0; type.order == 2 && e < static_cast<int>(type.edges.size()); ++e)  // middles where the vertices say
      for (std::size_t d = 0; d < dim; ++d)
        EXPECT_EQ(corner(static_cast<std::size_t>(type.n_vertices + e), d),
                  0.5 * (corner(static_cast<std::size_t>(type.edges[static_cast<std::size_t>(e)].first), d) +
                         corner(static_cast<std::size_t>(type.edges[static_cast<std::size_t>(e)].second), d)));
  }
}

INSTANTIATE_TEST_SUITE_P(All, NamedCell, testing::Range(0, static_cast<int>(lacon::catalog::cells().size())),
                         [](const auto& cell) {
                           return std::string(lacon::catalog::cells()[static_cast<std::size_t>(cell.param)].name);
                         });

TEST(Pyramid, FunctionsAtTheApexAreTheLimitFromInside) {
  for (const CellType type : {CellType::PYRAM5, CellType::PYRAM13}) {
    const auto n = static_cast<std::size_t>(lacon::catalog::cell(type).n_nodes);
    std::vector<double> at(3 * n), near(3 * n);
    lacon::shape_gradients(type, std::vector<double>{0, 0, 1}, at);
    lacon::shape_gradients(type, std::vector<double>{0, 0, 1 - 1e-9}, near);
    for (std::size_t i = 0; i < 3 * n; ++i) EXPECT_NEAR(at[i], near[i], 1e-8);  // second derivatives on the axis are below 10
  }
}

// ---------------------------------------------------------------------------------------------------- integration rules

double factorial(int n) { return n < 2 ? 1 : n * factorial(n - 1); }

/// Integral of x^i over [-1, 1].
double even(int i) { return i % 2 ? 0.0 : 2.0 / (i + 1); }

/// Exact integral of x^i y^j z^k over the reference cell.
double monomial(Family family, int i, int j, int k) {
  switch (family) {
    case Family::SEG:
      return even(i);
    case Family::QUAD:
      return even(i) * even(j);
    case Family::HEXA:
      return even(i) * even(j) * even(k);
    case Family::TRIA:
      return factorial(i) * factorial(j) / factorial(i + j + 2);
    case Family::TETRA:
      return factorial(i) * factorial(j) * factorial(k) / factorial(i + j + k + 3);
    case Family::PENTA:
      return factorial(i) * factorial(j) / factorial(i + j + 2) * even(k);
    case Family::PYRAM:
      return even(i) * even(j) * factorial(k) * factorial(i + j + 2) / factorial(i + j + k + 3);
    default:
      return 1;
  }
}

struct RuleCase {
  Family family;
  int points;
  int degree;            ///< total degree that it must integrate exactly
  bool positive = true;  ///< all weights
};

const RuleCase rules[] = {
    {Family::POINT, 1, 0},        {Family::TRIA, 1, 1},   {Family::TRIA, 3, 2},   {Family::TRIA, 4, 3},
    {Family::TRIA, 6, 4},         {Family::TRIA, 7, 5},   {Family::TRIA, 9, 5},   {Family::TRIA, 12, 6},
    {Family::TRIA, 16, 8},        {Family::TRIA, 25, 9},  {Family::TRIA, 64, 15}, {Family::TRIA, 100, 19},
    {Family::QUAD, 1, 1},         {Family::QUAD, 4, 3},   {Family::QUAD, 7, 5},   {Family::QUAD, 9, 5},
    {Family::QUAD, 16, 7},        {Family::QUAD, 25, 9},  {Family::TETRA, 1, 1},  {Family::TETRA, 4, 2},
    {Family::TETRA, 5, 3, false}, {Family::TETRA, 15, 5}, {Family::PENTA, 6, 2},  {Family::PENTA, 21, 5},
    {Family::PYRAM, 1, 1},        {Family::PYRAM, 5, 2},  {Family::PYRAM, 8, 3},  {Family::PYRAM, 27, 5},
    {Family::HEXA, 1, 1},         {Family::HEXA, 8, 3},   {Family::HEXA, 27, 5},  {Family::HEXA, 64, 7},
};

int dimension_of(Family family) {
  for (const CellRow& row : lacon::catalog::cells())
    if (row.family == family) return row.dimension;
  return -1;
}

double integrate(const Rule& rule, int i, int j, int k) {
  double sum = 0;
  const auto d = static_cast<std::size_t>(rule.dimension);
  for (std::size_t p = 0; p < rule.weights.size(); ++p) {
    double value = rule.weights[p];
    const int powers[3] = {i, j, k};
    for (std::size_t axis = 0; axis < d; ++axis) value *= std::pow(rule.points[p * d + axis], powers[axis]);
    sum += value;
  }
  return sum;
}

void check_rule(const RuleCase& c) {
  const Rule& rule = lacon::integration_rule(c.family, c.points);
  EXPECT_EQ(rule.size(), c.points);
  ASSERT_EQ(rule.dimension, dimension_of(c.family));
  ASSERT_EQ(rule.points.size(), static_cast<std::size_t>(c.points * rule.dimension));
  const int dim = rule.dimension;
  for (int k = 0; k <= (dim > 2 ? c.degree : 0); ++k)
    for (int j = 0; j + k <= (dim > 1 ? c.degree : 0); ++j)
      for (int i = 0; i + j + k <= (dim > 0 ? c.degree : 0); ++i)
        // the error of one abscissa is round-off times the degree
        EXPECT_NEAR(integrate(rule, i, j, k), monomial(c.family, i, j, k), 8 * eps * (4 + c.degree))
            << static_cast<int>(c.family) << ' ' << c.points << ": " << i << j << k;
  bool positive = true;
  for (const double w : rule.weights) positive &= w > 0;
  EXPECT_EQ(positive, c.positive) << static_cast<int>(c.family) << ' ' << c.points;
}

TEST(Rules, AreExactToTheirDegreeWithPositiveWeights) {
  for (const RuleCase& c : rules) check_rule(c);
  for (int n = 1; n <= 10; ++n) check_rule({Family::SEG, n, 2 * n - 1});
  for (int n = 11; n <= 32; n += 7) check_rule({Family::SEG, n, 2 * n - 1});
}

TEST(Rules, AreNotExactBeyondTheirDegree) {  // the degrees above are the true ones: the table hides no better or worse rule
  for (const RuleCase& c : rules) {
    const int dim = dimension_of(c.family), degree = c.degree + 1;
    double worst = 0;
    for (int k = 0; k <= (dim > 2 ? degree : 0); ++k)
      for (int j = 0; j + k <= (dim > 1 ? degree : 0); ++j) {
        const int i = degree - j - k;
        worst = std::max(
            worst, std::abs(integrate(lacon::integration_rule(c.family, c.points), i, j, k) - monomial(c.family, i, j, k)));
      }
    if (dim > 0) {
      EXPECT_GT(worst, 1e-13) << static_cast<int>(c.family) << ' ' << c.points;
    }
  }
}

TEST(Rules, PointsLieInsideTheCell) {
  for (const RuleCase& c : rules) {
    const Rule& rule = lacon::integration_rule(c.family, c.points);
    const CellRow* linear = nullptr;
    for (const CellRow& row : lacon::catalog::cells())
      if (row.family == c.family && !linear) linear = &row;
    std::vector<double> n(static_cast<std::size_t>(linear->n_nodes));
    for (int p = 0; p < rule.size(); ++p) {  // the vertices' functions of a linear cell are positive inside it alone
      lacon::shape_functions(
          linear->type,
          std::span(rule.points)
              .subspan(static_cast<std::size_t>(p * rule.dimension), static_cast<std::size_t>(rule.dimension)),
          n);
      for (const double value : n) EXPECT_GT(value, 0) << linear->name << ' ' << c.points;
    }
  }
}

TEST(Rules, ThreePointTriangleStartsNearNodeOne) {  // users read stresses by point number
  const Rule& rule = lacon::integration_rule(Family::TRIA, 3);
  const double expected[] = {1. / 6, 1. / 6, 2. / 3, 1. / 6, 1. / 6, 2. / 3};
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(rule.points[i], expected[i], eps);
}

TEST(Rules, TheSameRuleIsMadeOnce) {
  EXPECT_EQ(&lacon::integration_rule(Family::HEXA, 27), &lacon::integration_rule(Family::HEXA, 27));
}

TEST(Rules, AnUnknownNumberOfPointsIsRefused) {
  for (const int n : {-1, 0, 2, 5, 10000000}) EXPECT_THROW(lacon::integration_rule(Family::TRIA, n), std::logic_error) << n;
  EXPECT_THROW(lacon::integration_rule(Family::POINT, 2), std::logic_error);
  EXPECT_THROW(lacon::integration_rule(Family::TETRA, 8), std::logic_error);
  EXPECT_THROW(lacon::integration_rule(Family::PYRAM, 13), std::logic_error);
  EXPECT_THROW(lacon::integration_rule(Family::HEXA, 20), std::logic_error);
  EXPECT_THROW(lacon::gauss_rule(0), std::logic_error);
  EXPECT_THROW(lacon::tabulate(CellType::TRIA3, lacon::gauss_rule(2)), std::logic_error);
}

TEST(Catalogue, EveryElementHasItsRule) {
  ASSERT_FALSE(lacon::catalog::elements().empty());
  for (const auto& row : lacon::catalog::elements()) {
    const CellRow& cell = lacon::catalog::cell(row.cell);
    const auto table = lacon::tabulate(row.cell, lacon::integration_rule(cell.family, row.points));
    EXPECT_EQ(table.n_points, row.points) << row.name;
    EXPECT_EQ(table.n_nodes, cell.n_nodes) << row.name;
  }
}

TEST(Catalogue, NodePermutationsAreComplete) {
  for (const CellRow& cell : lacon::catalog::cells())
    for (const auto order : {cell.mirror, cell.med_permutation}) {
      EXPECT_EQ(static_cast<int>(order.size()), cell.n_nodes) << cell.name;
      const std::set<std::int8_t> distinct(order.begin(), order.end());
      EXPECT_EQ(static_cast<int>(distinct.size()), cell.n_nodes) << cell.name;
      EXPECT_EQ(*distinct.begin(), 0) << cell.name;
      EXPECT_EQ(*distinct.rbegin(), cell.n_nodes - 1) << cell.name;
    }
}

}  // namespace
