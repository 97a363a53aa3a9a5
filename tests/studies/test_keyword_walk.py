"""Every keyword that a study gives changes what its command makes: the walk of tests/keyword_walk over a study that runs in seconds."""

import os
import pathlib
import subprocess
import sys

from study_test import SECONDS, SOURCE, StudyTest

sys.path[:0] = [str(SOURCE / "tests/keyword_walk"), str(SOURCE / "commands")]

import walk  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent


class KeywordWalk(StudyTest):
    def walked(self, comm):
        """(keywords that have changed something, those that have not, and that no row of EXCUSED explains)"""
        found = self.folder / "found.jsonl"
        programs = walk.launcher(self.folder / "bin", pathlib.Path(os.environ["LACON_BIN"]))
        done = subprocess.run([programs / "lacon", comm, "--base", self.folder / "walked.base"], cwd=self.folder, capture_output=True, text=True,
                              timeout=SECONDS, stdin=subprocess.DEVNULL, env={**os.environ, "WALK_FILE": str(found)})
        self.assertEqual(done.returncode, 0, done.stdout[-2000:] + done.stderr[-2000:])
        changes, same = walk.found(found)
        return changes, sorted(path for path in same if not walk.excuse(path))

    def test_keywords_of_functions_and_tables(self):
        changes, same = self.walked(HERE / "keyword_effects.comm")
        self.assertEqual(same, [], "given, and nothing changed")
        self.assertGreater(len(changes), 100)

    def test_more_keywords_of_functions_tables_and_lists(self):
        changes, same = self.walked(HERE / "keyword_walk.comm")
        self.assertEqual(same, [], "given, and nothing changed")
        self.assertGreater(len(changes), 100)

    def test_a_keyword_without_effect_is_found(self):
        """A precision within which there is one row, whatever it says."""
        comm = self.folder / "idle.comm"
        comm.write_text("DEBUT()\nT = CREA_TABLE(LISTE=_F(PARA='X', LISTE_R=(3.0, 100.0)))\nIMPR_TABLE(TABLE=T, UNITE=39, FILTRE=_F(NOM_PARA='X', "
                        "VALE=3.0, PRECISION=1e-2, CRITERE='ABSOLU'))\nFIN()\n")
        changes, same = self.walked(comm)
        self.assertIn("IMPR_TABLE/FILTRE/PRECISION", same)
        self.assertIn("IMPR_TABLE/FILTRE/NOM_PARA", changes)


del StudyTest

if __name__ == "__main__":
    import unittest

    unittest.main()
