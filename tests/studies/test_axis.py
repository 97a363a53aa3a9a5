"""A body on the axis of revolution whose radial displacement nothing holds there is told, with what to do; where anything holds it, nothing is said."""

import unittest

import numpy as np
from study_test import StudyTest

from meshes import block, union, write_med

HEAD = """
DEBUT()
MESH = LIRE_MAILLAGE(UNITE=20)
MODEL = AFFE_MODELE(MAILLAGE=MESH, AFFE=_F(TOUT='OUI', PHENOMENE='MECANIQUE', MODELISATION='{model}'))
STEEL = DEFI_MATERIAU(ELAS=_F(E=2000.0, NU=0.3))
FIELD = AFFE_MATERIAU(MAILLAGE=MESH, AFFE=_F(TOUT='OUI', MATER=STEEL))
BASE = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA='BASE', DY=0.0))
PUSH = AFFE_CHAR_MECA(MODELE=MODEL, PRES_REP=_F(GROUP_MA='TOP', PRES=1.0))
TIMES = DEFI_LIST_REEL(DEBUT=0.0, INTERVALLE=_F(JUSQU_A=1.0, NOMBRE=1))
"""
SOLVE = """
R{n} = STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=FIELD, EXCIT=(_F(CHARGE=BASE), _F(CHARGE=PUSH), {excit}), INCREMENT=_F(LIST_INST=TIMES){more})
"""

#: what holds DX = 0 on the axis: a load, or what STAT_NON_LINE takes
HELD = {
    "eliminated": "AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA='AXIS', DX=0.0))",
    "a function": "AFFE_CHAR_CINE_F(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA='AXIS', DX=DEFI_CONSTANTE(VALE=0.0)))",
    "at nodes": "AFFE_CHAR_MECA(MODELE=MODEL, DDL_IMPO=_F(GROUP_MA='AXIS', DX=0.0))",
    "on a skin": "AFFE_CHAR_MECA(MODELE=MODEL, FACE_IMPO=_F(GROUP_MA='AXIS', DX=0.0))",
    "along the normal": "AFFE_CHAR_MECA(MODELE=MODEL, FACE_IMPO=_F(GROUP_MA='AXIS', DNOR=0.0))",
    "every displacement": "AFFE_CHAR_MECA(MODELE=MODEL, DDL_IMPO=_F(GROUP_MA='AXIS', LIAISON='ENCASTRE'))",
    "relations, node by node": "AFFE_CHAR_MECA(MODELE=MODEL, LIAISON_DDL=tuple(_F(NOEUD=name, DDL='DX', COEF_MULT=2.0, COEF_IMPO=0.0) for name in AXIS))",
    "one node, and the others as it": "AFFE_CHAR_MECA(MODELE=MODEL, DDL_IMPO=_F(NOEUD=AXIS[0], DX=0.0), LIAISON_UNIF=_F(GROUP_MA='AXIS', DDL='DX'))",
}


class Axis(StudyTest):
    def study(self, mesh, text, model="AXIS"):
        """What is said on the way of a study that ends well."""
        write_med(self.folder / "mesh.med", mesh)
        comm = self.folder / "study.comm"
        comm.write_text(HEAD.format(model=model) + text + "FIN()\n", encoding="utf-8")
        run = self.run_lacon(comm, "--fresh", "--unit", "20=mesh.med")
        self.assertEqual(run.status, 0, run.stdout[-3000:] + run.stderr[-3000:])
        return run.stderr

    @staticmethod
    def disc(first=0.0, name="DISC", sides=(("left", "AXIS"), ("bottom", "BASE"), ("top", "TOP")), cells=2):
        return block("QUAD4", np.linspace(first, first + 1, 3), np.linspace(0, 1, cells + 1), name=name, sides=dict(sides))

    def test_a_free_axis_is_told_with_its_body_and_group(self):
        said = self.study(self.disc(), SOLVE.format(n=1, excit="", more=""))
        self.assertIn("<I> <EVOLUTION_44> DISC touches the axis of revolution (X = 0), and nothing imposes the radial displacement DX at 3 node(s)", said)
        self.assertIn("DDL_IMPO=_F(GROUP_MA='AXIS', DX=0.0)", said)

    def test_nothing_is_said_where_anything_holds_it(self):
        mesh = self.disc()
        axis = tuple(f"N{i + 1}" for i in mesh.nodes_where(lambda x, _: x == 0))
        text = f"AXIS = {axis}\n" + "".join(f"H{n} = {load}\n" + SOLVE.format(n=n, excit=f"_F(CHARGE=H{n})", more="") for n, load in enumerate(HELD.values()))
        self.assertNotIn("EVOLUTION_44", self.study(mesh, text))

    def test_nothing_is_said_of_a_ring_or_a_plate(self):
        mesh = self.disc(first=1e-3)
        self.assertNotIn("EVOLUTION_44", self.study(mesh, SOLVE.format(n=1, excit="", more="")))
        hold = "H = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA='BASE', DX=0.0))\n"
        self.assertNotIn("EVOLUTION_44", self.study(self.disc(), hold + SOLVE.format(n=1, excit="_F(CHARGE=H)", more=""), "D_PLAN"))

    def test_relations_that_leave_it_free_do_not_hold_it(self):
        """All alike, or as much as something else that moves."""
        mesh = self.disc()
        edge = next(f"N{i + 1}" for i in mesh.nodes_where(lambda x, y: x == 1 and y == 1))
        axis = [f"N{i + 1}" for i in mesh.nodes_where(lambda x, _: x == 0)]
        for load in ("LIAISON_UNIF=_F(GROUP_MA='AXIS', DDL='DX')",
                     "LIAISON_DDL=(" + "".join(f"_F(NOEUD=('{a}', '{edge}'), DDL=('DX', 'DX'), COEF_MULT=(1.0, -0.1), COEF_IMPO=0.0), " for a in axis) + ")"):
            said = self.study(mesh, f"H = AFFE_CHAR_MECA(MODELE=MODEL, {load})\n" + SOLVE.format(n=1, excit="_F(CHARGE=H)", more=""))
            self.assertIn("DX at 3 node(s)", said)

    def test_each_body_is_told_by_what_it_lacks(self):
        """Of the lower one, whose axis is half held, the other nodes by name; the upper one has no group: many nodes are told how to find."""
        low = self.disc(name="LOW", sides=(("bottom", "BASE"), ("left", "AXIS")))
        up = self.disc(name="UP", sides=(("top", "TOP"),), cells=8)
        up.points[:, 1] += 1.0
        mesh = union([low, up])
        first = [f"N{i + 1}" for i in mesh.nodes_where(lambda x, y: x == 0 and y == 0)]
        hold = (f"H = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=(_F(NOEUD='{first[0]}', DX=0.0), _F(GROUP_MA='UP', DY=0.0)))\n")
        said = self.study(mesh, hold + SOLVE.format(n=1, excit="_F(CHARGE=H)", more=""))
        self.assertIn("LOW touches the axis of revolution (X = 0), and nothing imposes the radial displacement DX at 2 node(s)", said)
        self.assertIn("DDL_IMPO=_F(GROUP_MA='AXIS', DX=0.0)", said)
        self.assertIn("UP touches the axis of revolution (X = 0), and nothing imposes the radial displacement DX at 9 node(s)", said)
        self.assertIn("OPTION='PLAN', POINT=(0.0, 0.0), VECT_NORMALE=(1.0, 0.0)", said)

    def test_a_few_nodes_without_a_group_are_named(self):
        mesh = self.disc(sides=(("bottom", "BASE"), ("top", "TOP")))
        names = ", ".join(f"'N{i + 1}'" for i in sorted(mesh.nodes_where(lambda x, _: x == 0)))
        self.assertIn(f"DDL_IMPO=_F(NOEUD=({names}), DX=0.0)", self.study(mesh, SOLVE.format(n=1, excit="", more="")))

    def test_a_support_by_springs_holds_it(self):
        text = """
POINTS = CREA_MAILLAGE(MAILLAGE=MESH, CREA_POI1=_F(NOM_GROUP_MA='SPRINGS', GROUP_MA='AXIS'))
WITH = AFFE_MODELE(MAILLAGE=POINTS, AFFE=(_F(GROUP_MA=('DISC', 'BASE', 'TOP'), PHENOMENE='MECANIQUE', MODELISATION='AXIS'),
                                          _F(GROUP_MA='SPRINGS', PHENOMENE='MECANIQUE', MODELISATION='2D_DIS_T')))
MATTER = AFFE_MATERIAU(MAILLAGE=POINTS, AFFE=_F(TOUT='OUI', MATER=STEEL))
STIFF = AFFE_CARA_ELEM(MODELE=WITH, DISCRET_2D=_F(GROUP_MA='SPRINGS', CARA='K_T_D_N', VALE=(1e6, 0.0)))
FOOT = AFFE_CHAR_CINE(MODELE=WITH, MECA_IMPO=_F(GROUP_MA='BASE', DY=0.0))
R = STAT_NON_LINE(MODELE=WITH, CHAM_MATER=MATTER, CARA_ELEM=STIFF, EXCIT=_F(CHARGE=FOOT), INCREMENT=_F(LIST_INST=TIMES))
"""
        self.assertNotIn("EVOLUTION_44", self.study(self.disc(), text))


if __name__ == "__main__":
    unittest.main()
