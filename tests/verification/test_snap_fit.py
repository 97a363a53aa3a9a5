"""A hook that snaps over a ridge, in space, of curved cells: it is bent as a cantilever, and straight again behind the ridge."""

import unittest

import numpy as np

from load_study import StudyTest
from meshes import brick, union, write_med  # noqa: I001 (load_study says where it is)
from results import Result

COMM = """
DEBUT()
WHOLE = LIRE_MAILLAGE(UNITE=20)
MESH = CREA_MAILLAGE(MAILLAGE=WHOLE, DECOUPE_LAC=_F(GROUP_MA_ESCL='NOSE'))
MODEL = AFFE_MODELE(MAILLAGE=MESH, AFFE=_F(TOUT='OUI', PHENOMENE='MECANIQUE', MODELISATION='3D'))
SOFT = DEFI_MATERIAU(ELAS=_F(E={young}, NU=0.0))
STIFF = DEFI_MATERIAU(ELAS=_F(E={stiff}, NU=0.0))
FIELD = AFFE_MATERIAU(MAILLAGE=MESH, AFFE=(_F(GROUP_MA='HOOK', MATER=SOFT), _F(GROUP_MA='RIDGE', MATER=STIFF)))
CONTACT = DEFI_CONTACT(MODELE=MODEL, FORMULATION='CONTINUE', ALGO_RESO_GEOM='NEWTON', ALGO_RESO_CONT='NEWTON',
                       ZONE=_F(ALGO_CONT='LAC', GROUP_MA_ESCL='NOSE', GROUP_MA_MAIT='FLANKS'))
RAMP = DEFI_FONCTION(NOM_PARA='INST', VALE=(0, 0, 1, {way}))
HOLD = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=(_F(GROUP_MA='BASE', DX=0, DY=0, DZ=0), _F(GROUP_MA='ROOT', DY=0, DZ=0)))
PUSH = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA='ROOT', DX=1.0))
TIMES = DEFI_LIST_REEL(DEBUT=0.0, INTERVALLE=_F(JUSQU_A=1.0, NOMBRE={steps}))
R = STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=FIELD, CONTACT=CONTACT, EXCIT=(_F(CHARGE=HOLD), _F(CHARGE=PUSH, FONC_MULT=RAMP)),
                  INCREMENT=_F(LIST_INST=DEFI_LIST_INST(DEFI_LIST=_F(LIST_INST=TIMES))))
R = CALC_CHAMP(reuse=R, RESULTAT=R, FORCE='REAC_NODA')
FIN()
"""


def lines(first, last, count):
    return np.linspace(first, last, count + 1)


class SnapFit(StudyTest):
    """The nose has the flank of the ridge: both meet with all of their faces, 1 to the side and FLANK up."""

    LONG, THICK, WIDE, NOSE = 3.0, 0.2, 0.6, 0.3   # of the hook, and how far its nose reaches down
    FLANK = 0.3 / 0.55
    GAP = 0.24                                     # on the way to the ridge
    HIGH, TOP = 0.25, 0.15                         # by how much the ridge lifts the nose, and how long it is above
    YOUNG, STIFF = 2e3, 2e4
    WAY, STEPS = 1.2, 12

    def hook(self):
        """A beam along x with a nose below its end: a steep back, a flat bottom, a flank in front."""
        under = ([0, 2.9, 3.1, 3.25, 3.8], [0, 0, -self.NOSE, -self.NOSE, 0])
        x = np.concatenate([lines(0, 2.9, 5), [3.1, 3.25], lines(3.25, 3.8, 2)[1:]])
        mesh = brick("HEXA20", (x, lines(0, self.WIDE, 2), lines(0, 1, 1)),
                     lambda x, y, t: (x, y, (1 - t) * np.interp(x, *under) + t * self.THICK), "HOOK", {(0, 0): "ROOT", (2, 0): "NOSE"})
        mesh.cell_groups["NOSE"] = [(kind, c) for kind, c in mesh.cell_groups["NOSE"] if mesh.points[mesh.cells[kind][c], 0].min() > 2.8]
        return mesh

    def ridge(self):
        """Wider than the hook; its flanks are the same behind and in front."""
        top = self.HIGH - self.NOSE
        start = 3.25 + self.GAP - 0.05 / self.FLANK
        crest = start + 0.3 / self.FLANK
        over = ([start, crest, crest + self.TOP, crest + self.TOP + 0.2, 5.2], [top - 0.3, top, top, top - 0.3, top - 0.3])
        x = np.concatenate([lines(start, crest, 2), [crest + self.TOP], [crest + self.TOP + 0.2, 5.2]])
        return brick("HEXA20", (x, lines(-0.1, self.WIDE + 0.1, 2), lines(0, 1, 1)),
                     lambda x, y, t: (x, y, -0.8 * (1 - t) + t * np.interp(x, *over)), "RIDGE", {(2, 0): "BASE", (2, 1): "FLANKS"})

    def figures(self):
        """Of each instant: way, force on the hook's root (3), its moment about the beam's axis, largest displacement less the way."""
        write_med(self.folder / "snap.med", union([self.hook(), self.ridge()]))
        comm = self.folder / "snap.comm"
        comm.write_text(COMM.format(young=self.YOUNG, stiff=self.STIFF, way=self.WAY, steps=self.STEPS), encoding="utf-8")
        run = self.run_study(comm, "--fresh", "--unit", f"20={self.folder / 'snap.med'}")
        self.assertEqual(run.status, 0, run.stdout[-3000:] + run.stderr[-3000:])
        result = Result(self.folder / "snap.base", "R")

        def nodes_of(group):
            return sorted({node for cell in result.groups[group] for node in result.cells[cell][1]})

        root, hook = nodes_of("ROOT"), nodes_of("HOOK")
        rows = []
        for order in result.orders[1:]:
            way = result.instants[order] * self.WAY
            forces = np.stack([result.at_nodes("REAC_NODA", order, "D" + axis)[root] for axis in "XYZ"], axis=1)
            moved = np.stack([result.at_nodes("DEPL", order, "D" + axis)[hook] for axis in "XYZ"], axis=1) - [way, 0, 0]
            moment = ((result.points[root, 2] - self.THICK / 2) * forces[:, 0]).sum()
            rows.append((way, forces.sum(axis=0), moment, np.abs(moved).max()))
        return rows

    def bending(self, force, moment):
        """Twice the energy of the beam as far as the nose, by the moment in it."""
        x, weight = np.polynomial.legendre.leggauss(3)
        x, weight = 1.45 * (x + 1), 1.45 * weight
        return (weight * (moment + force[2] * x)**2).sum() * 12 / (self.YOUNG * self.WIDE * self.THICK**3)

    def on_flank(self, rows):
        """Of the instants at which both flanks meet whole: force to the side over the one up, work over twice the energy of bending."""
        return [(force[0] / -force[2], (way - self.GAP) * force[0] / self.bending(force, moment)) for way, force, moment, _ in rows
                if self.GAP < way < 0.41]

    def work(self, rows):
        """(work that the hook takes to be lifted, and gives back), by trapezia."""
        way, force = np.array([(way, force[0]) for way, force, *_ in rows]).T
        parts = np.diff(way) * (force[1:] + force[:-1]) / 2
        return parts[parts > 0].sum(), -parts[parts < 0].sum()

    def test_it_is_bent_as_a_cantilever_and_straight_again_behind_the_ridge(self):
        """Without friction forces are normal to the flank, and the work comes back, but for what trapezia of such steps leave."""
        rows = self.figures()
        for direction, energy in self.on_flank(rows):
            self.assertAlmostEqual(direction, self.FLANK, delta=1e-4)
            self.assertAlmostEqual(energy, 1, delta=0.01)
        taken, given = self.work(rows)
        self.assertLessEqual(abs(given - taken), 0.1 * taken)
        _, force, _, moved = rows[-1]
        self.assertLessEqual(np.abs(force).max(), 1e-9 * max(np.abs(row[1]).max() for row in rows))
        self.assertLessEqual(moved, 1e-10)


if __name__ == "__main__":
    unittest.main()
