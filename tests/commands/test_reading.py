"""LIRE_TABLE and LIRE_FONCTION: what IMPR_TABLE and IMPR_FONCTION wrote comes back; other columns; what is wrong is told with its line."""

import sys
import unittest

sys.path.insert(0, __file__.rpartition("/")[0] or ".")
from support import LauncherTest  # noqa: E402

MADE = """
DEBUT()
T = CREA_TABLE(TITRE=('one', 'two'), LISTE=(_F(PARA='N', LISTE_I=(1, 2, 3)), _F(PARA='X', LISTE_R=(0.1, -2.5e-300, 3.), NUME_LIGN=(1, 2, 4)),
                                            _F(PARA='S', LISTE_K=('A', 'BEE', 'C'))))
F = DEFI_FONCTION(NOM_PARA='INST', NOM_RESU='U', VALE=(0, 1.5, 2, -2.25e-7))
"""


class Reading(LauncherTest):
    def read(self, text, python, **files):
        for name, content in files.items():
            self.write(name, content)
        units = [word for i, name in enumerate(files, 51) for word in ("--unit", f"{i}={name}")]
        return self.run_study(f"DEBUT()\n{text}\n{python}\nFIN()\n", *units)

    def test_tables_that_were_printed_come_back(self):
        self.ok(self.run_study(MADE + """
IMPR_TABLE(TABLE=T, UNITE=61, FORMAT='ASTER')
IMPR_TABLE(TABLE=T, UNITE=61, FORMAT='ASTER', TITRE='again')
IMPR_TABLE(TABLE=T, UNITE=62, FORMAT='TABLEAU', FORMAT_R='E24.17')
IMPR_TABLE(TABLE=T, UNITE=63, FORMAT='TABLEAU', SEPARATEUR=';', DEBUT_LIGNE='')
first = LIRE_TABLE(UNITE=61).EXTR_TABLE()
t = T.EXTR_TABLE()
assert first.para == t.para and first.titr == 'one\\ntwo', first.titr
assert first.type[:2] == ['I', 'R'] and first.type[2][0] == 'K'
assert first.values()['N'] == [1, 2, 3, None] and first.values()['S'] == ['A', 'BEE', 'C', None]
assert all(a == b or abs(a - b) <= 1e-11 * abs(b) for a, b in zip(first.values()['X'], t.values()['X'])), first.values()
assert LIRE_TABLE(UNITE=61, NUME_TABLE=2).EXTR_TABLE().titr == 'again'
assert LIRE_TABLE(UNITE=61, TITRE='mine').EXTR_TABLE().titr == 'mine'
free = LIRE_TABLE(UNITE=62, FORMAT='LIBRE').EXTR_TABLE()
assert free.values() == t.values() and free.type[:2] == ['I', 'R'], free
FIN()
"""))

    def test_columns_of_any_kind(self):
        self.ok(self.read("""
t = LIRE_TABLE(UNITE=51, FORMAT='LIBRE', SEPARATEUR=',', RENOMME_PARA='UNIQUE', NUME_TABLE=2).EXTR_TABLE()
""", "assert t.para == ['A', 'B', 'A_1'] and t.values() == {'A': [1, 2], 'B': [1.5, -100.0], 'A_1': ['x', None]} and t.type == ['I', 'R', 'K8'], t",
                          csv="# a comment\nQ\n1\n\n\nA , B, A\n1, 1.5, x\n# between\n2,-1.0D+02,-\n"))

    def test_a_function_of_two_parameters(self):
        """Parameters, abscissae and the values of each function are columns; between them it interpolates as DEFI_NAPPE's."""
        self.ok(self.read("""
S = LIRE_FONCTION(UNITE=51, TYPE='NAPPE', NOM_PARA='TEMP', NOM_PARA_FONC='EPSI', INDIC_PARA=(1, 1), INDIC_ABSCISSE=(2, 1), PROL_DROITE='CONSTANT',
                  DEFI_FONCTION=(_F(INDIC_RESU=(2, 2), PROL_DROITE='CONSTANT'), _F(INDIC_RESU=(2, 3), PROL_DROITE='LINEAIRE')))
""", """
assert S.getVariables() == ['TEMP', 'EPSI'] and S.Absc() == [[0, 1, 2]] * 2 and S.Ordo()[1] == [0, 7, 9]
assert abs(S(15, 0.5) - (2.5 + 3.5) / 2) < 1e-14 and abs(S(30, 3) - 11) < 1e-14
""", txt="10.\n20.\n\n0 0 0\n1 5 7\n2 6 9\n"))

    def test_arrays_of_numpy(self):
        self.ok(self.read("""
import numpy
numpy.save('points.npy', numpy.array([[0., 5., 1.], [1., 6., 3.]]))
number = DEFI_FICHIER(FICHIER='points.npy', TYPE='BINARY', ACCES='OLD')
F = LIRE_FONCTION(UNITE=number, FORMAT='NUMPY', NOM_PARA='INST')
G = LIRE_FONCTION(UNITE=number, FORMAT='NUMPY', NOM_PARA='INST', INDIC_RESU=(1, 3))
""", "assert F.Valeurs() == [[0, 1], [5, 6]] and G.Ordo() == [1, 3]"))
        self.refused(self.read("LIRE_FONCTION(UNITE=51, FORMAT='NUMPY', NOM_PARA='INST')", "", npy="0 1\n"), "FUNCTION_20", "numpy.save")
        self.refused(self.read("""
import numpy
numpy.save('points.npy', numpy.array([[0., 1.], [1., numpy.nan]]))
LIRE_FONCTION(UNITE=DEFI_FICHIER(FICHIER='points.npy', TYPE='BINARY', ACCES='OLD'), FORMAT='NUMPY', NOM_PARA='INST')
""", ""), "FUNCTION_20", "not finite")

    def told(self, calls, files):
        """Run commands that are all refused, and compare what is said: [(command, identifier, words)]"""
        lines = "".join(f"try:\n    x = {command}\nexcept AsterError as error:\n    said.append(str(error))\n" for command, _, _ in calls)
        run = self.read("from code_aster.Utilities import *\nsaid = []\n" + lines + "print('SAID', repr(said))", "", **files)
        self.ok(run)
        said = eval(next(line for line in run.out.splitlines() if line.startswith("SAID"))[5:])
        self.assertEqual(len(said), len(calls))
        for text, (command, identifier, word) in zip(said, calls):
            self.assertIn(f"<{identifier}>", text, command)
            self.assertIn(word, text)

    def test_what_is_wrong_with_a_table_is_told_with_its_line(self):
        cases = (("#DEBUT_TABLE\nA B\nI R\n1 2.0\n", "", "TABLE_14", "line 4: the file ends before #FIN_TABLE"),
                 ("#DEBUT_TABLE\nA B\nI Q\n1 2.0\n#FIN_TABLE\n", "", "TABLE_14", "line 3: 'Q' is no type"),
                 ("#DEBUT_TABLE\nA B\nI R\n1\n#FIN_TABLE\n", "", "TABLE_14", "line 4: 1 cells for 2 columns"),
                 ("#DEBUT_TABLE\nA\nI\n1.5\n#FIN_TABLE\n", "", "TABLE_14", "line 4: '1.5' is no integer"),
                 ("#DEBUT_TABLE\nA A\nI I\n1 2\n#FIN_TABLE\n", "", "TABLE_7", "'A'"),
                 ("A\n1\n", "", "TABLE_15", "0 tables"), ("A\n1\n", ", FORMAT='LIBRE', NUME_TABLE=2", "TABLE_15", "1 tables"))
        self.told([(f"LIRE_TABLE(UNITE={51 + i}{keywords})", identifier, word) for i, (_, keywords, identifier, word) in enumerate(cases)],
                  {f"data{i}": text for i, (text, *_) in enumerate(cases)})

    def test_functions(self):
        self.ok(self.run_study(MADE + """
IMPR_FONCTION(COURBE=_F(FONCTION=F), UNITE=61, FORMAT='TABLEAU', FORMAT_R='E24.17')
f = LIRE_FONCTION(UNITE=61, NOM_PARA='INST')
assert f.Valeurs() == F.Valeurs(), f.Valeurs()
IMPR_FONCTION(COURBE=_F(FONCTION=F), UNITE=62, FORMAT='TABLEAU', SEPARATEUR=';', FORMAT_R='E24.17')
assert LIRE_TABLE(UNITE=62, SEPARATEUR=';', FORMAT='LIBRE').EXTR_TABLE().para == ['INST', 'F']
f = LIRE_FONCTION(UNITE=62, NOM_PARA='INST', SEPAR=';', INDIC_PARA=(1, 1), INDIC_RESU=(1, 2))
assert f.Valeurs() == F.Valeurs(), f.Valeurs()
FIN()
"""))
        data = "time force\n0, 1\n1, 2\n\n2, 9, -3D-1, 5\n1, 8, 4, 4\nend\n"
        self.ok(self.read("""
f = LIRE_FONCTION(UNITE=51, SEPAR=',', NOM_PARA='X', NOM_RESU='DX', INDIC_PARA=(2, 1), INDIC_RESU=(2, 3), VERIF='NON', PROL_DROITE='CONSTANT')
g = LIRE_FONCTION(UNITE=51, SEPAR=',', NOM_PARA='INST', INTERPOL='LIN')
""", "assert f.Valeurs() == [[1, 2], [4, -0.3]] and f(3) == -0.3 and g(0.5) == 1.5 and g.points().parameter == 'INST'", data=data))
        self.told([(f"LIRE_FONCTION(UNITE=51, SEPAR=',', NOM_PARA='X', {keywords})", identifier, word) for keywords, identifier, word in (
            ("INDIC_PARA=(3, 1)", "FUNCTION_16", "block 2: 4 columns, 2 lines"), ("INDIC_RESU=(1, 3)", "FUNCTION_16", "column 3"),
            ("INDIC_PARA=(2, 1), INDIC_RESU=(2, 2)", "DEFI_FONCTION_1", "2"))], {"data": data})

    def test_a_mark_of_the_byte_order_is_no_part_of_a_file(self):
        self.ok(self.read("f = LIRE_FONCTION(UNITE=51, NOM_PARA='INST')\nt = LIRE_TABLE(UNITE=52, FORMAT='LIBRE').EXTR_TABLE()",
                          "assert f.Valeurs() == [[0, 0.5], [3, 5]] and t.values() == {'A': [1]}", txt="\ufeff0 3\n0.5 5\n", csv="\ufeffA\n1\n"))

    def test_lines_that_are_no_row_of_numbers_lose_nothing(self):
        cases = (("0 0 ! start\n1 2\n", "line 1: '!' is no number"), ("0 0\n1 nan\n", "line 2: 'nan' is no number"), ("0 0\n1 1e999\n", "line 2: '1e999' is no"),
                 ("x\n0 0\n-inf 1\n", "line 3: '-inf' is no number"), ("0 0\n1 2 3\n", "line 2: 3 cells for 2 columns"), ("0 0\n1\n", "line 2: 1 cells for 2"))
        self.told([(f"LIRE_FONCTION(UNITE={51 + i}, NOM_PARA='INST')", "FUNCTION_24", word) for i, (_, word) in enumerate(cases)],
                  {f"data{i}": text for i, (text, _) in enumerate(cases)})

    def test_values_that_are_not_finite_are_no_function(self):
        tables = {f"data{i}": f"X Y\n0 1\n{row}\n" for i, row in enumerate(("1 nan", "inf 1"))}
        self.told([(f"RECU_FONCTION(TABLE=LIRE_TABLE(UNITE={unit}, FORMAT='LIBRE'), PARA_X='X', PARA_Y='Y')", "FUNCTION_25", f"point 2 is to be ({point})")
                   for unit, point in ((51, "1, nan"), (52, "inf, 1"))], tables)


if __name__ == "__main__":
    unittest.main()
