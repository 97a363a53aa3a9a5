"""The patch test in space: its meshes, supports and runs; test_patch_space.py judges them, book.py writes docs/verification.md from them.

Two blocks with meshes that do not match, stacked along a direction n that is no axis, under the pressure p on both ends and free
sideways: sigma = -p n n everywhere. Each block is held as a statically determinate body, so that no support carries anything.
"""

import itertools
import types

import numpy as np
from contact import contact_study, run_contact
from meshes import brick, shaken, union

PRESSURE, YOUNG, POISSON = 25.0, 200000.0, 0.3
#: the body of the slave -> (cell, row of meshes.CUBE, axis of the grid along n, DECOUPE_HEXA)
SLAVES = {
    "TETRA4": ("TETRA4", None, 2, "PYRA"),
    "TETRA10": ("TETRA10", None, 2, "PYRA"),
    "PENTA6 triangle": ("PENTA6", None, 2, "PYRA"),
    "PENTA6 quadrangle": ("PENTA6", None, 0, "PYRA"),
    "PENTA15 triangle": ("PENTA15", None, 2, "PYRA"),
    "PENTA15 quadrangle": ("PENTA15", None, 0, "PYRA"),
    "PYRAM5 triangle": ("PYRAM5", "PYRAM/VERTEX", 2, "PYRA"),
    "PYRAM5 base": ("PYRAM5", None, 2, "PYRA"),
    "PYRAM13 triangle": ("PYRAM13", "PYRAM/VERTEX", 2, "PYRA"),
    "PYRAM13 base": ("PYRAM13", None, 2, "PYRA"),
    "HEXA8 in PYRA": ("HEXA8", None, 2, "PYRA"),
    "HEXA8 in HEXA": ("HEXA8", None, 2, "HEXA"),
    "HEXA20 in PYRA": ("HEXA20", None, 2, "PYRA"),
    "HEXA20 in HEXA": ("HEXA20", None, 2, "HEXA"),
    "HEXA27": ("HEXA27", None, 2, "PYRA"),
}
#: facet of the master -> its body
MASTERS = {"TRIA3": "TETRA4", "TRIA6": "TETRA10", "QUAD4": "HEXA8", "QUAD8": "HEXA20", "QUAD9": "HEXA27"}
#: bodies of cells that stay affine (triangles, tetrahedra, parallelepipeds) whatever is done to them
ALWAYS_AFFINE = ("TETRA", "PENTA6 triangle", "PYRAM5 triangle")
NORMAL = np.array([0.48, -0.6, 0.64])
#: how far inner nodes are moved at random, of a grid step, in the contact plane (quadrangles of scaled Jacobian down to 0.3) and elsewhere
SHAKE = (0.45, 0.1)


def turned(normal):
    """A rotation whose third column is the normal."""
    normal = np.asarray(normal, float) / np.linalg.norm(normal)
    first = np.cross([0.3, 0.7, 0.2], normal)
    first /= np.linalg.norm(first)
    return np.column_stack([first, np.cross(normal, first), normal])


def uneven(n, shift):
    lines = np.linspace(0, 1, n + 1)
    return lines + shift * lines * (1 - lines)


def slide(mesh, most, seed):
    """Moves mid nodes of skin cells along their straight edges by up to `most` of the edge, middles of QUAD9 by half as much in the facet."""
    random, moved = np.random.default_rng(seed), {}
    for kind in ("TRIA6", "QUAD8", "QUAD9"):
        for nodes in mesh.cells.get(kind, []):
            n = 3 if kind == "TRIA6" else 4
            edges = np.roll(mesh.points[nodes[:n]], -1, axis=0) - mesh.points[nodes[:n]]
            for k, node in enumerate(nodes[n:]):
                by = most * random.uniform(-1, 1) * edges[k] if k < n else most * random.uniform(-0.5, 0.5, 2) @ edges[:2]
                moved.setdefault(node, mesh.points[node] + by)
    for node, point in moved.items():
        mesh.points[node] = point


def stack(slave, master, shaking=False, normal=NORMAL, scale=1.0, seed=2, sliding=0.0):
    """The two unit blocks, slave above. @param shaking moves inner nodes by SHAKE @param sliding see slide() @return (mesh, supports:
    group of one node -> component -> displacement)"""

    def body(kind, cut, axis, lines, seed, name, sides):
        order = [(axis + 1) % 3, (axis + 2) % 3, axis]
        grid = [None] * 3
        for where, line in zip(order, lines):
            grid[where] = line
        place = shaken(grid, lambda at: SHAKE[0 if at[axis] == 0 else 1], seed) if shaking else None
        mesh = brick(kind, grid, place, name, {(axis, end): group for end, group in sides.items()}, cut=cut)
        mesh.points = mesh.points[:, order]
        slide(mesh, sliding, seed)
        return mesh

    kind, cut, axis, _ = SLAVES[slave]
    upper = body(kind, cut, axis, (uneven(2, 0.13), uneven(3, -0.1), uneven(2, 0.2)), seed, "UPPER", {0: "SLAVE", 1: "LOAD"})
    lower = body(MASTERS[master], None, 2, (uneven(3, -0.17), uneven(2, 0.12), uneven(2, -0.2) - 1), seed + 1, "LOWER", {1: "MASTER", 0: "BASE"})
    supports = {}
    for mesh, name, height, free in ((upper, "UP", 1.0, [0, 1, 5]), (lower, "LOW", -1.0, range(6))):
        corners = [int(np.argmin(np.linalg.norm(mesh.points - at, axis=1))) for at in ((0, 0, height), (1, 0, height), (0, 1, height))]
        mesh.points = scale * mesh.points @ turned(normal).T
        supports.update(held(mesh, name, corners, free, normal))
    return union([upper, lower]), supports


def gradient(normal):
    """Of the displacements: u = gradient x, of sigma = -p n n."""
    normal = np.asarray(normal, float) / np.linalg.norm(normal)
    return -PRESSURE / YOUNG * ((1 + POISSON) * np.outer(normal, normal) - POISSON * np.eye(3))


def held(mesh, name, nodes, free, normal):
    """Adds a group for each node and chooses as many components of displacements as the body has rigid motions to lose.
    @param free which of: translations along the two tangents and the normal, rotations about them"""
    axes = turned(normal)
    points = mesh.points[nodes]
    size = np.ptp(mesh.points)
    motions = [np.tile(axes[:, k], (len(nodes), 1)) for k in range(3)] + [np.cross(axes[:, k], points - points[0]) / size for k in range(3)]
    rows = np.array([motions[k].ravel() for k in free]).T  # (node, component) x motion
    supports = {}
    for _ in free:  # the row that is furthest from those taken
        row = int(np.argmax(np.linalg.norm(rows, axis=1)))
        along = rows[row] / np.linalg.norm(rows[row])
        rows = rows - np.outer(rows @ along, along)
        node, component = divmod(row, 3)
        mesh.node_groups[f"{name}{node}"] = [nodes[node]]
        supports.setdefault(f"{name}{node}", {})["DX DY DZ".split()[component]] = float((gradient(normal) @ points[node])[component])
    return supports


def study(slave, master, shaking=False, scale=1.0, jacobian="INITIAL", normal=NORMAL, sliding=0.0):
    """What `run` and `figures` need of one patch test."""
    return types.SimpleNamespace(slave=slave, master=master, shaking=shaking, scale=scale, jacobian=jacobian, normal=np.asarray(normal, float),
                                 sliding=sliding)


def matrix(**parameters):
    return [study(*pair, **parameters) for pair in itertools.product(SLAVES, MASTERS)]


def tolerance(one):
    """Of pressures and stresses, relative: 1e-10 where facets are affine, 1e-8 where they are not."""
    quadrangles = "QUAD" in one.master or not one.slave.startswith(ALWAYS_AFFINE)
    return 1e-8 if one.slave.endswith("in HEXA") or one.sliding or one.shaking and quadrangles else 1e-10


def run(test, studies):
    """One run of the launcher for all of them. @param test a StudyTest @return for each study its figures: errors of .pressure (LAGS_C and
    PRES), .stress (nodal, along n), all stresses (.stresses), relative to p; .gap, .displacement relative to size and largest
    displacement, .cover, and the number of .iterations"""
    orders = []
    for one in studies:
        mesh, supports = stack(one.slave, one.master, one.shaking, one.normal, one.scale, sliding=one.sliding)
        orders.append(contact_study(mesh, [{"GROUP_NO": node, **values} for node, values in supports.items()],
                                    [{"GROUP_MA": ["LOAD", "BASE"], "PRES": PRESSURE}], cut=SLAVES[one.slave][3],
                                    elastic={"E": YOUNG, "NU": POISSON}, zone={"TYPE_JACOBIEN": one.jacobian}))
    return [figures(result, one) for result, one in zip(run_contact(test, orders)[1], studies)]


def figures(result, one):
    last = result.orders[-1]
    normal = one.normal / np.linalg.norm(one.normal)
    expected = PRESSURE
    if one.jacobian == "ACTUALISE":
        expected /= (1 + POISSON * PRESSURE / YOUNG) ** 2

    def worst(values, value=0.0):
        return float(np.max(np.abs(np.asarray(values) - value)))

    support, depl = result.field("DEPL", last)
    exact = result.points[support] @ gradient(one.normal).T
    _, stress = result.field("SIEF_NOEU", last)
    full = np.array([[stress["SI" + "".join(sorted(a + b))] for b in "XYZ"] for a in "XYZ"])
    return types.SimpleNamespace(
        pressure=max(worst(result.where_present("DEPL", last, "LAGS_C"), -expected),
                     worst(result.where_present("CONT_ELEM", last, "PRES"), -expected)) / PRESSURE,
        stress=worst(np.einsum("i,ijn,j", normal, full, normal), -PRESSURE) / PRESSURE,
        stresses=worst(full, -PRESSURE * np.outer(normal, normal)[:, :, None]) / PRESSURE,
        gap=worst(result.where_present("CONT_ELEM", last, "JEU")) / one.scale,
        cover=worst(result.where_present("CONT_ELEM", last, "COEFSURF"), 1.0),
        active=worst(result.where_present("CONT_ELEM", last, "CONT"), 1.0),
        displacement=worst(np.array([depl[c] for c in ("DX", "DY", "DZ")]).T, exact) / np.abs(exact).max(),
        iterations=int(result.parameter("newton_iterations")[-1]))
