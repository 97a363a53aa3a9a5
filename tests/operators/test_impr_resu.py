"""IMPR_RESU alone: MED files that the MED library's own tools accept and read back, VTU files parsed here, listings."""

import base64
import json
import pathlib
import shutil
import subprocess
import sys
import unittest
import xml.etree.ElementTree

import h5py
import numpy as np

from lacon_test import CELLS, OperatorTest, concept

# Two quadrangles side by side on the skin cell M1 (slave) and M2; cells of the two types interleave.
POINTS = [[0, 0], [1, 0], [2, 0], [0, 1], [1, 1], [2, 1]]
MESH_CELLS = [("SEG2", [0, 1]), ("QUAD4", [0, 1, 4, 3]), ("SEG2", [1, 2]), ("QUAD4", [1, 2, 5, 4])]
CELL_GROUPS = {"SLAVE": [0], "BODY": [1, 3], "LEFT_BODY": [1]}
NODE_GROUPS = {"BOTTOM": [0, 1, 2], "CORNER <&>": [5]}
INSTANTS = [0.0, 0.5, 1.0]
POINTS_PER_CELL = 4


def displacement(order):
    """DEPL with LAGS_C on the nodes 0 and 1 only."""
    values = np.array([[0.1 * n + order, -0.2 * n, -25.0 * (n + 1) * (n < 2)] for n in range(6)])
    present = np.ones((6, 3), int)
    present[2:, 2] = 0
    return {"quantity": "DEPL_R", "location": "NOEU", "components": ["DX", "DY", "LAGS_C"], "support": range(6), "values": values,
            "present": present}


def contact(order):
    return {"quantity": "CLAC_R", "location": "ELEM", "components": ["CONT", "PRES"], "support": [0], "values": [[1.0, -25.0 * order]]}


def stress_at_points(order):
    return {"quantity": "SIEF_R", "location": "ELGA", "components": ["SIXX", "SIYY"], "support": [1, 3],
            "offset": [0, POINTS_PER_CELL, 2 * POINTS_PER_CELL], "values": np.arange(16.0) + 100 * order}


def stress_at_cell_nodes(order):
    return {"quantity": "SIEF_R", "location": "ELNO", "components": ["SIXX"], "support": [3], "offset": [0, 4],
            "values": [1.0, 2.0, 3.0, 4.0]}


class ImprResu(OperatorTest):
    def setUp(self):
        super().setUp()
        self.write_mesh("mesh_1", POINTS, MESH_CELLS, CELL_GROUPS, NODE_GROUPS, label="MA")
        self.write_result("result_2", "mesh_1", INSTANTS, {
            "DEPL": {k: displacement(k) for k in range(3)}, "CONT_ELEM": {k: contact(k) for k in (1, 2)},
            "SIEF_ELGA": {k: stress_at_points(k) for k in range(3)}, "SIEF_ELNO": {2: stress_at_cell_nodes(2)}}, label="U")
        self.file = self.folder / "out.med"

    def print(self, resu, form="MED", append=False, **more):
        return self.run_order("impr_resu", self.order(resu, form, append, **more))

    def order(self, resu, form="MED", append=False, **more):
        defaults = {"PRECISION": 1e-6, "CRITERE": "RELATIF", "INFO_MAILLAGE": "NON", "IMPR_COOR": "NON", "IMPR_NOM_VARI": "OUI"}
        resu = resu if isinstance(resu, list) else [resu]
        return {"format": 1, "command": "IMPR_RESU", "base": str(self.base), "units": {"80": str(self.file)},
                "append": ["80"] if append else [], "source": "study.comm:9",
                "keywords": {"FORMAT": form, "UNITE": 80, "PROC0": "OUI", "INFO": 1, "RESU": [{**defaults, **one} for one in resu], **more}}

    def refuses(self, identifier, resu, *words, form="MED", append=False):
        before = self.snapshot()
        self.assert_refused(self.print(resu, form, append), identifier, *words)
        self.assertEqual(self.snapshot(), before)

    U = {"RESULTAT": concept("result_2")}
    MA = {"MAILLAGE": concept("mesh_1")}

    # ------------------------------------------------------------------------------------------ oracles

    def library(self, file=None):
        """What the MED library reads."""
        return self.med_library(file or self.file)

    # ------------------------------------------------------------------------------------------ MED

    # ------------------------------------------------------------------------------------------ gmsh's and code_aster's text

    def read_back(self, form):
        """The mesh that LIRE_MAILLAGE finds in the file."""
        run = self.run_command("LIRE_MAILLAGE", {"FORMAT": form}, result="mesh_9", label="BACK", units={20: self.file})
        self.assertEqual(run.status, 0, run.stderr)
        return self.read_mesh("mesh_9")

    def test_meshes_come_back_from_the_texts_of_gmsh_and_code_aster(self):
        mesh = self.read_mesh("mesh_1")
        def words(groups):
            return {name.replace(" ", "_"): members for name, members in groups.items()}

        for form, node_groups in (("GMSH", {}), ("ASTER", words(mesh.node_groups))):
            self.assertEqual(self.print(self.MA, form).status, 0)
            back = self.read_back(form)
            np.testing.assert_array_equal(back.coordinates, mesh.coordinates)
            cells = [(kind, list(nodes)) for kind, nodes in zip(mesh.types, mesh.cells)]
            found = [(kind, list(nodes)) for kind, nodes in zip(back.types, back.cells)]
            self.assertEqual(sorted(found), sorted(cells))
            by_cell = {name: sorted(found[m] for m in members) for name, members in back.cell_groups.items()}
            groups = words(mesh.cell_groups) if form == "ASTER" else mesh.cell_groups
            self.assertEqual({name: members for name, members in by_cell.items() if members},
                             {name: sorted(cells[m] for m in members) for name, members in groups.items() if len(members)})
            self.assertEqual({n: list(m) for n, m in back.node_groups.items()}, {n: list(m) for n, m in node_groups.items()})

    def test_fields_for_gmsh_are_views_behind_their_mesh(self):
        self.assertEqual(self.print({**self.U, "NOM_CHAM": ["DEPL", "CONT_ELEM", "SIEF_ELGA", "SIEF_ELNO"], "NUME_ORDRE": [2]}, "GMSH").status, 0)
        views = {}
        lines = self.file.read_text().splitlines()
        for at, line in enumerate(lines):
            if line.endswith("Data") and not line.startswith("$End"):
                count = int(lines[at + 8])
                self.assertEqual((float(lines[at + 4]), int(lines[at + 6])), (INSTANTS[2], 2))
                views[lines[at + 2].strip('"')] = (line, int(lines[at + 7]), [[float(v) for v in row.split()] for row in lines[at + 9:at + 9 + count]])
        depl = displacement(2)
        self.assertEqual(set(views), {"DEPL", "DEPL_LAGS_C", "CONT_ELEM_CONT", "CONT_ELEM_PRES", "SIEF_ELGA_SIXX_MEAN", "SIEF_ELGA_SIYY_MEAN", "SIEF_ELNO_SIXX"})
        self.assertEqual(views["DEPL"], ("$NodeData", 3, [[n + 1, *depl["values"][n][:2], 0.0] for n in range(6)]))
        self.assertEqual([row[0] for row in views["DEPL_LAGS_C"][2]], [1, 2])
        self.assertEqual(views["CONT_ELEM_PRES"], ("$ElementData", 1, [[1, -50.0]]))
        points = np.asarray(stress_at_points(2)["values"], float).reshape(2, -1, 2)
        self.assertEqual(views["SIEF_ELGA_SIYY_MEAN"][2], [[c + 1, v] for c, v in zip((1, 3), points.mean(axis=1)[:, 1])])
        self.assertEqual(views["SIEF_ELNO_SIXX"], ("$ElementNodeData", 1, [[4, 4, 1.0, 2.0, 3.0, 4.0]]))
        self.assertEqual(len(self.read_back("GMSH").cells), len(MESH_CELLS))
        self.refuses("IMPR_8", self.U, "RESU/RESULTAT", form="ASTER")

    def test_mesh_is_read_back_by_the_library_and_by_lire_maillage(self):
        run = self.print(self.MA)
        self.assertEqual(run.status, 0, run.stderr)
        self.assertIn(f"mesh MA: {self.file}", run.stdout)
        mesh, = self.library()["meshes"]
        self.assertEqual((mesh["name"], mesh["space"], mesh["dimension"]), ("MA", 2, 2))
        self.assertEqual(mesh["coordinates"], np.ravel(POINTS).tolist())
        self.assertEqual(mesh["cells"], {"SE2": [1, 2, 2, 3], "QU4": [1, 2, 5, 4, 2, 3, 6, 5]})
        groups = {tuple(sorted(names)) for names in mesh["families"].values()}
        self.assertEqual(groups, {(), ("SLAVE",), ("BODY",), ("BODY", "LEFT_BODY"), ("BOTTOM",), ("CORNER <&>",)})
        again = self.run_command("LIRE_MAILLAGE", {}, result="mesh_9", units={20: self.file})
        self.assertEqual(again.status, 0, again.stderr)
        back = self.read_mesh("mesh_9")
        self.assertEqual(back.cells, [[0, 1], [1, 2], [0, 1, 4, 3], [1, 2, 5, 4]])
        self.assertEqual({n: list(m) for n, m in back.cell_groups.items()}, {"SLAVE": [0], "BODY": [2, 3], "LEFT_BODY": [2]})
        self.assertEqual({n: list(m) for n, m in back.node_groups.items()}, NODE_GROUPS)

    def test_numbers_of_cells_are_in_the_file(self):
        self.print(self.MA)
        with h5py.File(self.file) as file:
            cells = file["ENS_MAA/MA/-0000000000000000001-0000000000000000001/MAI"]
            self.assertEqual((cells["SE2/NUM"][()].tolist(), cells["QU4/NUM"][()].tolist()), ([1, 3], [2, 4]))

    def test_every_group_of_the_file_tracks_and_indexes_the_order_of_its_links(self):
        """Without it the MED 4.1 tools cannot list families."""
        self.print(self.U)
        bad = []
        with h5py.File(self.file) as file:
            both = h5py.h5p.CRT_ORDER_TRACKED | h5py.h5p.CRT_ORDER_INDEXED

            def look(name, item):
                if isinstance(item, h5py.Group) and item.id.get_create_plist().get_link_creation_order() != both:
                    bad.append(name)

            look("/", file["/"])
            file.visititems(look)
        self.assertEqual(bad, [])

    def test_fields_of_all_instants_come_back_from_the_library(self):
        run = self.print(self.U)
        self.assertEqual(run.status, 0, run.stderr)
        self.assertIn(f"field U_______DEPL at 3 instants: {self.file}", run.stdout)
        fields = self.library()["fields"]
        self.assertEqual(set(fields), {"U_______DEPL", "U_______DEPL_LAGS_C", "U_______CONT_ELEM", "U_______SIEF_ELGA",
                                       "U_______SIEF_ELNO"})
        depl = fields["U_______DEPL"]
        self.assertEqual((depl["mesh"], depl["components"]), ("MA", ["DX", "DY"]))
        self.assertEqual([(s["order"], s["instant"]) for s in depl["steps"]], list(zip(range(3), INSTANTS)))
        for order, step in enumerate(depl["steps"]):
            on_nodes = step["values"]["NOE"]
            self.assertEqual((on_nodes["profile"], on_nodes["points"]), (None, 1))
            np.testing.assert_array_equal(np.reshape(on_nodes["values"], (6, 2)), displacement(order)["values"][:, :2])
        carriers = fields["U_______DEPL_LAGS_C"]["steps"][2]["values"]["NOE"]
        self.assertEqual((carriers["profile"], carriers["values"]), ([1, 2], [-25.0, -50.0]))
        contact_steps = fields["U_______CONT_ELEM"]["steps"]
        self.assertEqual([s["order"] for s in contact_steps], [1, 2])
        self.assertEqual(list(contact_steps[1]["values"]), ["MAI.SE2"])
        slaves = contact_steps[1]["values"]["MAI.SE2"]
        self.assertEqual((slaves["profile"], slaves["values"]), ([1], [1.0, -50.0]))
        points = fields["U_______SIEF_ELGA"]["steps"][1]["values"]["MAI.QU4"]
        self.assertEqual((points["points"], points["profile"]), (POINTS_PER_CELL, None))
        self.assertEqual(points["values"], (np.arange(16.0) + 100).tolist())
        corners = fields["U_______SIEF_ELNO"]["steps"][0]["values"]["NOE.QU4"]
        self.assertEqual((corners["profile"], corners["points"], corners["values"]), ([2], 4, [1.0, 2.0, 3.0, 4.0]))

    def test_parts_are_placed_on_the_whole_mesh_by_the_library_and_by_meshio(self):
        """The storage that is asked for as MED_GLOBAL_STMODE: a value's place is the number of its node or cell in the whole mesh."""
        self.assertEqual(self.print(self.U).status, 0)
        fields = self.library()["fields"]
        parts = 0
        for field in fields.values():
            for step in field["steps"]:
                for entity, read in step["values"].items():
                    size = len(field["components"]) * read["points"]
                    count = {"NOE": 6, "QU4": 2, "SE2": 1}[entity.rpartition(".")[2]]
                    members = np.array(read["profile"] or range(1, count + 1)) - 1
                    whole = np.reshape(read["global"], (-1, size))
                    self.assertGreater(len(whole), members.max())
                    np.testing.assert_array_equal(whole[members], np.reshape(read["values"], (-1, size)))
                    parts += read["profile"] is not None
        self.assertGreater(parts, 3)

    def test_meshio_reads_a_field_on_a_part(self):
        """Of nodes: meshio takes a field of cells only where every type of cells has it."""
        try:
            import meshio
        except ImportError:
            self.skipTest("python3-meshio is not installed")
        self.assertEqual(self.print({**self.U, "NOM_CHAM": ["DEPL"], "NUME_ORDRE": [2]}).status, 0)
        read = meshio.read(self.file)
        np.testing.assert_array_equal(read.point_data["U_______DEPL"], displacement(2)["values"][:, :2])
        np.testing.assert_array_equal(read.point_data["U_______DEPL_LAGS_C"][:2].ravel(), [-25.0, -50.0])
        self.assertTrue(np.isnan(read.point_data["U_______DEPL_LAGS_C"][2:]).all())

    def test_integration_points_are_those_of_the_reference_cell(self):
        self.print({**self.U, "NOM_CHAM": ["SIEF_ELGA"]})
        with h5py.File(self.file) as file:
            name, = file["GAUSS"]
            here = file["GAUSS"][name]
            corners = here["COO"][()].reshape(2, -1).T
            np.testing.assert_array_equal(corners, CELLS["QUAD4"]["nodes"])
            points = here["GAU"][()].reshape(2, -1).T
            weights = here["VAL"][()]
        # the 2 x 2 Gauss rule: degree 3 in each direction
        np.testing.assert_allclose(np.abs(points), 1 / np.sqrt(3), rtol=0, atol=1e-15)
        self.assertAlmostEqual(weights.sum(), 4.0, delta=1e-14)
        self.assertAlmostEqual(weights @ (points[:, 0] ** 2 * points[:, 1] ** 2), 4 / 9, delta=1e-14)

    def test_solids_keep_their_shape_in_the_node_order_of_med(self):
        """ELNO values equal to a node's first coordinate belong to the node whose coordinate it is, as the library reads both."""
        for kind in ("TETRA10", "PENTA15", "PYRAM13", "HEXA27"):
            points = np.array(CELLS[kind]["nodes"], float)
            self.write_mesh("mesh_3", points, [(kind, list(range(len(points))))], label="MB")
            self.write_result("result_4", "mesh_3", [0.0], {"SIEF_ELNO": {0: {
                "quantity": "SIEF_R", "location": "ELNO", "components": ["SIXX", "SIYY", "SIZZ"], "support": [0],
                "offset": [0, len(points)], "values": points}}}, label="V")
            self.print({"RESULTAT": concept("result_4")})
            read = self.library()
            mesh, = read["meshes"]
            (of, connectivity), = mesh["cells"].items()
            values = np.reshape(read["fields"]["V_______SIEF_ELNO"]["steps"][0]["values"]["NOE." + of]["values"], (-1, 3))
            np.testing.assert_array_equal(values, np.reshape(mesh["coordinates"], (-1, 3))[np.array(connectivity) - 1])

    def test_the_tools_of_med_accept_and_list_the_file(self):
        self.print([self.MA, self.U])
        self.assert_conforms(self.file)
        listing = self.med_tool("mdump4", str(self.file), "NODALE", "FULL_INTERLACE", "LECTURE_EN_TETE_SEULEMENT")
        for word in ("<<MA>>", "BODY", "CORNER <&>", "U_______DEPL", "U_______CONT_ELEM", "FIN DU DUMP"):
            self.assertIn(word, listing)

    def test_several_commands_on_one_unit_end_in_one_file(self):
        self.assertEqual(self.print(self.MA).status, 0)
        self.assertEqual(self.print({**self.U, "NOM_CHAM": ["DEPL"]}, append=True).status, 0)
        self.assertEqual(self.print({**self.U, "NOM_CHAM": ["CONT_ELEM"]}, append=True).status, 0)
        read = self.library()
        self.assertEqual([m["name"] for m in read["meshes"]], ["MA"])
        self.assertEqual(set(read["fields"]), {"U_______DEPL", "U_______DEPL_LAGS_C", "U_______CONT_ELEM"})
        self.assert_conforms(self.file)

    def test_a_mesh_and_a_result_may_be_one_occurrence(self):
        both = {**self.MA, **self.U, "NOM_CHAM": ["DEPL"]}
        self.assertEqual(self.print(both).status, 0)
        read = self.library()
        self.assertEqual([m["name"] for m in read["meshes"]], ["MA"])
        self.assertEqual(set(read["fields"]), {"U_______DEPL", "U_______DEPL_LAGS_C"})
        self.assertEqual(self.print(both, form="RESULTAT").status, 0)
        self.assertRegex(self.file.read_text(encoding="utf-8"), r"(?s)^\nmesh MA.*\n\nresult U, field DEPL")
        self.assertEqual(self.print(both, form="VTU").status, 0)
        self.assertEqual([name for _, name, _ in self.collection()], ["U"] * 3)

    def test_a_file_of_an_earlier_run_is_replaced(self):
        self.file.write_text("the file of an earlier run", encoding="utf-8")
        self.assertEqual(self.print(self.MA).status, 0)
        self.assertEqual(self.library()["fields"], {})

    def test_two_meshes_of_one_name_are_both_there(self):
        self.write_mesh("mesh_3", POINTS[:4], [("SEG2", [0, 1])], label="MA")
        self.assertEqual(self.print([self.MA, {"MAILLAGE": concept("mesh_3")}]).status, 0)
        self.assertEqual(sorted(m["name"] for m in self.library()["meshes"]), ["MA", "MA_2"])

    def test_selection_of_instants_fields_components_and_parts(self):
        self.print({**self.U, "NOM_CHAM": ["DEPL"], "NOM_CMP": ["DY"], "INST": [0.5000001], "GROUP_NO": ["BOTTOM"]})
        fields = self.library()["fields"]
        self.assertEqual(list(fields), ["U_______DEPL"])
        self.assertEqual(fields["U_______DEPL"]["components"], ["DY"])
        step, = fields["U_______DEPL"]["steps"]
        self.assertEqual((step["order"], step["instant"]), (1, 0.5))
        self.assertEqual((step["values"]["NOE"]["profile"], step["values"]["NOE"]["values"]), ([1, 2, 3], [-0.0, -0.2, -0.4]))
        self.print({**self.U, "NUME_ORDRE": [2], "GROUP_MA": ["LEFT_BODY"], "NOM_CHAM": ["DEPL", "SIEF_ELGA"],
                    "NOM_CHAM_MED": ["MOVE", "STRESS"]})
        fields = self.library()["fields"]
        self.assertEqual(fields["MOVE"]["steps"][0]["values"]["NOE"]["profile"], [1, 2, 4, 5])
        self.assertEqual(fields["STRESS"]["steps"][0]["values"]["MAI.QU4"]["profile"], [1])
        self.print({**self.U, "NOM_CHAM": ["DEPL", "SIEF_ELGA"], "NOM_RESU_MED": "PRESS"})
        self.assertEqual(list(self.library()["fields"]), ["PRESS___DEPL", "PRESS___DEPL_LAGS_C", "PRESS___SIEF_ELGA"])

    def test_a_field_without_value_on_the_part_is_told(self):
        run = self.print({**self.U, "NOM_CHAM": ["CONT_ELEM", "DEPL"], "GROUP_MA": ["BODY"]})
        self.assertEqual((run.status, self.ids(run)), (0, ["IMPR_5"]))

    # ------------------------------------------------------------------------------------------ what it refuses

    def test_bad_orders_leave_everything_as_it_was(self):
        self.print(self.MA)
        for identifier, resu, *words in (
                ("IMPR_1", {**self.U, "NOM_CHAM": ["SIEF_NOEU"]}, "SIEF_NOEU", "CONT_ELEM, DEPL"),
                ("IMPR_2", {**self.U, "NOM_CMP": ["DZ"]}, "DZ"),
                ("IMPR_3", {**self.U, "NOM_CHAM": ["CONT_ELEM"], "GROUP_NO": ["BOTTOM"]}, "CONT_ELEM"),
                ("IMPR_4", {**self.U, "NOM_CHAM": ["DEPL"], "NOM_CHAM_MED": ["A", "B"]}, "2 names"),
                ("RESULT_1", {**self.U, "NOM_CHAM": ["CONT_ELEM"], "INST": [0.0]}, "CONT_ELEM"),
                ("FIELDS_2", {**self.U, "INST": [0.7]}, "0.7"),
                ("FIELDS_1", {**self.U, "NUME_ORDRE": [7]}, "7"),
                ("MESH_1", {**self.U, "GROUP_MA": ["BODI"]}, "BODI", "BODY"),
                ("MESH_1", {**self.U, "GROUP_NO": ["TOP"]}, "TOP"),
                ("BASE_4", {"RESULTAT": concept("mesh_1")}, "mesh"),
                ("BASE_1", {"MAILLAGE": concept("mesh_7")}, "mesh_7"),
                ("MED_12", {**self.U, "NOM_CHAM": ["DEPL"], "NOM_CHAM_MED": ["N" * 65]}, "N" * 65)):
            with self.subTest(identifier):
                self.refuses(identifier, resu, *words, append=True)

    def test_the_pairing_of_a_result_without_contact_is_refused(self):
        for form in ("MED", "VTU", "RESULTAT"):
            self.refuses("IMPR_7", {**self.U, "PAIRING": "OUI"}, "RESU/PAIRING", " U ", form=form)

    def test_a_folder_that_cannot_be_written(self):
        self.file = self.folder / "nowhere" / "out.med"
        for form in ("MED", "VTU", "RESULTAT"):
            self.refuses("BASE_3", self.MA, form=form)

    def test_a_file_that_is_not_med_is_not_added_to(self):
        self.file.write_text("not MED", encoding="utf-8")
        self.refuses("MED_2", self.MA, append=True)
        self.file = self.folder / "out.pvd"
        self.file.write_text("no collection", encoding="utf-8")
        self.refuses("VTU_1", self.MA, form="VTU", append=True)

    # ------------------------------------------------------------------------------------------ VTU

    def collection(self):
        """[(time, name, file)] of the .pvd."""
        root = xml.etree.ElementTree.parse(self.file.with_suffix(".pvd")).getroot()
        self.assertEqual((root.tag, root.get("type")), ("VTKFile", "Collection"))
        return [(float(d.get("timestep")), d.get("name"), self.folder / d.get("file")) for d in root.iter("DataSet")]

    def parts(self):
        """[(time, part)] of the .pvd: ParaView shows one data set of each pair."""
        root = xml.etree.ElementTree.parse(self.file.with_suffix(".pvd")).getroot()
        return [(float(d.get("timestep")), int(d.get("part"))) for d in root.iter("DataSet")]

    def vtu(self, file):
        """Section -> name -> array of a .vtu; lengths are checked against what the file says."""
        root = xml.etree.ElementTree.parse(file).getroot()
        self.assertEqual((root.get("type"), root.get("byte_order"), root.get("header_type")),
                         ("UnstructuredGrid", "LittleEndian", "UInt64"))
        piece = root.find("UnstructuredGrid/Piece")
        sizes = {"PointData": int(piece.get("NumberOfPoints")), "CellData": int(piece.get("NumberOfCells"))}
        sections = {}
        for section in piece:
            arrays = sections.setdefault(section.tag, {})
            for item in section:
                raw = base64.b64decode(item.text)
                length = int(np.frombuffer(raw[:8], "<u8")[0])
                self.assertEqual(length, len(raw) - 8)
                kind = {"Float64": "<f8", "Int64": "<i8", "UInt8": "u1"}[item.get("type")]
                values = np.frombuffer(raw[8:], kind)
                width = int(item.get("NumberOfComponents", 1))
                arrays[item.get("Name")] = values.reshape(-1, width) if width > 1 else values
                if section.tag in sizes:
                    self.assertEqual(len(arrays[item.get("Name")]), sizes[section.tag])
        return sections

    def test_vtu_of_a_result_has_a_file_an_instant_and_their_list(self):
        run = self.print(self.U, "VTU")
        self.assertEqual(run.status, 0, run.stderr)
        self.assertIn(str(self.file.with_suffix(".pvd")), run.stdout)
        steps = self.collection()
        self.assertEqual([(time, name) for time, name, _ in steps], [(t, "U") for t in INSTANTS])
        last = self.vtu(steps[2][2])
        np.testing.assert_array_equal(last["Points"]["Points"], np.column_stack([POINTS, np.zeros(6)]))
        self.assertEqual(last["Cells"]["types"].tolist(), [3, 9, 3, 9])
        self.assertEqual(last["Cells"]["offsets"].tolist(), [2, 6, 8, 12])
        self.assertEqual(last["Cells"]["connectivity"].tolist(), [n for _, nodes in MESH_CELLS for n in nodes])
        nodes, cells = last["PointData"], last["CellData"]
        np.testing.assert_array_equal(nodes["DEPL"], np.column_stack([displacement(2)["values"][:, :2], np.zeros(6)]))
        np.testing.assert_array_equal(nodes["DEPL_LAGS_C"], [-25, -50] + [np.nan] * 4)
        self.assertEqual(nodes["DEPL_LAGS_C_EXISTS"].tolist(), [1, 1, 0, 0, 0, 0])
        self.assertNotIn("DEPL_EXISTS", nodes)
        np.testing.assert_array_equal(cells["CONT_ELEM"], [[1, -50]] + [[np.nan] * 2] * 3)
        self.assertEqual(cells["CONT_ELEM_EXISTS"].tolist(), [1, 0, 0, 0])
        np.testing.assert_array_equal(cells["SIEF_ELGA_MEAN"][[1, 3]], [[203, 204], [211, 212]])
        np.testing.assert_array_equal(cells["SIEF_ELNO_MEAN"], [np.nan] * 3 + [2.5])
        self.assertEqual(cells["GROUP_MA BODY"].tolist(), [0, 1, 0, 1])
        self.assertEqual(nodes["GROUP_NO CORNER <&>"].tolist(), [0, 0, 0, 0, 0, 1])

    def test_vtu_keeps_displacements_apart_from_other_unknowns(self):
        """Three components would be a vector that bodies are displaced by."""
        values = np.arange(24.0).reshape(6, 4)
        present = np.ones((6, 4), int)
        present[2:, 3] = 0
        self.write_result("result_4", "mesh_1", INSTANTS[:1], {"DEPL": {0: {
            "quantity": "DEPL_R", "location": "NOEU", "components": ["DX", "DY", "PHI", "LAGS_C"], "support": range(6), "values": values,
            "present": present}}}, label="V")
        self.assertEqual(self.print({"RESULTAT": concept("result_4")}, "VTU").status, 0)
        nodes = self.vtu(self.collection()[0][2])["PointData"]
        np.testing.assert_array_equal(nodes["DEPL"], np.column_stack([values[:, :2], np.zeros(6)]))
        np.testing.assert_array_equal(nodes["DEPL_PHI"], values[:, 2])
        np.testing.assert_array_equal(nodes["DEPL_LAGS_C"], [3, 7] + [np.nan] * 4)

    def test_vtu_of_several_commands_share_the_list(self):
        self.print(self.MA, "VTU")
        self.print({**self.U, "NUME_ORDRE": [2]}, "VTU", append=True)
        self.assertEqual([(time, name) for time, name, _ in self.collection()], [(0.0, "MA"), (1.0, "U")])
        self.assertEqual(len({file for _, _, file in self.collection()}), 2)
        self.print({**self.U, "NOM_CHAM": ["CONT_ELEM"], "NUME_ORDRE": [2]}, "VTU", append=True)
        self.assertEqual(self.parts(), [(0.0, 0), (1.0, 0), (1.0, 1)])

    def test_vtu_cells_have_the_node_order_of_vtk(self):
        """Mid nodes lie on the edges (of a HEXA27 also in the faces) that VTK's documentation of its cells lists."""
        hexa = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
        mid_nodes = {
            21: [(0, 1)], 22: [(0, 1), (1, 2), (2, 0)], 23: [(0, 1), (1, 2), (2, 3), (3, 0)],
            28: [(0, 1), (1, 2), (2, 3), (3, 0), (0, 1, 2, 3)],
            24: [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)],
            26: [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)],
            27: [(0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 4), (2, 4), (3, 4)],
            25: hexa,
            29: hexa + [(0, 3, 7, 4), (1, 2, 6, 5), (0, 1, 5, 4), (3, 2, 6, 7), (0, 1, 2, 3), (4, 5, 6, 7), range(8)]}
        seen = set()
        for kind, row in CELLS.items():
            points = np.zeros((len(row["nodes"]), 3))
            points[:, :row["dimension"]] = row["nodes"]
            self.write_mesh("mesh_3", points, [(kind, list(range(len(points))))])
            self.print({"MAILLAGE": concept("mesh_3")}, "VTU")
            read = self.vtu(self.collection()[0][2])
            number, = read["Cells"]["types"].tolist()
            nodes = read["Points"]["Points"][read["Cells"]["connectivity"]]
            seen.add(number)
            for k, of in enumerate(mid_nodes.get(number, [])):
                np.testing.assert_allclose(nodes[row["vertices"] + k], nodes[list(of)].mean(axis=0), atol=1e-15, err_msg=f"{kind} {k}")
            self.assertEqual(len(nodes), row["vertices"] + len(mid_nodes.get(number, [])), kind)
        self.assertEqual(seen, {1, 3, 5, 9, 10, 12, 13, 14, *mid_nodes})

    # ------------------------------------------------------------------------------------------ listings

    def table(self, title):
        """Rows of the listing below the line that starts with `title`."""
        lines = self.file.read_text(encoding="utf-8").splitlines()
        at = next(i for i, line in enumerate(lines) if line.startswith(title))
        end = lines.index("", at) if "" in lines[at:] else len(lines)
        return [line.split() for line in lines[at + 1:end]]

    def test_listing_of_fields_has_a_row_a_place(self):
        run = self.print({**self.U, "NUME_ORDRE": [2], "IMPR_COOR": "OUI"}, "RESULTAT")
        self.assertEqual(run.status, 0, run.stderr)
        rows = self.table("result U, field DEPL, order 2, instant 1.0")
        self.assertEqual(rows[0], ["X", "Y", "DX", "DY", "LAGS_C"])
        self.assertEqual(rows[2], ["N2", "1.000000000000E+00", "0.000000000000E+00", "2.100000000000E+00", "-2.000000000000E-01",
                                   "-5.000000000000E+01"])
        self.assertEqual(rows[6][-1], "-")
        self.assertEqual(self.table("result U, field CONT_ELEM")[1], ["M1", "1.000000000000E+00", "-5.000000000000E+01"])
        self.assertEqual(self.table("result U, field SIEF_ELGA")[6][:3], ["M4", "point", "2"])
        self.assertEqual(self.table("result U, field SIEF_ELNO")[2][:3], ["M4", "N3", "2.000000000000E+00"])

    def test_listing_of_extremes(self):
        self.print({**self.U, "NUME_ORDRE": [2], "NOM_CHAM": ["DEPL"], "VALE_MAX": "OUI", "VALE_MIN": "OUI"}, "RESULTAT")
        rows = self.table("result U, field DEPL")
        self.assertEqual(rows, [["greatest", "DX", "2.500000000000E+00", "at", "N6"], ["greatest", "DY", "-0.000000000000E+00", "at", "N1"],
                                ["greatest", "LAGS_C", "-2.500000000000E+01", "at", "N1"], ["least", "DX", "2.000000000000E+00", "at", "N1"],
                                ["least", "DY", "-1.000000000000E+00", "at", "N6"], ["least", "LAGS_C", "-5.000000000000E+01", "at", "N2"]])

    def test_listing_of_a_mesh_and_several_commands(self):
        self.print({**self.MA, "INFO_MAILLAGE": "OUI"}, "RESULTAT")
        self.print({**self.U, "NOM_CHAM": ["CONT_ELEM"]}, "RESULTAT", append=True)
        text = self.file.read_text(encoding="utf-8")
        for word in ("mesh MA", "QUAD4                            2", "X from 0 to 2", "result U, field CONT_ELEM, order 1"):
            self.assertIn(word, text)

    def test_counts_of_the_mesh_beside_any_file(self):
        for form in ("MED", "GMSH", "VTU"):
            with self.subTest(form):
                for said in ("OUI", "NON"):
                    run = self.print({**self.U, "NOM_CHAM": ["DEPL"], "INFO_MAILLAGE": said}, form)
                    self.assertEqual(["X from 0 to 2" in run.stdout, "QUAD4                            2" in run.stdout], [said == "OUI"] * 2, run.stdout)

    def test_words_of_listings_are_refused_elsewhere(self):
        for word in ("IMPR_COOR", "VALE_MAX", "VALE_MIN"):
            self.refuses("IMPR_9", {**self.U, word: "OUI"}, word, "'MED'")


if __name__ == "__main__":
    unittest.main()
