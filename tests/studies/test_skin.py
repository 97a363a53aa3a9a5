"""Contact at the nodes of a skin, from a .mail file to tables: skin.comm."""

import pathlib
import sys
import unittest

import h5py
import numpy as np
from study_test import StudyTest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

from meshes import block, union  # noqa: E402 (study_test.py says where it is)

COMM = pathlib.Path(__file__).resolve().parent / "skin.comm"


def mail(mesh, names):
    """A Mesh of the plane as code_aster's text. @param names node -> name, of those that are not N1, N2, ..."""
    node = [names.get(i, f"N{i + 1}") for i in range(len(mesh.points))]
    first, kinds = {}, list(mesh.cells)
    for kind in kinds:
        first[kind] = 1 + sum(len(mesh.cells[k]) for k in kinds[:kinds.index(kind)])
    parts = ["TITRE\ntwo blocks\nFINSF", "COOR_2D", *(f" {node[i]} {x:.17g} {y:.17g}" for i, (x, y) in enumerate(mesh.points)), "FINSF"]
    for kind, rows in mesh.cells.items():
        parts += [kind, *(f" M{first[kind] + c} " + " ".join(node[n] for n in row) for c, row in enumerate(rows)), "FINSF"]
    for name, members in mesh.cell_groups.items():
        parts += [f"GROUP_MA {name}", *(f" M{first[kind] + c}" for kind, c in members), "FINSF"]
    return "\n".join([*parts, "FIN", ""])


def two_blocks():
    lower = block("QUAD4", np.linspace(0, 1, 4), np.linspace(-1, 0, 4), None, "LOWER", {"bottom": "BASE", "top": "MASTER", "left": "AXIS"})
    upper = block("QUAD4", np.linspace(0, 1, 3), np.linspace(0, 1, 3), None, "UPPER", {"bottom": "SLAVE", "top": "TOP", "left": "AXIS"})
    return union([lower, upper])


class Skin(StudyTest):
    def test_contact_at_the_nodes_of_a_skin(self):
        mesh = two_blocks()
        corner = [i for i, (x, y) in enumerate(mesh.points) if x == 1 and y == 0][-1]  # of the upper block, which comes second
        (self.folder / "blocks.mail").write_text(mail(mesh, {corner: "CORNER"}))
        outputs = [f"--unit={unit}={self.folder / name}" for unit, name in ((20, "blocks.mail"), (61, "skin.csv"), (80, "skin.med"))]
        run = self.run_study(COMM, "--checks", "all", *outputs)
        self.assert_all_ok(run, 19)
        self.assertIn("MAIL_5", run.stderr)
        with h5py.File(self.folder / "skin.med") as file:
            self.assertIn("R_______CONT_NOEU", file["CHA"])
        head = next(line for line in (self.folder / "skin.csv").read_text().splitlines() if not line.startswith("#"))
        self.assertEqual([name.strip() for name in head.strip(", ").split(",")], ["NOEUD", "COOR_X", "COOR_Y", "PRES", "VX", "VY"])


if __name__ == "__main__":
    unittest.main()
