#include "lacon/operators/program/ending.hpp"

#include <poll.h>
#include <sys/prctl.h>
#include <sys/time.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <system_error>
#include <thread>

namespace lacon {
namespace {

constexpr timeval patience{.tv_sec = 1, .tv_usec = 500'000};

volatile std::sig_atomic_t asked = 0;

void remember(int signal) {
  if (asked) return;
  asked = signal;
  const itimerval once{.it_interval = {}, .it_value = patience};
  setitimer(ITIMER_REAL, &once, nullptr);  // SIGALRM ends the program
}

}  // namespace

void end_with_launcher() {
  const char* const launcher = std::getenv("LACON_LAUNCHER");
  const char* const socket = std::getenv("LACON_FORMULAS");
  if (!launcher || !socket) return;
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != std::atoi(launcher)) std::raise(SIGTERM);  // it has gone before
  // a launcher in another container than the one that reaps its children: the kernel says nothing of its end
  try {
    std::thread([end = std::atoi(socket)] {
      pollfd other{.fd = end, .events = POLLRDHUP, .revents = 0};
      while (poll(&other, 1, -1) < 0) continue;
      kill(getpid(), SIGTERM);
    }).detach();
  } catch (const std::system_error&) {  // no more threads are allowed: what the kernel says is enough almost everywhere
  }
}

void wait_with_ending() {
  struct sigaction action = {};
  action.sa_handler = remember;
  for (const int signal : {SIGTERM, SIGINT, SIGHUP, SIGPIPE, SIGXCPU}) {
    struct sigaction before = {};
    sigaction(signal, nullptr, &before);
    if (before.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);  // nohup stays what it is
  }
}

const char* ending() {
  switch (asked) {
    case SIGTERM:
      return "SIGTERM";
    case SIGINT:
      return "SIGINT";
    case SIGHUP:
      return "SIGHUP";
    case SIGPIPE:
      return "SIGPIPE";
    case SIGXCPU:
      return "SIGXCPU";
    default:
      return nullptr;
  }
}

}  // namespace lacon
