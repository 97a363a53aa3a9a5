"""A study gives the same results whatever the linear solver keeps of its factor: single precision, low-rank blocks, files."""

import json
import unittest

import numpy as np
from study_test import SOURCE, StudyTest

from meshes import brick, union, write_med
from results import Result

PLAIN = {"NU": "0.3", "CONTRAST": "1", "SLENDER": "0"}


def two_blocks(length, cells):
    """Blocks of height 0.5 whose meshes do not match. @param cells of the bottom along its length, across, and of its height"""
    def block(n, z0, name, sides):
        lines = [np.linspace(0.0, side, count + 1) for side, count in zip((length, 1.0), n)] + [np.linspace(z0, z0 + 0.5, n[2] + 1)]
        return brick("HEXA8", lines, name=name, sides=sides)

    long, across, high = cells
    return union([block(cells, 0.0, "VBOT", {(0, 0): "XB", (1, 0): "YB", (2, 0): "BASE", (2, 1): "CBOT"}),
                  block((long - 2, across, high), 0.5, "VTOP", {(0, 0): "XT", (1, 0): "YT", (2, 0): "CTOP", (2, 1): "TOP"})])


class Precision(StudyTest):
    def solve(self, solver, case, study="precision.comm", mesh="blocks.med"):
        """@return displacements, what the solution counted, what was said"""
        base, report = self.folder / f"{solver}.base", self.folder / "run.json"
        run = self.run_tool(SOURCE / "tests/studies" / study, "--fresh", "--base", base, "--unit", f"20={mesh}", "--json", report, **case,
                            SOLVER=solver)
        self.assertEqual(run.returncode, 0, run.stdout[-3000:] + run.stderr[-3000:])
        commands = json.loads(report.read_text())["timings"]["commands"]
        self.assertFalse((base / "factor.partial").exists())
        result = Result(base, "RESULT")
        _, components = result.field("DEPL", result.orders[-1])
        return components, next(c["counts"] for c in commands if c["command"] == "STAT_NON_LINE"), run.stdout + run.stderr

    def compare(self, solver, **change):
        """Solve a case both ways. @return what the other way counted and said"""
        case = PLAIN | change
        exact, _, _ = self.solve("double", case)
        other, counts, said = self.solve(solver, case)
        largest = max(np.nanmax(np.abs(exact[name])) for name in ("DX", "DY", "DZ"))
        for name, values in exact.items():
            scale = np.nanmax(np.abs(values)) if name == "LAGS_C" else largest
            self.assertLessEqual(np.nanmax(np.abs(other[name] - values)), 1e-9 * scale, (name, change))
        return counts, said

    def test_single_precision_is_enough(self):
        write_med(self.folder / "blocks.med", two_blocks(1.0, (7, 6, 3)))
        counts, said = self.compare("single")
        self.assertEqual(counts["factors in single precision"], counts["factorisations"])
        self.assertEqual(counts["factors of low rank"], counts["factorisations"])
        self.assertNotIn("SOLVER_4", said)

    def test_nearly_incompressible_and_of_unequal_stiffness(self):
        write_med(self.folder / "blocks.med", two_blocks(1.0, (7, 6, 3)))
        self.compare("single", NU="0.4999")
        self.compare("single", CONTRAST="1e6")
        self.compare("single", CONTRAST="1e-6")

    def test_slender_bodies_are_left_to_double_precision(self):
        write_med(self.folder / "blocks.med", two_blocks(100.0, (40, 2, 2)))
        counts, said = self.compare("single", SLENDER="1")
        self.assertNotIn("factors in single precision", counts)
        self.assertEqual(said.count("<SOLVER_4>"), 1)  # the study remembers

    def test_factors_in_files(self):
        write_med(self.folder / "blocks.med", two_blocks(1.0, (7, 6, 3)))
        counts, _ = self.compare("files")
        self.assertEqual(counts["factors in files"], counts["factorisations"])


if __name__ == "__main__":
    unittest.main()
