#include "lacon/operators/program/terminal.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdlib>
#include <iostream>
#include <streambuf>
#include <string_view>

namespace lacon {
namespace {

int terminal = -1;  // the file of the terminal
bool shown = false;

void put(std::string_view text) {
  while (!text.empty()) {
    const ssize_t n = write(terminal, text.data(), text.size());
    if (n <= 0) return;  // the terminal is gone: the computation goes on
    text.remove_prefix(static_cast<std::size_t>(n));
  }
}

/// The first `columns` characters of UTF-8.
std::string_view first_columns(std::string_view text, std::size_t columns) {
  std::size_t end = 0;
  for (; end < text.size(); ++end)
    if ((text[end] & 0xC0) != 0x80 && columns-- == 0) break;
  return text.substr(0, end);
}

/// Standard output, which shares the terminal with the line.
class Beside : public std::streambuf {
 public:
  explicit Beside(std::streambuf* under) : under_(under) {}

 protected:
  int overflow(int c) override {
    hide_terminal_line();
    return c == traits_type::eof() ? c : under_->sputc(static_cast<char>(c));
  }
  std::streamsize xsputn(const char* text, std::streamsize n) override {
    hide_terminal_line();
    return under_->sputn(text, n);
  }
  int sync() override { return under_->pubsync(); }

 private:
  std::streambuf* under_;
};

}  // namespace

void set_up_terminal_line() {
  const char* const number = std::getenv("LACON_TERMINAL");
  if (!number || !isatty(std::atoi(number))) return;
  terminal = std::atoi(number);
  static auto* const beside = new Beside(std::cout.rdbuf());  // std::cout is flushed after everything static has gone
  std::cout.rdbuf(beside);
}

bool has_terminal_line() { return terminal >= 0; }

void show_terminal_line(const std::string& text) {
  if (!has_terminal_line()) return;
  std::cout.flush();
  winsize size{};
  const std::size_t columns = ioctl(terminal, TIOCGWINSZ, &size) == 0 && size.ws_col > 1 ? size.ws_col - 1 : 79;
  put("\r\033[K" + std::string(first_columns(text, columns)));
  shown = true;
}

void hide_terminal_line() {
  if (shown) put("\r\033[K");
  shown = false;
}

}  // namespace lacon
