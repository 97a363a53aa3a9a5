"""A study gives the same results whether a factor or iterations of PETSc solve its linear systems; without PETSc it is refused."""

import json
import os
import pathlib
import re
import shutil
import sys
import unittest

import numpy as np
from study_test import SOURCE, StudyTest
from test_precision import Precision as Blocks
from test_precision import two_blocks

from meshes import brick, write_med
from results import Result

sys.path.append(str(SOURCE / "tests/bench"))
import scaling  # noqa: E402

PROGRAM = pathlib.Path(os.environ["LACON_BIN"]) / "lacon_petsc"
#: of the largest value: ten times the RESI_GLOB_RELA of these studies, or of those that ask for less
AGREEMENT = 1e-5
#: processes share the factors of small matrices too
SHARED = {"LACON_MPI_FROM": "1"}


def assert_same(test, one, other, agreement=AGREEMENT):
    """Components of a field on nodes: name -> values, NaN where a node has none."""
    test.assertEqual(one.keys(), other.keys())
    largest = max(np.nanmax(np.abs(values)) for name, values in one.items() if name != "LAGS_C")
    for name, values in one.items():
        scale = np.nanmax(np.abs(values)) if name == "LAGS_C" else largest
        test.assertLessEqual(np.nanmax(np.abs(other[name] - values)), agreement * scale, name)


@unittest.skipUnless(PROGRAM.exists(), "built without PETSc")
class Petsc(StudyTest):
    solve = Blocks.solve

    def test_two_blocks_of_unequal_stiffness(self):
        write_med(self.folder / "blocks.med", two_blocks(1.0, (7, 6, 3)))
        case = {"NU": "0.3", "CONTRAST": "1e3", "SLENDER": "0"}
        exact, direct, _ = self.solve("double", case)
        found, counts, said = self.solve("petsc", case | {"PRE_COND": "GAMG"})
        assert_same(self, exact, found)
        self.assertNotIn("SOLVER_7", said)
        self.assertEqual((counts["solutions"], counts["factorisations"]), (direct["solutions"], 0))
        self.assertGreater(counts["iterations of PETSc"], 0)

    def test_hertz(self):
        made = self.run_tool("new", "--template", "hertz")
        self.assertEqual(made.returncode, 0, made.stderr)
        study = self.folder / "hertz/hertz.comm"
        text = study.read_text(encoding="utf-8")
        last, steps = {}, {}
        for method in ("MUMPS", "PETSC"):
            study.write_text(text.replace("STAT_NON_LINE(", f"STAT_NON_LINE(SOLVEUR=_F(METHODE='{method}'), "), encoding="utf-8")
            base = self.folder / f"{method}.base"
            run = self.run_lacon(study, "--base", base)
            self.assert_all_ok(run, 1)
            self.assertNotIn("SOLVER_7", run.stdout + run.stderr)
            result = Result(base, "RESULT")
            last[method] = result.field("DEPL", result.orders[-1])[1]
            steps[method] = [int(n) for n in re.findall(r"Converged at the instant \S+ with (\d+)", run.stdout)]
        assert_same(self, last["MUMPS"], last["PETSC"])
        self.assertEqual(len(steps["PETSC"]), len(steps["MUMPS"]))
        for exact, inexact in zip(steps["MUMPS"], steps["PETSC"]):  # rough while statuses change
            self.assertAlmostEqual(exact, inexact, delta=1)

    def test_a_beam_that_turns(self):
        # the multigrid knows the rigid motions of the beam as it is: with those of its first place it took twice the iterations
        lines = [np.linspace(0.0, length, n) for length, n in ((3.0, 25), (0.5, 7), (0.5, 7))]
        write_med(self.folder / "beam.med", brick("HEXA8", lines, name="V", sides={(0, 0): "END"}))
        mean = {}
        for turn in ("0.01", "2.0"):
            _, counts, said = self.solve("PETSC", {"TURN": turn}, study="turning_beam.comm", mesh="beam.med")
            self.assertNotIn("SOLVER_7", said)
            mean[turn] = counts["iterations of PETSc"] / counts["solutions"]
        self.assertLess(mean["2.0"], 1.5 * mean["0.01"])


class Mpi(StudyTest):
    """--mpi N, with more processes than processors: a factor that they share, or their iterations."""

    def setUp(self):
        super().setUp()
        write_med(self.folder / "blocks.med", two_blocks(1.0, (7, 6, 3)))

    def solve(self, solver, *options, **environment):
        """@return displacements, counts, what was said"""
        base, report = self.folder / "run.base", self.folder / "run.json"
        run = self.run_tool(pathlib.Path(__file__).with_name("precision.comm"), "--fresh", "--base", base, "--unit", "20=blocks.med", "--json", report,
                            *options, **{"NU": "0.3", "CONTRAST": "1", "SLENDER": "0"} | SHARED | environment, SOLVER=solver, PRE_COND="GAMG")
        self.assertEqual(run.returncode, 0, run.stdout[-3000:] + run.stderr[-3000:])
        commands = json.loads(report.read_text())["timings"]["commands"]
        result = Result(base, "RESULT")
        counts = next(c["counts"] for c in commands if c["command"] == "STAT_NON_LINE")
        return result.field("DEPL", result.orders[-1])[1], counts, run.stdout + run.stderr

    def test_values_are_those_of_one_process(self):
        for solver, numbers in (("double", (2, 3)), ("single", (2,))):
            one, counts, _ = self.solve(solver)
            for ranks in numbers:
                found, now, said = self.solve(solver, "--mpi", ranks)
                again, _, _ = self.solve(solver, "--mpi", ranks)
                assert_same(self, one, found, 1e-9)
                for name, values in found.items():
                    np.testing.assert_array_equal(again[name], values)
                self.assertEqual(now["solutions"], counts["solutions"])
                self.assertLessEqual(now["factorisations"], counts["factorisations"])
                self.assertEqual(now["factors by several processes"], now["factorisations"])
                self.assertEqual(now["processes with cells"], ranks)
                self.assertNotIn("SOLVER_", said)
                self.assertEqual(said.count("Converged at the instant"), 1)

    def test_an_exact_factor_has_the_whole_matrix(self):
        """Slender bodies are left to one process in double precision, which gets the rows of those that have the cells. Three iterations leave 1e-9 of what
        bends most: what solutions of 1e-12 are worth where bodies are that soft."""
        write_med(self.folder / "blocks.med", two_blocks(100.0, (40, 2, 2)))
        one, _, _ = self.solve("double", SLENDER="1")
        found, counts, said = self.solve("single", "--mpi", 2, SLENDER="1")
        self.assertEqual(said.count("<SOLVER_4>"), 1)
        self.assertNotIn("factors by several processes", counts)
        self.assertEqual(counts["processes with cells"], 2)
        assert_same(self, one, found, 1e-8)

    def test_an_export_file_asks_for_processes(self):
        """P mpi_nbcpu N is --mpi N, which stands where both are there."""
        export = self.folder / "study.export"
        export.write_text(f"P mpi_nbcpu 2\nF comm {pathlib.Path(__file__).with_name('precision.comm')} D 1\nF med {self.folder / 'blocks.med'} D 20\n",
                          encoding="utf-8")
        for options, are_several in (((), True), (("--mpi", 1), False)):
            run = self.run_tool(export, "--fresh", "--base", "run.base", "--json", self.folder / "run.json", *options, **SHARED, NU="0.3", CONTRAST="1",
                                SLENDER="0", SOLVER="double", PRE_COND="GAMG")
            self.assertEqual(run.returncode, 0, run.stdout[-3000:] + run.stderr[-3000:])
            counts = next(c["counts"] for c in json.loads((self.folder / "run.json").read_text())["timings"]["commands"] if c["command"] == "STAT_NON_LINE")
            self.assertEqual("factors by several processes" in counts, are_several)

    def test_threads_ask_for_processes(self):
        """Where nobody says how many, factors are shared where there is more than one thread."""
        for options, are_several in ((("--threads", 2), True), (("--threads", 1), False), (("--threads", 2, "--mpi", 1), False)):
            _, counts, _ = self.solve("double", *options)
            self.assertEqual("factors by several processes" in counts, are_several, options)

    @unittest.skipUnless(PROGRAM.exists() and shutil.which("mpirun"), "built without PETSc, or there is no mpirun")
    def test_threads_ask_for_processes_that_iterate(self):
        """As many as threads, where the study is not a small one and nobody says how many."""
        for options, small, ranks in ((("--threads", 2), "1", 2), (("--threads", 1), "1", None), (("--threads", 2, "--mpi", 1), "1", None),
                                      (("--threads", 2), "1000000", None)):
            _, counts, said = self.solve("petsc", *options, LACON_MPI_FROM=small)
            self.assertEqual(counts.get("processes with cells"), ranks, options)
            self.assertNotIn("SOLVER_", said)

    @unittest.skipUnless(PROGRAM.exists() and shutil.which("mpirun"), "built without PETSc, or there is no mpirun")
    def test_iterations_give_the_same_bits_in_every_run(self):
        one, counts, _ = self.solve("double")
        found, now, said = self.solve("petsc", "--mpi", 2)
        again, _, _ = self.solve("petsc", "--mpi", 2)
        assert_same(self, one, found, AGREEMENT)
        self.assertEqual(now["solutions"], counts["solutions"])
        self.assertNotIn("SOLVER_7", said)
        for name, values in found.items():
            np.testing.assert_array_equal(again[name], values)
        # of more than two processes PETSc's own products of GAMG add in an order that changes
        found, again = (self.solve("petsc", "--mpi", 5)[0] for _ in range(2))
        for name, values in found.items():
            np.testing.assert_array_equal(again[name], values)

    @unittest.skipUnless(PROGRAM.exists() and shutil.which("mpirun"), "built without PETSc, or there is no mpirun")
    def test_what_petsc_prints_is_no_answer(self):
        """It goes to standard error, and the study is what it is without."""
        for options in ((), ("--mpi", 2)):
            quiet, _, _ = self.solve("petsc", *options)
            found, _, said = self.solve("petsc", *options, LACON_PETSC_OPTIONS="-ksp_converged_reason -ksp_monitor -info")
            self.assertIn("solve converged due to", said)
            self.assertIn("KSP Residual norm", said)
            for name, values in found.items():
                np.testing.assert_array_equal(quiet[name], values)

    @unittest.skipUnless(PROGRAM.exists() and shutil.which("mpirun"), "built without PETSc, or there is no mpirun")
    def test_options_for_other_programs_do_nothing(self):
        """Of PETSc, in the environment and in files where it looks for them."""
        for folder in (self.folder, self.folder / "home"):
            folder.mkdir(exist_ok=True)
            (folder / ".petscrc").write_text("-ksp_monitor\n", encoding="utf-8")
        for options in ((), ("--mpi", 2)):
            quiet, counts, _ = self.solve("petsc", *options)
            found, now, said = self.solve("petsc", *options, PETSC_OPTIONS="-ksp_type preonly -ksp_monitor", PETSC_OPTIONS_YAML="ksp_max_it: 1",
                                          HOME=str(self.folder / "home"))
            self.assertNotIn("Residual norm", said)
            self.assertEqual(now["iterations of PETSc"], counts["iterations of PETSc"])
            for name, values in found.items():
                np.testing.assert_array_equal(quiet[name], values)

    @unittest.skipUnless(PROGRAM.exists() and shutil.which("mpirun"), "built without PETSc, or there is no mpirun")
    def test_what_petsc_cannot_do_is_told(self):
        """By the process that cannot do it, which ends the others."""
        with self.assertRaisesRegex(AssertionError, "<S> <SOLVER_8> [^\n]* have ended: PETSc: "):
            self.solve("petsc", "--mpi", 2, LACON_PETSC_OPTIONS="-pc_type lu")

    @unittest.skipUnless(PROGRAM.exists() and shutil.which("mpirun"), "built without PETSc, or there is no mpirun")
    def test_log_view_counts_products_in_blocks(self):
        """A cycle of the multigrid multiplies by the matrix nine times at least (polynomials of degree 4 on either side, a residual); a node sees 8 to 27."""
        log = self.folder / "log"
        for options, ranks in (((), 1), (("--mpi", 2), 2)):
            _, counts, _ = self.solve("petsc", *options, LACON_PETSC_OPTIONS=f"-log_view :{log}")
            flops = scaling.counted(log.read_text(), ranks)["solve"]["flops"] * ranks
            nodes = len(Result(self.folder / "run.base", "RESULT").points)
            self.assertGreater(flops / counts["iterations of PETSc"], 9 * 2 * 9 * 8 * nodes)


class WithoutPetsc(StudyTest):
    @unittest.skipIf(PROGRAM.exists(), "built with PETSc")
    def test_it_is_refused_by_name(self):
        write_med(self.folder / "blocks.med", two_blocks(1.0, (4, 4, 2)))
        run = self.run_lacon(pathlib.Path(__file__).with_name("precision.comm"), "--base", "b.base", "--unit", "20=blocks.med", NU="0.3",
                             CONTRAST="1", SLENDER="0", SOLVER="petsc", PRE_COND="GAMG")
        self.assertEqual(run.status, 2)
        self.assertIn("SOLVER_6", run.stdout + run.stderr)
        self.assertIn("libpetsc-real-dev", run.stdout + run.stderr)


if __name__ == "__main__":
    unittest.main()
