#pragma once
// A program that an operator starts, asks line by line, and ends: one process, or mpirun with several.
#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace lacon {

class Companion {
 public:
  /// Start a program with its arguments. It says "ready" when it is.
  explicit Companion(std::vector<std::string> command);
  /// Ends it.
  ~Companion();
  Companion(const Companion&) = delete;
  Companion& operator=(const Companion&) = delete;

  /// Say a line. @return whether somebody was there to hear it
  bool say(const std::string& line);
  /// The next line of its own that is not empty; the first one says that it is ready. @return it; empty where it has ended
  std::string answer();
  /// Say a line and wait for the answer. @return likewise
  std::string ask(const std::string& line) { return say(line) ? answer() : std::string(); }
  /// Whether it has not ended yet.
  bool is_running() const;
  /// End it at once, whatever it does.
  void kill();
  /// How it has ended, in words: after an empty answer.
  std::string end();
  /// Whether there was such a program (a shell's exit status 127 says that there was none): known after end().
  bool has_started() const { return started_; }
  /// Whether a signal has ended it, or a process that it stands for: known likewise.
  bool was_killed() const { return killed_; }

 private:
  void end_without_start();

  pid_t process_ = -1;
  int to_ = -1, from_ = -1;
  std::string heard_;
  std::string ended_;
  bool started_ = true, killed_ = false;
};

}  // namespace lacon
