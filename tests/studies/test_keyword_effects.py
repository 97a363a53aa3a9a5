"""Keywords that change what a command makes: studies that give them, and compare with what is made without."""

import pathlib

from study_test import StudyTest, two_columns

from meshes import write_med

HERE = pathlib.Path(__file__).resolve().parent


class KeywordEffects(StudyTest):
    def test_functions_tables_and_what_is_written_of_them(self):
        run = self.run_study(HERE / "keyword_effects.comm")
        self.assert_all_ok(run, 5)
        for legend in ("the first legend", "the second legend"):
            self.assertIn(legend, run.stdout)


class LongKeywordEffects(StudyTest):
    def test_computations_and_results(self):
        write_med(self.folder / "mesh.med", two_columns()[0])
        run = self.run_study(HERE / "keyword_effects_results.comm", "--unit", f"20={self.folder / 'mesh.med'}")
        self.assertEqual(run.status, 0, run.stdout[-3000:] + run.stderr[-3000:])
        briefly, length, told = (run.stdout.index(f"\n{mark}\n") for mark in ("briefly", "at length", "told"))
        self.assertEqual(["X from" in run.stdout[briefly:length], "X from" in run.stdout[length:told]], [False, True])  # INFO_MED


del StudyTest

if __name__ == "__main__":
    import unittest

    unittest.main()
