"""Contact studies of generated meshes: invariance, balance, several masters and zones, cones, the benchmark's flat tetrahedra."""

import os
import pathlib
import sys
import unittest

import numpy as np

STUDIES = pathlib.Path(os.environ["LACON_SOURCE_DIR"]) / "tests/studies"
sys.path[:0] = [str(STUDIES), str(STUDIES / "metamorphic")]

from study_test import StudyTest  # noqa: E402, I001 (it says where meshes.py is)
from contact import contact_study, run_contact  # noqa: E402
from meshes import block, brick, shaken, union  # noqa: E402
from patch import KINDS, straight, uneven  # noqa: E402
from written import first_vertices, renumbered  # noqa: E402

BENCH = pathlib.Path(os.environ["LACON_SHARED_BENCH"]) / "meshes/t2.med"
PRESSURE, YOUNG, POISSON = 25.0, 2000.0, 0.3
SHRINK = (1 - 2 * POISSON) * PRESSURE / YOUNG  #: of all lengths under a hydrostatic pressure


def bowl(slave, master):
    """A block with a bulging underside on a wavy one that is wider on two sides only: patches in contact, open, covered in part and
    without master. @return upper, lower"""

    def above(x, y, z):
        return x, y, z + (1 - z) * (0.15 * ((x - 0.4) ** 2 + (y - 0.5) ** 2) + 0.01 * np.sin(3 * x + y))

    def below(x, y, z):
        return x, y, z + (1 + z) * 0.02 * np.sin(4 * x) * np.cos(3 * y)

    upper = brick(slave, [uneven(4, 0.13), uneven(3, -0.1), uneven(2, 0.1)], above, "UPPER", {(2, 0): "SLAVE", (2, 1): "TOP"}, curved=True)
    lower = brick(master, [1.1 * uneven(3, -0.17) - 0.4, 1.4 * uneven(4, 0.12) - 0.2, uneven(2, -0.2) - 1], below, "LOWER",
                  {(2, 1): "MASTER", (2, 0): "BASE"}, curved=True)
    return upper, lower


def pressed(mesh, **more):
    return contact_study(mesh, [{"GROUP_MA": "BASE", "DX": 0, "DY": 0, "DZ": 0}, {"GROUP_MA": "TOP", "DX": 0.01, "DY": 0, "DZ": -0.06}],
                         times=[0.0, 0.5, 1.0], zone={"CONTACT_INIT": "INTERPENETRE"}, **more)


def canonical(result):
    """Every field of every instant, its places in an order that numbers have no part in. @return name -> values"""
    found = {}

    def in_place(points):
        return np.lexsort(np.round(points, 8).T)

    body_of = np.zeros(len(result.points), int)
    for number, body in enumerate(("UPPER", "LOWER")):
        for c in result.groups[body]:
            body_of[result.cells[c][1]] = number
    for order in result.orders:
        for name in ("DEPL", "SIEF_NOEU", "CONT_ELEM"):
            if name == "SIEF_NOEU" and order == 0:
                continue
            support, values = result.field(name, order)
            if name == "CONT_ELEM":
                where = np.array([result.points[result.cells[c][1]].mean(axis=0) for c in support])
            else:
                where = np.column_stack([result.points[support], body_of[support]])
            for component, column in values.items():
                found[f"{name} {component} {order}"] = column[in_place(where)]
    return found


class FlatTetrahedra(StudyTest):
    def assert_flat(self, studies):
        _, results = run_contact(self, studies)
        for result in results:
            self.assertLessEqual(result.parameter("newton_iterations")[-1], 4)
            self.assertLessEqual(np.abs(result.where_present("DEPL", 1, "LAGS_C") + PRESSURE).max(), 1e-10 * PRESSURE)
            self.assertLessEqual(np.abs(result.where_present("SIEF_NOEU", 1, "SIZZ") + PRESSURE).max(), 1e-10 * PRESSURE)


class Contact(FlatTetrahedra):
    def test_no_result_depends_on_numbers(self):
        """Every field to 1e-11 of its largest value: nodes, cells and types renumbered, bodies in the other order."""
        pairs = [("HEXA8", "TETRA4", "HEXA"), ("HEXA20", "HEXA8", "PYRA"), ("TETRA10", "HEXA27", "PYRA"), ("PENTA6", "HEXA20", "PYRA")]
        studies = []
        for slave, master, cut in pairs:
            upper, lower = bowl(slave, master)
            mesh = union([upper, lower])
            studies += [pressed(m, cut=cut) for m in (mesh, renumbered(first_vertices(mesh), 3), union([lower, upper]))]
        _, results = run_contact(self, studies)
        for k, pair in enumerate(pairs):
            one, *others = [canonical(result) for result in results[3 * k:3 * k + 3]]
            last = one["CONT_ELEM CONT 2"]
            self.assertEqual(set(last), {-1.0, 0.0, 1.0}, "a study with every status")
            for other, how in zip(others, ("renumbered", "other order of bodies")):
                self.assertEqual(set(one), set(other))
                for name, values in one.items():
                    field, component, order = name.split()
                    scale = max(np.abs(v).max() for n, v in one.items() if n.startswith(field) and n.endswith(order)
                                and (field != "CONT_ELEM" or n.split()[1] == component) and (field != "DEPL" or (n.split()[1] == "LAGS_C") == (component == "LAGS_C")))
                    with self.subTest(pair=pair, how=how, values=name):
                        self.assertLessEqual(np.abs(values - other[name]).max(), 1e-11 * max(scale, 1e-300))

    def test_forces_and_moments_balance_and_pivots_are_those_expected(self):
        """On curved, warped skins that do not match, with and without LISSAGE: to 1e-12 of the force (times the length 1)."""
        pairs = [("HEXA8", "HEXA8", "HEXA"), ("HEXA20", "TETRA10", "PYRA"), ("TETRA4", "HEXA20", "PYRA"), ("HEXA27", "HEXA27", "PYRA")]
        cases = [(pair, smooth) for pair in pairs for smooth in ("NON", "OUI")]
        _, results = run_contact(self, [pressed(union(bowl(*pair[:2])), cut=pair[2], smooth=smooth) for pair, smooth in cases])
        for (pair, smooth), result in zip(cases, results):
            with self.subTest(pair=pair, smooth=smooth):
                slave, master, moment = (np.array([result.parameter(f"zone_1_{what}_{axis}") for axis in "xyz"])
                                         for what in ("slave_force", "master_force", "moment"))
                force = np.linalg.norm(slave, axis=0)[1:]
                self.assertGreater(force.min(), 1.0)
                self.assertLessEqual((np.linalg.norm(slave + master, axis=0)[1:] / force).max(), 1e-12)
                self.assertLessEqual((np.linalg.norm(moment, axis=0)[1:] / force).max(), 1e-12)
                pivots, expected = result.parameter("negative_pivots")[1:], result.parameter("expected_negative_pivots")[1:]
                np.testing.assert_array_equal(pivots, expected)
                np.testing.assert_array_equal(expected[expected >= 0], result.parameter("zone_1_active")[1:][expected >= 0])
                self.assertEqual((result.parameter("negative_pivots")[0], result.parameter("expected_negative_pivots")[0]), (-1, -1))

    def test_one_slave_cell_over_two_separate_masters(self):
        """Both are found: COEFSURF is the covered fraction 0.75, and both bodies are pressed down by what they carry."""
        cases = [("HEXA8", "PYRA"), ("HEXA8", "HEXA"), ("HEXA20", "HEXA"), ("HEXA27", "PYRA")]
        studies = []
        for kind, cut in cases:
            one = np.array([0.0, 1.0])
            upper = brick(kind, [one, one, one], None, "UPPER", {(2, 0): "SLAVE", (2, 1): "TOP"})
            lower = [brick("HEXA8", [np.array(ends), np.array([-0.1, 0.5, 1.2]), one - 1], None, name, {(2, 1): "MASTER", (2, 0): "BASE"})
                     for name, ends in (("LEFT", (-0.1, 0.35)), ("RIGHT", (0.6, 1.3)))]
            studies.append(contact_study(union([upper, *lower]), [{"GROUP_MA": "BASE", "DX": 0, "DY": 0, "DZ": 0},
                                                                  {"GROUP_MA": "TOP", "DX": 0, "DY": 0, "DZ": -0.01}]))
        _, results = run_contact(self, studies)
        for (kind, cut), result in zip(cases, results):
            with self.subTest(cell=kind, cut=cut):
                np.testing.assert_allclose(result.where_present("CONT_ELEM", 0, "COEFSURF"), 0.75, rtol=0, atol=1e-12)
                self.assertEqual(result.parameter("zone_1_active")[-1], 1)
                down = result.at_nodes("DEPL", 1, "DZ")
                for name in ("LEFT", "RIGHT"):
                    nodes = np.unique(np.concatenate([result.cells[c][1] for c in result.groups[name]]))
                    self.assertLess(down[nodes].min(), -5e-4, name)

    def test_two_zones_on_two_faces_of_one_block(self):
        """A block in a corner, its edge cells slaves of both zones, under the same pressure all around: sigma = -p I, LAGS_C = -p."""
        cases = [("HEXA8", "PYRA"), ("HEXA8", "HEXA"), ("TETRA4", "PYRA"), ("HEXA20", "PYRA"), ("HEXA27", "PYRA")]
        studies = []
        for kind, cut in cases:
            lines = [uneven(3, 0.13), uneven(2, -0.1), uneven(2, 0.2)]
            other = [uneven(2, -0.2), uneven(3, 0.15), uneven(3, -0.1)]
            corner = brick(kind, lines, shaken(lines, 0.1, 1), "CORNER", {(2, 0): "BOTTOM", (0, 0): "SIDE", (1, 0): "FRONT", (2, 1): "FREE", (0, 1): "FREE", (1, 1): "FREE"})
            floor_lines, wall_lines = [other[0], other[1], other[2] - 1], [other[2] - 1, other[1], other[0]]
            floor = brick("HEXA8", floor_lines, shaken(floor_lines, 0.1, 2), "FLOOR", {(2, 1): "GROUND", (2, 0): "DOWN", (0, 0): "XZERO", (1, 0): "FRONT", (0, 1): "FREE", (1, 1): "FREE"})
            wall = brick("TETRA10", wall_lines, shaken(wall_lines, 0.1, 3), "WALL", {(0, 1): "PLANE", (0, 0): "LEFT", (2, 0): "ZZERO", (1, 0): "FRONT", (2, 1): "FREE", (1, 1): "FREE"})
            hold = [{"GROUP_MA": "FRONT", "DY": 0}, {"GROUP_MA": "XZERO", "DX": 0}, {"GROUP_MA": "ZZERO", "DZ": 0},
                    {"GROUP_MA": "DOWN", "DZ": SHRINK}, {"GROUP_MA": "LEFT", "DX": SHRINK}]
            studies.append(contact_study(union([corner, floor, wall]), hold, [{"GROUP_MA": "FREE", "PRES": PRESSURE}], ("BOTTOM", "SIDE"),
                                         ("GROUND", "PLANE"), cut=cut))
        _, results = run_contact(self, studies)
        for (kind, cut), result in zip(cases, results):
            with self.subTest(cell=kind, cut=cut):
                tolerance = 1e-8 if cut == "HEXA" else 1e-10
                self.assertLessEqual(np.abs(result.where_present("DEPL", 1, "LAGS_C") + PRESSURE).max(), tolerance * PRESSURE)
                self.assertLessEqual(np.abs(result.where_present("CONT_ELEM", 1, "COEFSURF") - 1).max(), 1e-10)
                for component in ("SIXX", "SIYY", "SIZZ"):
                    self.assertLessEqual(np.abs(result.where_present("SIEF_NOEU", 1, component) + PRESSURE).max(), tolerance * PRESSURE)
                for zone in (1, 2):
                    self.assertEqual((result.parameter(f"zone_{zone}_open")[-1], result.parameter(f"zone_{zone}_unpaired")[-1]), (0, 0))

    def test_a_cone_under_hydrostatic_pressure_is_exact(self):
        """In axisymmetry, solid and hollow: sigma = -p I, LAGS_C = -p, and -p A0 / A with ACTUALISE (A / A0 = (1 - (1 - 2 nu) p / E)^2)."""
        cases = [(slave, master, inner, jacobian) for slave, master in zip(KINDS, KINDS[2:] + KINDS[:2]) for inner in (0.0, 0.4)
                 for jacobian in (("INITIAL", "ACTUALISE") if inner else ("INITIAL",))]
        _, results = run_contact(self, [self.cone(*case) for case in cases])
        for (slave, master, inner, jacobian), result in zip(cases, results):
            with self.subTest(slave=slave, master=master, inner=inner, jacobian=jacobian):
                pressure = PRESSURE / (1 - SHRINK) ** 2 if jacobian == "ACTUALISE" else PRESSURE
                self.assertLessEqual(np.abs(result.where_present("DEPL", 1, "LAGS_C") + pressure).max(), 1e-10 * PRESSURE)
                for component in ("SIXX", "SIYY", "SIZZ"):
                    self.assertLessEqual(np.abs(result.where_present("SIEF_NOEU", 1, component) + PRESSURE).max(), 1e-10 * PRESSURE)
                for axis, component in enumerate(("DX", "DY")):
                    self.assertLessEqual(np.abs(result.at_nodes("DEPL", 1, component) + SHRINK * result.points[:, axis]).max(), 1e-10)
                np.testing.assert_allclose(result.where_present("CONT_ELEM", 1, "COEFSURF"), 1, rtol=0, atol=1e-12)
                balance = [result.parameter(f"zone_1_slave_force_{axis}")[-1] + result.parameter(f"zone_1_master_force_{axis}")[-1] for axis in "xy"]
                self.assertLessEqual(np.abs(balance).max(), 1e-12 * PRESSURE)

    def cone(self, slave, master, inner, jacobian):
        """Two bodies of revolution that meet in the cone z = 0.6 r."""

        def place(low, high):
            def at(s, t):
                r = inner + (1 - inner) * s
                return r, low(r) + (high(r) - low(r)) * (t + 0.2 * s * (1 - s) * t * (1 - t))
            return at

        def body(kind, columns, rows, low, high, name, sides):
            return block(kind, columns, rows, straight(kind, place(low, high), columns, rows), name, sides)

        left = "FREE" if inner else "AXIS"
        upper = body(slave, uneven(5, 0.13), uneven(3, 0.2), lambda r: 0.6 * r, lambda r: 1.2, "UPPER", {"bottom": "SLAVE", "top": "FREE", "right": "FREE", "left": left})
        lower = body(master, uneven(4, -0.17), uneven(3, -0.2), lambda r: -1.0, lambda r: 0.6 * r, "LOWER", {"top": "MASTER", "bottom": "FREE", "right": "FREE", "left": left})
        lower.node_groups["FOOT"] = lower.nodes_where(lambda r, z: r == 1 and z == -1)
        hold = [{"GROUP_NO": "FOOT", "DY": SHRINK}] + ([] if inner else [{"GROUP_MA": "AXIS", "DX": 0}])
        return contact_study(union([upper, lower]), hold, [{"GROUP_MA": "FREE", "PRES": PRESSURE}], model="AXIS",
                             zone={"TYPE_JACOBIEN": jacobian, "CONTACT_INIT": "OUI"})

    def test_flat_tetrahedra_of_several_sizes_converge_at_once(self):
        """The peer's pairing loses couples here and its Newton method never ends (the benchmark's T2): at most 4 iterations, -p to 1e-10."""
        sizes = [(3, 4), (5, 7), (8, 6)]
        studies = []
        for slave, master in sizes:
            lines = [np.linspace(0, 1, slave + 1)] * 2 + [np.linspace(0, 1, slave // 2 + 1)]
            under = [np.linspace(0, 1, master + 1)] * 2 + [np.linspace(-1, 0, master // 2 + 1)]
            sides = {(0, 0): "XZERO", (1, 0): "YZERO"}
            studies.append(flat(union([brick("TETRA4", lines, shaken(lines, 0.2, slave), "UPPER", {**sides, (2, 0): "CTOP", (2, 1): "TOP"}),
                                       brick("TETRA4", under, shaken(under, 0.2, master), "LOWER", {**sides, (2, 1): "CBOT", (2, 0): "BASE"})]),
                                "CTOP", "CBOT", ["XZERO"], ["YZERO"]))
        self.assert_flat(studies)

    def test_pulls_of_edges_in_space_from_iteration_to_iteration_do_not_compare(self):
        """A skin bent to 1 in 500 on tetrahedra, whose edge recedes over other patches each time: what opens behind it goes by its own pull (by
        the secant of two, as in the plane, this took 31 iterations for 6)."""
        self.assertLessEqual(self.iterations_on_a_bent_skin("TETRA4", 0.0022), 8)

    def test_lines_between_masters_are_the_same_where_one_of_them_goes_on_behind_a_plane_of_symmetry(self):
        """Of two curved triangles that share an edge one alone had that edge prolonged, and cut at other places: forces jumped where both lines
        crossed a slave's, and 34 iterations went to and fro between iterates 1e-9 apart."""
        for depth in (0.00109, 0.001095, 0.0011):
            with self.subTest(depth=depth):
                self.assertLessEqual(self.iterations_on_a_bent_skin("TETRA10", depth), 6)

    def iterations_on_a_bent_skin(self, kind, depth):
        """Two blocks of 6 and 5 cells a side, the upper one's underside bent, pressed in one step."""
        def bent(x, y, z):
            return x, y, z + (1.0 - z) / 0.5 * 0.002 * (x * x + y * y)

        def lines(n, m, bottom):
            return [np.linspace(0, 1, n + 1)] * 2 + [np.linspace(bottom, bottom + 0.5, m + 1)]

        sides = {(0, 0): "XZERO", (1, 0): "YZERO"}
        lower = brick(kind, lines(6, 4, 0.0), name="LOWER", sides={**sides, (2, 0): "BASE", (2, 1): "MASTER"})
        upper = brick(kind, lines(5, 3, 0.5), bent, "UPPER", {**sides, (2, 0): "SLAVE", (2, 1): "TOP"})
        hold = [{"GROUP_MA": "XZERO", "DX": 0}, {"GROUP_MA": "YZERO", "DY": 0}, {"GROUP_MA": "BASE", "DZ": 0}, {"GROUP_MA": "TOP", "DZ": -depth}]
        _, (result,) = run_contact(self, [contact_study(union([lower, upper]), hold, convergence={"RESI_GLOB_RELA": 1e-6, "ITER_GLOB_MAXI": 50})])
        return result.parameter("newton_iterations")[-1]


def flat(mesh, slave, master, x, y, **more):
    return contact_study(mesh, [{"GROUP_MA": x, "DX": 0}, {"GROUP_MA": y, "DY": 0}, {"GROUP_MA": "BASE", "DZ": 0}],
                         [{"GROUP_MA": "TOP", "PRES": PRESSURE}], [slave], [master], **more)


@unittest.skipUnless(BENCH.is_file(), f"the benchmark's mesh {BENCH} is not there (set LACON_SHARED_BENCH)")
class Benchmark(FlatTetrahedra):
    """The flat study T2 of the benchmark, 38 341 TETRA4."""

    def test_t2_converges_with_either_block_as_slave(self):
        self.assert_flat([flat(BENCH, *blocks, ["XB", "XT"], ["YB", "YT"], orient=["CTOP", "CBOT", "TOP", "BASE"]) for blocks in (("CTOP", "CBOT"), ("CBOT", "CTOP"))])


if __name__ == "__main__":
    unittest.main()
