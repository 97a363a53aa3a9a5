"""The same physics in other units, and with stiffnesses as far apart as steel and gas: the same numbers."""

import sys
import unittest

sys.path.insert(0, __file__.rpartition("/")[0] or ".")
from faults.small_study import STUDY, SmallStudy  # noqa: E402

TOLERANCE = 1e-8


class Units(SmallStudy):
    def pressure(self, length=1.0, stiffness=1.0, upper=1.0):
        """LAGS_C of the one patch over the stiffness. @param length, stiffness in other units @param upper stiffness of the upper body alone"""
        text = STUDY.partition("RESULT = CALC_CHAMP")[0]
        for old, new in (
                ('"CBOT")))\n', f'"CBOT")))\nMESH = MODI_MAILLAGE(reuse=MESH, MAILLAGE=MESH, ECHELLE={length!r})\n'),
                ("DZ=-0.01", f"DZ={-0.01 * length!r}"), ("E=2000.0", f"E={2000.0 * stiffness!r}"),
                ("MATTER = ", f"UPPER = DEFI_MATERIAU(ELAS=_F(E={2000.0 * stiffness * upper!r}, NU=0.3))\nMATTER = "),
                ('AFFE=_F(TOUT="OUI", MATER=STEEL)', 'AFFE=(_F(TOUT="OUI", MATER=STEEL), _F(GROUP_MA="VTOP", MATER=UPPER))')):
            self.assertIn(old, text)
            text = text.replace(old, new, 1)
        text += "TEST_RESU(RESU=_F(RESULTAT=RESULT, NUME_ORDRE=3, NOM_CHAM='DEPL', NOM_CMP='LAGS_C', TYPE_TEST='MIN', VALE_CALC=1.0))\nFIN()\n"
        (self.folder / "study.comm").write_text(text, encoding="utf-8")
        run = self.run_lacon("study.comm", "--base", "small.base", "--unit", "20=blocks.med")
        self.assertEqual(run.status, 5, run.stdout[-2000:] + run.stderr)  # the check is there for its value
        return run.checks[0]["value"] / stiffness

    def test_lengths_and_stiffnesses_in_other_units(self):
        expected = self.pressure()
        self.assertLess(expected, -1.0)
        for length, stiffness in ((1e-9, 1e11), (1e-3, 1e-9), (1e3, 1e6), (1e6, 1e-6)):
            with self.subTest(length=length, stiffness=stiffness):
                self.assertLessEqual(abs(self.pressure(length, stiffness) - expected), TOLERANCE * abs(expected))

    def test_twelve_decades_between_the_bodies(self):
        """Whichever of the two is stiff, its strains are to those of the other as their stiffnesses: 1e-9 is as good as rigid, to 1e-9."""
        for stiff in (1, -1):
            with self.subTest(stiff="slave" if stiff == 1 else "master"):
                nearly, rigid, elsewhere = (self.pressure(stiffness=unit, upper=10.0 ** (stiff * decades)) / min(1.0, 10.0 ** (stiff * decades))
                                            for decades, unit in ((9, 1.0), (12, 1.0), (12, 1e6)))
                self.assertLess(rigid, -1.0)
                self.assertLessEqual(abs(nearly - rigid), 10e-9 * abs(rigid))
                self.assertLessEqual(abs(elsewhere - rigid), TOLERANCE * abs(rigid))


if __name__ == "__main__":
    unittest.main()
