"""Where the time of a run goes: start-up, then per command Python, the operator's process, and the operator's own phases."""

import os
import time


class Timings:
    def __init__(self):
        self._start = time.perf_counter()
        self._before = _age_of_process()
        self.commands = []  #: (command, where, seconds in all, seconds of the process, phases, counts)

    def add(self, command, where, seconds, outcome=None):
        """@param outcome of the operator (orders.Outcome), if there was one"""
        self.commands.append((command, where, seconds, *((outcome.seconds, outcome.phases, outcome.counts) if outcome else (0.0, {}, {}))))

    def data(self):
        """The same for --json: seconds of the launcher before the study, and a dictionary a command."""
        names = ("command", "where", "seconds", "operator", "phases", "counts")
        return {"start-up": self._before, "commands": [dict(zip(names, row)) for row in self.commands]}

    def table(self):
        """The report, a text of several lines."""
        total = self._before + time.perf_counter() - self._start
        rows = [("start-up", "", self._before, 0.0, self._before)]
        lines = ["", "Timings, seconds", f"  {'':42} {'all':>8} {'Python':>8} {'operator':>8}"]
        for command, where, seconds, process, phases, counts in self.commands:
            rows.append((command, where, seconds - process, process, seconds))
            lines.append(f"  {command + '  ' + where:42} {seconds:8.3f} {seconds - process:8.3f} {process:8.3f}")
            for phase, value in phases.items():
                lines.append(f"      {phase:38} {'':8} {'':8} {value:8.3f}")
            if counts:
                lines.append("      " + ", ".join(f"{name} {value:.6g}" for name, value in counts.items()))
        commands = sum(row[4] for row in rows[1:])
        lines.insert(3, f"  {'start-up of the launcher':42} {self._before:8.3f}")
        lines.append(f"  {'Python between commands, saving':42} {max(0.0, total - self._before - commands):8.3f}")
        lines.append(f"  {'total':42} {total:8.3f}")
        return "\n".join(lines)


def _age_of_process():
    """Seconds since this process was started."""
    try:
        with open("/proc/self/stat", encoding="ascii", errors="replace") as file:
            ticks = int(file.read().rpartition(")")[2].split()[19])
        return max(0.0, time.clock_gettime(time.CLOCK_BOOTTIME) - ticks / os.sysconf("SC_CLK_TCK"))
    except (OSError, ValueError, AttributeError):
        return 0.0
