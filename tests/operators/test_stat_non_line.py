"""stat_non_line alone: two unit squares of one QUAD8 each, the upper (slave) on the lower (master), everything by hand."""

import re
import unittest

import h5py
import numpy as np
from lacon_test import OperatorTest, concept, write_ragged

E, NU, PRESSURE = 2000.0, 0.3, 25.0
#: no residual under load falls below this, none without load is above it
UNREACHABLE = {"RESI_GLOB_MAXI": 1e-30, "ITER_GLOB_MAXI": 5}
#: plane strain, free sideways, pressed by p
EXX, EYY = NU * (1 + NU) * PRESSURE / E, -(1 - NU * NU) * PRESSURE / E


def square(bottom):
    """Nodes of a QUAD8 on [0, 1] x [bottom, bottom + 1], in Lacon's order."""
    return [(x, bottom + y) for x, y in [(0, 0), (1, 0), (1, 1), (0, 1), (0.5, 0), (1, 0.5), (0.5, 1), (0, 0.5)]]


LOWER, UPPER = list(range(8)), list(range(8, 16))
#: M1 master skin, M2 slave skin, M3 loaded skin, M4, M5 bodies
CELLS = [("SEG3", [2, 3, 6]), ("SEG3", [8, 9, 12]), ("SEG3", [10, 11, 14]), ("QUAD8", LOWER), ("QUAD8", UPPER)]
BASE = [(n, "DY", 0.0) for n in (0, 1, 4)]
AXIS = [(n, "DX", 0.0) for n in (0, 3, 7, 8, 11, 15)]


class TwoSquares(OperatorTest):
    """The base of these tests, without tests."""

    def setUp(self):
        super().setUp()
        self.write_mesh("mesh_1", square(-1) + square(0), CELLS, cell_groups={"MASTER": [0], "SLAVE": [1]})
        self.write_patches([1], [12])
        self.write_model("model_2", "mesh_1", ["D_PLAN/SEG3", "D_PLAN/QUAD8"], [0, 0, 0, 1, 1])
        self.write_material("material_3", ELAS={"E": E, "NU": NU})
        self.write_material_field("material_field_4", "mesh_1", ["material_3"], [0] * 5)
        self.write_load("load_5", imposed=BASE + AXIS, kind="cine")
        self.write_load("load_6", pressure=[(2, PRESSURE)])
        self.write_contact("contact_7")
        self.write_list("list_of_reals_8", [0.0, 1.0])

    def write_patches(self, cells, carriers):
        """One SEG3 and its middle node a patch."""
        with h5py.File(self.path("mesh_1"), "a") as file:
            patches = file.create_group("patches")
            patches["zone_group"] = np.array(["SLAVE"], h5py.string_dtype())
            patches["zone_offset"] = np.array([0, len(cells)], np.int64)
            patches["kind"] = np.full(len(cells), 14, np.int32)
            patches["parent"] = np.array(cells, np.int32)
            for name, members in (("cells", cells), ("carriers", carriers)):
                write_ragged(patches.create_group(name), "offset", "values", [[member] for member in members])

    def write_load(self, identifier, imposed=(), pressure=(), kind="meca"):
        with self.create(identifier, "load", references=["model_2"], model="model_2", kind=kind) as file:
            if imposed:
                names = sorted({component for _, component, _ in imposed})
                file["imposed/component"] = np.array(names, h5py.string_dtype())
                file["imposed/node"] = np.array([node for node, _, _ in imposed], np.int32)
                file["imposed/component_index"] = np.array([names.index(component) for _, component, _ in imposed], np.int32)
                file["imposed/value"] = np.array([value for _, _, value in imposed])
            if pressure:
                file["pressure/component"] = np.array(["PRES"], h5py.string_dtype())
                file["pressure/cell"] = np.array([cell for cell, _ in pressure], np.int32)
                file["pressure/component_index"] = np.zeros(len(pressure), np.int32)
                file["pressure/value"] = np.array([value for _, value in pressure])

    def write_contact(self, identifier, initial="OUI", slave=(1,), master=(0,), distance_limit=-1.0):
        with self.create(identifier, "contact", references=["model_2", "mesh_1"], model="model_2", mesh="mesh_1", algorithm="LAC",
                         smoothing=0, verify_normals=1, resi_geom=1e-6) as file:
            zones = file.create_group("zones")
            for name, value in (("slave_group", "SLAVE"), ("master_group", "MASTER"), ("jacobian", "INITIAL"), ("search", "RAPIDE"),
                                ("initial_status", initial)):
                zones[name] = np.array([value], h5py.string_dtype())
            zones["tolerance"] = np.array([1e-8])
            zones["distance_limit"] = np.array([distance_limit])
            for name, members in (("slave", slave), ("master", master), ("patches", range(len(slave)))):
                write_ragged(zones.create_group(name), "offset", "values", [list(members)])
            for name, values in (("cell", slave), ("patch", range(len(slave))), ("rank", [0] * len(slave))):
                file[f"slave/{name}"] = np.array(values, np.int32)
            file["slave/element"] = np.array(["LACS32D"] * len(slave), h5py.string_dtype())

    def write_list(self, identifier, values):
        with self.create(identifier, "list_of_reals") as file:
            file["values"] = np.array(values)

    def write_function(self, identifier, x, y, parameter="INST"):
        with self.create(identifier, "function", parameter=parameter, component="TOUTRESU", extension_left="EXCLU",
                         extension_right="EXCLU") as file:
            file.attrs["interpolation"] = np.array(["LIN", "LIN"], h5py.string_dtype())
            file["x"], file["y"] = np.array(x), np.array(y)

    def keywords(self, **changes):
        loads = changes.pop("loads", ["load_5", "load_6"])
        given = {"MODELE": concept("model_2"), "CHAM_MATER": concept("material_field_4"), "CONTACT": concept("contact_7"),
                 "EXCIT": [load if isinstance(load, dict) else {"CHARGE": concept(load)} for load in loads],
                 "COMPORTEMENT": {"RELATION": "ELAS", "DEFORMATION": "PETIT", "TOUT": "OUI"},
                 "INCREMENT": {"LIST_INST": concept("list_of_reals_8")},
                 "CONVERGENCE": {"RESI_GLOB_RELA": 1e-12, "ITER_GLOB_MAXI": 20}}
        given.update(changes)
        return {name: value for name, value in given.items() if value is not None}

    def solve(self, **changes):
        return self.run_command("STAT_NON_LINE", self.keywords(**changes), result="result_9", label="RESU")

    def assert_fails(self, identifier, *words, status=2, **changes):
        return self.assert_refuses(identifier, "STAT_NON_LINE", self.keywords(**changes), *words, status=status, result="result_9")


class StatNonLine(TwoSquares):
    # ------------------------------------------------------------------------------------------ what it computes

    def test_two_squares_pressed_together_are_uniform(self):
        run = self.solve()
        self.assertEqual((run.status, run.messages), (0, []), run.stderr)
        points = np.array(square(-1) + square(0))
        field = self.read_field("result_9", "DEPL", 1)
        self.assertEqual(field.components, ["DX", "DY", "LAGS_C"])
        np.testing.assert_array_equal(field.support, range(16))
        np.testing.assert_allclose(field.values[:, 0], EXX * points[:, 0], atol=1e-14)
        np.testing.assert_allclose(field.values[:, 1], EYY * (points[:, 1] + 1), atol=1e-14)
        np.testing.assert_array_equal(np.flatnonzero(field.present[:, 2] == 1), [12])  # the carrier alone
        np.testing.assert_array_equal(np.flatnonzero(field.present[:, 2] == 2), [8, 9])  # the others of the skin stand in
        np.testing.assert_allclose(field.values[[8, 9], 2], -PRESSURE, atol=1e-11)
        self.assertAlmostEqual(field.values[12, 2], -PRESSURE, delta=1e-11)
        stress = self.read_field("result_9", "SIEF_ELGA", 1)
        np.testing.assert_array_equal(stress.support, [3, 4])
        np.testing.assert_array_equal(stress.offset, [0, 9, 18])
        np.testing.assert_allclose(stress.values, [[0, -PRESSURE, -NU * PRESSURE, 0]] * 18, atol=1e-11)
        contact = self.read_field("result_9", "CONT_ELEM", 1)
        self.assertEqual(contact.components, ["CONT", "PRES", "JEU", "COEFSURF", "PRESCOOR"])
        np.testing.assert_array_equal(contact.support, [1])
        np.testing.assert_allclose(contact.values, [[1, -PRESSURE, 0, 1, -PRESSURE]], atol=1e-11)
        nodes = self.read_field("result_9", "CONT_NOEU", 1)
        np.testing.assert_array_equal(nodes.support, [8, 9, 12])
        force = PRESSURE * np.array([1 / 6, 1 / 6, 2 / 3])  # on the slave, upwards: shape functions of a SEG3 over its length 1
        expected = {"CONT": 2, "JEU": 0, "PRES": -PRESSURE, "RN": force, "RNX": 0, "RNY": force, "R": force, "RX": 0, "RY": force, "VX": 0, "VY": -1}
        self.assertEqual(nodes.components, list(expected))
        for column, values in enumerate(expected.values()):
            np.testing.assert_allclose(nodes.values[:, column], values, atol=1e-11)

    def test_a_body_that_lies_on_another_and_that_nothing_presses_is_told(self):
        """Its place is one of many: whatever lifts it is an equilibrium too. One that a displacement holds has a place."""
        run = self.solve(loads=["load_5"])
        self.assertEqual((run.status, self.ids(run)), (0, ["EVOLUTION_23"]), run.stderr)
        self.assertIn("at the instant 1 nothing presses the body of M5", run.stderr)
        self.write_load("load_10", imposed=[(15, "DY", 0.0)], kind="cine")
        self.assertEqual(self.ids(self.solve(loads=["load_5", "load_10"])), [])

    def test_the_proof_lines_say_what_the_zone_transmits(self):
        """Pressure times length on the slave, its opposite on the master, no moment; printed, and stored for each instant."""
        run = self.solve()
        self.assertIn("SLAVE on MASTER: 1 patches in contact, 0 open, 0 without master; covered", run.stdout)
        with h5py.File(self.path("result_9")) as index:
            zone = {name: values[()] for name, values in index["parameters"].items() if name.startswith("zone_1_")}
        self.assertEqual({len(values) for values in zone.values()}, {2})
        last = {name.removeprefix("zone_1_"): values[1] for name, values in zone.items()}
        self.assertEqual((last["active"], last["open"], last["unpaired"]), (1, 0, 0))
        self.assertAlmostEqual(last["slave_force_y"], PRESSURE, delta=1e-11)
        for axis in "xyz":
            self.assertAlmostEqual(last[f"slave_force_{axis}"] + last[f"master_force_{axis}"], 0, delta=1e-13 * PRESSURE)
            self.assertAlmostEqual(last[f"moment_{axis}"], 0, delta=1e-13 * PRESSURE)
        self.assertAlmostEqual(last["whole"], 1 + EXX, delta=1e-14)
        self.assertAlmostEqual(last["covered"], last["whole"], delta=1e-14)
        self.assertLessEqual(last["largest_lambda_gap"], 1e-8 * PRESSURE)

    def test_what_pairing_rejected_is_shown_on_demand(self):
        self.assertNotIn("pairing rejected", self.solve().stdout)
        self.assertIn("pairing rejected: 0 ", self.solve(INFO=2).stdout)

    def test_a_master_beyond_the_distance_limit_pairs_with_nothing(self):
        """The squares stand 0.3 apart, the skins have length 1; everything is held."""
        self.write_mesh("mesh_1", square(-1) + square(0.3), CELLS, cell_groups={"MASTER": [0], "SLAVE": [1]})
        self.write_patches([1], [12])
        self.write_load("load_5", imposed=[(n, component, 0.0) for n in range(16) for component in ("DX", "DY")], kind="cine")
        for limit, line in ((-1.0, "0 too far"), (0.31, "0 too far"), (0.29, "1 too far")):
            self.write_contact("contact_7", initial="NON", distance_limit=limit)
            run = self.solve(loads=["load_5"], INFO=2)
            self.assertEqual(run.status, 0, run.stderr)
            self.assertIn(line, run.stdout)
            open_or_unpaired = "0 open, 1 without" if limit == 0.29 else "1 open, 0 without"
            self.assertIn(open_or_unpaired, run.stdout)
            self.assertEqual("EVOLUTION_43" in self.ids(run), limit == 0.29)  # nothing met: slave, master or limit are wrong

    def test_forces_of_a_ring_are_said_to_be_those_of_one_radian(self):
        """Both squares turned round x = 0: the pressure times the area of one radian, r from 0 to 1; in the plane no such word."""
        self.assertNotIn("radian", self.solve().stdout)
        self.write_model("model_2", "mesh_1", ["AXIS/SEG3", "AXIS/QUAD8"], [0, 0, 0, 1, 1])
        printed = self.solve(COMPORTEMENT=None).stdout
        found = re.search(r"of one radian: force on the slave \(([^,]+), ([^)]+)\)", printed)
        self.assertTrue(found, printed)
        self.assertAlmostEqual(float(found[2]), PRESSURE / 2, delta=1e-4)

    def test_body_cells_that_no_behaviour_names_are_told(self):
        """Whoever names a skin for a body computes elastic cells; whoever gives no COMPORTEMENT asks for them."""
        self.write_mesh("mesh_1", square(-1) + square(0), CELLS, cell_groups={"MASTER": [0], "SLAVE": [1], "LOWER": [3], "SKIN": [2]})
        self.write_patches([1], [12])
        elastic = {"RELATION": "ELAS", "DEFORMATION": "PETIT"}
        run = self.solve(COMPORTEMENT=[{**elastic, "GROUP_MA": ["LOWER"]}, {**elastic, "GROUP_MA": ["SKIN"]}])
        self.assertEqual(self.ids(run), ["BEHAVIOUR_7"])
        self.assertIn("names 1 body cell(s), the first M5, in no occurrence", run.stderr)
        self.assertEqual(self.ids(self.solve(COMPORTEMENT=None)), [])

    def test_an_elastic_computation_of_a_material_that_could_flow_is_told(self):
        self.write_material("material_3", ELAS={"E": E, "NU": NU}, ECRO_LINE={"SY": 1e6, "D_SIGM_EPSI": 1.0})
        run = self.solve()
        self.assertEqual(self.ids(run), ["BEHAVIOUR_8"])
        self.assertIn("of 2 cell(s), the first M4, has ECRO_LINE", run.stderr)
        flows = {"RELATION": "VMIS_ISOT_LINE", "DEFORMATION": "PETIT", "TOUT": "OUI"}
        self.assertEqual(self.ids(self.solve(COMPORTEMENT=flows), "AFS"), [])

    def test_a_body_that_its_load_pulls_off_the_other_is_named(self):
        """Nothing else holds the upper square along y: no step is small enough, and the message says which body hangs on nothing. Springs of
        the matrix move it by as much in each iteration, against the same force: six of them show that."""
        self.write_load("load_6", pressure=[(2, -PRESSURE)])
        run = self.solve()
        self.assertEqual((run.status, self.ids(run, "FSI")), (3, ["EVOLUTION_20", "EVOLUTION_19", "EVOLUTION_4"]), run.stderr)
        self.assertRegex(run.stderr, "within [5-8] iterations")
        self.assertIn("the body of M5 hangs on nothing: contact that was to hold it opened again", run.stderr)
        self.assertIn("hold the body of M5", run.stderr)

    def test_one_slave_cell_over_two_separate_masters_pairs_with_both(self):
        """Masters under 0 to 0.3 and under 0.6 to 1: covered is 0.7, and the gap is their mean. Everything is held."""
        below = [(0.3 * x, y - 0.1) for x, y in square(-1)] + [(0.6 + 0.4 * x, y - 0.2) for x, y in square(-1)]
        cells = [("SEG3", [2, 3, 6]), ("SEG3", [10, 11, 14]), ("SEG3", [16, 17, 20]), ("SEG3", [18, 19, 22]),
                 ("QUAD8", LOWER), ("QUAD8", UPPER), ("QUAD8", [n + 16 for n in LOWER])]
        self.write_mesh("mesh_1", below + square(0), cells)
        self.write_patches([2], [20])
        self.write_model("model_2", "mesh_1", ["D_PLAN/SEG3", "D_PLAN/QUAD8"], [0, 0, 0, 0, 1, 1, 1])
        self.write_material_field("material_field_4", "mesh_1", ["material_3"], [0] * 7)
        self.write_load("load_5", imposed=[(n, component, 0.0) for n in range(24) for component in ("DX", "DY")], kind="cine")
        self.write_contact("contact_7", initial="NON", slave=[2], master=[0, 1])
        run = self.solve(loads=["load_5"])
        self.assertEqual(run.status, 0, run.stderr)
        contact = self.read_field("result_9", "CONT_ELEM", 1)
        gap = (0.3 * 0.1 + 0.4 * 0.2) / 0.7
        np.testing.assert_allclose(contact.values, [[0, 0, gap, 0.7, 0]], rtol=0, atol=1e-14)

    def test_an_overlap_that_is_imposed_is_an_alarm(self):
        """Everything is held: of the two squares that overlap, that touch and that stand apart only the first pair is named."""
        self.write_load("load_5", imposed=[(n, component, 0.0) for n in range(16) for component in ("DX", "DY")], kind="cine")
        for gap in (-0.125, 0.0, 0.125):
            self.write_mesh("mesh_1", square(-1) + square(gap), CELLS, cell_groups={"MASTER": [0], "SLAVE": [1]})
            self.write_patches([1], [12])
            run = self.solve(loads=["load_5"])
            self.assertEqual(run.status, 0, run.stderr)
            self.assertEqual("<A> <EVOLUTION_14> at the instant 1 1 patch(es)" in run.stderr, gap < 0, run.stderr)
            self.assertEqual("slave cell M2 with the gap -0.125" in run.stderr, gap < 0, run.stderr)

    def test_every_slave_cell_is_integrated_by_the_kernel_of_its_own_element(self):
        """Two slave cells of one kind, one of them axisymmetric: its measure has the factor r. Everything is held."""
        shifted = [(x + 1, y) for x, y in square(-1) + square(0)]
        cells = CELLS[:2] + CELLS[3:] + [(kind, [n + 16 for n in nodes]) for kind, nodes in CELLS[:2] + CELLS[3:]]
        self.write_mesh("mesh_1", square(-1) + square(0) + shifted, cells)
        self.write_patches([1, 5], [12, 28])
        self.write_model("model_2", "mesh_1", ["D_PLAN/SEG3", "AXIS/SEG3", "D_PLAN/QUAD8"], [0, 0, 2, 2, 1, 1, 2, 2])
        self.write_material_field("material_field_4", "mesh_1", ["material_3"], [0] * 8)
        self.write_load("load_5", imposed=[(n, component, 0.0) for n in range(32) for component in ("DX", "DY")], kind="cine")
        self.write_contact("contact_7", slave=[1, 5], master=[0, 4])
        run = self.solve(loads=["load_5"])
        self.assertEqual(run.status, 0, run.stderr)
        with h5py.File(self.path("result_9")) as index:
            self.assertAlmostEqual(index["parameters/zone_1_whole"][0], 1 + 1.5, delta=1e-14)  # x from 0 to 1; r from 1 to 2
            self.assertAlmostEqual(index["parameters/zone_1_covered"][0], 1 + 1.5, delta=1e-14)

    def test_the_table_has_the_peers_columns_and_counts_negative_pivots(self):
        run = self.solve(AFFICHAGE={"INFO_RESIDU": "OUI"})
        for word in ("ITERATION", "RESI_GLOB_RELA", "RESI_GLOB_MAXI", "AU POINT", "VARI. CONT.", "CRIT. GEOM.", "PIVOTS", "SECONDS"):
            self.assertIn(word, run.stdout)
        lines = [line.split("|")[1:-1] for line in run.stdout.splitlines() if line.startswith(" |") and "TANGENTE" in line]
        self.assertEqual([line[0].strip() for line in lines][0], "0X")
        self.assertTrue(lines[-1][0].strip().isdigit())  # converged: no X
        self.assertEqual({line[8].strip() for line in lines}, {"1"})  # one active patch
        self.assertEqual(run.counts["factorisations"], len(lines))
        self.assertEqual(run.counts["solutions"], len(re.findall(r"^ \|\s+\d+X? ", run.stdout, re.MULTILINE)))
        self.assertGreater(run.counts["Gflop of factorisations"], 0)

    def test_loads_follow_their_functions(self):
        self.write_function("function_10", [0, 0.5, 1], [0, 1, 0.5])
        self.write_list("list_of_reals_8", [0.0, 0.5, 1.0])
        run = self.solve(loads=["load_5", {"CHARGE": concept("load_6"), "FONC_MULT": concept("function_10")}])
        self.assertEqual(run.status, 0, run.stderr)
        for order, factor in enumerate((0, 1, 0.5)):
            np.testing.assert_allclose(self.read_field("result_9", "CONT_ELEM", order).values[0, 1], -factor * PRESSURE, atol=1e-11)

    def test_a_formula_needs_the_launcher(self):
        with self.create("formula_10", "formula", expression="INST", constants="{}", lost="{}") as file:
            file.attrs["parameters"] = np.array(["INST"], h5py.string_dtype())
        self.assert_fails("FORMULE_6", "FORMULA_10", loads=["load_5", {"CHARGE": concept("load_6"), "FONC_MULT": concept("formula_10")}])

    def test_a_multiplier_of_another_parameter_than_time_is_refused(self):
        self.write_function("function_10", [0, 1], [0, 1], parameter="X")
        self.assert_fails("FUNCTION_2", "FUNCTION_10", "depends on X",
                          loads=["load_5", {"CHARGE": concept("load_6"), "FONC_MULT": concept("function_10")}])

    def test_without_contact_one_body_is_pulled(self):
        self.write_load("load_6", imposed=[(n, "DY", 0.01) for n in (10, 11, 14)])
        self.write_load("load_5", imposed=BASE + AXIS + [(n, "DY", 0.0) for n in (8, 9, 12)])
        run = self.solve(CONTACT=None)
        self.assertEqual(run.status, 0, run.stderr)
        self.assertNotIn("VARI. CONT.", run.stdout)
        field = self.read_field("result_9", "DEPL", 1)
        self.assertEqual(field.components, ["DX", "DY"])
        self.assertIsNone(field.present)
        stress = self.read_field("result_9", "SIEF_ELGA", 1).values[9:]
        np.testing.assert_allclose(stress[:, 1], E / (1 - NU * NU) * 0.01, rtol=1e-12)
        np.testing.assert_allclose(self.read_field("result_9", "SIEF_ELGA", 1).values[:9], 0, atol=1e-12)

    def pull_with_every_displacement_imposed(self, iterations=0, **changes):
        """Both squares follow u = 0.01 y, v = 0.02 y at each node: no equation is left. The stress is Hooke's."""
        points = np.array(square(-1) + square(0))
        imposed = [(n, component, factor * points[n, 1]) for n in range(16) for component, factor in (("DX", 0.01), ("DY", 0.02))]
        self.write_load("load_5", imposed=imposed, kind="cine")
        run = self.solve(**changes)
        self.assertEqual(run.status, 0, run.stderr)
        with h5py.File(self.path("result_9")) as index:
            np.testing.assert_array_equal(index["parameters/newton_iterations"], [0, iterations])
        field = self.read_field("result_9", "DEPL", 1).values
        np.testing.assert_array_equal(field[:, :2], np.outer(points[:, 1], (0.01, 0.02)))
        volume, shear = E * NU / ((1 + NU) * (1 - 2 * NU)), E / (1 + NU)
        stress = [volume * 0.02, (volume + shear) * 0.02, volume * 0.02, shear * 0.005]
        np.testing.assert_allclose(self.read_field("result_9", "SIEF_ELGA", 1).values, [stress] * 18, rtol=0, atol=1e-12 * E)

    def test_where_every_displacement_is_imposed_nothing_is_left_to_solve(self):
        self.pull_with_every_displacement_imposed(CONTACT=None, loads=["load_5"])
        self.pull_with_every_displacement_imposed(CONTACT=None, loads=["load_5", "load_6"])

    def test_every_displacement_imposed_and_a_relation_between_them(self):
        """Between nodes 4 and 9, which are one point: it holds already, and is no equation either."""
        self.write_load("load_10", imposed=())
        with h5py.File(self.path("load_10"), "a") as file:
            relations = file.create_group("relations")
            write_ragged(relations, "offset", "node", [[3, 8]])
            relations["component"] = np.array(["DX"], h5py.string_dtype())
            relations["component_index"], relations["coefficient"] = np.zeros(2, np.int32), np.array([1.0, -1.0])
            relations["value"], relations["source"] = np.array([0.0]), np.array(["LIAISON_DDL[1]"], h5py.string_dtype())
        self.pull_with_every_displacement_imposed(CONTACT=None, loads=["load_5", "load_10"])

    def test_every_displacement_imposed_and_contact(self):
        """The patch is locked: one iteration more sees that the contact's geometry rests."""
        self.pull_with_every_displacement_imposed(iterations=1, loads=["load_5"])

    def test_only_what_archivage_asks_for_is_kept(self):
        self.write_list("list_of_reals_8", [0.0, 0.25, 0.5, 0.75, 1.0])
        run = self.solve(ARCHIVAGE={"PAS_ARCH": 3, "CHAM_EXCLU": ["SIEF_ELGA"]})
        self.assertEqual(run.status, 0, run.stderr)
        with h5py.File(self.path("result_9")) as index:
            np.testing.assert_array_equal(index["instant"], [0.0, 0.75, 1.0])  # the last one always
            self.assertEqual(sorted(index["fields"]), ["CONT_ELEM", "CONT_NOEU", "DEPL"])
            np.testing.assert_array_equal(index["fields/DEPL/order"], [0, 1, 2])

    def test_instants_behind_the_last_one_are_told(self):
        self.write_list("list_of_reals_8", [0.0, 0.5, 1.0])
        self.write_list("list_of_reals_7", [-1.0, 0.5, 1.0 + 1e-9, 3.0, 2.0])
        kind = {"PRECISION": 1e-6, "CRITERE": "RELATIF"}
        for archived, words in (({"INST": [0.5, 1.0], **kind}, []), ({"INST": [0.5, 3.0], **kind}, ["ARCHIVAGE/INST: 1 of", ", 1, from 3 on"]),
                                ({"LIST_INST": concept("list_of_reals_7"), **kind}, ["ARCHIVAGE/LIST_INST: 2 of", "from 2 on"])):
            run = self.solve(ARCHIVAGE=archived)
            self.assertEqual(run.status, 0, run.stderr)
            self.assertEqual([m["severity"] for m in run.messages if m["id"] == "STEP_7"], ["I"] * bool(words))
            for word in words:
                self.assertIn(word, next(m["text"] for m in run.messages if m["id"] == "STEP_7"))

    def test_instants_and_fields_that_archivage_names_in_vain_are_told(self):
        self.write_list("list_of_reals_8", [0.0, 0.5, 1.0])
        for archived, alarms, words in (({"INST": [0.5], "PRECISION": 1e-6, "CRITERE": "RELATIF"}, [], ""), ({"INST": [0.5, 0.7, 3.0], "PRECISION": 1e-6, "CRITERE": "RELATIF"}, ["EVOLUTION_56", "STEP_7"], "1 of these instants, the first is 0.7"),
                                        ({"CHAM_EXCLU": ["VARI_ELGA"]}, [], ""), ({"CHAM_EXCLU": ["DEPLL"]}, ["EVOLUTION_58"], "no field 'DEPLL'"),
                                        ({"DETR_NUME_SUIV": "OUI"}, ["EVOLUTION_62"], "none is removed")):
            run = self.solve(ARCHIVAGE=archived)
            self.assertEqual((run.status, self.ids(run)), (0, alarms), run.stderr)
            self.assertIn(words, run.stderr)

    def test_any_solver_is_mumps_and_says_so(self):
        self.assertEqual(self.solve().status, 0)
        expected = self.read_field("result_9", "DEPL", 1).values
        run = self.solve(SOLVEUR={"METHODE": "GCPC", "PRE_COND": "LDLT_INC", "RESI_RELA": 1e-8})
        self.assertEqual((run.status, self.ids(run)), (0, ["EVOLUTION_24"]), run.stderr)
        self.assertIn("METHODE='GCPC'", run.stderr)
        np.testing.assert_array_equal(self.read_field("result_9", "DEPL", 1).values, expected)

    def test_iterations_that_would_never_or_at_once_end_are_refused(self):
        for share in (-1e-8, 0.0, 1.0, 2.0):
            with self.subTest(share):
                self.assert_fails("SOLVER_15", f"{share:g}", SOLVEUR={"METHODE": "PETSC", "RESI_RELA": share})
        self.assertEqual(self.solve(SOLVEUR={"METHODE": "MUMPS", "RESI_RELA": -1.0}).status, 0)  # of a factor it is not checked then

    def test_auto_takes_mumps_for_few_equations_and_says_so(self):
        self.assertEqual(self.solve().status, 0)
        expected = self.read_field("result_9", "DEPL", 1).values
        run = self.solve(SOLVEUR={"METHODE": "AUTO"})
        self.assertEqual((run.status, self.ids(run)), (0, ["EVOLUTION_39"]), run.stderr)
        self.assertIn("MUMPS for", run.stderr)
        np.testing.assert_array_equal(self.read_field("result_9", "DEPL", 1).values, expected)

    # ------------------------------------------------------------------------------------------ what it refuses

    def test_an_order_that_lacks_a_keyword_is_refused(self):
        self.assert_fails("ORDER_2", "MODELE", MODELE=None)

    def test_an_unknown_keyword_is_refused(self):
        self.assert_fails("ORDER_3", "CONTACTE", CONTACTE="OUI")

    def test_loads_that_contradict_each_other_are_refused(self):
        self.write_load("load_6", imposed=[(4, "DY", 0.5)])
        self.assert_fails("LOAD_1", "N5 DY", "LOAD_5", "LOAD_6")

    def test_a_load_that_is_named_twice_is_refused(self):
        """It would count twice, or once, depending on its kind."""
        self.assert_fails("LOAD_3", "EXCIT[3]/CHARGE", "LOAD_6", loads=["load_5", "load_6", "load_6"])

    def test_a_function_outside_its_range_is_refused(self):
        self.write_function("function_10", [0, 0.5], [0, 1])
        self.assert_fails("FUNCTION_1", "FUNCTION_10", "INST = 1",
                          loads=["load_5", {"CHARGE": concept("load_6"), "FONC_MULT": concept("function_10")}])

    def test_a_body_without_material_is_refused(self):
        self.write_material_field("material_field_4", "mesh_1", ["material_3"], [0, 0, 0, -1, 0])
        self.assert_fails("ELEMENT_2", "M4")

    def test_a_material_without_a_parameter_is_refused(self):
        self.write_material("material_3", ELAS={"E": E})
        self.assert_fails("ELEMENT_3", "ELAS/NU", "MATERIAL_3")

    def test_instants_that_are_not_in_the_list_are_refused(self):
        self.assert_fails("EVOLUTION_5", "0.3", INCREMENT={"LIST_INST": concept("list_of_reals_8"), "INST_FIN": 0.3})

    def test_a_body_that_nothing_holds_is_a_failed_solution(self):
        self.write_load("load_10", imposed=AXIS)
        self.assert_fails("SOLVER_3", "DY", status=3, loads=["load_6", "load_10"])
        with self.create("time_steps_10", "time_steps", cut=1, cut_into=2, cut_levels=2, smallest=0.0) as file:
            file["values"] = np.array([0.0, 1.0])
        run = self.solve(loads=["load_6", "load_10"], INCREMENT={"LIST_INST": concept("time_steps_10")})
        self.assertEqual((run.status, self.ids(run)), (3, ["EVOLUTION_19", "SOLVER_3"]), run.stderr)  # a shorter step is as loose
        self.assertIn("DY of the body of M", run.stderr)

    def test_line_search_and_extrapolation_lead_to_the_same_solution(self):
        """A pressure that grows in four equal steps to large strains: extrapolated instants start nearer to their end. Without PREDICTION they do as soon
        as two motions have shown that it would."""
        self.write_function("function_10", [0, 4], [0, 8])
        self.write_list("list_of_reals_8", [0.0, 1.0, 2.0, 3.0, 4.0])
        iterations, ends = {}, {}
        searched = {"METHODE": "CORDE", "RESI_LINE_RELA": 0.1, "ITER_LINE_MAXI": 3, "RHO_MIN": 1e-2, "RHO_MAX": 10.0, "RHO_EXCL": 0.9e-2}
        for name, more in {"plain": {"NEWTON": {"PREDICTION": "TANGENTE"}}, "by itself": {}, "EXTRAPOLE": {"NEWTON": {"PREDICTION": "EXTRAPOLE"}}, "CORDE": {"RECH_LINEAIRE": searched},
                           "MIXTE": {"RECH_LINEAIRE": {**searched, "METHODE": "MIXTE"}}}.items():
            run = self.solve(loads=["load_5", {"CHARGE": concept("load_6"), "FONC_MULT": concept("function_10")}],
                             COMPORTEMENT={"RELATION": "ELAS", "DEFORMATION": "GREEN_LAGRANGE", "TOUT": "OUI"}, **more)
            self.assertEqual((run.status, run.messages), (0, []), run.stderr)
            iterations[name] = [int(words.split()[0]) for words in run.stdout.split(" with ") if words.split()[1:2] == ["iteration(s)"]]
            ends[name] = self.read_field("result_9", "DEPL", 4).values
        self.assert_refused(self.solve(RECH_LINEAIRE={**searched, "RHO_MIN": 0.5, "RHO_MAX": 0.2}), "EVOLUTION_57", "RHO_MIN=0.5", "RHO_MAX=0.2")
        for name, values in ends.items():
            np.testing.assert_allclose(values, ends["plain"], atol=1e-10, err_msg=name)
        self.assertEqual(iterations["EXTRAPOLE"][0], iterations["plain"][0])  # nothing has moved before the first step
        self.assertLess(sum(iterations["EXTRAPOLE"]), sum(iterations["plain"]))
        self.assertEqual(iterations["by itself"][:2], iterations["plain"][:2])
        self.assertLess(sum(iterations["by itself"]), sum(iterations["plain"]))

    def test_a_pressure_in_other_units_than_the_modulus_is_told_where_it_fails(self):
        """25 MPa as 25e6 beside a modulus in MPa: whatever the iterations fail at, the load is beyond what solids bear."""
        for factor, told in ((1, False), (1e6, True)):
            self.write_load("load_6", pressure=[(2, factor * PRESSURE)])
            run = self.solve(CONVERGENCE=UNREACHABLE)
            self.assertEqual(run.status, 3, run.stderr)
            self.assertEqual("look at the units: the pressure of 2.5e+07 on cell M3" in run.stderr, told, run.stderr)
            self.assertEqual("modulus E=2000" in run.stderr, told)
        self.write_function("function_10", [0, 0.5], [0, 1])  # it does not reach the end of the list: why the first step fails is told all the same
        self.write_list("list_of_reals_8", [0.0, 0.5, 1.0])
        run = self.solve(loads=["load_5", {"CHARGE": concept("load_6"), "FONC_MULT": concept("function_10")}], CONVERGENCE=UNREACHABLE)
        self.assert_refused(run, "EVOLUTION_4", status=3)

    def test_a_failure_keeps_what_was_computed_before_it(self):
        self.write_function("function_10", [0, 1, 2], [0, 0, 1])
        self.write_list("list_of_reals_8", [0.0, 1.0, 2.0])
        run = self.solve(loads=["load_5", {"CHARGE": concept("load_6"), "FONC_MULT": concept("function_10")}],
                         CONVERGENCE=UNREACHABLE)
        self.assert_refused(run, "EVOLUTION_4", "instant 2", "RESI_GLOB_MAXI", status=3)
        with h5py.File(self.path("result_9")) as index:
            np.testing.assert_array_equal(index["instant"], [0.0, 1.0])

    def test_a_failing_step_is_cut_where_the_list_says_so(self):
        with self.create("time_steps_10", "time_steps", cut=1, cut_into=2, cut_levels=2, smallest=0.0) as file:
            file["values"] = np.array([0.0, 1.0])
        run = self.solve(INCREMENT={"LIST_INST": concept("time_steps_10")}, CONVERGENCE={**UNREACHABLE, "ITER_GLOB_MAXI": 2})
        self.assertEqual(self.ids(run), ["EVOLUTION_7", "EVOLUTION_7", "EVOLUTION_71", "EVOLUTION_73", "EVOLUTION_76", "EVOLUTION_4"])  # two levels at most
        self.assertEqual(run.status, 3)
        self.assertFalse(self.path("result_9").exists())

    def test_what_round_off_leaves_is_not_cut(self):
        """Iterations enough show that it is no more than that."""
        run = self.solve(CONVERGENCE=UNREACHABLE)
        self.assertEqual(self.ids(run), ["EVOLUTION_19", "EVOLUTION_4"])
        self.assertEqual(run.status, 3)

    # ------------------------------------------------------------------------------------------ a step that failed

    def failed_step(self):
        return self.base / "result_9" / "failed_step.h5"

    def fail_second_step(self, **changes):
        """Instant 1 has no load and converges; instant 2 has one, and meets no criterion."""
        self.write_function("function_10", [0, 1, 2, 3], [0, 0, 1, 1])
        self.write_list("list_of_reals_8", [0.0, 1.0, 2.0])
        return self.solve(loads=["load_5", {"CHARGE": concept("load_6"), "FONC_MULT": concept("function_10")}],
                          **{"CONVERGENCE": UNREACHABLE, **changes})

    def test_the_last_iterates_of_a_failed_step_are_kept_beside_the_result(self):
        run = self.fail_second_step(CONVERGENCE={**UNREACHABLE, "ITER_GLOB_MAXI": 8})
        self.assert_refused(run, "EVOLUTION_4", status=3)
        self.assertIn("`lacon report study.base`", run.messages[-1]["do"])
        with h5py.File(self.failed_step()) as step:
            about = dict(step.attrs)
            self.assertEqual([about[k] for k in ("lacon_type", "format", "label", "mesh", "contact", "begins", "instant", "message")],
                             ["failed_step", 1, "RESU", "mesh_1", "contact_7", 1.0, 2.0, "EVOLUTION_4"])
            self.assertEqual(about["text"], run.messages[-1]["text"])
            np.testing.assert_array_equal(step["iteration"], range(3, 9))
            self.assertEqual(sorted(step["fields"]), ["CONT_ELEM", "DEPL", "RESI_NOEU"])
            for name, width in (("CONT_ELEM", 5), ("DEPL", 2), ("RESI_NOEU", 2)):
                self.assertEqual(sorted(step[f"fields/{name}"]), [str(i) for i in range(3, 9)])
                self.assertEqual(step[f"fields/{name}/8/values"].shape[1], width)
            residual = step["fields/RESI_NOEU/8/values"][:]
            self.assertEqual(abs(residual).max(), step["parameters/resi_glob_maxi"][-1])
            points = np.array(square(-1) + square(0))
            np.testing.assert_allclose(step["fields/DEPL/8/values"][:, 1], EYY * (points[:, 1] + 1), atol=1e-12)
            self.assertEqual(step["fields/CONT_ELEM/8"].attrs["instant"], 2.0)
        with h5py.File(self.path("result_9")) as index:  # and no instant of the result
            np.testing.assert_array_equal(index["instant"], [0.0, 1.0])
            self.assertNotIn("RESI_NOEU", index["fields"])
        self.assertEqual(self.failed_step().read_bytes()[-32:-24], b"LACONSUM")

    def test_a_step_that_fails_before_any_instant_leaves_its_iterates_and_no_result(self):
        run = self.solve(CONVERGENCE=UNREACHABLE)
        self.assert_refused(run, "EVOLUTION_4", status=3)
        self.assertFalse(self.path("result_9").exists())
        self.assertTrue(self.failed_step().exists())
        self.assertTrue((self.base / "result_9/journal.jsonl").exists())

    def test_the_iterates_go_when_an_instant_as_late_converges_and_are_replaced_when_another_step_fails(self):
        self.fail_second_step()
        before = self.failed_step().read_bytes()
        self.fail_second_step(CONVERGENCE={**UNREACHABLE, "ITER_GLOB_MAXI": 7})
        self.assertNotEqual(self.failed_step().read_bytes(), before)
        loads = ["load_5", {"CHARGE": concept("load_6"), "FONC_MULT": concept("function_10")}]
        keywords = self.keywords(loads=loads, RESULTAT=concept("result_9"), ETAT_INIT={"EVOL_NOLI": concept("result_9")})
        run = self.run_command("STAT_NON_LINE", keywords, result="result_9", label="RESU", reuse=True)
        self.assertEqual(run.status, 0, run.stderr)
        self.assertFalse(self.failed_step().exists())
        with h5py.File(self.path("result_9")) as index:
            np.testing.assert_array_equal(index["instant"], [0.0, 1.0, 2.0])

    def test_a_computation_without_failure_leaves_no_iterates(self):
        self.assertEqual(self.solve().status, 0)
        self.assertFalse(self.failed_step().exists())


if __name__ == "__main__":
    unittest.main()
