"""Memory that ends: the solution stops with a message, and the same command again comes to its end."""

import os
import pathlib
import resource
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))

from study_test import LACON  # noqa: E402, I001

from .small_study import SmallStudy  # noqa: E402

MEGABYTE = 1 << 20


class Memory(SmallStudy):
    def test_a_limit_ends_the_solution_cleanly(self):
        """Limits from what the program itself takes to what the study needs. Below 120 MB of addresses it is not even loaded."""
        self.assert_limits_end_it_cleanly()

    def test_a_limit_ends_a_solution_by_several_processes_cleanly(self):
        """Where one of them had no room for what OpenBLAS works in, it tried for ever."""
        self.assert_limits_end_it_cleanly(LACON_MPI="2", LACON_MPI_FROM="1")

    def assert_limits_end_it_cleanly(self, **environment):
        orders = self.folder / "orders"
        run = self.run_small("small", LACON_ORDERS=str(orders))
        self.assertEqual(run.returncode, 0, run.stderr)
        (order,) = orders.glob("*-stat_non_line.order.json")
        ended = []
        for limit in range(120, 480, 30):
            def limited(limit=limit):
                resource.setrlimit(resource.RLIMIT_AS, (limit * MEGABYTE,) * 2)

            done = subprocess.run([LACON.parent / "stat_non_line", order], capture_output=True, text=True, timeout=60, check=False,
                                  preexec_fn=limited, env={**os.environ, "OPENBLAS_NUM_THREADS": "1"} | environment)
            with self.subTest(limit=limit):
                self.assertIn(done.returncode, (0, 3), done.stderr)
                if done.returncode == 3:
                    self.assertRegex(done.stderr, r"<S> <(MEMORY_1|SOLVER_2)>")
            ended.append(done.returncode)
        self.assertEqual((ended[0], ended[-1]), (3, 0))
        again = self.run_small("small")
        self.assertEqual(again.returncode, 0, again.stderr)
