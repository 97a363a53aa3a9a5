"""IMPR_RESU alone: MED files that the MED library's own tools accept and read back, texts of gmsh and code_aster."""

import json
import pathlib
import shutil
import subprocess
import sys
import unittest

import h5py
import numpy as np

from impr_resu_test import INSTANTS, MESH_CELLS, NODE_GROUPS, POINTS, POINTS_PER_CELL, ImprResuTest, displacement, stress_at_points
from lacon_test import CELLS, concept, fill_field


class ImprResu(ImprResuTest):
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
        self.assertEqual({name.removeprefix("U_") for name in views}, {"DEPL", "DEPL_LAGS_C", "CONT_ELEM_CONT", "CONT_ELEM_PRES", "SIEF_ELGA_SIXX_MEAN", "SIEF_ELGA_SIYY_MEAN", "SIEF_ELNO_SIXX"})
        self.assertTrue(all(name.startswith("U_") for name in views))
        self.assertEqual(views["U_DEPL"], ("$NodeData", 3, [[n + 1, *depl["values"][n][:2], 0.0] for n in range(6)]))
        self.assertEqual([row[0] for row in views["U_DEPL_LAGS_C"][2]], [1, 2])
        self.assertEqual(views["U_CONT_ELEM_PRES"], ("$ElementData", 1, [[1, -50.0]]))
        points = np.asarray(stress_at_points(2)["values"], float).reshape(2, -1, 2)
        self.assertEqual(views["U_SIEF_ELGA_SIYY_MEAN"][2], [[c + 1, v] for c, v in zip((1, 3), points.mean(axis=1)[:, 1])])
        self.assertEqual(views["U_SIEF_ELNO_SIXX"], ("$ElementNodeData", 1, [[4, 4, 1.0, 2.0, 3.0, 4.0]]))
        self.assertEqual(len(self.read_back("GMSH").cells), len(MESH_CELLS))
        self.refuses("IMPR_8", self.U, "RESU/RESULTAT", form="ASTER")

    def write_namesake(self, identifier="result_5", mesh="mesh_1"):
        """Another result whose variable had the name of U: made in a loop, or in a function."""
        self.write_result(identifier, mesh, INSTANTS, {"DEPL": {1: {**displacement(1), "values": 7 * displacement(1)["values"]}}}, label="U")
        return {"RESULTAT": concept(identifier), "NOM_CHAM": ["DEPL"], "NUME_ORDRE": [1]}

    def test_results_of_one_name_lose_nothing_in_med(self):
        """In one command and in several; the names do not depend on which."""
        own, namesake = {**self.U, "NOM_CHAM": ["DEPL"], "NUME_ORDRE": [1]}, self.write_namesake()
        for together in (True, False):
            with self.subTest(together=together):
                runs = [self.print([own, namesake])] if together else [self.print(own), self.print(namesake, append=True)]
                self.assertEqual([run.status for run in runs], [0] * len(runs), runs[-1].stderr)
                self.assertEqual(self.ids(runs[-1]), ["FORMAT_2"] * 2)  # of DEPL, and of DEPL_LAGS_C
                self.assertIn(f"'{self.file}'", runs[-1].stderr)
                self.assertIn(f"field U_______DEPL_2: {self.file}", runs[-1].stdout)
                fields = self.library()["fields"]
                self.assertEqual(set(fields), {"U_______DEPL", "U_______DEPL_LAGS_C", "U_______DEPL_2", "U_______DEPL_LAGS_C_2"})
                for name, factor in (("U_______DEPL", 1), ("U_______DEPL_2", 7)):
                    step, = fields[name]["steps"]
                    np.testing.assert_array_equal(np.reshape(step["values"]["NOE"]["values"], (6, 2)), factor * displacement(1)["values"][:, :2])
                again = self.print(own, append=True)  # goes where it was
                self.assertEqual((self.ids(again), set(self.library()["fields"])), ([], set(fields)))
        self.assert_conforms(self.file)

    def test_fields_of_one_name_lose_nothing_in_med(self):
        """Of CHAM_GD: variables of one name."""
        for number, value in ((6, 1.0), (7, 2.0)):
            with self.create(f"field_{number}", "field", "C", ["mesh_1"], mesh="mesh_1", location="NOEU", quantity="DEPL_R", order=0, instant=0.0,
                             name="U") as file:
                fill_field(file, ["DX"], range(6), [value] * 6)
        self.assertEqual(self.print([{"CHAM_GD": concept(f"field_{number}")} for number in (6, 7)]).status, 0)
        read = {name: field["steps"][0]["values"]["NOE"]["values"][0] for name, field in self.library()["fields"].items()}
        self.assertEqual(read, {"C": 1.0, "C_2": 2.0})

    def test_results_of_one_name_are_told_apart_in_gmsh(self):
        own, namesake = {**self.U, "NOM_CHAM": ["DEPL"], "NUME_ORDRE": [1]}, self.write_namesake()
        self.assertEqual(self.print(own, "GMSH").status, 0)
        run = self.print(namesake, "GMSH", append=True)
        self.assertEqual((run.status, self.ids(run)), (0, ["FORMAT_2"]), run.stderr)
        self.assertEqual(self.print({**own, "NUME_ORDRE": [2]}, "GMSH", append=True).status, 0)
        lines = self.file.read_text().splitlines()
        views = [lines[at + 2].strip('"') for at, line in enumerate(lines) if line == "$NodeData"]
        self.assertEqual(views, ["U_DEPL", "U_DEPL_LAGS_C", "U_DEPL_2", "U_DEPL_2_LAGS_C", "U_DEPL", "U_DEPL_LAGS_C"])
        self.assertEqual(len(self.read_back("GMSH").cells), len(MESH_CELLS))

    def test_a_second_mesh_behind_the_first_is_refused(self):
        """By a later command as in one command; fields go on behind their mesh whatever groups it has got."""
        first = {**self.U, "NOM_CHAM": ["DEPL"], "NUME_ORDRE": [1]}
        for form in ("GMSH", "ASTER"):
            self.print(self.MA, form)
            self.assertEqual(self.print(self.MA, form, append=True).status, 0)
            for points, cells in ((np.array(POINTS) + 1, MESH_CELLS), (POINTS, MESH_CELLS[:3]), (POINTS, MESH_CELLS[::-1])):
                self.write_mesh("mesh_3", points, cells, label="MA")
                self.refuses("IMPR_8", {"MAILLAGE": concept("mesh_3")}, "RESU/MAILLAGE", form=form, append=True)
                if form == "GMSH":
                    self.refuses("IMPR_8", self.write_namesake("result_6", "mesh_3"), "RESU/RESULTAT", form=form, append=True)
            self.write_mesh("mesh_3", POINTS, MESH_CELLS, {"NEW": [0]}, label="MA")
            self.refuses("IMPR_8", {"MAILLAGE": concept("mesh_3")}, "RESU/MAILLAGE", form=form, append=True)
        self.assertEqual(self.print(first, "GMSH").status, 0)
        self.assertEqual(self.print(self.write_namesake("result_6", "mesh_3"), "GMSH", append=True).status, 0)

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

    def test_a_model_is_one_on_the_mesh_of_all_that_is_shown(self):
        self.write_mesh("mesh_3", POINTS, MESH_CELLS, label="OTHER")
        for number, mesh in ((4, "mesh_1"), (5, "mesh_3")):
            self.write_model(f"model_{number}", mesh, ["D_PLAN/QUAD4"], [-1, 0, -1, 0])
        own, other = ({"MODELE": concept(f"model_{number}")} for number in (4, 5))
        self.assertEqual(self.print(self.U, **own).status, 0)
        for resu in (self.U, self.MA, [self.U, {"MAILLAGE": concept("mesh_3")}]):
            self.assert_refused(self.print(resu, **other), "CREACHAMP_5", "MA", "OTHER")

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


if __name__ == "__main__":
    unittest.main()
