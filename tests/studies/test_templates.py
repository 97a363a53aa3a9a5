"""Every template of `lacon new` runs as it is, and what it computes is what theory says."""

import sys
import unittest

from study_test import SOURCE, StudyTest

sys.path.insert(0, str(SOURCE / "commands"))

from lacon.tools import templates  # noqa: E402

#: name -> how many checks it ends with
CHECKS = {"bolted_flange": 4, "hertz": 1, "indentation": 1, "press_fit": 2, "several_zones": 3}


class Templates(StudyTest):
    def test_there_are_these(self):
        self.assertEqual(set(templates.known()), set(CHECKS))
        listed = self.run_tool("new", "--help").stdout
        for name, words in templates.known().items():
            self.assertRegex(listed, rf"{name} +{words}")

    def test_they_are_refused_where_something_is_there_already(self):
        (self.folder / "hertz").mkdir()
        self.assertIn("<NEW_2>", self.run_tool("new", "--template", "hertz").stderr)
        self.assertIn("the nearest one is hertz", self.run_tool("new", "--template", "herz").stderr)

    def runs(self, name):
        self.assertEqual(self.run_tool("new", "--template", name, "--out", self.folder / "mine").returncode, 0)
        self.folder /= "mine"
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), sorted([f"{name}.comm", "mesh.py", "meshes.py"]))
        self.assert_all_ok(self.run_lacon(f"{name}.comm"), CHECKS[name])


for one in CHECKS:
    setattr(Templates, f"test_{one}_agrees_with_theory", lambda self, name=one: self.runs(name))


if __name__ == "__main__":
    unittest.main()
