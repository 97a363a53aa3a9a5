"""`lacon convert`: a mesh from gmsh's format to MED and VTU, with its groups."""

import unittest
from xml.etree import ElementTree

import h5py
from study_test import StudyTest

PLATE = """$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
2
1 4 "Low"
2 5 "Body"
$EndPhysicalNames
$Nodes
4
1 0 0 0
2 2 0 0
3 2 1 0
4 0 1 0
$EndNodes
$Elements
2
1 1 2 4 1 1 2
2 3 2 5 1 1 2 3 4
$EndElements
"""


class Convert(StudyTest):
    def setUp(self):
        super().setUp()
        (self.folder / "plate.msh").write_text(PLATE, encoding="ascii")

    def test_gmsh_to_med_to_vtu(self):
        done = self.run_tool("convert", "plate.msh", "plate.med")
        self.assertEqual(done.returncode, 0, done.stderr)
        with h5py.File(self.folder / "plate.med") as file:
            self.assertEqual(list(file["ENS_MAA"]), ["plate"])
            self.assertEqual(len(list(file["FAS/plate/ELEME"])), 2)
        done = self.run_tool("convert", "plate.med", "plate.vtu")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("GROUP_MA Low", (self.folder / "plate_0001.vtu").read_text(encoding="ascii"))
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), ["plate.med", "plate.msh", "plate.pvd", "plate_0001.vtu"])

    def test_to_code_asters_text_and_back_to_gmsh(self):
        for source, target in (("plate.msh", "plate.mail"), ("plate.mail", "back.msh"), ("back.msh", "back.mail")):
            done = self.run_tool("convert", source, target)
            self.assertEqual(done.returncode, 0, done.stderr)
        first, last = ((self.folder / name).read_text(encoding="ascii") for name in ("plate.mail", "back.mail"))
        self.assertEqual(first.partition("FINSF")[2], last.partition("FINSF")[2])  # all but the title
        self.assertIn("GROUP_MA\n Low\n M1\nFINSF", first)

    def test_latin_1_and_control_characters_become_names_that_every_program_reads(self):
        (self.folder / "plate.msh").write_bytes(PLATE.replace("Low", "Fläche <1>").replace("Body", "a\x01b").encode("latin-1"))
        done = self.run_tool("convert", "plate.msh", "plate.vtu")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("FORMAT_1", done.stderr)
        arrays = [array.get("Name") for array in ElementTree.parse(self.folder / "plate_0001.vtu").iter("DataArray")]
        self.assertLessEqual({"GROUP_MA Fläche <1>", "GROUP_MA a?b"}, set(arrays))

    def test_refusals(self):
        (self.folder / "broken.msh").write_text(PLATE.replace("$EndNodes", ""), encoding="ascii")
        for arguments, word in ((("broken.msh", "out.med"), "GMSH_3"), (("nowhere.msh", "out.med"), "nowhere.msh"),
                                (("plate.msh", "plate.msh"), "it is the mesh itself"), (("plate.unv", "out.med"), ".msh")):
            with self.subTest(arguments=arguments):
                done = self.run_tool("convert", *arguments)
                self.assertEqual(done.returncode, 2)
                self.assertIn(word, done.stderr)
                self.assertNotIn("Traceback", done.stderr)
                self.assertFalse((self.folder / "out.med").exists())

    def test_a_mesh_is_not_converted_to_itself(self):
        self.run_tool("convert", "plate.msh", "plate.med")
        before = (self.folder / "plate.med").read_bytes()
        self.assertEqual(self.run_tool("convert", "plate.med", "./plate.med").returncode, 2)
        self.assertEqual((self.folder / "plate.med").read_bytes(), before)


if __name__ == "__main__":
    unittest.main()
