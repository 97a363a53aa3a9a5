"""What the launcher and its tools share: the files of a study, a run from its beginning to its end, exit statuses."""

import pathlib
import sys

from ..core import current, messages
from . import execution
from .export import Export, read_export

#: exit statuses
done, user_error, solution_failed, internal_error, check_failed = 0, 2, 3, 4, 5


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


def guarded(work):
    """What `work` returns, (exit status, words of the diagnosis); errors that it throws are shown."""
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
    current.study = run
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
