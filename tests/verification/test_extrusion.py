"""Extrusion through a smooth die, in plane strain and without friction, between the bounds of limit analysis."""

import unittest

import numpy as np

from load_study import StudyTest
from meshes import block, union, write_med  # noqa: I001 (load_study says where it is)
from results import Result

ENTRY, EXIT, LENGTH, STROKE, YIELD, SLOPE = 1.0, 0.85, 1.0, 1.8, 200.0, 20.0  # half heights; SLOPE: D_SIGM_EPSI


def height(x):
    """The die: a cosine from the half height of the billet to that of what leaves it, over LENGTH."""
    return ENTRY - (ENTRY - EXIT) * (0.5 - 0.5 * np.cos(np.pi * np.clip(x / LENGTH, 0, 1)))


def bounds():
    """Of the force on half a billet of a rigid plastic material without hardening: no flow does with less than the work of a pure stretch;
    and none takes more than that of v_x = 1 / h, v_y = y h' / h^2, which keeps the volume and follows the die (upper bound theorem)."""
    x, s = np.linspace(0, LENGTH, 2001), np.linspace(0, 1, 401)
    h = height(x)
    phase = np.pi * x / LENGTH
    slope = -(ENTRY - EXIT) * 0.5 * np.pi / LENGTH * np.sin(phase)
    bend = -(ENTRY - EXIT) * 0.5 * (np.pi / LENGTH) ** 2 * np.cos(phase)
    along = ENTRY * slope / h**2
    shear = 0.5 * np.outer(h, s) * (ENTRY * (bend / h**2 - 2 * slope**2 / h**3))[:, None]
    rate = np.sqrt(along[:, None] ** 2 + shear**2)
    flow = 2 / np.sqrt(3) * YIELD
    across = (rate[:, 1:] + rate[:, :-1]).sum(axis=1) / 2 * (s[1] - s[0]) * h
    return flow * ENTRY * np.log(ENTRY / EXIT), flow * (across[1:] + across[:-1]).sum() / 2 * (x[1] - x[0])


STUDY = f"""
DEBUT()
WHOLE = LIRE_MAILLAGE(UNITE=20)
MESH = CREA_MAILLAGE(MAILLAGE=WHOLE, DECOUPE_LAC=_F(GROUP_MA_ESCL='SLAVE'))
MODEL = AFFE_MODELE(MAILLAGE=MESH, AFFE=_F(TOUT='OUI', PHENOMENE='MECANIQUE', MODELISATION='D_PLAN_SI'))
STEEL = DEFI_MATERIAU(ELAS=_F(E=200e3, NU=0.3))
METAL = DEFI_MATERIAU(ELAS=_F(E=70e3, NU=0.3), ECRO_LINE=_F(SY={YIELD}, D_SIGM_EPSI={SLOPE}))
FIELD = AFFE_MATERIAU(MAILLAGE=MESH, AFFE=(_F(GROUP_MA='DIE', MATER=STEEL), _F(GROUP_MA='BILLET', MATER=METAL)))
CONTACT = DEFI_CONTACT(MODELE=MODEL, FORMULATION='CONTINUE', ALGO_RESO_GEOM='NEWTON', ALGO_RESO_CONT='NEWTON',
                       ZONE=_F(GROUP_MA_ESCL='SLAVE', GROUP_MA_MAIT='MASTER', ALGO_CONT='LAC', CONTACT_INIT='INTERPENETRE'))
HOLD = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=(_F(GROUP_MA='DIE', DX=0, DY=0), _F(GROUP_MA='MIDDLE', DY=0)))
PUSH = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA='RAM', DX={STROKE}))
RAMP = DEFI_FONCTION(NOM_PARA='INST', VALE=(0, 0, 1, 1))
LIST = DEFI_LIST_INST(DEFI_LIST=_F(LIST_INST=DEFI_LIST_REEL(DEBUT=0, INTERVALLE=_F(JUSQU_A=1, NOMBRE=60))),
                      ECHEC=_F(ACTION='DECOUPE', SUBD_PAS=2, SUBD_NIVEAU=5))
R = STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=FIELD, CONTACT=CONTACT, EXCIT=(_F(CHARGE=HOLD), _F(CHARGE=PUSH, FONC_MULT=RAMP)),
                  COMPORTEMENT=(_F(GROUP_MA='BILLET', RELATION='VMIS_ISOT_LINE', DEFORMATION='GDEF_LOG'), _F(GROUP_MA='DIE', RELATION='ELAS')),
                  INCREMENT=_F(LIST_INST=LIST), CONVERGENCE=_F(RESI_REFE_RELA=1e-4, SIGM_REFE={YIELD}, ITER_GLOB_MAXI=25))
R = CALC_CHAMP(reuse=R, RESULTAT=R, FORCE='FORC_NODA')
FIN()
"""


class Extrusion(StudyTest):
    def forces(self):
        """(way of the ram, force on it) of each instant."""
        billet = block("QUAD8", np.linspace(-2.4, 0, 25), np.linspace(0, ENTRY, 6), None, "BILLET", {"bottom": "MIDDLE", "left": "RAM", "top": "SLAVE"})
        x = np.concatenate([np.linspace(-2.6, -0.2, 5), np.linspace(0, LENGTH, 13), np.linspace(LENGTH + 0.4, 2.2, 4)])
        die = block("QUAD8", (x - x[0]) / np.ptp(x), np.linspace(0, 1, 3),
                    lambda s, t: (x[0] + s * np.ptp(x), (1 - t) * height(x[0] + s * np.ptp(x)) + 1.5 * t), "DIE", {"bottom": "MASTER"})
        write_med(self.folder / "mesh.med", union([billet, die]))
        (self.folder / "extrusion.comm").write_text(STUDY, encoding="utf-8")
        run = self.run_study(self.folder / "extrusion.comm", "--fresh", "--unit", f"20={self.folder / 'mesh.med'}")
        self.assertEqual(run.status, 0, run.stdout[-3000:] + run.stderr[-3000:])
        result = Result(self.folder / "extrusion.base", "R")
        ram = np.abs(result.points[:, 0] + 2.4) < 1e-9
        return [(result.at_nodes("DEPL", order, "DX")[ram].max(), result.at_nodes("FORC_NODA", order, "DX")[ram].sum()) for order in result.orders]

    def test_the_force_of_steady_flow_lies_between_the_bounds(self):
        """Steady from where the front has left the die; strains of 0.3 at most harden by SLOPE / YIELD of it."""
        lower, upper = bounds()
        steady = [force for way, force in self.forces() if way > 1.35]
        print(f"force {min(steady):.2f} to {max(steady):.2f} between {lower:.2f} and {upper:.2f}")
        self.assertLess(max(steady) - min(steady), 0.02 * max(steady))
        self.assertGreater(min(steady), lower)
        self.assertLess(max(steady), (1 + 0.3 * SLOPE / YIELD) * upper)


if __name__ == "__main__":
    unittest.main()
