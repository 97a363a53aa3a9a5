"""What command files import of code_aster: CA, sympy and the tensors of manufactured solutions, refusals of what is not there."""

import sys
import unittest

sys.path.insert(0, __file__.rpartition("/")[0] or ".")
from support import STUDY, LauncherTest  # noqa: E402

try:
    import sympy
except ImportError:
    sympy = None

#: of code_aster's files: the symbolic way where sympy is there, the literal one otherwise
EITHER = """
DEBUT()
try:
    from code_aster.Utilities import sympy
    from code_aster.MacroCommands.Contrib.TensorModule import Tensor, grad
    X, Y = sympy.symbols('X Y')
    text = str(grad(Tensor([X**2 * Y, Y]))[0, 1])
    way = 'symbolic'
except ImportError:
    text, way = 'X**2', 'literal'
f = FORMULE(VALE=text, NOM_PARA=('X', 'Y'))
assert f(3, 5) == 9
print('the', way, 'way')
FIN()
"""


class Modules(LauncherTest):
    def test_numbers_that_aster_study_gives_to_commands_mean_nothing(self):
        self.ok(self.run_study("""
DEBUT(identifier='0:1')
M = LIRE_MAILLAGE(identifier='0:2', UNITE=20)
MAT = DEFI_MATERIAU(identifier='0:3', ELAS=_F(E=1, NU=0))
DEFI_GROUP(identifier='0:4', reuse=M, MAILLAGE=M, CREA_GROUP_MA=_F(NOM='ALL', TOUT='OUI'))
try:
    DEFI_LIST_REEL(identifier=5, VALE=1.0)
except AsterError as error:
    assert error.id_message == 'KEYWORD_3' and 'DEFI_LIST_REEL/identifier' in error.messages[0].where, error
FIN(identifier='0:6')
"""))
        self.assertNotIn("identifier", self.last_order("LIRE_MAILLAGE")["keywords"])

    def test_both_ways(self):
        run = self.ok(self.run_study(EITHER))
        self.assertIn("symbolic" if sympy else "literal", run.out)
        (self.work / "sympy.py").write_text("raise ImportError('there is no sympy')")
        self.assertIn("the literal way", self.ok(self.run_study(EITHER)).out)

    def test_modules_that_are_not_here(self):
        for statement, word in (("from Utilitai.Utmess import UTMESS", "Utilitai"), ("import code_aster.Supervis", "code_aster.Supervis"),
                                ("from code_aster.Utilities import logger", "logger"), ("import aster; aster.onFatalError()", "onFatalError"),
                                ("from code_aster import CA; CA.Model()", "Model")):
            run = self.refused(self.run_study(f"DEBUT()\n{statement}\n"), word, "STUDY_19", "study.comm:2")
            self.assertNotIn("<frozen", run.err)

    def test_a_mesh_that_is_read_into(self):
        self.ok(self.run_study("""
from code_aster import CA
CA.init()
mesh = CA.Mesh()
try:
    mesh.getNumberOfNodes()
except AttributeError as error:
    assert 'readMedFile' in str(error)
mesh.readMedFile('fort.20')
again = CA.Mesh()
again.readMedFile('mesh.med')
assert mesh.getNumberOfCells() == 3 == again.getNumberOfCells() and mesh is not again
MO = AFFE_MODELE(MAILLAGE=mesh, AFFE=_F(TOUT='OUI', PHENOMENE='MECANIQUE', MODELISATION='D_PLAN'))
assert MO.getMesh() is mesh and mesh.getName() == 'mesh'
CA.close()
"""))

    def test_methods_of_results_functions_and_tables(self):
        """What command files of versions 12 to 17 call beside values: the one process, order numbers, text of tables; tables without a concept."""
        run = self.ok(self.run_study(STUDY + """
from code_aster.CA import MPI
from Utilitai.Table import Table
from code_aster.Objects.table_py import Table as Same
import aster
assert MPI.ASTER_COMM_WORLD.Get_rank() == 0 == MPI.ASTER_COMM_WORLD.rank and CA.MPI.ASTER_COMM_WORLD.Get_size() == 1
assert R.getModel(1) is MO and R.getMaterialField(1) is CM
assert R.getIndexFromParameter('INST', 0.5, 'RELATIF', 1e-6) == 1 and R.getIndexFromParameter('INST', 0.7, throw_except=False) == -1
try:
    R.getIndexFromParameter('INST', 0.7, 'ABSOLU', 1e-3)
except ValueError as error:
    assert '0 instants at 0.7' in str(error) and 'INST 0.5' in str(error), error
assert RAMP.getValuesAsArray().tolist() == [[0, 0], [1, 1]]
assert (M.getInnerNodes(), M.getOuterNodes(), len(M.getInnerCells())) == (list(range(6)), [], 3)
t = Table(rows=[{'A': 1.0, 'B': 'x'}])
assert Same is Table and not hasattr(t, 'C') and t.A.values() == [1.0]
t.Impr()
t.Impr(FICHIER='t.txt', FORMAT='ASTER')
assert '#DEBUT_TABLE' in open('t.txt').read()
aster.affiche('MESSAGE', 'a word of the study')
R.printInfo()
try:
    R.getField('DEPL', 1).getValue
except AttributeError as error:
    assert "DEPL, a field, has no 'getValue' here; the nearest one is getValues" in str(error), error
FIN()
"""))
        for words in ("a word of the study", "NOEU_DEPL_R", "A +B"):
            self.assertRegex(run.out, words)

    def test_headers_of_versions_12_to_16(self):
        for header, end in (
                ("DEBUT(CODE=_F(NIV_PUB_WEB='INTERNET'), PAR_LOT='NON', MEMOIRE=_F(TAILLE_BLOC=800.), DEBUG=_F(SDVERI='OUI', JXVERI='OUI'))", "FIN()"),
                ("from Cata.cata import *\nfrom Accas import _F\nDEBUT()", "FIN(FORMAT_HDF='OUI')"),
                ("from code_aster.Cata.Syntax import _F, CO\nfrom code_aster.Cata.Commands import DEBUT, FIN\nDEBUT(ERREUR=_F(ERREUR_F='ABORT'))", "FIN()"),
                ("import code_aster\nfrom code_aster.Commands import *\ncode_aster.init('--test')", "code_aster.close()"),
                ("from code_aster import CA\nfrom code_aster.Commands import *\nCA.init('--test', ERREUR=_F(ALARME='EXCEPTION'))", "CA.close()")):
            self.ok(self.run_study(f"# coding=utf-8\n{header}\nL = DEFI_LIST_REEL(VALE=(0., 1.))\n{end}\n"))

    def test_exceptions_under_all_their_names(self):
        self.ok(self.run_study("""
import aster, libaster
from code_aster import CA
DEBUT()
for kind in (aster.error, aster.FatalError, libaster.AsterError, CA.AsterError):
    for other in (aster.NonConvergenceError, CA.IntegrationError, CA.ContactError, aster.BoucleContactError, libaster.TimeLimitError, kind):
        try:
            DEFI_LIST_REEL(VALE=(1., 0.))
        except other as error:
            assert other is kind and error.id_message == 'DEFI_LIST_1'
            break
        except kind:
            pass
    else:
        raise SystemExit(1)
FIN()
"""))

    def test_assertions(self):
        run = self.run_study("""
from code_aster import CA
CA.init('--test', ERREUR=_F(ALARME='ALARME'))
test = CA.TestCase()
test.assertEqual(1, 1)
test.assertAlmostEqual(1.0, 1.0 + 1e-9)
test.assertAlmostEqual(1.0, 1.1, delta=0.2, msg='near')
test.assertSequenceEqual([1, 2], [1, 2])
test.assertIsNone(None)
with test.assertRaises(ValueError):
    raise ValueError
with test.assertRaisesRegex(AsterError, 'DEFI_LIST_1'):
    DEFI_LIST_REEL(VALE=(1., 0.))
test.assertRaises(KeyError, {}.__getitem__, 1)
test.printSummary()
with test.assertRaises(ValueError):
    pass
test.assertTrue(False)
test.printSummary()
try:
    test.assertSomething()
except AttributeError as error:
    assert 'assertSomething' in str(error)
CA.close()
""")
        self.assertEqual((run.status, run.last), (5, "--- DIAGNOSTIC JOB : NOOK_TEST_RESU"), run.out + run.err)
        self.assertIn("assertions: 8 checks: 8 OK, 0 NOOK, 0 DIFF", run.out)
        self.assertIn("assertions: 10 checks: 8 OK, 2 NOOK, 0 DIFF", run.out)
        self.assertIn("NOOK assertRaises study.comm:16 ValueError not raised", run.out)


@unittest.skipUnless(sympy, "sympy is not installed")
class Tensors(unittest.TestCase):
    def setUp(self):
        from lacon.peer import tensors

        self.t = tensors
        self.X, self.Y, self.Z = sympy.symbols("X Y Z")

    def test_gradient_and_divergence(self):
        X, Y, Z, t = self.X, self.Y, self.Z, self.t
        U = t.Tensor([X**2 * Y, X * Z, Y * Z])
        self.assertEqual(t.grad(U), [[2 * X * Y, X**2, 0], [Z, 0, X], [0, Z, Y]])
        self.assertEqual(t.div(U), 2 * X * Y + Y)
        self.assertEqual(t.div(t.grad(U)), t.laplacien(U))
        self.assertEqual(t.laplacien(U), [2 * Y, 0, 0])
        self.assertEqual(t.grad(X * Y), [Y, X, 0])
        self.assertEqual(t.grad(t.Tensor([X * Y, X])), [[Y, X], [1, 0]])  # in the plane
        self.assertEqual(t.gradS(t.Tensor([X * Y, X])), [[Y, (X + 1) / 2], [(X + 1) / 2, 0]])

    def test_symbols_of_the_file_with_other_assumptions(self):
        x = sympy.Symbol("X", real=True)
        self.assertEqual(self.t.grad(self.t.Tensor([x**2, 0, 0]))[0, 0], 2 * x)

    def test_algebra(self):
        t, X = self.t, self.X
        A = t.Tensor([[1, X], [0, 2]])
        self.assertEqual(t.produitSimpleContracte(A, t.inverse(A)), [[1, 0], [0, 1]])
        self.assertEqual(t.transpose(A), [[1, 0], [X, 2]])
        self.assertEqual(2 * A - A / 2 + (-A), A / 2)
        self.assertEqual(X * A, A * X)
        self.assertEqual(sum([A, A]), 2 * A)
        self.assertEqual(t.produitSimpleContracte(A, t.Tensor([1, 1])), [1 + X, 2])
        self.assertEqual(t.produitSimpleContracte(t.Tensor([1, 2]), t.Tensor([3, X])), 3 + 2 * X)
        self.assertEqual(t.determinant(A), 2)
        self.assertEqual(t.trace(A), 3)
        self.assertEqual((A[0, 1], A[1], A.array.shape), (X, t.Tensor([0, 2]), (2, 2)))
        self.assertNotEqual(A, 2 * A)
        for bad in (lambda: A * A, lambda: A + 1):
            with self.assertRaises((TypeError, ValueError)):
                bad()

    def test_every_function_is_a_method(self):
        t, X, Y = self.t, self.X, self.Y
        A, u = t.Tensor([[2 + X**2, Y], [1, 3]]), t.Tensor([X * Y, X])
        for name in ("transpose", "inverse", "trace", "determinant", "diagonal", "norm", "grad", "div", "laplacien"):
            self.assertEqual(getattr(A, name)(), getattr(t, name)(A), name)
        self.assertEqual(u.gradS(), t.gradS(u))
        self.assertEqual((A.T.dot(u), A @ u, A.diagonal()), (t.produitSimpleContracte(t.transpose(A), u), A.produitSimpleContracte(u), [2 + X**2, 3]))
        self.assertEqual(A.produitDoubleContracte(A.inverse().T), 2)
        self.assertEqual(u.produitTensoriel(u).trace(), u.dot(u))

    def test_tensors_of_rank_0_are_expressions(self):
        """What products and invariants give has .array, works with numbers, expressions, tensors and sympy's functions, and prints as a formula."""
        t, X, Y = self.t, self.X, self.Y
        u = t.Tensor([X, Y])
        square = u.dot(u)
        self.assertEqual((type(square), square.rank, square.array.item(), str(square)), (t.Tensor, 0, X**2 + Y**2, "X**2 + Y**2"))
        for found, expected in ((square * square, (X**2 + Y**2)**2), (square / square, 1), (square + square - X, 2 * X**2 + 2 * Y**2 - X),
                                (1 - square, 1 - X**2 - Y**2), (X * square, X**3 + X * Y**2), (X / square, X / (X**2 + Y**2)),
                                (square**2, square * square), (sympy.sqrt(square), u.norm()), (t.sqrt(square), u.norm()),
                                (square.diff(X), 2 * X), (sympy.diff(square, Y), 2 * Y), (square.subs(X, 0), Y**2), (t.grad(square)[1], 2 * Y)):
            self.assertEqual(t.Tensor(found), expected)
        for found in (square * u, u * square):
            self.assertEqual(found, [X**3 + X * Y**2, X**2 * Y + Y**3])
        self.assertEqual(u / u.norm() * u.norm(), u)
        self.assertEqual(float(t.Tensor([3, 4]).norm()), 5.0)
        for bad in (lambda: u / u, lambda: float(u), lambda: u.transposed(), lambda: u**2, lambda: square + u):
            with self.assertRaises((AttributeError, TypeError, ValueError)):
                bad()

    def test_square_roots_of_symmetric_tensors(self):
        """The root of C = F'F against its definition and against the principal values: full, in blocks, with equal principal values."""
        import numpy

        t, X, Y, Z = self.t, self.X, self.Y, self.Z
        at = {X: 0.3, Y: 0.2, Z: 0.4}
        F = t.Tensor(sympy.eye(3)) + t.grad(t.Tensor([X * Y / 5, X**2 / 3, X * Y * Z / 4]))
        flat = t.Tensor(sympy.eye(3)) + t.grad(t.Tensor([X * Y / 5, X**2 / 3, Z]))
        for C in (F.T.dot(F), flat.T.dot(flat), t.Tensor([[4, 0], [0, X**2]]), t.Tensor([[2.0, 1.0, 1.0], [1.0, 2.0, 1.0], [1.0, 1.0, 2.0]])):
            root, given = (numpy.array(sympy.Matrix(tensor.array).subs(at).evalf(), float) for tensor in (C.sqrt(), C))
            numpy.testing.assert_allclose(root @ root, given, rtol=0, atol=1e-12)
            numpy.testing.assert_allclose(root, root.T, rtol=0, atol=1e-12)
            self.assertGreater(numpy.linalg.eigvalsh(root)[0], 0)
        with self.assertRaises(ValueError):
            F.sqrt()

    def test_isotropic_elasticity(self):
        """sigma = lambda tr(e) I + 2 mu e, and a uniaxial stress gives back Young's modulus and Poisson's ratio."""
        E, nu = sympy.Integer(210), sympy.Rational(3, 10)
        C = self.t.HookeIsotropic(E, nu)
        e = sympy.symbols("e")
        self.assertEqual(C.produitDoubleContracte(self.t.Tensor([[e, 0, 0], [0, -nu * e, 0], [0, 0, -nu * e]])), [[E * e, 0, 0], [0, 0, 0], [0, 0, 0]])
        shear = C.produitDoubleContracte(self.t.Tensor([[0, e, 0], [e, 0, 0], [0, 0, 0]]))
        self.assertEqual(shear[0, 1], 2 * e * E / (2 * (1 + nu)))
        self.assertIs(self.t.HookeTensor.HookeIsotropic, self.t.HookeIsotropic)

    def test_a_manufactured_solution_balances(self):
        """div(F S) of St-Venant-Kirchhoff against finite differences of the same stress."""
        t, X, Y, Z = self.t, self.X, self.Y, self.Z
        U = t.Tensor([X * Y * Z**2 / 5, X**2 / 7, Y * Z / 9])
        F = t.grad(U) + t.Tensor(sympy.eye(3))
        strain = (t.produitSimpleContracte(t.transpose(F), F) - t.Tensor(sympy.eye(3))) / 2
        P = t.produitSimpleContracte(F, t.HookeIsotropic(1, 0).produitDoubleContracte(strain))
        at = {X: 0.3, Y: -0.4, Z: 0.7}
        step = 1e-4
        for i in range(3):
            difference = sum((float(P[i, j].subs({**at, v: at[v] + step})) - float(P[i, j].subs({**at, v: at[v] - step}))) / (2 * step)
                             for j, v in enumerate((X, Y, Z)))
            self.assertAlmostEqual(float(t.div(P)[i].subs(at)), difference, delta=1e-7)


if __name__ == "__main__":
    unittest.main()
