"""An order that the checker accepts, made from a command's rows alone: the example of `lacon help`, and where property tests start."""

from ..core import plugins
from ..core.concepts import CO, Concept

_names = {"group_ma": "GROUP", "group_no": "NODES", "cell": "M1", "node": "N1", "text": "text"}


class Named(Concept):
    """Stands for a concept of some type under a name."""

    def __init__(self, kind, label):
        super().__init__(None, f"{kind}_1", label)
        self.type = kind


def minimal(row):
    """Keywords of a command, or of an occurrence of a factor keyword: what is mandatory and what rules ask for, nothing else."""
    return close(row, {})


def close(row, given):
    """`given` with the least that makes it complete, in the order of the rows."""
    keywords = row.get("keyword", {})
    given = dict(given)

    def add(name):
        if name not in given:
            given[name] = value(keywords[name], name)

    for name, keyword in keywords.items():
        if keyword.get("status") == "mandatory" or "example" in keyword or keyword.get("default") in keyword.get("elsewhere", ()):
            add(name)
    for rule in row.get("rule", ()):
        if rule["kind"] in ("exactly_one", "at_least_one") and not any(k in given for k in rule["of"]):
            add(rule["of"][0])
    changed = True
    while changed:
        before = len(given)
        for when in row.get("when", ()):
            if holds(when, keywords, given):
                for name in when.get("mandatory", ()):
                    add(name)
        for rule in row.get("rule", ()):
            if rule["kind"] == "together" and any(k in given for k in rule["of"]):
                for name in rule["of"]:
                    add(name)
        changed = len(given) != before
    return {name: given[name] for name in keywords if name in given}


def holds(when, keywords, given):
    """The conditions of a `when` row, with plain defaults."""
    values = {k: keyword["default"] for k, keyword in keywords.items() if "default" in keyword} | given
    return (all(values.get(k) in allowed for k, allowed in when.get("if", {}).items()) and all(k in given for k in when.get("present", ()))
            and not any(k in given for k in when.get("absent", ())))


def value(keyword, name=""):
    """A value, or as many as there must be, of a keyword."""
    if keyword["type"] == "factor":
        return minimal(keyword)
    count = keyword.get("min", 1)
    if count == 1:
        return single(keyword, 0, name)
    return [single(keyword, i, name) for i in range(count)]


def single(keyword, i=0, name=""):
    """The i-th of several values; different ones for different i, where the rows allow any."""
    if "example" in keyword:
        return keyword["example"]
    kind = keyword["type"].split("|")[0]
    allowed = plugins.lists[keyword["into_from"]]() if "into_from" in keyword else keyword.get("into")
    if allowed:
        return allowed[i % len(allowed)]
    if keyword.get("makes"):
        return CO("NEW")
    if kind in ("real", "integer", "scalar"):
        low, high = keyword.get("at_least", keyword.get("above", 0)), keyword.get("at_most", keyword.get("below", 2))
        choices = (1 + i, i, low + i, low + 1 + i, (low + high) / 2)
        number = next(x for x in choices if within(keyword, x))
        return int(number) if kind == "integer" else float(number)
    if kind in _names:
        return _names[kind] + (str(i + 1) if i else "")
    return Named(kind if kind != "concept" else "mesh", (name or kind).upper())


def within(keyword, number):
    """The number respects the bounds of the row."""
    return (number >= keyword.get("at_least", number) and number <= keyword.get("at_most", number)
            and not number <= keyword.get("above", number - 1) and not number >= keyword.get("below", number + 1))


def text(command):
    """The example of a command, lines of a command file."""
    row = plugins.command(command)
    keywords = minimal(row)
    head = ""
    if "result" in row and not any(row["keyword"][k].get("makes") for k in keywords):
        head = f"{row['result'].replace('_', ' ').title().replace(' ', '').upper()} = "
    items = [f"{k}={_shown(v)}" for k, v in keywords.items()]
    if row.get("reuse_status") == "mandatory":
        holder = keywords[row["reuse"]].label
        head = f"{holder} = "
        items.insert(0, f"reuse={holder}")
    return f"{head}{command}({', '.join(items)})"


def _shown(value):
    if isinstance(value, dict):
        return f"_F({', '.join(f'{k}={_shown(v)}' for k, v in value.items())})"
    if isinstance(value, list):
        return f"({', '.join(map(_shown, value))}{',' if len(value) == 1 else ''})"
    return value.label if isinstance(value, Concept) else repr(value)
