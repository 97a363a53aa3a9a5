"""Manufactured solutions: what the tensors of the peer's files derive equals the literal formulae of manufactured.py."""

import pathlib
import unittest

from study_test import StudyTest

HERE = pathlib.Path(__file__).resolve().parent

try:
    import sympy
except ImportError:
    sympy = None

_comm = """
import sys
sys.path.insert(0, {here!r})
from derived import derived
from manufactured import manufactured
import numpy
DEBUT()
test = CA.TestCase()
for u, normals in ((("0.2*Y**3*(0.5 - X)", "-0.01*Y - (1 + Y)*(0.5 - X)*(0.025 - 0.05*X)"), ((1, 0), (0, -1))),
                   (("0.2*X*Y*Z**2", "0.2*X*Y*Z**2", "-0.3 - 0.01*Z - (1 + 0.01*Z)*(0.2 + 0.2*X**2 + 0.2*Y**2)"), ((0, 1, 0), (0, 0, -1)))):
    first, second = derived(u, 1.0), manufactured(u, modulus=1.0)
    points = numpy.random.default_rng(7).uniform(-0.5, 1.0, (len(u), 20))
    for normal in normals:
        for a, b in zip([*first.inside, *first.on(normal), *first.beside_contact(normal), first.pressure(normal)],
                        [*second.inside, *second.on(normal), *second.beside_contact(normal), second.pressure(normal)]):
            a, b = (FORMULE(NOM_PARA=tuple("XYZ"[:len(u)]), VALE=text).on_arrays(*points) for text in (a, b))
            test.assertLessEqual(float(abs(a - b).max()), 1e-13)
test.printSummary()
FIN()
"""


@unittest.skipUnless(sympy, "sympy is not installed")
class Manufactured(StudyTest):
    def test_derived_formulae_equal_the_literal_ones(self):
        """In the plane and in space: volume forces, tractions, what stands beside contact, pressure; values of order 1 at 20 points."""
        comm = self.folder / "study.comm"
        comm.write_text(_comm.format(here=str(HERE)))
        self.assert_all_ok(self.run_lacon(comm), 34)


if __name__ == "__main__":
    unittest.main()
