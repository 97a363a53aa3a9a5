"""Processes that have their part of the cells give what one process gives: values, iterations, states, and the end of all of them."""

import contextlib
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import h5py
import numpy as np
from study_test import LACON, SECONDS, StudyTest
from test_precision import two_blocks

sys.path[:0] = [str(pathlib.Path(__file__).with_name("faults"))]

from test_killed import session_of  # noqa: E402, I001

from meshes import block, union, write_med
from results import Result

COMM = pathlib.Path(__file__).with_name("parts.comm")
FIELDS = ("DEPL", "SIEF_ELGA", "VARI_ELGA")
#: of the largest value of a field; RESI_GLOB_RELA is 1e-10 and RESI_RELA 1e-12
AGREEMENT = 1e-9
#: the same of MECA_STATIQUE, whose only solution is as exact as RESI_RELA and the condition of blocks of 1 to 100 in stiffness leave it
LINEAR = 1e-7


#: METHODE, and what runs with several processes need: those of MUMPS share the factors of small matrices too
PETSC = {"METHOD": "PETSC"}
MUMPS = {"METHOD": "MUMPS", "LACON_MPI_FROM": "1"}


class PartsTest(StudyTest):
    environment, program = PETSC, "lacon_petsc"
    two, count = ("--mpi", "2"), 2  #: processes

    def setUp(self):
        super().setUp()
        mesh = two_blocks(1.0, (7, 6, 3))
        for number, corner in enumerate(((0, 0, 1), (1, 0, 1), (0, 1, 1))):
            mesh.node_groups[f"C{number}"] = mesh.nodes_where(lambda *x, at=corner: x == at)
        write_med(self.folder / "blocks.med", mesh)

    def options(self, name):
        return [COMM, "--fresh", *self.of_base(name)]

    def of_base(self, name):
        return ["--base", self.folder / f"{name}.base", "--unit", "20=blocks.med", "--json", self.folder / "run.json"]

    def solve(self, *options, **environment):
        """@return the result, counts of the last STAT_NON_LINE, what was said"""
        return self.ran(self.options("run"), *options, **environment)

    def ran(self, study, *options, **environment):
        run = self.run_tool(*study, *options, **self.environment | environment)
        self.assertEqual(run.returncode, 0, run.stdout[-3000:] + run.stderr[-3000:])
        commands = json.loads((self.folder / "run.json").read_text())["timings"]["commands"]
        counts = [c["counts"] for c in commands if c["command"] == "STAT_NON_LINE"][-1]
        return self.read("run", "RESULT"), counts, run.stdout + run.stderr

    def read(self, base, name, fields=FIELDS):
        """{(field, order): {component: values}} of a result, and its iterations of Newton"""
        result = Result(self.folder / f"{base}.base", name)
        return {(field, order): result.field(field, order)[1] for field in fields for order in result.orders}, result.parameter("newton_iterations") if name == "RESULT" else None

    def assert_same(self, one, other, agreement=AGREEMENT):
        self.assertEqual(one[0].keys(), other[0].keys())
        for key, components in one[0].items():
            largest = max(np.nanmax(np.abs(other_order[name])) for (field, _), other_order in one[0].items() if field == key[0] for name in other_order)
            for name, values in components.items():
                np.testing.assert_array_equal(np.isnan(values), np.isnan(other[0][key][name]))
                self.assertLessEqual(np.nanmax(np.abs(other[0][key][name] - values), initial=0), agreement * largest, (key, name))

    def assert_same_bits(self, one, other):
        for key, components in one[0].items():
            for name, values in components.items():
                np.testing.assert_array_equal(other[0][key][name], values, str((key, name)))

    @contextlib.contextmanager
    def started(self, name, order, **environment):
        """A run that has archived its result up to an order. @return it, and processes of its session by their name"""
        with tempfile.TemporaryFile("w+") as said, subprocess.Popen(
                [LACON, *map(str, self.options(name)), *self.two], cwd=self.folder, stdin=subprocess.DEVNULL, stdout=said, stderr=subprocess.STDOUT,
                env={**os.environ, **self.environment, **environment}, start_new_session=True) as run:
            while self.archived(name) < order and run.poll() is None:
                time.sleep(0.02)
            of_name = {}
            for process, line in session_of(run.pid).items():
                of_name.setdefault(line[line.index("(") + 1:line.rindex(")")], []).append(process)
            self.assertEqual(len(of_name.get(self.program, [])), self.count, of_name)
            yield run, of_name
            run.wait(SECONDS)
            for _ in range(500):
                if not session_of(run.pid):
                    break
                time.sleep(0.01)
            self.assertEqual(session_of(run.pid), {})
            said.seek(0)
            run.said = said.read()

    def archived(self, name):
        """The last order in a base; -1: none"""
        for path in (self.folder / f"{name}.base").glob("result_*/index.h5"):
            with contextlib.suppress(OSError), h5py.File(path) as index:  # it is being put there
                return int(index["order"][-1])
        return -1

    def assert_strains_without_stress(self):
        """Temperatures that change strains and moduli, in one go and from a result on; a state to start from that initial strains brought about, which act no
        longer: all as one process has it."""
        def last(found):
            return found[0]["SIEF_ELGA", max(order for _, order in found[0])]["SIZZ"]

        cold = last(self.solve(METHOD="MUMPS")[0])
        for case in ({"HEAT": "1"}, {"HEAT": "1", "GO_ON": "1"}, {"STRAINED": "1"}):
            with self.subTest(**case):
                one, _, _ = self.solve(METHOD="MUMPS", **case)
                self.assertGreater(np.nanmax(np.abs(last(one) - cold)), 1e-4 * np.nanmax(np.abs(cold)))
                found, counts, said = self.solve("--mpi", 2, **case)
                self.assertNotIn("EVOLUTION_46", said)
                self.assertEqual(counts["processes with cells"], 2)
                self.assert_same(one, found)
                np.testing.assert_array_equal(one[1], found[1])

    def assert_killed_process_ends_all(self):
        """In the second instant, and in a later one that begins where the last motion leads to: a failure there would begin again at the last state."""
        for behind in (1, 3):
            with self.started(f"killed_{behind}", behind, INSTANTS=str(behind + 3), STEP="0.1") as (run, processes):
                os.kill(processes[self.program][-1], signal.SIGKILL)
            self.assertEqual(run.returncode, 3, run.said[-3000:])
            self.assertEqual(run.said.count("<SOLVER_8>"), 1, run.said[-3000:])
            self.assertNotIn("EVOLUTION_48", run.said)
            self.assertGreaterEqual(self.archived(f"killed_{behind}"), behind)

    def assert_interruption_is_all_that_is_told(self):
        """Ctrl-C in a terminal, or whoever ends a job: all processes of the group get the signal."""
        for number in (signal.SIGINT, signal.SIGTERM):
            with self.started(f"ended_{number}", 1, INSTANTS="400", STEP="0.001") as (run, _):
                os.killpg(run.pid, number)
            self.assertEqual(run.returncode, 4, run.said[-3000:])
            self.assertIn(f"<F> <STUDY_18> the run was ended by {number.name}", run.said)
            self.assertNotIn("SOLVER_8", run.said)

    def go_on_with_another(self, **case):
        """@return a result of four instants, and the same where the operator was killed behind the second one"""
        case |= {"INSTANTS": "4"}
        expected, _, _ = self.solve(*self.two, **case)
        with self.started("other", 2, LACON_RESTART_ALWAYS="1", **case) as (_, processes):
            os.kill(processes["stat_non_line"][0], signal.SIGKILL)
        options = [option for option in self.options("other") if option != "--fresh"]
        run = self.run_tool(*options, *self.two, **self.environment, **case)
        self.assertEqual(run.returncode, 0, run.stdout[-3000:] + run.stderr[-3000:])
        self.assertIn("EVOLUTION_32", run.stdout + run.stderr)
        return expected, self.read("other", "RESULT")


@unittest.skipUnless((LACON.parent / "lacon_petsc").exists() and shutil.which("mpirun"), "built without PETSc, or there is no mpirun")
class Parts(PartsTest):
    def test_values_and_states_are_those_of_one_process(self):
        factor, _, _ = self.solve(METHOD="MUMPS")
        self.assertGreater(np.nanmax(factor[0]["VARI_ELGA", 2]["V1"]), 1e-3)  # it flows
        one, counts, _ = self.solve()
        self.assertNotIn("processes with cells", counts)
        for ranks in (2, 3):
            found, now, said = self.solve("--mpi", ranks)
            self.assertEqual(now["processes with cells"], ranks)
            self.assertEqual(now["solutions"], counts["solutions"])
            self.assertEqual(now["factorisations"], 0)
            self.assertEqual(said.count("Converged at the instant"), 3)
            self.assertNotIn("SOLVER_", said)
            self.assert_same(factor, found)
            self.assert_same(one, found)
            np.testing.assert_array_equal(one[1], found[1])
        again, _, _ = self.solve("--mpi", 3)
        self.assert_same_bits(found, again)

    def test_a_linear_study(self):
        self.solve(METHOD="MUMPS", ELASTIC="1", INSTANTS="1")
        one = self.read("run", "LINEAR", FIELDS[:2])
        self.solve("--mpi", "2", ELASTIC="1", INSTANTS="1")
        found = self.read("run", "LINEAR", FIELDS[:2])
        for key, components in one[0].items():
            largest = max(np.nanmax(np.abs(values)) for values in components.values())
            for name, values in components.items():
                self.assertLessEqual(np.nanmax(np.abs(found[0][key][name] - values)), LINEAR * largest, (key, name))

    def test_a_factor_has_the_whole_matrix(self):
        """Iterations that do not come to their end leave the system to a factor, which is made of the rows of all processes."""
        factor, _, _ = self.solve(METHOD="MUMPS")
        found, counts, said = self.solve("--mpi", 2, ITERATIONS="2")
        self.assertIn("SOLVER_7", said)
        self.assertGreater(counts["factorisations"], 0)
        self.assertEqual(counts["processes with cells"], 2)
        self.assert_same(factor, found)

    def test_a_result_goes_on(self):
        """States of a result are handed out to those who have the cells."""
        whole, _, _ = self.solve(METHOD="MUMPS", GO_ON="1")
        found, counts, _ = self.solve("--mpi", 2, GO_ON="1")
        self.assertEqual(counts["processes with cells"], 2)
        self.assert_same(whole, found)

    def test_another_run_goes_on(self):
        """POURSUITE: states of a base are handed out, whoever left them there."""
        whole, _, _ = self.solve(METHOD="MUMPS", GO_ON="1")
        one = {"METHOD": "MUMPS"}
        for first, second in ((one, PETSC), (PETSC, one), (PETSC, MUMPS), (MUMPS, PETSC)):
            with self.subTest(first=first, second=second):
                self.solve(*(() if first is one else ("--mpi", 2)), INSTANTS="1", **first)
                found, counts, said = self.ran([COMM.with_suffix(".com1"), *self.of_base("run")], *(() if second is one else ("--mpi", 2)), **second)
                self.assertEqual(said.count("Converged at the instant"), 2)
                self.assertEqual(counts.get("processes with cells"), None if second is one else 2)
                self.assert_same(whole, found)

    def test_a_rigid_plate(self):
        """Relations among many nodes, of which each process has some: the plate stays plane, and all is as with one process."""
        factor, _, _ = self.solve(METHOD="MUMPS", SOLID="1")
        for environment in (PETSC, MUMPS):
            found, counts, said = self.solve("--mpi", 2, SOLID="1", **environment)
            self.assertEqual(counts["processes with cells"], 2)
            self.assertNotIn("SOLVER_", said)
            self.assert_same(factor, found)
            np.testing.assert_array_equal(factor[1], found[1])
        result = Result(self.folder / "run.base", "RESULT")
        x, moved = result.points, np.stack([result.at_nodes("DEPL", 1, name) for name in ("DX", "DY", "DZ")], axis=1)
        top = np.isclose(x[:, 2], 1)
        self.assertGreater(np.ptp(moved[top, 2]), 1e-4)
        plane = np.column_stack([np.ones(top.sum()), x[top, :2]])
        for component in moved[top].T:
            np.testing.assert_allclose(plane @ np.linalg.lstsq(plane, component, rcond=None)[0], component, atol=1e-12)

    def test_strains_without_stress(self):
        self.assert_strains_without_stress()

    def test_a_killed_process_ends_all(self):
        self.assert_killed_process_ends_all()

    def test_an_interruption_is_all_that_is_told(self):
        self.assert_interruption_is_all_that_is_told()

    def test_another_process_goes_on_with_the_same_bits(self):
        self.assert_same_bits(*self.go_on_with_another())

    def test_another_process_goes_on_under_temperatures(self):
        self.assert_same_bits(*self.go_on_with_another(HEAT="1"))


class PartsOfFactors(PartsTest):
    """The same where processes share factors: the operator has no matrix of the bodies."""

    environment, program = MUMPS, "lacon_mumps"

    def test_values_and_states_are_those_of_one_process(self):
        one, counts, _ = self.solve()
        self.assertGreater(np.nanmax(one[0]["VARI_ELGA", 2]["V1"]), 1e-3)  # it flows
        self.assertNotIn("processes with cells", counts)
        for ranks in (2, 3):
            found, now, said = self.solve("--mpi", ranks)
            self.assertEqual(now["processes with cells"], ranks)
            self.assertEqual(now["solutions"], counts["solutions"])
            self.assertGreater(now["factorisations"], 0)
            self.assertEqual(now["factors by several processes"], now["factorisations"])
            self.assertEqual(said.count("Converged at the instant"), 3)
            self.assertNotIn("SOLVER_", said)
            self.assert_same(one, found)
            np.testing.assert_array_equal(one[1], found[1])
        again, _, _ = self.solve("--mpi", 3)
        self.assert_same_bits(found, again)

    def test_a_linear_study(self):
        for case in ({}, {"HEAT": "1"}):
            with self.subTest(**case):
                self.solve(ELASTIC="1", INSTANTS="1", **case)
                one = self.read("run", "LINEAR", FIELDS[:2])
                _, _, said = self.solve("--mpi", 2, ELASTIC="1", INSTANTS="1", **case)
                self.assertNotIn("EVOLUTION_46", said)
                self.assert_same(one, self.read("run", "LINEAR", FIELDS[:2]))

    def test_strains_without_stress(self):
        self.assert_strains_without_stress()

    def test_what_is_left_to_one_process(self):
        """A matrix that is not symmetric."""
        lines = np.linspace
        lower = block("QUAD4", lines(0, 2, 13), lines(-1, 0, 7), name="LOWER", sides={"bottom": "BASE", "top": "GROUND"})
        upper = block("QUAD4", lines(0.5, 1.5, 6), lines(0, 1, 6), name="UPPER", sides={"bottom": "SOLE", "top": "TOP"})
        write_med(self.folder / "blocks.med", union([lower, upper]))
        found = []
        for told, options in ((0, ()), (1, ("--mpi", 2))):
            run = self.run_tool(COMM.with_name("unsymmetric.comm"), "--fresh", *self.of_base("run"), *options, **self.environment)
            self.assertEqual(run.returncode, 0, run.stdout[-3000:] + run.stderr[-3000:])
            self.assertEqual((run.stdout + run.stderr).count("<EVOLUTION_46>"), told)
            found.append(self.read("run", "RESULT"))
        self.assertGreater(np.nanmax(found[0][0]["VARI_ELGA", 2]["V1"]), 1e-3)  # it flows
        self.assert_same(*found)

    def test_too_few_files_may_be_open(self):
        """Processes begin, and memory that they share takes a file for each piece."""
        for limit in (12, 20):
            command = ["sh", "-c", f'ulimit -n {limit}; exec "$@"', "sh", LACON, *map(str, self.options("run")), "--mpi", "4"]
            run = subprocess.run(command, cwd=self.folder, env={**os.environ, **self.environment}, stdin=subprocess.DEVNULL, capture_output=True, text=True,
                                 timeout=SECONDS, check=False)
            self.assertEqual(run.returncode, 2, run.stdout[-2000:] + run.stderr[-2000:])
            self.assertIn(f"<F> <SOLVER_17> {limit} files may be open (ulimit -n)", run.stderr)

    def test_a_killed_process_ends_all(self):
        self.assert_killed_process_ends_all()

    def test_an_interruption_is_all_that_is_told(self):
        self.assert_interruption_is_all_that_is_told()

    def test_another_process_goes_on(self):
        """Who goes on makes a factor of its own, where the processes have had one of an earlier stiffness."""
        expected, found = self.go_on_with_another()
        self.assert_same(expected, found)


if __name__ == "__main__":
    unittest.main()
