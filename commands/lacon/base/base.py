"""A base: the folder of a study's concepts and its registry, docs/structures.md section 1.

The registry is replaced as a whole, after the concept it names is there: a killed run loses nothing that was done.
"""

import contextlib
import fcntl
import json
import os
import pathlib
import re
import shutil
import time
import weakref

from ..core.catalog import part
from ..core.concepts import concepts_in, dumps, type_of
from ..core.late import h5py
from ..core.messages import AsterError, NeedsRun, fail
from . import before, contents, kept, registry, seal
from .unfinished import Unfinished

_registry = registry.name
_orders = "orders.partial"
#: seconds after which an operator whose launcher is gone has ended
patience = 3.0
_tries, _pause = 20, 0.01  # seconds, until a folder that a run has just made is a base
_entry = re.compile(r"([a-z_]+_\d+)(\.h5)?(\.partial)?$")


def may_be_base(folder):
    """Whether a folder is a base, empty, or one that a full disk kept from having a registry."""
    return (folder / _registry).exists() or _has_no_more(folder)


def _has_no_more(folder):
    """Whether a folder has nothing but a registry and orders."""
    return all(path.name.startswith((_registry, _orders)) for path in folder.iterdir())


class Base:
    """An open base. One run at a time: the folder is locked until close()."""

    unsolved = ()  #: of `lacon check` a dictionary: id of a concept that is not really made -> its label, where it would be

    def __init__(self, folder, kinds, where, make, fresh=False, force=False):
        """Open `folder`. `make`: start one where there is none; `fresh`: empty the one that is there; `force`: take up nothing of it.

        @param kinds type of a concept -> class of its objects
        """
        self._start(folder, kinds)
        if self.folder.is_symlink() and not self.folder.exists():
            fail("STUDY_47", where, folder=self.folder, target=os.readlink(self.folder))
        if not self.folder.exists():
            if not make:
                fail("STUDY_2", where, folder=self.folder)
            try:
                self.folder.mkdir()
            except OSError as error:
                fail("STUDY_3", where, folder=self.folder, reason=error.strerror)
            self._made = True
        self._check_folder(where, fresh)
        self._take(where)
        self.kept = kept.Kept(self, look=not force)
        self.unfinished = Unfinished(self)
        try:
            if fresh:
                self._empty()
            elif (self.folder / _registry).exists():
                self._read(where)
                before.put_back_all(self)
                self.registry["labels"].update(self.unfinished.labels())
            elif not make:
                fail("STUDY_2", where, folder=self.folder)
            self.write(where)
        except BaseException:
            self.close()
            raise

    def _take(self, where):
        """Lock the folder. A launcher that has said its end lets it go within a moment, and so does the operator of one that is gone."""
        self.lock = os.open(self.folder, os.O_RDONLY)
        until = time.monotonic() + patience
        while True:
            try:
                fcntl.flock(self.lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
                return
            except BlockingIOError:
                holder = self._holder()
                if time.monotonic() < until and not (holder and _is_alive(holder["process"])):
                    time.sleep(0.05)
                    continue
                os.close(self.lock)
                others = ", ".join(_users_of(self.folder))
                if holder and not _is_alive(holder["process"]) and others:
                    fail("STUDY_46", where, folder=self.folder, process=holder["process"], since=holder["since"], others=others)
                who = part("run_of_process", **holder) if holder else others or part("run_of_no_process")
                fail("STUDY_5", where, folder=self.folder, who=who)

    def _holder(self):
        """{"process", "since"} of the run that is under way, as it has entered itself."""
        try:
            return registry.read(self.folder).get("running") or None
        except registry.Unreadable:
            return None

    def hold(self, where):
        """Enter this run as the one that is under way."""
        self.registry["running"] = {"process": os.getpid(), "since": time.strftime("%Y-%m-%d %H:%M:%S")}
        self.write(where)

    def _start(self, folder, kinds):
        """What every base has, one that is only read too."""
        self.kinds = kinds
        self.folder = pathlib.Path(os.path.abspath(folder))
        self.registry = registry.empty()
        self.unsolved = {}  #: of `lacon check`: id of a concept that is not really made -> its label, where it would be
        self._made = False
        self._references = {}  #: id -> state of its file, the ids in it
        self._objects = weakref.WeakValueDictionary()

    def _check_folder(self, where, fresh):
        """A folder that is not a base is left alone. One that is to be emptied has to show a registry of ours, or concepts beside a broken one."""
        if not self.folder.is_dir():
            fail("STUDY_4", where, folder=self.folder)
        if fresh and (self.folder / _registry).exists():
            try:
                registry.read(self.folder)
            except registry.Unreadable as error:
                if not self._is_ours(error.origin):
                    fail("STUDY_4", where, folder=self.folder)
        if not may_be_base(self.folder):
            fail("STUDY_4", where, folder=self.folder)

    def _is_ours(self, origin):
        """Whether this is a base, whose registry cannot be read. @param origin of registry.Unreadable"""
        if origin == "ours" or (origin == "blank" and _has_no_more(self.folder)):
            return True
        return origin in ("blank", "unknown") and any(seal.has_mark(self.path(identifier)) for identifier in self.ids())

    def _read(self, where):
        try:
            self.registry = registry.read(self.folder)
        except registry.Unreadable as error:
            fail("STUDY_6", where, file=self.folder / _registry, reason=error)

    def _empty(self):
        for path in self.folder.iterdir():
            if path.name.startswith((_registry, _orders)) or path.name == kept.folder or _entry.match(path.name):
                _remove(path)

    def write(self, where=""):
        """Replace the registry."""
        try:
            registry.write(self.folder, self.registry)
        except OSError as error:
            fail("STUDY_3", where, folder=self.folder, reason=error.strerror)

    def orders(self):
        """Folder of orders and of what operators say about them, there while a run lasts."""
        folder = self.folder / _orders
        folder.mkdir(exist_ok=True)
        return folder

    def close(self):
        """The run is over: remove its orders, let others in."""
        with contextlib.suppress(OSError):  # what cannot be written has been said
            _remove(self.folder / _orders)
        os.close(self.lock)

    # ------------------------------------------------------------------------------------------- concepts

    def path(self, identifier):
        """File of a concept; of a result, its index."""
        if type_of(identifier) == "result":
            return self.folder / identifier / "index.h5"
        return self.folder / f"{identifier}.h5"

    def failed_step(self, identifier):
        """File of the last iterates of the step at which the computation of a result failed; it may be there without the result."""
        return self.folder / identifier / contents.failed_step

    def open(self, identifier):
        if identifier in self.unsolved:
            raise NeedsRun(*self.unsolved[identifier])
        file = seal.open_checked(self.path(identifier))
        if (found := contents.holds(file) or identifier) != identifier:
            file.close()
            fail("BASE_7", file=self.path(identifier), found=found, expected=identifier)
        return file

    def concept(self, identifier, label=""):
        """The object of an id, the same one as long as anything holds it."""
        item = self._objects.get(identifier)
        if item is None:
            item = self._objects[identifier] = self.kinds[type_of(identifier)](self, identifier, label)
        return item

    def enter(self, item):
        """Make `item` the object of its concept."""
        self._objects[item.id] = item

    def live_objects(self):
        """(id, object) of every concept that Python still holds, in whatever variable."""
        return list(self._objects.items())

    def new_id(self, kind):
        """An id that no concept has; it counts once the registry is written."""
        number = self.registry["next"]
        while any((self.folder / name).exists() for name in (f"{kind}_{number}.h5", f"{kind}_{number}")):
            number += 1
        self.registry["next"] = number + 1
        return f"{kind}_{number}"

    def drop(self, identifier):
        """Remove what is there of a concept that was not finished, or that nothing refers to."""
        for path in (self.folder / f"{identifier}.h5", self.folder / f"{identifier}.h5.partial", self.folder / identifier):
            _remove(path)
        self._objects.pop(identifier, None)
        self.kept.forget(identifier)
        self.unfinished.end(identifier)

    def give_back(self, identifier):
        """Drop a concept that was not finished; its number, which nobody has seen, is the next one's again."""
        self.drop(identifier)
        number = int(identifier.rpartition("_")[2])
        if number == self.registry["next"] - 1:
            self.registry["next"] = number

    def drop_partial(self):
        """Remove what killed operators left."""
        for path in list(self.folder.rglob("*.partial")):
            if path.name != _orders:
                _remove(path)

    def write_concept(self, kind, label, command, keywords, fill, reused=None):
        """A concept that Python makes itself. `fill(file)` writes what is particular to it; it replaces the content of `reused`. @return its object"""
        identifier = reused.id if reused else self.new_id(kind)
        path = self.path(identifier)
        partial = path.with_name(path.name + ".partial")
        version = 1
        if reused:
            with reused.open() as file:
                version = int(file.attrs["version"]) + 1
        try:
            # in memory first: HDF5 does not survive a disk that is full
            with h5py.File(partial, "w", driver="core", backing_store=False) as file:
                attributes = {
                    "lacon_type": kind, "format": 1, "version": version, "id": identifier, "label": label, "command": command,
                    "keywords": dumps(keywords),
                    "references": json.dumps([c.id for c in concepts_in(keywords)] if kind in ("material", "formula") else []),
                }
                for name, value in attributes.items():
                    file.attrs[name] = value
                fill(file)
                file.flush()
                image = file.id.get_file_image()
            partial.write_bytes(image + seal.of(image))
            key = kept.file_key(partial)
            found = None if reused else self.kept.find(kind, key)
            if found:
                partial.unlink()
                self.give_back(identifier)
                return self.concept(found, label)
            os.replace(partial, path)
        except OSError as error:
            with contextlib.suppress(OSError):
                partial.unlink()
            fail("STUDY_3", folder=self.folder, reason=error.strerror or error)
        self.kept.enter(identifier, key)
        return self.concept(identifier, label)

    def ids(self):
        """Ids of all concepts that are there."""
        found = []
        for path in self.folder.iterdir():
            match = _entry.match(path.name)
            if match and not match[3] and self.is_there(match[1]):
                found.append(match[1])
        return found

    def is_there(self, identifier):
        """A concept has this id, and its file."""
        kind, _, number = identifier.rpartition("_")
        return kind in self.kinds and number.isdigit() and self.path(identifier).exists()

    def references(self, identifier):
        """Ids that a concept's file refers to."""
        there = os.stat(self.path(identifier))
        state = there.st_size, there.st_mtime_ns
        known = self._references.get(identifier)
        if not known or known[0] != state:
            with self.open(identifier) as file:
                texts = [v for k, v in file.attrs.items() if isinstance(v, str) and k not in ("id", "label", "keywords", "command")]
            known = self._references[identifier] = state, frozenset(word for text in texts for word in re.findall(r"[a-z_]+_\d+", text))
        return known[1]

    def clean(self, keep):
        """Remove every concept that none of the ids `keep` refers to, directly or not, and leftovers. @return removed ids"""
        present = set(self.ids())
        reached, queue = set(), [i for i in keep if i in present]
        while queue:
            identifier = queue.pop()
            if identifier not in reached:
                reached.add(identifier)
                queue += [i for i in self.references(identifier) if i in present]
        removed = sorted(present - reached)
        for identifier in removed:
            self.drop(identifier)
        self.kept.clean(reached)
        self._clean_results(reached)
        self.drop_partial()
        return removed

    def _clean_results(self, reached):
        """Remove folders without index and field files that no index names."""
        named = set()
        for identifier in reached:
            if type_of(identifier) == "result":
                with self.open(identifier) as file:
                    named |= contents.field_files(file)
                named |= self.kept.fields(identifier)
        for folder in self.folder.iterdir():
            if folder.is_dir() and _entry.match(folder.name) and folder.name not in self.unfinished.ids():
                if folder.name not in reached:
                    _remove(folder)
                    continue
                for path in folder.glob("*.h5"):
                    field = path.name.replace(".masters.h5", ".h5")  # what lies beside a field goes with it
                    if path.name not in ("index.h5", contents.failed_step) and f"{folder.name}/{field}" not in named:
                        _remove(path)


class ReadBase(Base):
    """A base that is looked at: not locked, not changed."""

    def __init__(self, folder, where, kinds=()):
        """@param kinds as of Base; without them for who reads files alone. @throws AsterError READER_7, STUDY_6"""
        self._start(folder, kinds)
        if not (self.folder / _registry).is_file():
            fail("READER_7", where, folder=self.folder)
        self._read(where)
        self.unfinished = Unfinished(self)

    def running(self):
        """{"process", "since"} of the run that is under way now; nothing where there is none."""
        holder = self._holder()
        return holder if holder and _is_alive(holder["process"]) else None

    def needs(self, path):
        """Whether a file is one of this folder, or one that its study reads: no tool may replace it."""
        path = os.path.realpath(path)
        return pathlib.Path(path).is_relative_to(os.path.realpath(self.folder)) or path in self.registry.get("sources", ())

    def labels(self, kind):
        """label -> id, of the concepts of a type that are there, results in progress among them; plain variables first, then elements of lists."""
        labels = {**self.registry["labels"], **self.unfinished.labels()}
        return {label: labels[label] for label in sorted(labels, key=lambda label: not label.isidentifier())
                if type_of(labels[label]) == kind and self.path(labels[label]).exists()}

    def labelled(self, kind):
        """label -> concept, likewise; one of several labels has the first one."""
        return {label: self.concept(identifier, label) for label, identifier in self.labels(kind).items()}

    def label_of(self, identifier):
        """The first label of a concept, empty where it has none."""
        return next((label for label, known in self.labels(type_of(identifier)).items() if known == identifier), "")


def once(labelled):
    """Of label -> thing each one under its first label alone. A thing is the same where its id is."""
    found = {}
    for label, thing in labelled.items():
        found.setdefault(thing.id, (label, thing))
    return dict(found.values())


def look_into(folder, where):
    """The base as it is now, to be read; its run may be about to make it. @throws AsterError as ReadBase"""
    for _ in range(_tries):
        try:
            return ReadBase(folder, where)
        except AsterError:
            if not os.path.isdir(folder):
                raise
            time.sleep(_pause)
    return ReadBase(folder, where)


def _users_of(folder):
    """"stat_non_line (process 4712)": other processes that have a folder open, as far as this user may see them."""
    about = os.stat(folder)
    for process in pathlib.Path("/proc").glob("[0-9]*"):
        with contextlib.suppress(OSError):
            if int(process.name) != os.getpid() and any(_is_same(link, about) for link in (process / "fd").iterdir()):
                yield part("name_of_process", name=(process / "comm").read_text(errors="replace").strip(), process=process.name)


def _is_same(path, about):
    try:
        return os.path.samestat(os.stat(path), about)
    except OSError:  # closed meanwhile, or no file
        return False


def _is_alive(process):
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        pass  # another user's
    return True


def _remove(path):
    if path.is_dir() and not path.is_symlink():
        shutil.rmtree(path)
    else:
        with contextlib.suppress(FileNotFoundError):
            path.unlink()
