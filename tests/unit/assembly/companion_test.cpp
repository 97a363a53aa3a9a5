// Programs that are talked with.
#include "lacon/assembly/processes/companion.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <filesystem>
#include <iostream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "lacon/assembly/processes/shared_memory.hpp"
#include "lacon/catalog/messages.hpp"
#include "open_files.hpp"

namespace lacon {
namespace {

std::vector<std::string> shell(const char* text) { return {"sh", "-c", text}; }

// Also of those that end by themselves, are not there, or are never heard.
TEST(Companion, LeavesNoFileOpen) {
  const std::ptrdiff_t before = open_files();
  for (int i = 0; i < 50; ++i) {
    Companion talks(shell("read line; echo heard $line; read line"));
    EXPECT_EQ(talks.ask("it"), "heard it");
    const Companion silent(shell("read line"));
    Companion ends(shell("exit 3")), missing({"/nowhere/program"});
    EXPECT_EQ(ends.answer(), "");
    EXPECT_EQ(missing.answer(), "");
    missing.end();
    EXPECT_FALSE(missing.has_started());
  }
  EXPECT_EQ(open_files(), before);
}

// Status of a shell, or of mpirun, that stands for what was killed.
TEST(Companion, KnowsWhetherItWasKilled) {
  for (const auto& [text, killed] : {std::pair("kill -9 $$", true), std::pair("exit 137", true), std::pair("exit 1", false),
                                     std::pair("exit 128", false), std::pair("exit 255", false)}) {
    Companion program(shell(text));
    EXPECT_EQ(program.answer(), "");
    program.end();
    EXPECT_EQ(program.was_killed(), killed) << text;
    EXPECT_TRUE(program.has_started());
  }
}

/// The message that a call ends with where no more files may be open.
template <class Call>
void say_without_files(const Call& call) {
  const rlimit few{20, 20};
  setrlimit(RLIMIT_NOFILE, &few);
  while (open("/dev/null", O_RDONLY) >= 0) continue;
  try {
    call();
  } catch (const Error& error) {
    std::cerr << error.message().id << ' ' << error.message().text;
  }
  _exit(0);
}

TEST(Companion, SaysThatTooFewFilesMayBeOpen) {
  const char* const expected = "SOLVER_17 20 files may be open";
  EXPECT_EXIT(say_without_files([] { const Companion program(shell("true")); }), testing::ExitedWithCode(0), expected);
  EXPECT_EXIT(say_without_files([] { const SharedMemory memory(8); }), testing::ExitedWithCode(0), expected);
}

// A user who may have no more processes has the program all the same.
TEST(Companion, SaysThatThereCanBeNoMoreProcesses) {
  if (geteuid() != 0) GTEST_SKIP() << "only root may become somebody else, whom the limit holds for";
  const auto start_as_another = [] {
    constexpr uid_t nobody_else = 61'234;
    const rlimit none{0, 0};
    setrlimit(RLIMIT_NPROC, &none);
    if (setresuid(nobody_else, nobody_else, nobody_else) != 0) _exit(1);
    Companion program(shell("echo ready"));
    std::cerr << program.answer() << program.end() << (program.has_started() ? ", it is there" : ", it is not there");
    _exit(0);
  };
  EXPECT_EXIT(start_as_another(), testing::ExitedWithCode(0), "Resource temporarily unavailable, it is there");
}

// Ctrl-C in a terminal is for the group of this process, which ends its programs as it sees fit.
TEST(Companion, IsInNoGroupOfATerminal) {
  Companion program(shell("echo $$; read line"));
  const pid_t process = std::stoi(program.answer());
  EXPECT_NE(getpgid(process), getpgrp());
  EXPECT_EQ(getsid(process), getsid(0));
}

}  // namespace
}  // namespace lacon
