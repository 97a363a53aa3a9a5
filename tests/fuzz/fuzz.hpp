#pragma once
// What the targets of fuzzing share. A target takes any bytes; it ends the process (broken(), a signal, a sanitizer, an
// exception that gets out) where a promise does not hold.
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "lacon/catalog/messages.hpp"

namespace lacon::fuzz {

using Bytes = std::span<const std::uint8_t>;

// files: whatever is in them, a reader returns or throws lacon::Error
void med(Bytes input);       ///< HDF5 as text (h5_text.hpp), read as a MED file
void msh(Bytes input);       ///< a file of gmsh
void order(Bytes input);     ///< a JSON order, and its keywords
void plugin(Bytes input);    ///< a plugin.toml
void concepts(Bytes input);  ///< HDF5 as text, read as the concept that it says it is
// numbers: the result is that of an oracle
void clipping(Bytes input);  ///< polygons of the plane against sums over their vertices
void pairing(Bytes input);   ///< skins of the plane and of space against rays and the search of every couple
void cuts(Bytes input);      ///< DECOUPE_LAC against volume and conformity

struct Target {
  std::string_view name;
  void (*run)(Bytes);
};
inline constexpr Target targets[] = {{"med", med},           {"msh", msh},           {"order", order},     {"plugin", plugin},
                                     {"concepts", concepts}, {"clipping", clipping}, {"pairing", pairing}, {"cuts", cuts}};

/// The target of this name, or nullptr.
const Target* find_target(std::string_view name);

/// End the process: a promise does not hold.
[[noreturn]] void broken(const std::string& what);
inline void expect(bool holds, const char* what) {
  if (!holds) broken(what);
}

/// Do what may be refused, by an Error alone.
template <class Work>
void may_refuse(const Work& work) {
  try {
    work();
  } catch (const Error&) {
  }
}

inline std::string_view text_of(Bytes input) { return {reinterpret_cast<const char*>(input.data()), input.size()}; }

/// A file that is there as long as this lives, in memory where the system has a folder for that. One at a time.
class TemporaryFile {
 public:
  explicit TemporaryFile(std::string_view content);
  ~TemporaryFile();
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Small numbers out of bytes; behind their end zeros.
class Choices {
 public:
  explicit Choices(Bytes bytes) : bytes_(bytes) {}

  bool exhausted() const { return at_ >= bytes_.size(); }
  int byte() { return at_ < bytes_.size() ? bytes_[at_++] : 0; }
  int below(int n) { return byte() % n; }
  int between(int least, int most) { return least + below(most - least + 1); }
  unsigned word() { return static_cast<unsigned>(byte()) << 8 | static_cast<unsigned>(byte()); }

 private:
  Bytes bytes_;
  std::size_t at_ = 0;
};

}  // namespace lacon::fuzz
