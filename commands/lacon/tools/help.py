"""`lacon help`, `lacon help DEFI_CONTACT`: the catalogue's rows as text."""

import functools
import os
import textwrap

from ..core import catalog, plugins
from ..core.catalog import part
from ..core.checker import condition
from ..core.command_line import CommandLine
from ..core.concepts import types
from ..core.nearest import nearest
from . import examples, keyword_table

#: type of a keyword -> the part that says it
_types = {**types, "group_ma": "type_group_ma", "group_no": "type_group_no", "cell": "type_cell", "node": "type_node", "integer": "type_integer",
          "real": "type_real", "text": "type_text"}
_rules = {"exactly_one": "rule_exactly_one", "at_least_one": "rule_at_least_one", "exclusive": "rule_exclusive", "together": "rule_together"}
_limits = {"above": "limit_above", "at_least": "limit_at_least", "below": "limit_below", "at_most": "limit_at_most"}


def parser():
    """Of its command line."""
    made = CommandLine(prog="lacon help", description="Lists all commands, or the keywords of some.")
    made.add("names", metavar="COMMAND", nargs="*", help="a command; without any all of them are listed")
    made.add("--table", action="store_true", help="print the table of all keywords beside code_aster's, in Markdown")
    return made


def run(arguments):
    """Print the list of commands, the keywords of each named one, or the page of all of them. @return exit status"""
    options = parser().parse_args(arguments)
    names = options.names
    if options.table:
        os.environ["LC_ALL"] = "C"  # a page of the documentation
        print(keyword_table.text(), end="")
        return 0
    if not names:
        for name in catalog.command_names():
            print(f"{name:18}{catalog.help_of(catalog.command(name))}")
        return 0
    status = 0
    for name in map(str.upper, names):
        if name in catalog.command_names():
            print("\n".join(_command(name)))
        elif name in catalog.peer_commands():
            print(part("not_in_lacon", name=name))
            print("  " + catalog.instead("command", name, part("no_counterpart")))
            status = 2
        else:
            print(part("no_command", name=name, nearest=nearest(name, catalog.command_names())))
            status = 2
    return status


def _command(name):
    row = plugins.command(name)
    result = f" -> {_type(row['result'])}" if "result" in row else ""
    yield f"{name}{result}"
    yield from _wrap(catalog.help_of(row), 2)
    if "reuse" in row:
        must = "reuse_needed" if row.get("reuse_status") == "mandatory" else "reuse_possible"
        yield from _wrap(part(must, keyword=row["reuse"]), 2)
    yield from _keywords(row, 2)
    yield "  " + part("shortest_call")
    yield from textwrap.wrap(examples.text(name), 110, initial_indent="    ", subsequent_indent="        ", break_long_words=False)
    yield ""


def _keywords(row, indent):
    for name, keyword in row.get("keyword", {}).items():
        yield " " * indent + f"{name}  {kind(keyword)}"
        yield from _wrap(catalog.help_of(keyword), indent + 4)
        yield from _keywords(keyword, indent + 4)
    for rule in rules(row):
        yield from _wrap(rule, indent)


def rules(row):
    """What holds between the keywords of a command or of a factor keyword, in words."""
    for rule in row.get("rule", ()):
        yield part(_rules[rule["kind"]], keywords=", ".join(rule["of"]))
    for when in row.get("when", ()):
        yield _when(when)


def kind(row):
    """"integer, mandatory, at least 1" and the like."""
    words = [functools.reduce(lambda one, other: part("one_or_other", one=one, other=other), map(_type, row["type"].split("|")))]
    most = row.get("max", 1)
    if most != 1:
        words.append(part("one_or_many") if most == "many" else part("up_to", count=most))
    if row.get("status") == "mandatory":
        words.append(part("is_mandatory"))
    if "into_from" in row:
        words.append(part("one_of", values=", ".join(plugins.lists[row["into_from"]]())))
    elif "into" in row:
        words.append(part("one_of", values=", ".join(map(str, row["into"]))))
    words += [part(words_of, limit=f"{row[key]:g}") for key, words_of in _limits.items() if key in row]
    if "default" in row and row["type"] != "factor":
        value = row["default"]
        words.append(part("default_is", value=", ".join(map(str, value)) if isinstance(value, list) else value))
    return "; ".join(words)


def _type(name):
    if name == "factor":
        return "_F(...)"
    return part(_types[name]) if name in _types else name.replace("_", " ")


def _when(when):
    parts = [part("keyword_by_default", keyword=k, value=v) for k, v in when.get("default", {}).items()]
    parts += [part("keyword_mandatory", keyword=k) for k in when.get("mandatory", ())]
    parts += [part("keywords_refused", keywords=", ".join(when["forbidden"]))] if "forbidden" in when else []
    parts += [part("keywords_ignored", keywords=", ".join(when["ignored"]))] if "ignored" in when else []
    return part("with_keywords", condition=condition(when), what="; ".join(parts))


def _wrap(text, indent):
    return textwrap.wrap(text, 110, initial_indent=" " * indent, subsequent_indent=" " * indent)
