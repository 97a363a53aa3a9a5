#include "lacon/assembly/processes/companion.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <initializer_list>
#include <system_error>
#include <thread>
#include <utility>

#include "lacon/assembly/processes/open_files.hpp"
#include "lacon/catalog/wording.hpp"

namespace lacon {
namespace {

constexpr int not_started = 127;
/// As shells and mpirun have it, the status of who stands for another is this and the signal that ended the other.
constexpr int by_signal = 128;
/// It ends by itself when nobody talks to it any more.
constexpr std::chrono::milliseconds patience{2000}, nap{2};

/// What this process has, and more.
class Environment {
 public:
  explicit Environment(std::initializer_list<const char*> more) {
    for (char** text = environ; *text; ++text) texts_.emplace_back(*text);
    for (const char* text : more) set(text);
  }
  /// @param text NAME=VALUE
  void set(std::string text) {
    const std::string name = text.substr(0, text.find('=') + 1);
    std::erase_if(texts_, [&](const std::string& t) { return t.starts_with(name); });
    texts_.push_back(std::move(text));
  }
  /// For exec, as long as nothing is set.
  char** words() {
    words_.clear();
    for (std::string& text : texts_) words_.push_back(text.data());
    words_.push_back(nullptr);
    return words_.data();
  }

 private:
  std::vector<std::string> texts_;
  std::vector<char*> words_;
};

/// A program with its standard streams. @return its process; negative: there can be no more
pid_t start(char* const* words, char* const* environment, int input, int output) {
  const pid_t process = vfork();  // fork() would copy the tables of all the memory that a large study has
  if (process == 0) {
    prctl(PR_SET_PDEATHSIG, SIGTERM);  // mpirun ends its ranks
    setpgid(0, 0);                     // Ctrl-C is for the operator, which ends it when it may
    dup2(input, STDIN_FILENO);
    dup2(output, STDOUT_FILENO);
    execvpe(words[0], words, environment);
    _exit(not_started);
  }
  return process;
}

}  // namespace

Companion::Companion(std::vector<std::string> command) {
  std::vector<char*> words;
  for (std::string& word : command) words.push_back(word.data());
  words.push_back(nullptr);
  int to[2], from[2];
  const auto refuse = [&](int error) {
    refuse_too_few_files(error);
    throw std::system_error(error, std::generic_category(), command.front());
  };
  if (pipe2(from, O_CLOEXEC)) refuse(errno);
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, to)) {
    const int error = errno;
    for (const int end : from) close(end);
    refuse(error);
  }
  Environment environment({"OPENBLAS_NUM_THREADS=1", "OMP_NUM_THREADS=1"});
  if (geteuid() == 0) {  // in a container: who lets root run a study lets it run its processes
    environment.set("OMPI_ALLOW_RUN_AS_ROOT=1");
    environment.set("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1");
  }
  process_ = start(words.data(), environment.words(), to[1], from[1]);
  if (process_ < 0)  // its answer is an end at once
    ended_ = part("cannot_be_started") + ": " + std::generic_category().message(errno);
  close(to[1]);
  close(from[1]);
  to_ = to[0];
  from_ = from[0];
}

Companion::~Companion() {
  close(to_);
  const auto wait = [&](std::chrono::milliseconds time) {
    for (; ended_.empty() && time.count() > 0; time -= nap) {
      if (waitpid(process_, nullptr, WNOHANG) != 0) return true;
      std::this_thread::sleep_for(nap);
    }
    return !ended_.empty();
  };
  if (!wait(patience)) {
    ::kill(process_, SIGTERM);
    if (!wait(patience)) {
      ::kill(process_, SIGKILL);
      waitpid(process_, nullptr, 0);
    }
  }
  close(from_);
}

bool Companion::is_running() const {
  siginfo_t found{};
  return ended_.empty() && waitid(P_PID, static_cast<id_t>(process_), &found, WEXITED | WNOHANG | WNOWAIT) == 0 &&
         found.si_pid == 0;
}

void Companion::kill() {
  if (ended_.empty()) ::kill(process_, SIGKILL);
}

bool Companion::say(const std::string& line) {
  const std::string whole = line + '\n';
  for (std::size_t sent = 0; sent < whole.size();) {
    const ssize_t now = send(to_, whole.data() + sent, whole.size() - sent, MSG_NOSIGNAL);
    if (now < 0 && errno != EINTR) return false;
    if (now > 0) sent += static_cast<std::size_t>(now);
  }
  return true;
}

std::string Companion::answer() {
  for (std::size_t end = heard_.find('\n');; end = heard_.find('\n')) {
    if (end != std::string::npos) {
      std::string line = heard_.substr(0, end);
      heard_.erase(0, end + 1);
      if (line.empty()) continue;
      return line;
    }
    char more[4096];
    const ssize_t got = read(from_, more, sizeof more);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return {};
    heard_.append(more, static_cast<std::size_t>(got));
  }
}

std::string Companion::end() {
  int status = 0;
  if (!ended_.empty() || waitpid(process_, &status, 0) != process_) return ended_;
  const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status) - by_signal;
  killed_ = signal > 0 && signal < NSIG;
  if (killed_)
    ended_ = part("ended_by_signal", {{"signal", strsignal(signal)}});
  else if (WEXITSTATUS(status) == not_started)
    end_without_start();
  else
    ended_ = part("ended_with_status", {{"status", std::to_string(WEXITSTATUS(status))}});
  return ended_;
}

void Companion::end_without_start() {
  ended_ = part("cannot_be_started");
  started_ = false;
}

}  // namespace lacon
