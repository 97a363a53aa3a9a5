// Fields of states that processes keep: the files of one process, from a few cells at a time.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <sstream>
#include <string>

#include "../assembly/hexa_block.hpp"
#include "lacon/assembly/parts/cells.hpp"
#include "lacon/assembly/parts/solid_parts.hpp"
#include "lacon/operators/evolution/observers/restart.hpp"
#include "lacon/operators/evolution/state_fields.hpp"

namespace lacon {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t part = 2'000'000;  // bytes of a dataset that are written at a time

/// Processes that are none: they obey within the test.
class Pretended : public PartProcesses {
 public:
  explicit Pretended(int size) {
    for (int rank = 0; rank < size; ++rank) cells_.push_back(std::make_unique<Cells>(rank, size, lender_));
  }
  int size() const override { return static_cast<int>(cells_.size()); }
  void start() override {}
  void keep() override {}
  std::string ask(const std::string& line) override {
    std::istringstream said(line);
    std::string verb, number, quantity, path;
    if (said >> verb; verb == "collect") {
      said >> number >> quantity >> path;
      most_ = std::max(most_, SharedMemory::open(path).size());
    }
    for (const auto& process : cells_) EXPECT_TRUE(process->obey(line)) << line;
    return "done";
  }
  std::size_t most() const { return most_; }  ///< bytes that were collected at a time

 private:
  Lender lender_;
  std::vector<std::unique_ptr<Cells>> cells_;
  std::size_t most_ = 0;
};

/// A block of HEXA8 of three laws in turn, one without internal variables.
struct FieldsOfParts : testing::Test {
  StaticProblem problem;
  fs::path folder;

  FieldsOfParts() : folder(fs::path(testing::TempDir()) / ("lacon_state_fields_" + std::to_string(getpid()))) {
    fs::create_directories(folder);
    problem.dimension = 3;
    test::HexaBlock{20}.add_to(problem.mesh);
    const std::size_t count = problem.mesh.n_cells();
    problem.model = {.mesh = {},
                     .phenomenon = "MECANIQUE",
                     .dimension = 3,
                     .elements = {"3D/HEXA8"},
                     .element = std::vector<std::int32_t>(count, 0)};
    problem.registry = std::make_unique<Registry>();
    problem.components = node_unknowns(problem.model, *problem.registry);
    problem.material_field = std::make_unique<MaterialField>();
    problem.material_field->material.assign(count, 0);
    problem.materials = std::make_unique<MaterialTable>(
        *problem.material_field,
        std::vector<Material>{{{{"ELAS", {{"E", 200.0}, {"NU", 0.3}}}, {"ECRO_LINE", {{"SY", 1.0}, {"D_SIGM_EPSI", 20.0}}}}}},
        std::vector<std::string>{"STEEL"});
    std::vector<std::int32_t> law;
    for (std::size_t c = 0; c < count; ++c) law.push_back(c % 7 == 0 ? 0 : c % 3 == 0 ? 2 : 1);
    problem.solids = solid_sets(problem.mesh, problem.model, *problem.registry, *problem.materials,
                                {{"ELAS/PETIT", "VMIS_ISOT_LINE/PETIT", "VMIS_ISOT_LINE/GDEF_LOG"}, law});
    problem.exists.assign(3 * problem.mesh.n_nodes(), 1);
    problem.numbering = number_equations(static_cast<std::int64_t>(problem.mesh.n_nodes()), 3, problem.exists, 0);
  }
  ~FieldsOfParts() override { fs::remove_all(folder); }

  Field written(const FieldRows& rows) const {
    write_field(folder / "field.h5", rows);
    return read_field(folder / "field.h5");
  }
  /// Numbers that each stand in one place.
  StaticState numbered() const {
    StaticState state;
    double next = 0;
    const auto some = [&](std::size_t size) {
      std::vector<double> values(size);
      for (double& value : values) value = ++next;
      return values;
    };
    for (const ElementSet& set : problem.solids)
      state.points.push_back({.stress = some(set.cells.size() * set.n_stress()),
                              .variable = some(set.cells.size() * set.n_variables()),
                              .thermal = {},
                              .parameter = {}});
    return state;
  }
};

TEST_F(FieldsOfParts, AreThoseOfOneProcessAndComeAFewCellsAtATime) {
  ASSERT_EQ(problem.solids.size(), 3);
  const StaticState here = numbered();
  const auto processes = std::make_shared<Pretended>(3);
  const auto parts = std::make_shared<SolidParts>(processes, problem.mesh, problem.solids, problem.numbering,
                                                  problem.components, problem.plugins);
  StaticState there;
  there.kept = parts->put(here.points);
  for (FieldRows (*const field)(const StaticProblem&, const StaticState&) : {stress_field, variable_field}) {
    const Field found = written(field(problem, there)), expected = field(problem, here).whole();
    ASSERT_TRUE(found.name != "SIEF_ELGA" || found.values.size() * sizeof(double) > 3 * part / 2);
    EXPECT_EQ(found.components, expected.components);
    EXPECT_EQ(found.support, expected.support);
    EXPECT_EQ(found.offset, expected.offset);
    EXPECT_EQ(found.values, expected.values);
    EXPECT_EQ(found.present, expected.present);
  }
  const std::size_t points_of_two_cells = 2 * 8 * 8 * sizeof(double);  // of those that parts cut
  EXPECT_LE(processes->most(), part + points_of_two_cells);

  hdf5::write_whole(folder / "record.h5", [&](const hdf5::Group& root) { write(root.create("state"), there); });
  EXPECT_LE(processes->most(), part + points_of_two_cells);
  const StaticState back = read_state(hdf5::Reader(folder / "record.h5").open("state"));
  ASSERT_EQ(back.points.size(), here.points.size());
  for (std::size_t s = 0; s < here.points.size(); ++s) {
    EXPECT_EQ(back.points[s].stress, here.points[s].stress);
    EXPECT_EQ(back.points[s].variable, here.points[s].variable);
  }
}

TEST_F(FieldsOfParts, RowsAreTheSameInWhateverPartsTheyAreMade) {
  problem.solids.back().n_point_variables = 3;  // as a law has that is not built in: others lack one of them
  const StaticState state = numbered();
  for (const FieldRows& rows : {stress_field(problem, state), variable_field(problem, state)}) {
    const Field whole = FieldRows(rows).whole();
    ASSERT_EQ(whole.present.empty(), whole.name == "SIEF_ELGA");
    const std::size_t width = whole.n_components();
    std::size_t there = 0;
    for (std::size_t row = 0, size = 1; row < whole.n_rows(); row += size, size = 1 + (3 * size + row) % 29) {
      size = std::min(size, whole.n_rows() - row);
      std::vector<double> values(size * width, -1);
      rows.values(rows.field, row, values);
      std::vector<std::uint8_t> present(size * width, 9);
      if (rows.present) rows.present(rows.field, row, present);
      for (std::size_t i = 0; i < values.size(); ++i) {
        ASSERT_EQ(values[i], whole.values[row * width + i]) << whole.name << " row " << row << " of " << size;
        ASSERT_TRUE(!rows.present || present[i] == whole.present[row * width + i]);
        there += whole.present.empty() || whole.present[row * width + i] == Field::there;
      }
    }
    std::size_t expected = 0;
    for (const ElementSet& set : problem.solids)
      expected += set.cells.size() * (whole.name == "SIEF_ELGA" ? set.n_stress() : set.n_variables());
    EXPECT_EQ(there, expected);
  }
  // values stand at their cells
  const Field stress = stress_field(problem, state).whole();
  for (std::size_t s = 0; s < problem.solids.size(); ++s)
    for (std::size_t i = 0; i < problem.solids[s].cells.size(); i += 100) {
      const auto place = std::ranges::find(stress.support, problem.solids[s].cells[i]) - stress.support.begin();
      EXPECT_EQ(stress.at(stress.first_row(static_cast<std::size_t>(place)), 0),
                state.points[s].stress[i * problem.solids[s].n_stress()]);
    }
}

}  // namespace
}  // namespace lacon
