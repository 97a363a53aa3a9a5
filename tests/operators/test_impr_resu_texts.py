"""IMPR_RESU alone: VTU files parsed here, listings, and what a file of any format leaves out."""

import base64
import unittest
import xml.etree.ElementTree

import numpy as np

from impr_resu_test import INSTANTS, MESH_CELLS, POINTS, ImprResuTest, displacement
from lacon_test import CELLS, concept


class Texts(ImprResuTest):
    # ------------------------------------------------------------------------------------------ VTU

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

    # ------------------------------------------------------------------------------------------ what is left out

    def test_fields_that_are_left_out_are_told_whether_they_were_named_or_not(self):
        """In every format, each reason once with all fields that it keeps out."""
        for form in ("MED", "VTU", "GMSH", "RESULTAT"):
            for resu, left_out in (({"NOM_CHAM": ["CONT_ELEM", "DEPL"], "GROUP_MA": ["BODY"]}, {"CONT_ELEM": "part of the mesh"}),
                                   ({"GROUP_MA": ["BODY"]}, {"CONT_ELEM": "part of the mesh"}),
                                   ({"GROUP_NO": ["BOTTOM"]}, {"CONT_ELEM, SIEF_ELGA, SIEF_ELNO": "GROUP_NO"}),
                                   ({"NOM_CMP": ["SIYY"]}, {"CONT_ELEM, DEPL, SIEF_ELNO": "NOM_CMP"}),
                                   ({"NOM_CHAM": ["DEPL", "CONT_ELEM"], "NOM_CMP": ["DX"]}, {"CONT_ELEM": "NOM_CMP"}),
                                   ({"INST": [0.5]}, {"SIEF_ELNO": "instants"}),
                                   ({"GROUP_NO": ["BOTTOM"], "INST": [0.0]}, {"CONT_ELEM, SIEF_ELNO": "instants", "SIEF_ELGA": "GROUP_NO"}),
                                   ({"GROUP_MA": ["SLAVE", "BODY"]}, {})):
                with self.subTest(form=form, **resu):
                    run = self.print({**self.U, **resu}, form)
                    self.assertEqual((run.status, self.ids(run).count("IMPR_5")), (0, len(left_out)), run.stderr)
                    for fields, why in left_out.items():
                        self.assertRegex(run.stderr, f"'U'.*: {fields}: .*{why}")

    def test_means_in_place_of_values_within_cells_are_told(self):
        for form in ("VTU", "GMSH", "MED", "RESULTAT"):
            run = self.print(self.U, form)
            self.assertEqual((run.status, self.ids(run)), (0, ["IMPR_10"] if form in ("VTU", "GMSH") else []), run.stderr)
            if form in ("VTU", "GMSH"):
                self.assertIn("SIEF_ELGA, SIEF_ELNO" if form == "VTU" else "SIEF_ELGA", run.stderr)
                self.assertEqual("SIEF_ELNO" in run.stderr, form == "VTU")
            self.assertEqual(self.ids(self.print({**self.U, "NOM_CHAM": ["DEPL", "CONT_ELEM"]}, form)), [])


if __name__ == "__main__":
    unittest.main()
