"""`lacon check study.comm`: everything that can be known of a study without solving it.

The command file runs in a base of its own, which disappears. Meshes, groups, models, materials, loads and contacts are really made, so
that whatever their operators refuse is found. What solves (rows with `solves`) and what follows from it is checked by its keywords
alone; nothing is printed to files and nothing is tested. The check ends at the first value that only a run can give.
"""

import argparse
import os
import pathlib
import tempfile

from ..core import current, messages, outcome
from ..core.concepts import concepts_in
from ..run import execution, launch, study

_always = ("DEBUT", "POURSUITE", "FIN", "DETRUIRE", "INCLUDE", "DEFI_FICHIER")


class Check:
    """What a check has come to."""

    def __init__(self):
        self.commands = 0
        self.unsolved = []  #: (command, where) of those whose keywords alone are checked

    def takes(self, command, row, keywords, where):
        """The command is not really run. Its keywords are right when this is asked."""
        self.commands += 1
        if command in _always:
            return False
        unsolved = any(item.id in current.study.base.unsolved for item in concepts_in(keywords))
        if not (row.get("solves") or unsolved or "result" not in row):
            return False
        if row.get("solves") or unsolved:
            self.unsolved.append((command, where))
        return True


def parser():
    """Of its command line."""
    made = argparse.ArgumentParser(prog="lacon check", description="Checks command files without solving; the study's base is left alone.")
    made.add_argument("files", nargs="+", metavar="FILE", help="command files, in order, or one export file")
    made.add_argument("--unit", action="append", default=[], metavar="N=FILE", help="the file of unit N; may be repeated")
    return made


def run(arguments):
    """@return exit status"""
    asked = parser()
    options = asked.parse_args(arguments)
    export = launch.command_files(options.files, launch.units_of(asked, options))
    stopped = []
    with tempfile.TemporaryDirectory(prefix="lacon_check_") as folder:
        this = study.Study(pathlib.Path(folder) / "check.base", export.units, provided=execution.provided_names())
        this.check = Check()
        for name in export.commands + export.named + export.data:
            this.protect(name)

        def work():
            try:
                with execution.delivered(export.named):
                    execution.run_files(this, export.commands)
            except messages.NeedsRun as needed:
                stopped.append((needed, execution.place(needed)))

        status, _ = launch.run_study(this, work)
    if status != outcome.done:
        return status
    words = [f"{', '.join(map(os.path.relpath, options.files))}: {this.check.commands} commands are right"]
    if this.check.unsolved:
        one_file = len({where.rpartition(":")[0] for _, where in this.check.unsolved}) == 1 == len(export.commands)
        seen = dict.fromkeys(f"{command} ({'line ' + where.rpartition(':')[2] if one_file else where})" for command, where in this.check.unsolved)
        words.append("by their keywords alone: " + ", ".join(seen))
    for needed, place in stopped:
        words.append(f"checked up to {place}: it needs what {needed.label} holds, which only a run can give ({needed.label} is made at {needed.made})")
    print("\n  ".join(words))
    return status
