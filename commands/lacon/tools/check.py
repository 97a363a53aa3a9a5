"""`lacon check study.comm`: everything that can be known of a study without solving it.

The command file runs in a base of its own, which disappears. Meshes, groups, models, materials, loads and contacts are really made, so
that whatever their operators refuse is found. The operator of what solves (rows with `solves`) does everything up to its first instant;
what follows from that is checked by its keywords alone, and by the groups that they name; nothing is printed to files and nothing is tested. The check ends at the first
value that only a run can give.
"""

import os
import pathlib
import tempfile

from ..commands.places import group_that_was_meant
from ..core import current, messages, outcome
from ..core.catalog import part
from ..core.command_line import CommandLine
from ..core.concepts import concepts_in, type_of
from ..run import execution, launch, study

_groups = {"group_ma": "cells", "group_no": "nodes"}  #: type of a keyword -> what its groups are of
_always = ("DEBUT", "POURSUITE", "FIN", "DETRUIRE", "INCLUDE", "DEFI_FICHIER")


class Check:
    """What a check has come to."""

    def __init__(self):
        self.commands = 0
        self.prepared = []  #: (command, where) of those that went up to their first instant
        self.unsolved = []  #: of those whose keywords alone are checked

    def takes(self, command, row, keywords, where):
        """The command is not really run. Its keywords are right when this is asked."""
        self.commands += 1
        told_by_a_run = row.get("result") == "concept" and "result_of" not in row  # what it gives: EXTR_TABLE
        if command in _always or told_by_a_run:
            return False
        unsolved = self._follows(keywords)
        if not (row.get("solves") or unsolved or "result" not in row):
            return False
        if unsolved:
            _refuse_unknown_groups(command, row, keywords, where)
            self.unsolved.append((command, where))
        elif row.get("solves"):
            self.prepared.append((command, where))
        return True

    def prepares(self, row, keywords):
        """Whether a command that is not really run solves, and what it starts from is there."""
        return bool(row.get("solves")) and not self._follows(keywords)

    def _follows(self, keywords):
        """Whether keywords name a concept that is not there since nothing was solved."""
        return any(item.id in current.study.base.unsolved for item in concepts_in(keywords))


def _named_groups(row, keywords, path):
    """(path of a keyword, "cells" or "nodes", name) of every group that a command names."""
    for name, keyword in row.get("keyword", {}).items():
        given = keywords.get(name)
        if given is None:
            continue
        several = given if isinstance(given, list) else [given]
        if keyword["type"] == "factor":
            for i, occurrence in enumerate(several, 1):
                yield from _named_groups(keyword, occurrence, f"{path}/{name}[{i}]")
        elif keyword["type"] in _groups:
            yield from ((f"{path}/{name}", _groups[keyword["type"]], one) for one in several)


def _refuse_unknown_groups(command, row, keywords, where):
    """TEST_RESU_9: a group that no mesh of the study has. What makes a mesh of a solution, or groups, may know others."""
    base = current.study.base
    if row.get("result") == "mesh" or any(type_of(identifier) == "mesh" for identifier in base.unsolved):
        return
    meshes = [base.concept(path.stem) for path in base.folder.glob("mesh_*.h5") if type_of(path.stem) == "mesh"]
    known = {kind: sorted({name for mesh in meshes for name in mesh.group_names(kind)}) for kind in _groups.values()}
    problems = [messages.message("TEST_RESU_9", f"{path}, {where}", name=name, what=part(kind), known=", ".join(known[kind]) or part("none"),
                                 nearest=group_that_was_meant(kind, name, known))
                for path, kind, name in _named_groups(row, keywords, command) if meshes and name not in known[kind]]
    if problems:
        raise messages.AsterError(problems)


def parser():
    """Of its command line."""
    made = CommandLine(prog="lacon check", description="Checks command files without solving; the study's base is left alone.")
    made.add("files", nargs="+", metavar="FILE", help="command files, in order, or one export file")
    made.add("--unit", action="append", default=[], metavar="N=FILE", help="the file of unit N; may be repeated")
    return made


def run(arguments):
    """@return exit status"""
    asked = parser()
    options = asked.parse_args(arguments)
    export = launch.command_files(options.files, launch.units_of(asked, options))
    shown = ", ".join(map(os.path.relpath, options.files))  # before a command file goes to another folder
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
    words = [part("commands_are_right", files=shown, count=this.check.commands)]
    if this.check.prepared:
        words.append(part("right_up_to_first_instant", commands=_listed(this.check.prepared, export)))
    if this.check.unsolved:
        words.append(part("right_by_keywords_alone", commands=_listed(this.check.unsolved, export)))
    for needed, place in stopped:
        words.append(part("checked_up_to", place=place, label=needed.label, made=needed.made))
    print("\n  ".join(words))
    return status


def _listed(commands, export):
    """"STAT_NON_LINE (line 11), ...": commands with their lines, and with the file where there are several."""
    one_file = len({where.rpartition(":")[0] for _, where in commands}) == 1 == len(export.commands)
    return ", ".join(dict.fromkeys(f"{command} ({part('line_number', line=where.rpartition(':')[2]) if one_file else where})" for command, where in commands))
