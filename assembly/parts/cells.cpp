#include "lacon/assembly/parts/cells.hpp"

#include <sstream>
#include <utility>

#include "lacon/assembly/parts/parcel.hpp"

namespace lacon {

bool Cells::obey(const std::string& line) {
  std::istringstream said(line);
  std::string verb, path;
  std::int64_t number = 0, other = 0;
  int kind = 0;
  said >> verb;
  if (verb == "board") {
    said >> path;
    memory_.emplace(SharedMemory::open(path));
    board_ = Board::in(*memory_, n_ranks_);
  } else if (verb == "part") {
    said >> kind >> path;
    if (kind != rank_) return true;
    PartCells cells;
    {
      const SharedMemory memory = SharedMemory::open(path);
      Unpacking unpack(memory.data());
      unpack(cells);
    }
    part_.emplace(std::move(cells));
  } else if (verb == "evaluate") {
    said >> kind >> number >> other;
    part_->evaluate(board_, board_.report[static_cast<std::size_t>(rank_)], static_cast<SolidMatrix>(kind), number, other);
  } else if (verb == "keep") {
    said >> number;
    part_->keep(number);
  } else if (verb == "natural") {
    said >> number;
    part_->keep_natural(number);
  } else if (verb == "rest") {
    said >> number >> other;
    part_->keep_at_rest(number, other);
  } else if (verb == "drop") {
    while (said >> number) part_->drop(number);
  } else if (verb == "put" || verb == "collect") {
    exchange(verb == "put", said);
  } else if (verb == "flows") {
    said >> number;
    board_.report[static_cast<std::size_t>(rank_)].flows = part_->flows(number);
  } else if (verb == "multiply") {
    said >> kind;
    part_->multiply(board_, kind != 0);
  } else if (verb == "products") {
    said >> kind >> path;
    const SharedMemory memory = SharedMemory::open(path);
    const std::span<double> both{reinterpret_cast<double*>(memory.data()), memory.size() / sizeof(double)};
    part_->multiply(both.first(both.size() / 2), both.subspan(both.size() / 2), kind);
  } else if (verb == "measure") {
    part_->measure(board_);
  } else if (verb == "diagonal") {
    part_->write_diagonal(board_);
  } else if (verb == "maxima") {
    part_->write_maxima(board_);
  } else if (verb == "remember") {
    part_->remember();
  } else if (verb == "change") {
    board_.report[static_cast<std::size_t>(rank_)].change = part_->change();
  } else if (verb == "whole") {
    said >> path;
    add_to(path);
  } else {
    return false;
  }
  return true;
}

void Cells::exchange(bool put, std::istream& said) {
  std::int64_t number = 0;
  std::size_t set = 0;
  int quantity = 0;
  std::string path;
  said >> number >> set >> quantity >> path;
  const SharedMemory memory = SharedMemory::open(path);
  const std::span<double> all{reinterpret_cast<double*>(memory.data()), memory.size() / sizeof(double)};
  if (put)
    part_->read(number, set, static_cast<PointQuantity>(quantity), all);
  else
    part_->write(number, set, static_cast<PointQuantity>(quantity), all);
}

void Cells::add_to(const std::string& path) const {
  const SharedMemory memory = SharedMemory::open(path);
  std::size_t n_rows = 0, n_entries = 0;
  Unpacking unpack(memory.data());
  unpack(n_rows)(n_entries);
  const auto* const rows = reinterpret_cast<const std::int64_t*>(memory.data() + 2 * sizeof(std::size_t));
  auto* const values = reinterpret_cast<double*>(memory.data() + (2 + n_rows) * 8);
  const auto* const columns = reinterpret_cast<const std::int32_t*>(values + n_entries);
  part_->add_to({rows, n_rows}, {columns, n_entries}, {values, n_entries});
}

}  // namespace lacon
