"""The last iterates of a step that failed: kept beside the result, read as arrays and pictures, gone when the step is solved."""

import os
import re
import signal
import subprocess
import sys
import time
import unittest

from study_test import LACON, SECONDS, SOURCE, StudyTest

sys.path.insert(0, str(SOURCE / "commands"))

import numpy as np  # noqa: E402
import test_progress  # noqa: E402
from lacon.reader.base import open_base  # noqa: E402

#: meets no criterion, and is not cut
FAILS = "CONVERGENCE=_F(RESI_GLOB_MAXI=1e-30, ITER_GLOB_MAXI=8)"


class FailedStep(StudyTest):
    def setUp(self):
        super().setUp()
        test_progress.write_study(self.folder)
        self.text = (self.folder / "study.comm").read_text(encoding="utf-8")

    def run_study(self, text, status):
        (self.folder / "study.comm").write_text(text, encoding="utf-8")
        run = subprocess.run([LACON, "study.comm", "--unit", "20=mesh.med"], cwd=self.folder, capture_output=True, text=True, timeout=SECONDS,
                             stdin=subprocess.DEVNULL)
        self.assertEqual(run.returncode, status, run.stdout[-2000:] + run.stderr)
        return run

    def opened(self):
        return open_base(self.folder / "study.base")

    def test_one_that_fails_before_any_instant_is_found_by_its_name_until_it_is_solved(self):
        run = self.run_study(self.text.replace("INCREMENT=_F(LIST_INST=TIMES)", f"INCREMENT=_F(LIST_INST=TIMES), {FAILS}"), 3)
        self.assertIn("`lacon report study.base` shows the last 6 iterates", run.stderr)
        base = self.opened()
        self.assertEqual((base.results, list(base.failed_steps)), ({}, ["RESULT"]))
        step = base["RESULT"]
        self.assertEqual((step.instant, step.begins, step.message, step.orders), (0.25, 0.0, "EVOLUTION_4", list(range(3, 9))))
        self.assertEqual(step.fields, {name: step.orders for name in ("DEPL", "RESI_NOEU", "CONT_ELEM")})
        self.assertEqual(abs(step.field("RESI_NOEU", order=8).values).max(), step.parameters["resi_glob_maxi"][-1])
        top = step.mesh.node_groups.get("TOP", np.unique(np.concatenate(step.mesh.polygons(step.mesh.groups["TOP"]))))
        np.testing.assert_allclose(step.displacements(order=8)[top, 1], -0.0125, atol=1e-15)
        self.assertTrue((step.contact(order=8).status == 1).any())
        self.assertEqual(len(step.journal.attempts[-1].iterations), 9)
        (self.folder / "go_on.comm").write_text("POURSUITE()\nprint(RESULT)\nFIN()\n")
        done = subprocess.run([LACON, "go_on.comm", "--base", "study.base"], cwd=self.folder, capture_output=True, text=True, timeout=SECONDS)
        self.assertIn("NameError", done.stdout + done.stderr)  # it is no result
        self.assertEqual(list(self.opened().failed_steps), ["RESULT"])
        self.run_study(self.text, 0)
        base = self.opened()
        self.assertEqual((list(base.results), base.failed_steps, base["RESULT"].failed_step), (["RESULT"], {}, None))
        self.assertEqual(list((self.folder / "study.base").glob("*/failed_step.h5")), [])

    def test_one_that_fails_is_looked_at_in_place_of_an_older_result_of_its_name(self):
        """What a command file gave before it was changed is not what was asked for last; changed back, it is again."""
        self.run_study(self.text, 0)
        self.run_study(self.text.replace("INCREMENT=_F(LIST_INST=TIMES)", f"INCREMENT=_F(LIST_INST=TIMES), {FAILS}"), 3)
        base = self.opened()
        self.assertEqual((base.results, base.only_result().message, base["RESULT"].message), ({}, "EVOLUTION_4", "EVOLUTION_4"))
        self.run_study(self.text, 0)
        base = self.opened()
        self.assertEqual((list(base.results), base.failed_steps), (["RESULT"], {}))
        self.assertEqual(base.only_result().instants[-1], 1.0)

    def test_one_behind_solved_instants_stays_beside_them_and_nothing_goes_on_from_it(self):
        half = self.text.replace("INCREMENT=_F(LIST_INST=TIMES)", "INCREMENT=_F(LIST_INST=TIMES, INST_FIN=0.5)")
        again = ("RESULT = STAT_NON_LINE(reuse=RESULT, RESULTAT=RESULT, ETAT_INIT=_F(EVOL_NOLI=RESULT), MODELE=MODEL, CHAM_MATER=MATTER, CONTACT=CONTACT, "
                 "EXCIT=(_F(CHARGE=HELD), _F(CHARGE=DRIVE)), INCREMENT=_F(LIST_INST=TIMES){})\nFIN()")
        self.run_study(half.replace("FIN()", again.format(f", {FAILS}")), 3)
        result = self.opened()["RESULT"]
        self.assertEqual((result.instants.tolist(), result.failed_step.begins, result.failed_step.instant), ([0.0, 0.25, 0.5], 0.5, 0.75))
        self.assertNotIn("RESI_NOEU", result.fields)
        said = subprocess.run([LACON, "plot", "study.base", "--iteration", "7", "--format", "svg"], cwd=self.folder, capture_output=True, text=True,
                              timeout=SECONDS, check=True).stdout.splitlines()
        self.assertEqual(said, ["study_mesh.svg", "study_pressure.svg", "study_convergence.svg"])
        self.assertIn("RESULT, iteration 7 of the failed step to INST 0.75", (self.folder / said[0]).read_text())
        self.assertIn("RESI_NOEU", (self.folder / said[0]).read_text())
        (self.folder / "go_on.comm").write_text("POURSUITE()\n" + again.format(""))
        subprocess.run([LACON, "go_on.comm", "--base", "study.base"], cwd=self.folder, capture_output=True, timeout=SECONDS, check=True)
        result = self.opened()["RESULT"]
        self.assertEqual((result.instants.tolist(), result.failed_step), ([0.0, 0.25, 0.5, 0.75, 1.0], None))

    def test_those_of_the_attempt_that_is_told_are_kept(self):
        """The shortest step fails, with increments that are searched as well, and what is left of the whole one with more iterations, and as they creep."""
        fails = "CONVERGENCE=_F(RESI_GLOB_MAXI=1e-30, ITER_GLOB_MAXI=1)"
        run = self.run_study(self.text.replace("INCREMENT=_F(LIST_INST=TIMES)", f"INCREMENT=_F(LIST_INST=TIMES), {fails}"), 3)
        told = [line for line in run.stderr.splitlines() if line.startswith("<")]
        self.assertEqual([line.split(">")[1].lstrip(" <") for line in told[-4:]], ["EVOLUTION_71", "EVOLUTION_73", "EVOLUTION_76", "EVOLUTION_4"])
        step = self.opened()["RESULT"]
        instant, residual = re.search(r"no convergence at the instant (\S+) .* RESI_GLOB_MAXI (\S+) at", told[-1]).groups()
        self.assertEqual((step.message, step.instant, step.orders), ("EVOLUTION_4", 0.25 / 4**3, [0, 1]))
        self.assertEqual((instant, residual), (f"{step.instant:.9g}", f"{step.parameters['resi_glob_maxi'][-1]:.1e}"))

    def test_pictures_of_iterates_that_diverge_still_show_the_bodies(self):
        sys.path.insert(0, str(SOURCE / "commands"))
        from lacon.reader.result import FailedStep as Step

        class Flown(Step):
            """Bodies of size 5 (4 x 3); a node is gone."""

            def __init__(self):
                self.mesh = type("Mesh", (), {"points": np.array([[0.0, 0.0, 0.0], [4.0, 3.0, 0.0]])})

        for gone, scale in ((1.0, 1.0), (2.5e6, 1e-6)):
            self.assertAlmostEqual(Flown()._bound(np.array([[gone, 0.0, 0.0], [0.0, 0.0, 0.0]])), scale, delta=1e-12)

    def test_a_killed_run_leaves_none(self):
        (self.folder / "study.comm").write_text(self.text.replace("INCREMENT=_F(LIST_INST=TIMES)", f"INCREMENT=_F(LIST_INST=TIMES), {FAILS}").replace("=8)", "=100000)"))
        run = subprocess.Popen([LACON, "study.comm", "--unit", "20=mesh.med"], cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
        until = time.monotonic() + SECONDS
        while time.monotonic() < until and not any(b'"iteration"' in path.read_bytes() for path in self.folder.glob("study.base/*/journal.jsonl")):
            time.sleep(0.01)
        os.killpg(run.pid, signal.SIGKILL)
        run.wait(SECONDS)
        self.assertEqual((self.opened().results, self.opened().failed_steps), ({}, {}))


if __name__ == "__main__":
    unittest.main()
