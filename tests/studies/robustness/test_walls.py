"""Walls of the master beside an edge: where a patch has a face in front of it they are no part of its contact, in a pocket they are."""

import math
import pathlib
import re
import sys

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent)]

from study_test import LACON, StudyTest  # noqa: E402, I001 (it says where meshes.py is)
from bodies import lines, slab, slab_in_space  # noqa: E402
from meshes import block, brick, union, weld  # noqa: E402
from results import Result  # noqa: E402
from run import missed, positions, run  # noqa: E402
from studies import Study, elastic, held, zone  # noqa: E402


class Walls(StudyTest):
    def forces(self, which):
        """Components of the force on the slave at each instant. @param which 1 or 2: the second or third"""
        return [float(found.split(",")[which]) for found in re.findall(r"force on the slave \(([^)]*)\)", (self.folder / "out").read_text())]

    def moment(self, group):
        """Of the reactions of a group about the origin, at the last instant."""
        result = Result(self.folder / "study.base", "RESU")
        order = result.orders[-1]
        nodes = positions(result, group)
        place = [result.points[nodes, axis] + result.at_nodes("DEPL", order, "DXDY"[2 * axis:2 * axis + 2])[nodes] for axis in (0, 1)]
        force = [result.at_nodes("REAC_NODA", order, name)[nodes] for name in ("DX", "DY")]
        return float(np.sum(place[0] * force[1] - place[1] * force[0]))

    def test_walls_beside_the_edge_of_a_block_are_no_part_of_its_contact(self):
        """A coarser slab, the slave, bends below the bottom of a stiffer cube: beside the edges its normals meet the sides of the cube, far up. With them in
        the zone half of the force was missing at a depth of 2 %, and cubes that lean stopped, or lost nine tenths."""
        walls = {(axis, end): "TOOL_SKIN" for axis in (0, 1) for end in (0, 1)}
        for kind, depth, leans, slides in (("HEXA8", 0.02, 0.01, 0.6), ("HEXA20", 0.02, 0.01, 0.6), ("HEXA8", 0.1, 0.01, 0.0), ("HEXA8", 0.1, 12.0, 0.6), ("TETRA4", 0.1, 0.5, 0.0)):
            forces = []
            for with_walls in (True, False):
                side = [lines(-0.5, 0.5, 3 if kind == "HEXA20" else 4)] * 3
                tool = brick(kind, side, None, "TOOL", {**(walls if with_walls else {}), (2, 0): "TOOL_SKIN", (2, 1): "TOOL_BASE"})
                for axes, angle in (((1, 2), leans), ((2, 0), 0.3 * leans)):
                    cosine, sine = math.cos(math.radians(angle)), math.sin(math.radians(angle))
                    tool.points[:, axes] = tool.points[:, axes] @ np.array([[cosine, sine], [-sine, cosine]])
                tool.points = tool.points - [0, 0, tool.points[:, 2].min()]
                mesh = union([tool, slab_in_space(kind, "SLAB", (-1.5, 1.5), (-1.5, 1.5), (-1, 0), (7, 7, 3))])
                study = Study(name="walls", mesh=mesh, model="3D", materials={"TOOL": elastic(5e3), "SLAB": elastic(1e3)}, zones=[zone("TOOL", "SLAB", 1)],
                              strain="GREEN_LAGRANGE", steps=4, asked={"per step": 10},
                              moves=[{**held("SLAB"), "DZ": 0.0}, {"GROUP_MA": "TOOL_BASE", "DX": [[0, 0], [2, 0], [4, slides / 3]], "DY": 0.0, "DZ": [[0, 0], [2, -depth], [4, -depth]]}])
                figures = run(study, LACON, self.folder)
                self.assertEqual(missed(study, figures), [], (kind, depth, leans, with_walls))
                self.assertNotIn("EVOLUTION_68", figures.get("alarms", []))
                forces.append(self.forces(2))
            for beside, alone in zip(*forces, strict=True):
                self.assertAlmostEqual(beside, alone, delta=1e-6 * abs(alone), msg=(kind, depth, leans))

    def test_the_sliver_of_a_crest_carries_all(self):
        """Two stiff trapezoids, corner on corner, whose flanks of 66 degrees are in the zone, and a soft layer above that is pressed by a tenth: whatever small
        part of a patch is on the other's crest, the force is that of the layer. Below a fiftieth the flank came into the average: no status was right."""
        flank = 1 / math.tan(math.radians(66))
        for kind in ("QUAD4", "QUAD8"):
            for side in (0, 1):
                whole = None
                for share in (0.5, 0.018, 0.009, 0.002):
                    over, upper = 0.25 * share, lines(0, 1, 4 if side else 5)
                    low = block(kind, lines(-1, 0, 4), lines(-1, 0, 4), lambda s, t: (s - (s + 1) * t * flank, t), "LOWER",
                                {"top": "LOWER_SKIN", "right": "LOWER_SKIN", "bottom": "LOWER_BASE"})
                    up = block(kind, upper, lines(0, 1, 4), lambda s, t, over=over: (s - over - (1 - s) * t * flank, t), "UPPER",
                               {"bottom": "UPPER_SKIN", "left": "UPPER_SKIN"})
                    layer = block(kind, upper, lines(1, 2, 2), lambda s, t, over=over: (s - over - (1 - s) * flank, t), "LAYER", {"top": "TOP"})
                    study = Study(name="crest", mesh=union([low, weld(union([up, layer]))]), steps=2, asked={"per step": 4},
                                  materials={"LOWER": elastic(1e7, 0.0), "UPPER": elastic(1e7, 0.0), "LAYER": elastic(1e2, 0.0)}, zones=[zone("LOWER", "UPPER", side)],
                                  moves=[{"GROUP_MA": "LOWER", "DX": 0.0}, {"GROUP_MA": "LOWER_BASE", "DY": 0.0}, {"GROUP_MA": "UPPER", "DX": 0.0},
                                         {"GROUP_MA": "LAYER", "DX": 0.0}, {"GROUP_MA": "TOP", "DY": [[0, 0], [2, -0.1]]}])
                    figures = run(study, LACON, self.folder)
                    self.assertEqual(missed(study, figures), [], (kind, side, share))
                    force = self.forces(1)[-1]
                    whole = whole or force
                    self.assertAlmostEqual(force, whole, delta=1e-4 * abs(whole), msg=(kind, side, share))  # crests are 1e5 times as stiff
                self.assertAlmostEqual(abs(whole), 100 * 0.1 * (1 + flank), delta=1e-4 * abs(whole))

    def test_a_sliver_that_lies_deep_is_no_crest(self):
        """A block pressed by 0.03 near the end of a slab, their sides in the zone: of the side behind a patch sees the other's by as little as the bodies overlap,
        and far inside. Were that its contact, the top would open: 0.35 for 4.2, and the iterations 'Converged'."""
        for kind, slab_is_slave, strain, at in (("QUAD4", True, "PETIT", 0.951), ("QUAD4", True, "PETIT", 0.941), ("QUAD8", False, "GREEN_LAGRANGE", 0.871)):
            forces = []
            for with_sides in (True, False):
                low = block(kind, lines(-1.5, 1, 13), lines(-1, 0, 5), None, "SLAB", {"top": "SLAB_SKIN", "bottom": "SLAB_BASE", **({"right": "SLAB_SKIN"} if with_sides else {})})
                up = block(kind, lines(at, at + 1, 4), lines(0, 0.6, 3), None, "TOOL", {"bottom": "TOOL_SKIN", "top": "TOOL_BASE", **({"left": "TOOL_SKIN"} if with_sides else {})})
                study = Study(name="end", mesh=union([low, up]), materials={"TOOL": elastic(1e3), "SLAB": elastic(1e3)}, zones=[zone("TOOL", "SLAB", int(slab_is_slave))],
                              strain=strain, steps=1, asked={"per step": 8},
                              moves=[held("SLAB"), {"GROUP_MA": "TOOL_BASE", "DX": 0.0, "DY": [[0, 0], [1, -0.03]]}])
                figures = run(study, LACON, self.folder)
                self.assertEqual(missed(study, figures), [], (kind, at, with_sides))
                forces.append(self.forces(1)[-1])
            self.assertAlmostEqual(forces[0], forces[1], delta=0.03 * abs(forces[1]), msg=(kind, at))  # sides in the zone take a part

    def test_a_square_key_in_a_square_hole_is_held_by_either_as_the_slave(self):
        """Turned by 0.06 about its middle. Patches of the hole beside the corners of the key met its other sides: half of the moment, or a stop."""
        grid = np.concatenate([lines(-2.5, -1, 4)[:-1], lines(-1, 1, 6), lines(1, 2.5, 4)[1:]])
        low, middle, high = grid[grid <= -0.999], grid[abs(grid) <= 1.001], grid[grid >= 0.999]
        for clearance in (0.0, 0.02):
            moments = []
            for side in (0, 1):
                half = lines(-1 + clearance, 1 - clearance, 8)
                key = block("QUAD8", half, half, None, "TOOL", {name: "TOOL_SKIN" for name in ("left", "right", "top", "bottom")})
                around = [(low, low, {"left": "SLAB_BASE"}), (low, middle, {"left": "SLAB_BASE", "right": "SLAB_SKIN"}), (low, high, {"left": "SLAB_BASE"}),
                          (high, low, {"right": "SLAB_BASE"}), (high, middle, {"right": "SLAB_BASE", "left": "SLAB_SKIN"}), (high, high, {"right": "SLAB_BASE"}),
                          (middle, high, {"bottom": "SLAB_SKIN"}), (middle, low, {"top": "SLAB_SKIN"})]
                mesh = union([key, weld(union([block("QUAD8", x, y, None, "SLAB", sides) for x, y, sides in around]))])
                mesh.cell_groups["HUB"] = [cell for cell in mesh.cell_groups["TOOL"] if np.all(np.abs(mesh.points[mesh.cells[cell[0]][cell[1]]]) < 0.3)]
                turn = {"GROUP_MA": "HUB", "DX": "X*(cos(0.06*INST)-1)-Y*sin(0.06*INST)", "DY": "X*sin(0.06*INST)+Y*(cos(0.06*INST)-1)"}
                study = Study(name="key", mesh=mesh, materials={"TOOL": elastic(2e3), "SLAB": elastic(2e3)}, zones=[zone("TOOL", "SLAB", side)], strain="GREEN_LAGRANGE",
                              steps=4, instants=[0.25, 0.5, 0.75, 1.0], moves=[held("SLAB"), turn], asked={"per step": 5, "lost": 0})
                figures = run(study, LACON, self.folder)
                self.assertEqual(missed(study, figures), [], (clearance, side))
                self.assertNotIn("EVOLUTION_68", figures.get("alarms", []))
                moments.append(self.moment("SLAB_BASE"))
            self.assertAlmostEqual(moments[1], moments[0], delta=0.01 * abs(moments[0]), msg=clearance)
            self.assertGreater(abs(moments[0]), 20)

    def test_a_block_lies_on_the_floor_and_the_wall_of_a_corner(self):
        """Its corner has both in front of it: were the wall left out the floor would end there, and no iterate would find where."""
        for kind, width in (("QUAD8", 9), ("TRIA6", 9), ("QUAD4", 5)):
            mesh = union([weld(union([block(kind, lines(-2, 0, 8), lines(-1, 0, 3), None, "SLAB", {"top": "SLAB_SKIN", "left": "SLAB_BASE", "bottom": "SLAB_BASE"}),
                                      block(kind, lines(0, 1, 3), lines(-1, 0, 3), None, "SLAB", {"bottom": "SLAB_BASE", "right": "SLAB_BASE"}),
                                      block(kind, lines(0, 1, 3), lines(0, 1, 6), None, "SLAB", {"left": "SLAB_SKIN", "right": "SLAB_BASE", "top": "SLAB_SKIN"})])),
                          block(kind, lines(-1, 0, width), lines(0, 0.8, width - 1), None, "TOOL", {"bottom": "TOOL_SKIN", "right": "TOOL_SKIN", "top": "TOOL_BASE"})])
            study = Study(name="pocket", mesh=mesh, materials={"TOOL": elastic(1e3), "SLAB": elastic(1e3)}, zones=[zone("TOOL", "SLAB", 0)], steps=4,
                          asked={"per step": 5, "lost": 0}, moves=[held("SLAB"), {"GROUP_MA": "TOOL_BASE", "DX": 0.0, "DY": [[0, 0], [4, -0.05]]}])
            self.assertEqual(missed(study, run(study, LACON, self.folder)), [], (kind, width))

    def test_a_square_that_turns_on_another_of_its_sides_in_one_step_rests_on_it_as_if_it_had_not_turned(self):
        """All its sides are in the zone, and the slab is the slave: what was below it is a wall now, and what was a wall is in front."""
        side = lines(-0.5, 0.5, 6)
        found = []
        for turn in (0.0, math.pi / 2):
            square = block("QUAD4", side, side, None, "TOOL", {name: "TOOL_SKIN" for name in ("left", "right", "top", "bottom")})
            mesh = union([square, slab("QUAD4", "SLAB", (-1.5, 1.5), (-1.5, -0.5), (18, 5))])
            mesh.cell_groups["HUB"] = [cell for cell in mesh.cell_groups["TOOL"] if np.all(np.abs(mesh.points[mesh.cells[cell[0]][cell[1]]]) < 0.2)]
            move = {"GROUP_MA": "HUB", "DX": f"X*(cos({turn}*INST)-1)-Y*sin({turn}*INST)", "DY": f"X*sin({turn}*INST)+Y*(cos({turn}*INST)-1)-0.08*INST"}
            study = Study(name="turn", mesh=mesh, materials={"TOOL": elastic(2e3), "SLAB": elastic(1e3)}, zones=[zone("TOOL", "SLAB", 1)], strain="GREEN_LAGRANGE",
                          steps=1, moves=[held("SLAB"), move])
            figures = run(study, LACON, self.folder)
            self.assertEqual(figures["status"], "finished", turn)
            found.append((self.forces(0)[-1], self.forces(1)[-1]))
        for across, up in found:
            self.assertAlmostEqual(across, 0, delta=1e-6 * abs(found[0][1]))
            self.assertAlmostEqual(up, found[0][1], delta=1e-6 * abs(found[0][1]))
