"""Formulae at many points: whole arrays where the expression allows it, point by point elsewhere, and the questions of operators."""

import json
import math
import socket
import sys
import threading
import unittest

import numpy as np

sys.path.insert(0, __file__.rpartition("/")[0] or ".")
from support import LauncherTest  # noqa: E402

from lacon.base import expressions  # noqa: E402
from lacon.base.expressions import Expression  # noqa: E402
from lacon.core.messages import AsterError  # noqa: E402

X = np.linspace(-2, 3, 101)
Y = np.linspace(1, 2, 101)


def clip(x):
    return min(max(x, 0.0), 1.0)


class Values(unittest.TestCase):
    def values(self, text, **values):
        """(on whole arrays or nothing, as operators get them, point by point)"""
        expression = Expression(text, ["X", "Y"], values)
        points = {"X": X, "Y": Y}
        single = np.array([expression.value({"X": float(x), "Y": float(y)}, "F") for x, y in zip(X, Y)], float)
        return expression._on_arrays(points, len(X), "F"), expression.values_at(points, len(X), "F"), single

    def test_elementwise_expressions_are_computed_on_whole_arrays(self):
        for text, more in (("2 * X**2 - X / Y + 1", {}), ("-a * sin(pi * X) + atan2(X, Y) + log(Y, 10) + log(Y)", {"a": 3}),
                           ("max(X, 0.5, Y) + min(X, 0) + abs(X)", {}), ("m.cos(X)", {"m": math}),
                           ("np.cos(X) * np.exp(-Y)", {"np": np}), ("pow(Y, 2) + hypot(X, Y) % 2", {}), ("5", {}),
                           ("s(X)", {"s": math.sin}), (" + ".join(f"{i} * X**{i % 5}" for i in range(400)), {})):
            with self.subTest(text[:40]):
                arrays, values, single = self.values(text, **more)
                self.assertIsNotNone(arrays)
                np.testing.assert_array_equal(values, arrays)
                np.testing.assert_allclose(values, single, rtol=1e-13, atol=1e-13 * abs(single).max())

    def test_any_other_expression_is_computed_point_by_point(self):
        for text, more in (("X if X > 0 else -Y", {}), ("clip(X)", {"clip": clip}), ("sum([i * X for i in range(3)])", {}),
                           ("max([X, Y])", {}), ("int(X)", {}), ("(lambda t: t * X)(Y)", {}), ("X > 0 and Y", {}), ("np.where(X > 0, 1, 2)", {"np": np}),
                           ("{True: 1, False: 2}[X < 0]", {}), ("sin(X)", {"sin": clip}), ("1.0 if type(X) is float else 0.0", {}),
                           ("np.any(X > 0)", {"np": np})):
            with self.subTest(text):
                arrays, values, single = self.values(text, **more)
                self.assertIsNone(arrays)
                np.testing.assert_array_equal(values, single)

    def test_what_numpy_rounds_otherwise_is_computed_point_by_point(self):
        """Integers of any size are Python's: 10**400 is no number of numpy's."""
        arrays, values, single = self.values("X * (10**400 / 10**399)")
        self.assertIsNotNone(arrays)
        np.testing.assert_array_equal(values, single)

    def refused(self, text, *words):
        with self.assertRaises(AsterError) as caught:
            Expression(text, ["X", "Y"], {}).values_at({"X": X, "Y": Y}, len(X), "F")
        self.assertEqual(caught.exception.id_message, "FORMULE_2")
        for word in words:
            self.assertIn(word, str(caught.exception))

    def test_the_first_point_without_value_is_named(self):
        self.refused("sqrt(X)", "X = -2.0, Y = 1.0", "ValueError")
        self.refused("X**0.5", "X = -2.0", "not a finite real number")
        self.refused("1 / (X + 2 if X < 0 else 1)", "X = -2.0", "ZeroDivisionError")
        self.refused("'text'", "not a finite real number")
        self.refused("'1.5'", "not a finite real number")  # a text is no number, whatever it says
        self.refused("exp(1000 * Y)", "OverflowError")
        self.refused("1e308 * 10 * Y", "inf")
        self.refused("exit()", "SystemExit")  # which would end the computation as if it were done
        self.refused("1j * X", "not a finite real number")

    def test_one_point_needs_no_arrays(self):
        np.testing.assert_array_equal(Expression("X if X > 0 else 0", ["X"], {}).values_at({"X": np.array([2.0])}, 1, "F"), [2.0])


class Base:
    """Stands in for a base with one formula."""

    def __init__(self, expression):
        self.label, self.id = "F", "formula_1"
        self.expression = lambda: expression

    def concept(self, identifier):
        return self


class Questions(unittest.TestCase):
    def ask(self, expression, parameters, columns):
        ours, theirs = socket.socketpair()
        with theirs, ours.makefile("rwb") as stream:
            server = threading.Thread(target=expressions.serve, args=(theirs.makefile("rwb"), Base(expression)))
            server.start()
            count = len(columns[0]) if columns else 1
            stream.write(json.dumps({"formula": "formula_1", "parameters": parameters, "count": count}).encode() + b"\n")
            stream.write(np.array(columns, "<f8").tobytes())
            stream.flush()
            answer = json.loads(stream.readline())
            values = np.frombuffer(stream.read(8 * count), "<f8") if "count" in answer else None
            ours.shutdown(socket.SHUT_WR)
            server.join(10)
            self.assertFalse(server.is_alive(), "the end of the questions ends the answers")
            ours.close()
        return answer, values

    def test_values(self):
        answer, values = self.ask(Expression("X - 2 * Y", ["X", "Y"], {}), ["X", "Y"], [[1, 2, 3], [10, 20, 30]])
        self.assertEqual(answer, {"count": 3})
        np.testing.assert_array_equal(values, [-19, -38, -57])

    def test_an_error_with_its_point(self):
        answer, _ = self.ask(Expression("1 / X", ["X"], {}), ["X"], [[1, 0]])
        self.assertEqual(answer["error"]["id"], "FORMULE_2")
        self.assertIn("X = 0.0", answer["error"]["text"])


class InCommandFiles(LauncherTest):
    def test_any_value_of_the_study_may_be_used_and_comes_back(self):
        self.ok(self.run_study("""
DEBUT()
import numpy as np
table = [1.0, 2.0, 4.0]
f = FORMULE(NOM_PARA='X', VALE='np.interp(X, t, table) + len(s)', t=(0, 1, 2), s='ab')
assert f(1.5) == 5
FIN()
"""))
        self.write("more.comm", "POURSUITE()\nassert f(1.5) == 5\nFIN()\n")
        self.ok(self.launch("more.comm", "--base", "study.base"))


    def test_functions_of_two_parameters_constants_and_samples(self):
        """A plane through two lines; LOG between functions; what POURSUITE finds again."""
        self.ok(self.run_study("""
DEBUT()
low = DEFI_FONCTION(NOM_PARA='X', VALE=(0, 0, 1, 1), PROL_DROITE='LINEAIRE')
high = DEFI_FONCTION(NOM_PARA='X', VALE=(0, 10, 1, 12), PROL_DROITE='LINEAIRE')
n = DEFI_NAPPE(NOM_PARA='INST', PARA=(0, 2), FONCTION=(low, high), PROL_DROITE='CONSTANT')
assert (n(0, 0.5), n(2, 0.5), n(1, 0.5), n(5, 0.5)) == (0.5, 11, 5.75, 11) and n.getVariables() == ['INST', 'X']
m = DEFI_NAPPE(NOM_PARA='INST', PARA=(1, 100), NOM_PARA_FONC='X', INTERPOL='LOG', PROL_GAUCHE='LINEAIRE',
               DEFI_FONCTION=(_F(VALE=(0, 1, 1, 1)), _F(VALE=(0, 100, 1, 100))))
assert abs(m(10, 0.3) - 10) < 1e-12 and abs(m(0.1, 0.3) - 0.1) < 1e-12
c = DEFI_CONSTANTE(VALE=3)
assert c(7) == 3 and c(-1e9) == 3
g = FORMULE(NOM_PARA='X', VALE='X**2 + c(X)', c=c)
s = CALC_FONC_INTERP(FONCTION=g, VALE_PARA=(0, 1, 2), PROL_DROITE='CONSTANT')
assert s.Valeurs() == [[0, 1, 2], [3, 4, 7]] and s(0.5) == 3.5 and s(9) == 7
FIN()
"""))
        self.write("more.comm", "POURSUITE()\nassert n(1, 0.5) == 5.75 and abs(m(10, 0.3) - 10) < 1e-12 and c(0) == 3\nFIN()\n")
        self.ok(self.launch("more.comm", "--base", "study.base"))

    def test_functions_of_two_parameters_that_are_wrong(self):
        for line, *words in (("DEFI_NAPPE(NOM_PARA='INST', PARA=(0, 0), FONCTION=(F, F))", "DEFI_FONCTION_1", "PARA"),
                             ("DEFI_NAPPE(NOM_PARA='INST', PARA=(0, 1), FONCTION=F)", "DEFI_FONCTION_5"),
                             ("DEFI_NAPPE(NOM_PARA='X', PARA=(0, 1), FONCTION=(F, F))", "DEFI_FONCTION_7", "another one than X"),
                             ("DEFI_NAPPE(NOM_PARA='INST', PARA=(0, 1), FONCTION=(F, F))(2, 0)", "DEFI_FONCTION_3"),
                             ("CALC_FONC_INTERP(FONCTION=FORMULE(NOM_PARA=('X', 'Y'), VALE='X'), VALE_PARA=(0, 1))", "DEFI_FONCTION_6", "X, Y"),
                             ("CALC_FONC_INTERP(FONCTION=F, VALE_PARA=(1, 0))", "DEFI_FONCTION_1")):
            with self.subTest(line):
                self.refused(self.run_study(f"DEBUT()\nF = DEFI_FONCTION(NOM_PARA='X', VALE=(0, 0, 1, 1))\nA = {line}\n", "--fresh"), *words)


class Names(LauncherTest):
    def test_what_the_study_calls_as_mathematics_does_is_the_studys(self):
        """Numbers, functions and concepts of its own, as in any Python expression; what numpy has by these names, and what is imported, changes nothing."""
        self.ok(self.run_study("""
DEBUT()
from math import *
from numpy import *
assert FORMULE(NOM_PARA='X', VALE='e * sqrt(X) + max(X, pi)')(4.) == 2 * e + 4
e, sum, gamma = 3.0, 4, DEFI_CONSTANTE(VALE=5.0)
def sqrt(x):
    return -x
F = FORMULE(NOM_PARA='X', VALE='e * X + sum + gamma(X) + sqrt(X)')
assert F(2.) == 6 + 4 + 5 - 2, F(2.)
assert FORMULE(NOM_PARA='X', VALE='e * X', e=7.0)(1.) == 7 and FORMULE(NOM_PARA='e', VALE='e')(1.) == 1
e = 9.0
assert F(2.) == 13
FIN()
"""))


if __name__ == "__main__":
    unittest.main()
