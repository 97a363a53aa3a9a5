"""Pressures that answer facets and not the load are told: of linear triangles finer than their master (a sphere pressed on a block in
space), and along rows of patches (a belt over a pulley)."""

import math
import os
import pathlib
import sys

import numpy as np

SOURCE = pathlib.Path(os.environ["LACON_SOURCE_DIR"])
sys.path.insert(0, str(SOURCE / "tests/studies"))

from study_test import StudyTest  # noqa: E402, I001 (it says where meshes.py is)
from contact import contact_study, run_contact  # noqa: E402
from meshes import block, brick, graded, union  # noqa: E402

RADIUS, EXTENT, DEPTH, YOUNG, POISSON = 10.0, 3.0, 0.12, 2000.0, 0.3
FINE = 1.3  #: of the cells that are not graded; the contact's radius is 1.24


def quarter(kind, size, body):
    """The quarter x, y > 0 of the sphere (cut off above) or of the block. @param size of the cells at the contact"""
    around = graded(EXTENT, size, FINE, 1.35)
    through = graded(1.0, size / EXTENT, FINE / 2 / EXTENT, 1.35)
    sides = {(0, 0): "SYMX", (1, 0): "SYMY"}
    if body == "block":
        return brick(kind, [around, around, EXTENT * -through[::-1]], None, "BLOCK", {(2, 1): "BLOCK_SKIN", (2, 0): "BLOCK_BASE", **sides})

    def place(x, y, t):
        low = RADIUS - math.sqrt(RADIUS**2 - x**2 - y**2)
        return x, y, low + t * (EXTENT - low)

    return brick(kind, [around, around, through], place, "SPHERE", {(2, 0): "SPHERE_SKIN", (2, 1): "SPHERE_BASE", **sides},
                 curved=kind.endswith(("10", "20")))


def study(kinds, sizes, slave):
    """@param kinds, sizes of the sphere's and of the block's cells"""
    mesh = union([quarter(kind, size, body) for kind, size, body in zip(kinds, sizes, ("sphere", "block"))])
    fixed = {"DX": 0.0, "DY": 0.0}
    hold = [{"GROUP_MA": "SYMX", "DX": 0.0}, {"GROUP_MA": "SYMY", "DY": 0.0}, {"GROUP_MA": "SPHERE_BASE", "DZ": -DEPTH, **fixed},
            {"GROUP_MA": "BLOCK_BASE", "DZ": 0.0, **fixed}]
    skins = ["SPHERE_SKIN", "BLOCK_SKIN"]
    return contact_study(mesh, hold, slaves=skins[slave == "block":][:1], masters=skins[slave == "sphere":][:1],
                         elastic={"E": YOUNG, "NU": POISSON}, convergence={"RESI_GLOB_RELA": 1e-9, "ITER_GLOB_MAXI": 40})


def distances_from_hertz(result):
    """From the pressures of the force that was found, within three quarters of the radius, root mean squares over the largest of them.
    @return (of the patches, of the means over the patches around vertices inside: CONT_NOEU there)"""
    order = result.orders[-1]
    pressure = result.on_cells("CONT_ELEM", order, "PRES")
    corners = np.array([[result.points[result.cells[cell][1][:3]] for cell in patch] for patch in result.patches])
    sides = corners[:, :, 1:] - corners[:, :, :1]
    areas = np.linalg.norm(np.cross(sides[:, :, 0], sides[:, :, 1]), axis=2) / 2
    area = areas.sum(axis=1)
    middle = np.einsum("pc,pcd->pd", areas, corners.mean(axis=2)) / area[:, None]
    of_patch = np.array([-pressure[patch[0]] for patch in result.patches])
    force = 4 * of_patch @ area
    modulus = YOUNG / (2 * (1 - POISSON**2))
    radius = (3 * force * RADIUS / (4 * modulus)) ** (1 / 3)
    largest = 3 * force / (2 * math.pi * radius**2)

    def distance(points, values):
        square = (points[:, 0] ** 2 + points[:, 1] ** 2) / radius**2
        near = square < 0.75**2
        return math.sqrt(np.mean((values[near] / largest - np.sqrt(1 - square[near])) ** 2))

    around = {}
    for number, patch in enumerate(result.patches):
        for node in {int(node) for cell in patch for node in result.cells[cell][1]}:
            around.setdefault(node, set()).add(number)
    inside = [node for node, patches in around.items() if len(patches) > 1 and min(result.points[node][:2]) > 1e-9]
    at_nodes = result.at_nodes("CONT_NOEU", order, "PRES")
    return distance(middle, of_patch), distance(result.points[inside], -at_nodes[inside])


class Alternation(StudyTest):
    def solved(self, kinds, sizes, slave):
        """@return (the alarms, the result)"""
        run, (result,) = run_contact(self, [study(kinds, sizes, slave)], CONTACT_ALARMS="ALARME")
        return [line for line in (run.stdout + run.stderr).splitlines() if line.startswith("<A> ")], result

    def test_a_slave_of_linear_triangles_finer_than_its_master_is_told(self):
        """Either body: it is the cells, not the curve. Means at vertices are of the first order, h / a / 2; patches are not near."""
        found = []
        for kinds, sizes, slave in ((("TETRA4", "TETRA4"), (0.2, 0.28), "sphere"), (("TETRA4", "TETRA4"), (0.1, 0.14), "sphere"),
                                    (("TETRA4", "TETRA4"), (0.28, 0.2), "block"), (("TETRA4", "HEXA8"), (0.2, 0.28), "sphere")):
            with self.subTest(kinds=kinds, sizes=sizes, slave=slave):
                alarms, result = self.solved(kinds, sizes, slave)
                patches, vertices = distances_from_hertz(result)
                found.append(patches)
                self.assertEqual(len(alarms), 1, alarms)
                self.assertIn(f"<EVOLUTION_47> zone {slave.upper()}_SKIN on ", alarms[0])
                self.assertGreater(patches, 0.7 * min(sizes))
                self.assertLess(vertices, min(sizes) / 1.24 / 2)
        self.assertLess(found[1], 0.6 * found[0])  # of the first order

    def test_pressures_that_follow_the_load_are_not_told(self):
        """Finer masters, the coarser body as the slave, hexahedra, quadratic cells."""
        for kinds, sizes, slave in ((("TETRA4", "TETRA4"), (0.14, 0.1), "sphere"), (("TETRA4", "TETRA4"), (0.2, 0.28), "block"),
                                    (("TETRA4", "HEXA8"), (0.2, 0.14), "sphere"), (("HEXA8", "TETRA4"), (0.2, 0.28), "sphere"),
                                    (("TETRA10", "TETRA10"), (0.28, 0.4), "sphere")):
            with self.subTest(kinds=kinds, sizes=sizes, slave=slave):
                alarms, _ = self.solved(kinds, sizes, slave)
                self.assertEqual(alarms, [])

    def test_scattered_pressures_of_triangles_are_told(self):
        """A paraboloid on a block, 12 graded cells along a side, that has 17 triangles in contact: pressures are off by half of the largest, to either
        side, without going up and down from each to the next. Not of hexahedra, whose pressures are 17 % off and go up and down along rows."""
        def lines(cells, power):
            return np.linspace(0, 1, cells + 1) ** power

        def paraboloid(x, y, t):
            low = (x * x + y * y) / 2 / RADIUS
            return x, y, low + t * (4 - low)

        sides = {(0, 0): "SYMX", (1, 0): "SYMY"}
        hold = [{"GROUP_MA": "SYMX", "DX": 0.0}, {"GROUP_MA": "SYMY", "DY": 0.0}, {"GROUP_MA": "LOWER_BASE", "DZ": 0.0}, {"GROUP_MA": "UPPER_BASE", "DZ": -0.06}]
        for kind in ("TETRA4", "HEXA8"):
            upper = brick(kind, [3 * lines(12, 1.5), 3 * lines(11, 1.5), lines(4, 1.4)], paraboloid, "UPPER", {(2, 0): "UPPER_SKIN", (2, 1): "UPPER_BASE", **sides})
            lower = brick(kind, [4 * lines(14, 1.5), 4 * lines(13, 1.5), -4 * lines(5, 1.5)[::-1]], None, "LOWER", {(2, 1): "LOWER_SKIN", (2, 0): "LOWER_BASE", **sides})
            one = contact_study(union([upper, lower]), hold, slaves=["UPPER_SKIN"], masters=["LOWER_SKIN"], convergence={"RESI_GLOB_RELA": 1e-9, "ITER_GLOB_MAXI": 40})
            run, _ = run_contact(self, [one], CONTACT_ALARMS="ALARME")
            told = "<A> <EVOLUTION_80> zone UPPER_SKIN on LOWER_SKIN" in run.stdout + run.stderr
            self.assertEqual(told, kind == "TETRA4")

    def test_edges_of_a_punch_are_not_told(self):
        """Pressures that have no bound at the edges, on a mesh of matching size."""
        lines = [np.linspace(0, 1, 9)] * 2 + [np.linspace(0, 1, 5)]
        under = [np.linspace(-1, 2, 31)] * 2 + [np.linspace(-1, 0, 5)]
        punch = brick("TETRA4", lines, None, "PUNCH", {(2, 0): "PUNCH_SKIN", (2, 1): "PUNCH_BASE"})
        block = brick("TETRA4", under, None, "BLOCK", {(2, 1): "BLOCK_SKIN", (2, 0): "BLOCK_BASE"})
        hold = [{"GROUP_MA": "PUNCH_BASE", "DX": 0.0, "DY": 0.0, "DZ": -0.01}, {"GROUP_MA": "BLOCK_BASE", "DX": 0.0, "DY": 0.0, "DZ": 0.0}]
        one = contact_study(union([punch, block]), hold, slaves=["PUNCH_SKIN"], masters=["BLOCK_SKIN"], convergence={"RESI_GLOB_RELA": 1e-9, "ITER_GLOB_MAXI": 40})
        run, _ = run_contact(self, [one], CONTACT_ALARMS="ALARME")
        for told in ("<EVOLUTION_47>", "<EVOLUTION_80>"):
            self.assertNotIn(told, run.stdout + run.stderr)


def belt(kind, cells):
    """A quarter of a belt of radius 10, pulled at its end, over a pulley: a uniform pressure. @param cells around (of the belt, of the pulley)"""
    in_space = kind.startswith("HEXA")

    def place(r, a, *z):
        return (r * math.cos(a), r * math.sin(a), *z)

    def part(name, radii, n, skin, other):
        grid = [radii, np.linspace(0, math.pi / 2, n + 1)]
        if not in_space:
            return block(kind, *grid, place, name, {skin: f"{name}_SKIN", other: f"{name}_BASE", "bottom": f"{name}_END", "top": "SYM"})
        ends = {(0, ("left", "right").index(skin)): f"{name}_SKIN", (0, ("left", "right").index(other)): f"{name}_BASE"}
        return brick(kind, [*grid, np.linspace(0, 2, 3)], place, name, {**ends, (1, 0): f"{name}_END", (1, 1): "SYM", (2, 0): "EDGE", (2, 1): "EDGE"},
                     curved=kind == "HEXA20")

    mesh = union([part("BELT", np.linspace(10, 10.2, 2), cells[0], "left", "right"), part("PULLEY", np.linspace(5, 10, 6), cells[1], "right", "left")])
    hold = [{"GROUP_MA": "SYM", "DX": 0.0}, {"GROUP_MA": "PULLEY_BASE", "DX": 0.0, "DY": 0.0}, *([{"GROUP_MA": "EDGE", "DZ": 0.0}] if in_space else [])]
    return contact_study(mesh, hold, [{"GROUP_MA": "BELT_END", "PRES": -100.0}], slaves=["BELT_SKIN"], masters=["PULLEY_SKIN"],
                         model="3D" if in_space else "D_PLAN", elastic={"E": 210e3, "NU": 0.3}, convergence={"RESI_GLOB_RELA": 1e-9, "ITER_GLOB_MAXI": 40})


def plate(kind, cells, ratio, slave):
    """A plate that a pressure of 10 lays on a base. @param cells along (the plate, the base) @param ratio of their stiffnesses"""
    in_space = kind.startswith("HEXA")

    def part(name, half, levels, n, skin, other):
        along = np.linspace(-half, half, n + 1)
        if not in_space:
            return block(kind, along, levels, None, name, {skin: f"{name}_SKIN", other: f"{name}_OTHER"})
        sides = {(2, ("bottom", "top").index(skin)): f"{name}_SKIN", (2, ("bottom", "top").index(other)): f"{name}_OTHER"}
        return brick(kind, [along, along, levels], None, name, sides)

    mesh = union([part("PLATE", 0.8, np.array([1.0, 1.1]), cells[0], "bottom", "top"), part("BASE", 1.0, np.linspace(0, 1, 4), cells[1], "top", "bottom")])
    across = {"DX": 0.0, "DY": 0.0} if in_space else {"DX": 0.0}
    hold = [{"GROUP_MA": "BASE_OTHER", **across, ("DZ" if in_space else "DY"): 0.0}, {"GROUP_MA": "PLATE_OTHER", **across}]
    return contact_study(mesh, hold, [{"GROUP_MA": "PLATE_OTHER", "PRES": 10.0}], slaves=[f"{slave}_SKIN"], masters=["BASE_SKIN" if slave == "PLATE" else "PLATE_SKIN"],
                         model="3D" if in_space else "D_PLAN", convergence={"RESI_GLOB_RELA": 1e-9, "ITER_GLOB_MAXI": 40},
                         elastic={"E": 1e3, "NU": 0.3}, other={"E": ratio * 1e3}, others=["PLATE"])


class Rows(StudyTest):
    def told(self, study):
        """@return (whether EVOLUTION_67 was, the largest pressure over that of the pull)"""
        run, (result,) = run_contact(self, [study], CONTACT_ALARMS="ALARME")
        pressure = result.on_cells("CONT_ELEM", result.orders[-1], "PRES")
        return "<EVOLUTION_67>" in run.stdout + run.stderr, -min(pressure.values()) / (100 * 0.2 / 10)

    def test_a_stiff_slave_on_a_soft_coarser_master_is_told(self):
        """Skins are straight. Where the master's cells are half as long pressures rise to the edge and nothing else; of a slave that is less
        than twice as stiff nothing is said, though its pressures alternate by a seventh, and a soft slave follows."""
        for kind, cells, ratio, slave, expected in (("QUAD4", (24, 15), 1000, "PLATE", True), ("QUAD4", (12, 30), 1000, "PLATE", False),
                                                    ("HEXA8", (16, 10), 1000, "PLATE", True), ("HEXA8", (8, 20), 1000, "PLATE", False),
                                                    ("HEXA8", (16, 8), 4, "PLATE", True), ("HEXA8", (24, 8), 1.5, "PLATE", False),
                                                    ("HEXA8", (8, 10), 1000, "BASE", False)):
            with self.subTest(kind=kind, cells=cells, ratio=ratio, slave=slave):
                run, _ = run_contact(self, [plate(kind, cells, ratio, slave)], CONTACT_ALARMS="ALARME")
                said = run.stdout + run.stderr
                self.assertEqual("<EVOLUTION_70> zone PLATE_SKIN on BASE_SKIN" in said, expected)
                self.assertEqual("<EVOLUTION_70>" in said, expected)
                self.assertEqual(said.count("<EVOLUTION_67>") + said.count("<EVOLUTION_47>"), 0)

    def test_pressures_that_follow_facets_are_told(self):
        """By half of the pressure and more; where cells lie on the curve, or are as many on both skins, nothing is."""
        for kind, cells, expected in (("QUAD4", (30, 20), True), ("QUAD4", (30, 45), True), ("HEXA8", (30, 20), True),
                                      ("QUAD4", (30, 30), False), ("QUAD8", (30, 20), False), ("HEXA20", (18, 12), False)):
            with self.subTest(kind=kind, cells=cells):
                told, largest = self.told(belt(kind, cells))
                self.assertEqual(told, expected)
                (self.assertGreater if expected else self.assertLess)(largest, 1.5)
