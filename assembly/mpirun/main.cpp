// lacon_mpirun PROGRAM ARGUMENTS...: mpirun, with a folder of its own for files of Open MPI, which are gone when it has ended,
// whatever has ended it.
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <optional>

#include "lacon/assembly/mpirun/own_folder.hpp"

namespace {

/// Seconds that mpirun has to end its ranks and itself, and those that are left of it; it needs a few tenths.
constexpr time_t patience = 1;
constexpr int not_started = 127;

/// Its signals are those of others again: mpirun answers to Ctrl-C by itself.
pid_t start(char** words, const sigset_t& before) {
  const pid_t process = fork();
  if (process == 0) {
    prctl(PR_SET_PDEATHSIG, SIGTERM);  // it ends its ranks
    sigprocmask(SIG_SETMASK, &before, nullptr);
    execvp(words[0], words);
    _exit(not_started);
  }
  return process;
}

/// The next of these signals. @return it; negative: the time is over
int next(const sigset_t& signals, const std::optional<timespec>& end) {
  for (;;) {
    timespec left{.tv_sec = patience, .tv_nsec = 0};
    if (end) {
      clock_gettime(CLOCK_MONOTONIC, &left);
      left = {.tv_sec = end->tv_sec - left.tv_sec, .tv_nsec = end->tv_nsec - left.tv_nsec};
      if (left.tv_nsec < 0) left = {.tv_sec = left.tv_sec - 1, .tv_nsec = left.tv_nsec + 1'000'000'000};
      if (left.tv_sec < 0) return -1;
    }
    const int signal = end ? sigtimedwait(&signals, nullptr, &left) : sigwaitinfo(&signals, nullptr);
    if (signal >= 0 || errno == EAGAIN) return signal;
  }
}

timespec after_patience() {
  timespec end{};
  clock_gettime(CLOCK_MONOTONIC, &end);
  end.tv_sec += patience;
  return end;
}

/// Until it has ended; where this process is asked to end, or its parent is gone, mpirun is. @return its status as waitpid()
/// has it
int wait_for(pid_t process, const sigset_t& signals, pid_t parent) {
  std::optional<timespec> end;
  for (int status = 0;;) {
    if (waitpid(process, &status, WNOHANG) == process) return status;
    const int signal = next(signals, end);
    if ((signal == SIGTERM || (signal == SIGCONT && getppid() != parent)) && !end) {
      kill(process, SIGTERM);
      end = after_patience();
    } else if (signal < 0) {
      kill(process, SIGKILL);
      end.reset();
    }
  }
}

/// Ranks that outlive it for a moment still make files.
void wait_for_others(const sigset_t& signals) {
  const timespec end = after_patience();
  for (pid_t other = 1; other >= 0;) {
    other = waitpid(-1, nullptr, WNOHANG);
    if (other == 0 && next(signals, end) < 0) return;
  }
}

/// Run it with folders of its own. @return its status
int run(char** words) {
  const pid_t parent = getppid();
  sigset_t signals, before;
  sigemptyset(&signals);
  for (const int signal : {SIGCHLD, SIGTERM, SIGCONT, SIGINT, SIGHUP}) sigaddset(&signals, signal);
  sigprocmask(SIG_BLOCK, &signals, &before);
  sigdelset(&signals, SIGINT);  // those of a terminal, should it be in its group: mpirun gets them too
  sigdelset(&signals, SIGHUP);
  signal(SIGCHLD, SIG_DFL);
  prctl(PR_SET_PDEATHSIG, SIGCONT);  // other signals do not wake who is stopped, and SIGKILL would leave what is to be removed
  if (getppid() != parent) raise(SIGCONT);  // it has gone before
  prctl(PR_SET_CHILD_SUBREAPER, 1);
  const lacon::OwnFolder session(lacon::folder_of_sessions()), memory(lacon::folder_of_memory);
  if (!session.path().empty()) setenv("TMPDIR", session.path().c_str(), 1);  // of this machine alone, as the next one
  // for processes of this machine: mpirun would tell those of others what begins with OMPI_
  if (!memory.path().empty()) setenv("LACON_MPI_MEMORY", memory.path().c_str(), 1);
  // what ranks know of each other as messages instead of shared files of megabytes: where TMPDIR has no room for these, ranks
  // die at their start and mpirun waits for ever
  setenv("PMIX_MCA_gds", "hash", 0);
  const pid_t process = start(words, before);
  if (process < 0) {  // it is there, and there can be no more processes
    std::perror(words[0]);
    return W_EXITCODE(1, 0);
  }
  close(STDIN_FILENO);  // who talks with mpirun sees when it has ended
  const int status = wait_for(process, signals, parent);
  wait_for_others(signals);
  return status;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fputs("usage: lacon_mpirun PROGRAM ARGUMENTS... (started by operators)\n", stderr);
    return 2;
  }
  const int status = run(argv + 1);
  if (!WIFSIGNALED(status)) return WEXITSTATUS(status);
  prctl(PR_SET_DUMPABLE, 0);  // one core is enough
  signal(WTERMSIG(status), SIG_DFL);
  sigset_t same;
  sigemptyset(&same);
  sigaddset(&same, WTERMSIG(status));
  sigprocmask(SIG_UNBLOCK, &same, nullptr);
  raise(WTERMSIG(status));
  return not_started;
}
