"""Patches that keep their cover (EVOLUTION_50), from one computation to the next."""

import pathlib
import re
import sys
import unittest

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

from study_test import StudyTest  # noqa: E402, I001 (it says where meshes.py is)
from meshes import block, union, write_med  # noqa: E402

PUNCH = HERE.parent / "faults/punch.comm"
LIST = "INCREMENT=_F(LIST_INST=DEFI_LIST_INST(DEFI_LIST=_F(LIST_INST=TIMES)))"


class GoOn(StudyTest):
    def run_once(self, name, text):
        """Run a command file. @return iterations of each instant, and what it said"""
        (self.folder / f"{name}.comm").write_text(text, encoding="utf-8")
        done = self.run_tool(f"{name}.comm", "--unit", "20=punch.med", "--base", f"{name}.base")
        self.assertEqual(done.returncode, 0, done.stdout[-2000:] + done.stderr)
        said = done.stdout + done.stderr
        return [int(count) for count in re.findall(r"Converged at the instant \S+ with (\d+) iteration", said)], said

    def test_a_computation_goes_on_with_the_covers_of_another(self):
        """Of ETAT_INIT: the state is balanced with its covers kept, and its next instants take what they take in one computation. Without them the first
        of these is searched for from a state that is none."""
        def lines(first, last, steps):
            return np.linspace(first, last, steps + 1)

        write_med(self.folder / "punch.med", union([
            block("QUAD4", lines(-2, 2, 17), lines(-1, 0, 5), name="LOWER", sides={"bottom": "BASE", "top": "GROUND"}),
            block("QUAD4", lines(-1, 1, 8), lines(0, 1, 4), name="PUNCH", sides={"bottom": "FACE", "top": "TOP"})]))
        text = PUNCH.read_text(encoding="utf-8")
        orders = text[text.index("RESULT = STAT_NON_LINE("):text.index("FIN()")]
        self.assertIn(LIST, orders)
        whole, _ = self.run_once("whole", text)
        half = orders.replace(LIST, "INCREMENT=_F(LIST_INST=TIMES, INST_FIN=6.0)")
        rest = orders.replace("RESULT =", "MORE =").replace(LIST, "ETAT_INIT=_F(EVOL_NOLI=RESULT), INCREMENT=_F(LIST_INST=TIMES)")
        parts, said = self.run_once("parts", text.replace(orders, half + rest))
        self.assertEqual(said.count("<EVOLUTION_50>"), 2)  # each computation says so
        self.assertEqual((len(whole), len(parts)), (8, 8))
        self.assertLessEqual(parts[6], whole[6] + 1)  # it begins without a motion to go on from


if __name__ == "__main__":
    unittest.main()
