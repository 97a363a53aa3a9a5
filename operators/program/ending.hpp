#pragma once
// How a program ends before its work is done: by a signal, or with the launcher that has started it.

namespace lacon {

/// From now on the program gets SIGTERM when its launcher ends, whatever ends that: by the kernel (PR_SET_PDEATHSIG) and by the
/// socket that it has inherited. Nothing without launcher.
void end_with_launcher();

/// From now on the signals that ask for an end (SIGTERM, SIGINT, SIGHUP, SIGPIPE: whoever read the output has gone, SIGXCPU:
/// the shell's limit of processor time) are remembered instead of ending the program at once, for a moment at which nothing is
/// half-done. After a second and a half without such a moment they end it all the same. One that is ignored stays so.
void wait_with_ending();
/// The name of the signal that asks for the end, nullptr as long as none does.
const char* ending();

}  // namespace lacon
