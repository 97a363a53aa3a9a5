"""Processes of PETSC on several machines: those on others, which see no memory of the operator, give what one machine gives."""

import os
import pathlib
import shutil
import socket
import subprocess
import unittest

import numpy as np
from study_test import LACON
from test_parts import PETSC, PartsTest

AGENT = pathlib.Path(__file__).with_name("another_machine")
HERE = socket.gethostname()


#: of a second machine that is made of this one
ENVIRONMENT = {"OMPI_MCA_plm_rsh_agent": str(AGENT), "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}


def are_others():
    """Whether mpirun reaches such a machine: this user may make name spaces, and there is a network besides the machine's own loop."""
    if not (shutil.which("mpirun") and shutil.which("unshare")):
        return False
    command = ["mpirun", "-n", "2", "--host", f"{HERE}:1,second:1", "hostname"]
    try:
        done = subprocess.run(command, env={**os.environ, **ENVIRONMENT}, capture_output=True, text=True, check=False, timeout=60)
    except subprocess.TimeoutExpired:
        return False
    return sorted(done.stdout.split()) == sorted((HERE, "second"))


@unittest.skipUnless((LACON.parent / "lacon_petsc").exists(), "built without PETSc")
@unittest.skipUnless(are_others(), "no second machine can be made of this one (mpirun, unshare, a network)")
class MachinesTest(PartsTest):
    environment = PETSC | ENVIRONMENT
    two = ("--hosts", f"{HERE}:1,second:1")

    def assert_same_on_two_machines(self, one, several, processes):
        self.assertEqual((several[1]["machines"], several[1]["processes with cells"]), (2, processes))
        self.assertNotIn("SOLVER_", several[2])
        np.testing.assert_array_equal(several[0][1], one[0][1])
        self.assert_same(one[0], several[0])


class Machines(MachinesTest):
    def test_values_and_states_are_those_of_one_machine(self):
        one = self.solve("--mpi", 2)
        self.assertNotIn("machines", one[1])
        several = self.solve(*self.two)
        self.assert_same_on_two_machines(one, several, 2)
        self.assert_same_bits(several[0], self.solve(*self.two)[0])

    def test_the_first_machine_is_that_of_the_operator(self):
        for hosts in ("second:1,third:1", "second:1"):
            run = self.run_tool(*self.options("run"), "--hosts", hosts, **self.environment)
            self.assertEqual(run.returncode, 2, run.stdout[-3000:] + run.stderr[-3000:])
            self.assertIn("<SOLVER_11>", run.stdout + run.stderr)
            self.assertIn(f"runs on second, and does not see the memory of the operator, which runs on {HERE}", run.stdout + run.stderr)


class ManyMachines(MachinesTest):
    def test_two_processes_of_a_machine_share_a_copy(self):
        self.assert_same_on_two_machines(self.solve("--mpi", 3, INSTANTS="1"), self.solve("--hosts", f"{HERE}:1,second:2", INSTANTS="1"), 3)

    def test_another_operator_goes_on_with_the_same_bits(self):
        self.assert_same_bits(*self.go_on_with_another())

    def test_a_result_goes_on(self):
        """States of a result are handed out, those of cells on the other machine too."""
        whole, _, _ = self.solve("--mpi", 2, GO_ON="1")
        self.assert_same(whole, self.solve(*self.two, GO_ON="1")[0])

    def test_a_factor_has_the_whole_matrix(self):
        one, _, _ = self.solve("--mpi", 2, ITERATIONS="2")
        several, _, said = self.solve(*self.two, ITERATIONS="2")
        self.assertIn("SOLVER_7", said)
        self.assert_same(one, several)

    def test_a_killed_process_ends_all(self):
        self.assert_killed_process_ends_all()


class Hosts(PartsTest):
    def test_names_that_mpirun_would_not_take(self):
        for hosts in ("", "a,", "a:0", "a:b", "a b"):
            run = self.run_tool(*self.options("run"), "--hosts", hosts)
            self.assertEqual(run.returncode, 2, hosts)
            self.assertIn("--hosts: give machines as mpirun takes them", run.stderr)

    @unittest.skipUnless((LACON.parent / "lacon_petsc").exists() and shutil.which("mpirun"), "built without PETSc, or there is no mpirun")
    def test_what_keeps_processes_from_beginning_is_named(self):
        """A machine that nobody knows, no mpirun: the folder of MPI's files and a missing PETSc were named instead."""
        for options, more, words in ((("--hosts", "nonsense.invalid:2"), {"OMPI_MCA_plm_rsh_agent": "/bin/false"}, "<F> <SOLVER_10> (.*\n)*.*machine of --hosts \\(nonsense.invalid:2\\)"),
                                     (("--mpi", 2), {"PATH": ""}, "<F> <SOLVER_18> .*none of the folders of PATH \\(''\\)")):
            run = self.run_tool(*self.options("run"), *options, **PETSC | more)
            self.assertEqual(run.returncode, 2, run.stderr)
            self.assertRegex(run.stderr, words)

    def test_a_factor_stays_on_this_machine(self):
        _, _, said = self.solve("--hosts", f"{HERE}:2", METHOD="MUMPS")
        self.assertEqual(said.count("<SOLVER_12>"), 1, said[-3000:])


if __name__ == "__main__":
    unittest.main()
