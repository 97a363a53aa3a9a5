// What another process needs to go on with the same bits.
#include "lacon/assembly/saddle_point_solver.hpp"
#include "lacon/structures/hdf5.hpp"

namespace lacon {

void SaddlePointSolver::save(const hdf5::Group& group) const {
  group.set("reference", reference_);
  group.set("factorisations", factorisations_);
  group.set("exact", std::int64_t{engine_->care() == Engine::Care::exact});
  group.set("pivots", std::int64_t{engine_->care() == Engine::Care::pivots});
  group.set("first_multiplier", first_multiplier_);
  group.set("expected_iterations", static_cast<std::int64_t>(expected_iterations_));
  std::vector<std::int64_t> rows;
  std::vector<double> scales;
  for (const auto& [row, scale] : multiplier_scale_) {
    rows.push_back(row);
    scales.push_back(scale);
  }
  group.write("scale/row", rows);
  group.write("scale/value", scales);
  std::vector<std::int64_t> first_row{0}, first_entry{0}, of_rows, offset;
  std::vector<std::uint8_t> on, bare;
  std::vector<std::int32_t> index;
  std::vector<double> value;
  for (const auto& [number, block] : blocks_) {
    of_rows.insert(of_rows.end(), block.rows.begin(), block.rows.end());
    on.insert(on.end(), block.on.begin(), block.on.end());
    for (const std::int64_t row : block.rows) {
      const auto column = columns_.find(row);
      bare.push_back(column != columns_.end() && column->second.block == number && column->second.is_bare());
    }
    offset.insert(offset.end(), block.offset.begin() + 1, block.offset.end());
    index.insert(index.end(), block.index.begin(), block.index.end());
    value.insert(value.end(), block.value.begin(), block.value.end());
    first_row.push_back(static_cast<std::int64_t>(of_rows.size()));
    first_entry.push_back(static_cast<std::int64_t>(index.size()));
  }
  group.write("columns/first_row", first_row);
  group.write("columns/first_entry", first_entry);
  group.write("columns/row", of_rows);
  group.write("columns/on", on);
  group.write("columns/bare", bare);
  group.write("columns/offset", offset);
  group.write("columns/index", index);
  group.write("columns/value", value);
}

void SaddlePointSolver::save_base(const hdf5::Group& group) const {
  group.set("symmetric", std::int64_t{base_->is_symmetric()});
  group.write("offset", base_->neighbours().offset);
  group.write("neighbours", base_->neighbours().values);
  group.write("values", base_->values());
}

void SaddlePointSolver::resume(const hdf5::Group& group, const hdf5::Group* base, const Numbering& numbering) {
  reference_ = group.real("reference");
  factorisations_ = group.integer("factorisations");
  if (group.integer("exact"))
    engine_->take(Engine::Care::exact);
  else if (group.integer("pivots"))
    engine_->take(Engine::Care::pivots);
  expected_iterations_ = static_cast<int>(group.integer("expected_iterations"));
  const auto rows = group.read<std::int64_t>("scale/row");
  const auto scales = group.read<double>("scale/value");
  for (std::size_t i = 0; i < rows.size(); ++i) multiplier_scale_[rows[i]] = scales.at(i);
  if (!base) return;
  base_.emplace(Ragged<std::int32_t>{base->read<std::int64_t>("offset"), base->read<std::int32_t>("neighbours")}, numbering,
                base->integer("symmetric") ? Symmetry::symmetric : Symmetry::general);
  base_->restore(base->read<double>("values"));
  engine_->analyse(*base_);
  factor_ = engine_->factorise(*base_);
  kept_ = Kept::factor;
  first_multiplier_ = group.integer("first_multiplier");
  const auto first_row = group.read<std::int64_t>("columns/first_row"),
             first_entry = group.read<std::int64_t>("columns/first_entry");
  const auto of_rows = group.read<std::int64_t>("columns/row"), offset = group.read<std::int64_t>("columns/offset");
  const auto on = group.read<std::uint8_t>("columns/on"), bare = group.read<std::uint8_t>("columns/bare");
  const auto index = group.read<std::int32_t>("columns/index");
  const auto value = group.read<double>("columns/value");
  for (std::size_t b = 0; b + 1 < first_row.size(); ++b) {
    SparseSides block;
    block.rows.assign(of_rows.begin() + first_row[b], of_rows.begin() + first_row[b + 1]);
    block.on.assign(on.begin() + first_row[b], on.begin() + first_row[b + 1]);
    block.offset.insert(block.offset.end(), offset.begin() + first_row[b], offset.begin() + first_row[b + 1]);
    block.index.assign(index.begin() + first_entry[b], index.begin() + first_entry[b + 1]);
    block.value.assign(value.begin() + first_entry[b], value.begin() + first_entry[b + 1]);
    compute(std::move(block));
    for (std::int64_t r = first_row[b]; r < first_row[b + 1]; ++r)
      if (bare.at(static_cast<std::size_t>(r))) make_bare(columns_.at(of_rows[static_cast<std::size_t>(r)]));
  }
}

}  // namespace lacon
