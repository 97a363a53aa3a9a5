#pragma once
// The processes that share a factor of MUMPS (tree_mumps.hpp), and may have the cells of the matrix (parts/solid_parts.hpp).
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "lacon/assembly/parts/part_processes.hpp"
#include "lacon/assembly/processes/companion.hpp"

namespace lacon {

/// Processes of lacon_mumps, each with the pieces of a matrix that were given to it.
class MumpsProcesses : public PartProcesses {
 public:
  /// @param program lacon_mumps; empty: beside the program that runs
  MumpsProcesses(int n_processes, std::string program) : n_(n_processes), program_(std::move(program)) {}
  int size() const override { return n_; }

  /// Where they do not run: not yet, or not any more. Throws SOLVER_8 where one cannot be started.
  void start() override;
  void forget() noexcept;
  std::string ask(const std::string& line) override;
  /// Tell the first one something. @return whether it was there to hear it; its answer comes by answer_of_first(), before
  /// anything else is asked
  bool tell_first(const std::string& line) { return !processes_.empty() && processes_.front()->say(line); }
  /// Empty where it has ended: all have to be started again then.
  std::string answer_of_first();
  /// End the first one, whose answer nobody waits for.
  void kill_first() noexcept {
    if (!processes_.empty()) processes_.front()->kill();
  }
  void keep() override { keeps_ = true; }
  struct Question {
    const char* verb;
    const char* phase;      ///< in words, where memory ends
    std::size_t equations;  ///< likewise
  };
  /// Ask about each piece, all before the first answer is waited for. @param process of each  @param rest of the line about it
  /// @param meanwhile what is done before answers are waited for  @param answered what is done with each piece once it and
  /// those before it are answered without complaint; what either throws comes behind all answers
  /// @return the numbers of each answer  Throws SOLVER_2, SOLVER_8, std::runtime_error.
  std::vector<std::vector<double>> ask(const Question& question, std::span<const int> process,
                                       const std::function<std::string(std::size_t piece)>& rest,
                                       const std::function<void()>& meanwhile = {},
                                       const std::function<void(std::size_t piece)>& answered = {});

 private:
  /// What a process has answered. Throws SOLVER_8 where it has ended.
  std::string answer_of(int process);

  int n_;
  std::string program_;
  std::vector<std::unique_ptr<Companion>> processes_;
  bool keeps_ = false;
  std::string end_;  ///< how one of them has ended
};

}  // namespace lacon
