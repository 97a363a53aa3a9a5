"""Keywords of one command against the catalogue: what is wrong with them, and the complete set.

Every problem of a call is found, not only the first. Paths are those of messages: DEFI_CONTACT/ZONE[1]/GROUP_MA_ESCL; occurrences
of a factor keyword that may be repeated are counted from 1.
"""

import math
import operator
import os
import re

from . import catalog, plugins
from .concepts import CO, Concept, types
from .messages import message
from .nearest import nearest

#: type of a value -> the part that names it
_names = {"group_ma": "name_of_cells", "group_no": "name_of_nodes", "cell": "name_of_cell", "node": "name_of_node", "scalar": "number_or_text", "text": "a_text",
          "integer": "an_integer", "real": "a_number"}


_largest_count = 2**31 - 1  # of what is counted: iterations, steps, cells


def complete(command, row, given, where=""):
    """@return (keywords with every default, in the order of the catalogue; problems, a list of messages; alarms, likewise)"""
    check = _Check(where, row.get("largest"))
    keywords = check.occurrence(command, row, given)
    return keywords, check.problems, check.alarms


def problems_of(path, keyword, value, where=""):
    """What is wrong with one value where a row of the catalogue wants another."""
    check = _Check(where)
    check.value(path, keyword, value)
    return check.problems


class _Check:
    def __init__(self, where, largest=None):
        """@param largest magnitude of real values"""
        self.where, self.largest = where, largest
        self.problems = []
        self.alarms = []

    def problem(self, identifier, path, **values):
        item = message(identifier, f"{path}, {self.where}" if self.where else path, path=path, **values)
        (self.alarms if item.severity == "A" else self.problems).append(item)

    # -------------------------------------------------------------------------------------- one set of keywords

    def occurrence(self, path, row, given):
        """The keywords of a command, or of one occurrence of a factor keyword."""
        rows = row.get("keyword", {})
        given = self.renamed(path, row, {k: v for k, v in given.items() if v is not None})
        given = handed_down(row.get("hands_down", {}), given)
        refused = any(name in row.get("elsewhere", ()) for name in given)
        values, others = {}, {}
        for name, value in given.items():
            if name in rows:
                values[name] = self.keyword(f"{path}/{name}", rows[name], value)
            elif "others" in row and name not in row.get("elsewhere", ()):
                others[name] = value
            else:
                self.unknown(path, name, row)
        for name, keyword in rows.items():
            if name not in given and "default" in keyword:
                values[name] = self.default(f"{path}/{name}", keyword)
        mandatory = {k for k, keyword in rows.items() if keyword.get("status") == "mandatory"}
        for when in row.get("when", ()):
            if self.holds(when, values, given):
                for name, default in when.get("default", {}).items():
                    values.setdefault(name, default)
                mandatory |= set(when.get("mandatory", ()))
                for name in when.get("forbidden", ()):
                    if name in given:
                        self.problem("KEYWORD_10", f"{path}/{name}", condition=condition(when))
                for name in when.get("ignored", ()):
                    if _is_given(name, given):
                        self.problem("KEYWORD_17", f"{path}/{name}", condition=condition(when))
        for name in rows:
            if name in mandatory and name not in given:
                self.problem("KEYWORD_2", f"{path}/{name}", help=catalog.help_of(rows[name]))
        for rule in row.get("rule", ()):
            self.rule(path, rule, given, refused)
        return {**{name: values[name] for name in rows if name in values}, **others}

    def renamed(self, path, row, given):
        """Keywords that code_aster, or earlier versions of it, spell otherwise too (`formerly`), under the names here."""
        made = {}
        for name, value in given.items():
            now = row.get("formerly", {}).get(name, name)
            if now in made or (now != name and now in given):
                self.problem("KEYWORD_6", path, names=", ".join(k for k in given if row.get("formerly", {}).get(k, k) == now))
            else:
                made[now] = value
        return made

    def unknown(self, path, name, row):
        if name in row.get("elsewhere", ()):
            otherwise = catalog.part("remove_see_help", command=re.match("[A-Z_0-9]*", path)[0])
            self.problem("KEYWORD_11", f"{path}/{name}", instead=catalog.instead("keyword", f"{path}/{name}", otherwise))
            return
        command = path.partition("/")[0]
        level = next(iter(_levels(command, catalog.command(command), name)), None)
        close = f"; {level} is there" if level else nearest(name, row.get("keyword", {}))
        self.problem("KEYWORD_1", f"{path}/{name}", nearest=close)

    def holds(self, when, values, given):
        return (all(values.get(k) in allowed for k, allowed in when.get("if", {}).items())
                and all(k in given for k in when.get("present", ()))
                and not any(k in given for k in when.get("absent", ())))

    def rule(self, path, rule, given, refused):
        """@param refused a keyword of code_aster's was refused here: it may be the one that is missed"""
        there = [k for k in rule["of"] if k in given]
        names = ", ".join(rule["of"])
        kind = rule["kind"]
        if kind in ("exactly_one", "at_least_one") and not there and not refused:
            self.problem("KEYWORD_7" if kind == "exactly_one" else "KEYWORD_8", path, names=names)
        elif kind in ("exactly_one", "exclusive") and len(there) > 1:
            self.problem("KEYWORD_6", path, names=", ".join(there))
        elif kind == "together" and there and len(there) < len(rule["of"]):
            self.problem("KEYWORD_9", path, there=", ".join(there), missing=", ".join(k for k in rule["of"] if k not in given))

    def default(self, path, row):
        value = row["default"]
        if row["type"] == "factor":
            made = self.occurrence(path, row, value)
            return [made]
        for item in value if isinstance(value, list) else (value,):
            if item in row.get("elsewhere", ()):
                self.other_value(path, item, row["into"])
        return list(value) if isinstance(value, list) else value

    # ------------------------------------------------------------------------------------------------ one keyword

    def keyword(self, path, row, value):
        if row["type"] == "factor":
            return self.factor(path, row, value)
        many = row.get("max", 1) != 1
        items = _items(value, row["type"])
        if items is None:
            items = [value]
        if not self.cardinality(path, row, len(items)):
            return value
        checked = [self.value(path, row, item) for item in items]
        if row.get("unique"):
            seen = []
            for item in checked:
                if item in seen:
                    self.problem("KEYWORD_12", path, value=_show(item))
                seen.append(item)
        return checked if many else checked[0]

    def factor(self, path, row, value):
        items = [value] if isinstance(value, dict) else list(value) if isinstance(value, (list, tuple)) else None
        if items is None or not all(isinstance(item, dict) for item in items):
            self.problem("KEYWORD_3", path, expected=catalog.part("f_or_list"), found=_show(value))
            return []
        if not self.cardinality(path, row, len(items)):
            return []
        repeated = row.get("max", 1) != 1
        return [self.occurrence(f"{path}[{i}]" if repeated else path, row, item) for i, item in enumerate(items, 1)]

    def cardinality(self, path, row, count):
        low, high = row.get("min", 1), row.get("max", 1)
        if count < low or (high != "many" and count > high):
            allowed = f"{low}" if high == low else f"{low} or more" if high == "many" else f"{low} to {high}"
            self.problem("KEYWORD_5", path, count=count, allowed=allowed)
            return False
        return True

    def value(self, path, row, item):
        """One value of a simple keyword, converted."""
        if row.get("makes"):
            if not isinstance(item, CO):
                self.problem("KEYWORD_16" if isinstance(item, Concept) else "KEYWORD_3", path, expected="CO('name')", found=_show(item))
            return item
        converted = _convert(row["type"], item)
        if converted is None:
            self.problem("KEYWORD_3", path, expected=_expected(row["type"]), found=_show(item))
            return item
        if isinstance(converted, Concept):
            if converted.destroyed:
                self.problem("KEYWORD_14", path, label=converted.label or converted.id, place=converted.destroyed)
            return converted
        allowed = row.get("into")
        if "into_from" in row:
            allowed = plugins.lists[row["into_from"]]()
        if allowed is not None and converted not in allowed:
            if converted in row.get("elsewhere", ()):
                self.other_value(path, converted, allowed)
            else:
                self.problem("KEYWORD_4", path, value=_show(converted), allowed=_list(allowed), nearest=nearest(converted, allowed))
        self.bounds(path, row, converted)
        return converted

    def other_value(self, path, value, allowed):
        """A value that code_aster has and Lacon has not."""
        instead = catalog.instead("value", f"{path}={value}", catalog.part("give_one_of", values=_list(allowed)))
        self.problem("KEYWORD_13", path, value=_show(value), instead=instead)

    def bounds(self, path, row, value):
        tests = {"above": (operator.gt, "bound_above"), "at_least": (operator.ge, "bound_at_least"),
                 "below": (operator.lt, "bound_below"), "at_most": (operator.le, "bound_at_most")}
        if self.largest and isinstance(value, float):
            row = {"at_least": -self.largest, "at_most": self.largest, **row}
        limits = {"at_least": -2**63, "at_most": _largest_count if "at_least" in row else 2**63 - 1, **row} if row["type"] == "integer" else row
        for key, (holds, words) in tests.items():
            if key in limits and not holds(value, limits[key]):
                self.problem("KEYWORD_15", path, value=_show(value), bound=catalog.part(words, bound=f"{limits[key]:.10g}"))
                return


def _is_given(name, given):
    """Whether a keyword is, "FACTOR/KEYWORD" in an occurrence of a factor keyword."""
    factor, _, own = name.rpartition("/")
    if not factor:
        return name in given
    items = given.get(factor)
    items = items if isinstance(items, (list, tuple)) else [items]
    return any(isinstance(item, dict) and item.get(own) is not None for item in items)


def handed_down(row, given):
    """Keywords of a command that mean the occurrences of some factor keywords (`hands_down`), in those that do not have them themselves."""
    targets = [name for name in row.get("to", ()) if isinstance(given.get(name), (dict, list, tuple))]
    common = {name: given[name] for name in row.get("keywords", ()) if name in given} if targets else {}
    if not common:
        return given
    made = {name: value for name, value in given.items() if name not in common}
    for name in targets:
        items = [made[name]] if isinstance(made[name], dict) else made[name]
        made[name] = [{**common, **item} if isinstance(item, dict) else item for item in items]
    return made


def _levels(path, row, name):
    """The paths of every keyword of this name in a command."""
    for own, keyword in row.get("keyword", {}).items():
        if own == name:
            yield f"{path}/{own}"
        yield from _levels(f"{path}/{own}", keyword, name)


# ------------------------------------------------------------------------------------------------------- values


def _items(value, kind):
    """The values of a list-like thing, a list of DEFI_LIST_ENTI among them where integers are wanted; None for a single value."""
    if isinstance(value, Concept):
        return value.getValues() if kind == "integer" and value.type == "list_of_integers" and not value.destroyed else None
    if isinstance(value, (list, tuple, range)):
        return list(value)
    if hasattr(value, "dtype") and getattr(value, "ndim", 0) > 0:
        return value.ravel().tolist()
    return None


def _convert(kind, value):
    """A value as `kind` wants it; None where it is of another type."""
    if isinstance(value, Concept):
        return value if kind == "concept" or value.type in kind.split("|") else None
    if "|" in kind:  # a concept it is not
        return next((found for found in (_convert(one, value) for one in kind.split("|")) if found is not None), None)
    if hasattr(value, "dtype") and getattr(value, "ndim", 1) == 0:
        value = value.item()
    if kind == "real":
        try:
            return float(value) if isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value) else None
        except OverflowError:  # an integer beyond every number of 64 bits
            return None
    if kind == "integer":
        return value if isinstance(value, int) and not isinstance(value, bool) else None  # bounds() refuses what no file holds
    if isinstance(value, str) and not _is_writable(value):
        return None
    if kind == "scalar":
        return value if isinstance(value, str) or _convert("real", value) is not None else None
    if kind in _names:
        return value if isinstance(value, str) and (kind == "text" or value.strip()) else None
    return None


def _is_writable(text):
    """Whether a text comes back as it was from a file of the base: HDF5 ends it at a zero, and half a character has no bytes."""
    try:
        return b"\0" not in os.fsencode(text)
    except UnicodeEncodeError:
        return False


def _expected(kind):
    if kind == "concept":
        return catalog.part("a_concept")

    def said(one):
        if one in _names:
            return catalog.part(_names[one])
        return catalog.part("an_object" if one[0] in "aeiou" else "an_object_of_kind", kind=catalog.part(types[one]))

    return catalog.part("or").join(map(said, kind.split("|")))


def _show(value):
    if isinstance(value, Concept):
        return f"{value.label or 'a concept'} (a {value.type.replace('_', ' ')})"
    if isinstance(value, CO):
        return f"{value.name!r}, a name whose concept has not been made"
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "..."


def _list(values):
    return ", ".join(map(str, values))


def condition(when):
    parts = [f"{k}={' or '.join(map(repr, v))}" for k, v in when.get("if", {}).items()]
    parts += list(when.get("present", ()))
    parts += [f"no {k}" for k in when.get("absent", ())]
    return " and ".join(parts)
