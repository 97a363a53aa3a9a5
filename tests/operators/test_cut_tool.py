"""crea_maillage without an order: MED in, MED out."""

import itertools
import json
import os
import pathlib
import subprocess
import sys
import unittest

import h5py
import numpy as np

from lacon_test import BIN, SECONDS, OperatorTest

sys.path.insert(0, str(pathlib.Path(os.environ["LACON_SOURCE_DIR"]) / "commands/studies"))
from meshes import block, brick, cubes, union, write_med  # noqa: E402

LINES = np.linspace(0.0, 1.0, 3)


class CutTool(OperatorTest):
    def setUp(self):
        super().setUp()
        self.source, self.out = self.folder / "in.med", self.folder / "out.med"

    def tool(self, *arguments):
        return subprocess.run([BIN / "crea_maillage", *map(str, arguments)], capture_output=True, text=True, timeout=SECONDS,
                              stdin=subprocess.DEVNULL, check=False)

    def cut(self, *arguments):
        done = self.tool(self.source, self.out, *arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done

    def refuses(self, identifier, *arguments, words=()):
        """Status 2, this message, no file but those that were there."""
        before = self.snapshot()
        done = self.tool(*arguments)
        self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
        self.assertIn(f"<F> <{identifier}>", done.stderr)
        for word in words:
            self.assertIn(word, done.stderr)
        self.assertEqual(self.snapshot(), before)

    def write_brick(self):
        """2 x 2 x 2 HEXA8 with a slave top, a group of its nodes, one of all nodes, one of some, and an empty group."""
        mesh = brick("HEXA8", [LINES] * 3, name="BODY", sides={(2, 1): "TOP", (2, 0): "BASE"})
        mesh.cell_groups["NOTHING"] = []
        mesh.node_groups = {"N_TOP": mesh.nodes_where(lambda x, y, z: z == 1), "EVERY": list(range(len(mesh.points))),
                            "EDGE": mesh.nodes_where(lambda x, y, z: z == 1 and x == 0)}
        write_med(self.source, mesh, "Joint")
        return mesh

    def read(self):
        """The file as the MED library sees it, cell groups by name as a set of (MED type, index)."""
        return self.med_library(self.out)["meshes"]

    def groups(self, kind):
        """Sizes of the groups of the written file, through LIRE_MAILLAGE."""
        run = self.run_command("LIRE_MAILLAGE", {"FORMAT": "MED", "UNITE": 20}, "mesh_9", units={20: self.out})
        self.assertEqual(run.status, 0, run.stderr)
        mesh = self.read_mesh("mesh_9")
        return mesh, {name: len(members) for name, members in getattr(mesh, kind).items()}

    def test_cuts_a_file_with_names_and_groups_kept(self):
        before = self.write_brick()
        done = self.cut("--slave", "TOP")
        self.assertRegex(done.stdout, r"zone TOP +4 macro-elements")
        self.assert_conforms(self.out)
        [mesh] = self.read()
        self.assertEqual((mesh["name"], mesh["space"], mesh["dimension"]), ("Joint", 3, 3))
        # METHOD: each face of a HEXA8 adds one node, three skin cells and four body cells
        mesh, cells = self.groups("cell_groups")
        self.assertEqual(cells, {"BODY": 8 + 4 * 4, "TOP": 16, "BASE": 4, "NOTHING": 0})
        self.assertEqual(len(mesh.coordinates), len(before.points) + 4)
        np.testing.assert_array_equal(mesh.coordinates[:27], before.points)

    def test_groups_of_nodes_that_hold_the_skin_get_its_nodes(self):
        self.write_brick()
        done = self.cut("--slave", "TOP", "--hexa", "HEXA")
        mesh, sizes = self.groups("node_groups")
        # HEXA: four nodes on each face, four inside each body cell
        self.assertEqual(sizes, {"EVERY": 27 + 4 * 8, "N_TOP": 9 + 4 * 4, "EDGE": 3})
        self.assertTrue(np.all(mesh.coordinates[mesh.node_groups["N_TOP"], 2] == 1))
        self.assertEqual(done.stderr.count("<DECOUPE_8>"), 2)
        self.cut("--slave", "TOP", "--hexa", "HEXA", "--keep-node-groups")
        self.assertEqual(self.groups("node_groups")[1], {"EVERY": 27, "N_TOP": 9, "EDGE": 3})

    def test_two_zones_of_one_body_in_the_plane(self):
        write_med(self.source, block("QUAD4", LINES, LINES, name="BODY", sides={"top": "TOP", "right": "RIGHT"}))
        self.cut("--slave", "TOP", "--slave", "RIGHT")
        self.assert_conforms(self.out)
        mesh, cells = self.groups("cell_groups")
        self.assertEqual((mesh.dimension, cells), (2, {"BODY": 4 + 4 * 3, "TOP": 6, "RIGHT": 6}))

    def test_a_skin_that_looks_inward_is_turned_and_told(self):
        mesh = self.write_brick()
        mesh.cells["QUAD4"] = mesh.cells["QUAD4"][:, ::-1]
        write_med(self.source, mesh, "Joint")
        done = self.cut("--slave", "TOP")
        self.assertIn("<I> <DECOUPE_7> 4 slave cells of the group 'TOP' looked into their body and were turned", done.stderr)
        mesh, _ = self.groups("cell_groups")
        corners = mesh.coordinates[np.array([mesh.cells[c] for c in mesh.cell_groups["TOP"]])]
        self.assertTrue(np.all(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 2] > 0))

    def test_the_box_of_the_benchmark_is_a_mesh_like_any_other(self):
        sides = {(axis, end): f"SIDE{axis}{end}" for axis in range(3) for end in (0, 1)}
        for kind, make in itertools.product(("HEXA8", "TETRA4"), (cubes, brick)):
            if make is cubes:
                box = cubes((2, 3, 4), "BODY", sides, kind)
            else:
                box = brick(kind, [np.arange(n + 1.0) for n in (2, 3, 4)], name="BODY", sides=sides)
            write_med(self.source, box)
            done = self.cut(*(word for name in sides.values() for word in ("--slave", name)))
            self.assertNotIn("DECOUPE_7", done.stderr)
            self.assertNotIn("LIRE_1", done.stderr)
            mesh, sizes = self.groups("cell_groups")
            self.assertEqual(sizes["SIDE00"], 12 * 4 if kind == "HEXA8" else 24 * 3)
            self.assertTrue(np.all(mesh.coordinates[np.concatenate([mesh.cells[c] for c in mesh.cell_groups["SIDE11"]]), 1] == 3))

    def test_arrays_of_several_parts(self):
        """Large arrays are read and written in parts of two megabytes: the last has another length. One in chunks is one part."""
        size = (82, 81, 80)
        mesh = cubes(size, "BODY", {(2, 1): "TOP"})
        n_nodes, n_bodies = len(mesh.points), len(mesh.cells["HEXA8"])
        self.assertGreater(min(n_nodes, n_bodies), 2**21 / 4)  # families: more than one part of 32-bit integers
        random = np.random.default_rng(3)
        mesh.node_groups["SOME_N"] = np.flatnonzero(random.random(n_nodes) < 0.4).tolist()
        chosen = np.flatnonzero(random.random(n_bodies) < 0.4)
        mesh.cell_groups["SOME"] = [("HEXA8", c) for c in chosen]
        write_med(self.source, mesh)
        under = np.any(mesh.points[mesh.cells["HEXA8"], 2] == size[2], axis=1)
        written = []
        for compressed in (False, True):
            if compressed:
                with h5py.File(self.source, "a") as file:
                    step = file["ENS_MAA/MESH/-0000000000000000001-0000000000000000001"]
                    for where in ("NOE/COO", "NOE/FAM", "MAI/HE8/NOD", "MAI/HE8/FAM"):
                        values, attributes = step[where][()], dict(step[where].attrs)
                        del step[where]
                        step.create_dataset(where, data=values, chunks=(10000,), compression="gzip", compression_opts=1)
                        step[where].attrs.update(attributes)
            self.cut("--slave", "TOP")
            with h5py.File(self.out) as file:
                step = file["ENS_MAA/MESH/-0000000000000000001-0000000000000000001"]
                points = step["NOE/COO"][()].reshape(3, -1).T
                bodies, numbers = step["MAI/HE8/NOD"][()].reshape(8, -1).T - 1, step["MAI/HE8/NUM"][()]
                families = {kind: {group.attrs["NUM"]: {bytes(name.tolist()).rstrip(b"\0").decode() for name in group["GRO/NOM"][()]}
                                   for group in file[f"FAS/MESH/{kind}"].values()} for kind in ("NOEUD", "ELEME")}
                named = {kind: [families[kind].get(number, set()) for number in step[where][()]]
                         for kind, where in (("NOEUD", "NOE/FAM"), ("ELEME", "MAI/HE8/FAM"))}
            np.testing.assert_array_equal(points[:n_nodes], mesh.points)
            np.testing.assert_array_equal(bodies, mesh.cells["HEXA8"][~under])
            self.assertTrue(np.all(np.diff(numbers) > 0))
            self.assertEqual([i for i, names in enumerate(named["NOEUD"]) if names], mesh.node_groups["SOME_N"])
            np.testing.assert_array_equal(np.array(["SOME" in names for names in named["ELEME"]]), np.isin(np.flatnonzero(~under), chosen))
            self.assertTrue(all("BODY" in names for names in named["ELEME"]))
            written.append((points, bodies, numbers))
        for first, second in zip(*written):
            np.testing.assert_array_equal(first, second)
        for where, value, identifier, words in (("MAI/HE8/NOD", n_nodes + 1, "MED_8", [f"number {n_bodies} names the node {n_nodes + 1}"]),
                                                ("NOE/COO", np.inf, "MED_9", [f"N{n_nodes} "])):
            write_med(self.source, mesh)
            with h5py.File(self.source, "a") as file:
                file[f"ENS_MAA/MESH/-0000000000000000001-0000000000000000001/{where}"][-1] = value
            self.refuses(identifier, self.source, self.folder / "new.med", "--slave", "TOP", words=words)

    def test_quality_is_reported_on_demand(self):
        self.write_brick()
        self.assertNotIn("the worst", self.cut("--slave", "TOP").stdout)
        # METHOD 1.5: 2 / sqrt(17) in the laterals of a cube cut into hexahedra
        self.assertRegex(self.cut("--slave", "TOP", "--hexa", "HEXA", "--quality").stdout, r"the worst after the cut:\n +0.4851  HEXA8 M\d+ \(BODY\)")

    def test_body_cells_inside_out_are_turned_and_told(self):
        mesh = self.write_brick()
        mesh.cells["HEXA8"][3] = mesh.cells["HEXA8"][3][[4, 5, 6, 7, 0, 1, 2, 3]]
        write_med(self.source, mesh, "Joint")
        done = self.cut("--slave", "TOP")
        self.assertRegex(done.stderr, r"<I> <LIRE_1> 1 ")
        run = self.run_command("LIRE_MAILLAGE", {"FORMAT": "MED", "UNITE": 20}, "mesh_9", units={20: self.out})
        self.assertEqual((run.status, self.ids(run)), (0, []))

    def test_chooses_a_mesh_by_name(self):
        self.write_brick()
        with h5py.File(self.source, "a") as file:
            for where in ("ENS_MAA", "FAS"):
                file.copy(f"{where}/Joint", f"{where}/Another")
        self.cut("--slave", "TOP", "--mesh", "Joint")
        self.assertEqual([mesh["name"] for mesh in self.read()], ["Joint"])
        self.refuses("MED_5", self.source, self.folder / "new.med", "--slave", "TOP", "--mesh", "Joints", words=["Joints", "Another"])

    def test_its_outcome_goes_to_a_file_on_demand(self):
        self.write_brick()
        self.cut("--slave", "TOP", "--status", self.folder / "outcome.json")
        outcome = json.loads((self.folder / "outcome.json").read_text())
        self.assertEqual((outcome["status"], [m["id"] for m in outcome["messages"]]), (0, ["DECOUPE_8", "DECOUPE_8", "MESH1_3"]))

    def test_an_outcome_that_cannot_be_written_is_told(self):
        self.write_brick()
        done = self.tool(self.source, self.out, "--slave", "TOP", "--status", self.source.parent / "nowhere/status.json")
        self.assertEqual(done.returncode, 2)
        self.assertRegex(done.stderr, r"<F> <BASE_3> .*nowhere/status\.json")

    def test_an_older_file_is_replaced(self):
        self.write_brick()
        self.out.write_text("an older file")
        self.cut("--slave", "TOP")
        self.assert_conforms(self.out)

    def test_refuses_what_it_cannot_cut_and_writes_nothing(self):
        self.write_brick()
        self.refuses("MESH_1", self.source, self.out, "--slave", "TPO", words=["--slave", "'TPO'", "'TOP'", "in.med"])
        self.refuses("MESH_2", self.source, self.out, "--slave", "NOTHING", words=["'NOTHING'"])
        self.refuses("DECOUPE_1", self.source, self.out, "--slave", "TOP", "--slave", "TOP", words=["'TOP'"])
        self.refuses("DECOUPE_4", self.source, self.out, "--slave", "BODY", words=["'BODY'", "HEXA8 M9"])
        self.refuses("MED_1", self.folder / "none.med", self.out, "--slave", "TOP", words=["none.med"])
        self.refuses("CUT_1", self.source, self.source, "--slave", "TOP", words=["in.med"])
        self.refuses("BASE_3", self.source, self.folder / "no/folder/out.med", "--slave", "TOP", words=["no/folder"])
        self.refuses("BASE_3", self.source, self.folder, "--slave", "TOP", words=["folder"])
        os.mkfifo(self.folder / "pipe")  # as /dev/null: renaming a whole file would put it in its place
        self.refuses("BASE_3", self.source, self.folder / "pipe", "--slave", "TOP", words=["pipe", "not a file"])
        self.assertTrue((self.folder / "pipe").is_fifo())
        plane = block("QUAD4", LINES, LINES, sides={"top": "TOP"})
        plane.points = np.column_stack([plane.points, np.full(len(plane.points), 5.0)])
        write_med(self.source, plane)
        self.refuses("DECOUPE_4", self.source, self.out, "--slave", "TOP", words=["SEG2 M1", "only where every z is 0"])
        self.source.write_text("no mesh")
        self.refuses("MED_2", self.source, self.out, "--slave", "TOP", words=["in.med"])
        skins_only = block("QUAD4", LINES, LINES, sides={"top": "TOP"})
        del skins_only.cells["QUAD4"]
        write_med(self.source, union([skins_only]))
        self.refuses("MESH1_2", self.source, self.out, "--slave", "TOP", words=["SEG2 M1", "'TOP'"])

    def test_refuses_a_command_line_without_skin_or_with_another_cut(self):
        self.write_brick()
        for arguments in ([self.source, self.out], [self.source, "--slave", "TOP"],
                          [self.source, self.out, "--slave", "TOP", "--hexa", "TETRA"]):
            self.assertEqual(self.tool(*arguments).returncode, 2)
        self.assertFalse(self.out.exists())


if __name__ == "__main__":
    unittest.main()
