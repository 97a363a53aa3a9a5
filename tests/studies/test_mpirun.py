"""lacon_mpirun: what Open MPI keeps in files is gone when it has ended; what one leaves that is killed itself goes with the next one."""

import contextlib
import os
import pathlib
import shutil
import signal
import subprocess
import time
import unittest

from study_test import LACON, StudyTest
from test_parts import PETSC, PartsTest, session_of

PROGRAM = LACON.with_name("lacon_mpirun")
MEMORY = pathlib.Path("/dev/shm")
#: a program in the place of mpirun, that makes a file in each of its folders and says where
TALKS = 'touch "$TMPDIR/file" "$LACON_MPI_MEMORY/file" && echo "$TMPDIR $LACON_MPI_MEMORY"; '


@unittest.skipUnless(PROGRAM.exists(), "built without PETSc")
class Folders(StudyTest):
    def setUp(self):
        super().setUp()
        self.tmp = self.folder / "tmp"
        self.tmp.mkdir()

    @contextlib.contextmanager
    def started(self, script, before=""):
        """@return the process, and the folders that its program has been given"""
        with subprocess.Popen([PROGRAM, "sh", "-c", before + TALKS + script], env={**os.environ, "TMPDIR": str(self.tmp)}, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, text=True) as process:
            folders = [pathlib.Path(name) for name in process.stdout.readline().split()]
            self.assertEqual([folder.parent for folder in folders], [self.tmp, MEMORY])
            yield process, folders

    def assert_there(self, folders, are_there):
        self.assertEqual([folder.exists() for folder in folders], [are_there] * len(folders))

    def test_it_ends_as_its_program(self):
        with self.started("exit 3") as (process, folders):
            self.assertEqual(process.wait(5), 3)
            self.assert_there(folders, False)
        with self.started("kill -SEGV $$") as (process, folders):
            self.assertEqual(process.wait(5), -signal.SIGSEGV)
            self.assert_there(folders, False)
        self.assertEqual(subprocess.run([PROGRAM, "/nowhere/mpirun"], stdin=subprocess.DEVNULL, check=False, timeout=5).returncode, 127)

    def test_who_is_asked_to_end_leaves_nothing(self):
        """Also where the program does not listen."""
        for script, before, status in (("exec sleep 60", "", -signal.SIGTERM), ("sleep 4; sleep 4", "trap '' TERM; ", -signal.SIGKILL)):
            with self.started(script, before) as (process, folders):
                process.terminate()
                self.assertEqual(process.wait(5), status)
                self.assert_there(folders, False)

    def test_a_stopped_one_ends_with_its_parent(self):
        """Whoever has started it is killed, and cannot continue it. Without that it stays as long as its parent is there."""
        script = f"'{PROGRAM}' sh -c '{TALKS}exec sleep 60' & echo $!; wait"
        with subprocess.Popen(["sh", "-c", script], env={**os.environ, "TMPDIR": str(self.tmp)}, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True,
                              start_new_session=True) as parent:
            process = int(parent.stdout.readline())
            folders = [pathlib.Path(name) for name in parent.stdout.readline().split()]
            try:
                os.kill(process, signal.SIGCONT)
                time.sleep(0.2)
                self.assert_there(folders, True)
                os.kill(process, signal.SIGSTOP)
                parent.kill()
                for _ in range(500):
                    if not session_of(parent.pid):
                        break
                    time.sleep(0.01)
                self.assertEqual(session_of(parent.pid), {})
                self.assert_there(folders, False)
            finally:
                for left in session_of(parent.pid):
                    os.kill(left, signal.SIGKILL)

    def test_what_a_killed_one_leaves_goes_with_the_next_one(self):
        with self.started("exec sleep 60") as (living, of_living):
            with self.started("exec sleep 60") as (killed, left):
                killed.kill()
                killed.wait(5)
                self.assert_there(left, True)
            others = [self.tmp / "lacon_mpi.other", self.tmp / "lacon_mpi.empty", self.tmp / "lacon"]
            for other in others:
                other.mkdir()
            (others[0] / "host").write_text("another machine")
            with self.started("exit 0") as (process, _):
                self.assertEqual(process.wait(5), 0)
            self.assert_there(left, False)
            self.assert_there([*of_living, *others], True)
            living.terminate()
            living.wait(5)

    def test_folders_that_cannot_be_made(self):
        """mpirun says itself what it cannot do there."""
        done = subprocess.run([PROGRAM, "sh", "-c", "echo $TMPDIR"], env={**os.environ, "TMPDIR": "/nowhere"}, stdin=subprocess.DEVNULL, capture_output=True,
                              text=True, check=False, timeout=5)
        self.assertEqual((done.returncode, done.stdout), (0, "/nowhere\n"))


@unittest.skipUnless(PROGRAM.exists() and shutil.which("mpirun"), "built without PETSc, or there is no mpirun")
class Killed(PartsTest):
    """Runs whose launcher is killed: nothing is left where Open MPI has its files."""

    environment = PETSC

    def test_a_killed_run_leaves_no_file(self):
        tmp = self.folder / "t" / ("m" * 90)  # longer than the name of a socket may be
        tmp.mkdir(parents=True)
        before = set(MEMORY.iterdir())
        for order in (1, 2, 3):
            with self.started(f"killed{order}", order, INSTANTS="4", TMPDIR=str(tmp)) as (run, _):
                made = set(MEMORY.iterdir()) - before
                self.assertTrue(any(tmp.glob("lacon_mpi.*/ompi.*")))
                self.assertTrue(any(path.is_dir() and any(path.glob("vader_segment*")) for path in made), made)
                run.kill()
            self.assertEqual(list(tmp.iterdir()), [])
            self.assertEqual(made & set(MEMORY.iterdir()), set())

    def test_any_process_is_killed(self):
        """What a keeper of mpirun cannot remove any more the operator does; one process by itself makes no files."""
        before, tmp = set(MEMORY.iterdir()), self.folder / "t"
        tmp.mkdir()
        for self.count, names in ((2, ("lacon_petsc", "mpirun", "lacon_mpirun", "stat_non_line")), (1, ("lacon_petsc", "stat_non_line", "group"))):
            self.two = ("--mpi", str(self.count))
            for name in names:
                with self.subTest(name, processes=self.count):
                    with self.started(f"{name}{self.count}", 1, INSTANTS="4", TMPDIR=str(tmp)) as (run, processes):
                        if name == "group":
                            os.killpg(run.pid, signal.SIGKILL)
                        else:
                            os.kill(processes[name][-1], signal.SIGKILL)
                    self.assertEqual(run.returncode, {"group": -signal.SIGKILL, "stat_non_line": 4}.get(name, 3), run.said)
                    self.assertEqual([list(tmp.iterdir()), set(MEMORY.iterdir()) - before], [[], set()])

    def test_a_stopped_process_ends_with_a_killed_run(self):
        """mpirun, who keeps it, or a rank."""
        before, tmp = set(MEMORY.iterdir()), self.folder / "t"
        tmp.mkdir()
        for name in ("lacon_mpirun", "mpirun", "lacon_petsc"):
            with self.subTest(name), self.started(name, 1, INSTANTS="4", TMPDIR=str(tmp)) as (run, processes):
                os.kill(processes[name][-1], signal.SIGSTOP)
                run.kill()
                run.wait()
                for _ in range(1000):
                    if not session_of(run.pid):
                        break
                    time.sleep(0.01)
                left = session_of(run.pid)
                for process in left:
                    os.kill(process, signal.SIGKILL)
                self.assertEqual(left, {})
            self.assertEqual(list(tmp.iterdir()), [])
            self.assertEqual(set(MEMORY.iterdir()) - before, set())


if __name__ == "__main__":
    unittest.main()
