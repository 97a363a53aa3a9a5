#include "lacon/assembly/loose_motions.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lacon {
namespace {

constexpr double takes_part = 1e-6;                         // of a motion: a body that it moves
constexpr double resists = 1e-2 * LooseMotions::round_off;  // of what the entries of a row sum up to

/// Rows of a matrix of few columns as its triangle, which has the same null space.
class Triangle {
 public:
  explicit Triangle(Eigen::Index columns) : rows_(0, columns), pending_(4 * columns + 64, columns) {}
  void add(const Eigen::VectorXd& row) {
    pending_.row(count_++) = row.transpose();
    if (count_ == pending_.rows()) reduce();
  }
  /// (n_columns, n): combinations of columns that vanish.
  Eigen::MatrixXd null_space(double negligible) {
    reduce();
    if (rows_.rows() == 0) return Eigen::MatrixXd::Identity(rows_.cols(), rows_.cols());
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(rows_, Eigen::ComputeFullV);
    Eigen::Index rank = 0;
    while (rank < svd.singularValues().size() &&
           svd.singularValues()[rank] > negligible * std::max(1.0, svd.singularValues()[0]))
      ++rank;
    return svd.matrixV().rightCols(rows_.cols() - rank);
  }

 private:
  void reduce() {
    Eigen::MatrixXd all(rows_.rows() + count_, rows_.cols());
    all.topRows(rows_.rows()) = rows_;
    all.bottomRows(count_) = pending_.topRows(count_);
    count_ = 0;
    const Eigen::Index rank = std::min(all.rows(), all.cols());
    if (rank == 0) return;
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(all);
    rows_ = qr.matrixQR().topRows(rank).triangularView<Eigen::Upper>();
  }
  Eigen::MatrixXd rows_, pending_;
  Eigen::Index count_ = 0;
};

}  // namespace

/// What a row makes of the motions: of those of one body for nearly all, which meet no other one.
struct LooseMotions::Image {
  double most = 0;  ///< what its entries sum up to
  std::int32_t first = -1;
  MotionVector own = MotionVector::Zero();
  std::map<std::int32_t, MotionVector> others;

  MotionVector& of_body(std::int32_t its_first) {
    if (first < 0) first = its_first;
    return first == its_first ? own : others.try_emplace(its_first, MotionVector::Zero()).first->second;
  }
};

/// Those of the rows that meet what moves.
class LooseMotions::Images {
 public:
  explicit Images(std::int64_t n_rows) : at_(static_cast<std::size_t>(n_rows), -1) {}
  Image& of_row(std::int64_t row) {
    if (at_[row] < 0) {
      at_[row] = static_cast<std::int32_t>(images_.size());
      images_.emplace_back();
    }
    return images_[at_[row]];
  }
  const Image* find(std::size_t row) const { return at_[row] < 0 ? nullptr : &images_[at_[row]]; }

 private:
  std::vector<std::int32_t> at_;
  std::vector<Image> images_;
};

template <class Takes, class Use>
void LooseMotions::for_each_row(const Takes& takes, const Use& use) const {
  for (std::int64_t dof = 0; dof < std::ssize(numbering_.equation); ++dof) {
    if (!takes(dof)) continue;
    if (const auto row = motions_.row(dof / numbering_.n_components, static_cast<int>(dof % numbering_.n_components)))
      use(dof, *row);
  }
}

LooseMotions::LooseMotions(RigidMotions motions, const Numbering& numbering)
    : motions_(std::move(motions)), numbering_(numbering) {
  std::map<std::int32_t, Eigen::Matrix<double, 6, 6>> held;
  for (const std::int32_t body : motions_.bodies()) held[body].setZero();
  for_each_row([&](std::int64_t dof) { return numbering.equation[dof] < 0; },
               [&](std::int64_t /*dof*/, const RigidMotions::Row& row) { held[row.body] += row.by * row.by.transpose(); });
  for (const auto& [body, gram] : held) {
    const Eigen::Matrix<double, 6, Eigen::Dynamic> free = motions_.free_of(gram);
    if (free.cols() == 0) continue;
    left_[body] = {static_cast<std::int32_t>(bodies_.size()), free};
    bodies_.insert(bodies_.end(), static_cast<std::size_t>(free.cols()), body);
  }
}

template <class Takes, class Use>
void LooseMotions::for_each_moved(const Takes& takes, const Use& use) const {
  for_each_row(
      [&](std::int64_t dof) {
        const std::int64_t equation = numbering_.equation[dof];
        return equation >= 0 && takes(equation);
      },
      [&](std::int64_t dof, const RigidMotions::Row& row) {
        const auto own = left_.find(row.body);
        if (own == left_.end()) return;
        const Left& left = own->second;
        const auto count = static_cast<std::int32_t>(left.motions.cols());
        Moved moved{dof, numbering_.equation[dof], left.first, count, MotionVector::Zero()};
        moved.by.head(count) = left.motions.transpose() * row.by;
        use(moved);
      });
}

template <class Takes>
std::vector<LooseMotions::Moved> LooseMotions::moved(const Takes& takes) const {
  std::vector<Moved> moved;
  for_each_moved(takes, [&](const Moved& found) { moved.push_back(found); });
  return moved;
}

const MotionVector* LooseMotions::Others::resistance_of(std::int64_t equation) const {
  const auto found = std::ranges::lower_bound(resisting, equation);
  return found != resisting.end() && *found == equation ? &resistance[found - resisting.begin()] : nullptr;
}

LooseMotions::Others LooseMotions::asked(const RowsElsewhere& rows, std::int64_t n_equations) const {
  Others others{&rows, rows.version(), std::vector<double>(n_equations, 0.0), {}, {}};
  Eigen::Index most = 0;
  for (const auto& [body, left] : left_) most = std::max(most, left.motions.cols());
  // one motion of each body at once, for no cell meets two of them; and magnitudes
  const std::int64_t width = most + 1;
  const auto fill = [&](std::span<double> x) {
    for_each_moved([](std::int64_t) { return true; },
                   [&](const Moved& moved) {
                     double* const own = x.data() + moved.dof * width;
                     std::copy_n(moved.by.data(), moved.count, own);
                     own[most] = moved.by.cwiseAbs().sum();
                   });
  };
  const auto use = [&](std::span<const double> products) {
    for (std::int64_t dof = 0; dof < std::ssize(numbering_.equation); ++dof) {
      const std::int64_t equation = numbering_.equation[dof];
      const double* const own = products.data() + dof * width;
      if (equation < 0 || own[most] == 0) continue;
      others.most[equation] = own[most];
      const Eigen::Map<const Eigen::VectorXd> image(own, most);
      if (most == 0 || image.cwiseAbs().maxCoeff() <= resists * own[most]) continue;
      others.resisting.push_back(equation);
      others.resistance.emplace_back(MotionVector::Zero()).head(most) = image;
    }
  };
  rows.products(static_cast<int>(width), fill, use);
  return others;
}

/// What the rows of a matrix make of the motions, each over what its entries sum up to.
class LooseMotions::Resistance {
 public:
  Resistance(std::span<const std::int32_t> bodies, double negligible)
      : bodies_(bodies), negligible_(negligible), rows_(std::ssize(bodies)) {}
  void enter(const Image& image) {
    if (image.most == 0) return;
    if (image.others.empty() && image.own.cwiseAbs().maxCoeff() <= negligible_ * image.most) return;  // most rows
    Eigen::VectorXd row = Eigen::VectorXd::Zero(std::ssize(bodies_));
    const auto put = [&](std::int32_t first, const MotionVector& values) {
      for (std::int32_t i = 0; i < 6 && first + i < std::ssize(bodies_) && bodies_[first + i] == bodies_[first]; ++i)
        row[first + i] = values[i] / image.most;
    };
    put(image.first, image.own);
    for (const auto& [first, values] : image.others) put(first, values);
    if (row.cwiseAbs().maxCoeff() > negligible_) rows_.add(row);
  }
  Eigen::MatrixXd null_space() { return rows_.null_space(negligible_); }

 private:
  std::span<const std::int32_t> bodies_;
  double negligible_;
  Triangle rows_;
};

namespace {

/// Vertices whose rows meet what belongs to several bodies, or to none: contact and relations. @param first of each vertex the
/// first motion of its body, -1: nothing moves it
std::vector<std::uint8_t> between_bodies(const SparseMatrix& matrix, std::span<const std::int32_t> first) {
  const Numbering& numbering = matrix.numbering();
  std::vector<std::uint8_t> between(first.size(), 0);
  for (std::size_t v = 0; v < first.size(); ++v)
    between[v] = static_cast<std::int64_t>(v) >= numbering.n_nodes || !matrix.is_symmetric() || matrix.elsewhere() ||
                 std::ranges::any_of(matrix.neighbours()[v], [&](std::int32_t w) {
                   return first[w] != first[v] && numbering.first[w + 1] > numbering.first[w];
                 });
  return between;
}

}  // namespace

void LooseMotions::multiply(const SparseMatrix& matrix, std::span<const Moved> all, std::span<const std::int32_t> first_motion,
                            std::span<const std::int32_t> at, Images& images) const {
  const std::vector<std::uint8_t> between = between_bodies(matrix, first_motion);
  // rows within a body: one motion of each body at once, and magnitudes
  Eigen::Index most = 0;
  for (const auto& [body, left] : left_) most = std::max(most, left.motions.cols());
  const auto width = static_cast<std::size_t>(most + 1);
  const std::vector<std::int64_t>& first = matrix.numbering().first;
  if (std::ranges::find(between, 0) != between.end()) {
    std::vector<double> x(width * static_cast<std::size_t>(matrix.size())), y(x.size());
    for (const Moved& moved : all) {
      double* const own = &x[width * static_cast<std::size_t>(moved.equation)];
      std::copy_n(moved.by.data(), moved.count, own);
      own[most] = moved.moves().cwiseAbs().sum();
    }
    matrix.multiply_together(x, y, static_cast<int>(width));
    for (std::size_t v = 0; v < between.size(); ++v)
      for (std::int64_t row = first[v]; row < first[v + 1] && !between[v]; ++row) {
        if (first_motion[v] < 0) continue;
        const double* const own = &y[width * static_cast<std::size_t>(row)];
        Image& image = images.of_row(row);
        image.of_body(first_motion[v]).head(most) = Eigen::Map<const Eigen::VectorXd>(own, most);
        image.most = own[most];
      }
  }

  const auto add = [&](std::int64_t row, std::int64_t column, double value) {
    if (at[column] < 0 || value == 0) return;
    const Moved& moved = all[at[column]];
    Image& image = images.of_row(row);
    image.of_body(moved.first).head(moved.count) += value * moved.moves();
    image.most += std::abs(value) * moved.moves().cwiseAbs().sum();
  };
  std::vector<std::uint8_t> is_between(static_cast<std::size_t>(matrix.size()));  // of equations
  for (std::size_t v = 0; v < between.size(); ++v)
    std::fill(is_between.begin() + first[v], is_between.begin() + first[v + 1], between[v]);
  for (std::size_t v = 0; v < between.size(); ++v) {
    if (!between[v] && std::ranges::none_of(matrix.neighbours()[v], [&](std::int32_t w) { return between[w]; })) continue;
    for (std::int64_t row = first[v]; row < first[v + 1]; ++row)
      for (std::int64_t k = matrix.rows()[row]; k < matrix.rows()[row + 1]; ++k) {
        const std::int64_t column = matrix.columns()[k];
        if (between[v]) add(row, column, matrix.values()[k]);
        if (matrix.is_symmetric() && column != row && is_between[column]) add(column, row, matrix.values()[k]);
      }
  }
}

Eigen::MatrixXd LooseMotions::unresisted(const SparseMatrix& matrix, double negligible) {
  const RowsElsewhere* const elsewhere = matrix.elsewhere();
  if (elsewhere && !(others_ && others_->rows == elsewhere && others_->version == elsewhere->version()))
    others_ = asked(*elsewhere, matrix.size());

  // rows that entries are here of, and those of others that resist; all others map motions to nothing
  std::vector<std::uint8_t> matters(static_cast<std::size_t>(matrix.size()), elsewhere ? 0 : 1);
  if (elsewhere) {
    for (std::int64_t row = 0; row < matrix.size(); ++row)
      for (std::int64_t k = matrix.rows()[row]; k < matrix.rows()[row + 1]; ++k)
        if (matrix.values()[k] != 0) matters[row] = matters[matrix.columns()[k]] = 1;
    for (const std::int64_t equation : others_->resisting) matters[equation] = 1;
  }
  const std::vector<Moved> all = moved([&](std::int64_t equation) { return matters[equation] != 0; });
  std::vector<std::int32_t> at(static_cast<std::size_t>(matrix.size()), -1);  // of an equation: its place in `all`
  std::vector<std::int32_t> first(static_cast<std::size_t>(matrix.numbering().n_vertices()), -1);
  for (std::size_t i = 0; i < all.size(); ++i) {
    at[all[i].equation] = static_cast<std::int32_t>(i);
    first[all[i].dof / matrix.numbering().n_components] = all[i].first;
  }
  Images images(matrix.size());
  multiply(matrix, all, first, at, images);

  Resistance resistance(bodies_, negligible);
  for (std::int64_t row = 0; row < matrix.size(); ++row) {
    if (!matters[row]) continue;
    const Image* const image = images.find(row);
    if (!elsewhere || at[row] < 0) {
      if (image) resistance.enter(*image);
      continue;
    }
    Image whole = image ? *image : Image();
    // of a row that nothing moves, too: on even meshes its entries cancel exactly
    MotionVector& own = whole.of_body(all[at[row]].first);
    if (const MotionVector* const of_others = others_->resistance_of(row)) own += *of_others;
    whole.most += others_->most[row];
    resistance.enter(whole);
  }
  // where stresses turn with bodies, all rows resist, and are others after each evaluation
  if (others_ && 4 * std::ssize(others_->resisting) > matrix.size()) others_.reset();
  return resistance.null_space();
}

std::vector<LooseMotion> LooseMotions::told_apart(Eigen::MatrixXd motions, const std::vector<Moved>& all) const {
  std::vector<LooseMotion> loose;
  for (Eigen::Index motion = 0; motion < motions.cols(); ++motion) {
    LooseMotion found{-1, {}};
    for (Eigen::Index i = 0; i < motions.rows(); ++i)
      if (std::abs(motions(i, motion)) > takes_part) found.bodies.insert(bodies_[static_cast<std::size_t>(i)]);
    const auto moves = [&](const Moved& moved, Eigen::Index which) {
      return moved.moves().dot(motions.col(which).segment(moved.first, moved.count));
    };
    const Moved* largest = &all.front();
    double size = 0;
    for (const Moved& moved : all)
      if (const double now = std::abs(moves(moved, motion)); now > (1 + takes_part) * size) largest = &moved, size = now;
    found.dof = largest->dof;
    // the others do not move it
    for (Eigen::Index other = motion + 1; other < motions.cols(); ++other)
      motions.col(other) -= moves(*largest, other) / moves(*largest, motion) * motions.col(motion);
    loose.push_back(found);
  }
  return loose;
}

std::vector<LooseMotion> LooseMotions::of(const SparseMatrix& matrix, double negligible) {
  found_.resize(0, 0);
  if (left_.empty()) return {};
  Eigen::MatrixXd motions = unresisted(matrix, negligible);
  if (motions.cols() == 0) return {};
  const std::vector<Moved> all = moved([](std::int64_t) { return true; });
  if (all.empty()) return {};
  found_ = motions;
  return told_apart(std::move(motions), all);
}

Eigen::VectorXd LooseMotions::by(std::int64_t dof) const {
  const auto row = motions_.row(dof / numbering_.n_components, static_cast<int>(dof % numbering_.n_components));
  const auto own = row && found_.cols() > 0 && numbering_.equation[dof] >= 0 ? left_.find(row->body) : left_.end();
  if (own == left_.end()) return Eigen::VectorXd::Zero(found_.cols());
  const Eigen::VectorXd moves = own->second.motions.transpose() * row->by;
  return found_.middleRows(own->second.first, moves.size()).transpose() * moves;
}

Eigen::VectorXd LooseMotions::work(std::span<const double> side) const {
  if (found_.cols() == 0) return {};
  Eigen::VectorXd of_motions = Eigen::VectorXd::Zero(found_.rows());
  for_each_moved([](std::int64_t) { return true; },
                 [&](const Moved& moved) {
                   for (std::int32_t i = 0; i < moved.count; ++i)
                     of_motions[moved.first + i] += side[moved.equation] * moved.by[i];
                 });
  return found_.transpose() * of_motions;
}

}  // namespace lacon
