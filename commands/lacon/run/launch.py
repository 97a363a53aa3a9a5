"""What the launcher and its tools share: the files of a study, a run from its beginning to its end; and what `lacon study.comm` does."""

import os
import pathlib

from ..commands import checks
from ..core import current, messages, outcome
from ..core.files import why_not_written
from . import execution, study
from .export import Export, read_export
from .stage import Stage


_most_processes = 1024  # on one machine: beyond it is a slip of the keys, and starting them is all that the machine does


def units_of(parser, options):
    units = {}
    for text in options.unit:
        number, equals, path = text.partition("=")
        if not equals or not number.isdigit() or not 1 <= int(number) <= 99 or not path:
            parser.wrong("give_unit", option=f"--unit {text}")
        if int(number) in units:
            parser.wrong("unit_twice", option=f"--unit {number}")
        units[int(number)] = path
    return units


def command_files(names, units):
    """The command files and what goes with them, named on the command line or by an export file. @return an export.Export"""
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


def base_of(export):
    """The base of a study whose command line names none."""
    return export.base or export.commands[0].with_suffix(".base")


def _is_text(path):
    """Whether a path is UTF-8, in which orders name it; Python keeps other bytes as lone surrogates."""
    try:
        str(path).encode()
    except UnicodeEncodeError:
        return False
    return True


def run_study(run, work):
    """Do `work`, which runs command files of the study `run`, and close its base. @return (exit status, words of the diagnosis)"""
    current.study = run
    status, diagnostic = outcome.done, ""
    try:
        work()
    except execution.Failure as failure:
        status, diagnostic = failure.status, failure.diagnostic
    finally:
        try:
            run.close(failed=status != outcome.done)
        except messages.AsterError as error:
            for item in error.messages:
                messages.show(item)
            status, diagnostic = error.status, error.diagnostic
        except MemoryError:
            if status == outcome.done:
                status, diagnostic = outcome.memory_used_up()
    return status, diagnostic


def run_command_line(options, units):
    """`lacon study.comm` with its options. @return (exit status, words of the diagnosis)"""
    export = command_files(options.files, units)
    threads = options.threads
    if threads is None:
        threads = export.count("ncpus")
    ranks = options.mpi if options.mpi is not None else export.count("mpi_nbcpu")
    if (ranks or 0) > _most_processes and not options.hosts:
        messages.fail("STUDY_40", count=ranks, most=_most_processes)
    base = options.base or base_of(export)
    for path in (os.getcwd(), base, *export.commands, *export.units.values()):
        if not _is_text(path):
            messages.fail("STUDY_26", path=path)
    run = study.Study(base, export.units, options.fresh, threads, options.checks == "all", execution.provided_names(),
                      options.force, options.verbose)
    if ranks is None and options.hosts:
        ranks = sum(int(host.partition(":")[2] or 1) for host in options.hosts.split(","))
    run.ranks = ranks
    run.hosts = options.hosts
    report = options.json and os.path.abspath(options.json)  # a command file may change its folder
    run.stage = Stage(options.stage) if options.stage else None
    run.files = [os.path.realpath(name) for name in export.commands]
    for name in [*options.files, *export.commands, *export.named, *export.data]:  # an export file too
        run.protect(name)

    def check_report():
        """@throws AsterError where the report would replace a file of the study"""
        of_units = map(os.path.realpath, export.units.values())
        if report and (os.path.realpath(report) in {*run.sources, *of_units} or run.keeps(report)):
            messages.fail("STUDY_41", option="--json", file=options.json)

    check_report()
    if report and (reason := why_not_written(report)):
        messages.fail("STUDY_50", "--json", option="--json", file=options.json, reason=reason)  # before anything is computed

    def work():
        with execution.signals(), execution.delivered(export.named), execution.time_limit(export.seconds()):
            execution.run_files(run, export.commands)

    status, diagnostic = run_study(run, work)
    if status == outcome.done:
        if any(check.status == "NOOK" for check in run.checks):
            status, diagnostic = outcome.check_failed, "NOOK_TEST_RESU"
        else:
            diagnostic = "<A>_ALARM" if run.alarms else "OK"
    if run.checks:
        print(checks.summary(run.checks))
    if report:
        check_report()  # the command files have named more of them
        try:
            checks.write_json(report, run.checks, diagnostic, status, run.timings.data())
        except OSError as error:
            messages.show(messages.message("STUDY_50", options.json, option="--json", file=options.json, reason=error.strerror))
            status, diagnostic = status or outcome.user_error, diagnostic if status else "<F>_ERROR"
    if options.timings:
        print(run.timings.table())
    return status, diagnostic
