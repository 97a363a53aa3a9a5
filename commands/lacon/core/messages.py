"""Messages by identifier, and the Python exceptions that carry them.

Severities: F the user's error, S the solution failed, A alarm, I information.
"""

import collections
import sys

from . import catalog, current, labels


class Message(collections.namedtuple("Message", "severity id text do where", defaults=("",))):
    """What is wrong, what to do, and where; printed as docs/structures.md section 4 says."""

    __slots__ = ()

    def __str__(self):
        lines = [f"<{self.severity}> <{self.id}> {self.text}"]
        if self.where:
            lines.append("    " + catalog.part("label_where", place=self.where))
        if self.do:
            lines.append("    " + catalog.part("label_do", advice=self.do))
        return "\n".join(lines)


def message(identifier, where="", **values):
    """The message of the catalogue with its gaps filled in."""
    row = catalog.messages()[identifier]
    return Message(row["severity"], identifier, row["text"].format(**values), row["do"].format(**values), where)


def show(item):
    """Print a message on the log, after what standard output holds so far."""
    sys.stdout.flush()
    print(item, file=sys.stderr, flush=True)


class NeedsRun(BaseException):
    """`lacon check` has come to a value that only a run can give. No error: a command file does not catch it."""

    def __init__(self, label, made):
        self.label, self.made = label, made
        super().__init__(label)


class AsterError(Exception):
    """A command failed by the user's doing. A command file may catch it.

    `messages` says why: a list of messages, or a text where a command file raises it itself. `shown` is true where an operator
    has printed them already.
    """

    status = 2
    diagnostic = "<F>_ERROR"

    def __init__(self, messages=(), shown=False):
        if isinstance(messages, str):
            messages = [Message("F", "USER", messages, "")]
        self.messages = list(messages)
        self.shown = shown
        super().__init__("\n".join(map(str, self.messages)))

    @property
    def id_message(self):
        """Identifier of the first message."""
        return self.messages[0].id if self.messages else ""

    @property
    def message(self):
        """Text of the first message."""
        return self.messages[0].text if self.messages else ""


class SolutionError(AsterError):
    """The solution failed: no convergence, singular matrix."""

    status = 3
    diagnostic = "<S>_ERROR"


class ConvergenceError(SolutionError):
    """Newton's method did not converge."""

    diagnostic = "<S>_NO_CONVERGENCE"


class InternalError(AsterError):
    """An operator died or broke its contract."""

    status = 4
    diagnostic = "<F>_ABNORMAL_ABORT"


def fail(identifier, where="", **values):
    """Raise the message as the exception of its severity. Without `where` it is the line of the command file that is running."""
    if not where and current.study is not None:
        where = labels.location(labels.user_frame())
    item = message(identifier, where, **values)
    kind = InternalError if identifier.startswith("INTERNAL") else SolutionError if item.severity == "S" else AsterError
    raise kind([item])
