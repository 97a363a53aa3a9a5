"""Tables: what the Python class does, how they are stored, and the commands that make, print and check them."""

import io
import json
import sys
import unittest

import h5py

sys.path.insert(0, __file__.rpartition("/")[0] or ".")
from support import STUDY, LauncherTest  # noqa: E402

from lacon.tables.printing import columns, number_format  # noqa: E402
from lacon.tables.storage import read_table, write_table  # noqa: E402
from lacon.tables.table import Table, crossed, type_of  # noqa: E402


def sample():
    return Table.of_columns({"N": ("I", [1, 2, 3, 4]), "X": ("R", [0.5, None, -2.0, 0.5]), "S": ("K8", ["A", "B", "A", None])}, "sample")


class Class(unittest.TestCase):
    def test_shape(self):
        table = sample()
        self.assertEqual(len(table), 4)
        self.assertEqual(table.para, ["N", "X", "S"])
        self.assertEqual(table.type, ["I", "R", "K8"])
        self.assertEqual(table.values()["X"], [0.5, None, -2.0, 0.5])
        self.assertEqual([row.get("S") for row in table], ["A", "B", "A", None])

    def test_cells_are_counted_from_one(self):
        table = sample()
        self.assertEqual((table["X", 1], table["X", 2], table["N", 4]), (0.5, None, 4))
        for number in (0, 5, -1):
            with self.assertRaises(IndexError):
                table["X", number]
        with self.assertRaisesRegex(KeyError, "no column Y"):
            table["Y", 1]

    def test_comparisons(self):
        table = sample()
        for found, rows in ((table.X == 0.5, [1, 4]), (table.X != 0.5, [3]), (table.X > 0, [1, 4]), (table.N <= 2, [1, 2]),
                            (table.S == "A", [1, 3]), (table.S == ["A", "B"], [1, 2, 3]), (table.X.VIDE(), [2]),
                            (table.X.NON_VIDE(), [1, 3, 4]), (table.X.MAXI(), [1, 4]), (table.X.MINI(), [3]),
                            (table.X.MAXI_ABS(), [3]), (table.X.MINI_ABS(), [1, 4]), (table.S.REGEXP("^B"), [2]),
                            ((table.X == 0.5) & (table.S == "A"), [1]), ((table.X < 0) | (table.N == 2), [3, 2])):
            self.assertEqual(found["N"].values(), rows)
            self.assertEqual(found.para, table.para)

    def test_sorting_puts_missing_cells_last(self):
        table = sample()
        table.sort(["X", "N"], "DECROISSANT")
        self.assertEqual(table.values()["N"], [4, 1, 3, 2])
        table.sort("X")
        self.assertEqual(table.values()["N"], [3, 4, 1, 2])

    def test_columns_in_order_and_crossed(self):
        table = Table.of_columns({"T": ("R", [0.0, 1.0]), "E": ("R", [None, None]), "N": ("I", [1, 2])})
        self.assertEqual(table.SansColonneVide().para, ["T", "N"])
        table.OrdreColonne("N")
        self.assertEqual((table.para, table.type), (["N", "T", "E"], ["I", "R", "R"]))
        across = Table.of_columns({"X": ("I", [1, 1, 2]), "Y": ("K8", ["A", "B", "A"]), "V": ("R", [1.0, 2.0, 3.0])}).Croise()
        self.assertEqual(across.values(), {"X": [1, 2], "A": [1.0, 3.0], "B": [2.0, None]})
        with self.assertRaisesRegex(TypeError, "three columns"):
            table[["N"]].Croise()

    def test_changes(self):
        table = sample()
        table.append({"N": 5, "NEW": 1.5})
        self.assertEqual(table.values()["NEW"], [None] * 4 + [1.5])
        table.fromfunction("TWICE", lambda x: 2 * x, "X")
        self.assertEqual(table.values()["TWICE"], [1.0, None, -4.0, 1.0, None])
        table.Renomme("TWICE", "D")
        del table["S"]
        self.assertEqual(table.para, ["N", "X", "NEW", "D"])
        self.assertEqual(table[["N", "D"]].para, ["N", "D"])
        self.assertEqual(table.Array("N", "X").tolist(), [[1, 0.5], [3, -2], [4, 0.5]])

    def test_a_column_of_integers_that_gets_a_real_is_one_of_reals(self):
        """2.7 stays 2.7 in a file; a text among numbers is refused where it is put in."""
        table = sample()
        table.append({"N": 2.7, "S": "a longer text"})
        self.assertEqual(table.type, ["R", "R", "K16"])
        with h5py.File(io.BytesIO(), "w") as file:
            write_table(file, table)
            self.assertEqual((read_table(file).values()["N"], read_table(file).kind("S")), ([1, 2, 3, 4, 2.7], "K16"))
        with self.assertRaisesRegex(TypeError, "column X .* numbers, and 'A'"):
            table.append({"X": "A"})

    def test_extremes_of_a_column_compare_each_value_twice(self):
        compared = []

        class Counted(float):
            __hash__ = float.__hash__

            def __gt__(self, other):
                compared.append(self)
                return float.__gt__(self, other)

            def __eq__(self, other):
                compared.append(self)
                return float.__eq__(self, other)

        table = Table.of_columns({"X": ("R", [Counted(i % 10) for i in range(200)])})
        self.assertEqual(len(table.X.MAXI()), 20)
        self.assertLessEqual(len(compared), 2 * 200)

    def test_types(self):
        self.assertEqual([type_of(v) for v in ([1, None], [1, 2.0], ["a"], ["a" * 9], ["a" * 80], [], [True])],
                         ["I", "R", "K8", "K16", "K80", "R", "R"])

    def test_stored_reads_back_the_same(self):
        for table in (sample(), Table.of_columns({"A": ("R", []), "B": ("K8", [])}), Table()):
            with h5py.File(io.BytesIO(), "w") as file:
                write_table(file, table)
                read = read_table(file)
            self.assertEqual((read.rows, read.para, read.type, read.titr), (table.rows, table.para, table.type, table.titr))


class Printing(unittest.TestCase):
    def test_columns(self):
        self.assertEqual(columns(sample()).split("\n"), [
            "#sample", " N            X S", " 1  5.00000E-01 A", " 2            - B", " 3 -2.00000E+00 A", " 4  5.00000E-01 -"])

    def test_formats(self):
        self.assertEqual(format(1.5, number_format("1PE16.9")), " 1.500000000E+00")
        self.assertEqual(format(1.5, number_format("F8.3")), "   1.500")
        with self.assertRaises(ValueError):
            number_format("%12.5e")

    def test_crossed(self):
        table = Table.of_columns({"T": ("R", [0.0, 0.0, 1.0, 1.0]), "P": ("K8", ["A", "B", "A", "B"]), "V": ("I", [1, 2, 3, 4])})
        self.assertEqual([line.split() for line in columns(crossed(table, ["T", "P", "V"], "3.1F"), "3.1F").split("\n")[1:]],
                         [["T", "A", "B"], ["0.0", "1", "2"], ["1.0", "3", "4"]])


TABLE = """
T = CREA_TABLE(LISTE=(_F(LISTE_R=(1.5, 2.5, -3.0), PARA='V'), _F(LISTE_I=(1, 2, 3), PARA='N'),
                      _F(LISTE_K=('A', 'B'), PARA='S', NUME_LIGN=(1, 3))), TITRE=('first', 'second'))
"""


class Commands(LauncherTest):
    def study(self, text, *options, table=TABLE):
        return self.run_study(f"DEBUT()\n{table}{text}\nFIN()\n", *options)

    def test_created(self):
        self.ok(self.study("""
assert len(T) == 3 and T['V', 3] == -3.0 and T['S', 2] is None and T['S', 3] == 'B' and T['N', 1] == 1
t = T.EXTR_TABLE()
assert t.type == ['R', 'I', 'K8'] and t.titr == 'first\\nsecond'
U = CREA_TABLE(**t.dict_CREA_TABLE())
assert U.EXTR_TABLE().rows == t.rows
f = DEFI_FONCTION(NOM_PARA='INST', NOM_RESU='P', VALE=(0, 1, 2, 5))
F = CREA_TABLE(FONCTION=_F(FONCTION=f))
assert F.values() == {'INST': [0, 2], 'P': [1, 5]}
G = CREA_TABLE(FONCTION=_F(FONCTION=f, PARA=('T', 'U')))
assert G.getParameters() == ['T', 'U'] and G.getColumnType('T') == 'R' and G.getValues('U') == ([1, 2], [1, 5])
"""))

    def test_a_column_without_values_makes_no_list(self):
        """dict_CREA_TABLE gave CREA_TABLE an empty list, which it refuses."""
        self.ok(self.study("""
t = T.EXTR_TABLE()
t = t.S.VIDE()
assert t.values()['S'] == [None]
U = CREA_TABLE(**t.dict_CREA_TABLE())
assert U.values() == {'V': [2.5], 'N': [2]}, U.values()
"""))

    def test_arrays_of_numpy(self):
        """What IMPR_TABLE and IMPR_FONCTION save, numpy and LIRE_FONCTION read; a cell without number is nan, a text is refused."""
        self.ok(self.study("""
import numpy
DEFI_FICHIER(UNITE=60, FICHIER='table.npy', ACCES='NEW')
IMPR_TABLE(TABLE=T, FORMAT='NUMPY', UNITE=60, NOM_PARA=('N', 'V'), TRI=_F(NOM_PARA='V'))
assert numpy.load('table.npy').tolist() == [[3, -3], [1, 1.5], [2, 2.5]]
HOLES = CREA_TABLE(LISTE=(_F(PARA='A', LISTE_R=(1.0, 2.0)), _F(PARA='B', LISTE_R=(5.0,), NUME_LIGN=(2,))))
IMPR_TABLE(TABLE=HOLES, FORMAT='NUMPY', UNITE=60)
found = numpy.load('table.npy')
assert numpy.isnan(found[0, 1]) and found[1].tolist() == [2, 5]
F = DEFI_FONCTION(NOM_PARA='INST', VALE=(0.0, 1.0, 2.0, 5.0))
G = DEFI_FONCTION(NOM_PARA='INST', VALE=(0.0, 3.0, 2.0, 4.0))
IMPR_FONCTION(FORMAT='NUMPY', UNITE=60, COURBE=(_F(FONCTION=F), _F(FONCTION=G)))
H = LIRE_FONCTION(FORMAT='NUMPY', UNITE=60, NOM_PARA='INST', INDIC_RESU=(1, 3))
assert H.Valeurs() == G.Valeurs() and numpy.load('table.npy').shape == (2, 3)
try:
    IMPR_TABLE(TABLE=T, FORMAT='NUMPY', UNITE=60)
    raise SystemExit('a text was saved')
except AsterError as error:
    assert "'S'" in str(error) or 'S' in str(error), error
"""))

    def test_survives_the_run(self):
        self.ok(self.study(""))
        self.ok(self.run_study("POURSUITE()\nassert T['V', 2] == 2.5 and T\nFIN()\n"))

    def test_creation_refused(self):
        calls = []
        for keywords, word in (("LISTE=(_F(PARA='A', LISTE_R=(1, 2)), _F(PARA='B', LISTE_R=1))", "TABLE_5"),
                               ("LISTE=(_F(PARA='A', LISTE_R=(1, 2), NUME_LIGN=1))", "TABLE_6"),
                               ("LISTE=(_F(PARA='A', LISTE_R=1), _F(PARA='A', LISTE_R=2))", "TABLE_7"),
                               ("LISTE=_F(PARA='A', LISTE_K='123456789', TYPE_K='K8')", "TABLE_8"),
                               ("LISTE=_F(PARA='A', LISTE_R=1, LISTE_I=1)", "KEYWORD_6"),
                               ("LISTE=_F(PARA='A', LISTE_R=1), TYPE_TABLE='TABLE_FONCTION'", "KEYWORD_13")):
            calls.append((f"CREA_TABLE({keywords})", word))
        self.all_refused("DEBUT()", calls)

    def test_printed(self):
        self.ok(self.study("""
IMPR_TABLE(TABLE=T, UNITE=30, NOM_PARA=('N', 'V'), FORMAT_R='F6.2', SEPARATEUR=';', FILTRE=_F(NOM_PARA='V', CRIT_COMP='GT', VALE=0.),
           TRI=_F(NOM_PARA='N', ORDRE='DECROISSANT'), TITRE='mine')
IMPR_TABLE(TABLE=T, UNITE=30, FORMAT='ASTER')
IMPR_TABLE(TABLE=T, UNITE=31, FORMAT='TABLEAU_CROISE', NOM_PARA=('N', 'S', 'V'))
IMPR_TABLE(TABLE=T, UNITE=32, PAGINATION='S', NOM_PARA=('S', 'N'), COMMENTAIRE='!')
""", "--unit", "30=out.txt", "--unit", "31=cross.txt", "--unit", "32=pages.txt"))
        text = (self.work / "out.txt").read_text()
        self.assertIn("#mine\n;N;     V\n;2;  2.50\n;1;  1.50\n", text)
        self.assertIn("#DEBUT_TABLE\n#TITRE first\n#TITRE second\n", text)
        self.assertTrue(text.endswith("#FIN_TABLE\n"))
        self.assertIn("A", (self.work / "cross.txt").read_text())
        pages = (self.work / "pages.txt").read_text()
        self.assertEqual(pages.count("!LACON CONCEPT T"), 3)
        self.assertNotIn("#", pages)

    def test_a_new_run_replaces_what_an_older_one_printed(self):
        for _ in range(2):
            self.ok(self.study("IMPR_TABLE(TABLE=T, UNITE=30)\nIMPR_TABLE(TABLE=T, UNITE=30)", "--unit", "30=out.txt"))
        self.assertEqual((self.work / "out.txt").read_text().count("LACON CONCEPT T"), 2)

    def test_rows_that_a_cross_table_does_not_show_are_told(self):
        """Columns 1 and 1.0000001 have one name with five digits."""
        twice = "U = CREA_TABLE(LISTE=(_F(PARA='A', LISTE_R=(1., 1., 2.)), _F(PARA='B', LISTE_R=(1., 1.0000001, 2.)), _F(PARA='C', LISTE_R=(1., 2., 3.))))\n"
        run = self.study(twice + "IMPR_TABLE(TABLE=U, UNITE=30, FORMAT='TABLEAU_CROISE')")
        self.assertEqual(run.last, "--- DIAGNOSTIC JOB : <A>_ALARM", run.out + run.err)
        self.assertIn("<TABLE_19> 1 rows", run.err)
        fine = self.ok(self.study(twice + "IMPR_TABLE(TABLE=U, UNITE=30, FORMAT='TABLEAU_CROISE', FORMAT_R='E16.9')"))
        self.assertNotIn("TABLE_19", fine.err + fine.out)

    def test_what_the_study_reads_is_not_replaced(self):
        self.refused(self.study("M = LIRE_MAILLAGE(UNITE=20)\nIMPR_TABLE(TABLE=T, UNITE=20)"), "COMMAND_12")
        self.assertEqual((self.work / "mesh.med").read_bytes(), b"not read by the stand-in")

    def test_printing_refused(self):
        calls = []
        for keywords, word in (("FORMAT_R='12'", "TABLE_11"), ("NOM_PARA='Q'", "TABLE_1"), ("FILTRE=_F(NOM_PARA='Q', VALE=1.)", "TABLE_1"),
                               ("FILTRE=_F(NOM_PARA='S', VALE=1.)", "TABLE_2"), ("FILTRE=_F(NOM_PARA='V', CRIT_COMP='LT', VALE=(1., 2.))", "TABLE_3"),
                               ("FILTRE=_F(NOM_PARA='S', CRIT_COMP='MAXI')", "TABLE_4"), ("FORMAT='TABLEAU_CROISE', NOM_PARA=('N', 'S')", "TABLE_12"),
                               ("FILTRE=_F(NOM_PARA='S', CRIT_COMP='REGEXP', VALE_K='(')", "TABLE_18"), ("FORMAT='AGRAF'", "KEYWORD_13"), ("FILTRE=_F(NOM_PARA='N', CRIT_COMP='VIDE', VALE=1.)", "KEYWORD_10")):
            calls.append((f"IMPR_TABLE(TABLE=T, UNITE=30, {keywords})", word))
        self.all_refused(f"DEBUT()\n{TABLE}", calls)
        self.assertFalse((self.work / "study.30.table").exists())

    def test_checked(self):
        lines = [("NOM_PARA='V', TYPE_TEST='MAX', VALE_CALC=2.5", 2.5), ("NOM_PARA='V', TYPE_TEST='SOMM_ABS', VALE_CALC=7.0", 7.0),
                 ("NOM_PARA='V', FILTRE=_F(NOM_PARA='S', VALE_K='B'), VALE_CALC=-3.0, VALE_ABS='NON'", -3.0),
                 ("NOM_PARA='V', FILTRE=_F(NOM_PARA='S', VALE_K='B'), VALE_CALC=3.0, VALE_ABS='OUI'", 3.0),
                 ("NOM_PARA='V', FILTRE=_F(NOM_PARA='S', VALE_K='B'), VALE_CALC=-3.0, VALE_REFE=-3.0, REFERENCE='ANALYTIQUE', VALE_ABS='OUI'", 3.0),
                 ("NOM_PARA='N', FILTRE=_F(NOM_PARA='V', CRIT_COMP='MINI'), VALE_CALC_I=-3, VALE_ABS='OUI'", 3),
                 ("NOM_PARA='S', FILTRE=_F(NOM_PARA='N', VALE_I=1), VALE_CALC_K='A', VALE_ABS='OUI'", "A"),
                 ("NOM_PARA='V', FILTRE=_F(NOM_PARA='V', VALE=2.5001), VALE_CALC=2.5", 2.5),
                 ("NOM_PARA='N', FILTRE=_F(NOM_PARA='V', CRIT_COMP='MINI'), VALE_CALC_I=3", 3),
                 ("NOM_PARA='N', FILTRE=(_F(NOM_PARA='N', CRIT_COMP='NE', VALE_I=(1, 3)), _F(NOM_PARA='S', CRIT_COMP='VIDE')), VALE_CALC_I=2", 2),
                 ("NOM_PARA='S', FILTRE=_F(NOM_PARA='N', VALE_I=1), VALE_CALC_K='A', VALE_REFE_K='A', REFERENCE='ANALYTIQUE'", "A"),
                 ("NOM_PARA='V', FILTRE=_F(NOM_PARA='N', VALE_I=1), VALE_CALC=(9.0, 1.5)", 1.5)]
        run = self.ok(self.study("".join(f"TEST_TABLE(TABLE=T, {line})\n" for line, _ in lines), "--json", "checks.json"))
        self.assertIn(f"{len(lines)} checks: {len(lines)} OK", run.out)
        made = json.loads((self.work / "checks.json").read_text())["checks"]
        self.assertEqual([c["value"] for c in made], [value for _, value in lines])
        self.assertEqual([c["label"] for c in made], ["T"] * len(lines))

    def test_missed(self):
        run = self.study("""
TEST_TABLE(TABLE=T, NOM_PARA='V', TYPE_TEST='MAX', VALE_CALC=2.6)
TEST_TABLE(TABLE=T, NOM_PARA='V', TYPE_TEST='MAX', VALE_CALC=2.5, VALE_REFE=2.6, REFERENCE='ANALYTIQUE')
TEST_TABLE(TABLE=T, NOM_PARA='S', FILTRE=_F(NOM_PARA='N', VALE_I=1), VALE_CALC_K='B')
TEST_TABLE(TABLE=T, NOM_PARA='N', FILTRE=_F(NOM_PARA='N', VALE_I=1), VALE_CALC_I=2)
""")
        self.assertEqual((run.status, run.last), (5, "--- DIAGNOSTIC JOB : NOOK_TEST_RESU"))
        self.assertIn("4 checks: 0 OK, 4 NOOK, 0 DIFF", run.out)

    def test_checks_refused(self):
        calls = []
        for keywords, word in (("NOM_PARA='V', VALE_CALC=1.5", "TABLE_9"), ("NOM_PARA='Q', VALE_CALC=1.5", "TABLE_1"),
                               ("NOM_PARA='V', FILTRE=_F(NOM_PARA='N', VALE_I=9), VALE_CALC=1.5", "TABLE_20"),
                               ("NOM_PARA='S', FILTRE=_F(NOM_PARA='N', VALE_I=2), VALE_CALC_K='A'", "TABLE_21"),
                               ("NOM_PARA='V', VALE_CALC_I=1, TYPE_TEST='MAX'", "TABLE_2"), ("NOM_PARA='S', VALE_CALC=1.", "TABLE_2"),
                               ("NOM_PARA='V'", "KEYWORD_7"), ("NOM_PARA='V', VALE_CALC=1., VALE_REFE=1.", "KEYWORD_10"),
                               ("NOM_PARA='V', VALE_CALC=1., REFERENCE='ANALYTIQUE'", "KEYWORD_2")):
            calls.append((f"TEST_TABLE(TABLE=T, {keywords})", word))
        self.all_refused(f"DEBUT()\n{TABLE}", calls)

    def test_a_filter_that_no_row_passes_is_named_with_what_the_column_has(self):
        """With TYPE_TEST too; of many values those nearest to what was asked for."""
        self.write("column.py", "COLUMN = [i / 4 for i in range(20)]\n")
        prelude = """
DEBUT()
from column import COLUMN
T = CREA_TABLE(LISTE=(_F(PARA='INST', LISTE_R=COLUMN), _F(PARA='NAME', LISTE_K=['A', 'B'] * 10), _F(PARA='V', LISTE_I=range(20))))
"""
        none = "FILTRE lets no row pass; in the rows before it the column"
        for call, words in (
                ("TEST_TABLE(TABLE=T, NOM_PARA='V', TYPE_TEST='MIN', VALE_CALC_I=1, FILTRE=_F(NOM_PARA='INST', VALE=1.1))",
                 (f"<TABLE_20> {none} 'INST' has: 0.5, 0.75, 1, 1.25, 1.5, 1.75, ...", "TEST_TABLE/FILTRE[1]")),
                ("TEST_TABLE(TABLE=T, NOM_PARA='V', VALE_CALC_I=1, FILTRE=(_F(NOM_PARA='INST', VALE=1.), _F(NOM_PARA='NAME', VALE_K='B')))",
                 (f"{none} 'NAME' has: 'A'", "TEST_TABLE/FILTRE[2]")),
                ("EXTR_TABLE(TABLE=T, TYPE_RESU='ENTIER', NOM_PARA='V', FILTRE=_F(NOM_PARA='V', CRIT_COMP='GT', VALE_I=19))",
                 (f"{none} 'V' has: 14, 15, 16, 17, 18, 19, ...", "EXTR_TABLE/FILTRE[1]"))):
            self.assertNotIn("TYPE_TEST", self.refused(self.run_study(prelude + call + "\n"), *words).err)

    def test_created_from_fields(self):
        self.ok(self.run_study(STUDY + """
def table(**keywords):
    return CREA_TABLE(RESU=_F(RESULTAT=R, INST=1.0, **keywords)).EXTR_TABLE()
t = table(NOM_CHAM='DEPL', TOUT_CMP='OUI', GROUP_NO='TOP')
assert t.para == ['RESULTAT', 'NOM_CHAM', 'NUME_ORDRE', 'INST', 'NOEUD', 'COOR_X', 'COOR_Y', 'COOR_Z', 'DX', 'LAGS_C'], t.para
assert t.values()['NOEUD'] == ['N4', 'N5', 'N6'] and t.values()['DX'] == [4, 5, 6] and t.values()['LAGS_C'] == [None, -25, None]
assert table(NOM_CHAM='DEPL', NOM_CMP='LAGS_C', TOUT='OUI').values()['NOEUD'] == ['N2', 'N5']
assert table(NOM_CHAM='DEPL', NOM_CMP='DX', GROUP_MA='SKIN').values()['DX'] == [1, 2]
t = table(NOM_CHAM='SIEF_ELGA', NOM_CMP='SIYY', MAILLE='M2')
assert t.para[4:] == ['MAILLE', 'POINT', 'SIYY'] and [list(r.values())[4:] for r in t] == [['M2', 1, 3], ['M2', 2, -4]]
t = table(NOM_CHAM='SIEF_ELNO', NOM_CMP='SIYY', NOEUD='N5')
assert t.values()['MAILLE'] == ['M1', 'M2'] and t.values()['SIYY'] == [3, 8] and t.values()['COOR_X'] == [1, 1]
assert table(NOM_CHAM='CONT_ELEM', NOM_CMP='PRES', TOUT='OUI').values()['MAILLE'] == ['M3']
assert len(CREA_TABLE(RESU=_F(RESULTAT=R, TOUT_ORDRE='OUI', NOM_CHAM='DEPL', NOM_CMP='DX', NOEUD='N1'))) == 3
FIN()
"""))
        self.all_refused("POURSUITE()", [
            ("CREA_TABLE(RESU=_F(RESULTAT=R, INST=1.0, NOM_CHAM='DEPL', NOM_CMP='LAGS_C', NOEUD='N1'))", "POST_3"),
            ("CREA_TABLE(RESU=_F(RESULTAT=R, INST=1.0, NOM_CHAM='SIEF_ELGA', NOM_CMP='SIYY', NOEUD='N1'))", "TEST_RESU_5"),
            ("CREA_TABLE(RESU=_F(RESULTAT=R, INST=1.0, NOM_CMP='DX', NOEUD='N1'))", "KEYWORD_2")])

    def test_a_cell_is_a_number_or_names_a_concept(self):
        """EXTR_TABLE: numbers of Python's, or a copy that stays when what it was made of goes."""
        self.ok(self.run_study("""
DEBUT()
F = DEFI_FONCTION(NOM_PARA='INST', VALE=(0, 0, 1, 2))
T = CREA_TABLE(LISTE=(_F(PARA='N', LISTE_I=(1, 2)), _F(PARA='X', LISTE_R=(0.5, 1.5)), _F(PARA='NAME', LISTE_K=('F', 'T'))))
n = EXTR_TABLE(TABLE=T, TYPE_RESU='ENTIER', NOM_PARA='N', FILTRE=_F(NOM_PARA='X', VALE=1.5))
x = EXTR_TABLE(TABLE=T, TYPE_RESU='REEL', NOM_PARA='X', FILTRE=_F(NOM_PARA='N', VALE_I=1))
assert (n, type(n), x, type(x)) == (2, int, 0.5, float), (n, x)
assert EXTR_TABLE(TABLE=T, TYPE_RESU='REEL', NOM_PARA='N', FILTRE=_F(NOM_PARA='N', CRIT_COMP='MAXI')) == 2.0
G = EXTR_TABLE(TABLE=T, TYPE_RESU='FONCTION_SDASTER', NOM_PARA='NAME', FILTRE=_F(NOM_PARA='N', VALE_I=1))
DETRUIRE(CONCEPT=_F(NOM=F))
assert G(0.5) == 1.0
FIN()
"""))
        self.all_refused("POURSUITE()", [
            ("EXTR_TABLE(TABLE=T, TYPE_RESU='REEL', NOM_PARA='X')", "TABLE_16"),
            ("EXTR_TABLE(TABLE=T, TYPE_RESU='REEL', NOM_PARA='Y')", "TABLE_1"),
            *((f"EXTR_TABLE(TABLE=T, TYPE_RESU='{kind}', NOM_PARA='{name}', FILTRE=_F(NOM_PARA='N', VALE_I=2))", "TABLE_17")
              for kind, name in (("ENTIER", "X"), ("REEL", "NAME"), ("FONCTION_SDASTER", "NAME"), ("TABLE_SDASTER", "X")))])

    def test_a_concept_is_found_where_a_command_file_has_it(self):
        """EXTR_TABLE: in a function of the command file, in a list, a dictionary; its own variable before one of the same name outside."""
        self.ok(self.run_study("""
DEBUT()
def constant(value):
    return DEFI_FONCTION(NOM_PARA='INST', VALE=(0, value, 1, value))
def named(*names):
    return CREA_TABLE(LISTE=_F(PARA='NAME', LISTE_K=names, TYPE_K='K24'))
def found(table):
    return EXTR_TABLE(TABLE=table, TYPE_RESU='FONCTION_SDASTER', NOM_PARA='NAME')(0.5)
F, S, D = constant(1), [], {}
S.append(constant(2))
S += [constant(3)]
D['x'] = constant(4)
assert [found(named(name)) for name in ('F', 'S[0]', 'S[1]', "D['x']")] == [1, 2, 3, 4]
def macro():
    F = constant(5)
    inner = constant(6)
    return [found(named(name)) for name in ('F', 'inner')]
assert macro() == [5, 6] and found(named('F')) == 1
FIN()
"""))

    def test_parameters_of_a_result(self):
        self.ok(self.run_study(STUDY + """
P = RECU_TABLE(CO=R, NOM_PARA='INST')
assert P.values() == {'NUME_ORDRE': [0, 1, 2], 'INST': [0.0, 0.5, 1.0]}
P = RECU_TABLE(CO=R, NOM_PARA='ITER_GLOB')
assert P.values() == {'NUME_ORDRE': [0, 1, 2], 'ITER_GLOB': [0, 2, 3]}
FIN()
"""))
        self.refused(self.run_study("POURSUITE()\nP = RECU_TABLE(CO=R, NOM_PARA='FREQ')\n"), "TABLE_13")
        self.refused(self.run_study("POURSUITE()\nP = RECU_TABLE(CO=R, NOM_TABLE='OBSERVATION')\n"), "TABLE_10")


if __name__ == "__main__":
    unittest.main()
