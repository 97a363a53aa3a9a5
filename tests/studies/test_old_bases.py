"""Bases that earlier versions wrote open, or are refused by name. `old_bases/format_1` is of the first version that had a base as it is now: what
tests/fuzz/study.comm makes without its last command, with one instant."""

import pathlib
import shutil
import sys
import unittest

import h5py

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from study_test import StudyTest  # noqa: E402

#: every concept is read, by the launcher or by an operator: the upper square is pushed down by 0.01
READ = """
POURSUITE()
TEST_RESU(RESU=_F(RESULTAT=RESULT, NOM_CHAM="DEPL", NOM_CMP="DY", GROUP_MA="TOP", TYPE_TEST="MIN", INST=1.0, REFERENCE="ANALYTIQUE", VALE_CALC=-0.01, VALE_REFE=-0.01))
TEST_RESU(CHAM_NO=_F(CHAM_GD=MOVED, NOM_CMP="DY", GROUP_NO="CORNER", CRITERE="ABSOLU", REFERENCE="ANALYTIQUE", VALE_CALC=0.0, VALE_REFE=0.0))
assert DEEPER(1.0) == -0.01 and SURFACE(0.5, 0.5) == 1.0 and TIMES.getValues() == [0.0, 1.0]
assert len(LINE.EXTR_TABLE()) > 0
IMPR_RESU(FORMAT="RESULTAT", UNITE=8, RESU=_F(RESULTAT=RESULT))
RESULT = CALC_CHAMP(reuse=RESULT, RESULTAT=RESULT, CONTRAINTE="SIEF_NOEU")
AGAIN = STAT_NON_LINE(MODELE=MODEL, CHAM_MATER=MATTER, CONTACT=CONTACT, EXCIT=(_F(CHARGE=HOLD), _F(CHARGE=PUSH), _F(CHARGE=BLOW)),
                      COMPORTEMENT=_F(RELATION="VMIS_ISOT_TRAC"), INCREMENT=_F(LIST_INST=STEPS))
TEST_RESU(RESU=_F(RESULTAT=AGAIN, NOM_CHAM="DEPL", NOM_CMP="DY", GROUP_MA="TOP", TYPE_TEST="MIN", INST=1.0, REFERENCE="ANALYTIQUE", VALE_CALC=-0.01, VALE_REFE=-0.01))
FIN()
"""


class OldBases(StudyTest):
    def setUp(self):
        super().setUp()
        self.base = self.folder / "old.base"
        shutil.copytree(pathlib.Path(__file__).resolve().parent / "old_bases/format_1", self.base)

    def run_text(self, text):
        (self.folder / "old.comm").write_text(text, encoding="utf-8")
        return self.run_tool("old.comm", "--base", "old.base", "--unit", "8=old.txt")

    def test_format_1_is_read_and_gone_on_with(self):
        run = self.run_text(READ)
        self.assertEqual(run.returncode, 0, run.stdout[-3000:] + run.stderr)
        self.assertIn("instant 1.000000000000E+00", (self.folder / "old.txt").read_text())

    def test_a_format_that_is_not_known_is_refused_with_the_file(self):
        for name, text in (("mesh_2.h5", "AFFE_MODELE(MAILLAGE=CUT, AFFE=_F(TOUT='OUI', PHENOMENE='MECANIQUE', MODELISATION='D_PLAN'))"),
                           ("table_19.h5", "LINE.EXTR_TABLE()")):
            with self.subTest(name):
                with h5py.File(self.base / name, "a") as file:
                    file.attrs["format"] = 2
                run = self.run_text(f"POURSUITE()\n{text}\nFIN()\n")
                self.assertEqual(run.returncode, 2, run.stdout + run.stderr)
                self.assertRegex(run.stderr, rf"<F> <BASE_6> .*{name}' is of format 2")


if __name__ == "__main__":
    unittest.main()
