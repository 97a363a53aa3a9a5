"""A study of 20 instants and two zones that is killed at random moments (its launcher, its operator, both; KILL, TERM, INT), each time followed
by the same command: no instant that was told as converged is lost, no process is left, and in the end everything is bit for bit what
a run is that nothing disturbed. FAULTS_SEED chooses other moments. What explains a failure is kept in the folder that its message names."""

import contextlib
import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

sys.path[:0] = [str(pathlib.Path(__file__).resolve().parent)]

from test_faults import FaultTest, children_of, content_of, converged  # noqa: E402, I001 (it says where study_test.py is)
from study_test import SECONDS  # noqa: E402

MOMENT = 2.5  # seconds after which nothing is left


def session_of(leader):
    """What is alive of the processes that a leader of a session has started, and those that they have: process -> its line in /proc."""
    found = {}
    for path in pathlib.Path("/proc").glob("[0-9]*/stat"):
        with contextlib.suppress(OSError):  # it has just gone
            text = path.read_text()
            state, _, _, session = text.rpartition(")")[2].split()[:4]
            if int(session) == leader and state != "Z":
                found[int(path.parent.name)] = text
    return found


class Killed(FaultTest):
    def kill(self, wait, whom, number):
        """Start the study, and end it after so many seconds. @return its exit status, what it said"""
        self.kills.append({"whom": whom, "signal": number.name, "after": wait, "load": os.getloadavg()[0]})
        with tempfile.TemporaryFile("w+") as said:
            run = subprocess.Popen(self.command("s.base"), cwd=self.folder, env={**os.environ, **self.environment}, stdin=subprocess.DEVNULL,
                                   stdout=said, stderr=subprocess.STDOUT, start_new_session=True)
            try:
                run.wait(wait)
            except subprocess.TimeoutExpired:
                children = children_of(run.pid)
                if whom == "group":
                    os.killpg(run.pid, number)
                elif whom == "operator" and children:
                    with contextlib.suppress(ProcessLookupError):  # it has come to its end meanwhile
                        os.kill(children[0], number)
                else:
                    run.send_signal(number)
                self.kills[-1]["children"] = children
                self.wait_for_the_end(run)
            said.seek(0)
            self.kills[-1].update(status=run.wait(SECONDS), said=said.read())
            return run.returncode, self.kills[-1]["said"]

    def wait_for_the_end(self, run):
        """No process of a run that was killed is there after a moment; one whose operator alone was killed takes its time to say so."""
        run.wait(SECONDS)
        start = time.monotonic()
        while left := session_of(run.pid):
            self.assertLess(time.monotonic() - start, MOMENT, f"an operator outlives its launcher: {left}")
            time.sleep(0.01)

    def check(self, kills):
        """So many kills; what failed is kept: both bases, and each kill with its moment and what the run said."""
        self.kills = []
        try:
            self.kill_and_compare(kills, int(os.environ.get("FAULTS_SEED", "1")))
        except BaseException as error:
            kept = pathlib.Path(tempfile.mkdtemp(prefix="killed_", dir=pathlib.Path(os.environ["LACON_BINARY_DIR"]) / "tests"))
            shutil.copytree(self.folder, kept, dirs_exist_ok=True)
            (kept / "kills.json").write_text(json.dumps({"failed": repr(error), "environment": self.environment, "kills": self.kills}, indent=1),
                                             encoding="utf-8")
            print(f"what explains it is kept in {kept}", file=sys.stderr)
            raise

    def kill_and_compare(self, kills, seed):
        chance = random.Random(seed)
        self.environment = {"FAULTS_LAW": "VMIS_ISOT_LINE", **({"LACON_RESTART_ALWAYS": "1"} if chance.random() < 0.5 else {})}
        start = time.monotonic()
        self.whole("whole.base")
        whole, expected = time.monotonic() - start, content_of(self.folder / "whole.base")
        told, ended, done = set(), {}, 0
        while done < kills:
            whom, number = chance.choice(("launcher", "operator", "group")), chance.choice((signal.SIGKILL, signal.SIGTERM, signal.SIGINT))
            status, text = self.kill(chance.uniform(0, 0.8 * whole), whom, number)
            told |= set(converged(text))
            if status == 0:
                self.compare(expected)
                told = set()
                shutil.rmtree(self.folder / "s.base")
                continue
            done += 1
            ended[whom, number.name] = ended.get((whom, number.name), 0) + 1
            self.assertEqual(told - self.there(), set(), f"lost after {done} kills: {whom}, {number.name}\n{text[-2000:]}")
        text = self.whole("s.base")
        self.compare(expected)
        print(f"{done} kills of {len(ended)} kinds, each followed by the same command: no instant lost, no process left, the same bits")

    def there(self):
        """The instants in the base, none where it has no result yet."""
        return set(self.instants("s.base")) if list((self.folder / "s.base").glob("result_*/index.h5")) else set()

    def compare(self, expected):
        found = content_of(self.folder / "s.base")
        self.assertEqual(sorted(map(str, found)), sorted(map(str, expected)))
        self.assertEqual([key for key in expected if found[key] != expected[key]], [])


class Short(Killed):
    def test_killed_8_times(self):
        self.check(8)


class Long(Killed):
    def test_killed_200_times(self):
        self.check(200)


if __name__ == "__main__":
    unittest.main()
