"""A study of two blocks, three instants and every kind of output, that takes a second."""

import numpy as np
from study_test import StudyTest

from meshes import brick, union, write_med

STUDY = """
DEBUT()
MESH = LIRE_MAILLAGE(UNITE=20)
MESH = MODI_MAILLAGE(reuse=MESH, MAILLAGE=MESH, ORIE_PEAU=_F(GROUP_MA_PEAU=("CTOP", "CBOT")))
CUT = CREA_MAILLAGE(MAILLAGE=MESH, DECOUPE_LAC=_F(GROUP_MA_ESCL="CTOP"))
MODEL = AFFE_MODELE(MAILLAGE=CUT, AFFE=_F(TOUT="OUI", PHENOMENE="MECANIQUE", MODELISATION="3D"))
STEEL = DEFI_MATERIAU(ELAS=_F(E=2000.0, NU=0.3))
MATTER = AFFE_MATERIAU(MAILLAGE=CUT, AFFE=_F(TOUT="OUI", MATER=STEEL))
CONTACT = DEFI_CONTACT(MODELE=MODEL, FORMULATION="CONTINUE", ALGO_RESO_GEOM="NEWTON", ALGO_RESO_CONT="NEWTON",
                       ZONE=_F(APPARIEMENT="MORTAR", ALGO_CONT="LAC", GROUP_MA_MAIT="CBOT", GROUP_MA_ESCL="CTOP"))
HOLD = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=(_F(GROUP_MA=("BASE", "TOP"), DX=0.0, DY=0.0), _F(GROUP_MA="BASE", DZ=0.0)))
PUSH = AFFE_CHAR_CINE(MODELE=MODEL, MECA_IMPO=_F(GROUP_MA="TOP", DZ=-0.01))
GROW = DEFI_FONCTION(NOM_PARA="INST", VALE=(0.0, 0.0, 1.0, 1.0))
TIMES = DEFI_LIST_REEL(DEBUT=0.0, INTERVALLE=_F(JUSQU_A=1.0, NOMBRE=3))
RESULT = STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=MATTER, CONTACT=CONTACT, EXCIT=(_F(CHARGE=HOLD), _F(CHARGE=PUSH, FONC_MULT=GROW)),
                       COMPORTEMENT=_F(RELATION="ELAS"), INCREMENT=_F(LIST_INST=TIMES))
RESULT = CALC_CHAMP(reuse=RESULT, RESULTAT=RESULT, CONTRAINTE="SIGM_NOEU")
IMPR_RESU(FORMAT="MED", UNITE=80, RESU=_F(RESULTAT=RESULT))
IMPR_RESU(FORMAT="VTU", UNITE=81, RESU=_F(RESULTAT=RESULT))
IMPR_RESU(FORMAT="RESULTAT", UNITE=8, RESU=_F(RESULTAT=RESULT))
FIN()
"""


def two_blocks():
    def lines(n, z):
        return [np.linspace(0.0, 1.0, n + 1), np.array([0.0, 0.5]), np.array([z, z + 0.5, z + 1.0])]

    return union([brick("HEXA8", lines(3, 0.0), name="VBOT", sides={(2, 0): "BASE", (2, 1): "CBOT"}),
                  brick("HEXA8", lines(2, 1.0), name="VTOP", sides={(2, 0): "CTOP", (2, 1): "TOP"})])


class SmallStudy(StudyTest):
    """A test whose folder holds the study."""

    def setUp(self):
        super().setUp()
        write_med(self.folder / "blocks.med", two_blocks())
        (self.folder / "study.comm").write_text(STUDY, encoding="utf-8")

    def run_small(self, name, *more, **environment):
        """Run the study, whose base and outputs begin with `name`. @return the process"""
        units = ((20, "blocks.med"), (80, f"{name}.rmed"), (81, f"{name}.vtu"), (8, f"{name}.txt"))
        return self.run_tool("study.comm", "--base", f"{name}.base", *(word for unit, file in units for word in ("--unit", f"{unit}={file}")),
                             *more, **environment)
