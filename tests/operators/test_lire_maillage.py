"""LIRE_MAILLAGE: MED files made here with h5py, and the peer's own."""

import json
import os
import unittest

import h5py
import numpy as np

from lacon_test import CELLS, SHARED_CASES, OperatorTest

STEP = "-0000000000000000001-0000000000000000001"


def write_med(path, coordinates, cells, cell_groups=(), mesh="MESH", integers=np.int32, version=(3, 2, 1), encoding="utf-8"):
    """A small MED file. @param cells name of a type -> list of node lists, 0-based, in *MED's* order
    @param cell_groups list of (family, type, members, group names)"""
    coordinates = np.asarray(coordinates, float)
    with h5py.File(path, "w") as file:
        about = file.create_group("INFOS_GENERALES")
        for name, value in zip(("MAJ", "MIN", "REL"), version):
            about.attrs[name] = np.int32(value)
        head = file.create_group("ENS_MAA").create_group(mesh.encode(encoding))
        for name, value in {"DIM": 2, "ESP": coordinates.shape[1], "REP": 0, "TYP": 0}.items():
            head.attrs[name] = np.int32(value)
        step = head.create_group(STEP)
        step.attrs["NDT"] = step.attrs["NOR"] = np.int32(-1)
        nodes = step.create_dataset("NOE/COO", data=coordinates.T.ravel())
        nodes.attrs["NBR"] = np.int32(len(coordinates))
        families = file.create_group("FAS").create_group(mesh.encode(encoding))
        families.create_group("FAMILLE_ZERO").attrs["NUM"] = np.int32(0)
        for kind, rows in cells.items():
            where = step.create_group(f"MAI/{CELLS[kind]['med']}")
            where.create_dataset("NOD", data=(np.array(rows).T.ravel() + 1).astype(integers)).attrs["NBR"] = np.int32(len(rows))
            family = np.zeros(len(rows), integers)
            for number, of, members, names in cell_groups:
                if of == kind:
                    family[members] = number
                    group = families.create_group(f"ELEME/FAM_{number}")
                    group.attrs["NUM"] = np.int32(number)
                    group.create_group("GRO").attrs["NBR"] = np.int32(len(names))
                    rows_of_names = np.array([list(name.encode(encoding).ljust(80, b"\0")) for name in names], np.int8)
                    item = h5py.h5t.array_create(h5py.h5t.STD_I8LE, (80,))
                    space = h5py.h5s.create_simple((len(names),))
                    data = h5py.h5d.create(group["GRO"].id, b"NOM", item, space)
                    data.write(h5py.h5s.ALL, h5py.h5s.ALL, rows_of_names, item)
            where["FAM"] = family


SQUARE = [[0, 0], [1, 0], [1, 1], [0, 1]]


def write_med_2(path, minor, surplus=0):
    """SQUARE as two TRIA3 and a SEG2 as MED 2 has it: no computation step, DIM instead of ESP, names of groups in one text, before 2.2 families of both
    kinds side by side in the mesh's group. @param surplus columns behind the nodes of the SEG2"""
    with h5py.File(path, "w") as file:
        about = file.create_group("INFOS_GENERALES")
        for name, value in zip(("MAJ", "MIN", "REL"), (2, minor, 2)):
            about.attrs[name] = np.int32(value)
        mesh = file.create_group("ENS_MAA/OLD")
        mesh.attrs.update(DIM=np.int32(2), TYP=np.int32(0), DES=np.bytes_("a square".ljust(200)))
        places = mesh.create_dataset("NOE/COO", data=np.array(SQUARE, float).T.ravel())
        places.attrs.update(NBR=np.int32(4), REP=np.int32(0), NOM=np.bytes_("x".ljust(16) + "y".ljust(16)), UNI=np.bytes_(" " * 32))
        mesh["NOE/FAM"] = np.array([0, 0, 3, 0], np.int32)
        mesh.create_dataset("MAI/TR3/NOD", data=np.array([[1, 2, 3], [1, 3, 4]], np.int32).T.ravel()).attrs["NBR"] = np.int32(2)
        mesh["MAI/TR3/FAM"] = np.array([-1, -1], np.int32)
        mesh.create_dataset("MAI/SE2/NOD", data=np.array([1, 2] + [0] * surplus, np.int32)).attrs["NBR"] = np.int32(1)
        mesh["MAI/SE2/FAM"] = np.array([-2], np.int32)
        for name, number, groups in (("FAMILLE_0", 0, []), ("FAMILLE_NOEUD_3", 3, ["TIP"]), ("FAMILLE_ELEMENT_1", -1, ["BODY"]),
                                     ("FAMILLE_ELEMENT_2", -2, ["BOTTOM", "BOTH"])):
            kind = "" if not number else "NOEUD/" if number > 0 else "ELEME/"
            family = file.create_group(f"ENS_MAA/OLD/FAS/{name}" if minor < 2 else f"FAS/OLD/{kind}{name}")
            family.attrs["NUM"] = np.int32(number)
            if groups:
                family.create_group("GRO").attrs["NBR"] = np.int32(len(groups))
                family["GRO"].create_dataset("NOM", data=np.frombuffer("".join(group.ljust(80) for group in groups).encode(), np.int8))
        for path, count in (("NOE", 4), ("NOE/FAM", 4), ("MAI/TR3", 2), ("MAI/TR3/FAM", 2), ("MAI/SE2", 1), ("MAI/SE2/FAM", 1)):
            mesh[path].attrs["NBR"] = np.int32(count)


class LireMaillage(OperatorTest):
    def setUp(self):
        super().setUp()
        self.file = self.folder / "mesh.med"

    def read(self, **keywords):
        return self.run_command("LIRE_MAILLAGE", keywords, result="mesh_1", label="MA", units={20: self.file})

    def refuses(self, identifier, *words, **keywords):
        return self.assert_refuses(identifier, "LIRE_MAILLAGE", keywords, *words, result="mesh_1", units={20: self.file})

    # ------------------------------------------------------------------------------------------ what it reads

    def test_a_mesh_with_its_groups_becomes_a_concept(self):
        write_med(self.file, SQUARE, {"SEG2": [[0, 1]], "TRIA3": [[0, 1, 2], [0, 2, 3]]},
                  [(-1, "TRIA3", [0, 1], ["BODY"]), (-2, "SEG2", [0], ["BOTTOM", "BOTH"])])
        run = self.read()
        self.assertEqual(run.status, 0, run.stderr)
        self.assertEqual(self.ids(run), [])
        mesh = self.read_mesh("mesh_1")
        self.assertEqual(mesh.dimension, 2)
        self.assertEqual(mesh.types, ["SEG2", "TRIA3", "TRIA3"])
        self.assertEqual(mesh.cells, [[0, 1], [0, 1, 2], [0, 2, 3]])
        np.testing.assert_array_equal(mesh.coordinates, np.column_stack([SQUARE, np.zeros(4)]))
        self.assertEqual({name: list(members) for name, members in mesh.cell_groups.items()},
                         {"BODY": [1, 2], "BOTTOM": [0], "BOTH": [0]})
        attributes = self.attributes("mesh_1")
        self.assertEqual((attributes["lacon_type"], attributes["label"], attributes["command"]), ("mesh", "MA", "LIRE_MAILLAGE"))
        self.assertEqual(json.loads(attributes["keywords"])["UNITE"], 20)
        for line in ("Mesh MA", "nodes                              4", "TRIA3                            2", "BODY"):
            self.assertIn(line, run.stdout)

    def test_files_of_version_2(self):
        """That of 2.3 is one for libmed's own reader of such files as well: read behind its conversion, it is the same mesh."""
        for minor, surplus, converts in ((3, 0, False), (1, 1, False), (3, 0, True)):
            write_med_2(self.file, minor, surplus)
            if converts:
                made = self.folder / "made.med"
                self.med_tool("medimport", str(self.file), str(made))
                made.replace(self.file)
            run = self.read()
            self.assertEqual((run.status, self.ids(run)), (0, []), run.stderr)
            mesh = self.read_mesh("mesh_1")
            self.assertEqual((mesh.dimension, mesh.types, mesh.cells), (2, ["SEG2", "TRIA3", "TRIA3"], [[0, 1], [0, 1, 2], [0, 2, 3]]))
            np.testing.assert_array_equal(mesh.coordinates[:, :2], SQUARE)
            self.assertEqual({name: list(members) for name, members in mesh.cell_groups.items()}, {"BODY": [1, 2], "BOTTOM": [0], "BOTH": [0]})
            self.assertEqual({name: list(members) for name, members in mesh.node_groups.items()}, {"TIP": [2]})

    def test_bytes_behind_the_end_are_nothing(self):
        """Some copies add a line to it; of files of a base that is damage."""
        write_med(self.file, SQUARE, {"QUAD4": [[0, 1, 2, 3]]})
        self.file.write_bytes(self.file.read_bytes() + b"\n")
        self.assertEqual(self.read().status, 0)

    def test_a_mesh_is_chosen_by_its_name(self):
        write_med(self.file, SQUARE, {"QUAD4": [[0, 1, 2, 3]]}, mesh="ONE")
        self.assertEqual(self.read(NOM_MED="ONE").status, 0)
        self.refuses("MED_5", "'TWO'", "'ONE'", NOM_MED="TWO")

    def test_clockwise_bodies_are_reversed_and_counted_and_skins_stay(self):
        write_med(self.file, SQUARE, {"SEG2": [[1, 0]], "TRIA3": [[0, 1, 2], [0, 3, 2]]})
        run = self.read()
        self.assertEqual((run.status, self.ids(run)), (0, ["LIRE_1"]))
        self.assertIn("1 body cells of negative volume are reversed (M3)", run.stderr)
        self.assertEqual(self.read_mesh("mesh_1").cells, [[1, 0], [0, 1, 2], [0, 2, 3]])

    def test_every_solid_has_positive_volume_after_reading_in_either_order(self):
        """Files in MED's node order come through the permutation, files of the other orientation through the mirror."""
        for kind, row in CELLS.items():
            if len(row["nodes"][0]) < 3:
                continue
            points = np.array(row["nodes"])
            for mirrored in (False, True):
                order = np.array(row["mirror"]) if mirrored else np.arange(len(points))
                nodes = np.empty(len(points), int)
                nodes[row["med_permutation"]] = order
                write_med(self.file, points, {kind: [list(nodes)]})
                run = self.read()
                self.assertEqual((run.status, self.ids(run)), (0, ["LIRE_1"] if mirrored else []), f"{kind} {mirrored} {run.stderr}")
                self.assertEqual(self.read_mesh("mesh_1").cells, [list(range(len(points)))], kind)

    def test_checks_inform_and_can_be_switched_off(self):
        write_med(self.file, SQUARE + [[5, 5]], {"QUAD4": [[0, 1, 2, 3], [1, 2, 3, 0]]})
        run = self.read()
        self.assertEqual((run.status, self.ids(run)), (0, ["LIRE_3", "LIRE_7"]))  # two body cells in the same place are an alarm
        self.assertEqual([message["severity"] for message in run.messages], ["I", "A"])
        self.assertIn("N5", run.stderr)
        self.assertIn("M2", run.stderr)
        self.assertEqual(self.ids(self.read(VERI_MAIL=[{"VERIF": "NON"}])), [])
        write_med(self.file, SQUARE, {"QUAD4": [[0, 1, 2, 3]], "SEG2": [[0, 1], [1, 0]]})
        self.assertEqual(self.ids(self.read()), ["LIRE_4"])

    def test_flat_cells_are_told(self):
        write_med(self.file, [[0, 0], [1, 0], [1, 1e-4]], {"TRIA3": [[0, 1, 2]]})
        self.assertEqual(self.ids(self.read()), ["LIRE_5"])
        self.assertEqual(self.ids(self.read(VERI_MAIL=[{"APLAT": 1e-5}])), [])

    def test_a_place_that_costs_digits_is_told(self):
        """Nodes that no cell has say nothing of a mesh's place; nor does its unit of length."""
        square = np.array(SQUARE, float)
        for points, ids in ((square + 1e5, []), (1e-9 * square + 1e-4, []), ([*(square + 1e5), [1e12, 0]], ["LIRE_3"]),
                            (square + [0, -2e7], ["LIRE_6"]), (1e-9 * square + 1e-1, ["LIRE_6"])):
            write_med(self.file, points, {"QUAD4": [[0, 1, 2, 3]]})
            run = self.read()
            self.assertEqual((run.status, self.ids(run)), (0, ids), run.stderr)
        self.assertRegex(run.stderr, "<A> <LIRE_6> the mesh, of the size 1e-09, lies 0.1 from the origin: 7 digits")
        self.assertEqual(self.ids(self.read(VERI_MAIL=[{"VERIF": "NON"}])), [])

    def test_the_box_is_printed_on_demand(self):
        write_med(self.file, SQUARE, {"QUAD4": [[0, 1, 2, 3]]})
        self.assertNotIn("X from", self.read().stdout)
        self.assertIn("X from 0 to 1", self.read(INFO=2).stdout)

    # ------------------------------------------------------------------------------------------ what it refuses

    def test_names_that_are_not_utf_8_are_latin_1(self):
        for encoding, ids in (("utf-8", []), ("latin-1", ["FORMAT_1"])):
            write_med(self.file, SQUARE, {"QUAD4": [[0, 1, 2, 3]]}, [(-1, "QUAD4", [0], ["Körper", "plain"])], "Gerät", encoding=encoding)
            for chosen in ({}, {"NOM_MED": "Gerät"}):
                with self.subTest(encoding=encoding, **chosen):
                    run = self.read(**chosen)
                    self.assertEqual((run.status, self.ids(run)), (0, ids), run.stderr)
                    mesh = self.read_mesh("mesh_1")
                    self.assertEqual((mesh.name, list(mesh.cell_groups)), ("Gerät", ["Körper", "plain"]))
            self.refuses("MED_5", "'Gerät'", "'other'", NOM_MED="other")

    def test_missing_file(self):
        self.refuses("MED_1", str(self.file), "no such file")

    def test_no_hdf5(self):
        self.file.write_text("not a mesh", encoding="utf-8")
        self.refuses("MED_2", "not an HDF5 file")

    def test_hdf5_but_not_med(self):
        h5py.File(self.file, "w").close()
        self.refuses("MED_2", "INFOS_GENERALES")

    def test_med_without_mesh(self):
        with h5py.File(self.file, "w") as file:
            for name, value in zip(("MAJ", "MIN", "REL"), (4, 1, 0)):
                file.require_group("INFOS_GENERALES").attrs[name] = np.int32(value)
        self.refuses("MED_4")

    def test_folded_cells_name_cell_and_group(self):
        write_med(self.file, SQUARE, {"QUAD4": [[0, 2, 1, 3]]}, [(-1, "QUAD4", [0], ["FOLDED"])])
        self.refuses("LIRE_2", "M1", "QUAD4", "FOLDED")

    def test_cells_without_volume(self):
        write_med(self.file, [[0, 0], [1, 0], [2, 0]], {"TRIA3": [[0, 1, 2]]})
        self.refuses("LIRE_2", "M1")

    def test_polygons(self):
        write_med(self.file, SQUARE, {"QUAD4": [[0, 1, 2, 3]]})
        with h5py.File(self.file, "a") as file:
            file.create_group(f"ENS_MAA/MESH/{STEP}/MAI/POG")
        self.refuses("MED_6", "polygons")

    def test_unit_without_file(self):
        self.assert_refuses("ORDER_5", "LIRE_MAILLAGE", {"UNITE": 21}, "21", result="mesh_1", units={20: self.file})

    def test_base_that_cannot_be_written(self):
        write_med(self.file, SQUARE, {"QUAD4": [[0, 1, 2, 3]]})
        self.base.rmdir()
        self.base.write_text("a file where the base should be", encoding="utf-8")
        self.refuses("BASE_3")


class PeerMeshes(OperatorTest):
    """Every mesh of the peer's LAC tests becomes a concept. Its bodies are sound; those that had to be reversed are counted."""

    def test_all(self):
        folder = SHARED_CASES / "meshes"
        if not folder.is_dir():
            self.skipTest(f"no folder {folder}: set LACON_SHARED_CASES")
        with open(os.path.join(os.path.dirname(__file__), "..", "unit", "structures", "peer_meshes.json"), encoding="utf-8") as file:
            expected = json.load(file)
        for name, row in expected.items():
            with self.subTest(name):
                run = self.run_command("LIRE_MAILLAGE", {}, result="mesh_1", units={20: folder / name})
                self.assertEqual(run.status, 0, run.stderr)
                mesh = self.read_mesh("mesh_1")
                self.assertEqual(len(mesh.coordinates), row["nodes"])
                self.assertEqual({name: len(members) for name, members in mesh.cell_groups.items()},
                                 {name: sum(counts.values()) for name, counts in row["cell_groups"].items()})


if __name__ == "__main__":
    unittest.main()
