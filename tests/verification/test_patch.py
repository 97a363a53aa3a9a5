"""Patch test: two blocks that do not match transmit a uniform pressure exactly, for every pair of cell types."""

import math
import os
import pathlib
import sys
import unittest

import h5py
import numpy as np

sys.path.insert(0, str(pathlib.Path(os.environ["LACON_SOURCE_DIR"]) / "tests/studies"))

from study_test import StudyTest  # noqa: E402, I001 (it says where meshes.py is)
import patch  # noqa: E402

COMM = pathlib.Path(__file__).resolve().parent / "patch_test.comm"
PRESSURE = 25.0


class Patch(StudyTest):
    def run_patches(self, pairs, **parameters):
        return patch.run_patches(self, COMM, pairs, **parameters)

    def test_every_pair_of_cell_types_is_exact(self):
        """LAGS_C, PRES, SIYY to 1e-10 of p, JEU to 1e-10 of the height, COEFSURF to 1e-12."""
        run = self.run_patches(patch.PAIRS, pressure=PRESSURE)
        self.assert_all_ok(run, patch.CHECKS_A_PAIR * len(patch.PAIRS))
        for pair, found in zip(patch.PAIRS, patch.by_pair(run, len(patch.PAIRS))):
            with self.subTest(slave=pair[0], master=pair[1]):
                for component in ("LAGS_C", "PRES", "SIYY"):
                    self.assertLessEqual(patch.worst(found[component], -PRESSURE), 1e-10 * PRESSURE, component)
                self.assertLessEqual(patch.worst(found["JEU"], 0.0), 1e-10 * patch.HEIGHT)
                self.assertLessEqual(patch.worst(found["COEFSURF"], 1.0), 1e-12)
        self.check_displacements(len(patch.PAIRS))

    def check_displacements(self, count):
        """u = (eps_xx x, eps_yy (y + height)) at every node of every study, read from the base."""
        exx, eyy = patch.strain(PRESSURE, patch.YOUNG, patch.POISSON)
        base = self.folder / "patch_test.base"
        results = sorted(base.glob("result_*/index.h5"))
        self.assertEqual(len(results), count)
        for path in results:
            with h5py.File(path) as index:
                depl = index["fields/DEPL"]
                file = base / depl["file"].asstr()[list(index["order"][()]).index(max(index["order"][()]))]
                mesh = base / f"{index.attrs['mesh']}.h5"
            with h5py.File(mesh) as cut:
                x = cut["coordinates"][()]
            with h5py.File(file) as field:
                support, values = field["support"][()], field["values"][()]
                dx, dy = (list(field.attrs["components"]).index(c) for c in ("DX", "DY"))
            self.assertEqual(len(support), len(x))
            np.testing.assert_allclose(values[:, dx], exx * x[support, 0], rtol=0, atol=1e-10 * patch.HEIGHT)
            np.testing.assert_allclose(values[:, dy], eyy * (x[support, 1] + patch.HEIGHT), rtol=0, atol=1e-10 * patch.HEIGHT)

    def test_on_the_current_length_the_pressure_is_less_by_the_stretch(self):
        """ACTUALISE: -p A0 / A with A / A0 = 1 + nu (1 + nu) p / E (plane strain, free sideways)."""
        pairs = [(kind, kind) for kind in patch.KINDS]
        run = self.run_patches(pairs, pressure=PRESSURE, jacobian="ACTUALISE")
        self.assert_all_ok(run, patch.CHECKS_A_PAIR * len(pairs))
        expected = -PRESSURE / (1 + 0.3 * 1.3 * PRESSURE / 2000)
        for found in patch.by_pair(run, len(pairs)):
            self.assertLessEqual(patch.worst(found["LAGS_C"], expected), 1e-10 * PRESSURE)
            self.assertGreater(patch.worst(found["LAGS_C"], -PRESSURE), 1e-3 * PRESSURE)

    def test_axisymmetry_and_plane_stress_are_exact_in_both_measures(self):
        """Discs against discs, plates against plates: -p, and with ACTUALISE -p A0 / A; JEU and COEFSURF as in plane strain (the checks of
        the study)."""
        pairs = [(kind, other) for kind, other in zip(patch.KINDS, patch.KINDS[2:] + patch.KINDS[:2])]
        for model, jacobian in (("AXIS", "INITIAL"), ("AXIS", "ACTUALISE"), ("C_PLAN", "INITIAL"), ("C_PLAN", "ACTUALISE")):
            self.assert_all_ok(self.run_patches(pairs, pressure=PRESSURE, jacobian=jacobian, model=model), patch.CHECKS_A_PAIR * len(pairs))

    def test_reduced_integration_is_exact_on_either_side(self):
        """D_PLAN_SI and AXIS_SI: quadrangles of 4 points as slave, as master, on both sides."""
        pairs = [("QUAD8", "QUAD8"), ("QUAD8", "TRIA6"), ("TRIA3", "QUAD8")]
        for model in ("D_PLAN_SI", "AXIS_SI"):
            self.assert_all_ok(self.run_patches(pairs, pressure=PRESSURE, model=model), patch.CHECKS_A_PAIR * len(pairs))

    def test_with_two_materials_the_error_is_of_the_order_of_the_strain(self):
        """The lower block stretches more than the upper one: the skins end at different places, apart by the difference of
        strains, and the pressure there differs from p by a constant times that difference."""
        pairs = [(kind, kind) for kind in patch.KINDS]
        lower = (1000.0, 0.4)
        figures = two_materials(self, COMM, pairs, lower)
        for pair, rows in zip(pairs, figures):
            with self.subTest(cells=pair[0]):
                order = math.log(rows[0].error / rows[-1].error) / math.log(rows[0].strain / rows[-1].strain)
                print(f"{pair[0]}: error of the pressure = {rows[-1].error / rows[-1].strain:.3f} x difference of strains, order {order:.3f}")
                self.assertAlmostEqual(order, 1.0, delta=0.1)


def two_materials(test, comm, pairs, lower, pressures=(25.0, 5.0, 1.0)):
    """@return for each pair, for each pressure: .strain (difference of lateral strains), .error (of PRES, relative to p)"""
    import types

    figures = [[] for _ in pairs]
    for pressure in pressures:
        run = patch.run_patches(test, comm, pairs, pressure=pressure, lower=lower, tolerance=1.0)
        test.assertEqual(run.status, 0, run.stdout[-3000:] + run.stderr[-3000:])
        difference = abs(patch.strain(pressure, *lower)[0] - patch.strain(pressure, patch.YOUNG, patch.POISSON)[0])
        for rows, found in zip(figures, patch.by_pair(run, len(pairs))):
            rows.append(types.SimpleNamespace(strain=difference, error=patch.worst(found["PRES"], -pressure) / pressure))
    return figures


if __name__ == "__main__":
    unittest.main()
