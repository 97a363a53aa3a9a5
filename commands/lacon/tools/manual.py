"""Man pages and the pages of commands and messages of the documentation, from the command lines and the catalogue. commands/generate.py writes
them when Lacon is built."""

import re
import textwrap

from ..core import catalog
from ..core.catalog import part
from . import examples
from .completion import options_of, positionals_of
from .help import kind, rules

#: section of a man page -> the part that says it
_sections = {"name": "section_name", "synopsis": "section_synopsis", "description": "section_description", "arguments": "section_arguments",
             "options": "section_options", "notes": "section_notes", "see also": "section_see_also", "keywords": "section_keywords"}
_severities = {"F": "an error of the user's", "S": "the solution failed", "A": "an alarm", "I": "an information"}


def _roff(text):
    """A text as a line of roff shows it."""
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return "\\&" + text if text.startswith((".", "'")) else text


def _section(name):
    """The line that begins a section, in the user's language."""
    return ".SH " + part(_sections[name])


def tool_page(name, parser, version):
    """The page of `lacon NAME` in section 1, of `lacon` with an empty name."""
    title = f"lacon-{name}" if name else "lacon"
    command = f"lacon {name}".strip()
    arguments = " ".join(f"\\fI{_roff(metavar)}\\fR" + (" ..." if several else "") for metavar, several, _ in positionals_of(parser))
    lines = [f'.TH {title.upper()} 1 "" "Lacon {version}" "Lacon"', _section("name"), f"{_roff(title)} \\- {_roff(parser.description.partition('.')[0])}",
             _section("synopsis"), f"\\fB{command}\\fR [\\fIoptions\\fR] {arguments}", _section("description"), _roff(parser.description), _section("arguments")]
    for metavar, _, words in positionals_of(parser):
        lines += [".TP", f"\\fI{_roff(metavar)}\\fR", _roff(words)]
    lines += [_section("options")]
    for names, value, choices, words in options_of(parser):
        shown = ", ".join(f"\\fB{_roff(option)}\\fR" for option in names) + (f" \\fI{_roff(value)}\\fR" if value else "")
        lines += [".TP", shown, _roff(words + (f" ({', '.join(map(str, choices))})" if choices else ""))]
    if parser.epilog:
        lines += [_section("notes"), *([".nf", *map(_roff, parser.epilog.splitlines()), ".fi"] if "\n" in parser.epilog else [_roff(parser.epilog)])]
    return "\n".join([*lines, _section("see also"), "\\fBlacon\\fR(1), \\fBlacon help\\fR", ""])


def command_page(name, version):
    """The page of a command in section 7."""
    row = catalog.command(name)
    chapter = part("manual_of_commands")
    lines = [f'.TH LACON\\-{name} 7 "" "Lacon {version}" "{chapter}"', _section("name"), f"lacon\\-{name} \\- {_roff(catalog.help_of(row))}", _section("synopsis"), ".nf",
             *map(_roff, textwrap.wrap(examples.text(name), 76, subsequent_indent="    ", break_long_words=False)), ".fi", _section("keywords")]

    def keywords(within):
        for keyword, item in within.get("keyword", {}).items():
            yield from (".TP", f"\\fB{keyword}\\fR  {_roff(kind(item))}", _roff(catalog.help_of(item)))
            if item["type"] == "factor":
                yield from (".RS", *keywords(item), ".RE")
        for rule in rules(within):
            yield from (".PP", _roff(rule))

    return "\n".join([*lines, *keywords(row), _section("see also"), "\\fBlacon\\fR(1)", ""])


# ---------------------------------------------------------------------------------------------------- pages of the documentation


def _text(words):
    """A text of the catalogue in Markdown: names of keywords and the like stay as they are."""
    return re.sub(r"([_*<>\[\]|\\])", r"\\\1", words)


def command_markdown(name):
    """The page of a command in the documentation."""
    row = catalog.command(name)
    result = f" Makes a {row['result'].replace('_', ' ')}." if "result" in row else ""
    lines = [f"# {name}", "", _text(row["help"]) + "." * (not row["help"].endswith(".")) + result, ""]
    if "reuse" in row:
        must = "needed" if row.get("reuse_status") == "mandatory" else "possible"
        lines += [f"`reuse=` is {must}: the concept given as `{row['reuse']}` is changed in place.", ""]
    lines += ["The shortest call that is accepted:", "", "```python", *textwrap.wrap(examples.text(name), 100, subsequent_indent="    ", break_long_words=False),
              "```", "", "## Keywords", ""]

    def keywords(within, indent):
        for keyword, item in within.get("keyword", {}).items():
            yield f"{indent}* **{keyword}**: {_text(kind(item))}. {_text(item['help'])}"
            yield from keywords(item, indent + "  ")
        for rule in rules(within):
            yield f"{indent}* *{_text(rule)}*"

    return "\n".join([*lines, *keywords(row, ""), ""])


def commands_markdown():
    """The list of commands."""
    lines = ["# Commands", "", "Every command with its keywords, as `lacon help COMMAND` shows them.", "", "| command | |", "|---|---|"]
    lines += [f"| [{name}]({name.lower()}.md) | {_text(catalog.command(name)['help'])} |" for name in catalog.command_names()]
    return "\n".join([*lines, "", "```{toctree}", ":hidden:", "", *map(str.lower, catalog.command_names()), "```", ""])


def messages_markdown():
    """Every message: what is wrong, and what to do."""
    lines = ["# Messages", "", "Every message by its identifier: what is wrong, and what to do. In braces what a message fills in.", "",
             "| severity | |", "|---|---|", *(f"| {letter} | {words} |" for letter, words in _severities.items()), ""]
    for identifier, row in sorted(catalog.messages().items(), key=lambda item: (item[0].rpartition("_")[0], int(item[0].rpartition("_")[2]))):
        lines += [f"## {identifier}", "", f"{row['severity']}: {_text(row['text'])}", ""] + ([f"Do: {_text(row['do'])}", ""] if row["do"] else [])
    return "\n".join(lines)
