"""What tests of whole studies share: a run of the launcher in a folder of its own, and what it left."""

import hashlib
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import types
import unittest

import numpy as np

SOURCE = pathlib.Path(os.environ["LACON_SOURCE_DIR"])
LACON = pathlib.Path(os.environ["LACON_BIN"]) / "lacon"
PEER_MESHES = pathlib.Path(os.environ["LACON_SHARED_CASES"]) / "meshes"
PATIENCE = int(os.environ.get("LACON_PATIENCE", "1"))  # how many times as slow as others a build may be
SECONDS = 300 * PATIENCE

sys.path.insert(0, str(SOURCE / "commands/studies"))
from meshes import block, union  # noqa: E402


def content(folder):
    """Every file below a folder, with a digest of its content."""
    return {str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest()
            for path in sorted(folder.rglob("*")) if path.is_file()}


def two_columns():
    """(mesh, lower, upper): columns of height 1 on one another, LOW with BASE and CBOT, UP with CTOP and TOP; groups of the upper left node
    EDGE and of the one below it CORNER."""
    low = block("QUAD4", np.linspace(0, 1, 4), np.linspace(0, 1, 3), name="LOW", sides={"bottom": "BASE", "top": "CBOT"})
    up = block("QUAD4", np.linspace(0, 1, 3), np.linspace(1, 2, 3), name="UP", sides={"bottom": "CTOP", "top": "TOP"})
    mesh = union([low, up])
    for name, corner in (("EDGE", (0, 2)), ("CORNER", (0, 1))):
        mesh.node_groups[name] = [len(low.points) + i for i, point in enumerate(up.points) if tuple(point) == corner]
    return mesh, low, up


class StudyTest(unittest.TestCase):
    """A test with an empty folder, in which studies run."""

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="lacon_study_"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def run_lacon(self, *arguments, **environment):
        """@return .status, .stdout, .stderr, .checks (of --json), .diagnostic (last line)"""
        report = self.folder / "checks.json"
        report.unlink(missing_ok=True)
        done = self.run_tool(*arguments, "--json", report, **environment)
        checks = json.loads(report.read_text(encoding="utf-8"))["checks"] if report.exists() else None
        lines = done.stdout.strip().splitlines()
        return types.SimpleNamespace(status=done.returncode, stdout=done.stdout, stderr=done.stderr, checks=checks,
                                     diagnostic=lines[-1] if lines else "")

    def run_tool(self, *arguments, **environment):
        """`lacon convert`, `lacon check` and the like. @return the finished process"""
        return subprocess.run([LACON, *map(str, arguments)], cwd=self.folder, capture_output=True, text=True, timeout=SECONDS,
                              stdin=subprocess.DEVNULL, env={**os.environ, **environment})

    def run_study(self, comm, *arguments, **environment):
        """Run a command file of the tests with its base in the test's folder."""
        return self.run_lacon(comm, "--base", self.folder / f"{pathlib.Path(comm).stem}.base", *arguments, **environment)

    def assert_all_ok(self, run, count):
        """The run ended well and made `count` checks, each of them OK."""
        self.assertEqual(run.status, 0, run.stdout[-4000:] + run.stderr[-4000:])
        self.assertEqual(run.diagnostic, "--- DIAGNOSTIC JOB : OK")
        self.assertEqual([c["status"] for c in run.checks], ["OK"] * count)
