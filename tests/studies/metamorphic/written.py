"""A contact study that is drawn from its number, and the ways in which the same study can be written."""

import copy
import dataclasses
import json
import math
import pathlib
import random
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "robustness")]

import run  # noqa: E402, I001 (it says where meshes.py is)
import numpy as np  # noqa: E402
from unseen import Draw, study as unseen  # noqa: E402
from meshes import CELLS, VOLUMES, Mesh, write_med  # noqa: E402

LACON = run.LACON
ORIGIN = 10.0  # about where cylindrical axes are, outside the bodies
SKINS = ("SLAB_SKIN", "TOOL_SKIN")


class Small(Draw):
    """Studies of seconds, of every kind of cell."""

    kinds = ("QUAD4", "QUAD8", "QUAD9", "TRIA3", "TRIA6")
    kinds_of_space = ("HEXA8", "HEXA20", "HEXA27", "TETRA4", "TETRA10", "PENTA6", "PENTA15", "PYRAM5", "PYRAM13")
    lengths = (5, 8)

    def randint(self, first, last):
        """From the lower third of what is drawn elsewhere: coarse meshes, few steps."""
        return super().randint(first, first + (last - first) // 3 if last > 6 else last)


@dataclasses.dataclass
class Written:
    """One way to write a study. What was drawn at X is at scale turn X + shift; stresses are `stiffness` times as large."""
    name: str
    mesh: Mesh
    orders: dict          # of study.comm
    points: Mesh          # to project to
    arguments: tuple = ()
    steps: int = 1
    measure = None

    def prepare(self, folder):
        """Write the inputs. @return (arguments of the launcher, variables of its environment)"""
        write_med(folder / "mesh.med", self.mesh)
        write_med(folder / "points.med", self.points)
        (folder / "study.json").write_text(json.dumps(self.orders, default=lambda array: array.tolist()))
        units = (word for unit, name in ((20, "mesh.med"), (21, "points.med")) for word in ("--unit", f"{unit}={folder / name}"))
        return [HERE / "study.comm", *units, *self.arguments], {"METAMORPHIC_STUDY": str(folder / "study.json")}

    def copy(self, name):
        return Written(name, Mesh(self.mesh.points.copy(), self.mesh.cells, {k: list(v) for k, v in self.mesh.cell_groups.items()}, dict(self.mesh.node_groups)),
                       copy.deepcopy(self.orders), self.points, self.arguments, self.steps)


# ------------------------------------------------------------------------------------------------- drawing


def inside(mesh, body, random, number=4):
    """Places within cells of a body: means of a cell's vertices with weights that are drawn."""
    found = []
    for _ in range(number):
        kind, cell = random.choice(mesh.cell_groups[body])
        corners = mesh.points[mesh.cells[kind][cell]][:vertices(kind)]
        weights = np.array([random.uniform(0.2, 1) for _ in corners])
        found.append(weights @ corners / weights.sum())
    return found


def vertices(kind):
    if CELLS[kind][1] == 3:
        return sum(len(spot) == 1 for spot in VOLUMES[kind][1].split())
    return {"SEG": 2, "TRI": 3, "QUA": 4}[kind[:3]]


def drawn(number, kind_of_draw=Small):
    """The study of this number, as it was drawn."""
    study, draw = unseen(number, kind_of_draw), random.Random(f"{number} in other words")
    mesh, space = study.mesh, study.mesh.points.shape[1]
    mesh.cell_groups = {name: members for name, members in mesh.cell_groups.items()}
    model = study.model
    if model == "D_PLAN" and study.strain == "PETIT" and draw.random() < 0.4:
        model = "C_PLAN"
    young = min(next(iter(law.values()))["E"] for law in study.materials.values())

    def sometimes(share, **keywords):
        return keywords if draw.random() < share else {}

    size = 0.01 * np.ptp(mesh.points, axis=0).min()
    gap = [f"{size * draw.uniform(-0.3, 1)!r} * (1 + 0.3 * sin(3 * X) * cos(2 * Y))", size * draw.uniform(-0.3, 1)]
    zone = {**study.zones[0], **sometimes(0.3, TYPE_JACOBIEN="ACTUALISE"), **sometimes(0.2, TYPE_APPA="ROBUSTE"), **sometimes(0.3, DIST_ESCL=draw.choice(gap)),
            **sometimes(0.3, DIST_MAIT=draw.choice(gap)), **sometimes(0.15, GLISSIERE="OUI"), **sometimes(0.2, COEF_MULT_APPA=draw.uniform(2, 6)),
            "CONTACT_INIT": draw.choice(("INTERPENETRE", "OUI", "NON"))}
    loads = []
    if draw.random() < 0.6:
        loads.append({"name": "FORCE_INTERNE", "GROUP_MA": "SLAB", "type": "FIXE_CSTE",
                      "value": [[[0, 0], [study.steps, 1e-3 * young * draw.uniform(-1, 1) * (axis > 0 or model != "AXIS")]] for axis in range(space)]})
    if draw.random() < 0.6:
        loads.append({"name": "PRES_REP", "GROUP_MA": "SLAB_SKIN", "type": draw.choice(("FIXE_CSTE", "SUIV")), "value": [[0, 0], [study.steps, 2e-3 * young * draw.random()]]})
    flows = any("ECRO_LINE" in law for law in study.materials.values())
    relation = draw.choice(("VMIS_ISOT_LINE", "VMIS_CINE_LINE")) if study.strain == "PETIT" and model != "C_PLAN" else "VMIS_ISOT_LINE"
    bodies = {}
    for body, law in study.materials.items():
        if "ECRO_LINE" in law and relation == "VMIS_CINE_LINE":
            law = {"ELAS": law["ELAS"], "ECRO_LINE": law["ECRO_LINE"]}
        bodies[body] = {"law": law, "relation": relation if "ECRO_LINE" in law else "ELAS"}
    within = {body: inside(mesh, body, draw) for body in ("TOOL", "SLAB")}
    points = np.array(within["TOOL"] + within["SLAB"])
    segments = np.arange(len(points)).reshape(-1, 2)
    half = len(segments) // 2
    targets = Mesh(points, {"SEG2": segments}, {"IN_TOOL": [("SEG2", k) for k in range(half)], "IN_SLAB": [("SEG2", k) for k in range(half, 2 * half)]})
    directions = rotation(draw, space).T
    # a line through the least convex slab stays in the cell that it begins in, else a node outside would have any nearest point
    kind, cell = draw.choice(mesh.cell_groups["SLAB"])
    corners = mesh.points[mesh.cells[kind][cell]][:vertices(kind)]
    middle = corners.mean(axis=0)
    line = [0.6 * middle + 0.4 * corners[0], 0.7 * middle + 0.3 * corners[2]]
    orders = {
        "turn": np.eye(space), "scale": 1.0, "shift": np.zeros(space), "stiffness": 1.0, "model": model, "strain": study.strain, "most": max(study.most, 30),
        "cut": study.cut, "instants": [float(k) for k in range(study.steps + 1)], "ends": [float(study.steps)], "parts of loads": [1.0], "orient": [],
        "cuts": {}, "mirror": "", "residual": 1e-6, "bodies": bodies, "matter": [[body, body] for body in bodies], "zones": [zone], "moves": study.moves, "loads": loads, "how": {},
        "contact": {**sometimes(0.35, LISSAGE="OUI"), **sometimes(0.15, VARIATION_JEU="FIGEE")},
        "origin": [ORIGIN + draw.uniform(-0.3, 0.3) for _ in range(space)], "directions": directions, "line": line}
    words = [model, study.name, "flows" if flows else "", *orders["contact"], *(key for key in zone if key not in ("GROUP_MA_ESCL", "GROUP_MA_MAIT", "CONTACT_INIT")),
             *(load["name"] + " " + load["type"] for load in loads)]
    return Written(", ".join(word for word in words if word), mesh, orders, targets, steps=study.steps)


# ------------------------------------------------------------------------------------------------- other ways to write it


def seen(mesh, numbers):
    """The cells with their vertices taken in another order: vertex k is the former numbers[kind][k].
    @param numbers kind -> vertices, or nothing"""
    cells = {}
    for kind, rows in mesh.cells.items():
        order = numbers(kind)
        if order:
            rows = rows[:, node_order(kind, order)]
        cells[kind] = rows
    return Mesh(mesh.points, cells, mesh.cell_groups, mesh.node_groups)


def node_order(kind, order):
    """The nodes of a cell whose vertices are taken in this order."""
    spots = spots_of(kind)
    former = {frozenset(spot): k for k, spot in enumerate(spots)}
    names = [next(iter(spot)) for spot in spots[:len(order)]]  # vertices by number in the catalogue's order, as the file has them
    new_name = {names[k]: names[order[k]] for k in range(len(order))}
    return [former[frozenset(new_name[v] for v in spot)] for spot in spots]


def spots_of(kind):
    """The vertices of which each node of a cell in a file is the mean."""
    if CELLS[kind][1] == 3:
        return [tuple(int(v) for v in spot) for spot in VOLUMES[kind][1].split()]
    n = vertices(kind)
    ends = [(0, 1)] if n == 2 else [(k, (k + 1) % n) for k in range(n)]
    number = int("".join(c for c in kind if c.isdigit()))
    return ([(k,) for k in range(n)] + ends + [tuple(range(n))])[:number]


#: shape -> vertices in a file's order: a rotation of the cell, and its image in a mirror
ROTATIONS = {"TRIA": [1, 2, 0], "QUAD": [1, 2, 3, 0], "TETRA": [1, 2, 0, 3], "PENTA": [1, 2, 0, 4, 5, 3], "PYRAM": [1, 2, 3, 0, 4],
             "HEXA": [1, 5, 6, 2, 0, 4, 7, 3]}
MIRRORED = {"SEG": [1, 0], "TRIA": [0, 2, 1], "QUAD": [0, 3, 2, 1], "TETRA": [0, 2, 1, 3], "PENTA": [0, 2, 1, 3, 5, 4], "PYRAM": [0, 3, 2, 1, 4],
            "HEXA": [0, 3, 2, 1, 4, 7, 6, 5]}


def shape(kind):
    return kind.rstrip("0123456789")


def first_vertices(mesh, times=1):
    """The first vertex of each cell is another one; skins keep their sense."""
    for _ in range(times):
        mesh = seen(mesh, lambda kind: ROTATIONS.get(shape(kind)))
    return mesh


def in_a_mirror(mesh):
    return seen(mesh, lambda kind: MIRRORED[shape(kind)])


def renumbered(mesh, seed):
    """Other numbers for nodes and cells, another order of the types and of groups."""
    random = np.random.default_rng(seed)
    node = random.permutation(len(mesh.points))
    points = np.empty_like(mesh.points)
    points[node] = mesh.points
    cells, place = {}, {}
    for kind in reversed(mesh.cells):
        order = random.permutation(len(mesh.cells[kind]))
        cells[kind] = node[mesh.cells[kind]][order]
        place[kind] = np.argsort(order)
    return Mesh(points, cells, {name: [(kind, int(place[kind][c])) for kind, c in members] for name, members in reversed(mesh.cell_groups.items())},
                {name: [int(node[n]) for n in members] for name, members in mesh.node_groups.items()})


def moved(one, name, turn=None, scale=1.0, shift=0.0, stiffness=1.0):
    """The study elsewhere, or in other units."""
    other = one.copy(name)
    space = one.mesh.points.shape[1]
    turn, shift = np.eye(space) if turn is None else turn, np.zeros(space) + shift
    other.mesh.points = scale * one.mesh.points @ turn.T + shift
    other.points = Mesh(scale * one.points.points @ turn.T + shift, one.points.cells, one.points.cell_groups)
    other.orders.update(turn=turn, scale=scale, shift=shift, stiffness=stiffness)
    return other


def rotation(random, space):
    """Any rotation."""
    found = np.linalg.qr(np.array([[random.gauss(0, 1) for _ in range(space)] for _ in range(space)]))[0]
    found[:, 0] *= np.sign(np.linalg.det(found))
    return found


def ulp(one, random):
    """Points that differ in their last digits: what the study itself makes of round-off."""
    other = one.copy("ulp")
    size = np.ptp(one.mesh.points, axis=0).max()
    other.mesh.points = one.mesh.points + 2.0 ** -52 * size * np.random.default_rng(1).choice((-1, 1), one.mesh.points.shape)
    if one.orders["model"] == "AXIS":
        other.mesh.points[:, 0] = one.mesh.points[:, 0]
    return other


def turned(one, random):
    if one.orders["model"] != "AXIS":
        return moved(one, "turned", rotation(random, one.mesh.points.shape[1]))


def quarter(one, random):
    """Turned by 90 degrees: coordinates that were equal stay so."""
    if one.orders["model"] != "AXIS":
        turn = np.eye(one.mesh.points.shape[1])
        turn[:2, :2] = [[0, -1], [1, 0]]
        return moved(one, "quarter", turn)


def shifted(one, random):
    """By a hundred sizes; of a body of revolution along its axis."""
    size = np.ptp(one.mesh.points, axis=0).max()
    shift = size * np.array([random.uniform(-100, 100) for _ in one.mesh.points[0]])
    if one.orders["model"] == "AXIS":
        shift[0] = 0.0
    return moved(one, "shifted", shift=shift)


def mirror(one, random, oriented=False):
    """Of the plane x = 0, in axisymmetry y = 0; cells and skins have their sense again."""
    space = one.mesh.points.shape[1]
    turn = np.eye(space)
    turn[(k := int(one.orders["model"] == "AXIS")), k] = -1.0
    other = moved(one, "oriented" if oriented else "mirror", turn)
    if oriented:
        other.orders["orient"] = list(SKINS)
    else:
        other.mesh = in_a_mirror(other.mesh)
    return other


def oriented(one, random):
    """The mirror image whose cells are as they were: the file's body cells are inside out, its skins inward."""
    return mirror(one, random, True)


def metres(one, random):
    """Written in m and Pa."""
    return moved(one, "metres", scale=1e-3, stiffness=1e6)


def extreme(one, random):
    return moved(one, "extreme", scale=1e-6, stiffness=1e9)


def nanometres(one, random):
    """Written in nm and N: areas are larger than stiffnesses by far."""
    return moved(one, "nanometres", scale=1e6, stiffness=1e-12)


def numbers(one, random):
    other = one.copy("numbers")
    other.mesh = renumbered(one.mesh, 3)
    return other


def vertex(one, random):
    other = one.copy("vertex")
    other.mesh = first_vertices(one.mesh, random.randint(1, 2))
    return other


def bodies(one, random):
    """Materials in the other order, each in two groups of cells."""
    other = one.copy("bodies")
    groups = other.mesh.cell_groups
    matter = []
    for body in reversed(other.orders["bodies"]):
        members = list(groups[body])
        random.shuffle(members)
        half = len(members) // 2
        groups[f"{body}_A"], groups[f"{body}_B"] = members[:half], members[half:]
        matter += [[f"{body}_A", body], [f"{body}_B", body]]
    other.orders["matter"] = matter
    return other


def zones(one, random):
    """The slave skin in two parts, the latter the first zone; LISSAGE='OUI' refuses skins that share nodes (CONTACT2_16)."""
    if "LISSAGE" in one.orders["contact"]:
        return None
    other = one.copy("zones")
    [zone] = other.orders["zones"]
    groups, name = other.mesh.cell_groups, zone["GROUP_MA_ESCL"]
    members = list(groups[name])
    middles = [other.mesh.points[other.mesh.cells[kind][cell]].mean(axis=0)[0] for kind, cell in members]
    members = [members[k] for k in np.argsort(middles, kind="stable")]
    half = random.randint(1, len(members) - 1)
    groups[name + "_A"], groups[name + "_B"] = members[:half], members[half:]
    other.orders["zones"] = [{**zone, "GROUP_MA_ESCL": name + "_B"}, {**zone, "GROUP_MA_ESCL": name + "_A"}]
    return other


def loads(one, random):
    """Each load twice, with a half of it."""
    if one.orders["loads"]:
        other = one.copy("loads")
        other.orders["parts of loads"] = [0.5, 0.5]
        return other


def stages(one, random):
    """Computed in two STAT_NON_LINE."""
    other = one.copy("stages")
    other.orders["ends"] = [float(random.randint(1, one.steps - 1)), float(one.steps)]
    return other


def threads(one, random):
    other = one.copy("threads")
    other.arguments = ("--threads", "3")
    return other


def petsc(one, random):
    other = one.copy("petsc")
    other.orders["how"] = {"SOLVEUR": {"METHODE": "PETSC"}}
    return other


def mpi(one, random):
    other = one.copy("mpi")
    other.arguments = ("--mpi", "2")
    return other


class Even(Small):
    """Studies that the mirror x = 0 leaves as they are: even numbers of cells, and no motion along x."""

    def randint(self, first, last):
        return max(2, super().randint(first, last) // 2 * 2)

    def motion(self, depth, slide):
        return super().motion(depth, 0.0)


def symmetric(number):
    """(the whole study, the half of it on which x > 0), or nothing where the drawn study has no such symmetry."""
    whole = drawn(number, Even)
    if not any(word in whole.name for word in (" tip,", " blocks,")):
        return None
    orders = whole.orders
    orders["contact"].pop("LISSAGE", None)  # normals of the half end at the mirror, those of the whole are means of both sides
    for zone in orders["zones"]:
        zone.update({key: 0.01 for key in ("DIST_ESCL", "DIST_MAIT") if key in zone})
    for load in orders["loads"]:
        if load["name"] == "FORCE_INTERNE":
            load["value"][0] = 0.0
    for points in (whole.points.points, *(orders["line"])):  # to the side that the half has
        points[..., 0] = abs(points[..., 0])
    half, mesh = whole.copy("half"), whole.mesh
    kept = {kind: [c for c, nodes in enumerate(rows) if mesh.points[nodes][:, 0].mean() > 0] for kind, rows in mesh.cells.items()}
    nodes = np.unique(np.concatenate([mesh.cells[kind][rows].ravel() for kind, rows in kept.items()]))
    number_of = {int(node): k for k, node in enumerate(nodes)}
    cells = {kind: np.vectorize(number_of.get)(mesh.cells[kind][rows]) for kind, rows in kept.items()}
    place = {(kind, c): k for kind, rows in kept.items() for k, c in enumerate(rows)}
    groups = {name: [(kind, place[kind, c]) for kind, c in members if (kind, c) in place] for name, members in mesh.cell_groups.items()}
    on_mirror = [number_of[int(node)] for node in nodes if abs(mesh.points[node][0]) < 1e-12]
    half.mesh = Mesh(mesh.points[nodes], cells, groups, {"MIRROR": on_mirror})
    half.orders["mirror"] = "MIRROR"
    return whole, half


#: what is as it was to the last bit; for others the tolerance in largest values of a field
WAYS = {"ulp": (ulp, math.inf), "threads": (threads, 0.0), "turned": (turned, 1e-9), "quarter": (quarter, 1e-9), "shifted": (shifted, 1e-9), "mirror": (mirror, 1e-9), "oriented": (oriented, 1e-9),
        "metres": (metres, 1e-9), "extreme": (extreme, 1e-9), "nanometres": (nanometres, 1e-9),
        "numbers": (numbers, 1e-11), "vertex": (vertex, 1e-11), "bodies": (bodies, 1e-11),
        "zones": (zones, 1e-6), "loads": (loads, 1e-11), "stages": (stages, 1e-6), "petsc": (petsc, 1e-6), "mpi": (mpi, 1e-9)}


def ways(number, names=WAYS):
    """(written as drawn, [(the same otherwise, tolerance)])."""
    one = drawn(number)
    others = []
    for name in names:
        made, tolerance = WAYS[name]
        other = made(one, random.Random(f"{number} {name}"))
        if other:
            others.append((other, tolerance))
    return one, others
