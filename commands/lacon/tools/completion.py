"""Completion of `lacon ...` for bash and zsh, from its command lines and the catalogue. commands/generate.py writes it when Lacon is built."""

import argparse

from ..core import catalog
from .convert import read_formats, write_formats


def _endings(formats):
    """The suffixes of formats, without their dots."""
    return [suffix.lstrip(".") for suffix in formats]


#: what a file or folder must end with, by what a command line calls it
_patterns = {"BASE": "*.base", "FOLDER": "*(/)", "MESH": f"*.({'|'.join(_endings(read_formats))})"}
_paths = ("FILE", "FOLDER", "N=FILE")  #: values of options that files are offered for


def options_of(parser):
    """[(names, metavar or nothing for a flag, choices, help)] of its options."""
    return [(action.option_strings, None if action.nargs == 0 else action.metavar or action.dest.upper(), list(action.choices or ()),
             " ".join((action.help or "").split()))
            for action in parser._actions if action.option_strings and action.help is not argparse.SUPPRESS]


def positionals_of(parser):
    """[(name, several of them, help)]"""
    return [(action.metavar or action.dest, action.nargs == "+", " ".join((action.help or "").split())) for action in parser._actions
            if not action.option_strings]


def choices_of(lines, templates):
    """(tool, option) -> its values"""
    found = {(tool, option): choices for tool, parser in lines.items() for names, _, choices, _ in options_of(parser) for option in names if choices}
    return {**found, ("new", "--template"): list(templates)}


def bash(lines, templates):
    """@param lines tool -> the parser of its command line, "" that of a study  @param templates names of them"""
    def words(tool):
        return " ".join(name for names, *_ in options_of(lines[tool]) for name in names)

    files = {tool: f"*.@({'|'.join(endings)})" for tool, endings in
             (("", ("comm", "com[0-9]", "export")), ("check", ("comm", "com[0-9]", "export")), ("convert", dict.fromkeys(_endings(read_formats) + _endings(write_formats))),
              ("new", _endings(read_formats)))}
    text = ["# Completion of lacon for bash, made from its command lines and the catalogue.", "_lacon() {",
            '    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} tool=${COMP_WORDS[1]} options="" files="" values=""',
            "    COMPREPLY=()", "    [[ $COMP_CWORD -gt 1 ]] || tool=''", '    case "$tool" in',
            f"        help) mapfile -t COMPREPLY < <(compgen -W '{' '.join(catalog.command_names())}' -- \"${{word^^}}\"); return ;;"]
    text += [f"        {tool}) options='{words(tool)}'; files='{files.get(tool, '')}' ;;" for tool in lines if tool]
    text += [f"        *) options='{words('')}'; files='{files['']}' ;;", "    esac", '    case "$tool $before" in']
    text += [f"        {(chr(39) + tool + ' ' + option + chr(39)) if tool else '*' + chr(39) + ' ' + option + chr(39)}) values='{' '.join(values)}' ;;"
             for (tool, option), values in choices_of(lines, templates).items()]
    text += ["    esac", '    if [[ -n $values ]]; then', '        mapfile -t COMPREPLY < <(compgen -W "$values" -- "$word")',
             '    elif [[ $word == -* ]]; then', '        mapfile -t COMPREPLY < <(compgen -W "$options" -- "$word")', "    else",
             "        local restore; restore=$(shopt -p extglob); shopt -s extglob",
             '        [[ -z $files ]] || mapfile -t COMPREPLY < <(compgen -f -X "!$files" -- "$word")', '        eval "$restore"',
             '        mapfile -t -O ${#COMPREPLY[@]} COMPREPLY < <(compgen -d -- "$word")', "        if [[ $COMP_CWORD -eq 1 ]]; then",
             f"            mapfile -t -O ${{#COMPREPLY[@]}} COMPREPLY < <(compgen -W 'help {' '.join(tool for tool in lines if tool)}' -- \"$word\")",
             "        fi", "    fi", "}", "complete -o filenames -o bashdefault -F _lacon lacon", ""]
    return "\n".join(text)


def zsh(lines, templates):
    """@param lines, templates as of bash()"""
    def quoted(text):
        return text.replace("'", "'\\''").replace("[", "\\[").replace("]", "\\]").replace(":", "\\:")

    choices = choices_of(lines, templates)

    def specifications(tool):
        for names, value, _, words in options_of(lines[tool]):
            for name in names:
                values = choices.get((tool, name))
                action = "" if value is None else f":{value}:" + (f"({' '.join(values)})" if values else "_files" if value in _paths else "")
                yield f"'*{name}[{quoted(words)}]{action}'"
        for name, _, words in positionals_of(lines[tool]):
            pattern = _patterns.get(name)
            yield f"'*:{quoted(words)}:_files{f' -g {chr(34)}{pattern}{chr(34)}' if pattern and name != 'BASE' else ' -/' if name == 'BASE' else ''}'"

    text = ["#compdef lacon", "# Completion of lacon for zsh, made from its command lines and the catalogue.", "_lacon() {", "    local -a tools commands",
            "    tools=(", f"        'help:{quoted('all commands, or the keywords of some')}'"]
    text += [f"        '{tool}:{quoted(parser.description.partition('.')[0])}'" for tool, parser in lines.items() if tool]
    text += ["    )", f"    commands=({' '.join(catalog.command_names())})", "    if (( CURRENT == 2 )); then", "        _describe 'tool' tools",
             "        _arguments " + " ".join(specifications("")), "        return", "    fi", "    local tool=$words[2]", "    case $tool in",
             "        help) _describe 'command' commands ;;"]
    for tool in filter(None, lines):
        text += [f"        {tool}) shift words; (( CURRENT-- )); _arguments {' '.join(specifications(tool))} ;;"]
    text += [f"        *) _arguments {' '.join(specifications(''))} ;;", "    esac", "}", '_lacon "$@"', ""]
    return "\n".join(text)
