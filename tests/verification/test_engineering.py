"""Beams that floors hold up, a tube that a sleeve expands beyond its elastic limit, a flat punch with rounded edges: closed forms."""

import math
import unittest

import numpy as np

from load_study import StudyTest
from meshes import block, graded, union, write_med  # noqa: I001 (load_study says where it is)
from results import Result

COMM = """
DEBUT()
WHOLE = LIRE_MAILLAGE(UNITE=20)
MESH = CREA_MAILLAGE(MAILLAGE=WHOLE, DECOUPE_LAC=_F(GROUP_MA_ESCL='SLAVE'))
MODEL = AFFE_MODELE(MAILLAGE=MESH, AFFE=_F(TOUT='OUI', PHENOMENE='MECANIQUE', MODELISATION={model!r}))
MATTER = AFFE_MATERIAU(MAILLAGE=MESH, AFFE=[_F(GROUP_MA=body, MATER=DEFI_MATERIAU(**law)) for body, law in {laws!r}.items()])
CONTACT = DEFI_CONTACT(MODELE=MODEL, FORMULATION='CONTINUE', ALGO_RESO_GEOM='NEWTON', ALGO_RESO_CONT='NEWTON',
                       ZONE=_F(ALGO_CONT='LAC', GROUP_MA_ESCL='SLAVE', GROUP_MA_MAIT='MASTER', CONTACT_INIT={initial!r}))
LOADS = [_F(CHARGE=AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO={held!r}))]
for command, keywords, course in {loads!r}:
    LOADS.append(_F(CHARGE=globals()[command](MODELE=MODEL, **keywords),
                    FONC_MULT=DEFI_FONCTION(NOM_PARA='INST', VALE=course, PROL_DROITE='CONSTANT')))
R = STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=MATTER, CONTACT=CONTACT, EXCIT=LOADS, COMPORTEMENT={flows!r},
                  INCREMENT=_F(LIST_INST=DEFI_LIST_REEL(VALE={instants!r})), CONVERGENCE=_F(RESI_GLOB_RELA=1e-8, ITER_GLOB_MAXI=25))
R = CALC_CHAMP(reuse=R, RESULTAT=R, FORCE='REAC_NODA')
FIN()
"""


def lines(first, last, count):
    return np.linspace(first, last, count + 1)


def steel(young, poisson=0.0, density=0.0):
    return {"ELAS": {"E": young, "NU": poisson, "RHO": density}}


class Study(StudyTest):
    def solved(self, bodies, laws, held, loads, instants, model="D_PLAN", initial="INTERPENETRE", flows=()):
        """The result R: a list of instants solved in one computation, without a step being cut."""
        write_med(self.folder / "study.med", union(bodies))
        comm = self.folder / "study.comm"
        comm.write_text(COMM.format(laws=laws, held=held, loads=loads, instants=instants, model=model, initial=initial,
                                    flows=flows or [{"RELATION": "ELAS"}]), encoding="utf-8")
        run = self.run_study(comm, "--fresh", "--unit", f"20={self.folder / 'study.med'}")
        self.assertEqual(run.status, 0, run.stdout[-3000:] + run.stderr[-3000:])
        return Result(self.folder / "study.base", "R")

    def sum_over(self, result, order, group, component="DY"):
        nodes = sorted({node for cell in result.groups[group] for node in result.cells[cell][1]})
        return result.at_nodes("REAC_NODA", order, component)[nodes].sum()

    def pressed(self, result, order):
        """Ends (first, last coordinate x) of the patches in contact."""
        cells = [cell for cell, status in result.on_cells("CONT_ELEM", order, "CONT").items() if status == 1]
        x = result.points[[node for cell in cells for node in result.cells[cell][1]], 0]
        return x.min(), x.max()


class Beams(Study):
    """E = 200000, nu = 0; the floor is a hundred times stiffer. A patch is the size of a cell: the end of contact is known to one."""
    YOUNG = 2e5

    def floor(self, kind, first, last, top, cells):
        return block(kind, lines(first, last, cells), lines(top - 6, top, 2), name="FLOOR", sides={"top": "MASTER", "bottom": "GROUND"})

    def laws(self, density=0.0):
        return {"FLOOR": steel(100 * self.YOUNG), "BEAM": steel(self.YOUNG, 0.0, density)}

    def pressed_onto(self):
        """A clamped beam, 100 long and 1 thick, 0.2 above a floor, under a pressure q. w'''' = q / E I, and no moment where it meets the floor:
        q l^4 / (72 E I) is the height, q l / 3 the force on the edge. @return rows of q, iterations, l, theory, force, theory, q"""
        long, high, courses = 100.0, 0.2, (0.001, 0.005, 0.02, 0.05, 0.1, 0.3)  # the first one hardly brings it there
        beam = block("QUAD8", lines(0, long, 160), lines(0, 1, 2), name="BEAM",
                     sides={"bottom": "SLAVE", "top": "TOP", "left": "ROOT", "right": "MIDDLE"})
        course = [float(v) for pair in enumerate((0.0, *courses)) for v in pair]
        result = self.solved([beam, self.floor("TRIA6", -1, long, -high, 33)], self.laws(),
                             [{"GROUP_MA": ("ROOT", "GROUND"), "DX": 0.0, "DY": 0.0}, {"GROUP_MA": "MIDDLE", "DX": 0.0}],
                             [("AFFE_CHAR_MECA", {"FORCE_CONTOUR": {"GROUP_MA": "TOP", "FY": -1.0}}, course)],
                             [float(k) for k in range(len(courses) + 1)])
        rows = []
        for q, order, iterations in list(zip(courses, result.orders[1:], result.parameter("newton_iterations")[1:]))[1:]:
            free = (72 * self.YOUNG / 12 * high / q)**0.25
            rows.append((q, int(iterations), self.pressed(result, order)[0], free, self.sum_over(result, order, "GROUND"), q * (long - 2 * free / 3), q))
        return rows

    def lifted(self):
        """A heavy beam, 200 long and 2 thick, lies on a floor and is lifted at its end, without a moment there, nor where it leaves the floor:
        q l^4 / (24 E I) is the height, q l / 2 the force. @return rows of height, iterations, l, theory, force, theory, q"""
        long, thick, density, gravity = 200.0, 2.0, 7.8e-6, 9810.0
        beam = block("QUAD8", lines(0, long, 200), lines(0, thick, 2), name="BEAM", sides={"bottom": "SLAVE", "left": "MIDDLE"})
        beam.node_groups["END"] = beam.nodes_where(lambda x, y: x == long and y == 0)
        heights = (0.25, 0.5, 1.0)
        instants = [0.0, 1.0] + [1.0 + height for height in heights]
        result = self.solved([beam, self.floor("QUAD4", -1, long + 5, 0.0, 19)], self.laws(density),
                             [{"GROUP_MA": "GROUND", "DX": 0.0, "DY": 0.0}, {"GROUP_MA": "MIDDLE", "DX": 0.0}],
                             [("AFFE_CHAR_CINE", {"MECA_IMPO": {"GROUP_NO": "END", "DY": 1.0}}, [0.0, 0.0, 1.0, 0.0, 2.0, 1.0]),
                              ("AFFE_CHAR_MECA", {"PESANTEUR": {"GRAVITE": gravity, "DIRECTION": (0.0, -1.0, 0.0)}}, [0.0, 0.0, 1.0, 1.0])],
                             instants, initial="OUI")
        rows = []
        end = int(np.flatnonzero((result.points[:, 0] == long) & (result.points[:, 1] == 0))[0])
        weight = density * gravity * thick
        for height, order, iterations in zip(heights, result.orders[2:], result.parameter("newton_iterations")[2:]):
            free = (24 * self.YOUNG * thick**3 / 12 * height / weight)**0.25
            rows.append((height, int(iterations), long - self.pressed(result, order)[1], free, result.at_nodes("REAC_NODA", order, "DY")[end],
                         weight * free / 2, weight))
        return rows

    def check(self, rows, patch, thick):
        """Shear, E I / (k G A) = t^2 / 5, moves the edge of l by less than t^2 / l, and patches show where it is to their size."""
        for _, iterations, length, free, force, exact, load in rows:
            self.assertAlmostEqual(length, free, delta=2 * patch + thick**2 / free)
            self.assertAlmostEqual(force, exact, delta=load * thick**2 / free)
            self.assertLessEqual(iterations, 15)  # one for each patch without EdgeCourse, 20 and more

    def test_a_beam_pressed_onto_a_floor_meets_it_where_it_has_no_moment(self):
        self.check(self.pressed_onto(), 0.625, 1.0)

    def test_a_beam_lifted_at_its_end_leaves_the_floor_where_it_has_no_moment(self):
        self.check(self.lifted(), 1.0, 2.0)


class ExpandedTube(Study):
    """An elastic sleeve, radii 8 to 10, is expanded by a pressure in a tube, 10 to 20, that flows at 200 without hardening (D_PLAN_SI, 30
    degrees, QUAD8; E = 200000, nu = 0.3). R. Hill (The Mathematical Theory of Plasticity, 1950): with k = 200 / sqrt(3) and c the radius of
    what flows, the tube widens outside by 2 k c^2 (1 - nu^2) / (E b) and is pressed by k (1 - c^2 / b^2 + 2 ln(c / a))."""
    YOUNG, POISSON, YIELD = 2e5, 0.3, 200.0
    INNER, JOINT, OUTER = 8.0, 10.0, 20.0
    PRESSURES = (60.0, 120.0, 160.0, 180.0, 200.0, 220.0, 240.0, 260.0)

    def ring(self, name, first, last, around, across, sides):
        def place(angle, radius):
            return radius * math.sin(angle), radius * math.cos(angle)

        return block("QUAD8", lines(0, math.pi / 6, around), lines(first, last, across), place, name, {"left": "AXIS", "right": "CUT", **sides})

    def figures(self):
        """Rows of pressure inside, c, pressures of contact (least, largest), theory."""
        elastic = {"E": self.YOUNG, "NU": self.POISSON}
        result = self.solved(
            [self.ring("SLEEVE", self.INNER, self.JOINT, 8, 4, {"bottom": "INSIDE", "top": "SLAVE"}),
             self.ring("TUBE", self.JOINT, self.OUTER, 6, 16, {"bottom": "MASTER", "top": "OUTSIDE"})],
            {"SLEEVE": {"ELAS": elastic}, "TUBE": {"ELAS": elastic, "ECRO_LINE": {"SY": self.YIELD, "D_SIGM_EPSI": 1e-5 * self.YOUNG}}},
            [{"GROUP_MA": "AXIS", "DX": 0.0}],
            [("AFFE_CHAR_MECA", {"PRES_REP": {"GROUP_MA": "INSIDE", "PRES": 1.0}}, [0.0, 0.0, 260.0, 260.0]),
             ("AFFE_CHAR_MECA", {"FACE_IMPO": {"GROUP_MA": "CUT", "DNOR": 0.0}}, [0.0, 1.0, 260.0, 1.0])],
            [0.0, *self.PRESSURES], "D_PLAN_SI", "OUI", [{"RELATION": "ELAS", "GROUP_MA": "SLEEVE"}, {"RELATION": "VMIS_ISOT_LINE", "GROUP_MA": "TUBE"}])
        outside = [i for i, (x, y) in enumerate(result.points) if abs(x) < 1e-9 and abs(y - self.OUTER) < 1e-9]
        shear, rows = self.YIELD / math.sqrt(3), []
        for pressure, order in zip(self.PRESSURES, result.orders[1:]):
            widened = float(result.at_nodes("DEPL", order, "DY")[outside[0]])
            c = math.sqrt(widened * self.YOUNG * self.OUTER / (2 * shear * (1 - self.POISSON**2)))
            if c < self.JOINT:
                continue
            exact = shear * (1 - (c / self.OUTER)**2 + 2 * math.log(c / self.JOINT))
            found = [-value for value in result.on_cells("CONT_ELEM", order, "PRES").values()]
            rows.append((pressure, c, min(found), max(found), exact))
        return rows

    def test_what_a_tube_bears_is_what_hill_has(self):
        """Of the tube a sixteenth is a cell: its points say whether they flow, c is known to a third of it, and the pressure to its square."""
        rows = self.figures()
        self.assertGreaterEqual(len(rows), 5)
        for _, _, least, largest, exact in rows:
            self.assertAlmostEqual(least, exact, delta=2e-3 * exact)
            self.assertAlmostEqual(largest, exact, delta=2e-3 * exact)


class RoundedPunch(Study):
    """A stiff punch, flat to x = 1, then y = (x - 1)^2 / 40, on a block 60 wide and high (D_PLAN, QUAD8; E = 200000, nu = 0.3)."""
    YOUNG, POISSON, FLAT, RADIUS, FINE = 2e5, 0.3, 1.0, 20.0, 0.05
    DEPTHS = (0.0125, 0.025, 0.05)

    def loaded(self, angle):
        """M. Ciavarella, D. A. Hills, G. Monno (Proc. Instn Mech. Engrs C 212, 1998): the force where contact ends at 1 / sin(angle)."""
        modulus = self.YOUNG / (1 - self.POISSON**2)
        return self.FLAT**2 * modulus / (2 * self.RADIUS) * ((math.pi - 2 * angle) / (2 * math.sin(angle)**2) - 1 / math.tan(angle))

    def theory(self, force):
        """(half width of contact, pressure in the middle) for a force."""
        low, high = 1e-3, math.pi / 2
        for _ in range(60):
            middle = (low + high) / 2
            low, high = (middle, high) if self.loaded(middle) > force else (low, middle)
        angle = low
        share = 2 / math.pi / (math.pi - 2 * angle - math.sin(2 * angle))
        in_the_middle = (math.pi - 2 * angle) + 2 * math.sin(angle) * math.log(math.tan(angle / 2))
        return self.FLAT / math.sin(angle), share * in_the_middle * force * math.sin(angle) / self.FLAT

    def figures(self):
        """Rows of depth, force, half width of contact, theory, pressure in the middle, theory."""
        across, down = graded(60.0, self.FINE, 1.8, 1.2), graded(60.0, self.FINE, 0.3, 1.25)
        punch = block("QUAD8", graded(12.0, 0.06, 1.8, 1.2), down,
                      lambda x, t: (x, max(x - self.FLAT, 0.0)**2 / (2 * self.RADIUS) * (1 - t / 60) + t), "PUNCH",
                      {"bottom": "MASTER", "top": "PUSHED", "left": "AXIS"})
        base = block("QUAD8", across, -down[::-1], None, "BLOCK", {"top": "SLAVE", "bottom": "GROUND", "left": "AXIS"})
        result = self.solved([punch, base], {"PUNCH": steel(1e4 * self.YOUNG, self.POISSON), "BLOCK": steel(self.YOUNG, self.POISSON)},
                             [{"GROUP_MA": "AXIS", "DX": 0.0}, {"GROUP_MA": "GROUND", "DY": 0.0}],
                             [("AFFE_CHAR_CINE", {"MECA_IMPO": {"GROUP_MA": "PUSHED", "DY": -1.0}}, [0.0, 0.0, 1.0, 1.0])], [0.0, *self.DEPTHS])
        rows = []
        for depth, order in zip(self.DEPTHS, result.orders[1:]):
            force = 2 * self.sum_over(result, order, "GROUND")
            width, middle = self.theory(force)
            pressures = result.on_cells("CONT_ELEM", order, "PRES")
            first = min(pressures, key=lambda cell: result.points[result.cells[cell][1], 0].min())
            rows.append((depth, force, self.pressed(result, order)[1], width, -pressures[first], middle))
        return rows

    def test_a_flat_punch_with_rounded_edges_presses_as_theory_has_it(self):
        """The pressure differs by terms of a / 60 squared, the size of the block, and by the slope of the edges, 1 / 40."""
        for _, _, width, exact, middle, in_theory in self.figures():
            self.assertAlmostEqual(width, exact, delta=self.FINE)
            self.assertAlmostEqual(middle, in_theory, delta=0.005 * in_theory)


if __name__ == "__main__":
    unittest.main()
