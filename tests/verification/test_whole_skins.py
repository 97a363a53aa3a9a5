"""Plates of one or two cells on one another, their whole skins slave and master: far sides are no contact, and nothing differs from faces."""

import os
import pathlib
import sys
import unittest

import numpy as np

SOURCE = pathlib.Path(os.environ["LACON_SOURCE_DIR"])
sys.path.insert(0, str(SOURCE / "tests/studies"))

from study_test import StudyTest  # noqa: E402, I001 (it says where meshes.py is)
from contact import contact_study, normal_force, run_contact  # noqa: E402
from meshes import block, brick, union  # noqa: E402

PRESSURE, WIDTH = 10.0, 6.0
UNCUT = ("QUAD8", "HEXA27")  #: cells whose skins are patches as they are
FACES = {"UPPER": "UPPER_LOW", "LOWER": "LOWER_HIGH"}


def plate(kind, name, across, through):
    """With groups of its lower and its upper side, LOW and HIGH, of those at its left, LEFT and BACK, and of all of them, SKIN."""
    if kind.startswith("QUAD"):
        sides = {"bottom": "LOW", "top": "HIGH", "left": "LEFT", "right": "RIGHT"}
        mesh = block(kind, across, through, None, name, {side: f"{name}_{group}" for side, group in sides.items()})
    else:
        sides = {(2, 0): "LOW", (2, 1): "HIGH", (0, 0): "LEFT", (0, 1): "RIGHT", (1, 0): "BACK", (1, 1): "FRONT"}
        mesh = brick(kind, [across, across, through], None, name, {side: f"{name}_{group}" for side, group in sides.items()})
    mesh.cell_groups[f"{name}_SKIN"] = [cell for group in sides.values() for cell in mesh.cell_groups[f"{name}_{group}"]]
    return mesh


def pressed(kind, cells, slave, whole):
    """@param cells through each of both plates @param whole skins, not faces, are in contact"""
    upper = plate(kind, "UPPER", np.linspace(1, 1 + WIDTH, 7), np.linspace(0, 1.5, cells + 1))
    lower = plate(kind, "LOWER", np.linspace(0, 8, 7), np.linspace(-1.5, 0, cells + 1))
    in_space = not kind.startswith("QUAD")
    hold = [{"GROUP_MA": "LOWER_LOW", "DX": 0.0, "DY": 0.0, **({"DZ": 0.0} if in_space else {})}, {"GROUP_MA": "UPPER_LEFT", "DX": 0.0}]
    if in_space:
        hold.append({"GROUP_MA": "UPPER_BACK", "DY": 0.0})
    skin = {name: f"{name}_SKIN" if whole else face for name, face in FACES.items()}
    return contact_study(union([upper, lower]), hold, [{"GROUP_MA": "UPPER_HIGH", "PRES": PRESSURE}], [skin[slave]],
                         [skin["LOWER" if slave == "UPPER" else "UPPER"]], "3D" if in_space else "D_PLAN", elastic={"E": 210e3, "NU": 0.3},
                         convergence={"RESI_GLOB_RELA": 1e-9, "ITER_GLOB_MAXI": 20})


class WholeSkins(StudyTest):
    def assert_like_faces(self, kind, cells, slave):
        run, results = run_contact(self, [pressed(kind, cells, slave, whole) for whole in (False, True)])
        for result in results:
            self.assertAlmostEqual(normal_force(result) / (PRESSURE * WIDTH ** (1 if kind.startswith("QUAD") else 2)), 1, delta=1e-4)  # plates bend
        peak, whole_peak = (min(result.on_cells("CONT_ELEM", result.orders[-1], "PRES").values()) for result in results)
        # DECOUPE_LAC cuts cells at the rim and at far sides otherwise
        self.assertAlmostEqual(whole_peak / peak, 1, delta=1e-8 if kind in UNCUT else 0.03)
        self.assertIn("<EVOLUTION_17>", run.stdout + run.stderr)

    def test_in_the_plane(self):
        for kind in ("QUAD4", "QUAD8"):
            for cells in (1, 2):
                for slave in FACES:
                    with self.subTest(kind=kind, cells=cells, slave=slave):
                        self.assert_like_faces(kind, cells, slave)

    def test_in_space(self):
        for kind, cells in (("HEXA27", 1), ("TETRA10", 2)):
            for slave in FACES:
                with self.subTest(kind=kind, cells=cells, slave=slave):
                    self.assert_like_faces(kind, cells, slave)


if __name__ == "__main__":
    unittest.main()
