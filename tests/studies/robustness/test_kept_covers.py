"""Patches that keep their cover (EVOLUTION_50): when they do, how fast residuals then fall, and that the next computation goes on with them, and without the
masters that were left out."""

import math
import pathlib
import re
import sys
import unittest

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent)]

from study_test import LACON, StudyTest  # noqa: E402, I001 (it says where meshes.py is)
from meshes import block, brick, union, write_med  # noqa: E402
from bodies import lines, slab, slab_in_space  # noqa: E402
from run import run  # noqa: E402
from studies import Study, elastic, held, path, zone  # noqa: E402
from unseen import study as unseen  # noqa: E402

PUNCH = HERE.parent / "faults/punch.comm"
LIST = "INCREMENT=_F(LIST_INST=DEFI_LIST_INST(DEFI_LIST=_F(LIST_INST=TIMES)))"


class InSpace(StudyTest):
    def test_the_edges_of_a_stiff_cube_end_on_patches_of_a_softer_slab(self):
        """Each of its edges lies in patches of the slab, leans, is pressed in and slides. Residuals stood between a tenth and one for as long as they were let,
        statuses changed all the way, and no step was short enough. Where covers are kept residuals fall by 1e-2 an iteration at least (0.35 without the ends that move)."""
        for leans, most, cut in ((0.5, 30, False), (0.01, 10, True)):
            tool = brick("HEXA8", [lines(-0.5, 0.5, 4)] * 3, None, "TOOL", {(2, 0): "TOOL_SKIN", (2, 1): "TOOL_BASE"})
            cosine, sine = math.cos(math.radians(leans)), math.sin(math.radians(leans))
            for axes in ((1, 2), (2, 0)):
                tool.points[:, axes] = tool.points[:, axes] @ np.array([[cosine, sine], [-sine, cosine]])
            tool.points = tool.points - [0, 0, tool.points[:, 2].min()]
            study = Study(name="cube", mesh=union([tool, slab_in_space("HEXA8", "SLAB", (-1.5, 1.5), (-1.5, 1.5), (-1, 0), (12, 12, 3))]), model="3D",
                          materials={"TOOL": elastic(5e3), "SLAB": elastic(1e3)}, zones=[zone("TOOL", "SLAB", 1)], strain="GREEN_LAGRANGE", steps=4, cut=cut, most=most,
                          moves=[{**held("SLAB"), "DZ": 0.0}, {"GROUP_MA": "TOOL_BASE", "DX": [[0, 0], [2, 0], [4, 0.2]], "DY": 0.0, "DZ": [[0, 0], [2, -0.1], [4, -0.1]]}])
            figures = run(study, LACON, self.folder)
            self.assertEqual(figures["status"], "finished", leans)
            self.assertIn("EVOLUTION_50", figures["alarms"])
            instants = (self.folder / "out").read_text().split("Instant de calcul")[1:]
            last = [float(residual) for residual in re.findall(r"^ \|\s+\d+ ?X?\|\s+(\S+)", instants[-1].replace("X |", "|"), re.MULTILINE)]
            near = [residual for residual in last if residual < 0.01]
            self.assertGreaterEqual(len(near), 2)
            for before, after in zip(near, near[1:]):
                self.assertLess(after, 0.02 * before, (leans, last))


class OnANode(StudyTest):
    def test_an_end_that_comes_to_rest_on_a_node_of_the_slave(self):
        """The normals of its cells differ there, so that the force on the end leaps: residuals fell by 2 % an iteration, in whole steps and in cut ones."""
        figures = run(unseen(31004), LACON, self.folder)
        self.assertEqual(figures["status"], "finished")
        told = (self.folder / "err").read_text()
        self.assertIn("EVOLUTION_50", figures["alarms"])
        self.assertNotIn("<EVOLUTION_7>", told)


class GoOn(StudyTest):
    def run_once(self, name, text):
        """Run a command file. @return iterations of each instant, and what it said"""
        (self.folder / f"{name}.comm").write_text(text, encoding="utf-8")
        done = self.run_tool(f"{name}.comm", "--unit", "20=punch.med", "--base", f"{name}.base")
        self.assertEqual(done.returncode, 0, done.stdout[-2000:] + done.stderr)
        said = done.stdout + done.stderr
        return [int(count) for count in re.findall(r"Converged at the instant \S+ with (\d+) iteration", said)], said

    def test_a_computation_goes_on_with_the_covers_of_another(self):
        """Of ETAT_INIT: the state is balanced with its covers kept, and its next instants take what they take in one computation. Without them the first
        of these is searched for from a state that is none."""
        write_med(self.folder / "punch.med", union([
            block("QUAD4", lines(-2, 2, 17), lines(-1, 0, 5), name="LOWER", sides={"bottom": "BASE", "top": "GROUND"}),
            block("QUAD4", lines(-1, 1, 8), lines(0, 1, 4), name="PUNCH", sides={"bottom": "FACE", "top": "TOP"})]))
        text = PUNCH.read_text(encoding="utf-8")
        orders = text[text.index("RESULT = STAT_NON_LINE("):text.index("FIN()")]
        self.assertIn(LIST, orders)
        whole, _ = self.run_once("whole", text)
        half = orders.replace(LIST, "INCREMENT=_F(LIST_INST=TIMES, INST_FIN=6.0)")
        rest = orders.replace("RESULT =", "MORE =").replace(LIST, "ETAT_INIT=_F(EVOL_NOLI=RESULT), INCREMENT=_F(LIST_INST=TIMES)")
        parts, said = self.run_once("parts", text.replace(orders, half + rest))
        self.assertEqual(said.count("<EVOLUTION_50>"), 2)  # each computation says so
        self.assertEqual((len(whole), len(parts)), (8, 8))
        self.assertLessEqual(parts[6], whole[6] + 1)  # it begins without a motion to go on from

    def test_a_computation_goes_on_without_the_masters_that_another_left_out(self):
        """A floor behind the edge of a block goes down to 0.87 of a patch, where it is left out, and comes up to 0.47: it stays out until 0.45. Who looked at
        it anew would leave it out from half a patch on, and find other forces."""
        mesh = union([slab("QUAD4", "TOOL", (0, 10), (0, 2), (10, 3), skin="bottom"), slab("QUAD4", "SLAB", (0, 4.4), (-2, 0), (5, 3)),
                      slab("QUAD4", "FLOOR", (4.4, 10), (-2, -0.42), (5, 2))])
        mesh.cell_groups["SLAB_SKIN"] = mesh.cell_groups["SLAB_SKIN"] + mesh.cell_groups["FLOOR_SKIN"]
        study = Study(name="floor", mesh=mesh, materials={body: elastic(1e3) for body in ("TOOL", "SLAB", "FLOOR")}, zones=[zone("TOOL", "SLAB", 0)], steps=3,
                      moves=[held("SLAB"), path("FLOOR", [(0, 0), (3, 0)], [(0, 0), (1, -0.5), (2, -0.1), (3, -0.1)]),
                             path("TOOL", [(0, 0), (3, 0)], [(0, 0), (1, -0.05), (3, -0.05)])])
        figures = run(study, LACON, self.folder)
        self.assertEqual((figures["status"], figures.get("alarms")), ("finished", None))
        orders = (HERE / "study.comm").read_text(encoding="utf-8")
        first = orders[orders.index("RESU = STAT_NON_LINE("):orders.index("CALC_CHAMP")]
        last = "INCREMENT=_F(LIST_INST=LIST),"
        self.assertIn(last, first)
        then = first.replace("RESU =", "MORE =").replace(last, "ETAT_INIT=_F(EVOL_NOLI=RESU), INCREMENT=_F(LIST_INST=LIST),")
        text = orders.replace(first, first.replace(last, "INCREMENT=_F(LIST_INST=LIST, INST_FIN=2.0),") + then)
        arguments, environment = study.prepare(self.folder)
        (self.folder / "parts.comm").write_text(text, encoding="utf-8")
        done = self.run_tool("parts.comm", *arguments[1:], "--base", "parts.base", **environment)
        self.assertEqual(done.returncode, 0, done.stderr)

        def forces(text):
            return re.findall(r"force on the slave (\([^)]*\))", text)

        whole = forces((self.folder / "out").read_text(encoding="utf-8"))
        self.assertEqual((len(whole), forces(done.stdout)), (3, whole))
        seen = self.run_tool("inspect", "parts.base", "--result", "MORE")
        self.assertIn("far behind", seen.stdout + seen.stderr)


if __name__ == "__main__":
    unittest.main()
