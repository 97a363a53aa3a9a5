"""DEFI_CONTACT alone, on bases made by hand."""

import h5py
import numpy as np

from lacon_test import OperatorTest, concept, read_ragged, text, write_ragged

# The slave body stands on y = 0: two triangles that DECOUPE_LAC cut in two each (patches of kind 7), and one between them.
# The master body lies below y = -0.1.
COORDINATES = [[0, 0], [1, 0], [2, 0], [3, 0], [4, 0], [1, 2], [3, 2], [0, -0.1], [4, -0.1], [0, -1], [4, -1], [9, 9], [8, 9]]
CELLS = [
    ("SEG2", [0, 1]), ("SEG2", [1, 2]),  # 0, 1: first patch
    ("SEG2", [2, 3]), ("SEG2", [3, 4]),  # 2, 3: second patch
    ("SEG2", [8, 7]),                    # 4: master
    ("SEG2", [7, 8]),                    # 5: the same, inward
    ("SEG2", [11, 12]),                  # 6: of no body
    ("SEG2", [9, 10]),                   # 7: no element in the model
    ("TRIA3", [0, 1, 5]), ("TRIA3", [1, 2, 5]), ("TRIA3", [2, 3, 6]), ("TRIA3", [3, 4, 6]), ("TRIA3", [2, 6, 5]),
    ("QUAD4", [9, 10, 8, 7]),
]
GROUPS = {"ESCL": [0, 1, 2, 3], "MAIT": [4], "INWARD": [5], "LOOSE": [6], "BARE": [7], "BOTH": [4, 3], "BODY": [13], "EMPTY": [],
          "ESCL_1": [0, 1], "ESCL_2": [2, 3], "TWICE": [4, 4]}
ELEMENTS = ["D_PLAN/SEG2", "D_PLAN/TRIA3", "D_PLAN/QUAD4", "COQUE_3D/SEG2"]
OF_CELL = [0] * 7 + [-1] + [1] * 5 + [2]


def zone(**more):
    return {"GROUP_MA_ESCL": "ESCL", "GROUP_MA_MAIT": "MAIT", "ALGO_CONT": "LAC", **more}


def keywords(*zones, **more):
    return {"MODELE": concept("model_2"), "FORMULATION": "CONTINUE", "ALGO_RESO_GEOM": "NEWTON", "ZONE": list(zones or [zone()]), **more}


class DefiContact(OperatorTest):
    def setUp(self):
        super().setUp()
        self.make()

    def make(self, zones=("ESCL",), zone_offset=(0, 2), kind=(7, 7), sub_cells=((0, 1), (2, 3)), carriers=((1,), (3,)), cells=CELLS,
             of_cell=OF_CELL, groups=GROUPS, coordinates=COORDINATES, node_groups=None):
        self.write_mesh("mesh_1", coordinates, cells, cell_groups=groups, node_groups=node_groups, label="MA")
        if zones:
            with h5py.File(self.path("mesh_1"), "a") as file:
                group = file.create_group("patches")
                group["zone_group"] = np.array(zones, h5py.string_dtype())
                group["zone_offset"] = np.array(zone_offset, np.int64)
                group["kind"] = np.array(kind, np.int32)
                group["parent"] = np.arange(len(kind), dtype=np.int32)
                write_ragged(group.create_group("cells"), "offset", "values", sub_cells)
                write_ragged(group.create_group("carriers"), "offset", "values", carriers)
        self.write_model("model_2", "mesh_1", ELEMENTS, of_cell)

    def define(self, *zones, **more):
        return self.run_command("DEFI_CONTACT", keywords(*zones, **more), result="contact_3")

    def refuses(self, identifier, *words, zones=(), **more):
        return self.assert_refuses(identifier, "DEFI_CONTACT", keywords(*zones, **more), *words, result="contact_3")

    def slaves(self):
        with h5py.File(self.path("contact_3")) as file:
            group = file["slave"]
            return list(zip(group["cell"][()].tolist(), group["patch"][()].tolist(), group["rank"][()].tolist(),
                            [text(e) for e in group["element"][()]]))

    # ------------------------------------------------------------------------------------------ what it makes

    def test_slave_elements_follow_patch_kind_and_rank(self):
        run = self.define()
        self.assertEqual(run.status, 0, run.stderr)
        self.assertEqual(self.ids(run), [])
        self.assertEqual(self.slaves(), [(0, 0, 0, "LACS22D"), (1, 0, 1, "LACS22DB"), (2, 1, 0, "LACS22D"), (3, 1, 1, "LACS22DB")])

    def test_the_zone_keeps_its_groups_cells_and_options(self):
        self.define(zone(TYPE_JACOBIEN="ACTUALISE", TYPE_APPA="ROBUSTE", CONTACT_INIT="OUI", RESI_APPA=1e-6,
                         COEF_MULT_APPA=2.5), LISSAGE="OUI", RESI_GEOM=1e-3)
        head = self.attributes("contact_3")
        self.assertEqual((head["model"], head["mesh"], head["algorithm"], head["smoothing"], head["resi_geom"], head["verify_normals"]),
                         ("model_2", "mesh_1", "LAC", 1, 1e-3, 1))
        with h5py.File(self.path("contact_3")) as file:
            zones = file["zones"]
            for name, value in {"slave_group": "ESCL", "master_group": "MAIT", "jacobian": "ACTUALISE", "search": "ROBUSTE",
                                "initial_status": "OUI"}.items():
                self.assertEqual([text(v) for v in zones[name][()]], [value])
            self.assertEqual(read_ragged(zones["slave"]), [[0, 1, 2, 3]])
            self.assertEqual(read_ragged(zones["master"]), [[4]])
            self.assertEqual(read_ragged(zones["patches"]), [[0, 1]])
            self.assertEqual(zones["tolerance"][()].tolist(), [1e-6])
            self.assertEqual(zones["distance_limit"][()].tolist(), [2.5])

    def test_defaults_are_those_of_the_peer(self):
        self.define()
        self.assertEqual(self.attributes("contact_3")["resi_geom"], 1e-6)
        with h5py.File(self.path("contact_3")) as file:
            self.assertEqual([text(file[f"zones/{n}"][0]) for n in ("jacobian", "search", "initial_status")], ["INITIAL", "RAPIDE", "INTERPENETRE"])

    def test_three_sub_cells_of_a_quadrangle(self):
        self.make(kind=(12,), zone_offset=(0, 1), sub_cells=((0, 1, 2),), carriers=((1, 2),), groups={**GROUPS, "ESCL": [0, 1, 2]})
        self.define()
        self.assertEqual([e for *_, e in self.slaves()], ["LACS22D", "LACS22DT", "LACS22DB"])

    def test_quadratic_cells_are_whole_patches(self):
        coordinates = [[0, 0], [2, 0], [1, 0], [1, 2], [2, 1], [0.5, 1], [0, -1], [2, -1], [1, -2], [1, -1], [2, -1.5], [0, -1.5]]
        cells = [("SEG3", [0, 1, 2]), ("SEG2", [7, 6]), ("TRIA6", [0, 1, 3, 2, 4, 5]), ("TRIA3", [6, 8, 7])]
        for kind in (9, 14):
            self.make(kind=(kind,), zone_offset=(0, 1), sub_cells=((0,),), carriers=((2,),), cells=cells, of_cell=[0, 0, 1, 1],
                      groups={"ESCL": [0], "MAIT": [1]}, coordinates=coordinates)
            self.write_model("model_2", "mesh_1", ["D_PLAN/SEG3", "D_PLAN/SEG2"], [0, 1, -1, -1])
            run = self.define()
            self.assertEqual(run.status, 0, run.stderr)
            self.assertEqual(self.slaves(), [(0, 0, 0, "LACS32D")])

    def test_skins_without_element_get_that_of_their_bodies(self):
        self.make(of_cell=[-1] * 8 + [1] * 5 + [2])
        run = self.define()
        self.assertEqual((run.status, self.ids(run)), (0, []), run.stderr)
        with h5py.File(self.path("contact_3")) as file:
            self.assertEqual(file["skin/cell"][()].tolist(), [0, 1, 2, 3, 4])
            self.assertEqual({text(e) for e in file["skin/element"][()]}, {"D_PLAN/SEG2"})

    def left_out(self, **keywords):
        run = self.define(zone(**keywords))
        self.assertEqual(run.status, 0, run.stderr)
        with h5py.File(self.path("contact_3")) as file:
            return read_ragged(file["zones/held_open"])[0], self.ids(run)

    def test_skins_without_length_are_refused(self):
        """A slave stopped Newton's method, a master was passed over without a word."""
        at = {number: list(place) for number, place in enumerate(COORDINATES)}
        for node, keyword, words in ((1, "GROUP_MA_ESCL", ("SEG2 M1", "'ESCL'", "N1, N2")), (7, "GROUP_MA_MAIT", ("SEG2 M5", "'MAIT'", "N9, N8"))):
            same = {1: at[0], 7: at[8]}[node]
            self.make(coordinates=[same if number == node else place for number, place in at.items()])
            self.refuses("SKIN_1", f"ZONE/{keyword}", "no length", *words)

    def test_a_master_between_two_body_cells_is_refused(self):
        """The slave would pass the surface of the body and rest on that line."""
        self.make(cells=[*CELLS, ("QUAD4", [7, 8, 12, 11])], of_cell=[*OF_CELL, 2])
        for more in ({}, {"VERI_NORM": "NON"}):
            self.refuses("DECOUPE_3", "GROUP_MA_MAIT", "M5 of the group 'MAIT'", "M14", "M15", **more)
        self.make(cells=[*CELLS, ("QUAD4", [7, 8, 12, 11])], of_cell=[*OF_CELL, -1])  # no part of the model
        self.assertEqual(self.define().status, 0)

    def test_patches_that_meet_what_is_left_out_have_no_contact(self):
        self.make(node_groups={"TIP": [4], "FAR": [9]})
        self.assertEqual(self.left_out(), ([], []))
        self.assertEqual(self.left_out(SANS_GROUP_NO=["TIP"]), ([1], []))
        self.assertEqual(self.left_out(SANS_NOEUD=["N1"]), ([0], []))
        self.assertEqual(self.left_out(SANS_NOEUD=["N3"]), ([0, 1], ["LAC_8"]))
        self.assertEqual(self.left_out(SANS_MAILLE=["M1"]), ([0], []))
        self.assertEqual(self.left_out(SANS_GROUP_MA=["ESCL_2"]), ([0, 1], ["LAC_8"]))
        self.assertEqual(self.left_out(SANS_GROUP_NO=["FAR"]), ([], ["LAC_7"]))
        self.refuses("CHARGE_1", "N77", zones=[zone(SANS_NOEUD=["N77"])])
        self.refuses("GROUPE_2", "M77", zones=[zone(SANS_MAILLE=["M77"])])

    def test_offsets_gliding_and_zones_without_resolution_are_kept(self):
        run = self.define(zone(RESOLUTION="NON", TOLE_INTERP=0.1, GLISSIERE="OUI", DIST_ESCL=0.25, DIST_MAIT=-0.5), STOP_INTERP="OUI")
        self.assertEqual(run.status, 0, run.stderr)
        self.assertEqual(self.attributes("contact_3")["stops_at_overlap"], 1)
        with h5py.File(self.path("contact_3")) as file:
            zones = file["zones"]
            self.assertEqual(read_ragged(zones["held_open"]), [[0, 1]])
            self.assertEqual([text(zones[name][0]) for name in ("resolution", "gliding")], ["NON", "OUI"])
            self.assertEqual([zones[name][0] for name in ("overlap_tolerance", "slave_offset/value", "master_offset/value")], [0.1, 0.25, -0.5])

    def test_zones_take_the_patches_of_their_own_group_in_any_order(self):
        self.make(zones=("ESCL_1", "ESCL_2"), zone_offset=(0, 1, 2))
        run = self.define(zone(GROUP_MA_ESCL="ESCL_2"), zone(GROUP_MA_ESCL="ESCL_1"))
        self.assertEqual(run.status, 0, run.stderr)
        self.assertEqual([(c, p) for c, p, *_ in self.slaves()], [(2, 1), (3, 1), (0, 0), (1, 0)])

    def test_a_master_cell_named_twice_counts_once(self):
        self.define(zone(GROUP_MA_MAIT="TWICE"))
        with h5py.File(self.path("contact_3")) as file:
            self.assertEqual(read_ragged(file["zones/master"]), [[4]])

    # ------------------------------------------------------------------------------------------ what it refuses

    def test_the_algorithm_must_be_newton(self):
        self.refuses("CONTACT4_1", "ALGO_RESO_GEOM", "POINT_FIXE", ALGO_RESO_GEOM="POINT_FIXE")
        self.refuses("CONTACT4_1", "ALGO_RESO_CONT", ALGO_RESO_CONT="POINT_FIXE")

    def test_algo_reso_geom_left_out_is_point_fixe_and_refused(self):
        given = keywords()
        del given["ALGO_RESO_GEOM"]
        run = self.assert_refuses("CONTACT4_1", "DEFI_CONTACT", given, "ALGO_RESO_GEOM", result="contact_3")
        self.assertIn("NEWTON", run.messages[0]["do"])

    def test_friction_is_refused_loudly(self):
        self.refuses("CONTACT4_4", "COULOMB", FROTTEMENT="COULOMB")

    def test_only_continue_and_lac_everywhere(self):
        self.refuses("LAC_1", "DISCRETE", FORMULATION="DISCRETE")
        self.refuses("LAC_2", "STANDARD", zones=[zone(ALGO_CONT="STANDARD")])
        self.refuses("CONTACT3_4", "ZONE[2]", zones=[zone(), zone(ALGO_CONT="STANDARD")])

    def test_adaptation_is_refused(self):
        self.refuses("CONTACT_95", "CYCLAGE", zones=[zone(ADAPTATION="CYCLAGE")])

    def test_a_mesh_that_was_not_cut_is_refused(self):
        self.make(zones=())
        run = self.refuses("CONTACT4_2", "MA")
        self.assertIn("DECOUPE_LAC", run.messages[0]["do"])

    def test_every_cut_group_is_used_once(self):
        self.make(zones=("ESCL_1", "ESCL_2"), zone_offset=(0, 1, 2))
        self.refuses("CONTACT2_17", "1", "2", zones=[zone(GROUP_MA_ESCL="ESCL_1")])
        self.refuses("CONTACT2_17", zones=[zone(GROUP_MA_ESCL="ESCL_1"), zone(GROUP_MA_ESCL="ESCL_1")])

    def test_the_slave_must_be_a_cut_group(self):
        self.refuses("CONTACT2_18", "BODY", zones=[zone(GROUP_MA_ESCL="BODY")])

    def test_slave_and_master_swapped_are_recognised(self):
        run = self.refuses("CONTACT4_5", "MAIT", "swapped", zones=[zone(GROUP_MA_ESCL="MAIT", GROUP_MA_MAIT="ESCL")])
        self.assertIn("swap", run.messages[0]["do"])

    def test_a_slave_group_that_changed_since_the_cut_is_refused(self):
        self.make(groups={**GROUPS, "ESCL": [0, 1, 2]})
        self.refuses("CONTACT4_5", "3 cells", "4 sub-cells")

    def test_corners_of_smoothed_skins_are_named(self):
        """Two faces that meet in a corner: 25 degrees from the mean normal are a curved skin, 45 are none."""
        for turn, corner in ((50, False), (90, True)):
            angle = np.radians(turn)
            bent = [list(point) for point in COORDINATES]
            for node, length in ((3, 1), (4, 2)):  # the second patch goes up from N3, still with its body inside
                bent[node] = [2 + length * np.cos(angle), length * np.sin(angle)]
            bent[6] = [1.5, 4]
            with self.subTest(turn=turn):
                self.make(coordinates=bent)
                run = self.define(LISSAGE="OUI", VERI_NORM="NON")
                self.assertEqual(run.status, 0, run.stderr)
                self.assertEqual("CONTACT2_21" in run.stderr, corner, run.stderr)
                if corner:
                    self.assertIn("2 cell(s)", run.stderr)
                    self.assertIn("N3", run.stderr)
                self.assertNotIn("CONTACT2_21", self.define(LISSAGE="NON", VERI_NORM="NON").stderr)

    def test_smoothing_wants_slave_skins_apart(self):
        self.make(zones=("ESCL_1", "ESCL_2"), zone_offset=(0, 1, 2))
        zones = [zone(GROUP_MA_ESCL="ESCL_1"), zone(GROUP_MA_ESCL="ESCL_2")]
        self.refuses("CONTACT2_16", "ESCL_1", "ESCL_2", "N3", zones=zones, LISSAGE="OUI")
        self.assertEqual(self.define(*zones, LISSAGE="NON").status, 0)

    def test_shells_are_refused(self):
        self.make(of_cell=OF_CELL[:4] + [3] + OF_CELL[5:])
        self.refuses("CONTACT_94", "M5")

    def test_cells_that_cannot_be_in_contact_are_refused(self):
        self.refuses("CONTACT_96", "QUAD4", "M14", zones=[zone(GROUP_MA_MAIT="BODY")])
        self.make(of_cell=[*OF_CELL[:-1], -1])  # the body behind it has no element either
        self.refuses("LAC_4", "M8", zones=[zone(GROUP_MA_MAIT="BARE")])

    def test_slave_and_master_share_no_cell(self):
        self.refuses("LAC_3", "M4", zones=[zone(GROUP_MA_MAIT="BOTH")])

    def test_one_contact_is_not_given_twice(self):
        """The same skins, with each as the slave once: a matrix without inverse. A skin may be slave of one body and master of another."""
        self.make(zones=("ESCL_1", "ESCL_2"), zone_offset=(0, 1, 2))
        both = [zone(GROUP_MA_ESCL="ESCL_1", GROUP_MA_MAIT="ESCL_2"), zone(GROUP_MA_ESCL="ESCL_2", GROUP_MA_MAIT="ESCL_1")]
        self.refuses("LAC_10", "ESCL_1", "ESCL_2", "M1", "M3", zones=both)
        self.assertEqual(self.define(both[0], {**both[1], "RESOLUTION": "NON"}).status, 0)
        self.path("contact_3").unlink()
        self.assertEqual(self.define(both[0], zone(GROUP_MA_ESCL="ESCL_2")).status, 0)

    def test_inward_skins_are_refused_unless_told_otherwise(self):
        run = self.refuses("MODELISA4_24", "INWARD", "M6", zones=[zone(GROUP_MA_MAIT="INWARD")])
        self.assertIn("ORIE_PEAU", run.messages[0]["do"])
        self.assertEqual(self.define(zone(GROUP_MA_MAIT="INWARD"), VERI_NORM="NON").status, 0)

    def test_an_inward_slave_is_refused_by_geometry(self):
        self.make(cells=[("SEG2", [1, 0]), *CELLS[1:]])
        self.refuses("MODELISA4_24", "ESCL", "M1", "1 cells")

    def test_a_skin_without_body_alarms(self):
        run = self.define(zone(GROUP_MA_MAIT="LOOSE"))
        self.assertEqual((run.status, self.ids(run)), (0, ["CONTACT2_20"]))
        self.path("contact_3").unlink()
        self.assertEqual(self.ids(self.define(zone(GROUP_MA_MAIT="LOOSE"), VERI_NORM="NON")), [])

    def test_a_body_that_is_not_in_the_model_alarms(self):
        for bodies, words in ((range(8, 14), ("GROUP_MA_ESCL", "GROUP_MA_MAIT")), ((13,), ("GROUP_MA_MAIT",)), ((), ())):
            self.make(of_cell=[-1 if c in bodies else element for c, element in enumerate(OF_CELL)])
            run = self.define()
            self.assertEqual((run.status, self.ids(run)), (0, ["CONTACT2_22"] * len(words)), bodies)
            for message, word in zip(run.messages, words):
                self.assertIn(word, message["text"])
            self.path("contact_3").unlink()

    def test_groups_must_exist_and_have_cells(self):
        self.refuses("MESH_1", "MAIF", "MAIT", zones=[zone(GROUP_MA_MAIT="MAIF")])
        self.refuses("MESH_2", "EMPTY", zones=[zone(GROUP_MA_MAIT="EMPTY")])

    def test_a_patch_of_an_unknown_kind_is_refused(self):
        self.make(kind=(7, 99))
        self.refuses("LAC_5", "99")


del OperatorTest

if __name__ == "__main__":
    import unittest

    unittest.main()
