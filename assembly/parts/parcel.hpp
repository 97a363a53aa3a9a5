#pragma once
// Numbers, texts and arrays of them one behind the other, as one process hands them to another.
#include <cstddef>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace lacon {

/// What parcel(box) packs or unpacks in the order in which it names things.
class Packing {
 public:
  template <class T>
  Packing& operator()(T& value) {
    if constexpr (requires { value.size(); }) {
      std::size_t size = value.size();
      (*this)(size);
      if constexpr (std::is_trivially_copyable_v<typename T::value_type>)
        append(value.data(), size * sizeof(typename T::value_type));
      else
        for (auto& item : value) (*this)(item);
    } else if constexpr (requires { value.parcel(*this); }) {
      value.parcel(*this);
    } else {
      append(&value, sizeof value);
    }
    return *this;
  }
  std::span<const std::byte> bytes() const { return bytes_; }

 private:
  void append(const void* from, std::size_t size) {
    const auto* const first = static_cast<const std::byte*>(from);
    bytes_.insert(bytes_.end(), first, first + size);
  }
  std::vector<std::byte> bytes_;
};

class Unpacking {
 public:
  explicit Unpacking(const std::byte* from) : next_(from) {}
  template <class T>
  Unpacking& operator()(T& value) {
    if constexpr (requires { value.size(); }) {
      std::size_t size = 0;
      (*this)(size);
      value.resize(size);
      if constexpr (std::is_trivially_copyable_v<typename T::value_type>)
        take(value.data(), size * sizeof(typename T::value_type));
      else
        for (auto& item : value) (*this)(item);
    } else if constexpr (requires { value.parcel(*this); }) {
      value.parcel(*this);
    } else {
      take(&value, sizeof value);
    }
    return *this;
  }

 private:
  void take(void* to, std::size_t size) {
    if (size > 0) std::memcpy(to, next_, size);
    next_ += size;
  }
  const std::byte* next_;
};

}  // namespace lacon
