// Tables: what is stored reads back the same, missing cells among it.
#include <gtest/gtest.h>

#include "formats_fixture.hpp"
#include "lacon/structures/hdf5.hpp"
#include "lacon/structures/table.hpp"

namespace {

using namespace lacon;

class Tables : public test::InFolder {};

TEST_F(Tables, StoredReadsBackTheSame) {
  Table table = Table::of({{"NOEUD", "K8"}, {"NUME", "I"}, {"PRES", "R"}}, "pressures");
  table.add({"N1", std::int64_t{7}, -25.0});
  table.add({std::monostate{}, std::int64_t{0}, std::monostate{}});
  hdf5::write_whole(folder / "table.h5", [&](const hdf5::Group& root) { write_table(root, table); });
  const Table read = read_table(hdf5::Reader(folder / "table.h5"));
  EXPECT_EQ(read.title, "pressures");
  ASSERT_EQ(read.columns.size(), 3u);
  EXPECT_EQ(read.n_rows(), 2u);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(read.columns[k].name, table.columns[k].name);
    EXPECT_EQ(read.columns[k].type, table.columns[k].type);
    EXPECT_EQ(read.columns[k].cells, table.columns[k].cells);
  }
}

TEST_F(Tables, WithoutRows) {
  hdf5::write_whole(folder / "table.h5", [&](const hdf5::Group& root) {
    write_table(root, Table::of({{"A", "R"}, {"B", "K8"}}));
  });
  const Table read = read_table(hdf5::Reader(folder / "table.h5"));
  EXPECT_EQ(read.columns.size(), 2u);
  EXPECT_EQ(read.n_rows(), 0u);
}

TEST_F(Tables, ARowOfAnotherLengthIsRefused) {
  Table table = Table::of({{"A", "R"}, {"B", "R"}});
  EXPECT_THROW(table.add({1.0}), std::logic_error);
}

TEST_F(Tables, ColumnsThatDoNotFitAreRefused) {
  Table table = Table::of({{"A", "R"}, {"B", "R"}});
  table.columns[0].cells = {1.0};
  hdf5::write_whole(folder / "table.h5", [&](const hdf5::Group& root) { write_table(root, table); });
  EXPECT_THROW(read_table(hdf5::Reader(folder / "table.h5")), Error);
}

}  // namespace
