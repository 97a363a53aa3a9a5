"""A run: its base, its names, its files, and what DEBUT, POURSUITE and FIN do to them."""

import os
import pathlib
import stat
import sys

from ..base import orders
from ..base.base import Base
from ..base.names import Names
from ..core import current, streams
from ..core.catalog import part
from ..core.concepts import Concept
from ..core.files import is_readable, write_whole
from ..core.messages import AsterError, Message, fail, message, show
from ..objects.kinds import kinds
from . import execution, unused_contacts
from .timings import Timings


def _refuse_special(number, path, where):
    """A unit is a file on a disk: results are written whole by renaming, which would replace a device as /dev/null, and data are read more than once."""
    if os.path.exists(path) and not os.path.isfile(path):
        mode = os.stat(path).st_mode
        what = "unit_folder" if stat.S_ISDIR(mode) else "unit_pipe" if stat.S_ISFIFO(mode) else "unit_device"
        fail("COMMAND_21", where, unit=number, file=path, what=part(what))


class Study:
    """Everything that one call of the launcher shares between its command files."""

    def __init__(self, base_folder, units=None, fresh=False, threads=None, strict_checks=False, provided=None, force=False, verbose=False):
        self.base_folder = pathlib.Path(os.path.abspath(base_folder))
        # a command file may change its folder
        self.units = {number: os.path.abspath(path) for number, path in (units or {}).items()}  #: number -> path
        self.given_units = dict(self.units)  #: as the command line and the export file have them
        self.process = os.getpid()
        self.files = []  #: command files of the run
        self.texts = []  #: (name, text) of those that are run
        self.fresh = fresh
        self.check = None  #: a tools.check.Check, where this run only checks
        self.force = force  #: run every operator, changed or not
        self.threads = threads
        self.ranks = None  #: processes that solve linear systems
        self.hosts = None  #: machines where those of PETSC run, as mpirun takes them
        self.verbose = verbose  #: operators say their phases and counts as they come
        self.quiet = False  #: of what is not a message nothing is printed
        self.strict_checks = strict_checks
        self.names = Names(provided or {})
        self.base = None
        self.open = False  #: between DEBUT or POURSUITE and FIN
        self.ended = ""  #: where FIN was
        self.alarm_is_error = False
        self.ignored_alarms = frozenset()
        self.alarms = 0
        self.checks = []
        self.stage = None  #: a stage.Stage, where this run is one in a sandbox
        self.written_units = {}  #: number -> path
        self._formats = {}  #: of files that this run wrote; text of any command is of RESULTAT
        self.missing_told = set()  #: units whose folder was not there before a computation
        self.earlier_units = {}  #: number -> (file, file written) before DEFI_FICHIER gave it another one; None: none
        self.plots = {}  #: (unit, format) -> tables.curves.Plot that this run draws there
        self.sources = set()  #: files that the study is made from, and never writes
        self.lost = {}
        self.killed = False  #: the run before this one ended without saving its plain Python data
        self.timings = Timings()
        self.orders = 0  #: number of orders so far
        self._emptied = False

    # ------------------------------------------------------------------------------------------- life

    def start(self, keywords, where, resume):
        """DEBUT, or with `resume` POURSUITE."""
        name = "POURSUITE" if resume else "DEBUT"
        if self.open:
            fail("STUDY_9", where, command=name)
        if self.base is None:
            self.base = Base(self.base_folder, kinds, where, make=not resume, fresh=self.fresh and not resume,
                             force=self.force)
            if resume:
                self.killed = bool(self.base.registry.get("running"))
                if self.base.registry.get("begun", {}).get("files") != self.files:  # otherwise they are run again after an error
                    self.base.registry["begun"] = {"files": self.files, "at": self.base.kept.stand()}
                self.sources.update(self.base.registry.get("sources", ()))
                self.lost = self.names.restore(self.base)
                self._explain_lost()
                for label, instant, made in self.base.unfinished.found():
                    self.inform("STUDY_31", where, label=label, instant=f"{instant:.9g}", made=made)
            else:
                self.names.forget_data(self.base)
                self.base.registry.pop("begun", None)
        elif not resume and self.fresh and not self._emptied:
            fail("STUDY_10", where)
        if not resume:
            unused_contacts.forget(self)
        self._emptied = True
        self.base.hold(where)
        self.open, self.ended = True, ""
        self.alarm_is_error = keywords["ERREUR"][0]["ALARME"] == "EXCEPTION"
        self.ignored_alarms = frozenset(keywords.get("IGNORE_ALARM", ()))

    def _explain_lost(self):
        builtins = self.names.values.get("__builtins__")
        if hasattr(builtins, "lost"):
            builtins.lost.update(self.lost)

    def finish(self, where):
        """FIN: save; remove what neither a name, nor a concept, nor a live Python object refers to."""
        if os.path.basename(where.rpartition(":")[0]) not in (name for name, _ in self.texts[:-1]):  # otherwise POURSUITE follows in this run
            unused_contacts.tell(self)
        self.base.registry.pop("begun", None)
        self.save()
        keep = set(self.base.registry["labels"].values())
        keep |= {i for i, item in self.base.live_objects() if not item.destroyed}
        self.base.clean(keep)
        self.open, self.ended = False, where

    def save(self):
        """Write what a later POURSUITE needs."""
        if self.base is not None:
            self.names.save(self.base)
            begun, stand = self.base.registry.get("begun", {}).get("at", {}), self.base.kept.stand()
            if all(stand.get(identifier) == at for identifier, at in begun.items()):  # nothing that these files changed is to be taken back
                self.base.registry.pop("begun", None)
            self.base.registry.update(running=False, sources=sorted(self.sources))
            self.base.write()

    def close(self, failed=False):
        """The end of the run, whatever brought it: save, and after FIN remove what no name refers to any more. A command that a thread of the command
        file is in comes to its end first; where the run has `failed` its operator is ended."""
        if os.getpid() != self.process:  # a process that the command file has forked: the base is that of the run
            return
        while not current.turn.acquire(timeout=0.05):
            if failed:
                orders.end_running()
        try:
            self._close()
        finally:
            self.open = False
            current.turn.release()

    def _close(self):
        try:
            if self.base is not None:
                self.save()
                if self.ended:
                    self.base.clean(set(self.base.registry["labels"].values()))
        finally:
            if self.base is not None:
                self.base.close()
                self.base = None

    def order_files(self, command):
        """Where the next order and its outcome go: in the base while the run lasts, or where LACON_ORDERS says, to stay."""
        if os.environ.get("LACON_ORDERS"):
            folder = pathlib.Path(os.environ["LACON_ORDERS"])
            folder.mkdir(parents=True, exist_ok=True)
        else:
            folder = self.base.orders()
        self.orders += 1
        stem = f"{self.orders:03d}-{command.lower()}"
        return folder / f"{stem}.order.json", folder / f"{stem}.status.json"

    # ------------------------------------------------------------------------------------------- messages

    def inform(self, identifier, where="", **values):
        """An alarm or an information from the Python side."""
        self.tell([message(identifier, where, **values)])

    def tell(self, items):
        """Messages that do not end the run, but those that the user has had enough of."""
        items = [item for item in items if item.id not in self.ignored_alarms]
        for item in items:
            show(item)
        self.count_alarms(items)

    def repeat_alarms(self, alarms, where):
        """Say the alarms of an operator that is not run again. @param alarms as Kept.alarms() gives them"""
        self.tell([Message(*alarm, where) for alarm in alarms])

    def count_alarms(self, items):
        """Count alarms that were shown. @throws AsterError where alarms are errors"""
        alarms = [m for m in items if m.severity == "A" and m.id not in self.ignored_alarms]
        self.alarms += len(alarms)
        if alarms and self.alarm_is_error:
            raise AsterError([m._replace(severity="F") for m in alarms], shown=False)

    # ------------------------------------------------------------------------------------------- units

    def input_unit(self, number, where):
        """The file of a unit that a command reads: one that was given, or that this run wrote."""
        path = self.written_units.get(number) or self.units.get(number)
        if path is None:
            fail("COMMAND_4", where, unit=number)
        _refuse_special(number, path, where)
        if not os.path.isfile(path) or not is_readable(path):
            fail("COMMAND_5", where, unit=number, file=path)
        return os.path.abspath(path)

    def has_read(self, path):
        """A command that ended well has read this file: a datum, unless this run wrote it."""
        if os.path.realpath(path) not in map(os.path.realpath, self.written_units.values()):
            self.protect(path)

    def output_unit(self, number, suffix, where):
        """The file of a unit that a command writes; beside the command file where none was given."""
        path = os.path.abspath(self.units.get(number, self.base_folder.parent / f"{self.base_folder.stem}.{number}{suffix}"))
        staged = self.stage and (number not in self.units or self.units[number] == self.given_units.get(number))
        if os.path.islink(path) and not staged:  # the link stays, and the file that it means is written
            path = os.path.realpath(path)
        folder = os.path.dirname(path)
        _refuse_special(number, path, where)
        if not os.path.isdir(folder) or not (staged or os.access(folder, os.W_OK)):
            fail("COMMAND_8", where, unit=number, file=path)
        if os.path.realpath(path) in self.sources:
            fail("COMMAND_12", where, unit=number, file=path)
        if self.keeps(path):
            fail("COMMAND_18", where, unit=number, file=path, base=self.base_folder)
        for other, written in self.written_units.items():
            if other != number and os.path.realpath(self.units.get(other, written)) == os.path.realpath(path):
                fail("COMMAND_17", where, unit=number, other=other, file=path)
        return self.stage.file(number, path) if staged else path

    def check_outputs(self, where):
        """Before a computation: a unit whose file can never be written is refused now, not behind it. A file that is there may be one that is read; a
        folder that is missing may be made by the command file: an alarm."""
        for number, path in sorted(self.units.items()):
            if number in self.written_units or os.path.isfile(path):
                continue
            folder = there = os.path.dirname(os.path.abspath(path))
            while not os.path.lexists(there):
                there = os.path.dirname(there)
            if os.path.isdir(path):  # a device may be a unit that nothing uses
                _refuse_special(number, path, where)
            if not (os.path.isdir(there) and (self.stage or os.access(there, os.W_OK | os.X_OK))):
                fail("COMMAND_8", where, unit=number, file=path)
            if there != folder and number not in self.missing_told:
                self.missing_told.add(number)
                self.inform("COMMAND_19", where, unit=number, file=path, folder=folder)

    def announced_output(self, number, suffix, where):
        """As output_unit(); says where the file goes when nobody gave one."""
        if number in self.written_units:
            return self.written_units[number]
        path = self.output_unit(number, suffix, where)
        if number not in self.units:
            self.inform("COMMAND_10", where, unit=number, file=os.path.relpath(self.base_folder.parent / os.path.basename(path)))
        return path

    def enter_format(self, number, path, form, where):
        """A command is about to write a unit in this format. @throws AsterError COMMAND_20 where this run has written another there, which would be lost"""
        before = self._formats.get(path, form)
        if number in self.written_units and before != form:
            fail("COMMAND_20", where, unit=number, file=path, before=before, form=form)
        self._formats[path] = form

    def is_terminal(self, number):
        """Unit 6 is the output of the run, as at code_aster, unless it has a file."""
        return number == 6 and number not in self.units

    def write_text(self, number, suffix, where, text):
        """Write a unit, or add to what this run has written there."""
        if self.is_terminal(number):
            print(text, end="")
            return
        path = self.announced_output(number, suffix, where)
        try:
            if number in self.written_units:
                with open(path, "rb") as file:
                    if file.read(4) == b"\x89HDF":
                        fail("COMMAND_13", where, unit=number, file=path)
                self.enter_format(number, path, "RESULTAT", where)
                with open(path, "a", encoding="utf-8") as file:
                    file.write(text)
            else:
                write_whole(path, text)
                self.enter_format(number, path, "RESULTAT", where)
        except OSError:
            fail("COMMAND_8", where, unit=number, file=path)
        self.written_units[number] = path

    def associate(self, number, path, append):
        """Give a unit another file, which is written anew unless `append`, until release()."""
        self.earlier_units.setdefault(number, (self.units.get(number), self.written_units.pop(number, None)))
        self.units[number] = os.path.abspath(path)
        self.written_units.pop(number, None)
        if append and os.path.isfile(path):
            self.written_units[number] = self.units[number]

    def release(self, number):
        """The unit has the file again that it had before associate()."""
        for units, before in zip((self.units, self.written_units), self.earlier_units.pop(number, ())):
            units.pop(number, None)
            if before is not None:
                units[number] = before

    def free_unit(self):
        """A unit that has no file."""
        return next((n for n in range(99, 0, -1) if n not in self.units and n not in self.written_units), None)

    def keeps(self, path):
        """Whether a file lies in the base, which nothing but commands writes."""
        return pathlib.Path(os.path.realpath(path)).is_relative_to(os.path.realpath(self.base_folder))

    def protect(self, path):
        """Results never replace this file, in this run and in those that go on with it: it is a datum of the study."""
        self.sources.add(os.path.realpath(path))

    # ------------------------------------------------------------------------------------------- names

    def destroy(self, items, where):
        """DETRUIRE: take concepts out of the study and out of its names."""
        for item in items:
            item.destroyed = where
        for name, value in list(self.names.user().items()):
            if isinstance(value, Concept) and value.destroyed:
                del self.names.values[name]
        self.names.update_labels(self.base)
        self.base.write(where)
        kept = set(self.base.registry["labels"].values()) | {i for i, item in self.base.live_objects() if not item.destroyed}
        kept |= self.base.unfinished.ids() - {item.id for item in items}
        self.base.clean(kept)

    def include(self, path):
        """Run a file with the names of this study, as if it stood where it is called."""
        execution.include(path, self.names.values)

    def progress(self, text):
        streams.take_back()
        if self.check is None and not self.quiet:
            print(text, flush=sys.stdout.isatty())
