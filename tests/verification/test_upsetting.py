"""Upsetting between rough platens that stick: the limit load against bounds that are theorems of limit analysis, and against Hill's figure.

A load is a mean pressure over the flow stress: in plane strain over 2 k = 2 Y / sqrt(3), of a cylinder over Y. Sources: Prandtl (1923), Hill (The
Mathematical Theory of Plasticity, 1950: 3 / 4 + w / (4 h) where w > h), Avitzur (Metal Forming, 1968: 1 + 2 m R / (3 sqrt(3) h), here m = 1).
"""

import unittest

import numpy as np

from load_study import LoadTest
from meshes import block  # noqa: I001 (load_study says where it is)
from results import Result

YIELD, YOUNG, POISSON = 20.0, 200e3, 0.3  # limit loads come at strains of a thousandth: the shape is still the first one
#: cells over half the height, of the two meshes
MESHES = (4, 8)
#: name -> (modelisation, width over height, or diameter over height)
BILLETS = {"a square prism": ("D_PLAN_SI", 1.0), "a wide prism": ("D_PLAN_SI", 4.0), "a cylinder": ("AXIS_SI", 1.0), "a flat cylinder": ("AXIS_SI", 4.0)}
LAWS = ("GDEF_LOG", "SIMO_MIEHE")


def bounds(modelisation, ratio):
    """Lower bound: one stress everywhere, which is no more than the flow stress. Upper bound: the work of a flow. Flows: v_x, or v_r, is the
    same over the height and glides on platens whose friction is k (Avitzur 1968 for the cylinder); in plane strain also four rigid
    wedges that glide on the diagonals, (w / h + h / w) / 2."""
    if modelisation == "AXIS_SI":
        return 1.0, 1 + 2 * (ratio / 2) / (3 * np.sqrt(3))
    return 1.0, min(1 + ratio / 4, (ratio + 1 / ratio) / 2)


class Sticking(LoadTest):
    def loads(self, modelisation, ratio, meshes=MESHES, laws=LAWS, pushes=(2e-4, 4e-4, 7e-4, 1e-3)):
        """law -> loads of the meshes, at the end of the push"""
        meshes = [block("QUAD8", np.linspace(0, ratio / 2, round(n * ratio) + 1), np.linspace(0, 0.5, n + 1), None, "BILLET",
                        {"bottom": "MIDDLE", "left": "AXLE", "top": "PLATEN"}) for n in meshes]
        text = f"""
METAL = DEFI_MATERIAU(ELAS=_F(E={YOUNG}, NU={POISSON}), ECRO_LINE=_F(SY={YIELD}, D_SIGM_EPSI=0.0))
REALS = DEFI_LIST_REEL(VALE={[0.0, *pushes]})
LIST = DEFI_LIST_INST(DEFI_LIST=_F(LIST_INST=REALS), ECHEC=_F(ACTION='DECOUPE'))
for unit in {tuple(20 + k for k in range(len(meshes)))}:
    model(unit, '{modelisation}', METAL)
    HOLD = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=(_F(GROUP_MA='AXLE', DX=0), _F(GROUP_MA='MIDDLE', DY=0)))
    PUSH = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA='PLATEN', DX=0, DY=-0.5))
    for law in {laws}:
        R.append(STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=FIELD, EXCIT=(_F(CHARGE=HOLD), _F(CHARGE=PUSH, FONC_MULT=RAMP)), INCREMENT=_F(LIST_INST=LIST),
                               COMPORTEMENT=_F(RELATION='VMIS_ISOT_LINE', DEFORMATION=law), CONVERGENCE=_F(RESI_GLOB_RELA=1e-6, ITER_GLOB_MAXI=30)))
        R[-1] = CALC_CHAMP(reuse=R[-1], RESULTAT=R[-1], FORCE='FORC_NODA')
"""
        run = self.run_text(meshes, text)
        self.assertEqual(run.status, 0, run.stdout[-3000:] + run.stderr[-3000:])
        flow = YIELD * (1.0 if modelisation == "AXIS_SI" else 2 / np.sqrt(3))
        area = (ratio / 2) ** 2 / 2 if modelisation == "AXIS_SI" else ratio / 2  # of one radian; of a half
        found = {law: [] for law in laws}
        for k in range(len(meshes) * len(laws)):
            result = Result(self.folder / "loads.base", f"R[{k}]")
            top = np.abs(result.points[:, 1] - 0.5) < 1e-9
            found[laws[k % len(laws)]].append([-result.at_nodes("FORC_NODA", order, "DY")[top].sum() / area / flow for order in result.orders[1:]])
        return found



    def figures(self, name):
        """law -> load of each mesh at the end of the push; lower bound, upper bound"""
        modelisation, ratio = BILLETS[name]
        return {law: [pushed[-1] for pushed in rows] for law, rows in self.loads(modelisation, ratio).items()}, bounds(modelisation, ratio)

    def assert_between(self, found, lower, upper):
        """And from above: what moves by shape functions alone finds no flow that does with less; bodies keep 0.1 % of the push."""
        for law, (coarse, fine) in found.items():
            self.assertGreater(fine, lower, law)
            self.assertLess(fine, coarse, law)
            self.assertLess(coarse, upper, law)
        self.assertLess(max(abs(a - b) for a, b in zip(*found.values())), 1e-3)  # strains of a thousandth: laws agree to that


class Bounds(Sticking):
    def test_a_square_prism_yields_at_the_load_where_both_bounds_meet(self):
        """1: found from above, the finer the mesh the nearer."""
        found, (lower, upper) = self.figures("a square prism")
        self.assertEqual((lower, upper), (1, 1))
        for law, (coarse, fine) in found.items():
            self.assertGreater(fine, 1, law)
            self.assertLess(fine - 1, 0.5 * (coarse - 1), law)  # of the first order at least: fields jump over the diagonals
            self.assertLess(fine - 1, 0.015, law)

    def test_a_cylinder_yields_between_the_bounds(self):
        found, theorems = self.figures("a cylinder")
        self.assert_between(found, *theorems)


class LongBounds(Sticking):
    def test_a_wide_prism_yields_between_the_bounds_and_near_hills_figure(self):
        found, theorems = self.figures("a wide prism")
        self.assert_between(found, *theorems)
        hill = 0.75 + BILLETS["a wide prism"][1] / 4
        for law, (coarse, fine) in found.items():
            self.assertLess(abs(fine - hill), abs(coarse - hill), law)
            self.assertLess(abs(fine / hill - 1), 0.03, law)  # the figure is Hill's approximation; the coarse mesh is 4 % above it

    def test_a_flat_cylinder_yields_between_the_bounds(self):
        found, theorems = self.figures("a flat cylinder")
        self.assert_between(found, *theorems)

    def test_a_tenth_of_the_height_later_the_load_is_between_the_bounds_of_the_new_shape(self):
        found, (lower, upper) = self.at_a_tenth()
        for law, load in found.items():
            self.assertGreater(load, lower, law)
            self.assertLess(load, upper, law)

    def at_a_tenth(self):
        """Of the wide prism, coarse mesh, over the platens' first width: law -> load; bounds. Below: the column under the platens is in one
        stress, what bulges out in none. Above: the flow of bounds(), whatever bulges out: h / h' + w / (4 h')."""
        modelisation, ratio = BILLETS["a wide prism"]
        found = self.loads(modelisation, ratio, MESHES[:1], LAWS, (1e-3, *(round(0.01 * k, 3) for k in range(1, 11))))
        return {law: rows[0][-1] for law, rows in found.items()}, (1.0, (1 + ratio / 4) / 0.9)


if __name__ == "__main__":
    unittest.main()
