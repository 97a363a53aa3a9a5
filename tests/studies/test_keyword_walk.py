"""Every keyword that a study gives changes what its command makes: the walk of tests/keyword_walk over a study that runs in seconds."""

import os
import pathlib
import subprocess
import sys

from study_test import SECONDS, SOURCE, StudyTest

sys.path[:0] = [str(SOURCE / "tests/keyword_walk"), str(SOURCE / "commands")]

import walk  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent


class Walked(StudyTest):
    seconds = SECONDS

    def walked(self, comm):
        """(keywords that have changed something, in all walks of a test; those that have not, and that no row of EXCUSED explains)"""
        found = self.folder / "found.jsonl"
        programs = walk.launcher(self.folder / "bin", pathlib.Path(os.environ["LACON_BIN"]))
        done = subprocess.run([programs / "lacon", comm, "--base", self.folder / f"{comm.stem}.base"], cwd=self.folder, capture_output=True, text=True,
                              timeout=self.seconds, stdin=subprocess.DEVNULL, env={**os.environ, "WALK_FILE": str(found)})
        self.assertEqual(done.returncode, 0, done.stdout[-2000:] + done.stderr[-2000:])
        changes, same = walk.found(found)
        return changes, sorted(path for path in same if not walk.excuse(path))

    def shows(self, changes, study):
        """What tests/keyword_walk/shown.json says of a study is so."""
        said = walk.shown()[study]
        self.assertGreater(len(said), 10)
        self.assertEqual(sorted(set(said) - changes), [], f"{study} shows these no longer: tests/keyword_walk/run --record")


class KeywordWalk(Walked):
    def test_keywords_of_functions_and_tables(self):
        changes, same = self.walked(HERE / "keyword_effects.comm")
        self.assertEqual(same, [], "given, and nothing changed")
        self.shows(changes, "studies/keyword_effects.comm")

    def test_more_keywords_of_functions_tables_and_lists(self):
        changes, same = self.walked(HERE / "keyword_walk.comm")
        self.assertEqual(same, [], "given, and nothing changed")
        self.shows(changes, "studies/keyword_walk.comm")

    def test_a_keyword_without_effect_is_found(self):
        """A precision within which there is one row, whatever it says."""
        comm = self.folder / "idle.comm"
        comm.write_text("DEBUT()\nT = CREA_TABLE(LISTE=_F(PARA='X', LISTE_R=(3.0, 100.0)))\nIMPR_TABLE(TABLE=T, UNITE=39, FILTRE=_F(NOM_PARA='X', "
                        "VALE=3.0, PRECISION=1e-2, CRITERE='ABSOLU'))\nFIN()\n")
        changes, same = self.walked(comm)
        self.assertIn("IMPR_TABLE/FILTRE/PRECISION", same)
        self.assertIn("IMPR_TABLE/FILTRE/NOM_PARA", changes)


class LongKeywordWalk(Walked):
    """Meshes, loads, solutions, contact, and what is made of results."""

    seconds = 3600

    def test_every_keyword_of_the_small_studies(self):
        same = set()
        for comm in sorted((HERE / "walk").glob("*.comm")):
            changes, same = self.walked(comm)
            self.shows(changes, f"studies/walk/{comm.name}")
        self.assertEqual(same, [], "given, and nothing changed")


del StudyTest, Walked

if __name__ == "__main__":
    import unittest

    unittest.main()
