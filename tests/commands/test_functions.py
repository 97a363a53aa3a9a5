"""CALC_FONCTION, RECU_FONCTION, TEST_FONCTION, IMPR_FONCTION and CALC_TABLE against closed forms and by hand."""

import sys
import unittest

sys.path.insert(0, __file__.rpartition("/")[0] or ".")
from support import STUDY, LauncherTest  # noqa: E402

from lacon.tables.curves import Curve, Plot, _mathematics, _tick, columns  # noqa: E402

FUNCTIONS = """
DEBUT()
import math
f = DEFI_FONCTION(NOM_PARA='INST', NOM_RESU='U', VALE=(0, 0, 1, 1, 3, 9), PROL_DROITE='CONSTANT')
g = DEFI_FONCTION(NOM_PARA='INST', VALE=(0, 2, 2, 0, 3, -1))
quadratic = FORMULE(NOM_PARA='INST', VALE='INST**2')
two = FORMULE(NOM_PARA=('X', 'Y'), VALE='X*Y')
L = DEFI_LIST_REEL(DEBUT=0., INTERVALLE=_F(JUSQU_A=3., NOMBRE=3))
T = CREA_TABLE(LISTE=(_F(PARA='A', LISTE_R=(1., 2., 3.)), _F(PARA='B', LISTE_R=(4., 5., 7.)), _F(PARA='S', LISTE_K=('x', 'y', 'x'))))
"""


class Calculations(LauncherTest):
    def study(self, text):
        return self.run_study(f"{FUNCTIONS}{text}\nFIN()\n")

    def test_operations(self):
        """Values by hand: f joins (0, 0), (1, 1), (3, 9); g joins (0, 2), (2, 0), (3, -1)."""
        self.ok(self.study("""
def check(made, x, y):
    assert made.Absc() == x and all(abs(a - b) < 1e-14 for a, b in zip(made.Ordo(), y)) and len(made.Ordo()) == len(y), made.Valeurs()
check(CALC_FONCTION(COMB=(_F(FONCTION=f, COEF=2.), _F(FONCTION=g, COEF=-1.))), [0, 1, 2, 3], [-2, 1, 10, 19])
check(CALC_FONCTION(COMB=_F(FONCTION=f, COEF=2.), LIST_PARA=L), [0, 1, 2, 3], [0, 2, 10, 18])
check(CALC_FONCTION(ENVELOPPE=_F(FONCTION=(f, g))), [0, 1, 2, 3], [2, 1, 5, 9])
check(CALC_FONCTION(ENVELOPPE=_F(FONCTION=(f, g), CRITERE='INF')), [0, 1, 2, 3], [0, 1, 0, -1])
check(CALC_FONCTION(MULT=_F(FONCTION=(f, g))), [0, 1, 2, 3], [0, 1, 0, -9])
check(CALC_FONCTION(MULT=(_F(FONCTION=f), _F(FONCTION=g))), [0, 1, 2, 3], [0, 1, 0, -9])
check(CALC_FONCTION(INTEGRE=_F(FONCTION=f, COEF=1.)), [0, 1, 3], [1, 1.5, 11.5])
check(CALC_FONCTION(ABS=_F(FONCTION=g)), [0, 2, 3], [2, 0, 1])
check(CALC_FONCTION(PUISSANCE=_F(FONCTION=g, EXPOSANT=3)), [0, 2, 3], [8, 0, -1])
check(CALC_FONCTION(INVERSE=_F(FONCTION=f)), [0, 1, 9], [0, 1, 3])
check(CALC_FONCTION(INVERSE=_F(FONCTION=g)), [-1, 0, 2], [3, 2, 0])
back = CALC_FONCTION(INVERSE=_F(FONCTION=DEFI_FONCTION(NOM_PARA='X', NOM_RESU='DY', VALE=(0, 2, 1, 0), PROL_GAUCHE='LINEAIRE', PROL_DROITE='CONSTANT')))
assert back.Parametres()['NOM_PARA'] == 'DY' and back.Parametres()['NOM_RESU'] == 'X' and back(4.0) == -1.0 and back.Parametres()['PROL_GAUCHE'] == 'EXCLU'
check(CALC_FONCTION(COMPOSE=_F(FONC_RESU=f, FONC_PARA=CALC_FONCTION(ABS=_F(FONCTION=g)))), [0, 2, 3], [5, 0, 1])
late = DEFI_FONCTION(NOM_PARA='INST', VALE=(2, 5, 4, 6))
check(CALC_FONCTION(ASSE=_F(FONCTION=(f, late))), [0, 1, 2, 4], [0, 1, 5, 6])
check(CALC_FONCTION(ASSE=_F(FONCTION=(late, f), SURCHARGE='GAUCHE')), [0, 1, 3, 4], [0, 1, 9, 6])
M = CALC_FONCTION(MAX=_F(FONCTION=(f, g)))
assert M.EXTR_TABLE().rows[0] == {'FONCTION': 'f', 'TYPE': 'MAX', 'INST': 3, 'U': 9} and len(M) == 4, M.EXTR_TABLE()
h = CALC_FONCTION(COMB=_F(FONCTION=f, COEF=1.), PROL_DROITE='LINEAIRE', NOM_RESU='V')
assert h.Parametres() == {'INTERPOL': ['LIN', 'LIN'], 'NOM_PARA': 'INST', 'NOM_RESU': 'V', 'PROL_GAUCHE': 'EXCLU', 'PROL_DROITE': 'LINEAIRE'} and h.size() == 3
assert h(4) == 13 and f(4) == 9 and CALC_FONCTION(ABS=_F(FONCTION=f))(4) == 9
"""))

    def test_means_and_polynomials(self):
        """The mean of f and g at all their points; a parabola through points of one is found again, also by too high a degree."""
        self.ok(self.study("""
m = CALC_FONCTION(MOYENNE=_F(FONCTION=(f, g)))
assert m.Valeurs() == [[0, 1, 2, 3], [1, 1, 2.5, 4]]
x = [0, 0.3, 1, 1.4, 2]
parabola = DEFI_FONCTION(NOM_PARA='X', ABSCISSE=x, ORDONNEE=[3 * v**2 - v for v in x], PROL_DROITE='LINEAIRE')
for degree in (2, 4):
    p = CALC_FONCTION(REGR_POLYNOMIALE=_F(FONCTION=parabola, DEGRE=degree))
    assert p.Absc() == x and max(abs(a - b) for a, b in zip(p.Ordo(), parabola.Ordo())) < 1e-13 and p.Parametres() == parabola.Parametres()
line = CALC_FONCTION(REGR_POLYNOMIALE=_F(FONCTION=DEFI_FONCTION(NOM_PARA='X', VALE=(0, 0, 1, 3, 2, 0)), DEGRE=1))
assert max(abs(v - 1) for v in line.Ordo()) < 1e-14
"""))
        self.refused(self.study("CALC_FONCTION(REGR_POLYNOMIALE=_F(FONCTION=f, DEGRE=3))"), "FUNCTION_18", "3 + 1 points", "f has 3")

    def test_simpson_is_exact_for_parabolas_on_any_steps(self):
        """x**2 from 0 on, with an odd and an even count of intervals; on equal steps x**3 at the ends of pairs; of two points the trapezoid."""
        self.ok(self.study("""
def integral(x, degree):
    points = DEFI_FONCTION(NOM_PARA='X', ABSCISSE=x, ORDONNEE=[v**degree for v in x])
    made = CALC_FONCTION(INTEGRE=_F(FONCTION=points, METHODE='SIMPSON', COEF=2.))
    assert made.Absc() == x
    return [y - 2 - v**(degree + 1) / (degree + 1) for v, y in zip(made.Absc(), made.Ordo())]
for x in ([0, 0.3, 1, 1.4, 2], [0, 0.3, 1, 1.4], [0, 1, 3]):
    assert max(map(abs, integral(x, 2))) < 1e-14, integral(x, 2)
assert max(map(abs, integral([0, 1, 2, 3, 4], 3)[::2])) < 1e-13
assert integral([0, 1], 2) == [0, 0.5 - 1 / 3]
"""))

    def test_fractiles_and_extremes_of_parts(self):
        """Of three constants the median is the one between, a quarter half way below it. The extremes of g in [1, 2.5], on whose ends no points are."""
        self.ok(self.study("""
flat = [DEFI_FONCTION(NOM_PARA='X', VALE=(0, c, 1, c)) for c in (4., 1., 2.)]
for part, value in ((1.0, 4), (0.0, 1), (0.5, 2), (0.25, 1.5)):
    assert CALC_FONCTION(FRACTILE=_F(FONCTION=flat, FRACT=part)).Valeurs() == [[0, 1], [value, value]]
M = CALC_FONCTION(MAX=_F(FONCTION=g, INTERVALLE=(1., 2.5, 2., 3.))).EXTR_TABLE()
assert [(r['INTERVALLE'], r['TYPE'], r['INST'], r['TOUTRESU']) for r in M] == [(1, 'MAX', 1, 1), (1, 'MIN', 2.5, -0.5), (2, 'MAX', 2, 0), (2, 'MIN', 3, -1)], M
"""))

    def test_measures_of_functions(self):
        """By trapezes over the points: of (0, 1), (1, -1), (2, 1) the square is 1 everywhere, and the mean 0; of a line over [1, 3] of [0, 4] by hand."""
        self.ok(self.study("""
saw = DEFI_FONCTION(NOM_PARA='INST', VALE=(0, 1, 1, -1, 2, 1))
line = DEFI_FONCTION(NOM_PARA='INST', VALE=(0, 0, 4, 4))
T = INFO_FONCTION(RMS=(_F(FONCTION=saw), _F(FONCTION=line, INST_INIT=1., INST_FIN=3.)))
assert T.EXTR_TABLE().para == ['FONCTION', 'METHODE', 'INST_INIT', 'INST_FIN', 'RMS']
assert T['RMS', 1] == 1 and T['FONCTION', 2] == 'line' and abs(T['RMS', 2] - 5**0.5) < 1e-14 and T['INST_FIN', 2] == 3
E = INFO_FONCTION(ECART_TYPE=_F(FONCTION=line, INST_INIT=1., INST_FIN=3.))
assert abs(E['ECART_TYPE', 1] - 1) < 1e-14 and abs(INFO_FONCTION(ECART_TYPE=_F(FONCTION=saw))['ECART_TYPE', 1] - 1) < 1e-14
assert INFO_FONCTION(MAX=_F(FONCTION=(f, g))).EXTR_TABLE().rows == CALC_FONCTION(MAX=_F(FONCTION=(f, g))).EXTR_TABLE().rows
"""))
        self.refused(self.study("INFO_FONCTION(RMS=_F(FONCTION=f, INST_INIT=2., INST_FIN=2.))"), "FUNCTION_19", "between 2 and 2")

    def test_a_surface_is_drawn_by_its_functions(self):
        done = self.study("""
surface = DEFI_NAPPE(NOM_PARA='TEMP', PARA=(10., 20.), NOM_PARA_FONC='EPSI', DEFI_FONCTION=(_F(VALE=(0., 0., 1., 5.)), _F(VALE=(0., 1., 1., 7.))))
IMPR_FONCTION(UNITE=6, COURBE=_F(FONCTION=surface))
assert surface.Valeurs() == [[10., 20.], [[[0., 1.], [0., 5.]], [[0., 1.], [1., 7.]]]]
""")
        self.ok(done)
        rows = [line.split() for line in done.out.splitlines() if line.strip() and line.split()[0][0].isdigit()]
        self.assertIn(["1.00000E+00", "5.00000E+00", "7.00000E+00"], rows, done.out)
        self.assertIn("surface_20", done.out)

    def test_the_derivative_is_of_second_order_on_any_steps(self):
        """Exact for a quadratic function on uneven points, also at the ends; its error falls fourfold for sin."""
        self.ok(self.study("""
x = [0, 0.3, 1, 1.4, 2]
d = CALC_FONCTION(DERIVE=_F(FONCTION=DEFI_FONCTION(NOM_PARA='X', ABSCISSE=x, ORDONNEE=[3 * v**2 - v for v in x])))
assert max(abs(a - (6 * v - 1)) for v, a in zip(*d.Valeurs())) < 1e-13
def error(n):
    x = [i / n for i in range(n + 1)]
    d = CALC_FONCTION(DERIVE=_F(FONCTION=DEFI_FONCTION(NOM_PARA='X', ABSCISSE=x, ORDONNEE=list(map(math.sin, x)))))
    return max(abs(a - math.cos(v)) for v, a in zip(*d.Valeurs()))
assert 3.6 < error(20) / error(40) < 4.4
line = CALC_FONCTION(DERIVE=_F(FONCTION=DEFI_FONCTION(NOM_PARA='X', VALE=(0, 1, 2, 5))))
assert line.Ordo() == [2, 2]
"""))

    def test_checks(self):
        run = self.study("""
TEST_FONCTION(VALEUR=_F(FONCTION=FORMULE(NOM_PARA=('X', 'Y'), VALE='X - 2 * Y'), NOM_PARA=('Y', 'X'), VALE_PARA=(1., 5.), VALE_CALC=3.))
TEST_FONCTION(VALEUR=(_F(FONCTION=f, VALE_PARA=2., VALE_CALC=5.0, VALE_REFE=5.001, REFERENCE='ANALYTIQUE'),
                      _F(FONCTION=two, VALE_PARA=(2., 3.), VALE_CALC=6.0), _F(FONCTION=quadratic, VALE_PARA=3., VALE_CALC=9.5, VALE_REFE=9.0, REFERENCE='ANALYTIQUE', PRECISION=0.1),
                      _F(FONCTION=f, VALE_PARA=2., VALE_CALC=-5.0, VALE_ABS='OUI')))
""")
        self.assertEqual((run.status, run.last), (0, "--- DIAGNOSTIC JOB : OK"))
        self.assertIn("5 checks: 4 OK, 0 NOOK, 1 DIFF", run.out)
        self.assertIn("X 2, Y 3", run.out)

    def test_calculated_tables(self):
        self.ok(self.study("""
product = FORMULE(NOM_PARA=('A', 'B'), VALE='A*B')
def table(*actions):
    return CALC_TABLE(TABLE=T, ACTION=actions).EXTR_TABLE()
v = table(_F(OPERATION='OPER', FORMULE=product, NOM_PARA='AB'), _F(OPERATION='TRI', NOM_PARA='A', ORDRE='DECROISSANT')).values()
assert v['AB'] == [21, 10, 4] and v['A'] == [3, 2, 1]
assert table(_F(OPERATION='OPER', FORMULE=product, NOM_PARA='AA', NOM_COLONNE=('A', 'A'))).values()['AA'] == [1, 4, 9]
assert table(_F(OPERATION='FILTRE', NOM_PARA='B', CRIT_COMP='GT', VALE=4), _F(OPERATION='EXTR', NOM_PARA=('B', 'A'))).rows == [{'B': 5, 'A': 2}, {'B': 7, 'A': 3}]
assert table(_F(OPERATION='FILTRE', NOM_PARA='S', VALE_K='x')).values()['A'] == [1, 3]
assert table(_F(OPERATION='RENOMME', NOM_PARA=('A', 'C'))).para == ['C', 'B', 'S']
assert table(_F(OPERATION='SUPPRIME', NOM_PARA=('A', 'B'))).para == ['S']
assert table(_F(OPERATION='UNIQUE', NOM_PARA='S')).values()['A'] == [1, 2]
w = table(_F(OPERATION='AJOUT_LIGNE', NOM_PARA=('A', 'S'), VALE=(9, 'z')), _F(OPERATION='AJOUT_COLONNE', NOM_PARA=('N', 'K'), VALE=(1, 'k')))
assert w.values() == {'A': [1, 2, 3, 9], 'B': [4, 5, 7, None], 'S': ['x', 'y', 'x', 'z'], 'N': [1] * 4, 'K': ['k'] * 4} and w.kind('N') == 'I'
assert table(_F(OPERATION='AJOUT_COLONNE', NOM_PARA='C', VALE_COLONNE=(5., 6.))).values()['C'] == [5, 6, None]
c = table(_F(OPERATION='CALCUL', NOM_PARA=('A', 'B'), TYPE_CALCUL=('SOMM', 'MOY', 'MINI')))
assert c.values() == {'TYPE_CALCUL': ['SOMM', 'MOY', 'MINI'], 'A': [6, 2, 1], 'B': [16, 16 / 3, 4]}
d = table(_F(OPERATION='STATISTIQUES'))
assert d.values()['TYPE_CALCUL'] == ['NOMBRE', 'MOY', 'ECART_TYPE', 'MEDIANE', 'MAXI', 'MINI', 'SOMM'] and d.para == ['TYPE_CALCUL', 'A', 'B'], d
assert d.values()['A'] == [3, 2, (2 / 3)**0.5, 2, 3, 1, 6] and table(_F(OPERATION='STATISTIQUES', NOM_PARA='B')).values()['B'][3] == 5
U = CREA_TABLE(LISTE=(_F(PARA='A', LISTE_R=(2., 3., 8.)), _F(PARA='Q', LISTE_R=(0.2, 0.3, 0.8))))
j = table(_F(OPERATION='COMB', TABLE=U, NOM_PARA='A')).values()
assert j['A'] == [1, 2, 3, 8] and j['Q'] == [None, 0.2, 0.3, 0.8] and j['B'] == [4, 5, 7, None]
assert table(_F(OPERATION='COMB', TABLE=U, RESTREINT='OUI')).values() == {'A': [2, 3], 'B': [5, 7], 'S': ['y', 'x'], 'Q': [0.2, 0.3]}
I = CREA_TABLE(LISTE=(_F(PARA='K', LISTE_I=(1, 2)), _F(PARA='B', LISTE_I=(1, 2)), _F(PARA='W', LISTE_K=('u', 'v'))))
X = CREA_TABLE(LISTE=(_F(PARA='K', LISTE_R=(1., 3.)), _F(PARA='B', LISTE_R=(1.5, 2.5))))
# integers meet reals: keys are compared as numbers, and no digit is lost
assert CALC_TABLE(TABLE=I, ACTION=_F(OPERATION='COMB', TABLE=X, NOM_PARA='K')).EXTR_TABLE().values() == {'K': [1, 2, 3], 'B': [1.5, 2, 2.5], 'W': ['u', 'v', None]}
assert CALC_TABLE(TABLE=I, ACTION=_F(OPERATION='AJOUT_LIGNE', NOM_PARA=('K', 'B'), VALE=(3, 2.7))).EXTR_TABLE().values()['B'] == [1, 2, 2.7]
name = T.id
T = CALC_TABLE(reuse=T, TABLE=T, ACTION=_F(OPERATION='SUPPRIME', NOM_PARA='S'))
assert T.id == name and T.getParameters() == ['A', 'B']
"""))

    def test_functions_from_tables_and_results(self):
        self.ok(self.run_study(FUNCTIONS.replace("DEBUT()", STUDY.strip()) + """
r = RECU_FONCTION(TABLE=T, PARA_X='A', PARA_Y='B', FILTRE=_F(NOM_PARA='S', VALE_K='x'))
assert r.Valeurs() == [[1, 3], [4, 7]] and r(2) == 5.5
u = RECU_FONCTION(RESULTAT=R, NOM_CHAM='DEPL', NOM_CMP='DX', GROUP_NO='ONE', TOUT_ORDRE='OUI')
assert u.Valeurs() == [[0, 0.5, 1], [0, 2, 4]] and u.points().parameter == 'INST' and u.points().component == 'DX'
s = RECU_FONCTION(RESULTAT=R, NOM_CHAM='SIEF_ELGA', NOM_CMP='SIYY', MAILLE='M2', POINT=2, INST=(0.5, 1.0), NOM_RESU='S', PROL_GAUCHE='CONSTANT')
assert s.Valeurs() == [[0.5, 1], [-4, -4]] and s(0) == -4
p = RECU_FONCTION(RESULTAT=R, NOM_PARA_RESU='INST', NUME_ORDRE=(1, 2))
try:
    RECU_FONCTION(RESULTAT=R, NOM_CHAM='SIEF_ELGA', NOM_CMP='SIYY', MAILLE='M2', INST=(0.5, 1.0))
    raise SystemExit('several points')
except AsterError as error:  # which has no TYPE_TEST
    assert error.id_message == 'TEST_RESU_7' and 'TYPE_TEST' not in str(error), error
assert p.Valeurs() == [[0.5, 1], [0.5, 1]]
FIN()
"""))

    def test_refused(self):
        self.all_refused(FUNCTIONS + "R = None\n", [
            ("TEST_FONCTION(VALEUR=_F(FONCTION=two, VALE_PARA=1., VALE_CALC=1.))", "FUNCTION_12"),
            ("TEST_FONCTION(VALEUR=_F(FONCTION=f, NOM_PARA='Z', VALE_PARA=1., VALE_CALC=1.))", "FUNCTION_12"),
            ("TEST_FONCTION(VALEUR=_F(FONCTION=g, VALE_PARA=4., VALE_CALC=1.))", "DEFI_FONCTION_3"),
            ("DEFI_FONCTION(NOM_PARA='X', VALE=(1, 1, 2, 2), INTERPOL=('LOG', 'LIN'), PROL_GAUCHE='LINEAIRE')(0)", "DEFI_FONCTION_9"),
            ("CALC_FONCTION(MAX=_F(FONCTION=g, INTERVALLE=(1., 0.)))", "FUNCTION_21"), ("CALC_FONCTION(MAX=_F(FONCTION=g, INTERVALLE=(0., 1., 2.)))", "FUNCTION_21"),
            ("CALC_FONCTION(INVERSE=_F(FONCTION=CALC_FONCTION(MULT=_F(FONCTION=(f, g)))))", "FUNCTION_22"),
            ("CALC_FONCTION(PUISSANCE=_F(FONCTION=g, EXPOSANT=-1))", "FUNCTION_15"), ("CALC_FONCTION(RMS=_F(FONCTION=f))", "KEYWORD_11"),
            ("CALC_FONCTION(DERIVE=_F(FONCTION=DEFI_FONCTION(NOM_PARA='X', VALE=(0, 1))))", "FUNCTION_14"),
            ("CALC_FONCTION(ABS=_F(FONCTION=f), MAX=_F(FONCTION=f))", "KEYWORD_6"),
            ("CALC_FONCTION(COMB=_F(FONCTION=f, COEF=1.), INTERPOL='LOG')", "DEFI_FONCTION_4"),
            ("DEFI_NAPPE(NOM_PARA='X', PARA=(0., 1.), FONCTION=(f, f), INTERPOL='LOG')", "DEFI_FONCTION_4"),
            ("RECU_FONCTION(TABLE=T, PARA_X='A', PARA_Y='S')", "TABLE_4"), ("RECU_FONCTION(TABLE=T, PARA_X='A', PARA_Y='Q')", "TABLE_1"),
            ("RECU_FONCTION(TABLE=T, PARA_X='A', PARA_Y='B', FILTRE=_F(NOM_PARA='A', CRIT_COMP='GT', VALE=9.))", "FUNCTION_13"),
            ("RECU_FONCTION(TABLE=CREA_TABLE(LISTE=(_F(PARA='A', LISTE_R=(1., 2., 1.)), _F(PARA='B', LISTE_R=(1., 2., 3.)))), PARA_X='A', PARA_Y='B', VERIF='NON')", "FUNCTION_23"),
            ("DEFI_FONCTION(NOM_PARA='INST', VALE=(0, -1e308, 1, 1e308))", "DEFI_FONCTION_8"), ("DEFI_FONCTION(NOM_PARA='INST', VALE=(-1e308, 0, 1e308, 1))", "DEFI_FONCTION_8"),
            ("IMPR_FONCTION(COURBE=_F(FONCTION=quadratic))", "FUNCTION_11"), ("IMPR_FONCTION(COURBE=_F(FONCTION=two, LIST_PARA=L))", "FUNCTION_12"),
            ("IMPR_FONCTION(COURBE=_F(ABSCISSE=(1., 2.), ORDONNEE=1.))", "DEFI_FONCTION_5"), ("IMPR_FONCTION(FORMAT='AGRAF', COURBE=_F(FONCTION=f))", "KEYWORD_13"),
            ("CALC_TABLE(TABLE=T, ACTION=_F(OPERATION='RENOMME', NOM_PARA='A'))", "CALC_TABLE_1"),
            ("CALC_TABLE(TABLE=T, ACTION=_F(OPERATION='RENOMME', NOM_PARA=('A', 'B')))", "TABLE_7"),
            ("CALC_TABLE(TABLE=T, ACTION=_F(OPERATION='AJOUT_LIGNE', NOM_PARA=('A', 'B'), VALE=1))", "CALC_TABLE_2"),
            ("CALC_TABLE(TABLE=T, ACTION=_F(OPERATION='AJOUT_LIGNE', NOM_PARA='A', VALE='text'))", "TABLE_2"),
            ("CALC_TABLE(TABLE=T, ACTION=_F(OPERATION='COMB', TABLE=CREA_TABLE(LISTE=_F(PARA='Z', LISTE_R=1.))))", "CALC_TABLE_3"),
            ("CALC_TABLE(TABLE=T, ACTION=_F(OPERATION='COMB', TABLE=T, NOM_PARA='S'))", "CALC_TABLE_4"),
            ("CALC_TABLE(TABLE=T, ACTION=_F(OPERATION='COMB', TABLE=CREA_TABLE(LISTE=(_F(PARA='A', LISTE_R=1.), _F(PARA='S', LISTE_R=1.))), NOM_PARA='A'))", "CALC_TABLE_5"),
            ("CALC_TABLE(TABLE=T, ACTION=_F(OPERATION='OPER', FORMULE=FORMULE(NOM_PARA='A', VALE='2 * A'), NOM_PARA='S'))", "TABLE_7"),
            ("CALC_TABLE(TABLE=T, ACTION=_F(OPERATION='EXTR', NOM_PARA='Q'))", "TABLE_1"), ("CALC_TABLE(TABLE=T, ACTION=_F(OPERATION='OPER', NOM_PARA='Q'))", "KEYWORD_2")])


class Drawings(LauncherTest):
    def test_a_function_at_what_is_no_number(self):
        """A text went round and round until Python had no room."""
        self.ok(self.run_study("""
DEBUT()
f = DEFI_FONCTION(NOM_PARA='X', VALE=(0., 0., 1., 1.))
for wrong in ('a', '', b'a'):
    try:
        f(wrong)
    except TypeError as error:
        assert 'f takes numbers' in str(error), error
    else:
        raise AssertionError(wrong)
FIN()
"""))

    def test_curves_of_several_commands_are_in_one_file(self):
        text = FUNCTIONS + """
IMPR_FONCTION(FORMAT='XMGRACE', UNITE=29, TITRE='A "title"', LEGENDE_Y='L\\\\s2\\\\N', ECHELLE_X='LOG', BORNE_X=(0.1, 10.), BORNE_Y=(0., 9.),
              COURBE=(_F(FONCTION=f, LEGENDE='first', COULEUR=4, MARQUEUR=2, STYLE=3), _F(ABSCISSE=(3., 1.), ORDONNEE=(1., 2.), TRI='X')))
IMPR_FONCTION(FORMAT='XMGRACE', UNITE=29, COURBE=_F(FONC_X=f, FONC_Y=g, LIST_PARA=L))
IMPR_FONCTION(UNITE=30, COURBE=(_F(FONCTION=f), _F(FONCTION=quadratic, LIST_PARA=L), _F(LIST_PARA=L, LIST_RESU=L, LEGENDE='same')))
IMPR_TABLE(TABLE=T, FORMAT='XMGRACE', UNITE=31, NOM_PARA=('A', 'B'))
FIN()
"""
        for _ in range(2):  # a second run begins anew
            self.ok(self.run_study(text, "--unit", "29=curves.agr", "--unit", "30=columns.txt", "--unit", "31=table.agr"))
        grace = (self.work / "curves.agr").read_text()
        for part in ("@    world 0.1, 0, 10, 9\n", "title \"A 'title'\"", "xaxes scale Logarithmic", "yaxes scale Normal", "s0 line color 4", "s0 symbol 2",
                     '@    yaxis label "L\\s2\\N"', "s0 line linestyle 3", 's0 legend "first"', "@target G0.S1\n@type xy\n1 2\n3 1\n&\n",
                     "@target G0.S2\n@type xy\n0 2\n1 1\n5 0\n9 -1\n&\n"):
            self.assertIn(part, grace)
        self.assertEqual(grace.count("@target"), 3)
        self.assertEqual((self.work / "columns.txt").read_text().split("\n")[0].split(), ["INST", "f", "X", "quadratic", "same"][:2] + ["INST_2", "quadratic", "same"])
        self.assertIn('legend "T B"', (self.work / "table.agr").read_text())

    def test_a_picture(self):
        try:
            import matplotlib  # noqa: F401
        except ImportError:
            self.skipTest("matplotlib is not installed")
        self.ok(self.run_study(FUNCTIONS + """
IMPR_FONCTION(FORMAT='PNG', UNITE=29, TITRE='\\\\q slope $1 \\\\2', ECHELLE_X='LOG', ECHELLE_Y='LOG', LEGENDE_X='h', LEGENDE_Y='L\\\\s2\\\\N(Erreur)',
              COURBE=(_F(ABSCISSE=(1., 0.5), ORDONNEE=(1., 0.25), LEGENDE='P\\\\S2\\\\N', MARQUEUR=1), _F(ABSCISSE=1., ORDONNEE=1.)))
FIN()
""", "--unit", "29=picture.png"))
        self.assertEqual((self.work / "picture.png").read_bytes()[:8], b"\x89PNG\r\n\x1a\n")

    def test_without_matplotlib(self):
        (self.work / "matplotlib.py").write_text("raise ImportError('none')")
        self.refused(self.run_study(FUNCTIONS + "IMPR_FONCTION(FORMAT='PNG', COURBE=_F(FONCTION=f))\n"), "FUNCTION_10")
        self.assertEqual(list(self.work.glob("*.png*")), [])

    def test_escapes_of_grace(self):
        self.assertEqual(_mathematics(r"L\s2\N(Erreur)"), r"L$_{2}$(Erreur)")
        self.assertEqual(_mathematics(r"\q h\S2\N \2x\f{Symbol}"), r" h$^{2}$ x")
        self.assertEqual(_mathematics("5 $"), r"5 \$")

    def test_ticks_are_round_and_at_most_five(self):
        for low, high in ((0, 1), (0, 7), (-3, 1e4), (0.1, 0.13)):
            tick = _tick(low, high, "LIN")
            self.assertLessEqual((high - low) / tick, 5 + 1e-9)
            self.assertGreater((high - low) / tick, 1.9)

    def test_ranges_of_what_is_drawn(self):
        plot = Plot()
        plot.curves = [Curve([1, 2], [5, 5]), Curve([0.5], [5])]
        self.assertEqual(plot._ranges(), ((0.5, 4.5), (2, 5.5)))

    def test_names_of_columns_stay_different(self):
        table = columns([Curve([0, 1], [1, 2], legend="u"), Curve([0, 1], [3, 4], legend="u"), Curve([0], [9])])
        self.assertEqual(table.para, ["X", "u", "u_2", "X_2", "Y"])
        self.assertEqual(table.values()["Y"], [9, None])


if __name__ == "__main__":
    unittest.main()
