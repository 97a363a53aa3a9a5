"""The launcher: `lacon study.comm --unit 20=mesh.med`, `lacon study.export`, and tools: `lacon help DEFI_CONTACT`, `lacon inspect`."""

import os
import pathlib
import sys

from . import version

#: `lacon NAME ...` that runs no command files: the module whose run(arguments) does it and returns the exit status
subcommands = {"help": "help", "inspect": "inspector", "convert": "convert", "check": "check", "new": "starter"}

#: exit statuses, DESIGN.md
done, user_error, solution_failed, internal_error, check_failed = 0, 2, 3, 4, 5


def parse(arguments):
    import argparse

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
    parser.add_argument("--threads", type=int, metavar="N", help="threads of operators")
    parser.add_argument("--version", action="version", version=f"lacon {version}")
    options = parser.parse_args(arguments)
    if options.threads is not None and options.threads < 1:
        parser.error("--threads: give a number of at least 1")
    return parser, options


def units_of(parser, options):
    units = {}
    for text in options.unit:
        number, equals, path = text.partition("=")
        if not equals or not number.isdigit() or not 1 <= int(number) <= 99 or not path:
            parser.error(f"--unit {text}: give a number from 1 to 99 and a file, as in --unit 20=mesh.med")
        if int(number) in units:
            parser.error(f"--unit {number} is there twice")
        units[int(number)] = path
    return units


def main(arguments=None):
    """@return the exit status"""
    arguments = sys.argv[1:] if arguments is None else arguments
    sys.stdout.reconfigure(line_buffering=sys.stdout.isatty())
    if arguments and arguments[0] in subcommands:
        import importlib

        tool = importlib.import_module(f".{subcommands[arguments[0]]}", __package__)
        try:
            status = guarded(lambda: (tool.run(arguments[1:]), ""))[0]
            sys.stdout.flush()
            return status
        except BrokenPipeError:  # `lacon help STAT_NON_LINE | head`: who reads has seen enough
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # what is still to be written at exit goes nowhere
            return done
    parser, options = parse(arguments)
    units = units_of(parser, options)
    status, diagnostic = guarded(lambda: _run(options, units))
    print(f"--- DIAGNOSTIC JOB : {diagnostic}", flush=True)
    return status


def guarded(work):
    """What `work` returns, (exit status, words of the diagnosis); errors that it throws are shown."""
    from . import messages

    try:
        return work()
    except messages.AsterError as error:
        for item in error.messages:
            messages.show(item)
        return error.status, error.diagnostic
    except FileNotFoundError as error:  # no catalogue: an installation that is not whole
        print(f"<F> <INTERNAL> {error}", file=sys.stderr)
        return internal_error, "<F>_ABNORMAL_ABORT"


def command_files(names, units):
    """The command files and what goes with them, named on the command line or by an export file. @return an export.Export"""
    from . import execution, messages
    from .export import Export, read_export

    files = [pathlib.Path(name) for name in names]
    if files[0].suffix == ".export":
        if len(files) > 1:
            messages.fail("STUDY_22", str(files[1]))
        export = read_export(files[0])
    else:
        export = Export()
        export.commands = files
    export.units = {**export.units, **units}
    execution.check_files(export.commands)
    return export


def run_study(run, work):
    """Do `work`, which runs command files of the study `run`, and close its base. @return (exit status, words of the diagnosis)"""
    from . import execution, messages, study

    study.current = run
    status, diagnostic = done, ""
    try:
        work()
    except execution.Failure as failure:
        status, diagnostic = failure.status, failure.diagnostic
    finally:
        try:
            run.close()
        except messages.AsterError as error:
            for item in error.messages:
                messages.show(item)
            status, diagnostic = error.status, error.diagnostic
    return status, diagnostic


def _run(options, units):
    """@return (exit status, words of the diagnosis)"""
    from . import checks, execution, messages, study

    export = command_files(options.files, units)
    threads = options.threads
    if threads is None and export.parameters.get("ncpus", "").isdigit():
        threads = max(1, int(export.parameters["ncpus"]))
    base = options.base or export.base or export.commands[0].with_suffix(".base")
    run = study.Study(base, export.units, options.fresh, threads, options.checks == "all", execution.provided_names(),
                      options.force)
    for name in export.commands + export.named + export.data:
        run.protect(name)

    def work():
        with execution.delivered(export.named), execution.time_limit(export.parameters.get("time_limit", "")):
            execution.run_files(run, export.commands)

    status, diagnostic = run_study(run, work)
    if status == done:
        if any(check.status == "NOOK" for check in run.checks):
            status, diagnostic = check_failed, "NOOK_TEST_RESU"
        else:
            diagnostic = "<A>_ALARM" if run.alarms else "OK"
    if run.checks:
        print(checks.summary(run.checks))
    if options.json:
        try:
            checks.write_json(options.json, run.checks, diagnostic, status, run.timings.data())
        except OSError as error:
            messages.show(messages.message("STUDY_3", options.json, folder=options.json, reason=error.strerror))
            status, diagnostic = status or user_error, diagnostic if status else "<F>_ERROR"
    if options.timings:
        print(run.timings.table())
    return status, diagnostic
