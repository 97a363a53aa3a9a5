"""A shoe that crosses the gap between two rails, the second of which is higher."""

import re
import unittest

import numpy as np
from study_test import StudyTest

from meshes import block, union, write_med

STUDY = """
DEBUT()
MESH = LIRE_MAILLAGE(UNITE=20, FORMAT="MED")
MESH = CREA_MAILLAGE(MAILLAGE=MESH, DECOUPE_LAC=_F(GROUP_MA_ESCL="SOLE"))
MODEL = AFFE_MODELE(MAILLAGE=MESH, AFFE=_F(TOUT="OUI", PHENOMENE="MECANIQUE", MODELISATION="D_PLAN"))
MATTER = AFFE_MATERIAU(MAILLAGE=MESH, AFFE=_F(TOUT="OUI", MATER=DEFI_MATERIAU(ELAS=_F(E=210e3, NU=0.3))))
CONTACT = DEFI_CONTACT(
    MODELE=MODEL,
    FORMULATION="CONTINUE",
    ALGO_RESO_GEOM="NEWTON",
    ALGO_RESO_CONT="NEWTON",
    ZONE=_F(GROUP_MA_ESCL="SOLE", GROUP_MA_MAIT="RAIL", ALGO_CONT="LAC"),
)
HELD = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA="BASE", DX=0.0, DY=0.0))
DRAWN = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA="TOP", DX=1.0))
PRESSED = AFFE_CHAR_MECA(MODELE=MODEL, PRES_REP=_F(GROUP_MA="TOP", PRES=50.0), LIAISON_UNIF=_F(GROUP_MA="TOP", DDL="DY"))
PLACE = DEFI_FONCTION(NOM_PARA="INST", VALE=(0.0, 0.0, 1.0, 4.0, 9.0, 8.0))
FORCE = DEFI_FONCTION(NOM_PARA="INST", VALE=(0.0, 0.0, 1.0, 1.0, 9.0, 1.0))
TIMES = DEFI_LIST_REEL(DEBUT=0.0, INTERVALLE=(_F(JUSQU_A=1.0, NOMBRE=1), _F(JUSQU_A=9.0, NOMBRE=128)))
RESULT = STAT_NON_LINE(
    MODELE=MODEL,
    CHAM_MATER=MATTER,
    CONTACT=CONTACT,
    EXCIT=(_F(CHARGE=HELD), _F(CHARGE=DRAWN, FONC_MULT=PLACE), _F(CHARGE=PRESSED, FONC_MULT=FORCE)),
    INCREMENT=_F(LIST_INST=DEFI_LIST_INST(DEFI_LIST=_F(LIST_INST=TIMES)), INST_FIN=5.0),
)
FIN()
"""


class Rails(StudyTest):
    def test_each_set_of_statuses_has_its_iterations(self):
        """A patch over the end of a rail presses and opens by turns. Behind the set that came back two or three of ITER_GLOB_MAXI were left, too few for
        the next set at any length of the step: the shoe stopped on the way, at the instant 4.797."""
        def lines(first, last, cells):
            return np.linspace(first, last, cells + 1)

        def sole(x, t):
            return (x - 8, 0.25 * max(abs(x) - 2, 0) ** 2 * (1 - t) + 2 * t)

        shoe = block("QUAD4", lines(-3, 3, 72), lines(0, 1, 3), sole, "SHOE", {"bottom": "SOLE", "top": "TOP"})
        rails = [block("QUAD4", lines(*ends, 100), lines(-2, height, 3), None, name, {"top": "RAIL", "bottom": "BASE"})
                 for name, ends, height in (("R1", (-16, -0.15), 0), ("R2", (0.15, 16), 0.05))]
        write_med(self.folder / "mesh.med", union([shoe, *rails]))
        study = self.folder / "study.comm"
        study.write_text(STUDY, encoding="utf-8")
        run = self.run_lacon(study, "--unit", "20=mesh.med", "--fresh")
        self.assertEqual(run.status, 0, run.stdout[-2000:] + run.stderr)
        iterations = [int(count) for count in re.findall(r"Converged at the instant \S+ with (\d+) iteration", run.stdout)]
        self.assertGreater(max(iterations), 10)
        self.assertLessEqual(max(iterations), 30)


if __name__ == "__main__":
    unittest.main()
