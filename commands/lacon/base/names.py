"""The Python names of a command file: which concepts they hold, and what of them a later POURSUITE finds again.

Kept: concepts, numbers, strings, lists, tuples, dicts and sets of such, numpy arrays, modules and what is imported from them. A name
that cannot be kept is remembered with the reason, and said where it is first used.
"""

import ast
import base64
import builtins
import importlib
import io
import itertools
import math
import re
import sys
import types

from ..core.concepts import CO, Concept, _F
from ..core.late import numpy
from ..core.messages import message

_atoms = (type(None), bool, int, str)
_moved = {"lacon.functions": "lacon.base.functions"}  # modules of the launcher, as bases of earlier versions name them
_scalars = {type(None), bool, int, float, str, bytes, complex}


class NotKept(Exception):
    """A value that cannot be kept, and why."""


class LostName(NameError):
    """A name of the saved study that could not be kept, at its first use."""

    def __init__(self, item):
        super().__init__(item.text)
        self.item = item


class Builtins(dict):
    """Python's built-in names, with an explanation for those that a saved study lost."""

    def __init__(self, lost):
        super().__init__(vars(builtins))
        self.lost = lost

    def __missing__(self, name):
        if name in self.lost:
            raise LostName(message("STUDY_8", name=name, why=self.lost[name]))
        raise KeyError(name)


def root(label):
    """"MA[0][1]" -> "MA\""""
    return re.split(r"[\[.]", label, maxsplit=1)[0]


def concepts_of(name, value, seen=()):
    """(label, concept) of every concept that `value`, called `name`, holds in lists, tuples and dicts."""
    if isinstance(value, Concept):
        yield name, value
    elif isinstance(value, (list, tuple, dict)) and id(value) not in seen and len(seen) < 50:
        items = list(value.items()) if isinstance(value, dict) else enumerate(value)
        if not isinstance(value, dict) and _plain(value):
            return
        for key, item in items:
            if type(item) not in _scalars:
                yield from concepts_of(f"{name}[{key!r}]", item, (*seen, id(value)))


def _holds(value, wanted):
    """Whether a list, tuple or dict has this object, itself or in those it holds."""
    if not isinstance(value, (list, tuple, dict)):
        return False
    return any(item is wanted or _holds(item, wanted) for item in (value.values() if isinstance(value, dict) else value))


def _plain(items):
    """True where a list holds numbers and texts only, or lists of such: quickly, for there may be a million."""
    kinds = set(map(type, items))
    return kinds <= _scalars or (kinds <= {list, tuple} and set(map(type, itertools.chain.from_iterable(items))) <= _scalars)


# ---------------------------------------------------------------------------------------------------- encoding


def encode(value, seen=()):
    """A value as JSON. @throws NotKept"""
    if isinstance(value, Concept):
        if value.destroyed:
            raise NotKept(f"its concept was destroyed at {value.destroyed}")
        return {"concept": value.id}
    if type(value) in _atoms:
        return value
    if type(value) is float:
        return value if value - value == 0 else {"float": repr(value)}
    if id(value) in seen:
        raise NotKept("it contains itself")
    seen = (*seen, id(value))
    if type(value) in (list, tuple, set, frozenset):
        kinds = set(map(type, value))  # lists of a million numbers go as they are
        plain = kinds <= {int, bool, str, type(None)} or (kinds == {float} and all(map(math.isfinite, value)))
        return {type(value).__name__: list(value) if plain else [encode(item, seen) for item in value]}
    if type(value) in (dict, _F):
        return {"dict": [[encode(k, seen), encode(v, seen)] for k, v in list(value.items())]}
    if type(value) is complex:
        return {"complex": [value.real, value.imag]}
    if type(value) is bytes:
        return {"bytes": base64.b64encode(value).decode()}
    if type(value) is range:
        return {"range": [value.start, value.stop, value.step]}
    if isinstance(value, types.ModuleType):
        if value.__name__ in sys.modules:
            return {"module": value.__name__}
        raise NotKept("it is a module that cannot be imported by name")
    if "numpy" in sys.modules and (type(value) is numpy.ndarray or isinstance(value, numpy.generic)):
        if value.dtype.hasobject:
            raise NotKept("it is an array of Python objects")
        stream = io.BytesIO()
        numpy.save(stream, value, allow_pickle=False)
        return {"npy": base64.b64encode(stream.getvalue()).decode(), "scalar": isinstance(value, numpy.generic)}
    return _encode_import(value)


def _encode_import(value):
    """Functions and classes of importable modules; nothing else is left."""
    module, name = getattr(value, "__module__", None), getattr(value, "__qualname__", None)
    if isinstance(value, (type, types.FunctionType, types.BuiltinFunctionType)) or type(value).__name__ == "ufunc":
        name = name or getattr(value, "__name__", None)
        module = module or "numpy"
        home = sys.modules.get(module)
        if module not in ("__main__", "builtins") and name and getattr(home, name, None) is value:
            return {"import": [module, name]}
    if isinstance(value, types.FunctionType):
        raise NotKept("it is a function of the command file, and functions are not saved")
    if isinstance(value, CO):
        raise NotKept(f"it is {value!r}, and no command has made its concept")
    if isinstance(value, type):
        raise NotKept("it is a class of the command file, and classes are not saved")
    raise NotKept(f"it is a {type(value).__name__}, and only concepts, numbers, strings, lists, tuples, dicts and arrays are saved")


def decode(data, base):
    """A value from its JSON. @throws NotKept where its module is gone"""
    if not isinstance(data, dict):
        return data
    kind, content = next(iter(data.items()))
    if kind == "concept":
        if not base.is_there(content):
            raise NotKept(f"the concept {content} is no longer in the base")
        return base.concept(content)
    if kind == "float":
        return float(content)
    if kind in ("list", "tuple", "set", "frozenset"):
        make = {"list": list, "tuple": tuple, "set": set, "frozenset": frozenset}[kind]
        return make(decode(item, base) for item in content)
    if kind == "dict":
        return {decode(k, base): decode(v, base) for k, v in content}
    if kind == "complex":
        return complex(*content)
    if kind == "bytes":
        return base64.b64decode(content)
    if kind == "range":
        return range(*content)
    if kind == "npy":
        array = numpy.load(io.BytesIO(base64.b64decode(content)), allow_pickle=False)
        return array[()] if data["scalar"] else array
    try:
        if kind == "module":
            return importlib.import_module(content)
        return getattr(importlib.import_module(_moved.get(content[0], content[0])), content[1])
    except Exception as error:
        raise NotKept(f"its module cannot be imported: {error}") from error


# ---------------------------------------------------------------------------------------------------- the study's names


class Names:
    """The namespace that all files of a run share, and its image in the base's registry."""

    def __init__(self, provided):
        self.provided = dict(provided)
        self.values = dict(provided)
        self._known = set()  #: names of this run so far
        self._pending = None  #: label of a concept that was not assigned yet when it was entered
        self._lost = {}
        self._seen = None  #: all names as they were when the labels were last brought up to date; None where more than names says what these are
        self._named = set()  #: ids that these have
        self._boxes = []  #: (name, value) of those that may come to hold concepts while their name stays

    def user(self):
        """name -> value of what the command files made"""
        missing = object()
        return {k: v for k, v in list(self.values.items())  # a thread of the command file may assign meanwhile
                if not k.startswith("__") and self.provided.get(k, missing) is not v}

    def taken(self, name, co):
        """What a variable of this name holds where publish() cannot give it to the concept: no concept, and nothing with `co` in it. Otherwise None."""
        held = self.values.get(name)
        return None if isinstance(held, (Concept, CO)) or _holds(held, co) else held

    def publish(self, name, concept):
        """Make the name given with CO() a variable; one that holds a concept gets the new one, as if it were assigned."""
        if name.isidentifier() and isinstance(self.values.setdefault(name, concept), (Concept, CO)):
            self.values[name] = concept

    def update_labels(self, base, pending=None):
        """Bring the registry's labels up to date; `pending` = (label, id) of a concept that is not assigned yet.

        Labels of an earlier run stay until their variable is assigned again. @return true where the registry changed
        """
        new = self._new_concepts(base)
        if new is None:
            return self._update_all_labels(base, pending)
        labels, before = base.registry["labels"], self._pending
        entered = {name: item.id for name, item in new.items()}
        for name, item in new.items():
            item.label = name
        if pending and pending[0]:
            entered[pending[0]] = pending[1]
        self._pending = pending[0] if pending else None
        changed = any(labels.get(label) != identifier for label, identifier in entered.items())
        if before is not None and before not in entered:  # it was never assigned
            changed |= labels.pop(before, None) is not None
        labels.update(entered)
        return changed

    def _new_concepts(self, base):
        """Thousands of functions or loads are made one after the other, and looking at all names at each of them would take its square.

        @return name -> concept, where nothing else has come since the last time that concerns labels; otherwise None
        """
        if self._seen is None or self._pending in self._seen or any(True for box in self._boxes for _ in concepts_of(*box)):
            return None
        fresh = [(name, value) for name, value in list(self.values.items()) if self._seen.get(name, self) is not value]
        labels, values = base.registry["labels"], base.registry["namespace"].get("values", {})
        new = {}
        for name, value in fresh:
            is_concept = isinstance(value, Concept)
            if isinstance(value, (list, tuple, dict)) or name.startswith("__") or name in values:
                return None
            if not is_concept and not isinstance(self._seen.get(name), (Concept, list, tuple, dict)):
                continue  # plain before and now, as the variable of a loop
            if not is_concept or name in self._seen or value.destroyed or value.id in self._named:
                return None
            if labels.get(name, value.id) != value.id:
                return None
            new[name] = value
            self._named.add(value.id)
        self._seen.update(fresh)
        self._known.update(name for name, _ in fresh)
        return new if len(self._seen) == len(self.values) else None

    def _update_all_labels(self, base, pending):
        user = self.user()
        labels, containers, named = {}, {}, set()
        # a variable of its own names a concept before a list that has it, whichever came first
        for name, value in sorted(user.items(), key=lambda item: not isinstance(item[1], Concept)):  # twice a command: names that mean no more than one concept, of which there may be thousands, go quickly
            alone = isinstance(value, Concept)
            if alone or isinstance(value, (list, tuple, dict)):
                found = [(label, c) for label, c in ([(name, value)] if alone else concepts_of(name, value)) if not c.destroyed]
                for label, item in found:
                    labels[label] = item.id
                    if item.id not in named:  # of several variables the first one is its name
                        named.add(item.id)
                        item.label = label
                if found and not alone:
                    try:
                        containers[name] = encode(value)
                    except (NotKept, RecursionError):
                        pass  # said when the names are saved
        gone = self._known | set(user)
        self._known = set(user) | self._known
        if pending and pending[0]:
            labels[pending[0]] = pending[1]
        registry = base.registry
        old = {k: v for k, v in registry["labels"].items() if k not in gone and root(k) not in gone and k != self._pending}
        self._pending = pending[0] if pending else None
        # plain data stays as it was last saved: that is what is left of it when the run is killed
        values = {k: v for k, v in registry["namespace"].get("values", {}).items()
                  if k not in gone or (k in user and not isinstance(user[k], Concept))}
        new = {**old, **labels}
        values.update(containers)
        space = {"values": values, "lost": registry["namespace"].get("lost", {})}
        changed = new != registry["labels"] or space != registry["namespace"]
        registry["labels"], registry["namespace"] = new, space
        self._seen, self._named = (None if old or containers else dict(self.values)), named
        self._boxes = [(name, value) for name, value in user.items() if isinstance(value, (list, tuple, dict))]
        return changed

    def forget_data(self, base):
        """DEBUT: plain data and lost names of an earlier run do not come back; its concepts do."""
        space = base.registry["namespace"]
        kept = {k: v for k, v in space.get("values", {}).items() if any(root(label) == k for label in base.registry["labels"])}
        base.registry["namespace"] = {"values": kept, "lost": {}}

    def save(self, base):
        """Enter everything that a later POURSUITE needs in the registry."""
        self.update_labels(base)
        space = base.registry["namespace"]
        user = self.user()
        for name in user:
            space["lost"].pop(name, None)
        for name, why in self._lost.items():
            if name not in user:
                space["lost"][name] = why
        for name, value in user.items():
            if isinstance(value, Concept) and not value.destroyed:
                space["values"].pop(name, None)
                continue
            try:
                space["values"][name] = encode(value)
            except (NotKept, RecursionError) as reason:
                space["values"].pop(name, None)
                space["lost"][name] = str(reason)

    def restore(self, base):
        """Bring back what an earlier run saved. @return names that could not be, with the reason"""
        labels, space = base.registry["labels"], base.registry["namespace"]
        lost = dict(space.get("lost", {}))
        for label, identifier in labels.items():
            if base.path(identifier).exists():
                if root(label) == label:
                    self.values[label] = base.concept(identifier, label)
            else:
                lost[root(label)] = f"its concept {identifier} is no longer in the base"
        for name, data in space.get("values", {}).items():
            try:
                self.values[name] = decode(data, base)
            except NotKept as reason:
                lost[name] = str(reason)
        self._place_elements(base)
        self.update_labels(base)
        self._lost = {k: v for k, v in lost.items() if k not in self.values}
        return self._lost

    def _place_elements(self, base):
        """Concepts whose label is an element, "MA[1]": a killed run may have made them after it last saved their list."""
        for label, identifier in base.registry["labels"].items():
            match = re.fullmatch(r"(\w+)\[(-?\d+|'[^']*')\]", label)
            if not match or not base.path(identifier).exists():
                continue
            name, key = match[1], ast.literal_eval(match[2])
            holder = self.values.setdefault(name, [] if key == 0 else {})
            if isinstance(holder, dict):
                holder.setdefault(key, base.concept(identifier, label))
            elif isinstance(holder, list) and key == len(holder):
                holder.append(base.concept(identifier, label))
