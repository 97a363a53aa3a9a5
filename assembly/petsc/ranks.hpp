#pragma once
// The processes of PETSc as the operator sees them: started, asked line by line, ended with it.
#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace lacon {

class Ranks {
 public:
  /// Start a program with its arguments. It says "ready" when it is.
  explicit Ranks(std::vector<std::string> command);
  /// Ends them.
  ~Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  /// Say a line and wait for the answer. @return it; empty where they have ended
  std::string ask(const std::string& line);
  /// The next line of theirs, behind that answer, or the first one: that they are ready. @return likewise
  std::string answer();
  /// How they have ended, in words: after an empty answer.
  std::string end();

 private:
  pid_t process_ = -1;
  int to_ = -1, from_ = -1;
  std::string heard_;
  std::string ended_;
};

}  // namespace lacon
