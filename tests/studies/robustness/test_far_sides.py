"""What a slave would see through bodies, its own or others: the far sides of thin ones, flanks of the next tooth. Zones have a part of the skins alone."""

import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent)]

from study_test import LACON, StudyTest  # noqa: E402, I001 (it says where meshes.py is)
from bodies import lines, slab  # noqa: E402
from meshes import block, brick, union, weld  # noqa: E402
from run import run  # noqa: E402
from studies import Study, elastic, held  # noqa: E402

PERIOD, HEIGHT = 2.0, 3.0  # of teeth


def teeth(x):
    part = x / PERIOD % 1
    return HEIGHT * 2 * min(part, 1 - part)


class FarSides(StudyTest):
    def forces(self, mesh, zones, **study):
        """Of each zone on its slave, at the last instant, with what was told."""
        bodies = study.pop("bodies")
        figures = run(Study(name="far sides", mesh=mesh, zones=[{"GROUP_MA_ESCL": slave, "GROUP_MA_MAIT": master} for slave, master in zones],
                            materials={body: elastic(2e5, study.pop("poisson", 0.3)) for body in bodies}, **study), LACON, self.folder)
        self.assertEqual(figures["status"], "finished", zones)
        self.assertEqual(set(figures.get("alarms", [])), set(), zones)
        self.assertLessEqual(figures["iterations"] + figures["lost"], 6)
        found = re.findall(r"force on the slave \(([^)]*)\)", (self.folder / "out").read_text())[-len(zones):]
        return [float(force.split(",")[-1]) for force in found]

    def rack(self, kind, gap):
        """Three teeth, and a body with a groove above the middle one, 4 cells a flank."""
        lower = [slab(kind, "LOWER", (first, first + PERIOD), (-4, 0), (8, 4), top=teeth, sides={"top": name})
                 for first, name in ((-PERIOD, "LEFT"), (0, "MIDDLE"), (PERIOD, "RIGHT"))]
        mesh = union([weld(union(lower)), slab(kind, "UPPER", (0, PERIOD), (0, gap + 6), (8, 4), top=lambda x: gap + teeth(x), skin="bottom")])
        mesh.cell_groups["TEETH"] = [cell for name in ("LEFT", "MIDDLE", "RIGHT") for cell in mesh.cell_groups[name]]
        return mesh

    def test_flanks_of_the_next_tooth(self):
        """Each flank sees those of the groove through its own tooth and the groove beside it, whose sides are in no zone: bodies that were nowhere near to
        each other pressed with 57 921, and passed for solved."""
        for kind in ("QUAD4", "QUAD8"):
            forces = {}
            for slave, gap, down in (("TEETH", 0.2, 0.1), ("TEETH", 0.02, 0.022), ("MIDDLE", 0.02, 0.022)):
                moves = [held("LOWER"), {"GROUP_MA": "UPPER_BASE", "DX": 0.0, "DY": -down}]
                for pair in ((slave, "UPPER_SKIN"), ("UPPER_SKIN", slave)):
                    forces[(slave, gap, pair.index(slave))], = self.forces(self.rack(kind, gap), [pair], bodies=("LOWER", "UPPER"), steps=1, moves=moves)
            for side in (0, 1):
                self.assertEqual(forces[("TEETH", 0.2, side)], 0)
                self.assertGreater(abs(forces[("MIDDLE", 0.02, side)]), 10)
                # the cut of QUAD4 refines the bodies of the other teeth as well
                self.assertAlmostEqual(forces[("TEETH", 0.02, side)], forces[("MIDDLE", 0.02, side)], delta=0.5 if kind == "QUAD4" and side == 0 else 1e-6)

    def plates(self, kind, thick, cells):
        """Two that lie on each other, all sides in their skins. @param cells along the lower and the upper one"""
        space = kind.startswith(("HEXA", "TETRA"))
        bodies = []
        for name, low, n in (("LOWER", -thick, cells[0]), ("UPPER", 0, cells[1])):
            sides = {(axis, end): f"{name}_{axis}{end}" for axis in range(3 if space else 2) for end in (0, 1)}
            across = [lines(0, 4, n)] * (len(sides) // 2 - 1) + [lines(low, low + thick, 1)]
            body = (brick(kind, across, None, name, sides) if space else
                    block(kind, *across, None, name, {side: sides[key] for side, key in (("left", (0, 0)), ("right", (0, 1)), ("bottom", (1, 0)), ("top", (1, 1)))}))
            body.cell_groups[f"{name}_SKIN"] = [cell for side in sides.values() for cell in body.cell_groups[side]]
            bodies.append(body)
        return union(bodies)

    def test_the_far_sides_of_thin_plates(self):
        """They overlap by twice the thickness, less than half of a cell. Patches were in contact with them, and nothing was solved."""
        for kind, thick, cells in (("QUAD4", 0.1, (10, 8)), ("QUAD8", 0.1, (10, 8)), ("QUAD8", 0.02, (10, 8)), ("HEXA8", 0.1, (6, 5))):
            axis = 2 if kind == "HEXA8" else 1
            moves = [{"GROUP_MA": f"LOWER_{axis}0", "D" + "XYZ"[axis]: 0.0}]
            moves += [{"GROUP_MA": f"{body}_{across}0", "D" + "XYZ"[across]: 0.0} for body in ("LOWER", "UPPER") for across in range(axis)]
            force, = self.forces(self.plates(kind, thick, cells), [("LOWER_SKIN", "UPPER_SKIN")], bodies=("LOWER", "UPPER"), poisson=0.0, steps=1, moves=moves,
                                 model="3D" if axis == 2 else "D_PLAN", loads=({"PRES_REP": {"GROUP_MA": f"UPPER_{axis}1", "PRES": 1.0}},))
            self.assertAlmostEqual(force, -4.0 ** axis, delta=1e-6)
