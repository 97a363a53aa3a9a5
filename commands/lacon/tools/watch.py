"""`lacon watch BASE`: the Newton curves of a computation in progress, in another terminal than its own. It ends when the run ends.

Reads the base, and never changes it: the registry says which computation is under way, the journal of its result what its iterations are.
"""

import math
import shutil
import sys
import time

from ..base.base import look_into
from ..base.journal import name as journal_name
from ..base.journal import read_journal
from ..core import outcome
from ..core.concepts import type_of
from ..core.catalog import part
from ..core.command_line import CommandLine
from ..core.messages import fail
from .chart import chart, columns_of

_home, _rest, _line = "\033[H", "\033[J", "\033[K"  #: of a terminal: go to its corner, empty what is behind, the rest of a line
_widest = 8  #: dots from one iteration to the next, at most


def parser():
    """Of its command line."""
    made = CommandLine(
        prog="lacon watch", description="Shows how Newton's method of a computation in progress goes on: residuals and changes of contact, iteration by "
        "iteration. Ends when the run ends. Into a pipe or a file it writes what it shows last.")
    made.add("base", metavar="BASE", help="folder of the base, STUDY.base")
    made.add("--once", action="store_true", help="show what is there now, and end")
    made.add("--every", type=float, default=1.0, metavar="SECONDS", help="how often it looks; 1 by default")
    return made


def run(arguments):
    """@return exit status"""
    asked = parser()
    options = asked.parse_args(arguments)
    if not options.every > 0.0:
        asked.wrong("give_seconds", option=f"--every {options.every:g}")
    draws = sys.stdout.isatty() and not options.once
    try:
        last = follow(options, draws)
    except KeyboardInterrupt:  # who looks on has seen enough: the computation goes on
        return outcome.done
    if not draws:
        print("\n".join(last))
    return outcome.done


def follow(options, draws):
    """Look on until the run ends, or once. @return the last frame"""
    emptied = False
    while True:
        base = look_into(options.base, "lacon watch")
        running = base.running()
        size = shutil.get_terminal_size()
        lines = frame(base, running, size.columns, size.lines)
        if draws:
            sys.stdout.write((_home if emptied else _home + _rest) + "".join(line + _line + "\n" for line in lines) + _rest)
            sys.stdout.flush()
            emptied = True
        if options.once or not running:
            return lines
        time.sleep(options.every)


def chosen(base):
    """(id, label, where) of the computation to look at: the one that is under way, otherwise that of the newest journal; nothing where there is none"""
    journals = sorted(base.folder.glob(f"*/{journal_name}"), key=lambda path: path.stat().st_mtime)
    results = [path.parent.name for path in journals if type_of(path.parent.name) == "result"]
    if not results:
        return None
    entry = base.registry.get("unfinished", {}).get(results[-1])
    if entry:
        return results[-1], entry["label"], entry["where"]
    return results[-1], base.label_of(results[-1]), ""


def frame(base, running, width, height):
    """What is shown now, lines of text that fit into the window."""
    state = part("running_since", time=running["since"].partition(" ")[2], process=running["process"]) if running else part("not_running")
    computation = chosen(base)
    if computation is None:
        if not running:
            fail("WATCH_1", "lacon watch", folder=base.folder)
        return [f"{base.folder.name}: {state}", "", part("no_iteration_yet")]
    identifier, label, where = computation
    journal = read_journal(base, identifier)
    if journal is None:  # it cannot be read
        fail("READER_4", "lacon watch", label=label or identifier)
    lines = [f"{base.folder.name}: {label or identifier}{', ' + where if where else ''}; {state}", progress(journal, running), ""]
    rows = max((height - len(lines) - 6) // (3 if journal.patches else 1), 3)
    shown = journal.iterations()[-columns_of(width):]
    lines += residuals(journal, shown, width, 2 * rows if journal.patches else rows)
    if journal.patches:
        lines += statuses(journal, shown, width, rows)
    first = f" {shown[0][0].instant:.6g}" if shown else ""
    return [line[:width] for line in lines] + ["".ljust(11) + part("iterations_shown", count=len(shown), first=first)[:width - 11]]


def progress(journal, running):
    """"INST 0.4  iteration 3  35 % of the instants  1 min 20 s, about 2 min 30 s left\""""
    if not journal.attempts:
        return part("first_has_begun" if not journal.ended else "no_instant_tried")
    attempt, reached = journal.attempts[-1], journal.share(journal.reached())
    words = [f"INST {attempt.instant:.6g}", part("iteration_number", number=len(attempt.iterations)), part("share_of_instants", percent=math.floor(100 * reached))]
    if journal.ended:
        return "  ".join([*words, in_words(journal.now), part("complete" if journal.completed else "ended_before_last")])
    gone = time.time() - journal.since if running else journal.now
    left = journal.seconds_left()
    words.append(in_words(gone) + (part("progress_left", time=in_words(left)) if left is not None and running else ""))
    return "  ".join(words + ([] if running else [part("ended_on_the_way")]))


def in_words(seconds):
    """"1 min 20 s", two units at most."""
    whole = round(max(seconds, 0.0))
    if whole < 60:
        return f"{whole} s"
    return f"{whole // 60} min {whole % 60} s" if whole < 3600 else f"{whole // 3600} h {whole % 3600 // 60} min"


def curves(shown, width, value):
    """(one list of dots an instant, where another one begins) of a value of the iterations."""
    step = max(min(_widest, columns_of(width) // max(len(shown), 1)), 1)
    found, marks = [], []
    for i, (attempt, line) in enumerate(shown):
        if i == 0 or attempt is not shown[i - 1][0]:
            found.append([])
            marks += [i * step - step // 2] if i else []
        found[-1].append((i * step, line.get(value, 0)))  # an instant without contact has no changes of it
    return found, marks


def residuals(journal, shown, width, rows):
    """RESI_GLOB_RELA, or where it is not asked for RESI_REFE_RELA or RESI_GLOB_MAXI, on a logarithmic scale."""
    kinds = {"rela": "RESI_GLOB_RELA", "refe": "RESI_REFE_RELA", "maxi": "RESI_GLOB_MAXI"}
    kind = next((name for name in kinds if journal.limits.get(name) is not None), "maxi")
    values = [line[kind] for _, line in shown]
    limit = max(journal.limits.get(kind) or 0.0, 0.0)  # no other one is on a logarithmic scale
    known = [v for v in [*values, limit] if math.isfinite(v) and v > 0.0] or [1.0]
    lower, upper = (10.0 ** edge(math.log10(pick(known))) for edge, pick in ((math.floor, min), (math.ceil, max)))
    last = part("now_value", value=f"{values[-1]:.2e}") if values else ""
    title = f"{kinds[kind]}{last}" + (part("asked_dashed", limit=f"{limit:.0e}") if limit else "")
    drawn, marks = curves(shown, width, kind)
    return [" " * 11 + title, *chart(drawn, width, rows, lower, max(upper, 10.0 * lower), log=True, level=limit or None, marks=marks)]


def statuses(journal, shown, width, rows):
    """How many patches change between contact and no contact."""
    values = [line.get("changes", 0) for _, line in shown]
    active = part("patches_in_contact", count=shown[-1][1].get("active", 0), all=journal.patches) if shown else ""
    title = part("patches_that_change") + (part("now_value", value=values[-1]) if values else "") + active
    drawn, marks = curves(shown, width, "changes")
    return [" " * 11 + title, *chart(drawn, width, rows, 0, max([*values, 1]), marks=marks)]
