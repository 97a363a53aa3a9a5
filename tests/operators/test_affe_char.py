"""AFFE_CHAR_CINE and AFFE_CHAR_MECA alone, on bases made by hand."""

import h5py
import numpy as np

from lacon_test import OperatorTest, concept, text

# Two quadrangles side by side, 3 x 1 nodes a row; node 7 (N7) belongs to no element.
COORDINATES = [[0, 0], [1, 0], [2, 0], [0, 1], [1, 1], [2, 1], [5, 5]]
CELLS = [
    ("QUAD4", [0, 1, 4, 3]), ("QUAD4", [1, 2, 5, 4]),
    ("SEG2", [5, 4]), ("SEG2", [4, 3]),  # top, outward
    ("SEG2", [1, 0]),                    # bottom left, inward
    ("SEG2", [1, 4]),                    # between the two
    ("SEG2", [0, 6]),                    # of no body
    ("SEG2", [2, 5]),                    # right: no element in the model
]
GROUPS = {"BODY": [0, 1], "TOP": [2, 3], "INWARD": [4], "BETWEEN": [5], "LOOSE": [6], "RIGHT": [7], "EMPTY": []}
NODES = {"CORNER": [0], "ALONE": [6], "BOTTOM": [0, 1, 2]}


class Loads(OperatorTest):
    def setUp(self):
        super().setUp()
        self.write_mesh("mesh_1", COORDINATES, CELLS, cell_groups=GROUPS, node_groups=NODES)
        self.write_model("model_2", "mesh_1", ["D_PLAN/QUAD4", "D_PLAN/SEG2"], [0, 0, 1, 1, 1, 1, 1, -1])
        self.write_model("model_3", "mesh_1", ["D_PLAN/QUAD4", "D_PLAN/SEG2"], [0, 0, 1, 1, 1, 1, -1, -1])

    def cine(self, *occurrences, model="model_3"):
        return self.run_command("AFFE_CHAR_CINE", {"MODELE": concept(model), "MECA_IMPO": list(occurrences)}, result="load_4")

    def meca(self, model="model_3", **keywords):
        return self.run_command("AFFE_CHAR_MECA", {"MODELE": concept(model), **keywords}, result="load_4")

    def imposed(self):
        """(node, component) -> value, and the number of rows."""
        with h5py.File(self.path("load_4")) as file:
            group = file["imposed"]
            names = [text(n) for n in group["component"][()]]
            rows = [((int(n), names[c]), v) for n, c, v in zip(group["node"][()], group["component_index"][()], group["value"][()])]
            self.assertEqual(len(dict(rows)), len(rows))
            return dict(rows)

    def pressure(self):
        with h5py.File(self.path("load_4")) as file:
            return dict(zip(file["pressure/cell"][()].tolist(), file["pressure/value"][()].tolist()))

    # ------------------------------------------------------------------------------------------ imposed displacements

    def test_displacements_of_groups_of_cells_of_nodes_and_of_nodes_by_name(self):
        run = self.cine({"GROUP_MA": ["TOP"], "DY": -1.0}, {"GROUP_NO": ["CORNER"], "DX": 0.0, "DY": 0.0}, {"NOEUD": ["N3"], "DY": 2.5})
        self.assertEqual(run.status, 0, run.stderr)
        self.assertEqual(self.imposed(), {(5, "DY"): -1, (4, "DY"): -1, (3, "DY"): -1, (0, "DX"): 0, (0, "DY"): 0, (2, "DY"): 2.5})
        self.assertEqual((self.attributes("load_4")["kind"], self.attributes("load_4")["model"]), ("cine", "model_3"))

    def test_tout_means_the_nodes_that_have_elements(self):
        self.cine({"TOUT": "OUI", "DX": 0.0})
        self.assertEqual(set(self.imposed()), {(n, "DX") for n in range(6)})

    def test_spaces_around_the_name_of_a_group_are_seen(self):
        run = self.cine({"GROUP_MA": ["TOP   "], "DY": 0.0})
        self.assertEqual((run.status, self.ids(run)), (2, ["MESH_1"]))
        self.assertIn("'TOP'", run.messages[0]["text"] + run.messages[0]["do"])

    def test_nodes_of_skin_cells_alone_alarm(self):
        """The mesher has not merged N7 with N6 of the body: a support there holds nothing. A skin that stands for a body lies elsewhere."""
        self.assertEqual(self.ids(self.cine({"GROUP_MA": ["LOOSE"], "DX": 0.0}, model="model_2")), [])
        self.write_mesh("mesh_1", [*COORDINATES[:6], COORDINATES[5]], CELLS, cell_groups=GROUPS, node_groups=NODES)
        for run in (self.cine({"GROUP_MA": ["LOOSE"], "DX": 0.0}, model="model_2"), self.meca(model="model_2", FORCE_NODALE=[{"GROUP_NO": ["ALONE"], "FX": 1.0}])):
            self.assertEqual((run.status, self.ids(run)), (0, ["CHARGE_26"]))
            self.assertIn("1 of the nodes belong to no body, the first is N7", run.stderr)
        self.assertEqual(self.ids(self.cine({"GROUP_MA": ["TOP"], "DX": 0.0}, model="model_2")), [])

    def test_nodes_that_are_left_out(self):
        self.cine({"TOUT": "OUI", "DX": 0.0})
        self.meca(DDL_IMPO=[{"GROUP_MA": ["TOP"], "SANS_GROUP_MA": ["BETWEEN"], "DY": 0.0},
                            {"GROUP_NO": ["BOTTOM"], "SANS_GROUP_NO": ["CORNER"], "SANS_NOEUD": ["N3"], "DX": 0.0}])
        self.assertEqual(set(self.imposed()), {(5, "DY"), (3, "DY"), (1, "DX")})
        run = self.meca(DDL_IMPO=[{"GROUP_MA": ["TOP"], "SANS_GROUP_NO": ["NOWHERE"], "DY": 0.0}])
        self.assertEqual(run.status, 2)
        self.assertIn("SANS_GROUP_NO", run.stderr)
        self.meca(FACE_IMPO=[{"GROUP_MA": ["TOP"], "SANS_NOEUD": ["N5"], "DNOR": 0.0}])
        rows, _ = self.relations(14, 2)
        self.assertEqual(set(np.nonzero(rows)[1] // 2), {5, 3})

    def test_every_displacement_held(self):
        for factor in ({"LIAISON": "ENCASTRE"}, {"BLOCAGE": ["DEPLACEMENT", "ROTATION"]}):
            self.assertEqual(self.meca(DDL_IMPO=[{"GROUP_NO": ["BOTTOM"], **factor}]).status, 0)
            self.assertEqual(self.imposed(), {(node, component): 0 for node in (0, 1, 2) for component in ("DX", "DY")})
            run = self.meca(DDL_IMPO=[{"GROUP_NO": ["BOTTOM"], "DX": 1.0, **factor}])
            self.assertEqual(run.status, 2)
            self.assertIn("CHARGE_4", run.stderr)

    def test_the_same_value_twice_is_one_row(self):
        self.meca(DDL_IMPO=[{"GROUP_MA": ["TOP"], "DX": 0.0}, {"NOEUD": ["N5"], "DX": 0.0}])
        self.assertEqual(len(self.imposed()), 3)
        self.assertEqual(self.attributes("load_4")["kind"], "meca")

    def refuses_imposed(self, identifier, occurrences, *words):
        for command, factor in (("AFFE_CHAR_CINE", "MECA_IMPO"), ("AFFE_CHAR_MECA", "DDL_IMPO")):
            self.assert_refuses(identifier, command, {"MODELE": concept("model_3"), factor: occurrences}, *words, result="load_4")

    def test_of_two_occurrences_the_last_one_wins_a_component(self):
        run = self.meca(DDL_IMPO=[{"GROUP_NO": ["BOTTOM"], "DX": 0.0, "DY": 0.0}, {"NOEUD": ["N2"], "DX": 1.0}])
        self.assertEqual((run.status, self.ids(run)), (0, ["CHARGE_20"]))
        imposed = self.imposed()
        self.assertEqual(len(imposed), 6)
        self.assertEqual((imposed[1, "DX"], imposed[1, "DY"]), (1.0, 0.0))
        self.assertIn("DX of the node N2, by DDL_IMPO[2]/NOEUD", run.messages[0]["text"])
        self.meca(DDL_IMPO=[{"NOEUD": ["N2"], "DX": 1.0}, {"GROUP_NO": ["BOTTOM"], "DX": 0.0}])
        self.assertEqual(self.imposed(), {(n, "DX"): 0.0 for n in (0, 1, 2)})

    def test_two_keywords_do_not_give_one_degree_of_freedom_two_values(self):
        self.assert_refuses("CHARGE_4", "AFFE_CHAR_MECA", {"MODELE": concept("model_3"), "DDL_IMPO": [{"NOEUD": ["N5"], "DX": 0.0}],
                                                          "FACE_IMPO": [{"GROUP_MA": ["TOP"], "DX": 1.0}]}, "DX", "N5", result="load_4")

    def test_nodes_without_element_are_refused(self):
        self.refuses_imposed("CHARGE_2", [{"GROUP_NO": ["ALONE"], "DX": 0.0}], "N7", "ALONE")

    def test_degrees_of_freedom_that_a_node_lacks_are_refused(self):
        self.refuses_imposed("CHARGE_3", [{"GROUP_NO": ["CORNER"], "DZ": 0.0}], "DZ", "N1", "DX, DY")

    def test_unknown_nodes_and_groups_are_refused(self):
        for name in ("N8", "N0", "N01", "N-1", "A1", "N1x", "N", "N99999999999999999999"):
            self.refuses_imposed("CHARGE_1", [{"NOEUD": [name], "DX": 0.0}], name)
        self.refuses_imposed("MESH_1", [{"GROUP_MA": ["TOPP"], "DX": 0.0}], "TOPP", "TOP")
        self.refuses_imposed("MESH_1", [{"GROUP_NO": ["TOP"], "DX": 0.0}], "no node group 'TOP'; there is a cell group of this name")
        self.refuses_imposed("MESH_2", [{"GROUP_MA": ["EMPTY"], "DX": 0.0}], "EMPTY")

    # ------------------------------------------------------------------------------------------ pressures

    def test_pressure_on_a_group(self):
        run = self.meca(PRES_REP=[{"GROUP_MA": ["TOP"], "PRES": 25.0}])
        self.assertEqual(run.status, 0, run.stderr)
        self.assertEqual(self.pressure(), {2: 25, 3: 25})
        self.assertEqual(self.ids(run), [])

    def test_the_same_pressure_twice_counts_once(self):
        self.meca(PRES_REP=[{"GROUP_MA": ["TOP"], "PRES": 25.0}, {"GROUP_MA": ["TOP"], "PRES": 25.0}])
        self.assertEqual(self.pressure(), {2: 25, 3: 25})

    def test_tout_means_every_skin_cell_of_the_model(self):
        self.meca(PRES_REP=[{"TOUT": "OUI", "PRES": 1.0}], VERI_NORM="NON")
        self.assertEqual(set(self.pressure()), {2, 3, 4, 5})

    def refuses_pressure(self, identifier, occurrences, *words):
        self.assert_refuses(identifier, "AFFE_CHAR_MECA", {"MODELE": concept("model_3"), "PRES_REP": occurrences}, *words, result="load_4")

    def test_cells_that_are_no_skin_of_the_model_are_refused(self):
        self.refuses_pressure("CHARGE_6", [{"GROUP_MA": ["BODY"], "PRES": 1.0}], "QUAD4", "M1", "BODY")
        self.refuses_pressure("CHARGE_6", [{"GROUP_MA": ["RIGHT"], "PRES": 1.0}], "SEG2", "M8")

    def test_a_skin_that_looks_into_its_body_is_refused_unless_told_otherwise(self):
        self.refuses_pressure("CHARGE_7", [{"GROUP_MA": ["INWARD"], "PRES": 1.0}], "M5", "INWARD")
        run = self.meca(PRES_REP=[{"GROUP_MA": ["INWARD"], "PRES": 1.0}], VERI_NORM="NON")
        self.assertEqual((run.status, self.pressure(), self.ids(run)), (0, {4: 1}, []))

    def test_a_loaded_skin_without_body_alarms(self):
        run = self.meca(model="model_2", PRES_REP=[{"GROUP_MA": ["LOOSE"], "PRES": 1.0}])
        self.assertEqual((run.status, self.ids(run)), (0, ["CHARGE_8"]))

    def test_a_skin_under_pressure_inside_a_body_alarms_unless_told_otherwise(self):
        run = self.meca(PRES_REP=[{"GROUP_MA": ["BETWEEN"], "PRES": 1.0}])
        self.assertEqual((run.status, self.ids(run, "A"), self.pressure()), (0, ["CHARGE_27"], {5: 1}))
        for word in ("BETWEEN", "1 cells", "M6", "M1 and M2"):
            self.assertIn(word, run.messages[0]["text"])
        self.path("load_4").unlink()
        self.assertEqual(self.ids(self.meca(PRES_REP=[{"GROUP_MA": ["BETWEEN"], "PRES": 1.0}], VERI_NORM="NON")), [])

    def test_where_the_model_ends_inside_the_mesh_a_skin_has_its_side(self):
        pressure = [{"GROUP_MA": ["BETWEEN"], "PRES": 1.0}]
        for without, status, said in ((0, 2, ["CHARGE_7"]), (1, 0, [])):  # N2-N5 leaves the right cell's neighbour, not the right cell
            elements = [0, 0, 1, 1, 1, 1, -1, -1]
            elements[without] = -1
            self.write_model("model_5", "mesh_1", ["D_PLAN/QUAD4", "D_PLAN/SEG2"], elements)
            run = self.meca(model="model_5", PRES_REP=pressure)
            self.assertEqual((run.status, self.ids(run)), (status, said))

    def test_orientation_goes_by_geometry_not_by_the_order_of_body_nodes(self):
        cells = [("QUAD4", [0, 3, 4, 1]), *CELLS[1:]]  # the left quadrangle inside out
        self.write_mesh("mesh_1", COORDINATES, cells, cell_groups=GROUPS, node_groups=NODES)
        self.assertEqual(self.meca(PRES_REP=[{"GROUP_MA": ["TOP"], "PRES": 1.0}]).status, 0)
        self.path("load_4").unlink()
        self.refuses_pressure("CHARGE_7", [{"GROUP_MA": ["INWARD"], "PRES": 1.0}], "M5")

    # ------------------------------------------------------------------------------------------ forces, gravity, functions

    def terms(self, kind, place="cell"):
        """(place, component) -> value, or the function's id"""
        with h5py.File(self.path("load_4")) as file:
            group = file[kind]
            names = [text(n) for n in group["component"][()]]
            values = group["value"][()].tolist()
            if "function" in group:
                functions = [text(n) for n in group["function"][()]]
                values = [functions[k] if k >= 0 else v for k, v in zip(group["function_index"][()], values)]
            return {(int(p), names[c]): v for p, c, v in zip(group[place][()], group["component_index"][()], values)}

    def test_forces_on_edges_bodies_and_nodes(self):
        run = self.meca(FORCE_CONTOUR=[{"GROUP_MA": ["TOP"], "FX": 1.0, "FY": -2.0}], FORCE_INTERNE=[{"GROUP_MA": ["BODY"], "FY": 3.0}],
                        FORCE_NODALE=[{"GROUP_NO": ["CORNER"], "FX": 4.0}])
        self.assertEqual(run.status, 0, run.stderr)
        self.assertEqual(self.terms("force"), {(2, "FX"): 1, (3, "FX"): 1, (2, "FY"): -2, (3, "FY"): -2, (0, "FY"): 3, (1, "FY"): 3})
        self.assertEqual(self.terms("nodal_force", "node"), {(0, "FX"): 4})
        self.assertIn("1 nodes under forces, 4 cells under forces", run.stdout)

    def test_the_side_of_a_skin_is_no_matter_for_forces(self):
        run = self.meca(FORCE_CONTOUR=[{"GROUP_MA": ["INWARD"], "FX": 1.0}])
        self.assertEqual((run.status, self.ids(run)), (0, []))

    def test_gravity_along_a_direction_of_any_length(self):
        self.meca(PESANTEUR=[{"GRAVITE": 10.0, "DIRECTION": [0, -2, 0]}])
        self.assertEqual(self.terms("gravity"), {(0, "FX"): 0, (0, "FY"): -10, (1, "FX"): 0, (1, "FY"): -10})

    def write_function(self, identifier, parameter):
        with self.create(identifier, "function", parameter=parameter, component="TOUTRESU", extension_left="EXCLU",
                         extension_right="EXCLU") as file:
            file.attrs["interpolation"] = np.array(["LIN", "LIN"], h5py.string_dtype())
            file["x"], file["y"] = np.array([0.0, 1.0]), np.array([0.0, 1.0])

    def write_formula(self, identifier, *parameters):
        with self.create(identifier, "formula", expression="0", constants="{}", lost="{}") as file:
            file.attrs["parameters"] = np.array(parameters, h5py.string_dtype())

    def test_functions_stay_functions(self):
        self.write_function("function_5", "INST")
        self.write_formula("formula_6", "X", "Y", "Z", "INST")
        run = self.run_command("AFFE_CHAR_MECA_F", {
            "MODELE": concept("model_3"), "DDL_IMPO": [{"GROUP_NO": ["CORNER"], "DX": concept("function_5")}],
            "PRES_REP": [{"GROUP_MA": ["TOP"], "PRES": concept("formula_6")}],
            "FORCE_CONTOUR": [{"GROUP_MA": ["TOP"], "FX": concept("formula_6"), "FY": concept("function_5")}]}, result="load_4")
        self.assertEqual(run.status, 0, run.stderr)
        self.assertEqual(self.terms("imposed", "node"), {(0, "DX"): "function_5"})
        self.assertEqual(self.terms("pressure"), {(2, "PRES"): "formula_6", (3, "PRES"): "formula_6"})
        self.assertEqual(self.terms("force")[2, "FY"], "function_5")
        self.assertEqual(self.attributes("load_4")["references"], '["model_3","function_5","formula_6"]')
        run = self.run_command("AFFE_CHAR_CINE_F", {
            "MODELE": concept("model_3"), "MECA_IMPO": [{"GROUP_NO": ["CORNER"], "DY": concept("formula_6")}]}, result="load_7")
        self.assertEqual((run.status, self.attributes("load_7")["kind"]), (0, "cine"))

    def test_functions_of_other_parameters_are_refused(self):
        self.write_function("function_5", "TEMP")
        self.assert_refuses("FUNCTION_2", "AFFE_CHAR_MECA_F", {"MODELE": concept("model_3"), "PRES_REP": [
            {"GROUP_MA": ["TOP"], "PRES": concept("function_5")}]}, "TEMP", "FUNCTION_5", "PRES_REP/PRES", result="load_4")

    def test_of_two_forces_pressures_or_functions_the_last_one_wins(self):
        self.write_function("function_5", "INST")
        self.write_function("function_6", "INST")
        run = self.run_command("AFFE_CHAR_CINE_F", {"MODELE": concept("model_3"), "MECA_IMPO": [
            {"GROUP_NO": ["CORNER"], "DX": concept("function_5")}, {"NOEUD": ["N1"], "DX": concept("function_6")}]}, result="load_7")
        self.assertEqual(self.ids(run), ["CHARGE_20"])
        with h5py.File(self.path("load_7")) as file:
            self.assertEqual([text(name) for name in file["imposed/function"][()]], ["function_6"])
        for group, keywords in (("force", {"FORCE_CONTOUR": [{"GROUP_MA": ["TOP"], "FX": 1.0}, {"GROUP_MA": ["TOP"], "FX": 2.0}]}),
                                ("nodal_force", {"FORCE_NODALE": [{"NOEUD": ["N1"], "FX": 1.0}, {"NOEUD": ["N1"], "FX": 2.0}]}),
                                ("pressure", {"PRES_REP": [{"GROUP_MA": ["TOP"], "PRES": 1.0}, {"GROUP_MA": ["TOP"], "PRES": 2.0}]})):
            self.assertEqual(self.ids(self.meca(**keywords)), ["CHARGE_20"])
            with h5py.File(self.path("load_4")) as file:
                self.assertEqual(set(file[f"{group}/value"][()].tolist()), {2.0})

    def refuses(self, identifier, keywords, *words):
        self.assert_refuses(identifier, "AFFE_CHAR_MECA", {"MODELE": concept("model_3"), **keywords}, *words, result="load_4")

    def test_loads_on_cells_of_another_kind_are_refused(self):
        self.refuses("CHARGE_6", {"FORCE_FACE": [{"GROUP_MA": ["TOP"], "FX": 1.0}]}, "SEG2", "M3", "face of a 3D body")
        self.refuses("CHARGE_6", {"FORCE_INTERNE": [{"GROUP_MA": ["TOP"], "FX": 1.0}]}, "M3", "body cell")
        self.refuses("CHARGE_6", {"PESANTEUR": [{"GROUP_MA": ["TOP"], "GRAVITE": 1.0, "DIRECTION": [0, 1, 0]}]}, "M3")
        self.refuses("CHARGE_9", {"FORCE_INTERNE": [{"GROUP_MA": ["BODY"], "FZ": 1.0}]}, "FZ", "M1", "FX, FY")
        self.refuses("CHARGE_3", {"FORCE_NODALE": [{"GROUP_NO": ["CORNER"], "FZ": 1.0}]}, "DZ", "N1")
        self.refuses("CHARGE_10", {"PESANTEUR": [{"GRAVITE": 1.0, "DIRECTION": [0, 1, 1]}]}, "leaves the plane")
        self.refuses("CHARGE_10", {"PESANTEUR": [{"GRAVITE": 1.0, "DIRECTION": [0, 0, 0]}]}, "no length")
        turn = {"VITESSE": 1.0, "CENTRE": [0, 0]}
        self.refuses("CHARGE_10", {"ROTATION": [{**turn, "AXE": [0, 0, 0]}]}, "ROTATION/AXE", "no length")

    # ------------------------------------------------------------------------------------------ relations

    def relations(self, n_dofs, dimension):
        """(rows, n_dofs) coefficients and the values"""
        with h5py.File(self.path("load_4")) as file:
            group = file["relations"]
            offset, nodes, index = group["offset"][()], group["node"][()], group["component_index"][()]
            names = [text(n) for n in group["component"][()]]
            rows = np.zeros((len(offset) - 1, n_dofs))
            for r, (a, b) in enumerate(zip(offset[:-1], offset[1:])):
                for node, component, coefficient in zip(nodes[a:b], index[a:b], group["coefficient"][a:b]):
                    rows[r, node * dimension + ("DX", "DY", "DZ").index(names[component])] += coefficient
            return rows, group["value"][()]

    def test_rigid_bodies_keep_rigid_motions_and_no_others(self):
        """Relations are independent, and their common null space is that of the rigid motions."""
        rng = np.random.default_rng(3)
        shapes = {"plane": rng.uniform(-1, 1, (7, 2)), "space": rng.uniform(-1, 1, (8, 3)) + 100, "two points": np.array([[0.0, 0, 1], [1, 2, 3]]),
                  "on a line": np.outer([0, 1, 0.3, 2.5], [1, -2, 0.5]) + 3, "in a plane of space": np.outer([0, 1, 2, 0.5], [1, 0, 1]) + [
                      [0, 0, 0], [0, 1, 0], [0, -1, 0], [0, 2, 0]], "twice the same point": np.array([[0.0, 0], [1, 0], [0, 0], [1, 1]])}
        for name, points in shapes.items():
            with self.subTest(name):
                n, dimension = points.shape
                element = f"{'D_PLAN' if dimension == 2 else '3D'}/SEG2" if dimension == 2 else "3D/TRIA3"
                size = 2 if dimension == 2 else 3
                cells = [("SEG2" if dimension == 2 else "TRIA3", [(k + j) % n for j in range(size)]) for k in range(n)]
                self.write_mesh("mesh_1", points, cells, cell_groups={"ALL": list(range(n))}, node_groups={"NODES": list(range(n))})
                self.write_model("model_3", "mesh_1", [element], [0] * n, dimension=dimension)
                run = self.meca(LIAISON_SOLIDE=[{"GROUP_NO": ["NODES"]}])
                self.assertEqual(run.status, 0, run.stderr)
                rows, values = self.relations(n * dimension, dimension)
                motions = []
                for d in range(dimension):
                    motions.append(np.tile(np.eye(dimension)[d], n))
                for i in range(dimension):
                    for j in range(i):
                        spin = np.zeros((dimension, dimension))
                        spin[i, j], spin[j, i] = 1, -1
                        motions.append(((points - points[0]) @ spin.T).ravel())
                rigid = np.linalg.matrix_rank(np.array(motions), tol=1e-9)
                self.assertEqual(len(rows), n * dimension - rigid)
                self.assertEqual(np.linalg.matrix_rank(rows / np.abs(rows).max(axis=1)[:, None], tol=1e-9), len(rows))
                self.assertLessEqual(np.abs(rows @ np.array(motions).T).max(), 1e-12 * np.abs(rows).max() * np.abs(motions).max())
                self.assertEqual(np.abs(values).max(), 0)
                self.path("load_4").unlink()

    def test_relations_that_are_wrong_are_refused(self):
        self.refuses("CHARGE_11", {"LIAISON_DDL": [{"NOEUD": ["N1", "N2"], "DDL": ["DX"], "COEF_MULT": [1.0, 2.0], "COEF_IMPO": 0.0}]}, "LIAISON_DDL/DDL")
        self.refuses("CHARGE_11", {"LIAISON_DDL": [{"NOEUD": ["N1", "N2"], "DDL": ["DX", "DX"], "COEF_MULT": [1.0], "COEF_IMPO": 0.0}]}, "COEF_MULT")
        self.refuses("CHARGE_3", {"LIAISON_UNIF": [{"GROUP_NO": ["BOTTOM"], "DDL": ["DZ"]}]}, "DZ", "N1")
        self.refuses("CHARGE_2", {"LIAISON_UNIF": [{"GROUP_NO": ["CORNER", "ALONE"], "DDL": ["DX"]}]}, "N7")
        self.refuses("CHARGE_12", {"FACE_IMPO": [{"GROUP_MA": ["BODY"], "DNOR": 0.0}]}, "M1", "no skin cell")
        sides = {"DDL_1": ["DX"], "COEF_MULT_1": [1.0], "DDL_2": ["DX"], "COEF_MULT_2": [-1.0], "COEF_IMPO": 0.0}
        self.refuses("CHARGE_13", {"LIAISON_GROUP": [{"GROUP_NO_1": ["BOTTOM"], "GROUP_NO_2": ["CORNER"], **sides}]}, "3 nodes", "1 on the other")
        self.refuses("CHARGE_13", {"LIAISON_GROUP": [{"GROUP_NO_1": ["BOTTOM"], "GROUP_MA_2": ["TOP"], "TRAN": [9.0, 1.0], **sides}]}, "two nodes")
        self.write_model("model_3", "mesh_1", ["AXIS/QUAD4", "AXIS/SEG2"], [0, 0, 1, 1, 1, 1, -1, -1])
        self.refuses("CHARGE_14", {"LIAISON_SOLIDE": [{"GROUP_NO": ["BOTTOM"]}]}, "BOTTOM")

    def test_relations_whose_terms_cancel(self):
        """They were left out with the value they were to have: 0 = 1 was done as nothing."""
        def link(coefficients, value, nodes=("N1", "N1")):
            return {"LIAISON_DDL": [{"NOEUD": list(nodes), "DDL": ["DX", "DX"], "COEF_MULT": coefficients, "COEF_IMPO": value}]}

        for coefficients in ([0.0, 0.0], [1.0, -1.0], [0.3, -0.1 - 0.2]):
            self.refuses("CHARGE_25", link(coefficients, 1.5), "LIAISON_DDL/DDL", "0 is 1.5")
        self.refuses("CHARGE_25", link([0.0, 0.0], 1.5, ("N1", "N2")), "0 is 1.5")
        self.assertEqual(self.meca(**link([1.0, -1.0], 0.0)).status, 0)
        with h5py.File(self.path("load_4")) as file:
            self.assertNotIn("relations", file)
        self.path("load_4").unlink()
        self.assertEqual(self.meca(**link([1.0, 2.0], 1.5)).status, 0)
        rows, values = self.relations(14, 2)
        self.assertEqual((rows[0, 0], values.tolist()), (3.0, [1.5]))
        with h5py.File(self.path("load_4")) as file:
            self.assertEqual(file["relations/offset"][()].tolist(), [0, 1])

    def test_displacements_along_axes_of_their_own(self):
        """ANGL_NAUT turns the axes about Z: 30 degrees; 90 degrees leave no round-off behind."""
        self.meca(LIAISON_OBLIQUE=[{"GROUP_NO": ["CORNER"], "ANGL_NAUT": [30.0, 0.0, 0.0], "DX": 2.0, "DY": 3.0}])
        rows, values = self.relations(14, 2)
        np.testing.assert_allclose(rows[:, :2], [[0.75**0.5, 0.5], [-0.5, 0.75**0.5]], atol=1e-15)
        self.assertEqual(values.tolist(), [2.0, 3.0])
        self.meca(LIAISON_OBLIQUE=[{"NOEUD": ["N1"], "ANGL_NAUT": [90.0], "DX": 0.0}])
        np.testing.assert_array_equal(self.relations(14, 2)[0][:, :2], [[0, 1]])
        self.refuses("CHARGE_3", {"LIAISON_OBLIQUE": [{"NOEUD": ["N1"], "ANGL_NAUT": [10.0], "DZ": 0.0}]}, "DZ", "N1")
        self.refuses("MODIREPERE_5", {"LIAISON_OBLIQUE": [{"NOEUD": ["N1"], "ANGL_NAUT": [0.0, 20.0, 0.0], "DX": 0.0}]}, "ANGL_NAUT")

    def nodal(self):
        """(node, component) -> sum of the forces."""
        sums = {}
        with h5py.File(self.path("load_4")) as file:
            group = file["nodal_force"]
            names = [text(n) for n in group["component"][()]]
            for n, c, v in zip(group["node"][()], group["component_index"][()], group["value"][()]):
                sums[int(n), names[c]] = sums.get((int(n), names[c]), 0.0) + v
        return sums

    def test_forces_in_axes_of_their_own(self):
        """ANGL_NAUT: the first axis is 30 degrees above x."""
        self.meca(FORCE_NODALE=[{"GROUP_NO": ["CORNER"], "ANGL_NAUT": [30.0], "FX": 2.0}, {"NOEUD": ["N2"], "ANGL_NAUT": [90.0], "FY": 3.0}])
        found = self.nodal()
        for place, value in {(0, "FX"): 3**0.5, (0, "FY"): 1.0, (1, "FX"): -3.0, (1, "FY"): 0.0}.items():
            self.assertAlmostEqual(found[place], value, delta=1e-14)

    def test_forces_along_edges_in_space(self):
        """A straight edge of length 3 gives its ends a sixth and its middle two thirds; edges that meet add up, FORCE_NODALE too; of two occurrences
        the later one holds."""
        points = [[0, 0, 0], [3, 0, 0], [0, 1, 0], [0, 0, 1], [1.5, 0, 0], [3, 4, 0]]
        self.write_mesh("mesh_1", points, [("TETRA4", [0, 1, 2, 3]), ("SEG3", [0, 1, 4]), ("SEG2", [1, 5]), ("POI1", [4]), ("POI1", [5])],
                        cell_groups={"BODY": [0], "EDGES": [1, 2], "LAST": [2]}, dimension=3)
        self.write_model("model_3", "mesh_1", ["3D/TETRA4", "DIS_T/POI1"], [0, -1, -1, 1, 1], dimension=3)
        run = self.meca(FORCE_ARETE=[{"GROUP_MA": ["EDGES"], "FZ": 6.0}, {"GROUP_MA": ["LAST"], "FZ": 1.0, "FX": 2.0}],
                        FORCE_NODALE=[{"NOEUD": ["N1"], "FZ": 0.5}])
        self.assertEqual(run.status, 0, run.stderr)
        expected = {(0, "FZ"): 3.5, (4, "FZ"): 12.0, (1, "FZ"): 3.0 + 2.0, (5, "FZ"): 2.0, (1, "FX"): 4.0, (5, "FX"): 4.0}
        found = self.nodal()
        self.assertEqual(set(found), set(expected))
        for place, value in expected.items():
            self.assertAlmostEqual(found[place], value, delta=1e-13)
        self.refuses("CHARGE_6", {"FORCE_ARETE": [{"GROUP_MA": ["BODY"], "FX": 1.0}]}, "TETRA4", "M1")

    def test_a_node_that_follows_others_on_average(self):
        """LIAISON_RBE3: rigid motions of the others are its own, whatever the weights; alike and around it, it is their weighted mean."""
        ring = {"GROUP_NO_MAIT": "MIDDLE", "DDL_MAIT": ["DX", "DY"], "NOEUD_ESCL": ["N1", "N3", "N6", "N4"], "DDL_ESCL": ["DX-DY"]}
        self.write_mesh("mesh_1", [*COORDINATES[:6], [1.0, 0.5]], [*CELLS[:6], ("POI1", [6])], cell_groups={**GROUPS, "LOOSE": [6], "RIGHT": [5]},
                        node_groups={**NODES, "MIDDLE": [6]})
        self.write_model("model_3", "mesh_1", ["D_PLAN/QUAD4", "D_PLAN/SEG2", "2D_DIS_T/POI1"], [0, 0, 1, 1, 1, 1, 2])
        points = np.array([*COORDINATES[:6], [1.0, 0.5]])
        for weights in ([1.0], [1.0, 2.0, 3.0, 7.0]):
            run = self.meca(LIAISON_RBE3=[{**ring, "COEF_ESCL": weights}])
            self.assertEqual(run.status, 0, run.stderr)
            rows, values = self.relations(14, 2)
            self.assertEqual((len(rows), np.abs(values).max()), (2, 0))
            for motion in (np.tile([1.0, 0.0], 7), np.tile([0.0, 1.0], 7), (points[:, ::-1] * [-1, 1]).ravel()):
                np.testing.assert_allclose(rows @ motion, 0, atol=1e-14)
            if len(weights) == 1:
                np.testing.assert_allclose(rows[0].reshape(7, 2)[[0, 2, 5, 3], 0], -0.25, atol=1e-14)
        self.meca(LIAISON_RBE3=[{"NOEUD_MAIT": "N7", "DDL_MAIT": ["DX"], "GROUP_NO_ESCL": ["BOTTOM"], "DDL_ESCL": ["DX-DY", "DX", "DX-DY"], "COEF_ESCL": [2.0]}])
        self.assertEqual(len(self.relations(14, 2)[0]), 1)
        self.refuses("CHARGE_24", {"LIAISON_RBE3": [{**ring, "NOEUD_ESCL": ["N1"], "COEF_ESCL": [1.0]}]}, "DX")
        self.refuses("CHARGE_24", {"LIAISON_RBE3": [{**ring, "DDL_ESCL": ["DX-DRZ"], "COEF_ESCL": [1.0]}]}, "DRZ")
        self.refuses("CHARGE_11", {"LIAISON_RBE3": [{**ring, "COEF_ESCL": [1.0, 2.0]}]}, "COEF_ESCL")

    def test_nodes_tied_to_the_cells_that_hold_them(self):
        """The loose node stands in the left cell at a quarter of its width and three quarters of its height; the cell's own nodes are tied
        to nothing; where it stands outside, it moves as the nearest point."""
        self.write_mesh("mesh_1", [*COORDINATES[:6], [0.25, 0.75]], [*CELLS, ("QUAD4", [6, 1, 2, 5])], cell_groups={**GROUPS, "LOOSE": [6]},
                        node_groups=NODES)
        self.write_model("model_3", "mesh_1", ["D_PLAN/QUAD4", "D_PLAN/SEG2"], [0, 0, 1, 1, 1, 1, 1, -1, 0])
        self.meca(LIAISON_MAIL=[{"GROUP_MA_MAIT": ["BODY"], "GROUP_NO_ESCL": ["ALONE", "CORNER"]}])
        rows, values = self.relations(14, 2)
        weights = {0: 0.75 * 0.25, 1: 0.25 * 0.25, 4: 0.25 * 0.75, 3: 0.75 * 0.75, 6: -1.0}
        expected = np.zeros((2, 14))
        for node, weight in weights.items():
            expected[[0, 1], [2 * node, 2 * node + 1]] = -weight
        np.testing.assert_allclose(rows, expected, atol=1e-12)
        self.assertEqual(values.tolist(), [0.0, 0.0])
        self.refuses("CHARGE_22", {"LIAISON_MAIL": [{"GROUP_MA_MAIT": ["TOP"], "GROUP_NO_ESCL": ["ALONE"]}]}, "LIAISON_MAIL/GROUP_MA_MAIT")
        self.write_mesh("mesh_1", [*COORDINATES[:6], [-0.5, 0.5]], [*CELLS, ("QUAD4", [6, 1, 2, 5])], cell_groups=GROUPS, node_groups=NODES)
        run = self.meca(LIAISON_MAIL=[{"GROUP_MA_MAIT": ["BODY"], "GROUP_NO_ESCL": ["ALONE"]}])
        self.assertEqual((run.status, self.ids(run)), (0, ["CHARGE_23"]))
        np.testing.assert_allclose(self.relations(14, 2)[0][0, [0, 6, 12]], [-0.5, -0.5, 1.0], atol=1e-9)
        run = self.meca(LIAISON_MAIL=[{"GROUP_MA_MAIT": ["BODY"], "GROUP_NO_ESCL": ["ALONE"], "DISTANCE_ALARME": 0.6}])
        self.assertEqual((run.status, self.ids(run)), (0, []))
        self.refuses("CHARGE_21", {"LIAISON_MAIL": [{"GROUP_MA_MAIT": ["BODY"], "GROUP_NO_ESCL": ["ALONE"], "DISTANCE_MAX": 0.4}]}, "N7")

    def test_edges_and_pairs_without_some_nodes(self):
        self.meca(ARETE_IMPO=[{"GROUP_MA": ["TOP"], "SANS_NOEUD": ["N5"], "DY": 1.0}])
        self.assertEqual(self.imposed(), {(5, "DY"): 1, (3, "DY"): 1})
        sides = {"DDL_1": ["DX"], "COEF_MULT_1": [1.0], "DDL_2": ["DX"], "COEF_MULT_2": [-1.0], "COEF_IMPO": 0.0}
        self.meca(LIAISON_GROUP=[{"GROUP_NO_1": ["BOTTOM"], "GROUP_MA_2": ["TOP"], "SANS_NOEUD": ["N1", "N4"], **sides}])
        rows, _ = self.relations(14, 2)
        self.assertEqual([sorted(np.nonzero(row)[0] // 2) for row in rows], [[1, 4], [2, 5]])
        self.meca(LIAISON_GROUP=[{"NOEUD_1": ["N1", "N3"], "NOEUD_2": ["N6", "N4"], **sides}])
        self.assertEqual([sorted(np.nonzero(row)[0] // 2) for row in self.relations(14, 2)[0]], [[0, 3], [2, 5]])

    def test_normals_of_a_bent_side_alarm(self):
        """The corner's mean normal is 45 degrees from both sides; multiplied by normal displacement it holds neither."""
        cells = [*CELLS[:7], ("SEG2", [2, 5])]
        self.write_mesh("mesh_1", COORDINATES, cells, cell_groups={**GROUPS, "BENT": [2, 7]}, node_groups=NODES)
        run = self.meca(FACE_IMPO=[{"GROUP_MA": ["BENT"], "DNOR": 0.0}])
        self.assertEqual((run.status, self.ids(run)), (0, ["CHARGE_16"]))
        rows, _ = self.relations(14, 2)
        np.testing.assert_allclose(rows[np.abs(rows[:, 10]) > 0][0, 10:12], [0.5**0.5, 0.5**0.5], atol=1e-15)

    def test_displacements_and_pressures_share_a_load(self):
        self.meca(DDL_IMPO=[{"GROUP_NO": ["BOTTOM"], "DY": 0.0}], PRES_REP=[{"GROUP_MA": ["TOP"], "PRES": -3.0}])
        self.assertEqual((len(self.imposed()), self.pressure()), (3, {2: -3, 3: -3}))


del OperatorTest

if __name__ == "__main__":
    import unittest

    unittest.main()
