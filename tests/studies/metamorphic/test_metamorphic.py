"""A physical answer does not depend on how the study is written down: drawn contact studies, as they are and written otherwise."""

import os
import pathlib
import random
import shutil
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

from campaign import compare, half, judge, symmetric, ways  # noqa: E402, I001 (it says where meshes.py is)
from written import WAYS, first_vertices, in_a_mirror, renumbered  # noqa: E402
import numpy as np  # noqa: E402
from meshes import brick  # noqa: E402

#: study -> ways: corners with two slave edges, of beams (TRIA3); a ring (AXIS, QUAD8, LISSAGE); a box on a box (HEXA8); a plastic
#: round whose residuals grow (TRIA6, LISSAGE); wedges whose slave cells warp and flatten from iterate to iterate (PENTA6, LISSAGE)
SHORT = {1000: ("turned", "numbers", "vertex", "oriented", "threads"), 3: ("shifted", "extreme", "loads"), 1004: ("turned", "mirror", "bodies", "vertex", "nanometres"),
         1008: ("turned",), 8022: ("stages",)}
LONG = {number: tuple(WAYS) for number in (0, 1, 2, 3, 100, 102, 1000, 1001, 1002, 1006, 1033)}
HALVES = (10, 16)  # blocks: TRIA6 in plane stress, QUAD9 and GREEN_LAGRANGE
#: where the skins bend at the mirror the cover of the half goes on beyond it by as much of a cell at most (pairing/README.md)
HALF = 1.5e-4


class Written(unittest.TestCase):
    """The other ways to write a mesh, without a run."""

    def test_cells_have_the_same_nodes_and_sense_whatever_vertex_is_the_first(self):
        for kind in ("TETRA4", "TETRA10", "PENTA6", "PENTA15", "PYRAM5", "PYRAM13", "HEXA8", "HEXA20", "HEXA27"):
            mesh = brick(kind, [np.linspace(0, 1, 2)] * 3, None, "BODY", {(2, 1): "TOP"}, curved=True)
            other, mirror = first_vertices(mesh), in_a_mirror(mesh)
            for name, rows in mesh.cells.items():
                with self.subTest(body=kind, cell=name):
                    self.assertEqual([set(row) for row in rows.tolist()], [set(row) for row in other.cells[name].tolist()])
                    self.assertTrue((rows[:, 0] != other.cells[name][:, 0]).all())
                    again = other.cells[name]
                    for _ in range(11):
                        again = first_vertices(type(mesh)(mesh.points, {name: again})).cells[name]
                    self.assertTrue((again == rows).all(), "twelve turns by a third, a quarter or the whole")
                    self.assertTrue((in_a_mirror(mirror).cells[name] == rows).all())
                    if name == kind:
                        self.assertTrue((self.senses(mesh.points, other.cells[name]) == self.senses(mesh.points, rows)).all())
                        self.assertTrue((self.senses(mesh.points, mirror.cells[name]) == -self.senses(mesh.points, rows)).all())

    @staticmethod
    def senses(points, rows):
        a, b, c = (points[rows[:, k]] - points[rows[:, 0]] for k in (1, 2, 3 if rows.shape[1] in (4, 10) else 4 if rows.shape[1] in (5, 13, 8, 20, 27) else 3))
        return np.sign(np.einsum("ij,ij->i", np.cross(a, b), c))

    def test_a_renumbered_mesh_has_the_same_cells_at_the_same_places(self):
        mesh = brick("PENTA6", [np.linspace(0, 1, 3)] * 3, None, "BODY", {(2, 1): "TOP"})
        other = renumbered(mesh, 1)
        for group, members in mesh.cell_groups.items():
            self.assertEqual(sorted(mesh.points[mesh.cells[kind][c]].tolist() for kind, c in members),
                             sorted(other.points[other.cells[kind][c]].tolist() for kind, c in other.cell_groups[group]))
        self.assertFalse((mesh.points == other.points).all())

    def test_a_number_is_always_the_same_study(self):
        self.assertEqual(ways(7, ["turned"])[0].name, ways(7, ["turned"])[0].name)
        self.assertTrue(any(symmetric(number) for number in range(20)))
        self.assertNotEqual(random.Random("7 turned").random(), random.Random("8 turned").random())


class Short(unittest.TestCase):
    studies, halves = SHORT, HALVES

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="lacon_metamorphic_"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def test_the_same_study_written_otherwise_has_the_same_answer(self):
        """To the promise of each way (written.WAYS); in the long test where round-off of the points themselves does more, to a hundred times that."""
        for number, names in self.studies.items():
            drawn, control = None, {}
            for found, tolerance, different in compare(number, names, self.folder / str(number)):
                if drawn is None:
                    drawn = found
                    self.assertEqual(found.figures["status"], "finished", found.written.name)
                    continue
                if found.written.name == "ulp":
                    control = different
                with self.subTest(study=drawn.written.name, way=found.written.name):
                    self.assertGreater(len(different), 10)
                    self.assertEqual(judge(drawn, found, tolerance, different, control), [])

    def test_a_half_has_the_answer_of_the_whole(self):
        for number in self.halves:
            different, whole, part = half(number, self.folder / f"half {number}")
            with self.subTest(number):
                self.assertEqual((whole["status"], part["status"]), ("finished", "finished"))
                self.assertEqual(whole["of steps"], part["of steps"])
                self.assertEqual(set(different), {"DEPL", "PRES", "CONT", "JEU"})
                self.assertLessEqual(max(different.values()), HALF)


class Long(Short):
    studies, halves = LONG, (10, 13, 16, 39)


if __name__ == "__main__":
    os.environ.setdefault("LACON_PATIENCE", "1")
    unittest.main()
