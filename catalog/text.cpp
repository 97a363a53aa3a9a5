#include "lacon/catalog/text.hpp"

#include <cstdint>

namespace lacon {

bool is_utf8(std::string_view text) {
  static constexpr std::uint32_t least[] = {0, 0x80, 0x800, 0x10000};  // of a character that is followed by so many bytes
  for (std::size_t at = 0; at < text.size();) {
    const auto lead = static_cast<unsigned char>(text[at++]);
    const std::size_t follow = lead < 0x80 ? 0 : lead >> 5 == 6 ? 1 : lead >> 4 == 14 ? 2 : lead >> 3 == 30 ? 3 : 4;
    if (follow == 4 || follow > text.size() - at) return false;
    std::uint32_t code = follow == 0 ? lead : lead & (0x3fU >> follow);
    for (std::size_t k = 0; k < follow; ++k) {
      const auto next = static_cast<unsigned char>(text[at++]);
      if (next >> 6 != 2) return false;
      code = code << 6 | (next & 0x3fU);
    }
    if (code < least[follow] || code > 0x10ffff || (code >= 0xd800 && code < 0xe000)) return false;
  }
  return true;
}

std::string as_utf8(std::string_view text) {
  if (is_utf8(text)) return std::string(text);
  std::string converted;
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (code >= 0x80) converted += static_cast<char>(0xc0 | code >> 6);
    converted += static_cast<char>(code < 0x80 ? code : 0x80 | (code & 0x3f));
  }
  return converted;
}

}  // namespace lacon
