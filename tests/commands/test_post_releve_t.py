"""POST_RELEVE_T on the stand-in's result: DX = instant x node number, LAGS_C on N2 and N5; nodes 1 2 3 / 4 5 6 on a grid of unit squares."""

import sys
import unittest

import h5py
import numpy

sys.path.insert(0, __file__.rpartition("/")[0] or ".")
from support import STUDY, LauncherTest  # noqa: E402

HEAD = ["INTITULE", "RESU", "NOM_CHAM", "NUME_ORDRE", "INST"]


class PostReleveT(LauncherTest):
    def action(self, text, python):
        """Make T with one ACTION and run `python` on it, after the study was made once."""
        if not (self.work / "study.base").exists():
            self.ok(self.run_study(STUDY + "FIN()\n"))
        return self.run_study(f"POURSUITE()\nT = POST_RELEVE_T(ACTION=_F(INTITULE='it', RESULTAT=R, {text}))\nt = T.EXTR_TABLE()\n{python}\nFIN()\n")

    def test_extraction(self):
        self.ok(self.action("INST=1.0, GROUP_NO='TOP', NOM_CHAM='DEPL', NOM_CMP=('DX', 'LAGS_C'), OPERATION='EXTRACTION'", f"""
assert t.para == {HEAD} + ['NOEUD', 'ABSC_CURV', 'COOR_X', 'COOR_Y', 'COOR_Z', 'DX', 'LAGS_C'], t.para
assert t.type == ['K16', 'K8', 'K16', 'I', 'R', 'K8'] + ['R'] * 6, t.type
v = t.values()
assert v['NOEUD'] == ['N4', 'N5', 'N6'] and v['DX'] == [4, 5, 6] and v['LAGS_C'] == [None, -25, None]
assert v['ABSC_CURV'] == [0, 1, 2] and v['COOR_X'] == [0, 1, 2] and v['COOR_Y'] == [1, 1, 1]
assert v['INTITULE'] == ['it'] * 3 and v['RESU'] == ['R'] * 3 and v['NUME_ORDRE'] == [2] * 3
TEST_TABLE(TABLE=T, NOM_PARA='DX', TYPE_TEST='MAX', VALE_CALC=6.0)
"""))

    def test_nodes_without_the_component_are_left_out(self):
        self.ok(self.action("NUME_ORDRE=(1, 2), GROUP_MA='BODY', NOM_CHAM='DEPL', NOM_CMP='LAGS_C', OPERATION='EXTRACTION'",
                            "assert t.values()['NOEUD'] == ['N2', 'N5'] * 2 and t.values()['INST'] == [0.5, 0.5, 1, 1]"))

    def test_all_instants_and_all_components(self):
        self.ok(self.action("TOUT_ORDRE='OUI', NOEUD=('N3', 'N1'), NOM_CHAM='DEPL', TOUT_CMP='OUI', OPERATION='EXTRACTION'", """
assert t.values()['DX'] == [0, 0, 1.5, 0.5, 3, 1] and t.values()['NOEUD'] == ['N3', 'N1'] * 3 and t.values()['ABSC_CURV'][1] == 2
"""))

    def test_instants_of_a_list_that_are_not_there_are_told(self):
        run = self.action("LIST_INST=DEFI_LIST_REEL(VALE=(0.5, 0.7, 1.0)), NOEUD='N1', NOM_CHAM='DEPL', NOM_CMP='DX', OPERATION='EXTRACTION'",
                          "assert t.values()['INST'] == [0.5, 1.0], t")
        self.assertEqual(run.status, 0, run.err)
        self.assertIn("<A> <FIELDS_5>", run.err)
        self.assertIn("no instant 0.7", run.err)
        self.refused(self.action("LIST_INST=DEFI_LIST_REEL(VALE=(0.2, 0.7)), NOEUD='N1', NOM_CHAM='DEPL', NOM_CMP='DX', OPERATION='EXTRACTION'", ""),
                     "TEST_RESU_1", "0.2")

    def test_fields_of_cells_are_averaged_at_their_nodes(self):
        self.ok(self.action("INST=1.0, NOEUD=('N1', 'N2', 'N3'), NOM_CHAM='STAND_IN', NOM_CMP='JEU', OPERATION='EXTRACTION'",
                            "assert t.values()['JEU'] == [0.5, 0.375, 0.25], t"))  # the first cell's value stands in for none

    def test_values_at_nodes_of_cells_are_averaged(self):
        self.ok(self.action("INST=1.0, NOEUD=('N1', 'N2', 'N5'), NOM_CHAM='SIEF_ELNO', NOM_CMP='SIYY', OPERATION='EXTRACTION'",
                            "assert t.values()['SIYY'] == [1, 3.5, 5.5], t"))

    def test_mean_of_a_linear_field_along_a_line(self):
        self.ok(self.action("INST=1.0, GROUP_NO='TOP', NOM_CHAM='DEPL', NOM_CMP='DX', OPERATION='MOYENNE'", """
found = dict(zip(t.QUANTITE, t.DX))
expected = dict(MOMENT_0=5, MOMENT_1=2, MINIMUM=4, MAXIMUM=6, MOYE_INT=4, MOYE_EXT=6)
assert found.keys() == expected.keys() and all(abs(found[k] - expected[k]) < 1e-14 for k in found), found
"""))

    def test_a_mean_along_a_way_that_turns_back_is_told(self):
        """It was a wrong number in silence: the nodes of a skin of quadratic cells come as ends and middles."""
        run = self.action("INST=1.0, NOEUD=('N4', 'N6', 'N5'), NOM_CHAM='DEPL', NOM_CMP='DX', OPERATION='MOYENNE'", "")
        self.assertEqual(run.status, 0, run.out + run.err)
        self.assertIn("<A> <POST_10>", run.err)
        self.assertIn("N6", run.err)
        self.assertNotIn("POST_10", self.action("INST=1.0, GROUP_NO='TOP', NOM_CHAM='DEPL', NOM_CMP='DX', OPERATION='MOYENNE'", "").err)

    #: Python that makes a mesh of line cells, and a field F on it, ten times the place; vertices N1 N2 N3 at x = 0, 1, 2, middles N4 N5
    LINES = """
DEBUT()
import numpy
from lacon.core import current
from lacon.core.hdf5 import text_type
def mesh(points, cells, groups, node_groups=()):
    def fill(file):
        file.attrs['dimension'], file['coordinates'] = 2, numpy.array([[*p, 0] for p in points], float)
        part = file.create_group('cells')
        part.attrs.create('types', ['SEG3', 'QUAD4'], dtype=text_type())
        part['type'] = numpy.array([0 if len(c) == 3 else 1 for c in cells], numpy.int8)
        part['offset'] = numpy.cumsum([0, *map(len, cells)])
        part['nodes'] = numpy.concatenate(cells).astype(numpy.int32)
        for kind, given in (('cells', groups), ('nodes', dict(node_groups))):
            part = file.create_group(f'groups/{kind}')
            part.create_dataset('name', data=list(given), dtype=text_type())
            part['offset'] = numpy.cumsum([0, *map(len, given.values())])
            part['values'] = numpy.array([i for members in given.values() for i in members], numpy.int32)
    return current.study.base.write_concept('mesh', 'M', 'BY_HAND', {}, fill)
def field(m, n):
    def fill(file):
        file.attrs.update(name='F', quantity='DEPL_R', mesh=m.id, location='NOEU')
        file.attrs.create('components', ['DX', 'DY'], dtype=text_type())
        file['support'], file['values'] = list(range(n)), m.getCoordinates().toNumpy()[:, :2] * 10
    return current.study.base.write_concept('field', 'F', 'CREA_CHAMP', {}, fill)
def table(**more):
    return POST_RELEVE_T(ACTION=_F(**{'INTITULE': 'it', 'CHAM_GD': F, 'NOM_CMP': ('DX', 'DY'), 'OPERATION': 'EXTRACTION', **more})).EXTR_TABLE()
M = mesh([(0, 0), (1, 0), (2, 0), (.5, 0), (1.5, 0), (0, 1), (1, 1)], [[1, 0, 3], [1, 2, 4], [0, 1, 6, 5]],
         {'L': [0, 1], 'BACK': [1, 0], 'A': [0], 'B': [1], 'BODY': [2]}, {'NL': [0, 1, 2, 3, 4], 'ALL': list(range(7)), 'ORDER': [0, 3, 1, 4, 2]}.items())
F = field(M, 7)
"""

    def test_nodes_of_lines_come_along_their_chain(self):
        """They came by their numbers, middles last: the abscissa ran back and forth, and integrals over it were wrong in silence."""
        self.ok(self.run_study(self.LINES + """
t = table(GROUP_MA='L')  # against x, as the first cell
assert t.NOEUD.values() == ['N3', 'N5', 'N2', 'N4', 'N1'] and t.ABSC_CURV.values() == [0, .5, 1, 1.5, 2], t
assert t.DX.values() == [20, 15, 10, 5, 0], t
assert table(GROUP_MA='BACK').NOEUD.values() == ['N1', 'N4', 'N2', 'N5', 'N3']
assert table(GROUP_MA=('A', 'B')).NOEUD.values() == table(MAILLE=('M1', 'M2')).NOEUD.values() == t.NOEUD.values()
assert table(GROUP_NO='ORDER').NOEUD.values() == ['N1', 'N4', 'N2', 'N5', 'N3']  # in the group's order
near = lambda found, expected: max(abs(a - b) for a, b in zip(found, expected, strict=True)) < 1e-12
assert near(table(GROUP_MA='BACK', TRAC_NOR='OUI').TRAC_NOR.values(), [0] * 5)
# two chains, a closed one, and cells that are no lines: by their numbers
corners = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1)]
M = mesh(corners, [[0, 1, 4], [1, 2, 5], [2, 3, 6], [3, 0, 7], [0, 1, 2, 3]], {'ROUND': [0, 1, 2, 3], 'TWO': [0, 2], 'BODY': [4], 'U': [2, 1, 0]})
F = field(M, 8)
assert table(GROUP_MA='ROUND').NOEUD.values() == [f'N{i}' for i in range(1, 9)]
assert table(GROUP_MA='TWO').NOEUD.values() == ['N1', 'N2', 'N3', 'N4', 'N5', 'N7']
assert table(GROUP_MA='BODY').NOEUD.values() == ['N1', 'N2', 'N3', 'N4']
assert table(GROUP_MA='U').NOEUD.values() == ['N1', 'N5', 'N2', 'N6', 'N3', 'N7', 'N4']
FIN()
"""))

    def test_an_abscissa_that_turns_back_is_told(self):
        """Of nodes of a line, in whichever group; not of a body, of nodes in an order that was asked for, nor of sums."""
        def told(last):
            run = self.run_study(f"{self.LINES}\n{last}\nFIN()\n")
            self.assertEqual(run.status, 0, run.out + run.err)
            return run.err
        self.assertIn("2 time(s), first at N3", told("table(GROUP_NO='NL')"))
        self.assertIn("<A> <POST_11>", told("table(GROUP_MA='A', GROUP_NO='NL')"))
        bent = "M = mesh([(0, 0), (2, 0), (2, 2), (1, 0), (2, 1)], [[0, 1, 3], [1, 2, 4]], {}, {'NL': [0, 1, 2, 4, 3]}.items()); F = field(M, 5)"
        self.assertIn("<A> <POST_11>", told(f"{bent}\ntable(GROUP_NO='NL')"))
        for silent in ("table(GROUP_MA='L')", "table(GROUP_NO='ORDER')", "table(GROUP_NO='ALL')", "table(GROUP_MA='BODY')", "table(NOEUD=('N1', 'N3', 'N2'))",
                       "table(GROUP_NO='NL', OPERATION='MOYENNE_ARITH')", "table(GROUP_NO='NL', OPERATION='EXTREMA')",
                       "table(GROUP_NO='NL', NOM_CMP=None, RESULTANTE='DX')"):
            self.assertNotIn("POST_1", told(silent), silent)

    def test_axes_of_a_way_that_turns_back(self):
        """It was said that VECT_Y is missing."""
        for asked in ("TRAC_NOR='OUI'", "REPERE='LOCAL'"):
            self.refused(self.run_study(f"{self.LINES}\ntable(GROUP_NO='NL', {asked})\nFIN()\n"), "<F> <POST_12>", "(2, 0, 0)", "NOEUD_ORDO")

    def test_moments_of_a_field_with_a_kink(self):
        self.ok(self.action(
            "INST=1.0, NOEUD=('N1', 'N2', 'N6', 'N5'), NOM_CHAM='DEPL', NOM_CMP='DX', OPERATION='MOYENNE'", """
found = dict(zip(t.QUANTITE, t.DX))
l = 2 + 2**0.5
xs, fs = [0, 1, 1 + 2**0.5, l], [1, 2, 6, 5]
import numpy
s = numpy.linspace(0, l, 2000001)
f = numpy.interp(s, xs, fs)
integral = lambda g: ((g[1:] + g[:-1]) / 2 * numpy.diff(s)).sum()
assert abs(found['MOMENT_0'] - integral(f) / l) < 1e-9 and abs(found['MOMENT_1'] - 12 / l**2 * integral(f * (s - l / 2))) < 1e-9
"""))

    def test_extremes(self):
        self.ok(self.action("INST=1.0, GROUP_NO='TOP', NOM_CHAM='DEPL', TOUT_CMP='OUI', OPERATION='EXTREMA'", """
assert [(r['EXTREMA'], r['NOEUD'], r['CMP'], r['VALE']) for r in t] == [
    ('MAX', 'N6', 'DX', 6), ('MIN', 'N4', 'DX', 4), ('MAXI_ABS', 'N6', 'DX', 6), ('MINI_ABS', 'N4', 'DX', 4),
    ('MAX', 'N5', 'LAGS_C', -25), ('MIN', 'N5', 'LAGS_C', -25), ('MAXI_ABS', 'N5', 'LAGS_C', 25), ('MINI_ABS', 'N5', 'LAGS_C', 25)]
"""))

    def test_arithmetic_mean(self):
        self.ok(self.action("INST=1.0, GROUP_MA='BODY', NOM_CHAM='DEPL', NOM_CMP='DX', OPERATION='MOYENNE_ARITH'",
                            "assert t.rows[0]['MOYENNE'] == 3.5 and t.rows[0]['CMP'] == 'DX'"))

    def test_resultant_and_moment(self):
        run = self.action("INST=1.0, GROUP_NO='TOP', NOM_CHAM='DEPL', RESULTANTE=('DX', 'LAGS_C'), MOMENT=('DRX', 'DRY', 'DRZ'), POINT=(1., 0.), "
                          "OPERATION='EXTRACTION'", """
assert t.para[-5:] == ['RESULT_X', 'RESULT_Y', 'MOMENT_X', 'MOMENT_Y', 'MOMENT_Z'] and len(t) == 1
assert [t.rows[0][n] for n in t.para[-5:]] == [15, -25, 0, 0, -15], t
""")
        self.assertEqual(run.status, 0, run.err)

    def test_a_resultant_has_the_names_of_its_components(self):
        """Without MOMENT; with it each component is of the axis that its name ends in: u = (0, 0, 3) at (0, 1), (1, 1), (2, 1) turns about X and Y."""
        self.ok(self.action("INST=1.0, GROUP_NO='TOP', NOM_CHAM='DEPL', RESULTANTE=('LAGS_C', 'DX'), OPERATION='EXTRACTION'", """
assert t.para[-2:] == ['LAGS_C', 'DX'] and [t.rows[0][n] for n in t.para[-2:]] == [-25, 15] and len(t) == 1, t
"""))
        self.ok(self.run_study(STUDY + self.field("DEPL_R", ["DX", "DY", "DZ"], [[0.0, 0.0, 3.0]] * 3) + """
def resultant(**more):
    return table(NOM_CMP=None, RESULTANTE='DZ', **more)
t = resultant()
assert t.para[-1] == 'DZ' and t.DZ == [9.0] and not any(name.startswith('RESULT') for name in t.para), t
t = resultant(MOMENT=('DRX', 'DRY', 'DRZ'), POINT=(0.0, 0.0))
assert t.para[-4:] == ['RESULT_Z', 'MOMENT_X', 'MOMENT_Y', 'MOMENT_Z'] and [t.rows[0][n] for n in t.para[-4:]] == [9, 9, -9, 0], t
FIN()
"""))

    def field(self, quantity, components, values):
        """Python that makes a field F of its own at nodes 4, 5 and 6, at (0, 1), (1, 1) and (2, 1)."""
        return f"""
from lacon.core import current
from lacon.core.hdf5 import text_type
def fill(file):
    file.attrs.update(name='F', quantity='{quantity}', mesh=M.id, location='NOEU')
    file.attrs.create('components', {components}, dtype=text_type())
    file['support'], file['values'] = [3, 4, 5], {values}
F = current.study.base.write_concept('field', 'F', 'CREA_CHAMP', {{}}, fill)
def table(**more):
    keywords = dict(NOM_CMP={components}) if not {{'INVARIANT', 'ELEM_PRINCIPAUX'}} & set(more) else {{}}
    return POST_RELEVE_T(ACTION=_F(INTITULE='it', CHAM_GD=F, **{{'OPERATION': 'EXTRACTION', 'GROUP_NO': 'TOP', **keywords, **more}})).EXTR_TABLE()
def near(found, expected):
    import numpy
    assert numpy.allclose(found, expected, rtol=0, atol=1e-13), (found, expected)
"""

    def test_vectors_in_other_axes(self):
        """u = (x, y), which is r e_r about the origin."""
        r = [1, 2**0.5, 5**0.5]
        self.ok(self.run_study(STUDY + self.field("DEPL_R", ["DX", "DY"], [[0.0, 1.0], [1.0, 1.0], [2.0, 1.0]]) + f"""
t = table(REPERE='POLAIRE')
near(t.DX, {r}); near(t.DY, [0, 0, 0])
t = table(REPERE='CYLINDRIQUE', ORIGINE=(1., 0.), AXE_Z=(0., 0., 1.))  # (1, 0) + r e_r
near(t.DX, [1 / 2**0.5, 1, 3 / 2**0.5]); near(t.DY, [-1 / 2**0.5, -1, -1 / 2**0.5])
t = table(REPERE='UTILISATEUR', ANGL_NAUT=90.)
near(t.DX, [1, 1, 1]); near(t.DY, [0, -1, -2])
t = table(REPERE='POLAIRE', OPERATION='MOYENNE_ARITH')
near(t.MOYENNE[1], 0)
t = table(TRAC_DIR='OUI', DIRECTION=(3., 4.))
near(t.TRAC_DIR, [.8, 1.4, 2.])
t = table(REPERE='POLAIRE', ORIGINE=(1., 1.))  # node 5 is on the axis
near([a * a + b * b for a, b in zip(t.DX, t.DY)], [1, 2, 5])
FIN()
"""))

    def test_axes_along_a_line(self):
        """X goes along the nodes in their order, Y to its left or towards VECT_Y; at a corner X is half way."""
        self.ok(self.run_study(STUDY + self.field("DEPL_R", ["DX", "DY"], [[0.0, 1.0], [1.0, 1.0], [2.0, 1.0]]) + """
t = table(REPERE='LOCAL')
near(t.DX, [0, 1, 2]); near(t.DY, [1, 1, 1])
t = table(REPERE='LOCAL', VECT_Y=(5., -2.))
near(t.DX, [0, 1, 2]); near(t.DY, [-1, -1, -1])
t = table(REPERE='LOCAL', GROUP_NO=None, NOEUD=('N6', 'N5', 'N4'))
near(t.DX, [-2, -1, 0]); near(t.DY, [-1, -1, -1])
t = POST_RELEVE_T(ACTION=_F(INTITULE='corner', RESULTAT=R, INST=1.0, NOM_CHAM='DEPL', NOM_CMP='DX', NOEUD=('N1', 'N2', 'N5'), OPERATION='EXTRACTION', REPERE='LOCAL'))
near(t.EXTR_TABLE().DX, [1, 2**0.5, 0])
FIN()
"""))

    def test_traces_on_the_line(self):
        """Along the nodes the normal is to the left: Y; backwards -Y; in the axes of the line always Y. Of a tensor its product with it."""
        self.ok(self.run_study(STUDY + self.field("DEPL_R", ["DX", "DY"], [[0.0, 1.0], [1.0, 2.0], [2.0, 3.0]]) + """
near(table(TRAC_NOR='OUI').TRAC_NOR, [1, 2, 3])
near(table(TRAC_NOR='OUI', VECT_Y=(0., -1.)).TRAC_NOR, [-1, -2, -3])
near(table(TRAC_NOR='OUI', GROUP_NO=None, NOEUD=('N6', 'N5', 'N4')).TRAC_NOR, [-3, -2, -1])
near(table(TRAC_NOR='OUI', REPERE='LOCAL').TRAC_NOR, [1, 2, 3])
FIN()
"""))
        names = ["SIXX", "SIYY", "SIZZ", "SIXY"]
        self.ok(self.run_study(STUDY + self.field("SIEF_R", names, [[3.0, 4.0, 10.0, 2.0], [5.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 7.0]]) + """
t = table(TRAC_NOR='OUI')
near(t.TR_NOR_1, [2, 0, 7]); near(t.TR_NOR_2, [4, 0, 0]); near(t.TR_NOR_3, [0, 0, 0])
FIN()
"""))

    def test_a_vector_that_is_not_whole_has_no_components_in_other_axes(self):
        self.ok(self.run_study(STUDY + self.field("DEPL_R", ["DX", "DY"], [[0.0, 1.0], [1.0, 1.0], [2.0, 1.0]]).replace(
            "F = current", "    file['present'] = [[1, 1], [1, 0], [1, 1]]\nF = current") + """
t = table(REPERE='UTILISATEUR', ANGL_NAUT=90.)
assert [x is None for x in t.DX] == [False, True, False] and [x is None for x in t.DY] == [False, True, False], t
FIN()
"""))

    def test_tensors(self):
        names = ["SIXX", "SIYY", "SIZZ", "SIXY"]
        self.ok(self.run_study(STUDY + self.field("SIEF_R", names, [[3.0, 3.0, 10.0, 2.0], [5.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 7.0]]) + """
t = table(INVARIANT='OUI')
near(t.VMIS, [(.5 * (4**2 + 5**2 + 9**2))**.5, 5, 7 * 3**.5]); near(t.TRESCA, [9, 5, 14]); near(t.TRACE, [16, 5, 0]); near(t.DETER, [50, 0, 0])
t = table(ELEM_PRINCIPAUX='OUI')
near(t.PRIN_1, [1, 0, -7]); near(t.PRIN_2, [5, 0, 0]); near(t.PRIN_3, [10, 5, 7])
near([t.VECT_2_X[0], t.VECT_2_Y[0], t.VECT_3_Z[0]], [.5**.5, .5**.5, 1])
t = table(TRAC_DIR='OUI', DIRECTION=(0., 2.))
near(t.TR_DIR_1, [2, 0, 7]); near(t.TR_DIR_2, [3, 0, 0]); near(t.TR_DIR_3, [0, 0, 0])
t = table(REPERE='UTILISATEUR', ANGL_NAUT=45.)
near(t.SIXX, [5, 2.5, 7]); near(t.SIYY, [1, 2.5, -7]); near(t.SIZZ, [10, 0, 0]); near(t.SIXY, [0, -2.5, 0])
t = table(INVARIANT='OUI', OPERATION='EXTREMA')
assert [(r['EXTREMA'], r['NOEUD'], r['CMP']) for r in t][0] == ('MAX', 'N6', 'VMIS')
FIN()
"""))

    def test_fields_of_their_own(self):
        self.ok(self.run_study(STUDY + """
from lacon.core import current
from lacon.core.hdf5 import text_type
def fill(file):
    file.attrs.update(name='NEUT', quantity='NEUT_R', mesh=M.id, location='NOEU')
    file.attrs.create('components', ['X1'], dtype=text_type())
    file['support'], file['values'] = [3, 5], [[7.], [9.]]
F = current.study.base.write_concept('field', 'F', 'CREA_CHAMP', {}, fill)
t = POST_RELEVE_T(ACTION=_F(INTITULE='it', CHAM_GD=F, GROUP_NO='TOP', TOUT_CMP='OUI', OPERATION='EXTRACTION')).EXTR_TABLE()
assert t.para == ['INTITULE', 'CHAM_GD', 'NOEUD', 'ABSC_CURV', 'COOR_X', 'COOR_Y', 'COOR_Z', 'X1'] and t.values()['X1'] == [7, 9], t
assert t.values()['ABSC_CURV'] == [0, 2]
t = CREA_TABLE(RESU=_F(CHAM_GD=F, NOM_CMP='X1', TOUT='OUI')).EXTR_TABLE()
assert t.values()['NOEUD'] == ['N4', 'N6'] and t.para[0] == 'CHAM_GD', t
FIN()
"""))

    def test_a_mean_along_a_line_leaves_out_where_there_is_no_gap(self):
        """JEU = -1 without a master counted as a gap. What stands in for a value (LAGS_C beside its carriers) is taken as it is shown."""
        self.ok(self.run_study(self.LINES + """
def mean(markers, kind=3):
    def fill(file):
        file.attrs.update(name='F', quantity='DEPL_R', mesh=M.id, location='NOEU')
        file.attrs.create('components', ['DX'], dtype=text_type())
        x = M.getCoordinates().toNumpy()[:5, :1]
        without = numpy.isin(range(1, 6), markers)[:, None]
        file['support'], file['values'] = list(range(5)), numpy.where(without, -1.0, 10 * x)
        file['present'] = numpy.where(without, kind, 1).astype(numpy.uint8)
    one = current.study.base.write_concept('field', 'F', 'CREA_CHAMP', {}, fill)
    return table(CHAM_GD=one, GROUP_MA='BACK', NOM_CMP='DX', OPERATION='MOYENNE').DX.values()  # along N1 N4 N2 N5 N3: x = 0 ... 2
near = lambda found, expected: max(abs(a - b) for a, b in zip(found, expected, strict=True)) < 1e-12
assert near(mean([]), [10, 20, 0, 20, 0, 20])
assert near(mean([1]), [12.5, 15, 5, 20, 5, 20]), mean([1])
assert near(mean([2]), [10, 20, 0, 20, 0, 20]), mean([2])
assert near(mean([1, 2, 3, 4, 5]), [-1, 0, -1, -1, -1, -1])
assert mean([3, 4, 5]) == [0, 10], mean([3, 4, 5])  # no piece of the line is left: the extremes alone
assert near(mean([1], kind=2), [9.875, 20.625, -1, 20, -0.4375, 20.1875]), mean([1], kind=2)
FIN()
"""))

    def test_moments_of_nodes_that_have_moved_are_told(self):
        """Moments take nodes where they are in the mesh: of a body that has turned they were those of another place in silence."""
        moment = "NOEUD=('N1', 'N2', 'N3'), NOM_CHAM='SIEF_ELNO', OPERATION='EXTRACTION', RESULTANTE='SIYY', MOMENT='DRZ', POINT=(0., 0.)"
        run = self.action(f"TOUT_ORDRE='OUI', {moment}", "assert t.values()['MOMENT_Z'] == [15.5] * 3, t")
        self.assertEqual((run.status, run.err.count("<I> <POST_13>")), (0, 1), run.err)
        # forces 1, 3.5, 6 along Y at x = 0, 1, 2, moved by 1, 2, 3
        for words in ("(0, 0, 41.5), not (0, 0, 15.5)", "at the instant 1 have", "150 %"):
            self.assertIn(words, run.err)
        self.assertNotIn("POST_13", self.action(f"INST=0.0, {moment}", "").err)
        self.assertNotIn("POST_13", self.action(f"INST=1.0, {moment.replace('POINT=(0., 0.)', 'POINT=(-1e3, 0.)')}", "").err)
        for file in (self.work / "study.base").rglob("mesh_*.h5"):  # as MODI_MAILLAGE with DEFORME leaves it
            with h5py.File(file, "a") as mesh:
                mesh["first_place"] = numpy.zeros(7)
        moved = self.action(f"INST=1.0, {moment}", "")
        self.assertEqual(moved.status, 0, moved.out + moved.err)
        self.assertNotIn("POST_13", moved.err)

    def test_axes_at_nodes_that_have_turned_are_told(self):
        """N4 goes from (0, 1) to (4, 1): by 76 degrees about the origin; in axes of the mesh alone nothing turns."""
        radial = "INST=1.0, GROUP_NO='TOP', NOM_CHAM='DEPL', NOM_CMP='DX', OPERATION='EXTRACTION'"
        run = self.action(f"{radial}, REPERE='POLAIRE'", "")
        self.assertEqual(run.status, 0, run.err)
        self.assertIn("<I> <MODIREPERE_6> ACTION[1]/REPERE", run.err)
        self.assertIn("at the instant 1 have turned some by 76 degrees", run.err)
        for silent in (radial, f"{radial.replace('1.0', '0.0')}, REPERE='POLAIRE'", f"{radial}, REPERE='UTILISATEUR', ANGL_NAUT=10.0"):
            self.assertNotIn("MODIREPERE_6", self.action(silent, "").err)

    def test_several_actions(self):
        self.ok(self.run_study(STUDY + """
T = POST_RELEVE_T(ACTION=(_F(INTITULE='a', RESULTAT=R, INST=1.0, NOEUD='N1', NOM_CHAM='DEPL', NOM_CMP='DX', OPERATION='EXTRACTION'),
                          _F(INTITULE='b', RESULTAT=R, INST=1.0, NOEUD='N2', NOM_CHAM='DEPL', NOM_CMP='LAGS_C', OPERATION='EXTRACTION')))
assert T.values()['DX'] == [1, None] and T.values()['LAGS_C'] == [None, -25]
FIN()
"""))

    def test_refused(self):
        good = {"INST": "1.0", "GROUP_NO": "'TOP'", "NOM_CHAM": "'DEPL'", "NOM_CMP": "'DX'", "OPERATION": "'EXTRACTION'"}
        calls = []
        for changes, word in (({"GROUP_NO": "'TOPP'"}, "TEST_RESU_9"), ({"INST": "0.7"}, "TEST_RESU_1"), ({"NOM_CHAM": "'DEPLA'"}, "TEST_RESU_3"),
                              ({"NOM_CMP": "'DZ'"}, "TEST_RESU_4"), ({"NOM_CHAM": "'SIEF_ELGA'", "NOM_CMP": "'SIYY'"}, "POST_1"),
                              ({"NOM_CMP": None, "RESULTANTE": "'DX'", "OPERATION": "'EXTREMA'"}, "POST_2"),
                              ({"NOM_CMP": "'LAGS_C'", "GROUP_NO": "'ONE'"}, "POST_3"),
                              ({"NOM_CMP": "('DX', 'LAGS_C')", "OPERATION": "'MOYENNE'"}, "POST_4"),
                              ({"GROUP_NO": "'ONE'", "OPERATION": "'MOYENNE'"}, "POST_5"), ({"GROUP_NO": "'ONE'", "REPERE": "'LOCAL'"}, "POST_5"),
                              ({"REPERE": "'LOCAL'", "VECT_Y": "(1., 0.)"}, "POST_9"), ({"VECT_Y": "(1., 0.)"}, "KEYWORD_10"),
                              ({"REPERE": "'UTILISATEUR'"}, "KEYWORD_2"), ({"ORIGINE": "(0., 0.)"}, "KEYWORD_10"),
                              ({"NOM_CMP": None, "RESULTANTE": "'DX'", "MOMENT": "'DX'", "POINT": "(0., 0.)"}, "KEYWORD_4"),
                              ({"NOM_CMP": None, "INVARIANT": "'OUI'"}, "POST_7"), ({"TRAC_DIR": "'OUI'"}, "KEYWORD_9"),
                              ({"TRAC_DIR": "'OUI'", "DIRECTION": "(0., 0.)"}, "POST_8"), ({"CHEMIN": "R"}, "KEYWORD_11"),
                              ({"NOM_CMP": None, "RESULTANTE": "'DX'", "REPERE": "'POLAIRE'"}, "KEYWORD_10")):
            given = ", ".join(f"{k}={v}" for k, v in {**good, **changes}.items() if v)
            calls.append((f"POST_RELEVE_T(ACTION=_F(INTITULE='it', RESULTAT=R, {given}))", word))
        self.all_refused(STUDY, calls)


if __name__ == "__main__":
    unittest.main()
