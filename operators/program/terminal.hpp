#pragma once
// The line at the foot of a terminal that says where a long computation is. The launcher hands over the terminal, as the number
// of a file in LACON_TERMINAL; without it there is none, and nothing is written.
#include <string>

namespace lacon {

/// From now on what is written to standard output takes the line away first. Nothing without terminal.
void set_up_terminal_line();
bool has_terminal_line();
/// Show this line instead of the one that is there, cut at the width of the terminal.
void show_terminal_line(const std::string& text);
/// Take it away; the next one that is shown stands again below what was written meanwhile.
void hide_terminal_line();

}  // namespace lacon
