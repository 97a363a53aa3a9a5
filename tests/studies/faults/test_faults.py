"""A computation that is ended in its middle, whatever ends it: the instants that were told as converged are in the base, and the same
command file run again computes what is missing to the same bits."""

import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import time
import unittest

import h5py
import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

from study_test import LACON, SECONDS, StudyTest  # noqa: E402, I001 (it says where meshes.py is)
from meshes import block, union, write_med  # noqa: E402

STUDY = HERE / "study.comm"
INSTANTS = 20


def stack(fineness):
    """A block with a round foot on two others, meshes that do not match."""
    def lines(first, last, steps):
        return np.linspace(first, last, steps + 1)

    def foot(s, t):
        return s, 1.0 + t + (1 - t) * 0.08 * (s - 1.6) ** 2

    return union([
        block("QUAD8", lines(0, 4, 4 * fineness), lines(-1, 0, 2 * fineness), name="LOWER", sides={"bottom": "BASE", "top": "GROUND"}),
        block("QUAD8", lines(0, 3, 3 * fineness + 1), lines(0, 1, 2 * fineness), name="MIDDLE",
              sides={"bottom": "SOLE", "top": "TABLE", "left": "LEFT", "right": "RIGHT"}),
        block("QUAD8", lines(1, 2.2, 2 * fineness), lines(0, 1, 2 * fineness), place=foot, name="UPPER", sides={"bottom": "FOOT", "top": "TOP"})])


def converged(text):
    """The instants that a run told as converged."""
    return re.findall(r"Converged at the instant (\S+)", text)


class FaultTest(StudyTest):
    """A test whose folder holds a mesh, and runs that are ended in their middle."""

    fineness = 2

    def setUp(self):
        super().setUp()
        write_med(self.folder / "stack.med", stack(self.fineness))
        self.environment = {}

    def command(self, base, *more):
        return [str(LACON), str(STUDY), "--base", str(self.folder / base), "--unit", f"20={self.folder / 'stack.med'}", *map(str, more)]

    def start(self, base, *more, **options):
        """A run under way, its output in a pipe."""
        return subprocess.Popen(self.command(base, *more), cwd=self.folder, env={**os.environ, **self.environment}, text=True,
                                stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, **options)

    def whole(self, base, *more):
        """A run to its end. @return what it said"""
        run = self.start(base, *more)
        text, _ = run.communicate(timeout=SECONDS)
        self.assertEqual(run.returncode, 0, text[-3000:])
        return text

    def until(self, run, count):
        """What a run says until it has told `count` instants as converged."""
        text = ""
        while len(converged(text)) < count:
            line = run.stdout.readline()
            self.assertTrue(line, text[-3000:])
            text += line
        return text

    def poursuite(self, base, lines):
        """A file that goes on with what a base holds. @return the run"""
        (self.folder / "more.comm").write_text(f"POURSUITE()\n{lines}\nFIN()\n", encoding="utf-8")
        return self.run_lacon("more.comm", "--base", self.folder / base)

    def index(self, base):
        """The index of the one result."""
        (path,) = (self.folder / base).glob("result_*/index.h5")
        return path

    def instants(self, base):
        with h5py.File(self.index(base)) as file:
            return [f"{instant:.9g}" for instant in file["instant"][1:]]


def operator_of(launcher):
    """Process id of the operator that a launcher has started."""
    for task in pathlib.Path(f"/proc/{launcher}/task").iterdir():
        for child in (task / "children").read_text().split():
            if "stat_non_line" in pathlib.Path(f"/proc/{child}/comm").read_text():
                return int(child)
    raise AssertionError("no operator")


class Kept(FaultTest):
    """What converged is kept under its name."""

    def check_kept(self, base, told):
        """Every instant told is in the index, and POURSUITE finds them, and says that the result is unfinished and where it ends."""
        there = self.instants(base)
        self.assertEqual(there[:len(told)], told)
        self.assertLess(len(there), INSTANTS)
        run = self.poursuite(base, f"print('it has', len(RESULT.getAccessParameters()['INST']))\nassert abs(RESULT.getField('DEPL', {len(there)}).getValues()[0]) < 1")
        self.assertEqual(run.status, 0, run.stdout + run.stderr)
        self.assertIn(f"it has {len(there) + 1}", run.stdout)
        self.assertIn("<A> <STUDY_31> RESULT is unfinished", run.stderr)
        self.assertIn(f"its last instant is {there[-1]}", run.stderr)

    def test_an_operator_is_killed(self):
        run = self.start("s.base")
        text = self.until(run, 3)
        os.kill(operator_of(run.pid), signal.SIGKILL)
        text += run.communicate(timeout=SECONDS)[0]
        self.assertEqual(run.returncode, 4, text)
        self.assertIn("INTERNAL_3", text)
        self.check_kept("s.base", converged(text))

    def test_a_launcher_is_killed(self):
        run = self.start("s.base", start_new_session=True)
        text = self.until(run, 3)
        os.killpg(run.pid, signal.SIGKILL)
        text += run.communicate(timeout=SECONDS)[0]
        self.check_kept("s.base", converged(text))

    def test_a_function_ends_in_the_middle(self):
        """<F> at the instant 0.55: a formula has no value there."""
        text = STUDY.read_text(encoding="utf-8").replace("GROUP_MA=\"TOP\", DX=ASIDE, DY=DOWN", "GROUP_MA=\"TOP\", DX=ASIDE, DY=HALF")
        text = text.replace("ASIDE = ", 'HALF = DEFI_FONCTION(NOM_PARA="INST", VALE=(0.0, 0.0, 0.52, -0.01))\nASIDE = ')
        (self.folder / "half.comm").write_text(text, encoding="utf-8")
        run = self.run_lacon("half.comm", "--base", "s.base", "--unit", "20=stack.med")
        self.assertEqual(run.status, 2, run.stdout[-2000:])
        self.assertIn("FUNCTION_1", run.stderr)
        self.assertEqual(len(converged(run.stdout)), 10)
        self.check_kept("s.base", converged(run.stdout))

    def test_the_index_can_be_read_at_any_moment(self):
        most = 0
        run = subprocess.Popen(self.command("s.base"), cwd=self.folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
        while run.poll() is None:
            for path in (self.folder / "s.base").glob("result_*/index.h5"):
                with h5py.File(path) as file:
                    self.assertGreaterEqual(len(file["instant"]), max(2, most))
                    most = len(file["instant"])
                    for entry in file["fields"].values():
                        self.assertTrue(all((self.folder / "s.base" / name).is_file() for name in entry["file"].asstr()[:]))
        self.assertEqual((run.returncode, most), (0, INSTANTS + 1))


class Ends(FaultTest):
    """No operator outlives its launcher, and both end within two seconds."""

    MOMENT = 2.0

    def is_alive(self, process):
        try:
            return pathlib.Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
        except OSError:
            return False

    def ended_by(self, number, whom=lambda run: run.pid, how=os.kill):
        """A run that gets a signal after two instants; no operator is left. @return its exit status, what it said"""
        run = self.start("s.base", start_new_session=True)
        text = self.until(run, 2)
        operator, start = operator_of(run.pid), time.monotonic()
        how(whom(run), number)
        text += run.communicate(timeout=SECONDS)[0]
        while self.is_alive(operator) and time.monotonic() < start + SECONDS:
            time.sleep(0.01)
        self.assertLess(time.monotonic() - start, self.MOMENT)
        self.assertEqual(self.instants("s.base")[:2], converged(text)[:2])
        return run.returncode, text

    def test_the_launcher_is_killed(self):
        self.assertEqual(self.ended_by(signal.SIGKILL)[0], -signal.SIGKILL)

    def test_the_launcher_is_asked_to_end(self):
        for number in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP):
            status, text = self.ended_by(number)
            self.assertEqual(status, 4, text)
            self.assertIn(f"<F> <STUDY_18> the run was ended by {number.name}\n    where: {STUDY}:", text)
            self.assertIn("COMMAND_14", text)
            shutil.rmtree(self.folder / "s.base")

    def test_both_are_interrupted(self):
        """As by Ctrl-C in a terminal."""
        status, text = self.ended_by(signal.SIGINT, lambda run: os.getpgid(run.pid), os.killpg)
        self.assertEqual(status, 4, text)
        self.assertIn(f"<F> <STUDY_18> the run was ended by SIGINT\n    where: {STUDY}:", text)

    def test_the_time_limit_is_over(self):
        (self.folder / "s.export").write_text(f"P time_limit 2.5\nF comm {STUDY} D 1\nF libr {self.folder}/stack.med D 20\n", encoding="utf-8")
        self.environment["FAULTS_LAW"] = "VMIS_ISOT_LINE"
        write_med(self.folder / "stack.med", stack(8))
        run = self.run_tool("s.export", "--base", "s.base", FAULTS_LAW="VMIS_ISOT_LINE")
        self.assertEqual(run.returncode, 3, run.stdout[-2000:] + run.stderr)
        self.assertIn(f"<S> <STUDY_25> the time limit of 2.5 s is over\n    where: {STUDY}:", run.stderr)

    def test_who_uses_the_base(self):
        run = self.start("s.base")
        self.until(run, 1)
        other = self.run_tool(*self.command("s.base")[1:])
        self.assertEqual(other.returncode, 2, other.stdout)
        self.assertIn(f"in use by another run: process {run.pid}, since 20", other.stderr)
        self.assertEqual(run.wait(SECONDS), 0, run.communicate())
        run.stdout.close()

    def test_the_next_run_waits_for_the_operator_of_one_that_was_killed(self):
        run = self.start("s.base")
        self.until(run, 1)
        run.kill()
        run.communicate()
        self.whole("s.base")


if __name__ == "__main__":
    unittest.main()
