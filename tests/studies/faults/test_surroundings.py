"""What a shell or a batch system may give a run: standard streams that are closed, limits of files and of the stack. The study comes to the same end, or says what is
wrong and comes to it when it is run again."""

import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))

from study_test import LACON, SECONDS  # noqa: E402, I001
from test_threads import datasets  # noqa: E402

from meshes import write_med  # noqa: E402

from .small_study import SmallStudy  # noqa: E402
from .test_faults import INSTANTS, STUDY, FaultTest, converged, stack  # noqa: E402

UNITS = "--unit 20=blocks.med --unit 80=s.rmed --unit 81=s.vtu --unit 8=s.txt"


class Surroundings(SmallStudy):
    def shell(self, line):
        """A line of a shell in which LACON runs the study. @return the process"""
        line = line.replace("LACON", f"'{LACON}' study.comm --base s.base {UNITS}")
        return subprocess.run(["sh", "-c", line], cwd=self.folder, capture_output=True, text=True, timeout=SECONDS, check=False)

    def test_streams_that_are_closed(self):
        self.assertEqual(self.run_small("whole").returncode, 0)
        expected = datasets(self.folder / "whole.base")
        for closed in (">&-", "<&- >&- 2>&-"):
            run = self.shell(f"LACON --fresh {closed}")
            self.assertEqual(run.returncode, 0, f"{closed}: {run.stdout[-500:]}{run.stderr}")
            self.assertNotIn("Traceback", run.stdout + run.stderr)
            found = datasets(self.folder / "s.base")
            self.assertEqual([key for key in expected if key[0].endswith(".h5") and found.get(key) != expected[key] and "index" not in key[0]], [])

    def test_files_may_not_grow_beyond_a_limit(self):
        """`ulimit -f`, in blocks of 512 bytes: as a disk that is full."""
        for blocks in (1, 20):
            run = self.shell(f"ulimit -f {blocks}; LACON")
            self.assertEqual(run.returncode, 2, f"{blocks}: {run.stdout[-500:]}{run.stderr}")
            self.assertIn("File too large", run.stderr)
            self.assertNotIn("Traceback", run.stderr)
        run = self.shell("LACON")
        self.assertEqual(run.returncode, 0, run.stderr)

    def test_a_stack_that_is_too_small(self):
        """`ulimit -s`, in kB: a soft limit is raised, a hard one is told; operators ended by SIGSEGV, an internal error."""
        run = self.shell("ulimit -s 100; LACON")
        self.assertEqual(run.returncode, 2, run.stdout[-500:] + run.stderr)
        self.assertIn("<F> <STUDY_48> the stack of a process is limited to 100 kB (ulimit -s)", run.stderr)
        run = self.shell("ulimit -S -s 100; LACON")
        self.assertEqual(run.returncode, 0, run.stderr)
        for enough in ("-s 512", "-s unlimited"):
            run = self.shell(f"ulimit {enough}; LACON --fresh")
            self.assertEqual(run.returncode, 0, f"{enough}: {run.stderr}")


class Limits(FaultTest):
    def test_runs_that_a_time_limit_ends_come_further_each_time(self):
        """Limits that are too short for the whole: what converged is kept, and the next run begins behind it."""
        self.environment = {"FAULTS_LAW": "VMIS_ISOT_LINE", "LACON_RESTART_ALWAYS": "1"}
        write_med(self.folder / "stack.med", stack(6))
        limit, kept, ends = 0.5, [], []
        while len(ends) < 2:
            (self.folder / "s.export").write_text(f"P time_limit {limit}\nF comm {STUDY} D 1\nF libr {self.folder}/stack.med D 20\n", encoding="utf-8")
            run = self.run_tool("s.export", "--base", "s.base", **self.environment)
            told = kept + converged(run.stdout)
            if run.returncode == 0:
                break
            self.assertEqual(run.returncode, 3, run.stdout[-2000:] + run.stderr)
            if told != kept:
                self.assertEqual(self.instants("s.base")[:len(told)], told)  # each once, in their order
                kept = self.instants("s.base")
                ends.append(len(kept))
            else:
                limit *= 2
        self.assertGreaterEqual(len(ends), 1)
        self.whole("s.base")
        self.assertEqual(self.instants("s.base"), [f"{i / INSTANTS:.9g}" for i in range(1, INSTANTS + 1)])
