// The contact kernel, the system of one contact cell, and what macro-elements make of them.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <random>

#include "lacon/catalog/contact.hpp"
#include "lacon/elements/contact_system.hpp"
#include "lacon/elements/reference.hpp"
#include "lacon/elements/registry.hpp"
#include "solids.hpp"

namespace {

using lacon::CellType;
using Numbers = std::vector<double>;

/// The kernel of the skins of a modelisation.
const lacon_kernel& contact_kernel(int dimension, bool axis) {
  static lacon::Registry registry;
  const char* const element = dimension == 3 ? "3D/TRIA3" : axis ? "AXIS/SEG2" : "D_PLAN/SEG2";
  return registry.kernel(*registry.find_element(element), "RIGI_CONT", LACON_CONTACT);
}

/// One contact cell: a slave and a master cell with points on both.
struct ContactCell {
  CellType slave_type, master_type;
  int dimension;
  Numbers weight, slave_xi, master_xi;
  Numbers initial, slave, master, normals;
  bool current = false, axis = false;

  int slaves() const { return lacon::catalog::cell(slave_type).n_nodes; }
  int masters() const { return lacon::catalog::cell(master_type).n_nodes; }
  Numbers shape(CellType type, const Numbers& xi, bool gradient) const {
    const int nodes = lacon::catalog::cell(type).n_nodes, d = dimension - 1;
    Numbers values;
    for (std::size_t p = 0; p < weight.size(); ++p) {
      Numbers at(z(gradient ? nodes * d : nodes));
      const auto point = std::span(xi).subspan(p * z(d), z(d));
      gradient ? lacon::shape_gradients(type, point, at) : lacon::shape_functions(type, point, at);
      values.insert(values.end(), at.begin(), at.end());
    }
    return values;
  }
};

struct ContactResult {
  Numbers point_gap, coupling;
  double gap, measure, current_measure;
  int error;
};

ContactResult run(const ContactCell& c, int batch_dimension = 0) {
  const Numbers shape = c.shape(c.slave_type, c.slave_xi, false), gradient = c.shape(c.slave_type, c.slave_xi, true),
                master_shape = c.shape(c.master_type, c.master_xi, false);
  const std::int64_t offset[] = {0, static_cast<std::int64_t>(c.weight.size())};
  ContactResult r{Numbers(c.weight.size()), Numbers(z((c.slaves() + c.masters()) * c.dimension), garbage), -1, -1, -1, -1};
  const lacon_contact_batch batch{sizeof(lacon_contact_batch),
                                  1,
                                  c.slaves(),
                                  c.masters(),
                                  batch_dimension ? batch_dimension : c.dimension,
                                  c.current,
                                  offset,
                                  c.weight.data(),
                                  shape.data(),
                                  gradient.data(),
                                  master_shape.data(),
                                  c.initial.data(),
                                  c.slave.data(),
                                  c.master.data(),
                                  c.normals.empty() ? nullptr : c.normals.data(),
                                  r.point_gap.data(),
                                  &r.gap,
                                  &r.measure,
                                  &r.current_measure,
                                  r.coupling.data(),
                                  &r.error};
  contact_kernel(c.dimension, c.axis).contact(&batch);
  return r;
}

/// Two facing cells of any kinds, bent and displaced at random; points of a rule on the slave, anywhere near on the master.
ContactCell random_cell(CellType slave, CellType master, unsigned seed) {
  const int dimension = lacon::catalog::cell(slave).dimension + 1;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> number(-0.08, 0.08);
  ContactCell c{slave, master, dimension, {}, {}, {}, {}, {}, {}, {}};
  const auto family = lacon::catalog::cell(slave).family;
  const auto& rule = lacon::integration_rule(family, dimension == 2 ? 4 : family == lacon::Family::TRIA ? 6 : 9);
  c.weight = rule.weights;
  c.slave_xi = rule.points;
  c.master_xi = rule.points;
  for (double& xi : c.master_xi) xi = 0.8 * xi + number(random);
  const auto nodes = [&](CellType type, double height, double size) {
    const auto& cell = lacon::catalog::cell(type);
    Numbers x;
    for (int a = 0; a < cell.n_nodes; ++a) {
      for (int d = 0; d < dimension - 1; ++d) x.push_back(size * cell.nodes[z(a * cell.dimension + d)] + number(random));
      x.push_back(height + number(random));
    }
    return x;
  };
  c.initial = nodes(slave, 0, 1);
  c.slave = c.initial;
  for (double& x : c.slave) x += 2 * number(random);
  c.master = nodes(master, 0.2, 1.3);
  return c;
}

/// Normals, Jacobians of the slave at its points, for a functional of one's own.
struct Frozen {
  std::vector<std::array<double, 3>> normal;
  Numbers measure;
};

Frozen freeze(const ContactCell& c) {
  Frozen frozen;
  const Numbers gradient = c.shape(c.slave_type, c.slave_xi, true), shape = c.shape(c.slave_type, c.slave_xi, false);
  const auto area = [&](const Numbers& x, std::size_t p) {
    double t[2][3] = {{0, 0, 0}, {0, 0, c.dimension == 2 ? 1.0 : 0.0}};
    for (int a = 0; a < c.slaves(); ++a)
      for (int i = 0; i < c.dimension; ++i)
        for (int s = 0; s < c.dimension - 1; ++s)
          t[s][i] += gradient[(p * z(c.slaves()) + z(a)) * z(c.dimension - 1) + z(s)] * x[z(a * c.dimension + i)];
    return std::array{t[0][1] * t[1][2] - t[0][2] * t[1][1], t[0][2] * t[1][0] - t[0][0] * t[1][2],
                      t[0][0] * t[1][1] - t[0][1] * t[1][0]};
  };
  for (std::size_t p = 0; p < c.weight.size(); ++p) {
    auto n = area(c.slave, p);
    const auto n0 = area(c.initial, p);
    const double j = std::hypot(n[0], n[1], n[2]), j0 = std::hypot(n0[0], n0[1], n0[2]);
    if (!c.normals.empty()) {
      n = {};
      for (int a = 0; a < c.slaves(); ++a)
        for (int i = 0; i < c.dimension; ++i) n[z(i)] += shape[p * z(c.slaves()) + z(a)] * c.normals[z(a * c.dimension + i)];
    }
    const double length = std::hypot(n[0], n[1], n[2]);
    frozen.normal.push_back({n[0] / length, n[1] / length, n[2] / length});
    frozen.measure.push_back(c.weight[p] * (c.current ? j : j0));
  }
  return frozen;
}

/// The integrated gap with normal, projection, polygon and Jacobian frozen.
double frozen_gap(const ContactCell& c, const Frozen& frozen) {
  const Numbers shape = c.shape(c.slave_type, c.slave_xi, false), master_shape = c.shape(c.master_type, c.master_xi, false);
  double sum = 0;
  for (std::size_t p = 0; p < c.weight.size(); ++p)
    for (int i = 0; i < c.dimension; ++i) {
      double across = 0;
      for (int a = 0; a < c.masters(); ++a)
        across += master_shape[p * z(c.masters()) + z(a)] * c.master[z(a * c.dimension + i)];
      for (int a = 0; a < c.slaves(); ++a) across -= shape[p * z(c.slaves()) + z(a)] * c.slave[z(a * c.dimension + i)];
      sum += frozen.measure[p] * frozen.normal[p][z(i)] * across;
    }
  return sum;
}

using Couple = std::pair<CellType, CellType>;

struct Lac : testing::TestWithParam<Couple> {
  /// The couple in each of the four variants: INITIAL and ACTUALISE, without and with LISSAGE.
  std::vector<ContactCell> variants() const {
    std::vector<ContactCell> all;
    for (const bool current : {false, true})
      for (const bool smooth : {false, true}) {
        ContactCell c = random_cell(GetParam().first, GetParam().second, 5);
        c.current = current;
        if (smooth)
          for (int a = 0; a < c.slaves(); ++a) {
            Numbers n(z(c.dimension), 0.1 * a - 0.2);
            n.back() = c.dimension == 2 ? -1 : 1;
            c.normals.insert(c.normals.end(), n.begin(), n.end());
          }
        all.push_back(c);
      }
    return all;
  }
};

TEST_P(Lac, CouplingIsTheDerivativeOfTheGapWithNormalProjectionPolygonAndJacobianFrozen) {
  for (const ContactCell& c : variants()) {
    const ContactResult r = run(c);
    ASSERT_EQ(r.error, LACON_FINE);
    const Frozen frozen = freeze(c);
    EXPECT_NEAR(r.gap, frozen_gap(c, frozen), 100 * eps);
    for (int node = 0; node < c.slaves() + c.masters(); ++node)
      for (int i = 0; i < c.dimension; ++i) {
        ContactCell low = c, high = c;
        const auto coordinate = [&](ContactCell& of) -> double& {
          return node < c.slaves() ? of.slave[z(node * c.dimension + i)] : of.master[z((node - c.slaves()) * c.dimension + i)];
        };
        coordinate(low) -= 0.5;  // linear: no truncation error
        coordinate(high) += 0.5;
        EXPECT_NEAR(r.coupling[z(node * c.dimension + i)], frozen_gap(high, frozen) - frozen_gap(low, frozen), 400 * eps);
      }
  }
}

TEST_P(Lac, RigidTranslationDoesNotCoupleOnAnyGeometry) {
  for (const ContactCell& c : variants()) {
    const ContactResult r = run(c);
    for (int i = 0; i < c.dimension; ++i) {
      double sum = 0, size = 0;
      for (int node = 0; node < c.slaves() + c.masters(); ++node) {
        sum += r.coupling[z(node * c.dimension + i)];
        size += std::abs(r.coupling[z(node * c.dimension + i)]);
      }
      EXPECT_GT(size, 0);
      EXPECT_LE(std::abs(sum), 1e-13 * size);
    }
  }
}

TEST_P(Lac, MeasuresFollowTheKindOfJacobianAndTheCurrentOneIsAlwaysCurrent) {
  for (ContactCell c : variants()) {
    c.slave = c.initial;
    const ContactResult before = run(c);
    EXPECT_NEAR(before.measure, before.current_measure, 20 * eps);  // products may be fused with one sum and not the other
    for (double& x : c.slave) x *= 3;
    for (double& x : c.master) x *= 3;
    const ContactResult after = run(c);
    const double growth = c.dimension == 2 ? 3 : 9;
    EXPECT_NEAR(after.current_measure, growth * before.measure, 100 * eps);
    EXPECT_NEAR(after.measure, (c.current ? growth : 1) * before.measure, 100 * eps);
    EXPECT_NEAR(after.gap, (c.current ? growth : 1) * 3 * before.gap, 200 * eps);  // both G and C: METHOD.md 5.5
    for (std::size_t i = 0; i < after.coupling.size(); ++i)
      EXPECT_NEAR(after.coupling[i], (c.current ? growth : 1) * before.coupling[i], 200 * eps);
  }
}

TEST_P(Lac, IntegratedGapIsTheSumOfThePointGaps) {
  for (const ContactCell& c : variants()) {
    const ContactResult r = run(c);
    const Frozen frozen = freeze(c);
    double gap = 0, measure = 0;
    for (std::size_t p = 0; p < c.weight.size(); ++p) {
      gap += frozen.measure[p] * r.point_gap[p];
      measure += frozen.measure[p];
    }
    EXPECT_NEAR(r.gap, gap, 100 * eps);
    EXPECT_NEAR(r.measure, measure, 100 * eps);
  }
}

TEST_P(Lac, BadGeometryIsCaught) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const ContactCell& good : variants()) {
    ContactCell c = good;
    c.slave.assign(c.slave.size(), 0.7);
    EXPECT_EQ(run(c).error, LACON_BAD_JACOBIAN);
    c = good;
    c.initial.assign(c.initial.size(), 0.7);
    EXPECT_EQ(run(c).error, LACON_BAD_JACOBIAN);
    c = good;
    c.master[1] = nan;
    EXPECT_EQ(run(c).error, LACON_NOT_FINITE);
    c = good;
    c.normals.assign(c.slave.size(), 0.0);  // nodal normals that cancel
    EXPECT_EQ(run(c).error, LACON_BAD_JACOBIAN);
    EXPECT_EQ(run(good, 5 - good.dimension).error, LACON_BAD_BATCH);
  }
}

TEST_P(Lac, TheUnitOfLengthsIsNoJudgeOfGeometry) {
  for (const double unit : {1e-9, 1e9})
    for (const ContactCell& good : variants()) {
      ContactCell c = good;
      for (Numbers* const points : {&c.initial, &c.slave, &c.master})
        for (double& x : *points) x *= unit;
      const ContactResult r = run(c), whole = run(good);
      EXPECT_EQ(r.error, whole.error);
      for (std::size_t p = 0; p < c.weight.size(); ++p)  // a mean normal has a length of one for any unit
        EXPECT_NEAR(r.point_gap[p], unit * whole.point_gap[p], 100 * eps * unit);
    }
}

TEST(ContactKernel, ATangentThatIsRoundOffIsNone) {
  // edges along each axis, whose middle node lies where dx/dxi = xi + 1/2 - 2 xi m is nothing but round-off at one point
  int not_zero = 0;
  for (const int along : {0, 1})
    for (const double xi : {0.3, 0.35, 0.41, 0.57, 0.6, 0.71, 0.77, 0.83, 0.9}) {
      ContactCell c = random_cell(CellType::SEG3, CellType::SEG2, 1);
      c.slave_xi.assign(c.weight.size(), xi);
      const double middle = (xi + 0.5) / (2 * xi);
      c.slave.assign(6, 0.0);
      c.slave[z(2 + along)] = 1;
      c.slave[z(4 + along)] = middle;
      c.initial = c.slave;
      const Numbers gradient = c.shape(c.slave_type, c.slave_xi, true);
      not_zero += gradient[1] + gradient[2] * middle != 0;
      EXPECT_EQ(run(c).error, LACON_BAD_JACOBIAN) << xi;
    }
  EXPECT_GT(not_zero, 0);
}

std::vector<Couple> couples() {
  std::vector<Couple> all;
  for (const CellType slave : {CellType::SEG2, CellType::SEG3})
    for (const CellType master : {CellType::SEG2, CellType::SEG3}) all.emplace_back(slave, master);
  const CellType skins[] = {CellType::TRIA3, CellType::TRIA6, CellType::QUAD4, CellType::QUAD8, CellType::QUAD9};
  for (const CellType slave : skins)
    for (const CellType master : skins) all.emplace_back(slave, master);
  return all;
}

INSTANTIATE_TEST_SUITE_P(All, Lac, testing::ValuesIn(couples()), [](const auto& couple) {
  return std::string(lacon::catalog::cell(couple.param.first).name) + "_" +
         std::string(lacon::catalog::cell(couple.param.second).name);
});

/// A slave edge on top of its body (walked from right to left) and a master at height `gap` above it.
ContactCell flat_cell(double gap) {
  ContactCell c{CellType::SEG2, CellType::SEG2, 2, {}, {}, {}, {}, {}, {}, {}};
  c.weight = lacon::gauss_rule(2).weights;
  c.slave_xi = lacon::gauss_rule(2).points;
  c.master_xi = {-c.slave_xi[0], -c.slave_xi[1]};
  c.initial = c.slave = {2, 0, 0, 0};
  c.master = {0, gap, 2, gap};
  return c;
}

TEST(LacSigns, GapIsPositiveWhenOpenAndClosingItIsMinusTheMeasure) {
  for (const double gap : {0.3, -0.1}) {
    const ContactResult r = run(flat_cell(gap));
    EXPECT_NEAR(r.gap, 2 * gap, 4 * eps);
    EXPECT_NEAR(r.measure, 2, 4 * eps);
    // n_e = +y: moving the slave up by 1 closes the gap by 1 over the length 2, moving the master up opens it
    const Numbers exact = {0, -1, 0, -1, 0, 1, 0, 1};
    for (std::size_t i = 0; i < exact.size(); ++i) EXPECT_NEAR(r.coupling[i], exact[i], 4 * eps);
  }
}

TEST(LacSigns, InThreeDimensionsToo) {
  ContactCell c{CellType::TRIA3, CellType::TRIA3, 3, {}, {}, {}, {}, {}, {}, {}};
  const auto& rule = lacon::integration_rule(lacon::Family::TRIA, 3);
  c.weight = rule.weights;
  c.slave_xi = rule.points;
  c.initial = c.slave = {0, 0, 0, 1, 0, 0, 0, 1, 0};  // seen from above, the body below
  c.master = {0, 0, 0.2, 0, 1, 0.2, 1, 0, 0.2};
  for (std::size_t p = 0; p < 3; ++p) c.master_xi.insert(c.master_xi.end(), {c.slave_xi[2 * p + 1], c.slave_xi[2 * p]});
  const ContactResult r = run(c);
  EXPECT_NEAR(r.gap, 0.1, 4 * eps);
  EXPECT_NEAR(r.measure, 0.5, 4 * eps);
  for (int node = 0; node < 6; ++node) EXPECT_NEAR(r.coupling[z(3 * node + 2)], node < 3 ? -1. / 6 : 1. / 6, 4 * eps);
}

TEST(LacSigns, ForcesAreCollinearWherePointsAreProjectedAlongTheNormal) {
  ContactCell c = random_cell(CellType::SEG3, CellType::SEG2, 9);
  const Frozen frozen = freeze(c);
  const Numbers shape = c.shape(CellType::SEG3, c.slave_xi, false);
  const double tx = (c.master[2] - c.master[0]) / 2, ty = (c.master[3] - c.master[1]) / 2;
  for (std::size_t p = 0; p < c.weight.size(); ++p) {  // x + s n on the master's line
    double x = 0, y = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      x += shape[3 * p + a] * c.slave[2 * a];
      y += shape[3 * p + a] * c.slave[2 * a + 1];
    }
    const double dx = x - (c.master[0] + c.master[2]) / 2, dy = y - (c.master[1] + c.master[3]) / 2, nx = frozen.normal[p][0],
                 ny = frozen.normal[p][1];
    c.master_xi[p] = (dx * ny - dy * nx) / (tx * ny - ty * nx);
  }
  const ContactResult r = run(c);
  double moment = 0;
  for (std::size_t a = 0; a < 5; ++a) {
    const double* x = a < 3 ? &c.slave[2 * a] : &c.master[2 * (a - 3)];
    moment += x[0] * r.coupling[2 * a + 1] - x[1] * r.coupling[2 * a];
  }
  EXPECT_NEAR(moment, 0, 100 * eps);
}

TEST(LacSigns, ACellWithoutPointsIsEmpty) {
  ContactCell c = flat_cell(1);
  c.weight.clear();
  const ContactResult r = run(c);
  EXPECT_EQ(r.error, LACON_FINE);
  EXPECT_EQ(r.gap, 0);
  EXPECT_EQ(r.measure, 0);
  EXPECT_EQ(r.coupling, Numbers(8, 0.0));
}

// ---------------------------------------------------------------------------------------------------- macro-elements

using Point = std::array<double, 2>;

/// A macro-element of METHOD.md 1.4: its nodes by name and reference coordinates, and sub-cells in order.
struct Macro {
  std::map<std::string, Point> nodes;
  CellType type;
  std::vector<std::vector<std::string>> cells;
};

/// Integral of the shape function of each node over some sub-cells.
std::map<std::string, double> nodal_integrals(const Macro& macro, std::size_t first, std::size_t last) {
  const auto& cell = lacon::catalog::cell(macro.type);
  const int points = cell.dimension == 1                  ? 3
                     : cell.family == lacon::Family::TRIA ? 12
                                                          : 9;  // exact for shape times bilinear Jacobian
  const auto table = lacon::tabulate(macro.type, lacon::integration_rule(cell.family, points));
  std::map<std::string, double> sum;
  for (std::size_t e = first; e < last; ++e)
    for (int p = 0; p < table.n_points; ++p) {
      double j[2][2] = {{0, 0}, {0, cell.dimension == 1 ? 1.0 : 0.0}};
      for (int a = 0; a < cell.n_nodes; ++a)
        for (int r = 0; r < cell.dimension; ++r)
          for (int s = 0; s < cell.dimension; ++s)
            j[r][s] +=
                macro.nodes.at(macro.cells[e][z(a)])[z(r)] * table.gradient[z((p * cell.n_nodes + a) * cell.dimension + s)];
      const double weight = table.weight[z(p)] * (j[0][0] * j[1][1] - j[0][1] * j[1][0]);
      for (int a = 0; a < cell.n_nodes; ++a) sum[macro.cells[e][z(a)]] += weight * table.shape[z(p * cell.n_nodes + a)];
    }
  return sum;
}

/// Checks the integral of the shape functions of all nodes, and their sum.
void expect_integrals(const Macro& macro, const std::map<std::string, double>& exact, double area, std::size_t first = 0,
                      std::size_t last = 99) {
  last = std::min(last, macro.cells.size());
  double total = 0;
  const auto integrals = nodal_integrals(macro, first, last);
  EXPECT_EQ(integrals.size(), exact.size());
  for (const auto& [node, value] : integrals) {
    EXPECT_NEAR(value, exact.at(node), 40 * eps) << node;
    total += value;
  }
  EXPECT_NEAR(total, area, 40 * eps);
}

constexpr double third = 1.0 / 3;
const std::map<std::string, Point> triangle = {{"n1", {0, 0}},
                                               {"n2", {1, 0}},
                                               {"n3", {0, 1}},
                                               {"n4", {0.5, 0}},
                                               {"n5", {0.5, 0.5}},
                                               {"n6", {0, 0.5}},
                                               {"C", {third, third}},
                                               {"m1", {0.5 * third, 0.5 * third}},
                                               {"m2", {2 * third, 0.5 * third}},
                                               {"m3", {0.5 * third, 2 * third}}};
const std::map<std::string, Point> square = {{"n1", {-1, -1}},
                                             {"n2", {1, -1}},
                                             {"n3", {1, 1}},
                                             {"n4", {-1, 1}},
                                             {"n5", {0, -1}},
                                             {"n6", {1, 0}},
                                             {"n7", {0, 1}},
                                             {"n8", {-1, 0}},
                                             {"n9", {0, 0}},
                                             {"c1", {-third, -third}},
                                             {"c2", {third, -third}},
                                             {"c3", {third, third}},
                                             {"c4", {-third, third}},
                                             {"e1", {0, -third}},
                                             {"e2", {third, 0}},
                                             {"e3", {0, third}},
                                             {"e4", {-third, 0}},
                                             {"q1", {-2 * third, -2 * third}},
                                             {"q2", {2 * third, -2 * third}},
                                             {"q3", {2 * third, 2 * third}},
                                             {"q4", {-2 * third, 2 * third}},
                                             {"C", {0, 0}},
                                             {"m1", {-0.5, -0.5}},
                                             {"m2", {0.5, -0.5}},
                                             {"m3", {0.5, 0.5}},
                                             {"m4", {-0.5, 0.5}}};
const Macro hexa4 = {square,
                     CellType::QUAD4,
                     {{"n1", "n2", "c2", "c1"},
                      {"n2", "n3", "c3", "c2"},
                      {"n3", "n4", "c4", "c3"},
                      {"n4", "n1", "c1", "c4"},
                      {"c1", "c2", "c3", "c4"}}};
const Macro hexa8 = {square,
                     CellType::QUAD8,
                     {{"n1", "n2", "c2", "c1", "n5", "q2", "e1", "q1"},
                      {"n2", "n3", "c3", "c2", "n6", "q3", "e2", "q2"},
                      {"n3", "n4", "c4", "c3", "n7", "q4", "e3", "q3"},
                      {"n4", "n1", "c1", "c4", "n8", "q1", "e4", "q4"},
                      {"c1", "c2", "c3", "c4", "e1", "e2", "e3", "e4"}}};

TEST(MacroElements, NodalIntegralsOfEdges) {  // METHOD.md 1.7
  expect_integrals({{{"1", {-1, 0}}, {"c", {0, 0}}, {"2", {1, 0}}}, CellType::SEG2, {{"1", "c"}, {"c", "2"}}},
                   {{"1", 0.5}, {"c", 1}, {"2", 0.5}}, 2);
  expect_integrals({{{"1", {-1, 0}}, {"c1", {-third, 0}}, {"c2", {third, 0}}, {"2", {1, 0}}},
                    CellType::SEG2,
                    {{"1", "c1"}, {"c1", "c2"}, {"c2", "2"}}},
                   {{"1", third}, {"c1", 2 * third}, {"c2", 2 * third}, {"2", third}}, 2);
  expect_integrals({{{"1", {-1, 0}}, {"2", {1, 0}}, {"3", {0, 0}}}, CellType::SEG3, {{"1", "2", "3"}}},
                   {{"1", third}, {"2", third}, {"3", 4 * third}}, 2);
}

TEST(MacroElements, NodalIntegralsOfTriangles) {  // METHOD.md 1.7
  expect_integrals({triangle, CellType::TRIA3, {{"n1", "n2", "C"}, {"n2", "n3", "C"}, {"n3", "n1", "C"}}},
                   {{"n1", 1. / 9}, {"n2", 1. / 9}, {"n3", 1. / 9}, {"C", 1. / 6}}, 0.5);
  expect_integrals(
      {triangle,
       CellType::TRIA6,
       {{"n1", "n2", "C", "n4", "m2", "m1"}, {"n2", "n3", "C", "n5", "m3", "m2"}, {"n3", "n1", "C", "n6", "m1", "m3"}}},
      {{"n1", 0},
       {"n2", 0},
       {"n3", 0},
       {"n4", 1. / 18},
       {"n5", 1. / 18},
       {"n6", 1. / 18},
       {"m1", 1. / 9},
       {"m2", 1. / 9},
       {"m3", 1. / 9},
       {"C", 0}},
      0.5);
}

TEST(MacroElements, NodalIntegralsOfQuadranglesCutInPyramids) {  // METHOD.md 1.7
  expect_integrals({square, CellType::TRIA3, {{"n1", "n2", "C"}, {"n2", "n3", "C"}, {"n3", "n4", "C"}, {"n4", "n1", "C"}}},
                   {{"n1", 2 * third}, {"n2", 2 * third}, {"n3", 2 * third}, {"n4", 2 * third}, {"C", 4 * third}}, 4);
  expect_integrals({square,
                    CellType::TRIA6,
                    {{"n1", "n2", "C", "n5", "m2", "m1"},
                     {"n2", "n3", "C", "n6", "m3", "m2"},
                     {"n3", "n4", "C", "n7", "m4", "m3"},
                     {"n4", "n1", "C", "n8", "m1", "m4"}}},
                   {{"n1", 0},
                    {"n2", 0},
                    {"n3", 0},
                    {"n4", 0},
                    {"n5", third},
                    {"n6", third},
                    {"n7", third},
                    {"n8", third},
                    {"m1", 2 * third},
                    {"m2", 2 * third},
                    {"m3", 2 * third},
                    {"m4", 2 * third},
                    {"C", 0}},
                   4);
}

TEST(MacroElements, NodalIntegralsOfQuadranglesCutInHexahedra) {  // METHOD.md 1.7
  std::map<std::string, double> whole;
  for (const std::string i : {"1", "2", "3", "4"}) {
    whole["n" + i] = 14. / 27;
    whole["c" + i] = 13. / 27;
  }
  expect_integrals(hexa4, whole, 4);
  expect_integrals(hexa4, {{"n1", 7. / 27}, {"n2", 7. / 27}, {"c1", 5. / 27}, {"c2", 5. / 27}}, 8. / 9, 0, 1);
  expect_integrals(hexa4, {{"c1", 1. / 9}, {"c2", 1. / 9}, {"c3", 1. / 9}, {"c4", 1. / 9}}, 4. / 9, 4, 5);
  whole.clear();
  for (int i = 1; i <= 4; ++i) {
    const std::string name = std::to_string(i);
    whole["n" + name] = -10. / 81;
    whole["c" + name] = -17. / 81;
    whole["n" + std::to_string(i + 4)] = 28. / 81;
    whole["e" + name] = 32. / 81;
    whole["q" + name] = 16. / 27;
  }
  expect_integrals(hexa8, whole, 4);
  expect_integrals(hexa8,
                   {{"n1", -5. / 81},
                    {"n2", -5. / 81},
                    {"c1", -7. / 81},
                    {"c2", -7. / 81},
                    {"n5", 28. / 81},
                    {"e1", 20. / 81},
                    {"q1", 8. / 27},
                    {"q2", 8. / 27}},
                   8. / 9, 0, 1);
}

TEST(MacroElements, NodalIntegralsOfNineNodes) {  // METHOD.md 1.7
  expect_integrals({square, CellType::QUAD9, {{"n1", "n2", "n3", "n4", "n5", "n6", "n7", "n8", "n9"}}},
                   {{"n1", 1. / 9},
                    {"n2", 1. / 9},
                    {"n3", 1. / 9},
                    {"n4", 1. / 9},
                    {"n5", 4. / 9},
                    {"n6", 4. / 9},
                    {"n7", 4. / 9},
                    {"n8", 4. / 9},
                    {"n9", 16. / 9}},
                   4);
}

// ---------------------------------------------------------------------------------------------------- tied multipliers

/// The constraint's row of a patch, its displacement rows and its diagonal, assembled from the systems of its sub-cells (one
/// master each, of one node) after the LAGS_C of all carriers became one equation. Coupling of cell e, slave node a, component
/// i: (letter a of cell e) x (1, 10, 100)_i.
struct Assembled {
  std::map<std::string, Numbers> row, force;
  double diagonal = 0, residual = 0, gap = 0;
  int cells = 0;
};

Assembled assemble(int kind, const Macro& macro, const std::vector<Numbers>& letters, bool active, double lambda) {
  Assembled sum;
  for (std::size_t e = 0; e < macro.cells.size(); ++e, ++sum.cells) {
    const auto* slave = lacon::catalog::find_slave(kind, static_cast<int>(e));
    const int nodes = static_cast<int>(macro.cells[e].size()), dimension = lacon::catalog::cell(slave->cell).dimension + 1;
    EXPECT_EQ(slave->cell, macro.type);
    const lacon::ContactCellDofs dofs{nodes, 1, dimension, slave->carriers};
    Numbers coupling, gap(1, 0.1 * static_cast<double>(e + 1));
    for (int a = 0; a <= nodes; ++a)
      for (int i = 0; i < dimension; ++i) coupling.push_back((a < nodes ? letters[e][z(a)] : -7.0) * std::pow(10, i));
    Numbers matrix(z(dofs.size() * (dofs.size() + 1) / 2), garbage), residual(z(dofs.size()), garbage);
    lacon::contact_system(dofs, coupling, {}, gap[0], active, lambda, matrix, residual);
    const auto entry = [&](int i, int j) { return matrix[z(std::max(i, j) * (std::max(i, j) + 1) / 2 + std::min(i, j))]; };
    sum.gap += gap[0];
    std::vector<int> multipliers;
    for (int l = 0; l < static_cast<int>(slave->carriers.size()); ++l) multipliers.push_back(dofs.multiplier(l));
    for (const int row : multipliers) {
      sum.residual += residual[z(row)];
      for (const int column : multipliers) sum.diagonal += entry(row, column);
    }
    for (int a = 0; a <= nodes; ++a) {
      const std::string node = a < nodes ? macro.cells[e][z(a)] : "master";
      sum.row.try_emplace(node, z(dimension), 0.0);
      sum.force.try_emplace(node, z(dimension), 0.0);
      for (int i = 0; i < dimension; ++i) {
        sum.force[node][z(i)] += residual[z(dofs.displacement(a, i))];
        for (const int row : multipliers) sum.row[node][z(i)] += entry(row, dofs.displacement(a, i));
      }
    }
  }
  return sum;
}

void expect_columns(int kind, const Macro& macro, const std::vector<Numbers>& letters, std::map<std::string, double> exact) {
  const double lambda = -2.5;
  const Assembled active = assemble(kind, macro, letters, true, lambda),
                  inactive = assemble(kind, macro, letters, false, lambda);
  exact["master"] = -7.0 * active.cells;
  EXPECT_EQ(active.row.size(), exact.size());
  for (const auto& [node, row] : active.row)
    for (std::size_t i = 0; i < row.size(); ++i) {
      const double c = exact.at(node) * std::pow(10, i);
      EXPECT_NEAR(row[i], c, 40 * eps * std::abs(c)) << node;
      EXPECT_NEAR(active.force.at(node)[i], lambda * c, 40 * eps * std::abs(lambda * c)) << node;
      EXPECT_EQ(inactive.row.at(node)[i], 0) << node;
      EXPECT_EQ(inactive.force.at(node)[i], 0) << node;
    }
  EXPECT_EQ(active.diagonal, 0);
  EXPECT_NEAR(active.residual, active.gap, 10 * eps);
  EXPECT_NEAR(inactive.diagonal, active.cells, 10 * eps);  // N, and N lambda: the solve makes lambda zero
  EXPECT_NEAR(inactive.residual, active.cells * lambda, 40 * eps);
}

// a, b, c, d of the sub-cells I to V
const std::vector<Numbers> letters = {{2, 3, 5, 7}, {11, 13, 17, 19}, {23, 29, 31, 37}, {41, 43, 47, 53}, {59, 61, 67, 71}};

TEST(TiedMultipliers, OfThreeEdgesMakeOneConstraint) {  // METHOD.md 5.6, SEG2 on QUAD4
  const Macro edge = {{{"x1", {-1, 0}}, {"c1", {-third, 0}}, {"c2", {third, 0}}, {"x2", {1, 0}}},
                      CellType::SEG2,
                      {{"x1", "c1"}, {"c1", "c2"}, {"c2", "x2"}}};
  expect_columns(12, edge, letters, {{"x1", 2}, {"c1", 3 + 11}, {"c2", 13 + 23}, {"x2", 29}});
}

TEST(TiedMultipliers, OfTwoEdgesMakeOneConstraint) {  // SEG2 on TRIA3
  const Macro edge = {{{"x1", {-1, 0}}, {"c", {0, 0}}, {"x2", {1, 0}}}, CellType::SEG2, {{"x1", "c"}, {"c", "x2"}}};
  expect_columns(7, edge, letters, {{"x1", 2}, {"c", 3 + 11}, {"x2", 13}});
}

TEST(TiedMultipliers, OfFiveQuadranglesMakeOneConstraint) {  // METHOD.md 5.6: (42) -> (43), column by column
  const auto& [i, ii, iii, iv, v] = std::tie(letters[0], letters[1], letters[2], letters[3], letters[4]);
  expect_columns(25, hexa4, letters,
                 {{"n1", i[0] + iv[1]},
                  {"n2", i[1] + ii[0]},
                  {"n3", ii[1] + iii[0]},
                  {"n4", iii[1] + iv[0]},
                  {"c1", v[0] + i[3] + iv[2]},
                  {"c2", v[1] + i[2] + ii[3]},
                  {"c3", v[2] + ii[2] + iii[3]},
                  {"c4", v[3] + iii[2] + iv[3]}});
}

TEST(TiedMultipliers, OfTheFlatSquareGiveTheNodalIntegrals) {  // METHOD.md 5.6: 14/27 and 13/27
  const double outer = 7. / 27, inner = 5. / 27, centre = 1. / 9;
  const std::vector<Numbers> flat = {{outer, outer, inner, inner},
                                     {outer, outer, inner, inner},
                                     {outer, outer, inner, inner},
                                     {outer, outer, inner, inner},
                                     Numbers(4, centre)};
  std::map<std::string, double> exact;
  for (const std::string k : {"1", "2", "3", "4"}) {
    exact["n" + k] = 14. / 27;
    exact["c" + k] = 13. / 27;
  }
  expect_columns(25, hexa4, flat, exact);
}

TEST(ContactSystem, OrdersTheMultiplierBehindItsNodesDisplacements) {
  const std::int8_t carriers[] = {1, 0};  // in any order
  const lacon::ContactCellDofs dofs{2, 2, 2, carriers};
  EXPECT_EQ(dofs.size(), 10);
  EXPECT_EQ(dofs.displacement(0, 0), 0);
  EXPECT_EQ(dofs.displacement(0, 1), 1);
  EXPECT_EQ(dofs.multiplier(1), 2);
  EXPECT_EQ(dofs.displacement(1, 0), 3);
  EXPECT_EQ(dofs.multiplier(0), 5);
  EXPECT_EQ(dofs.displacement(2, 0), 6);
  EXPECT_EQ(dofs.displacement(3, 1), 9);
}

TEST(ContactSystem, MatrixIsTheDerivativeOfTheResidual) {  // C frozen: d(lambda C)/d lambda = C, dG/du = C
  const std::int8_t carriers[] = {1};
  const lacon::ContactCellDofs dofs{2, 2, 2, carriers};
  const Numbers coupling = {1, 2, 3, 4, 5, 6, 7, 8};
  Numbers matrix(45), low(9), high(9);
  contact_system(dofs, coupling, {}, 0.5, true, -3, matrix, low);
  contact_system(dofs, coupling, {}, 0.5, true, -2, matrix, high);
  for (int node = 0; node < 4; ++node)
    for (int i = 0; i < 2; ++i) {
      const int at = dofs.displacement(node, i), row = dofs.multiplier(0);
      const double slope = high[z(at)] - low[z(at)];
      EXPECT_EQ(slope, coupling[z(2 * node + i)]);
      EXPECT_EQ(matrix[z(std::max(at, row) * (std::max(at, row) + 1) / 2 + std::min(at, row))], slope);
    }
  EXPECT_EQ(high[z(dofs.multiplier(0))], 0.5);
}

TEST(LacAxis, WeightsCarryTheRadiusOfTheGeometryOfTypeJacobien) {
  const auto& rule = lacon::gauss_rule(3);
  // a ring from r = 1 to 3, its body below, moved outward by 1; the master 0.1 above
  ContactCell c{CellType::SEG2, CellType::SEG2,   2, rule.weights, rule.points, {}, {3, 0, 1, 0},
                {4, 0, 2, 0},   {2, 0.1, 4, 0.1}, {}};
  for (const double xi : rule.points) c.master_xi.push_back(-xi);
  c.axis = true;
  for (const bool current : {false, true}) {
    c.current = current;
    const auto r = run(c);
    EXPECT_EQ(r.error, LACON_FINE);
    const double inner = current ? 2 : 1, area = current ? 6 : 4;  // int r dr
    EXPECT_NEAR(r.measure, area, 20 * eps);
    EXPECT_NEAR(r.current_measure, 6, 20 * eps);
    EXPECT_NEAR(r.gap, 0.1 * area, 20 * eps);
    const double outer_share = 2 * inner / 2 + 4.0 / 3, inner_share = area - outer_share;  // int N r dr, r = inner + 2 s
    const double exact[] = {-outer_share, -inner_share, inner_share, outer_share};
    for (int node = 0; node < 4; ++node) {
      EXPECT_NEAR(r.coupling[z(2 * node)], 0, 20 * eps);
      EXPECT_NEAR(r.coupling[z(2 * node + 1)], exact[node], 20 * eps);
    }
  }
  // a mesh may touch the axis, with the round-off of a file in single precision; a displaced node that no load holds may be
  // beyond it by the error of the discretisation
  const auto moved = [&](Numbers ContactCell::*geometry, double r) {
    ContactCell other = c;
    (other.*geometry)[2] = r;
    return run(other).error;
  };
  for (const double r : {0.0, -1e-7}) EXPECT_EQ(moved(&ContactCell::initial, r), LACON_FINE);
  EXPECT_EQ(moved(&ContactCell::initial, -0.1), LACON_BAD_RADIUS);
  for (const double r : {0.0, -1e-7, -0.1}) EXPECT_EQ(moved(&ContactCell::slave, r), LACON_FINE);
  EXPECT_EQ(moved(&ContactCell::slave, -0.6), LACON_BAD_RADIUS);
  // an iterate may be beyond the axis on its way: it counts nothing there
  c.slave = {-0.2, 0, -0.1, 0};
  EXPECT_EQ(run(c).error, LACON_BAD_RADIUS);
  EXPECT_EQ(run(c).current_measure, 0);
}

}  // namespace
