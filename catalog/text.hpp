#pragma once
// Text from outside in the one encoding that everything here speaks.
#include <string>
#include <string_view>

namespace lacon {

bool is_utf8(std::string_view text);

/// `text` as UTF-8: what it is already stays, any other bytes are taken for Latin-1 (ISO 8859-1), one character each.
std::string as_utf8(std::string_view text);

}  // namespace lacon
