// lacon_mumps: a process that factorises subtrees for an operator, and may have cells of its own. The operator starts it, as
// one of some, and talks with it over standard input and output (exchange.hpp).
#include <malloc.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <map>
#include <new>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "lacon/assembly/mumps.hpp"
#include "lacon/assembly/parts/cells.hpp"
#include "lacon/assembly/processes/shared_memory.hpp"
#include "lacon/assembly/tree/exchange.hpp"
#include "lacon/assembly/tree/ordering_ahead.hpp"
#include "lacon/catalog/messages.hpp"
#include "lacon/structures/openblas.hpp"

namespace {

using lacon::SharedMemory, lacon::PieceSizes, lacon::Mumps;

std::string said_of(const std::vector<double>& numbers) {
  std::ostringstream line;
  line.precision(17);
  line << "done";
  for (const double number : numbers) line << ' ' << number;
  return line.str();
}

template <class Real>
class Piece {
 public:
  explicit Piece(SharedMemory pattern)
      : pattern_(std::move(pattern)),
        sizes_(lacon::PieceMemory::in(pattern_).sizes),
        mumps_({.symmetric = sizes_.is_symmetric != 0,
                .memory_margin = sizes_.memory_margin,
                .singular_pivot = sizes_.singular_pivot,
                .scaled = true,
                .low_rank = sizes_.low_rank,
                .as_ordered = sizes_.as_ordered != 0}) {}

  std::string analyse() {
    const lacon::PieceMemory piece = lacon::PieceMemory::in(pattern_);
    const lacon::MumpsForecast foreseen =
        mumps_.analyse({.row = piece.row, .column = piece.column, .place = piece.place, .border = piece.in_border});
    return said(foreseen.flops, foreseen.entries, foreseen.bytes);
  }
  std::string factorise(const SharedMemory& memory) {
    Real* const values = reinterpret_cast<Real*>(memory.data());
    const auto n = static_cast<std::size_t>(sizes_.entries), border = static_cast<std::size_t>(sizes_.border);
    const lacon::Factorisation found =
        mumps_.factorise(std::span<const Real>(values, n), std::span<Real>(values + n, border * border));
    std::string answer = said(found.flops, found.entries, found.whole_entries, found.negative_pivots.value_or(0));
    for (const std::int64_t equation : found.null_pivots) answer += ' ' + std::to_string(equation);
    return answer;
  }
  std::string reduce(const SharedMemory& memory) {
    const auto [sides, border] = parts(memory);
    if (sizes_.border)
      mumps_.reduce(sides, border);
    else
      mumps_.substitute(sides);
    return said();
  }
  std::string reduce(const SharedMemory& memory, const SharedMemory& sparse) {
    const auto [sides, border] = parts(memory);
    const auto& sizes = *reinterpret_cast<const lacon::SparseSideSizes*>(sparse.data());
    const auto count = static_cast<std::size_t>(sizes.count), entries = static_cast<std::size_t>(sizes.entries);
    const auto* const offset = reinterpret_cast<const std::int64_t*>(sparse.data() + sizeof sizes);
    const auto* const value = reinterpret_cast<const Real*>(offset + count + 1);
    const auto* const index = reinterpret_cast<const std::int32_t*>(value + entries);
    const std::span<const std::int64_t> offsets(offset, count + 1);
    if (sizes_.border)
      mumps_.reduce(offsets, {index, entries}, {value, entries}, sides, border);
    else
      mumps_.substitute(offsets, {index, entries}, {value, entries}, sides);
    return said();
  }
  std::string expand(const SharedMemory& memory) {
    const auto [sides, border] = parts(memory);
    if (sizes_.border) mumps_.expand(border, sides);
    return said();
  }

 private:
  std::pair<std::span<Real>, std::span<Real>> parts(const SharedMemory& memory) const {
    const auto size = static_cast<std::size_t>(sizes_.size), border = static_cast<std::size_t>(sizes_.border);
    const std::size_t count = memory.size() / sizeof(Real) / (size + border);
    Real* const first = reinterpret_cast<Real*>(memory.data());
    return {{first, count * size}, {first + count * size, count * border}};
  }
  static std::string said(auto... numbers) { return said_of({static_cast<double>(numbers)...}); }

  SharedMemory pattern_;
  PieceSizes sizes_;
  Mumps<Real> mumps_;
};

class Pieces {
 public:
  std::string answer(const std::string& verb, std::istream& said) {
    if (verb == "forget") {
      single_.clear();
      full_.clear();
      malloc_trim(0);  // what they had goes back to the system
      return "done";
    }
    std::string precision, path;
    int number = 0;
    if (verb == "open") {
      said >> path;
      SharedMemory::open(path);
      return "done";
    }
    if (verb == "factorise") reserve();
    if (verb == "order") {
      said >> path;
      return said_of(lacon::order_in(SharedMemory::open(path)));
    }
    said >> precision >> number >> path;
    SharedMemory memory = SharedMemory::open(path);
    std::optional<SharedMemory> more;
    if (said >> path) more.emplace(SharedMemory::open(path));
    return precision == "float" ? answer(single_, verb, number, std::move(memory), more)
                                : answer(full_, verb, number, std::move(memory), more);
  }

 private:
  template <class Real>
  static std::string answer(std::map<int, Piece<Real>>& pieces, const std::string& verb, int number, SharedMemory memory,
                            const std::optional<SharedMemory>& more) {
    if (verb == "analyse") {
      pieces.erase(number);
      return pieces.try_emplace(number, std::move(memory)).first->second.analyse();
    }
    Piece<Real>& piece = pieces.at(number);
    if (verb == "factorise") return piece.factorise(memory);
    if (verb == "expand") return piece.expand(memory);
    return more ? piece.reduce(memory, *more) : piece.reduce(memory);
  }

  /// What factors work in. Throws std::bad_alloc: the operator may do without this process.
  void reserve() {
    if (is_reserved_) return;
    lacon::reserve_blas_memory();
    is_reserved_ = true;
  }

  bool is_reserved_ = false;
  std::map<int, Piece<float>> single_;
  std::map<int, Piece<double>> full_;
};

template <class Real>
void fill(std::istream& said, const lacon::ElementPart& part) {
  std::string path;
  std::vector<SharedMemory> memory;
  while (said >> path) memory.push_back(SharedMemory::open(path));
  lacon::EntryPlaces<Real> places(lacon::EquationMap::in(memory.front()));
  for (std::size_t m = 1; m + 1 < memory.size(); m += 2)
    places.add_piece(lacon::PieceMemory::in(memory[m]), reinterpret_cast<Real*>(memory[m + 1].data()));
  part.for_each_own([&](std::int32_t row, std::int32_t column, double value) { places.add(row, column, value); });
}

/// @return nothing where a line is not about cells
std::optional<std::string> answer_about_cells(lacon::Cells& cells, const std::string& line) {
  try {
    if (line.starts_with("fill ")) {
      std::istringstream said(line.substr(line.find(' ')));
      std::string precision;
      said >> precision;
      precision == "float" ? fill<float>(said, *cells.part()) : fill<double>(said, *cells.part());
      return "done";
    }
    if (cells.obey(line)) return "done";
    return std::nullopt;
  } catch (const lacon::Error& error) {
    return "failed " + error.message().text;
  }
}

}  // namespace

int main(int argc, char** argv) {
  struct stat input;
  if (argc != 3 || fstat(STDIN_FILENO, &input) != 0 || !S_ISSOCK(input.st_mode)) {
    std::fputs("lacon_mumps is not for users: operators start it and talk with it over a socket. Run `lacon study.comm`\n",
               stderr);
    return 2;
  }
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  setenv("LACON_THREADS", "1", 1);  // processes are what works at the same time here
  const lacon::Lender lender;
  lacon::Cells cells(std::stoi(argv[1]), std::stoi(argv[2]), lender);
  Pieces pieces;
  std::cout << "ready" << std::endl;
  for (std::string line; std::getline(std::cin, line);) {
    std::istringstream said(line);
    std::string verb;
    said >> verb;
    try {
      const std::optional<std::string> answer = answer_about_cells(cells, line);
      std::cout << (answer ? *answer : pieces.answer(verb, said)) << std::endl;
    } catch (const lacon::Error& error) {
      if (error.message().id == "SOLVER_2")  // there are no files
        std::cout << "no memory" << std::endl;
      else
        std::cout << "failed " << error.message().text << std::endl;
    } catch (const std::bad_alloc&) {
      std::cout << "no memory" << std::endl;
    } catch (const std::exception& error) {
      std::cout << "failed " << error.what() << std::endl;
    }
  }
}
