#pragma once
// Vectors that many must be kept of, where few of their digits count.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lacon {

/// Half the memory of single precision: whole numbers of 16 bits, in a unit for each block. An entry is off by 1.6e-5 of the
/// largest one of its block at most. Entries must be finite.
class PackedVector {
 public:
  static constexpr std::size_t block = 128;
  /// Bytes of one of n entries.
  static constexpr std::size_t memory(std::size_t n) {
    return n * sizeof(std::int16_t) + (n + block - 1) / block * sizeof(float);
  }

  PackedVector() = default;
  explicit PackedVector(std::span<const float> values) : numbers_(values.size()) {
    for (std::size_t first = 0; first < values.size(); first += block) {
      const auto part = values.subspan(first, std::min(block, values.size() - first));
      double size = 0;
      for (const float value : part) size = std::max(size, std::abs(static_cast<double>(value)));
      const double unit = units_.emplace_back(static_cast<float>(size / most));
      if (unit == 0) continue;
      for (std::size_t i = 0; i < part.size(); ++i)
        numbers_[first + i] = static_cast<std::int16_t>(std::lround(static_cast<double>(part[i]) / unit));
    }
  }
  std::size_t size() const { return numbers_.size(); }
  bool empty() const { return numbers_.empty(); }

  /// Add a multiple of its entries from `first` on, which must be the first of a block, to as many.
  void add_to(std::span<float> x, std::size_t first, float factor) const {
    for (std::size_t done = 0; done < x.size(); done += block) {
      const float unit = factor * units_[(first + done) / block];
      const std::int16_t* const numbers = numbers_.data() + first + done;
      float* const to = x.data() + done;
      const std::size_t count = std::min(block, x.size() - done);
      for (std::size_t i = 0; i < count; ++i) to[i] += unit * static_cast<float>(numbers[i]);
    }
  }

 private:
  static constexpr double most = INT16_MAX;
  std::vector<std::int16_t> numbers_;
  std::vector<float> units_;  ///< of each block
};

}  // namespace lacon
