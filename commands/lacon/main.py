"""The launcher: `lacon study.comm --unit 20=mesh.med`, `lacon study.export`, and tools: `lacon help DEFI_CONTACT`, `lacon inspect`."""

import argparse
import importlib
import os
import sys

from . import version
from .commands import checks
from .core import messages
from .core.plugins import operator_folder
from .run import execution, launch, study

#: `lacon NAME ...` that is no study: modules of tools/
tools = ("help", "inspect", "convert", "check", "new")


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


def parse(arguments):
    parser = argparse.ArgumentParser(
        prog="lacon", description="Runs code_aster command files with the operators of Lacon.",
        epilog="lacon help: all commands; lacon help COMMAND: its keywords. Exit status: 0 done, 2 user's error, 3 the solution failed, 4 internal error, 5 a check is NOOK.")
    parser.add_argument("files", nargs="+", metavar="FILE", help="command files, in order, or one export file")
    parser.add_argument("--unit", action="append", default=[], metavar="N=FILE", help="the file of unit N; may be repeated")
    parser.add_argument("--base", metavar="FOLDER", help="folder of the base; otherwise STUDY.base beside the first command file")
    parser.add_argument("--fresh", action="store_true", help="DEBUT empties the base first")
    parser.add_argument("--force", action="store_true", help="run every operator, also where nothing has changed since its concept was made")
    parser.add_argument("--checks", choices=("all",), help="all: a missed VALE_CALC is NOOK, not DIFF")
    parser.add_argument("--json", metavar="FILE", help="write every check with its figures, and where the time went")
    parser.add_argument("--timings", action="store_true", help="print where the time went")
    parser.add_argument("--verbose", action="store_true", help="operators say each phase with its time, and each count, as they come")
    parser.add_argument("--threads", type=int, metavar="N", help="threads of operators")
    parser.add_argument("--version", action=_Version, nargs=0, help="print the version, and what operators calculate with")
    options = parser.parse_args(arguments)
    if options.threads is not None and options.threads < 1:
        parser.error("--threads: give a number of at least 1")
    return parser, options


def main(arguments=None):
    """@return the exit status"""
    arguments = sys.argv[1:] if arguments is None else arguments
    sys.stdout.reconfigure(line_buffering=sys.stdout.isatty())
    if arguments and arguments[0] in tools:
        tool = importlib.import_module(f".tools.{arguments[0]}", __package__)
        try:
            status = launch.guarded(lambda: (tool.run(arguments[1:]), ""))[0]
            sys.stdout.flush()
            return status
        except BrokenPipeError:  # `lacon help STAT_NON_LINE | head`: who reads has seen enough
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # what is still to be written at exit goes nowhere
            return launch.done
    parser, options = parse(arguments)
    units = launch.units_of(parser, options)
    status, diagnostic = launch.guarded(lambda: _run(options, units))
    print(f"--- DIAGNOSTIC JOB : {diagnostic}", flush=True)
    return status


def _run(options, units):
    """@return (exit status, words of the diagnosis)"""
    export = launch.command_files(options.files, units)
    threads = options.threads
    if threads is None and export.parameters.get("ncpus", "").isdigit():
        threads = max(1, int(export.parameters["ncpus"]))
    base = options.base or export.base or export.commands[0].with_suffix(".base")
    run = study.Study(base, export.units, options.fresh, threads, options.checks == "all", execution.provided_names(),
                      options.force, options.verbose)
    for name in export.commands + export.named + export.data:
        run.protect(name)

    def work():
        with execution.delivered(export.named), execution.time_limit(export.parameters.get("time_limit", "")):
            execution.run_files(run, export.commands)

    status, diagnostic = launch.run_study(run, work)
    if status == launch.done:
        if any(check.status == "NOOK" for check in run.checks):
            status, diagnostic = launch.check_failed, "NOOK_TEST_RESU"
        else:
            diagnostic = "<A>_ALARM" if run.alarms else "OK"
    if run.checks:
        print(checks.summary(run.checks))
    if options.json:
        try:
            checks.write_json(options.json, run.checks, diagnostic, status, run.timings.data())
        except OSError as error:
            messages.show(messages.message("STUDY_3", options.json, folder=options.json, reason=error.strerror))
            status, diagnostic = status or launch.user_error, diagnostic if status else "<F>_ERROR"
    if options.timings:
        print(run.timings.table())
    return status, diagnostic
