"""`lacon help`, `lacon help DEFI_CONTACT`: the catalogue's rows as text."""

import textwrap

from ..core import catalog, plugins
from ..core.checker import condition
from ..core.nearest import nearest
from . import examples, keyword_table

_types = {"group_ma": "group of cells", "group_no": "group of nodes", "cell": "cell name", "node": "node name", "factor": "_F(...)"}


def run(names):
    """Print the list of commands, the keywords of each named one, or with --table the page of all of them. @return exit status"""
    if names == ["--table"]:
        print(keyword_table.text(), end="")
        return 0
    if not names:
        for name in catalog.command_names():
            print(f"{name:18}{catalog.command(name)['help']}")
        return 0
    status = 0
    for name in map(str.upper, names):
        if name in catalog.command_names():
            print("\n".join(_command(name)))
        elif name in catalog.peer_commands():
            print(f"{name} is a command of code_aster that is not available in Lacon")
            print("  " + catalog.instead("command", name, "there is no counterpart"))
            status = 2
        else:
            print(f"there is no command {name}{nearest(name, catalog.command_names())}")
            status = 2
    return status


def _command(name):
    row = plugins.command(name)
    result = f" -> {row['result'].replace('_', ' ')}" if "result" in row else ""
    yield f"{name}{result}"
    yield from _wrap(row["help"], 2)
    if "reuse" in row:
        must = "needed" if row.get("reuse_status") == "mandatory" else "possible"
        yield from _wrap(f"reuse= is {must}: the concept given as {row['reuse']} is changed in place", 2)
    yield from _keywords(row, 2)
    yield "  the shortest call that is accepted:"
    yield from textwrap.wrap(examples.text(name), 110, initial_indent="    ", subsequent_indent="        ", break_long_words=False)
    yield ""


def _keywords(row, indent):
    for name, keyword in row.get("keyword", {}).items():
        yield " " * indent + f"{name}  {kind(keyword)}"
        yield from _wrap(keyword["help"], indent + 4)
        yield from _keywords(keyword, indent + 4)
    for rule in rules(row):
        yield from _wrap(rule, indent)


def rules(row):
    """What holds between the keywords of a command or of a factor keyword, in words."""
    for rule in row.get("rule", ()):
        words = {"exactly_one": "exactly one of", "at_least_one": "at least one of", "exclusive": "at most one of",
                 "together": "all or none of"}[rule["kind"]]
        yield f"{words}: {', '.join(rule['of'])}"
    for when in row.get("when", ()):
        yield _when(when)


def kind(row):
    """"integer, mandatory, at least 1" and the like."""
    words = [" or ".join(_types.get(k, k.replace("_", " ")) for k in row["type"].split("|"))]
    most = row.get("max", 1)
    if most != 1:
        words.append("one or many" if most == "many" else f"up to {most}")
    if row.get("status") == "mandatory":
        words.append("mandatory")
    if "into_from" in row:
        words.append("one of " + ", ".join(plugins.lists[row["into_from"]]()))
    elif "into" in row:
        words.append("one of " + ", ".join(map(str, row["into"])))
    for key in ("above", "at_least", "below", "at_most"):
        if key in row:
            words.append(f"{key.replace('_', ' ')} {row[key]:g}")
    if "default" in row and row["type"] != "factor":
        value = row["default"]
        words.append("default " + (", ".join(map(str, value)) if isinstance(value, list) else str(value)))
    return "; ".join(words)


def _when(when):
    parts = [f"{k} is {v} by default" for k, v in when.get("default", {}).items()]
    parts += [f"{k} is mandatory" for k in when.get("mandatory", ())]
    parts += [f"{', '.join(when['forbidden'])} are refused"] if "forbidden" in when else []
    return f"with {condition(when)}: {'; '.join(parts)}"


def _wrap(text, indent):
    return textwrap.wrap(text, 110, initial_indent=" " * indent, subsequent_indent=" " * indent)
