"""macr_lign_coupe alone: fields by hand along lines through distorted meshes, against closed forms."""

import math
import unittest

import h5py
import numpy as np
from lacon_test import OperatorTest, concept

HEAD = ["INTITULE", "RESU", "NOM_CHAM", "NUME_ORDRE", "INST"]
PLACE = ["ABSC_CURV", "COOR_X", "COOR_Y", "COOR_Z"]


def bricks(n, seed=2):
    """n x n x n HEXA8 of the unit cube, inner nodes moved."""
    random = np.random.default_rng(seed)
    points, number = [], {}
    for i, j, k in np.ndindex(n + 1, n + 1, n + 1):
        inner = all(0 < a < n for a in (i, j, k))
        number[i, j, k] = len(points)
        points.append(np.array([i, j, k]) / n + inner * random.uniform(-0.2, 0.2, 3) / n)
    corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    cells = [("HEXA8", [number[i + a, j + b, k + c] for a, b, c in corners]) for i, j, k in np.ndindex(n, n, n)]
    return np.array(points), cells


class MacrLignCoupe(OperatorTest):
    def write(self, points, cells, values, instants=(0.0, 1.0), present=None, **groups):
        """MESH, and RESU whose DEPL at order k is (1 + k) times `values`."""
        points = np.asarray(points, float)
        self.write_mesh("mesh_1", points, cells, **groups)
        values = np.asarray(values, float)
        field = {"quantity": "DEPL_R", "location": "NOEU", "components": ["DX", "DY", "DZ"][:values.shape[1]], "support": range(len(points)),
                 "present": present}
        self.write_result("result_2", "mesh_1", instants, {"DEPL": {k: {**field, "values": (1 + k) * values} for k in range(len(instants))}},
                          label="RESU")

    def plane(self):
        """Two unit squares side by side, DX = x, and on top of both, not joined, a rectangle with DX = x + 10; DY = x y."""
        points = [(0, 0), (1, 0), (2, 0), (0, 1), (1, 1), (2, 1), (0, 1), (2, 1), (2, 2), (0, 2)]
        cells = [("QUAD4", [0, 1, 4, 3]), ("QUAD4", [1, 2, 5, 4]), ("QUAD4", [6, 7, 8, 9]), ("SEG2", [4, 3]), ("SEG2", [5, 4]), ("SEG2", [6, 7]),
                 ("SEG2", [1, 4])]
        self.write(points, cells, [(x + 10 * (i > 5), x * y) for i, (x, y) in enumerate(points)], node_groups={"LINE": [0, 1, 2], "BACK": [0, 2, 1], "ONE": [2]},
                   cell_groups={"LOW": [0, 1], "UP": [2], "TOP": [3, 4], "APART": [3, 5], "FORK": [3, 4, 6], "ALL": [0, 1, 2]})

    def lines(self, *lines, **keywords):
        run = self.run_command("MACR_LIGN_COUPE", {**self.subject(keywords), "LIGN_COUPE": list(lines)}, result="table_9", label="T")
        self.assertEqual(run.status, 0, run.stderr)
        self.messages = [m["id"] for m in run.messages]
        with h5py.File(self.base / "table_9.h5") as file:
            return self.read_table(file)

    def subject(self, keywords):
        return keywords if "CHAM_GD" in keywords else {"RESULTAT": concept("result_2"), "NOM_CHAM": "DEPL", **keywords}

    def refuses(self, identifier, line, *words, **keywords):
        self.assert_refuses(identifier, "MACR_LIGN_COUPE", {**self.subject(keywords), "LIGN_COUPE": line}, *words, result="table_9")

    def column(self, rows, name):
        return [row[name] for row in rows]

    def test_sums_over_nodes_and_their_moments(self):
        """DX = x, DY = x y at (0, 0), (1, 0), (2, 0) and (1, 1), (0, 1) of the lower squares: closed forms, about the origin and about (1, 2)."""
        self.plane()
        rows = self.lines({"TYPE": "GROUP_NO", "GROUP_NO": "LINE", "RESULTANTE": ["DY", "DX"]})
        self.assertEqual([list(row) for row in rows], [[*HEAD, "DY", "DX"]] * 2)
        self.assertEqual([(row["DX"], row["DY"]) for row in rows], [(3, 0), (6, 0)])
        rows = self.lines({"TYPE": "GROUP_MA", "GROUP_MA": "TOP", "RESULTANTE": ["DX", "DY"], "MOMENT": ["DRZ"], "POINT": [1.0, 2.0]})
        self.assertEqual(list(rows[0]), [*HEAD, "RESULT_X", "RESULT_Y", "MOMENT_X", "MOMENT_Y", "MOMENT_Z"])
        # nodes (0, 1), (1, 1), (2, 1): forces (0, 0), (1, 1), (2, 2); arms (-1, -1), (0, -1), (1, -1): 0 + 1 + 2 + 2
        self.assertEqual([[row[n] for n in list(row)[5:]] for row in rows], [[3, 3, 0, 0, 5], [6, 6, 0, 0, 10]])
        self.assertNotIn("LIGNCOUPE_13", self.messages)
        segment = {"NB_POINTS": 3, "COOR_ORIG": [0.0, 0.5], "COOR_EXTR": [2.0, 0.5], "RESULTANTE": ["DX"]}
        self.assertEqual([row["DX"] for row in self.lines(segment)], [3, 6])
        self.assertIn("LIGNCOUPE_13", self.messages)
        self.refuses("CREACHAMP_14", {**segment, "RESULTANTE": ["FX"]}, "RESULTANTE", "FX")

    def test_stand_ins_are_no_part_of_sums_but_where_nothing_else_is(self):
        """As of POST_RELEVE_T: node 1 of LINE is a stand-in in DX, all of its nodes are in DY."""
        points, cells = [(0, 0), (1, 0), (2, 0), (0, 1), (1, 1), (2, 1)], [("QUAD4", [0, 1, 4, 3]), ("QUAD4", [1, 2, 5, 4])]
        self.write(points, cells, [(5, -1)] * 6, instants=(0.0, ), present=[(1 + (n == 1), 2) for n in range(6)], node_groups={"LINE": [0, 1, 2]})
        rows = self.lines({"TYPE": "GROUP_NO", "GROUP_NO": "LINE", "RESULTANTE": ["DX", "DY"]})
        self.assertEqual((rows[0]["DX"], rows[0]["DY"]), (10, -3))
        rows = self.lines({"TYPE": "GROUP_NO", "GROUP_NO": "LINE"})
        self.assertEqual(self.column(rows, "DX"), [5, 5, 5])

    def test_no_gap_along_a_line_is_no_gap(self):
        """JEU = -1 without a master (3 of `present`) at (0, y): between it and the gaps beside it mixtures were shown, and means took -1 for a gap."""
        points, cells = [(0, 0), (1, 0), (2, 0), (0, 1), (1, 1), (2, 1)], [("QUAD4", [0, 1, 4, 3]), ("QUAD4", [1, 2, 5, 4])]
        self.write(points, cells, [(x if x else -1, -1) for x, _ in points], instants=(0.0, ), present=[(1 if x else 3, 3) for x, _ in points],
                   node_groups={"LINE": [0, 1, 2]})
        segment = {"NB_POINTS": 5, "COOR_ORIG": [0.0, 0.5], "COOR_EXTR": [2.0, 0.5]}
        rows = self.lines(segment)
        np.testing.assert_allclose(self.column(rows, "DX"), [-1, -1, 1, 1.5, 2], atol=1e-14)
        self.assertEqual(self.column(rows, "DY"), [-1] * 5)
        for line in (segment, {"TYPE": "GROUP_NO", "GROUP_NO": "LINE"}):
            rows = self.lines({**line, "OPERATION": "MOYENNE"})  # of x from 1 to 2; where nothing else is, of the markers
            np.testing.assert_allclose(self.column(rows, "DX"), [1.5, 1, 1, 2, 1, 2], atol=1e-13)
            np.testing.assert_allclose(self.column(rows, "DY"), [-1, 0, -1, -1, -1, -1], atol=1e-13)
        rows = self.lines({**segment, "NB_POINTS": 3, "COOR_EXTR": [1.0, 0.5], "OPERATION": "MOYENNE", "NOM_CMP": ["DX"]})
        self.assertEqual(self.column(rows, "DX"), [None, None, 1, 1, None, None])  # a single point is no piece of a line

    def turned(self, deformed=False):
        """The squares of plane(), turned by 90 degrees about the origin at the second instant, and a force along Y at (2, 0)."""
        self.plane()
        with h5py.File(self.path("mesh_1")) as file:
            points = file["coordinates"][()][:, :2]
        if deformed:
            with h5py.File(self.path("mesh_1"), "a") as file:
                file["first_place"] = np.zeros(7)
        field = {"quantity": "DEPL_R", "location": "NOEU", "components": ["DX", "DY"], "support": range(len(points))}
        turn = np.column_stack([-points[:, 1], points[:, 0]]) - points
        force = np.array([(0.0, float(n == 2)) for n in range(len(points))])
        self.write_result("result_2", "mesh_1", (0.0, 1.0), {"DEPL": {k: {**field, "values": k * turn} for k in (0, 1)},
                                                             "REAC_NODA": {k: {**field, "values": force} for k in (0, 1)}}, label="RESU")

    def test_places_that_have_moved_are_told(self):
        """Moments and radial axes are of places in the mesh, which was not said of bodies that have turned."""
        moment = {"TYPE": "GROUP_NO", "GROUP_NO": "LINE", "RESULTANTE": ["DX", "DY"], "MOMENT": ["DRZ"], "POINT": [0.0, 0.0]}
        radial = {"TYPE": "GROUP_NO", "GROUP_NO": "LINE", "REPERE": "POLAIRE", "ORIGINE": [0.0, 0.0]}
        for deformed, told in ((False, ["MODIREPERE_6", "POST_13"]), (True, [])):
            self.turned(deformed)
            run = self.run_command("MACR_LIGN_COUPE", {**self.subject({"NOM_CHAM": "REAC_NODA"}), "LIGN_COUPE": [moment, radial]}, result="table_9")
            self.assertEqual((run.status, [m for m in self.ids(run) if m != "MODIREPERE_4"]), (0, told), run.stderr)
            if told:
                self.assertIn("by 90 degrees", run.stderr)
                self.assertIn("141 % of the largest distance from POINT: where nodes are then the moment is (0, 0, 0), not (0, 0, 2)", run.stderr)
        self.turned()
        for line, more in ((moment, {"INST": [0.0]}), ({**moment, "POINT": [-100.0, 0.0]}, {}), ({**radial, "REPERE": "UTILISATEUR", "ANGL_NAUT": [5.0]}, {})):
            line = {k: v for k, v in line.items() if k != "ORIGINE" or line["REPERE"] == "POLAIRE"}
            self.lines(line, NOM_CHAM="REAC_NODA", **more)
            self.assertFalse({"POST_13", "MODIREPERE_6"} & set(self.messages), self.messages)

    def test_a_model_or_mesh_that_is_not_the_fields_is_refused(self):
        self.plane()
        self.write_mesh("mesh_5", [(0, 0), (1, 0)], [("SEG2", [0, 1])])
        line = {"TYPE": "GROUP_NO", "GROUP_NO": "LINE"}
        self.lines({**line, "MAILLAGE": concept("mesh_1")})
        self.refuses("CREACHAMP_5", {**line, "MAILLAGE": concept("mesh_5")}, "MESH_1", "MESH_5")
        self.write_model("model_6", "mesh_5", ["D_PLAN/SEG2"], [0])
        self.refuses("CREACHAMP_5", line, "MESH_1", "MESH_5", MODELE=concept("model_6"))

    def test_a_linear_field_along_a_segment_through_distorted_bricks(self):
        points, cells = bricks(4)
        gradient = np.array([[1.0, -2.0, 0.5], [0.3, 0.0, 4.0], [0.0, 1.0, 1.0]])
        self.write(points, cells, points @ gradient.T + 0.25)
        start, end = np.array([0.03, 0.1, 0.0]), np.array([0.9, 0.77, 1.0])
        rows = self.lines({"NB_POINTS": 17, "COOR_ORIG": [*start], "COOR_EXTR": [*end], "INTITULE": "it"})
        self.assertEqual(list(rows[0]), [*HEAD, *PLACE, "DX", "DY", "DZ"])
        self.assertEqual([tuple(rows[i][c] for c in HEAD) for i in (0, 17)], [("it", "RESU", "DEPL", 0, 0.0), ("it", "RESU", "DEPL", 1, 1.0)])
        expected = start + np.linspace(0, 1, 17)[:, None] * (end - start)
        for k in (0, 1):
            own = rows[17 * k:17 * (k + 1)]
            np.testing.assert_allclose([[row[c] for c in PLACE[1:]] for row in own], expected, atol=1e-15)
            np.testing.assert_allclose(self.column(own, "ABSC_CURV"), np.linspace(0, 1, 17) * np.linalg.norm(end - start), atol=1e-15)
            np.testing.assert_allclose([[row[c] for c in ("DX", "DY", "DZ")] for row in own], (1 + k) * (expected @ gradient.T + 0.25), atol=1e-12)

    def test_other_axes_at_the_points_of_the_line(self):
        """u = x, which is r e_r + z e_z about the third axis."""
        points, cells = bricks(2)
        self.write(points, cells, points)
        line = {"NB_POINTS": 5, "COOR_ORIG": [0.1, 0.9, 0.2], "COOR_EXTR": [0.8, 0.3, 0.6]}
        cylinder = {**line, "REPERE": "CYLINDRIQUE", "ORIGINE": [0.0, 0.0, 7.0], "AXE_Z": [0.0, 0.0, 3.0]}
        for row in self.lines(cylinder, NUME_ORDRE=[0]):
            x, y, z = (row[c] for c in PLACE[1:])
            np.testing.assert_allclose([row[c] for c in ("DX", "DY", "DZ")], [math.hypot(x, y), z, 0], atol=1e-14)
        for row in self.lines({**line, "REPERE": "UTILISATEUR", "ANGL_NAUT": [90.0], "NOM_CMP": ["DY"]}, NUME_ORDRE=[0]):
            self.assertEqual(list(row)[-2:], ["COOR_Z", "DY"])
            self.assertAlmostEqual(row["DY"], -row["COOR_X"], 14)
        found = self.lines({**cylinder, "OPERATION": "MOYENNE", "NOM_CMP": ["DZ"]}, NUME_ORDRE=[0])
        np.testing.assert_allclose(self.column(found, "DZ"), [0] * 6, atol=1e-13)
        self.lines({**cylinder, "COOR_ORIG": [0.0, 0.0, 0.5]}, NUME_ORDRE=[0])
        self.assertEqual(self.messages, ["MODIREPERE_4"])
        self.refuses("MODIREPERE_5", {**cylinder, "AXE_Z": [0.0, 0.0, 0.0]}, "AXE_Z")

    def test_axes_along_the_line(self):
        """u = x: along a segment the abscissa and what is across; on an arc about the centre the radius across and nothing along; at a corner the mean."""
        points, cells = bricks(2)
        self.write(points, cells, points)
        start, end = np.array([0.1, 0.9, 0.2]), np.array([0.8, 0.3, 0.6])
        line = {"NB_POINTS": 5, "COOR_ORIG": [*start], "COOR_EXTR": [*end], "REPERE": "LOCAL"}
        x = (end - start) / np.linalg.norm(end - start)
        y = np.array([0.0, 0.0, 1.0]) - x[2] * x
        y /= np.linalg.norm(y)
        for row in self.lines({**line, "VECT_Y": [0.0, 0.0, 5.0]}, NUME_ORDRE=[0]):
            place = np.array([row[c] for c in PLACE[1:]])
            np.testing.assert_allclose([row[c] for c in ("DX", "DY", "DZ")], [place @ x, place @ y, place @ np.cross(x, y)], atol=1e-14)
        for wrong in ({}, {"VECT_Y": [0.0, 0.0, 0.0]}, {"VECT_Y": [*(2 * x)]}):
            self.refuses("LIGNCOUPE_10", {**line, **wrong}, "VECT_Y")
        arc = {"TYPE": "ARC", "NB_POINTS": 4, "CENTRE": [0.0, 0.0, 0.5], "COOR_ORIG": [0.8, 0.0, 0.5], "ANGLE": 90.0, "DNOR": [0.0, 0.0, 1.0]}
        for row in self.lines({**arc, "REPERE": "LOCAL", "VECT_Y": [-1.0, -1.0, 0.0]}, NUME_ORDRE=[0]):
            np.testing.assert_allclose([row[c] for c in ("DX", "DY", "DZ")], [0, -0.8, 0.5], atol=1e-13)
        self.write([(0, 0), (1, 0), (1, 1), (0, 1)], [("QUAD4", [0, 1, 2, 3])], [(0, 0), (1, 0), (1, 1), (0, 1)], node_groups={"CORNER": [0, 1, 2]})
        rows = self.lines({"TYPE": "GROUP_NO", "GROUP_NO": "CORNER", "REPERE": "LOCAL"}, NUME_ORDRE=[0])
        np.testing.assert_allclose([[row["DX"], row["DY"]] for row in rows], [(0, 0), (0.5**0.5, -(0.5**0.5)), (1, -1)], atol=1e-15)

    def test_traces_on_a_line(self):
        """u = x, T with x and y on its diagonal, on the diagonal of a square from below: n = (-1, 1) / sqrt 2."""
        corners = [(0, 0), (1, 0), (1, 1), (0, 1)]
        line = {"NB_POINTS": 3, "COOR_ORIG": [0.2, 0.4], "COOR_EXTR": [0.6, 0.8]}
        self.write(corners, [("QUAD4", [0, 1, 2, 3])], corners)
        root = 0.5**0.5
        for row in self.lines({**line, "TRAC_NOR": "OUI"}, NUME_ORDRE=[0]):
            self.assertEqual([name for name in row if name.startswith(("D", "TR"))], ["TRAC_NOR"])
            self.assertAlmostEqual(row["TRAC_NOR"], (row["COOR_Y"] - row["COOR_X"]) * root, 14)
        for row in self.lines({**line, "TRAC_NOR": "OUI", "VECT_Y": [1.0, 0.0]}, {**line, "TRAC_DIR": "OUI", "DIRECTION": [2.0, -2.0]}, NUME_ORDRE=[0]):
            self.assertAlmostEqual(row.get("TRAC_NOR", row.get("TRAC_DIR")) or row["TRAC_DIR"], (row["COOR_X"] - row["COOR_Y"]) * root, 14)
        self.assertAlmostEqual(self.column(self.lines({**line, "TRAC_NOR": "OUI", "REPERE": "LOCAL", "OPERATION": "MOYENNE"}, NUME_ORDRE=[0]), "TRAC_NOR")[0], 0.2 * root, 14)
        self.refuses("LIGNCOUPE_11", {**line, "TRAC_DIR": "OUI", "DIRECTION": [0.0, 0.0]}, "DIRECTION")

    def test_invariants_and_principal_values_of_a_tensor(self):
        """T turned by 30 degrees from diag(3, 1), SIZZ = -2, times x: those of the diagonal; of the whole tensor, whatever NOM_CMP says of other lines."""
        angle, corners = math.radians(30), [(0, 0), (1, 0), (1, 1), (0, 1)]
        c, s = math.cos(angle), math.sin(angle)
        tensor = [3 * c * c + s * s, 3 * s * s + c * c, -2.0, 2 * c * s]
        self.write_mesh("mesh_1", np.array(corners, float), [("QUAD4", [0, 1, 2, 3])])
        self.write_result("result_2", "mesh_1", (0.0,), {"SIGM_NOEU": {0: {
            "quantity": "SIEF_R", "location": "NOEU", "components": ["SIXX", "SIYY", "SIZZ", "SIXY"], "support": range(4), "present": None,
            "values": np.array([[(1 + x) * value for value in tensor] for x, _ in corners])}}}, label="RESU")
        line = {"NB_POINTS": 3, "COOR_ORIG": [0.0, 0.5], "COOR_EXTR": [1.0, 0.5]}
        subject = {"RESULTAT": concept("result_2"), "NOM_CHAM": "SIGM_NOEU", "NOM_CMP": ["SIXX"]}
        for row in self.lines({**line, "INVARIANT": "OUI"}, **subject):
            size = 1 + row["COOR_X"]
            self.assertEqual(list(row)[-5:], ["COOR_Z", "VMIS", "TRESCA", "TRACE", "DETER"])
            expected = [size * math.sqrt(((3 - 1)**2 + (1 + 2)**2 + (3 + 2)**2) / 2), 5 * size, 2 * size, -6 * size**3]
            np.testing.assert_allclose([row[name] for name in ("VMIS", "TRESCA", "TRACE", "DETER")], expected, rtol=1e-13)
        for row in self.lines({**line, "ELEM_PRINCIPAUX": "OUI"}, **subject):
            size = 1 + row["COOR_X"]
            np.testing.assert_allclose([row[f"PRIN_{k}"] for k in (1, 2, 3)], [-2 * size, size, 3 * size], rtol=1e-13)
            axes = [[row[f"VECT_{k}_{axis}"] for axis in "XYZ"] for k in (1, 2, 3)]
            np.testing.assert_allclose(axes, [[0, 0, 1], [-s, c, 0], [c, s, 0]], atol=1e-13)
        self.write(corners, [("QUAD4", [0, 1, 2, 3])], corners)
        self.refuses("LIGNCOUPE_12", {**line, "INVARIANT": "OUI"}, "DX")

    def test_polar_axes(self):
        """u = x, which is r e_r: in the plane as CYLINDRIQUE, in space X radial, Y tangential, Z along z."""
        points, cells = bricks(2)
        self.write(points, cells, points)
        line = {"NB_POINTS": 3, "COOR_ORIG": [0.1, 0.9, 0.2], "COOR_EXTR": [0.8, 0.3, 0.6], "REPERE": "POLAIRE", "ORIGINE": [0.0, 0.0, 0.0]}
        for row in self.lines(line, NUME_ORDRE=[0]):
            x, y, z = (row[c] for c in PLACE[1:])
            np.testing.assert_allclose([row[c] for c in ("DX", "DY", "DZ")], [math.hypot(x, y), 0, z], atol=1e-14)

    def test_axes_of_a_vector_that_is_not_whole_leave_it_out(self):
        self.write([(0, 0), (1, 0), (1, 1), (0, 1)], [("QUAD4", [0, 1, 2, 3])], [(1, 2)] * 4, present=np.array([(1, 1), (1, 0), (1, 1), (1, 1)], np.uint8))
        rows = self.lines({"NB_POINTS": 2, "COOR_ORIG": [1.0, 0.0], "COOR_EXTR": [1.0, 1.0], "REPERE": "UTILISATEUR", "ANGL_NAUT": [90.0]}, NUME_ORDRE=[0])
        self.assertEqual([rows[0]["DX"], rows[0]["DY"]], [None, None])
        np.testing.assert_allclose([rows[1]["DX"], rows[1]["DY"]], [2, -1], atol=1e-15)

    def test_an_arc_in_space(self):
        points, cells = bricks(3)
        self.write(points, cells, points)
        rows = self.lines({"TYPE": "ARC", "NB_POINTS": 5, "CENTRE": [0.2, 0.2, 0.5], "COOR_ORIG": [0.8, 0.2, 0.5], "ANGLE": 90.0, "DNOR": [0.0, 0.0, 2.0]},
                          NUME_ORDRE=[0])
        for row, angle in zip(rows, np.linspace(0, math.pi / 2, 5)):
            found = [row[c] for c in ("COOR_X", "COOR_Y", "COOR_Z", "DX", "DY", "DZ", "ABSC_CURV")]
            place = [0.2 + 0.6 * math.cos(angle), 0.2 + 0.6 * math.sin(angle), 0.5]
            np.testing.assert_allclose(found, [*place, *place, 0.6 * angle], atol=1e-13)

    def test_groups_are_lines_of_nodes(self):
        self.plane()
        rows = self.lines({"TYPE": "GROUP_NO", "GROUP_NO": "LINE", "NOM_CMP": ["DX"]}, {"TYPE": "GROUP_MA", "GROUP_MA": "TOP"}, INST=[0.0])
        self.assertEqual(self.column(rows, "INTITULE"), ["LINE"] * 3 + ["TOP"] * 3)
        self.assertEqual(self.column(rows, "ABSC_CURV"), [0, 1, 2, 0, 1, 2])
        self.assertEqual(self.column(rows, "COOR_X"), [0, 1, 2, 2, 1, 0])  # TOP runs as its first cell does
        self.assertEqual(self.column(rows, "DX"), [0, 1, 2, 2, 1, 0])
        self.assertEqual(self.column(rows, "DY"), [None] * 3 + [2, 1, 0])

    def test_a_closed_chain_of_quadratic_edges_comes_back(self):
        points = [(0, 0), (1, 0), (0, 1), (0.5, 0), (0.5, 0.5), (0, 0.5)]
        cells = [("TRIA6", [0, 1, 2, 3, 4, 5]), ("SEG3", [0, 1, 3]), ("SEG3", [0, 2, 5]), ("SEG3", [1, 2, 4])]
        self.write(points, cells, points, instants=(0.0,), cell_groups={"AROUND": [1, 2, 3]})
        rows = self.lines({"TYPE": "GROUP_MA", "GROUP_MA": "AROUND"})
        self.assertEqual([(r["DX"], r["DY"]) for r in rows], [points[i] for i in (0, 3, 1, 4, 2, 5, 0)])
        self.assertAlmostEqual(rows[-1]["ABSC_CURV"], 2 + math.sqrt(2), delta=1e-15)

    def test_means_along_a_line(self):
        self.plane()
        rows = self.lines({"NB_POINTS": 9, "COOR_ORIG": [0.0, 0.5], "COOR_EXTR": [2.0, 0.5], "OPERATION": "MOYENNE"}, NUME_ORDRE=[1])
        self.assertEqual(list(rows[0]), [*HEAD, "QUANTITE", "DX", "DY"])
        self.assertEqual(rows[0]["INTITULE"], "l.coupe1")
        found = {row["QUANTITE"]: (row["DX"], row["DY"]) for row in rows}
        for name, (dx, dy) in {"MOMENT_0": (2, 1), "MOMENT_1": (4, 2), "MINIMUM": (0, 0), "MAXIMUM": (4, 2), "MOYE_INT": (0, 0), "MOYE_EXT": (4, 2)}.items():
            np.testing.assert_allclose(found.pop(name), (dx, dy), atol=1e-14)
        self.assertEqual(found, {})

    def test_a_mean_along_a_group_that_is_no_line_is_told(self):
        self.plane()
        for group, told in (("LINE", []), ("BACK", ["POST_10"])):
            self.lines({"TYPE": "GROUP_NO", "GROUP_NO": group, "NOM_CMP": ["DX"], "OPERATION": "MOYENNE"}, INST=[0.0])
            self.assertEqual(self.messages, told)

    def test_two_sides_of_an_interface(self):
        self.plane()
        line = {"NB_POINTS": 3, "COOR_ORIG": [0.0, 1.0], "COOR_EXTR": [2.0, 1.0]}
        for group, values in (("LOW", [0, 1, 2]), ("UP", [10, 11, 12])):
            self.assertEqual(self.column(self.lines(line, NUME_ORDRE=[0], VIS_A_VIS={"GROUP_MA_1": group}), "DX"), values)

    def test_a_field_of_its_own_with_a_component_that_some_nodes_lack(self):
        self.plane()
        self.write_field("field_3.h5", "NEUT", "NEUT_R", "NOEU", ["X1", "X2"], range(6), [[i, 2 * i] for i in range(6)], "mesh_1",
                         present=[[1, i != 0] for i in range(6)])
        with h5py.File(self.base / "field_3.h5", "a") as file:
            file.attrs.update({"lacon_type": "field", "version": np.int64(1), "id": "field_3", "label": "F", "command": "BY_HAND",
                               "keywords": "{}", "references": '["mesh_1"]'})
        rows = self.lines({"NB_POINTS": 3, "COOR_ORIG": [0.5, 0.0], "COOR_EXTR": [1.5, 0.0]}, CHAM_GD=concept("field_3"))
        self.assertEqual(list(rows[0]), ["INTITULE", "CHAM_GD", *PLACE, "X1", "X2"])
        np.testing.assert_allclose(self.column(rows, "X1"), [0.5, 1, 1.5], atol=1e-15)
        # X2 is missing in the first cell, but at the node that it shares with the second
        self.assertEqual(self.column(rows, "X2")[0], None)
        np.testing.assert_allclose(self.column(rows, "X2")[1:], [2, 3], atol=1e-14)

    def test_fields_of_cells_are_means_at_their_nodes(self):
        self.plane()
        field = {"quantity": "SIEF_R", "components": ["SIXX"]}
        self.write_result("result_2", "mesh_1", [0.0], {
            "CONT_ELEM": {0: {**field, "location": "ELEM", "support": [0, 1], "values": [[1.0], [3.0]]}},
            "SIEF_ELNO": {0: {**field, "location": "ELNO", "support": [0, 1], "offset": [0, 4, 8], "values": [[1.0]] * 4 + [[3.0]] * 4}}}, label="RESU")
        for name in ("CONT_ELEM", "SIEF_ELNO"):
            rows = self.lines({"NB_POINTS": 5, "COOR_ORIG": [0.0, 0.5], "COOR_EXTR": [2.0, 0.5]}, NOM_CHAM=name)
            np.testing.assert_allclose(self.column(rows, "SIXX"), [1, 1.5, 2, 2.5, 3], atol=1e-14)  # 2 at the nodes that both share

    def test_points_outside(self):
        self.plane()
        line = {"NB_POINTS": 3, "COOR_ORIG": [0.5, -0.1], "COOR_EXTR": [1.5, -0.1]}
        rows = self.lines(line, NUME_ORDRE=[0])
        self.assertEqual(self.messages, ["LIGNCOUPE_2"])
        np.testing.assert_allclose(self.column(rows, "DX"), [0.5, 1, 1.5], atol=1e-7)
        for more, told in (({"DISTANCE_MAX": 0.11}, []), ({"DISTANCE_ALARME": 0.11}, []), ({"DISTANCE_ALARME": 0.09}, ["LIGNCOUPE_2"]),
                           ({"DISTANCE_MAX": 0.11, "DISTANCE_ALARME": 0.09}, ["LIGNCOUPE_2"])):
            self.lines({**line, **more})
            self.assertEqual(self.messages, told, more)
        self.refuses("LIGNCOUPE_1", {**line, "DISTANCE_MAX": 0.09}, "the point 1", "(0.5, -0.1)", "LIGN_COUPE/TYPE")
        self.refuses("LIGNCOUPE_1", {**line, "COOR_EXTR": [1.5, -1.0]}, "the point 2")

    def test_a_line_without_length_is_told(self):
        self.plane()
        rows = self.lines({"NB_POINTS": 2, "COOR_ORIG": [0.5, 0.5], "COOR_EXTR": [0.5, 0.5]}, NUME_ORDRE=[0])
        self.assertEqual(self.messages, ["LIGNCOUPE_14"])
        np.testing.assert_allclose(self.column(rows, "DX"), [0.5, 0.5], atol=1e-14)

    def test_instants_of_a_list_that_are_not_there_are_told(self):
        self.plane()
        line = {"NB_POINTS": 2, "COOR_ORIG": [0.5, 0.5], "COOR_EXTR": [1.5, 0.5]}
        for values, orders, told in (([0.0, 0.5, 1.0], [0, 1], ["FIELDS_5"]), ([1.0], [1], [])):
            with self.create("list_of_reals_3", "list_of_reals") as file:
                file["values"] = np.array(values)
            rows = self.lines(line, LIST_INST=concept("list_of_reals_3"))
            self.assertEqual(self.column(rows, "NUME_ORDRE")[::2], orders)
            self.assertEqual(self.messages, told)
        with self.create("list_of_reals_3", "list_of_reals") as file:
            file["values"] = np.array([0.25, 0.5])
        self.refuses("FIELDS_2", line, "0.25", LIST_INST=concept("list_of_reals_3"))

    def test_refused(self):
        self.plane()
        line = {"NB_POINTS": 3, "COOR_ORIG": [0.0, 0.0], "COOR_EXTR": [2.0, 0.0]}
        self.refuses("LIGNCOUPE_3", {**line, "COOR_EXTR": [1.0, 0.0, 0.0]}, "COOR_EXTR", "3 coordinates")
        self.refuses("CREACHAMP_14", {**line, "NOM_CMP": ["DZ"]}, "DZ")
        self.refuses("MESH_1", {"TYPE": "GROUP_NO", "GROUP_NO": "LINES"}, "LINES")
        self.refuses("FIELDS_2", line, "0.7", INST=[0.7])
        self.refuses("RESULT_1", line, "SIEF_NOEU", NOM_CHAM="SIEF_NOEU")
        for group, why in (("APART", "M6 does not hang together"), ("FORK", "more than two"), ("LOW", "M1 is no line cell")):
            self.refuses("LIGNCOUPE_4", {"TYPE": "GROUP_MA", "GROUP_MA": group}, group, why)
        self.refuses("LIGNCOUPE_6", {"TYPE": "GROUP_NO", "GROUP_NO": "ONE", "OPERATION": "MOYENNE"}, "one place")
        self.refuses("LIGNCOUPE_8", {"TYPE": "ARC", "NB_POINTS": 3, "CENTRE": [0.5, 0.5], "COOR_ORIG": [0.5, 0.5], "ANGLE": 90.0}, "CENTRE")

    def test_fields_that_no_line_meets(self):
        self.plane()
        field = {"quantity": "SIEF_R", "components": ["SIXX"]}
        self.write_result("result_2", "mesh_1", [0.0], {
            "SIEF_ELGA": {0: {**field, "location": "ELGA", "support": [0], "offset": [0, 4], "values": [[1.0]] * 4}},
            "SIEF_NOEU": {0: {**field, "location": "NOEU", "support": [0, 1, 3, 4], "values": [[1.0]] * 4}}}, label="RESU")
        line = {"NB_POINTS": 3, "COOR_ORIG": [0.5, 0.5], "COOR_EXTR": [1.5, 0.5]}
        self.refuses("LIGNCOUPE_5", line, "ELGA", NOM_CHAM="SIEF_ELGA")
        self.refuses("LIGNCOUPE_7", {**line, "OPERATION": "MOYENNE"}, "SIXX", "point 3", NOM_CHAM="SIEF_NOEU")
        self.refuses("LIGNCOUPE_9", {**line, "COOR_ORIG": [1.2, 0.5]}, "SIXX", NOM_CHAM="SIEF_NOEU")


if __name__ == "__main__":
    unittest.main()
