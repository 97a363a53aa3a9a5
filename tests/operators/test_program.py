"""What every operator's command line has: --version, --verbose, and the kernels of OpenBLAS that it chooses at its start."""

import json
import os
import pathlib
import re
import subprocess
import unittest
from unittest import mock

from lacon_test import BIN
from test_stat_non_line import TwoSquares

UNKNOWN_PROCESSOR = pathlib.Path(os.environ.get("LACON_BINARY_DIR", "build/release")).resolve() / "tests/unknown_processor.so"


def processor():
    """(maker, flags) of the first processor."""
    text = pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8").partition("\n\n")[0]
    facts = {key.strip(): value.strip() for key, _, value in (line.partition(":") for line in text.splitlines())}
    return facts.get("vendor_id"), set(facts.get("flags", "").split())


def newest_kernel():
    """The newest of OpenBLAS's kernels that the processor has all instructions for; None where that is the oldest."""
    maker, flags = processor()
    for kernel, needs in (("SkylakeX", "avx512f avx512cd avx512bw avx512dq avx512vl"), ("Zen" if maker == "AuthenticAMD" else "Haswell", "avx2 fma"),
                          ("Sandybridge", "avx"), ("Nehalem", "sse4_2")):
        if set(needs.split()) <= flags:
            return kernel
    return None


class Program(TwoSquares):
    def setUp(self):
        super().setUp()
        self.enterContext(mock.patch.dict(os.environ))
        for name in ("OPENBLAS_CORETYPE", "OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
            os.environ.pop(name, None)

    def calculates_with(self, **environment):
        """(what the outcome says of OpenBLAS, kernels of the processes that were started)"""
        with mock.patch.dict(os.environ, {"OPENBLAS_VERBOSE": "2", **environment}):
            run = self.solve()
        self.assertEqual(run.status, 0, run.stderr)
        return run.blas, re.findall(r"^Core: (\w+)$", run.stderr, re.MULTILINE)

    def test_the_kernel_that_a_user_has_set_stands(self):
        blas, kernels = self.calculates_with(OPENBLAS_CORETYPE="Prescott")
        self.assertEqual((blas["kernel"], kernels), ("Prescott", ["Prescott"]))

    def test_a_processor_that_openblas_knows_needs_one_process(self):
        blas, kernels = self.calculates_with()
        self.assertEqual(kernels[-1], blas["kernel"])
        self.assertLessEqual(len(kernels), 2)

    @unittest.skipUnless(newest_kernel(), "the processor has nothing newer than SSE3")
    @unittest.skipUnless(UNKNOWN_PROCESSOR.exists(), "built with the address sanitizer")
    def test_on_a_processor_that_openblas_does_not_know_the_newest_kernel_is_taken(self):
        _, kernels = self.calculates_with(LD_PRELOAD=str(UNKNOWN_PROCESSOR))
        self.assertEqual((len(kernels), kernels[-1]), (2, newest_kernel()))
        _, kernels = self.calculates_with(LD_PRELOAD=str(UNKNOWN_PROCESSOR), OPENBLAS_CORETYPE="Nehalem")
        self.assertEqual(kernels, ["Nehalem"])

    def test_openblas_has_one_thread_unless_the_user_says_otherwise(self):
        self.assertEqual(self.calculates_with()[0]["threads"], 1)
        if os.cpu_count() > 1:
            self.assertEqual(self.calculates_with(OPENBLAS_NUM_THREADS="2")[0]["threads"], 2)

    def test_the_version_says_what_it_calculates_with(self):
        run = subprocess.run([BIN / "stat_non_line", "--version"], capture_output=True, text=True, timeout=10, check=True)
        self.assertRegex(run.stdout, r"\A\d+\.\d+\.\d+\nOpenBLAS \d+\.\d+\.\d+, kernel \w+, 1 thread\(s\)\n\Z")
        run = subprocess.run([BIN / "affe_modele", "--version"], capture_output=True, text=True, timeout=10, check=True)
        self.assertRegex(run.stdout, r"\A\d+\.\d+\.\d+\n\Z")

    def test_the_launcher_says_so_too(self):
        own = subprocess.run([BIN / "stat_non_line", "--version"], capture_output=True, text=True, timeout=10, check=True)
        run = subprocess.run([BIN / "lacon", "--version"], capture_output=True, text=True, timeout=10, check=True)
        self.assertEqual(run.stdout, f"lacon {own.stdout}")

    def test_programs_of_operators_say_that_they_are_not_for_users(self):
        for name, *arguments in (("lacon_mumps",), ("lacon_mumps", "--help"), ("lacon_mumps", "0", "1"), ("lacon_petsc",)):
            run = subprocess.run([BIN / name, *arguments], stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=10, check=False)
            self.assertEqual((run.returncode, run.stdout), (2, ""))
            self.assertIn("operators", run.stderr)

    def test_verbose_says_phases_and_counts(self):
        quiet = self.solve()
        self.assertEqual(quiet.stderr, "")
        run = self.run_order("stat_non_line", quiet.order.read_text(encoding="utf-8"), options=["--verbose"])
        self.assertEqual((run.status, run.stdout.count("\n")), (0, quiet.stdout.count("\n")))
        said = re.findall(r"^  (\S.*?) +([\d.e+-]+)( s)?$", run.stderr, re.MULTILINE)
        self.assertEqual(len(said) + 1, run.stderr.count("\n"), run.stderr)
        self.assertTrue(run.stderr.startswith("STAT_NON_LINE, study.comm:1\n"), run.stderr)
        for name in ("read", "pairing", "elements", "factorisation"):
            self.assertAlmostEqual(sum(float(value) for what, value, unit in said if what == name and unit), run.seconds[name], delta=1e-4)
        self.assertEqual(sum(float(value) for what, value, unit in said if what == "solutions" and not unit), run.counts["solutions"])

    def test_messages_that_cannot_be_written_are_told_in_the_outcome(self):
        order, outcome = self.folder / "none.json", self.folder / "outcome.json"
        for log, lost in (("/dev/full", True), (os.devnull, None)):
            with open(log, "w", encoding="utf-8") as stream:
                subprocess.run([BIN / "affe_modele", order, "--status", outcome], stderr=stream, timeout=10, check=False)
            self.assertEqual(json.loads(outcome.read_text(encoding="utf-8")).get("log_lost"), lost)

    @unittest.skipUnless(UNKNOWN_PROCESSOR.exists(), "built with the address sanitizer, which looks for leaks in /proc")
    @unittest.skipUnless(os.geteuid() == 0 and subprocess.run(["unshare", "-m", "true"], check=False).returncode == 0, "needs a mount namespace")
    def test_without_proc_the_plugins_beside_the_program_are_found(self):
        """As in a chroot where nobody has mounted it."""
        order = self.solve().order
        hidden = 'mount -t tmpfs none /proc && exec "$0" "$@"'
        for program in (BIN / "stat_non_line", os.path.relpath(BIN / "stat_non_line", self.folder)):
            run = subprocess.run(["unshare", "-m", "sh", "-c", hidden, program, order], cwd=self.folder, capture_output=True, text=True, timeout=60, check=False)
            self.assertEqual(run.returncode, 0, run.stderr)


if __name__ == "__main__":
    unittest.main()
