"""What need not be made again: concepts of an earlier run whose order, and everything it depends on, have not changed.

The key of a concept that an operator made is a digest of its complete order, the content of the files it read, the keys of every
concept that its order reaches, and the versions of operator, plug-ins and catalogue. References go by id, so a concept is kept only
together with those it refers to: their ids are part of its key. Commands that Python does itself always run; where they make what
is there already, the concept that is there keeps its id.

`reuse=` makes versions of one id. Each keeps its file (a hard link in the folder kept/ of the base) as long as the concept is there, so
that a later run can go back to the first and forward again from it.

Registry, key "made": id -> list of versions, each {"key", "stat" (size and time of its file), "fields" (the same of
each field file of a result), "references", "alarms"}.
"""

import functools
import hashlib
import json
import os
import pathlib
import re
import sys

from .. import version
from ..core import catalog, plugins
from ..core.concepts import type_of
from ..core.files import link
from . import contents, names, seal, steady

#: of the base: versions of concepts that were changed in place
folder = "kept"


class Kept:
    """The records of one open base, and where this run stands in each concept's versions."""

    def __init__(self, base, look=True):
        self.base = base
        self.look = look  #: False: everything is made anew (--force)
        self._at = {}  #: id -> version that this run has reached; ids that it has not met are free to be taken up

    @property
    def _made(self):
        return self.base.registry.setdefault("made", {})

    # ------------------------------------------------------------------------------------------- keys

    def _record(self, identifier):
        """The version of a concept that is in force; nothing for one whose making is not known."""
        versions = self._made.get(identifier, ())
        if identifier in self._at:
            at = self._at[identifier]
            return versions[at] if at >= 0 else None
        at = self._in_force(identifier, versions)  # a run that was killed may have left any of them
        return None if at is None else versions[at]

    def _reached(self, identifiers):
        """{id: key} of these concepts and of all that they refer to. @return nothing where a key is not known"""
        found, queue = {}, list(identifiers)
        while queue:
            identifier = queue.pop()
            if identifier in found:
                continue
            record = self._record(identifier)
            if record is None:
                return None
            found[identifier] = record["key"]
            queue += record["references"]
            if type_of(identifier) == "formula":
                now = self._formula(identifier)
                if now is None:
                    return None
                found[identifier] += now[0]
                queue += now[1]
        return found

    def _formula(self, identifier):
        """(digest of the values that the names of a formula have now, ids among them); nothing where they may change by themselves."""
        expression = self.base.concept(identifier).expression()
        if expression.lost or not steady.is_expression(expression.text):
            return None
        try:
            values = json.dumps({k: names.encode(v) for k, v in expression.values.items()}, sort_keys=True)
        except (names.NotKept, RecursionError):
            return None
        if not steady.are_values(expression.text, values):
            return None
        return _digest(values), re.findall(r'\{"concept": "([^"]*)"\}', values)

    def order_key(self, order, program, files):
        """The key of what an order makes, None where there is none. @param files those that it reads"""
        if any(_stat(path) is None for path in (program, *files.values())):
            return None
        result, keywords = order["result"], order["keywords"]
        if result["reuse"]:
            inputs = [*_concept_ids(keywords), result["id"]]
        else:  # CO() names the result itself among the keywords
            keywords = {k: v for k, v in keywords.items() if v != {"concept": result["id"]}}
            inputs = _concept_ids(keywords)
        reached = self._reached(inputs)
        if reached is None:
            return None
        try:
            read = {unit: [pathlib.Path(path).stem, _of_file(path)] for unit, path in files.items()}
        except OSError:  # a disk that fails: the operator says which file it cannot read
            return None
        return _digest({
            "command": order["command"], "keywords": keywords, "label": result["label"], "reuse": result["reuse"],
            "inputs": reached, "program": _of_program(program), "version": _version(),
            "files": read,
        })

    def stand(self):
        """id -> the version that its file holds."""
        return {identifier: at for identifier, versions in self._made.items()
                if (at := self._in_force(identifier, versions)) is not None}

    def _in_force(self, identifier, versions):
        there = _stat(self.base.path(identifier))
        return next((at for at, record in enumerate(versions) if record["stat"] == there), None)

    def key_of_change(self, identifier, make_key):
        """The key of an order that changes a concept. Where a run of the same command files was ended in this order, or behind it, the
        concept goes back to what it was before, so that the order finds what it has made, or begun."""
        if self.look and identifier not in self._at:
            versions, begun = self._made.get(identifier, ()), self.base.registry.get("begun", {}).get("at", {}).get(identifier)
            before = self.base.unfinished.version(identifier)
            if begun is not None and begun + 1 < len(versions):
                before.append((begun, versions[begun + 1]["key"]))
            for at, wanted in before:
                self._at[identifier] = at
                if wanted is not None and make_key() == wanted and self._restore(identifier, at):
                    return wanted
                del self._at[identifier]
        return make_key()

    # ------------------------------------------------------------------------------------------- finding

    def find(self, kind, key, silent=False):
        """The id of a concept of an earlier run whose first version has this key; it is put back to that version.

        @param silent  only one that was made without alarms
        """
        if not self.look or key is None:
            return None
        for identifier, versions in self._made.items():
            if (versions[0]["key"] == key and type_of(identifier) == kind and identifier not in self._at
                    and not (silent and versions[0]["alarms"]) and self._restore(identifier, 0)):
                return identifier
        return None

    def find_next(self, identifier, key, silent=False):
        """True where the next version of a concept has this key; the concept is then brought to it. Otherwise later versions go."""
        versions, at = self._made.get(identifier, ()), self._at.get(identifier)
        if at is None:
            return False
        following = versions[at + 1:at + 2]
        if (self.look and key is not None and following and following[0]["key"] == key and not (silent and following[0]["alarms"])
                and self._restore(identifier, at + 1)):
            return True
        self._cut(identifier, at + 1)
        return False

    def _cut(self, identifier, first):
        """Drop the versions of a concept from `first` on."""
        versions = self._made.get(identifier, [])
        for at in range(first, len(versions)):
            _unlink(self._copy(identifier, at))
        del versions[first:]

    def alarms(self, identifier):
        """[[severity, id, text, remedy]] of the alarms with which the version in force was made."""
        return self._record(identifier)["alarms"]

    def _restore(self, identifier, at):
        """Put a version of a concept in its place. @return false where its files are not as they were left"""
        record, path = self._made[identifier][at], self.base.path(identifier)
        source = path if _stat(path) == record["stat"] else self._copy(identifier, at)
        if _stat(source) != record["stat"] or self._field_stats(identifier, source) != record.get("fields"):
            return False
        if source != path:
            link(source, path)
        self._at[identifier] = at
        return True

    def _field_stats(self, identifier, path):
        """Size and time of each field file that a version of a result names; None for another concept."""
        return {name: _stat(self.base.folder / name) for name in _fields(path)} if type_of(identifier) == "result" else None

    # ------------------------------------------------------------------------------------------- entering

    def enter(self, identifier, key, messages=()):
        """Remember how a concept was made that is there now; with a key of None, that it is not known."""
        self.forget(identifier)
        self._add(identifier, key, messages)

    def hold(self, identifier):
        """The file of a concept is about to be replaced, perhaps by one that is not whole: the version that it holds stays in kept/.

        @return its number, nothing for one whose making is not known
        """
        at = self._in_force(identifier, self._made.get(identifier, ()))
        if at is not None:
            link(self.base.path(identifier), self._copy(identifier, at))
        return at

    def leave(self, identifier):
        """What a concept holds now is none of its versions, which stay for a run that makes them again."""
        self._at[identifier] = -1

    def enter_next(self, identifier, before, key, messages):
        """Remember a new version of a concept. @param before a copy of the file of the version before, which goes to kept/"""
        versions = self._made.get(identifier, [])
        there = _stat(before)
        at = next((i for i, record in enumerate(versions) if record["stat"] == there), None)
        if at is None or key is None:
            self.forget(identifier)
            self._at[identifier] = -1
            return
        self._cut(identifier, at + 1)
        link(before, self._copy(identifier, at))
        self._add(identifier, key, messages)
        link(self.base.path(identifier), self._copy(identifier, at + 1))

    def _add(self, identifier, key, messages):
        self._at[identifier] = -1
        if key is None:
            return
        alarms = [[m.severity, m.id, m.text, m.do] for m in messages if m.severity == "A"]
        fields = self._field_stats(identifier, self.base.path(identifier))
        record = {"key": key, "stat": _stat(self.base.path(identifier)), "alarms": alarms,
                  **({"fields": fields} if fields is not None else {}), "references": sorted(i for i in self.base.references(identifier) if i != identifier and self.base.is_there(i))}
        versions = self._made.setdefault(identifier, [])
        versions.append(record)
        self._at[identifier] = len(versions) - 1

    def forget(self, identifier):
        """A concept is gone, or is about to be made anew."""
        self._at.pop(identifier, None)
        for at in range(len(self._made.pop(identifier, ()))):
            _unlink(self._copy(identifier, at))

    def clean(self, present):
        """Forget every concept that is no longer there."""
        for identifier in [i for i in self._made if i not in present]:
            self.forget(identifier)
        copies = self.base.folder / folder
        if copies.is_dir() and not any(copies.iterdir()):
            copies.rmdir()

    def fields(self, identifier):
        """Field files that a version of a result names."""
        return {name for at in range(len(self._made.get(identifier, ()))) for name in _fields(self._copy(identifier, at))}

    def _copy(self, identifier, at):
        return self.base.folder / folder / f"{identifier}.{at}.h5"


def file_key(path):
    """A digest of a concept's file without what names the concept itself."""
    digest = hashlib.blake2b(digest_size=20)

    def attributes(name, item):
        for key in sorted(item.attrs):
            if name or key != "id":
                digest.update(f"{name}@{key}={_listed(item.attrs[key])!r};".encode())

    def visit(name, item):
        attributes(name, item)
        if hasattr(item, "dtype"):
            value = item[()]
            digest.update(f"{name}:{item.dtype}{item.shape};".encode())
            digest.update(value.tobytes() if hasattr(value, "tobytes") and not value.dtype.hasobject else repr(_listed(value)).encode())

    with seal.open_checked(path) as file:
        attributes("", file)
        file.visititems(visit)
    return digest.hexdigest()


def _listed(value):
    return value.tolist() if hasattr(value, "tolist") else value


def _digest(value):
    return hashlib.blake2b(json.dumps(value, sort_keys=True).encode(), digest_size=20).hexdigest()


def _concept_ids(value):
    """Ids in the keywords of an order."""
    if isinstance(value, dict):
        return [value["concept"]] if set(value) == {"concept"} else [i for v in value.values() for i in _concept_ids(v)]
    return [i for v in value for i in _concept_ids(v)] if isinstance(value, list) else []


@functools.cache
def _content(path, size, time):
    digest = hashlib.blake2b(digest_size=20)
    with open(path, "rb") as file:
        while block := file.read(1 << 20):
            digest.update(block)
    return digest.hexdigest()


def _of_file(path):
    """A digest of a file's content."""
    return _content(os.path.realpath(path), *_stat(path))


@functools.cache
def _of_program(path):
    """What tells versions of a program or plug-in apart: the number that the linker gave it, else a digest of its content.

    To read megabytes of a program would take longer than to run a small one.
    """
    with open(path, "rb") as file:
        head = file.read(4096)
    note = head.find(b"\x03\0\0\0GNU\0") if head.startswith(b"\x7fELF") else -1
    length = int.from_bytes(head[note - 4:note], sys.byteorder) if note >= 8 else 0
    number = head[note + 8:note + 8 + length]
    return number.hex() if 8 <= length == len(number) else _of_file(path)


#: packages of the launcher that have a part in what an operator makes: they evaluate its formulae, and the functions in them
_evaluating = ("base", "objects")


@functools.cache
def _version():
    """What beside the operator itself decides what it makes: catalogue, plug-ins, the launcher's part in formulae."""
    there = catalog.location()
    files = [there] if there.is_file() else sorted(there.rglob("*.toml"))
    files += [path for folder in plugins.plugin_folders() for path in sorted(folder.rglob("*")) if path.is_file()]
    files += [path for package in _evaluating for path in sorted((pathlib.Path(__file__).parents[1] / package).glob("*.py"))]
    return [version, *map(_of_program, files)]


def _stat(path):
    """[size, time of the last change], by which a file is known again; nothing where it is not there."""
    try:
        found = os.stat(path)
        return [found.st_size, found.st_mtime_ns]
    except OSError:
        return None


def _fields(index):
    """Field files that an index of a result names."""
    if not index.is_file():
        return set()
    with seal.open_checked(index) as file:
        return contents.field_files(file)


def _unlink(path):
    path.unlink(missing_ok=True)
