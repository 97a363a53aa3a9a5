"""The launcher: `lacon study.comm --unit 20=mesh.med`, `lacon study.export`, and tools: `lacon help DEFI_CONTACT`, `lacon inspect`."""

import argparse
import importlib
import os
import re
import sys

from . import version
from .core import outcome, streams
from .core.command_line import CommandLine
from .core.plugins import operator_folder

#: `lacon NAME ...` that is no study: modules of tools/
tools = ("help", "inspect", "convert", "check", "new", "plot", "report", "watch")


class _Version(argparse.Action):
    """Print the version; the operator that solves tells its library, kernel and threads."""

    def __call__(self, parser, *_):
        import subprocess  # start-up: any run

        print(f"lacon {version}")
        try:
            said = subprocess.run([operator_folder() / "stat_non_line", "--version"], capture_output=True, text=True, check=True).stdout
            print(said.partition("\n")[2], end="")
        except (OSError, subprocess.SubprocessError):
            pass  # a launcher without operators has a version too
        parser.exit()


def parser():
    """Of the command line of a study."""
    made = CommandLine(
        prog="lacon", description="Runs code_aster command files with the operators of Lacon.",
        epilog="lacon help: all commands; lacon help COMMAND: its keywords. Tools, each with --help: lacon inspect, convert, check, new, plot, report, watch. Exit status: 0 done, 2 user's error, 3 the solution failed, 4 internal error or interrupted, 5 a check is NOOK.")
    made.add("files", nargs="+", metavar="FILE", help="command files, in order, or one export file")
    made.add("--unit", action="append", default=[], metavar="N=FILE", help="the file of unit N; may be repeated")
    made.add("--base", metavar="FOLDER", help="folder of the base; otherwise STUDY.base beside the first command file")
    made.add("--fresh", action="store_true", help="DEBUT empties the base first")
    made.add("--force", action="store_true", help="run every operator, also where nothing has changed since its concept was made")
    made.add("--checks", choices=("all",), help="all: a VALE_CALC missed beside a reference that is met is NOOK, not DIFF")
    made.add("--json", metavar="FILE", help="write every check with its figures, and where the time went")
    made.add("--timings", action="store_true", help="print where the time went")
    made.add("--verbose", action="store_true", help="operators say each phase with its time, and each count, as they come")
    made.add("--threads", type=int, metavar="N", help="threads of operators")
    made.add("--mpi", type=int, metavar="N", help="processes that solve the linear systems")
    made.add("--hosts", metavar="NAMES", help="machines of the processes of METHODE='PETSC', this one first, as mpirun takes them: NAME:PROCESSES,...")
    made.add("--sandbox", action="store_true", help="run the study without network, and let it write its base and the files of its units alone (bubblewrap)")
    made.add("--stage", help=argparse.SUPPRESS)  # of the launcher within a sandbox
    made.add("--version", action=_Version, nargs=0, help="print the version, and what operators calculate with")
    return made


def parse(arguments):
    """(the parser, its options)"""
    asked = parser()
    options = asked.parse_args(arguments)
    if options.threads is not None and options.threads < 1:
        asked.wrong("give_one_or_more", option="--threads")
    if options.mpi is not None and options.mpi < 1:
        asked.wrong("give_one_or_more", option="--mpi")
    if options.hosts is not None and not re.fullmatch(r"[^\s:,]+(:[1-9]\d*)?(,[^\s:,]+(:[1-9]\d*)?)*", options.hosts):
        asked.wrong("give_hosts", option="--hosts")
    if options.base == "":
        asked.wrong("give_folder", option="--base")
    return asked, options


def main(arguments=None):
    """@return the exit status"""
    arguments = sys.argv[1:] if arguments is None else arguments
    streams.open_closed()
    sys.stdout.reconfigure(line_buffering=sys.stdout.isatty(), errors="backslashreplace")  # names of files that the terminal's encoding lacks
    if arguments and arguments[0] in tools:
        tool = importlib.import_module(f".tools.{arguments[0]}", __package__)
        try:
            return outcome.guarded(lambda: (_flushed(tool.run(arguments[1:])), ""))[0]
        except BrokenPipeError:  # `lacon help STAT_NON_LINE | head`: who reads has seen enough
            streams.let_go()
            return outcome.done
    process = os.getpid()
    asked, options = parse(arguments)
    status, diagnostic = outcome.guarded(lambda: _run(asked, options))
    if not diagnostic:  # the launcher within a sandbox has said it
        return status
    if os.getpid() != process:  # one that the command file has forked: the diagnosis is that of the run
        return status
    try:
        return outcome.guarded(lambda: (_flushed(status, f"--- DIAGNOSTIC JOB : {diagnostic}"), ""))[0]
    except BrokenPipeError:
        streams.let_go()
    return status


def _run(asked, options):
    """A study. @return (exit status, words of the diagnosis)"""
    launch = importlib.import_module(".run.launch", __package__)  # --help, --version, help and inspect start without
    units = launch.units_of(asked, options)
    if options.sandbox:
        sandbox = importlib.import_module(".run.sandbox", __package__)
        return sandbox.run(options, units), ""
    return launch.run_command_line(options, units)


def _flushed(status, *said):
    print(*said, sep="", end="\n" if said else "", flush=True)
    return status
