"""`lacon new`: the starter study of a mesh passes `lacon check`, names the pair that the geometry shows, and runs."""

import unittest

import numpy as np
from study_test import StudyTest

from meshes import block, brick, union, write_med


def lines(cells, start, length=1.0):
    return start + np.linspace(0, length, cells + 1)


def plate():
    upper = block("QUAD4", lines(3, 0), lines(2, 0), name="UPPER", sides={"bottom": "FINE", "top": "LOAD", "left": "SIDE_1"})
    lower = block("QUAD4", lines(2, 0), lines(2, -1), name="LOWER", sides={"top": "COARSE", "bottom": "BASE", "left": "SIDE_2"})
    return union([upper, lower])


class New(StudyTest):
    def new(self, mesh, *arguments):
        write_med(self.folder / "mesh.med", mesh)
        return self.run_tool("new", "mesh.med", *arguments)

    def assert_checked(self, name="mesh.comm"):
        done = self.run_tool("check", name, "--unit", "20=mesh.med")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("commands are right", done.stdout)
        return (self.folder / name).read_text(encoding="utf-8")

    def test_it_is_written_in_the_language_of_the_user(self):
        """The same commands; what is said beside them has no English sentence."""
        self.new(plate())
        write_med(self.folder / "mesh.med", plate())
        done = self.run_tool("new", "mesh.med", "--out", "etude.comm", LC_ALL="fr_FR.UTF-8")
        self.assertIn("etude.comm : une étude de départ ; y chercher CHOISIR", done.stdout)
        english, french = (self.assert_checked(name).splitlines() for name in ("mesh.comm", "etude.comm"))
        self.assertEqual([line.partition("#")[0] for line in english], [line.partition("#")[0] for line in french])
        said = {line.partition("#")[2].strip() for line in english} & {line.partition("#")[2].strip() for line in french}
        self.assertEqual({line for line in said if len(line.split()) > 3 and "--unit" not in line}, set())
        self.assertEqual(sum("CHOOSE" in line for line in english), sum("CHOISIR" in line for line in french))

    def test_a_contact_of_two_blocks(self):
        done = self.new(plate())
        self.assertEqual(done.returncode, 0, done.stderr)
        text = self.assert_checked()
        self.assertIn("GROUP_MA_ESCL='FINE', GROUP_MA_MAIT='COARSE'", text)
        self.assertIn("MECA_IMPO=(_F(GROUP_MA='BASE', DX=0.0, DY=0.0), _F(GROUP_MA='SIDE_1', DX=0.0), _F(GROUP_MA='SIDE_2', DX=0.0))", text)
        self.assertIn("PRES_REP=_F(GROUP_MA='LOAD', PRES=1.0)", text)
        self.assertIn("# Bodies: LOWER, UPPER", text)
        self.assert_runs()

    def assert_runs(self):
        run = self.run_lacon("mesh.comm", "--unit", "20=mesh.med", "--unit", "80=result.med")
        self.assertEqual(run.status, 0, run.stdout[-2000:] + run.stderr)

    def test_a_flat_skin_meets_the_round_skin_opposite_and_not_the_symmetry_beside_it(self):
        """Half a roller on half a plate: the axis of symmetry of one comes down to the skin of the other, both end in the point that touches."""
        def roller(s, t):
            angle, radius = s * np.pi / 2, 1 + 3 * t
            return radius * np.sin(angle), 4 - radius * np.cos(angle)

        upper = block("QUAD4", lines(16, 0), lines(6, 0), place=roller, name="ROLLER", sides={"top": "ROUND", "left": "SYM_1", "right": "MIDDLE"})
        lower = block("QUAD4", lines(8, 0, 4.0), lines(4, -2, 2.0), name="PLATE", sides={"top": "FLAT", "left": "SYM_2", "bottom": "BASE"})
        self.assertEqual(self.new(union([upper, lower])).returncode, 0)
        text = self.assert_checked()
        self.assertIn("GROUP_MA_ESCL='ROUND', GROUP_MA_MAIT='FLAT'", text)
        self.assertEqual(text.count("ALGO_CONT='LAC'"), 1)
        self.assertIn("ROUND: curved", text)
        self.assertIn("_F(GROUP_MA='SYM_1', DX=0.0), _F(GROUP_MA='SYM_2', DX=0.0)", text)

    def test_symmetry_planes_of_two_bodies_are_no_contact(self):
        """Coarse blocks in space: rows of cells of the planes X = 0 and Y = 0 touch over the skins that meet."""
        below = brick("HEXA8", [lines(2, 0), lines(2, 0), lines(1, 0)], name="LOWER", sides={(0, 0): "X_1", (1, 0): "Y_1", (2, 1): "TOP", (2, 0): "BASE"})
        above = brick("HEXA8", [lines(3, 0), lines(3, 0), lines(1, 1)], name="UPPER", sides={(0, 0): "X_2", (1, 0): "Y_2", (2, 0): "SOLE", (2, 1): "LOAD"})
        self.assertEqual(self.new(union([below, above])).returncode, 0)
        text = self.assert_checked()
        self.assertIn("GROUP_MA_ESCL='SOLE', GROUP_MA_MAIT='TOP'", text)
        self.assertEqual(text.count("ALGO_CONT='LAC'"), 1)
        self.assert_runs()

    def test_bodies_may_stand_on_each_other_along_any_axis(self):
        """Blocks side by side along x, the lower end of one at z = 0: pressed together along x, z = 0 is a symmetry."""
        left = brick("HEXA8", [lines(2, -1), lines(2, 0.5), lines(2, 0)], name="LEFT", sides={(0, 0): "FOOT", (0, 1): "FACE", (2, 0): "HALF"})
        right = brick("HEXA8", [lines(3, 0), lines(3, 0.5), lines(3, 0)], name="RIGHT", sides={(0, 0): "SOLE", (0, 1): "HEAD"})
        self.assertEqual(self.new(union([left, right])).returncode, 0)
        text = self.assert_checked()
        self.assertIn("MECA_IMPO=(_F(GROUP_MA='FOOT', DX=0.0, DY=0.0, DZ=0.0), _F(GROUP_MA='HALF', DZ=0.0), _F(GROUP_MA='HEAD', DY=0.0, DZ=0.0))", text)
        self.assertIn("PRES_REP=_F(GROUP_MA='HEAD', PRES=1.0)", text)
        self.assert_runs()

    def test_planes_of_symmetry_and_supports_may_cut_several_bodies(self):
        """A quarter of a shaft in a hub, each group on both: the zero of both axes is held across; moved up, the lower plane is the support."""
        def ring(inner, width):
            return lambda s, t: ((inner + t * width) * np.sin(np.pi / 2 * s), (inner + t * width) * np.cos(np.pi / 2 * s))

        rings = [block("QUAD4", lines(cells, 0), lines(3, 0), place=ring(inner, width), name=name, sides={**skin, "left": "SYM_X", "right": "SYM_Y"})
                 for cells, inner, width, name, skin in ((8, 10.0, 5.0, "SHAFT", {"top": "OUTER"}), (12, 15.0, 9.0, "HUB", {"bottom": "BORE"}))]
        mesh = union(rings)
        self.assertEqual(self.new(mesh).returncode, 0)
        text = self.assert_checked()
        self.assertIn("MECA_IMPO=(_F(GROUP_MA='SYM_X', DX=0.0), _F(GROUP_MA='SYM_Y', DY=0.0))", text)
        self.assertIn("SYM_X: plane X = 0, on several bodies", text)
        self.assertIn("lengths are those of the mesh, 24 at its largest", text)
        self.assert_runs()
        mesh.points[:, 1] += 2.0
        self.assertEqual(self.new(mesh, "--out", "moved.comm").returncode, 0)
        self.assertIn("MECA_IMPO=(_F(GROUP_MA='SYM_Y', DX=0.0, DY=0.0), _F(GROUP_MA='SYM_X', DX=0.0))", self.assert_checked("moved.comm"))

    def test_names_say_which_skin_is_the_slave(self):
        """Before what is finer; where they say nothing, or both, that counts."""
        for fine, coarse, slave in (("MAITRE", "PEAU_ESCL", "PEAU_ESCL"), ("Master", "SKIN", "SKIN"), ("SKIN", "slave_1", "slave_1"),
                                    ("MASTER_OF_SLAVE", "SKIN", "MASTER_OF_SLAVE")):
            mesh = plate()
            mesh.cell_groups = {{"FINE": fine, "COARSE": coarse}.get(name, name): cells for name, cells in mesh.cell_groups.items()}
            (self.folder / "mesh.comm").unlink(missing_ok=True)
            self.assertEqual(self.new(mesh).returncode, 0)
            master = fine if slave == coarse else coarse
            self.assertIn(f"GROUP_MA_ESCL={slave!r}, GROUP_MA_MAIT={master!r}", (self.folder / "mesh.comm").read_text(encoding="utf-8"))

    def test_skins_that_look_away_from_each_other_are_no_pair(self):
        """The bottom of one plate and the top of the other are within two lengths of cells, thick or thin, with both bodies between them."""
        for thickness in (1.0, 0.1):
            lower = block("QUAD4", lines(4, 0, 4.0), lines(1, 0, thickness), name="LOWER", sides={"bottom": "BASE", "top": "MASTER"})
            upper = block("QUAD4", lines(3, 0, 3.0), lines(1, thickness, thickness), name="UPPER", sides={"bottom": "SLAVE", "top": "LOAD"})
            (self.folder / "mesh.comm").unlink(missing_ok=True)
            self.assertEqual(self.new(union([lower, upper])).returncode, 0)
            text = self.assert_checked()
            self.assertEqual((text.count("ALGO_CONT='LAC'"), text.count("GROUP_MA_ESCL='SLAVE', GROUP_MA_MAIT='MASTER'")), (1, 1), thickness)
            self.assertIn("PRES_REP=_F(GROUP_MA='LOAD', PRES=1.0)", text)

    def test_skins_that_overlap_a_little_are_a_pair(self):
        lower = block("QUAD4", lines(4, 0), lines(2, 0), name="LOWER", sides={"bottom": "BASE", "top": "COARSE"})
        upper = block("QUAD4", lines(5, 0), lines(2, 0.95), name="UPPER", sides={"bottom": "FINE", "top": "LOAD"})
        self.assertEqual(self.new(union([lower, upper])).returncode, 0)
        self.assertIn("GROUP_MA_ESCL='FINE', GROUP_MA_MAIT='COARSE'", self.assert_checked())

    def test_a_skin_meets_the_nearest_one_that_faces_it(self):
        """A shim between two plates that reach further: the plates face each other too, through it and beside it."""
        sizes = {"LOWER": (5, 0.0, 1.25), "SHIM": (3, 1.0, 0.5), "UPPER": (5, 1.25, 1.25)}
        bodies = [block("QUAD4", lines(cells, 0, width), lines(1, height, 0.25 if name == "SHIM" else 1.0), name=name, sides={"bottom": name + "_B", "top": name + "_T"})
                  for name, (cells, height, width) in sizes.items()]
        self.assertEqual(self.new(union(bodies)).returncode, 0)
        text = self.assert_checked()
        zones = sorted(line.strip() for line in text.splitlines() if "ALGO_CONT='LAC', GROUP_MA_ESCL" in line and not line.startswith("#"))
        self.assertEqual([line.partition("'LAC', ")[2] for line in zones],
                         ["GROUP_MA_ESCL='SHIM_B', GROUP_MA_MAIT='LOWER_T'),", "GROUP_MA_ESCL='SHIM_T', GROUP_MA_MAIT='UPPER_B'),"])

    def test_the_skin_itself_is_taken_before_the_whole_boundary(self):
        mesh = plate()
        skins = {group: members for group, members in mesh.cell_groups.items() if group in ("FINE", "LOAD", "SIDE_1")}
        mesh.cell_groups["ALL_OF_UPPER"] = sorted(cell for members in skins.values() for cell in members)
        self.assertEqual(self.new(mesh).returncode, 0)
        self.assertIn("GROUP_MA_ESCL='FINE', GROUP_MA_MAIT='COARSE'", self.assert_checked())

    def test_whole_boundaries_of_bodies_are_no_skins_of_a_contact(self):
        """In space, where nothing else is named: what to add is said, and no zone is made of them; beside the skin that meets another they are nothing."""
        bodies = [brick("HEXA8", [lines(n, 0), lines(n, 0), lines(n, z)], name=name, sides={(a, e): f"{name}_{a}{e}" for a in range(3) for e in range(2)})
                  for name, z, n in (("LOWER", 0, 2), ("UPPER", 1, 3))]
        mesh = union(bodies)
        for name in ("LOWER", "UPPER"):
            mesh.cell_groups["ALL_" + name] = sorted(c for side, cells in mesh.cell_groups.items() if side.startswith(name + "_") for c in cells)
        self.assertEqual(self.new(mesh).returncode, 0)
        text = self.assert_checked()
        self.assertIn("GROUP_MA_ESCL='UPPER_20', GROUP_MA_MAIT='LOWER_21'", text)
        self.assertEqual(text.count("ALGO_CONT='LAC'"), 1)
        mesh.cell_groups = {name: cells for name, cells in mesh.cell_groups.items() if name.startswith("ALL_") or "_" not in name}
        self.assertEqual(self.new(mesh, "--out", "whole.comm").returncode, 0)
        text = self.assert_checked("whole.comm")
        self.assertIn("CHOOSE a slave and a master", text)
        self.assertNotIn("\nCONTACT =", text)

    def test_the_call_that_help_shows_is_accepted(self):
        call = self.run_tool("help", "DEFI_CONTACT").stdout.partition("accepted:")[2]
        self.assertEqual(self.new(plate()).returncode, 0)
        text = self.assert_checked()
        first, last = text.index("CONTACT = "), text.index("STEPS = ")
        shown = " ".join(call.split()).replace("=MODELE", "=MODEL").replace("MAIT='GROUP'", "MAIT='COARSE'").replace("ESCL='GROUP'", "ESCL='FINE'")
        (self.folder / "mesh.comm").write_text(text[:first] + shown + "\n" + text[last:], encoding="utf-8")
        self.assert_runs()

    def test_without_a_pair_the_file_says_what_to_add(self):
        done = self.new(brick("HEXA8", [lines(1, 0), lines(1, 0), lines(1, 0)], name="BODY", sides={(2, 0): "LOW"}), "--out", "one.comm")
        self.assertEqual(done.returncode, 0, done.stderr)
        text = self.assert_checked("one.comm")
        self.assertIn("MODELISATION='3D'", text)
        self.assertIn("CHOOSE a slave and a master", text)
        self.assertNotIn("\nCONTACT =", text)

    def test_a_mesh_without_groups_of_skins(self):
        self.new(block("TRIA3", lines(2, 0), lines(2, 0), name="BODY"))
        self.assertIn("GROUP_MA='BODY', DX=0.0, DY=0.0", self.assert_checked())

    def test_never_replaces_a_file(self):
        (self.folder / "mesh.comm").write_text("mine", encoding="utf-8")
        done = self.new(plate())
        self.assertEqual(done.returncode, 2)
        self.assertIn("mesh.comm is there already", done.stderr)
        self.assertEqual((self.folder / "mesh.comm").read_text(encoding="utf-8"), "mine")

    def test_refuses_what_is_no_mesh(self):
        (self.folder / "mesh.med").write_text("no mesh", encoding="utf-8")
        for name, word in (("mesh.med", "MED_2"), ("nowhere.med", "nowhere.med"), ("mesh.unv", ".msh")):
            done = self.run_tool("new", name)
            self.assertEqual(done.returncode, 2)
            self.assertIn(word, done.stderr)
        self.assertFalse((self.folder / "mesh.comm").exists())


if __name__ == "__main__":
    unittest.main()
