#include "lacon/assembly/parts/cells.hpp"

#include <memory>
#include <set>
#include <span>
#include <sstream>
#include <utility>
#include <vector>

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
    loan_ = lender_.borrow(path, LoanUse::write);
    board_ = Board::in(loan_->memory(), n_ranks_);
  } else if (verb == "parts") {
    take_part(said);
  } else if (verb == "keep") {
    said >> number;
    part_->keep(number);
  } else if (verb == "natural") {
    said >> number;
    part_->keep_natural(number);
  } else if (verb == "copy") {
    said >> number >> other;
    part_->keep_copy(number, other);
  } else if (verb == "strain") {
    said >> number;
    part_->strain_as(number);
  } else if (verb == "rest") {
    said >> number >> other;
    part_->keep_at_rest(number, other);
  } else if (verb == "drop") {
    while (said >> number) part_->drop(number);
  } else if (verb == "put" || verb == "collect") {
    exchange(verb == "put", said);
  } else if (verb == "products") {
    said >> kind >> path;
    const auto loan = lender_.borrow(path, LoanUse::write);
    const std::span<double> both = loan->memory().numbers();
    part_->multiply(both.first(both.size() / 2), both.subspan(both.size() / 2), kind);
    loan->give_back();
  } else if (verb == "remember") {
    part_->remember();
  } else if (verb == "whole") {
    said >> path;
    add_to(path);
  } else {
    return obey_by_board(verb, said);
  }
  return true;
}

void Cells::take_part(std::istream& said) {
  int reader = 0;
  std::string path;
  std::unique_ptr<Loan> own;
  for (said >> reader; said >> path; ++reader)
    if (auto loan = lender_.borrow(path, LoanUse::read, reader); reader == rank_) own = std::move(loan);
  if (!own) return;
  PartCells cells;
  Unpacking unpack(own->memory().data());
  unpack(cells);
  own.reset();
  part_.emplace(std::move(cells));
}

bool Cells::obey_by_board(const std::string& verb, std::istream& said) {
  static const std::set<std::string> known{"evaluate", "flows", "multiply", "measure", "diagonal", "maxima", "change"};
  if (!known.contains(verb)) return false;
  PartReport& report = board_.report[static_cast<std::size_t>(rank_)];
  std::int64_t number = 0, other = 0;
  int kind = 0;
  loan_->renew();
  if (verb == "evaluate") {
    said >> kind >> number >> other;
    part_->evaluate(board_, report, static_cast<SolidMatrix>(kind), number, other);
  } else if (verb == "flows") {
    said >> number;
    report.flows = part_->flows(number);
  } else if (verb == "multiply") {
    said >> kind;
    part_->multiply(board_, kind != 0);
  } else if (verb == "measure") {
    part_->measure(board_);
  } else if (verb == "diagonal") {
    part_->write_diagonal(board_);
  } else if (verb == "maxima") {
    part_->write_maxima(board_);
  } else {
    report.change = part_->change();
  }
  loan_->give_back();
  return true;
}

void Cells::exchange(bool put, std::istream& said) {
  std::int64_t number = 0;
  int kind = 0;
  std::string path;
  said >> number >> kind >> path;
  std::vector<CellRange> cells;
  for (CellRange some; said >> some.first >> some.count;) cells.push_back(some);
  const auto quantity = static_cast<PointQuantity>(kind);
  const auto loan = lender_.borrow(path, put ? LoanUse::read : LoanUse::write);
  if (put) return part_->read(number, quantity, cells, loan->memory().numbers());
  part_->write(number, quantity, cells, loan->memory().numbers());
  loan->give_back();
}

void Cells::add_to(const std::string& path) const {
  const auto loan = lender_.borrow(path, LoanUse::write);
  const SharedMemory& memory = loan->memory();
  std::size_t n_rows = 0, n_entries = 0;
  Unpacking unpack(memory.data());
  unpack(n_rows)(n_entries);
  const auto* const rows = reinterpret_cast<const std::int64_t*>(memory.data() + 2 * sizeof(std::size_t));
  auto* const values = reinterpret_cast<double*>(memory.data() + (2 + n_rows) * 8);
  const auto* const columns = reinterpret_cast<const std::int32_t*>(values + n_entries);
  part_->add_to({rows, n_rows}, {columns, n_entries}, {values, n_entries});
  loan->give_back();
}

}  // namespace lacon
