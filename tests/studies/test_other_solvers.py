"""The peer's cases and the verification studies with other solvers than their command files ask for: two and three processes, and PETSC (label `long`)."""

import functools
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import peer_checks
from study_test import LACON, PEER_MESHES, SOURCE

HERE = pathlib.Path(__file__).resolve().parent
PROGRAM = LACON.with_name("lacon_petsc")
CASES = ("ssnp170a", "ssnp170k", "ssnp170m", "ssnp170p", "ssnp170r", "ssnp170w", "ssnp170z", "ssnp173a", "ssnv104k", "ssnv104n", "ssnp165c", "ssnp165e",
         "zzzz383a", "zzzz383c", "zzzz383d", "zzzz383e")
#: errors of manufactured solutions, on the first two meshes
MANUFACTURED = ("ssnp150c", "ssnp150f", "ssnv219e", "ssnv219g", "ssnv219i", "ssnv219k", "ssnv219l")
#: where factors say by their inertia that a matrix is unstable, and the next iteration has another one; where iterates of the one meet a kink of the
#: gap that those of the other pass by (7 more in one of 20 instants)
SNAPPING = ("ssnp165c", "ssnp165e")
VERIFICATION = ("test_patch", "test_patch_3d", "test_quadratic", "test_hertz", "test_hertz_axis", "test_families", "test_statuses", "test_initial_state",
                "test_modelisations", "test_loads", "test_thermal", "test_contact.Contact", "test_behaviours.Behaviours", "test_behaviours.Prediction",
                "test_large_strain.Upsetting",
                "test_norms", "test_derived_fields", "test_patch_space.PatchInSpace")


#: what asks for more than iterations give: inertia, relations that say the same twice, pressures of open patches that are zero to the last bit, digits
#: beyond RESI_GLOB_RELA, or a RESI_GLOB_RELA beyond RESI_RELA
OF_FACTORS = ("test_statuses", "test_modelisations", "test_loads", "test_thermal", "test_behaviours.Prediction",
              "test_patch_space.PatchInSpace")


def environment(folder, **solver):
    """That of a test whose studies have another solver: in the place of LACON_BIN a folder in which `lacon` is with_solver.py."""
    programs = pathlib.Path(folder) / "programs"
    programs.mkdir()
    for program in LACON.parent.iterdir():
        if program != LACON:
            (programs / program.name).symlink_to(program)
    launcher = programs / "lacon"
    launcher.write_text(f"#!{sys.executable}\n" + HERE.joinpath("with_solver.py").read_text(encoding="utf-8"), encoding="utf-8")
    launcher.chmod(0o755)
    return {**os.environ, "LACON_BIN": str(programs), **solver}


@functools.cache
def values(case, **solver):
    """@return field -> values of its checks, and the iterations of Newton of each instant"""
    with tempfile.TemporaryDirectory() as folder:
        comms, meshes = peer_checks.files(case)
        units = {**{unit: pathlib.Path(folder) / f"out.{unit}" for unit in (29, 33, 40, 80)},
                 **{unit: PEER_MESHES / mesh for unit, mesh in meshes.items()}}
        report = pathlib.Path(folder) / "checks.json"
        surroundings = environment(folder, **solver) | {"CASE": case, "RESIDUAL": "1e-3"} | ({"MESHES": "2"} if case in MANUFACTURED else {})
        run = subprocess.run([pathlib.Path(surroundings["LACON_BIN"]) / "lacon", *(HERE / comm for comm in comms), "--base", "study.base", "--json", report,
                              *(word for unit, path in units.items() for word in ("--unit", f"{unit}={path}"))],
                             cwd=folder, capture_output=True, text=True, stdin=subprocess.DEVNULL, env=surroundings)
        if run.returncode not in (0, 5):
            raise AssertionError(f"{case}: exit status {run.returncode}\n{run.stdout[-3000:]}{run.stderr[-3000:]}")
        found = {}
        if case in MANUFACTURED:
            found["ERRORS"] = [float(word) for word in re.findall(r"[\d.e+-]+", re.search(f"ERRORS {case} (.*)", run.stdout)[1])]
        else:
            for row, check in zip(peer_checks.rows(case), json.loads(report.read_text(encoding="utf-8"))["checks"]):
                found.setdefault(row["field"], []).append(check["value"])
        return found, [int(count) for count in re.findall(r"Converged at the instant \S+ with (\d+)", run.stdout)]


class OtherSolver:
    """Of one solver: `solver` is what the environment has more, `agreement` how well values agree with those of a factor, of the largest one of the same
    field, `iterations` how many of Newton's an instant may take more or less."""

    verification = VERIFICATION

    def test_peer_cases(self):
        for case in (*CASES, *MANUFACTURED):
            with self.subTest(case=case):
                exact, expected = values(case)
                found, counts = values(case, **self.solver)
                for field, wanted in exact.items():
                    scale = max(map(abs, wanted), default=0)
                    for one, other in zip(wanted, found[field]):
                        self.assertLessEqual(abs(one - other), self.agreement * scale, f"{field}: {one} and {other}")
                self.assertEqual(len(counts), len(expected))
                if case in SNAPPING:
                    self.assertAlmostEqual(sum(expected), sum(counts), delta=self.iterations * len(counts))
                    continue
                for one, other in zip(expected, counts):
                    self.assertAlmostEqual(one, other, delta=self.iterations)

    def test_verification_studies(self):
        for module in self.verification:
            with self.subTest(module=module), tempfile.TemporaryDirectory() as folder:
                run = subprocess.run([sys.executable, "-B", "-m", "unittest", module], cwd=SOURCE / "tests/verification", capture_output=True, text=True,
                                     env=environment(folder, **self.solver))
                self.assertEqual(run.returncode, 0, run.stderr[-3000:])


@unittest.skipUnless(PEER_MESHES.is_dir(), "no meshes of the peer")
class TwoProcesses(OtherSolver, unittest.TestCase):
    solver, agreement, iterations = {"LACON_MPI": "2", "LACON_MPI_FROM": "1"}, 1e-9, 0


@unittest.skipUnless(PEER_MESHES.is_dir(), "no meshes of the peer")
class ThreeProcesses(OtherSolver, unittest.TestCase):
    solver, agreement, iterations = {"LACON_MPI": "3", "LACON_MPI_FROM": "1"}, 1e-9, 0


@unittest.skipUnless(PEER_MESHES.is_dir() and PROGRAM.exists(), "no meshes of the peer, or no PETSc")
class Iterations(OtherSolver, unittest.TestCase):
    """To ten times RESI_GLOB_RELA, which is 1e-6."""

    solver, agreement, iterations = {"LACON_TEST_SOLVER": "PETSC"}, 1e-5, 1
    verification = tuple(module for module in VERIFICATION if module not in OF_FACTORS)


if __name__ == "__main__":
    unittest.main()
