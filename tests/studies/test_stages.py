"""One result whose contact and loads are exchanged as it goes on: each of its instants is of its own stage, for what is computed, written and looked at."""

import json
import sys
import unittest

import h5py
import numpy as np
from study_test import SOURCE, StudyTest, two_columns

sys.path.insert(0, str(SOURCE / "commands"))

from lacon.core.messages import AsterError  # noqa: E402
from lacon.reader.base import open_base  # noqa: E402
from meshes import write_med  # noqa: E402

E, D = 1000.0, 0.01


class Stages(StudyTest):
    def setUp(self):
        super().setUp()
        write_med(self.folder / "mesh.med", two_columns()[0])

    def test_each_instant_is_of_its_own_contact(self):
        here = SOURCE / "tests/studies"
        run = self.run_lacon(here / "stages.comm", "--base", "stages.base", "--unit", "20=mesh.med")
        self.assertEqual(run.status, 0, run.stderr)
        self.assertIn("EVOLUTION_35", run.stderr)  # what is only watched overlaps, and says so
        run = self.run_lacon(here / "stages.com1", "--base", "stages.base", *(f"--unit={unit}={name}" for unit, name in (
            (80, "fields.med"), (81, "fields.pvd"), (8, "fields.txt"), (82, "pairing.med"))))
        self.assert_all_ok(run, 6)
        base = open_base(self.folder / "stages.base")
        result = base["RES"]
        (index,) = (self.folder / "stages.base").glob("result_*/index.h5")
        with h5py.File(index) as file:
            self.assertEqual(file.attrs["format"], 2)
            self.assertEqual([stage["first"] for stage in json.loads(file.attrs["stages"])], [0, 2, 3, 4, 5])
        self.assertEqual([(slave, master) for slave, master, *_ in result.zones], [("CTOP", "CBOT")])
        pressures = []
        for order in result.orders:
            patches = result.contact(order=order)
            pressures.append(None if patches is None else patches.pressure.tolist())
        n = len(pressures[0])
        for found, wanted in zip(pressures, (0.0, E * D / 2, 0.0, E * D / 2, None, E * D / 2)):
            if wanted is None:
                self.assertIsNone(found)
            else:
                np.testing.assert_allclose(found, [wanted] * n, rtol=1e-9, atol=1e-9)
        np.testing.assert_allclose(result.parameters["zone_1_slave_force_y"], [0, E * D / 2, 0, E * D / 2, np.nan, E * D / 2], rtol=1e-9, atol=1e-9)
        np.testing.assert_allclose(result.contact(order=2).gap, -D, rtol=1e-9)  # what is only watched
        result.plot_pressure(order=5)
        with self.assertRaises(AsterError) as refusal:
            result.plot_pressure(order=4)
        self.assertEqual(refusal.exception.id_message, "READER_3")
        self.assertIn("instant 4.0", (self.folder / "fields.txt").read_text())
        result.plot_convergence()
        for tool in ("report", "inspect"):
            done = self.run_tool(tool, "stages.base")
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        done = self.run_tool("inspect", "stages.base", "--instant", "4.0")
        self.assertEqual((done.returncode, "IMPR_7" in done.stderr), (2, True), done.stderr)


if __name__ == "__main__":
    unittest.main()
