"""The journal of a computation: its iterations as they come, docs/structures.md section 2. Read while it grows, and behind its end."""

import json
import math

name = "journal.jsonl"  #: in the folder of a result


class Attempt:
    """An instant that was tried."""

    def __init__(self, instant, at):
        self.instant = instant
        self.at = at  #: seconds since the process began
        self.iterations = []  #: dictionaries: iteration, rela, maxi, changes, active, geometry, constraint, seconds, at ...
        self.solved = False


class Journal:
    """What a journal tells.

    `attempts` in their order; `instants` asked for, the first one is that of the initial state; `limits` of the criteria by name, None where one is
    not asked for; `patches` of the contact; `since` (seconds of the epoch) the last process computes, `begins` at which instant; `ended`, `completed`;
    of the last process `machine` (lacon, processor, threads, blas), `phases` name -> seconds, `memory` in bytes, as far as it has told them.
    """

    def __init__(self, lines):
        self.attempts, self.instants, self.limits = [], [], {}
        self.patches, self.since, self.begins, self.now = 0, 0.0, 0.0, 0.0
        self.ended = self.completed = False
        self.machine, self.phases, self.memory = {}, {}, 0
        for line in lines:
            try:
                self._take(json.loads(line))
            except (ValueError, KeyError, TypeError, IndexError, AttributeError, RecursionError):
                pass  # empty, cut off where a process was killed, or none of a journal

    def _take(self, row):
        self.now = row.get("at", 0.0)
        if row["event"] == "start":
            self.begins, self.instants, self.limits = row["from"], row["instants"], row["limits"]
            self.patches, self.since = max(self.patches, row["patches"]), row["since"]  # of a result that goes on without contact those that it had
            self.machine, self.phases, self.memory = row.get("machine", {}), {}, 0
            self.attempts = [a for a in self.attempts if a.solved and a.instant <= self.begins]  # what is behind is computed again
            self.ended = self.completed = False
        elif row["event"] == "begin":
            self.attempts.append(Attempt(row["instant"], self.now))
        elif row["event"] == "iteration":
            self.attempts[-1].iterations.append({k: math.nan if v is None else v for k, v in row.items()})
        elif row["event"] == "solved":
            self.attempts[-1].solved = True
            self.phases, self.memory = row.get("phases", {}), row.get("memory", 0)
        elif row["event"] == "end":
            self.ended, self.completed = True, row["completed"]

    def iterations(self):
        """[(Attempt, iteration)] of all attempts."""
        return [(attempt, line) for attempt in self.attempts for line in attempt.iterations]

    def reached(self):
        """The instant that was solved last."""
        return next((a.instant for a in reversed(self.attempts) if a.solved), self.begins)

    def share(self, instant):
        """How far an instant is in the list, from 0 to 1: each interval counts the same."""
        if len(self.instants) < 2 or instant >= self.instants[-1]:
            return 1.0
        before = sum(t <= instant for t in self.instants) - 1
        if before < 0:
            return 0.0
        first, last = self.instants[before:before + 2]
        return (before + (instant - first) / (last - first)) / (len(self.instants) - 1)

    def seconds_left(self):
        """By what the instants since the process began have taken; None where that is not known."""
        done, begun = self.share(self.reached()), self.share(self.begins)
        return self.now * (1.0 - done) / (done - begun) if done > begun else None


def read_journal(base, identifier):
    """The journal of a result; nothing where it has none."""
    try:
        return Journal((base.folder / identifier / name).read_text(encoding="utf-8", errors="replace").splitlines())
    except OSError:
        return None
