"""Meshes of the studies and of the tests: blocks of cells in the plane or in space, put together, written as MED 4.1.

    body = block("QUAD8", linspace(0, 2, 5), linspace(0, 1, 3), name="BODY", sides={"bottom": "BASE", "top": "LOAD"})
    write_med("mesh.med", union([body, other]))

Needs numpy and h5py only.
"""

import h5py
import numpy as np

#: cell type -> (name in MED files, dimension, skin cell)
CELLS = {
    "SEG2": ("SE2", 1, ""), "SEG3": ("SE3", 1, ""),
    "TRIA3": ("TR3", 2, "SEG2"), "TRIA6": ("TR6", 2, "SEG3"),
    "QUAD4": ("QU4", 2, "SEG2"), "QUAD8": ("QU8", 2, "SEG3"), "QUAD9": ("QU9", 2, "SEG3"),
}

#: volume cell -> (name in MED files, the vertices, in the order of catalog/cells.toml, of which each node in MED's order is the mean)
VOLUMES = {
    "TETRA4": ("TE4", "0 2 1 3"),
    "TETRA10": ("T10", "0 2 1 3 02 12 01 03 23 13"),
    "PENTA6": ("PE6", "0 2 1 3 5 4"),
    "PENTA15": ("P15", "0 2 1 3 5 4 20 12 01 53 45 34 03 25 14"),
    "PYRAM5": ("PY5", "0 3 2 1 4"),
    "PYRAM13": ("P13", "0 3 2 1 4 30 23 12 01 04 34 24 14"),
    "HEXA8": ("HE8", "0 3 2 1 4 7 6 5"),
    "HEXA20": ("H20", "0 3 2 1 4 7 6 5 30 23 12 01 74 67 56 45 04 37 26 15"),
    "HEXA27": ("H27", "0 3 2 1 4 7 6 5 30 23 12 01 74 67 56 45 04 37 26 15 0321 3047 2376 1265 0154 4567 01234567"),
}
CELLS.update({kind: (med, 3, "") for kind, (med, _) in VOLUMES.items()})

#: name of a cut -> vertices (of a cube, by number as in HEXA8; 8 is its centre) of the cells that a cube is cut into
CUBE = {
    "HEXA": ["01234567"],
    "PENTA": ["013457", "123567"],
    "PYRAM": ["01238", "04518", "15628", "26738", "37408", "47658"],
    "PYRAM/VERTEX": ["15620", "26730", "47650"],  # all apices in one vertex: the faces that meet there are two triangles each
    "TETRA": ["0126", "0236", "0376", "0746", "0456", "0516"],
}
#: cuts that fit together only if each cube is the mirror image of its neighbours -> the vertices of a cell seen in a mirror
MIRRORED = {"PYRAM/VERTEX": (0, 3, 2, 1, 4)}
CORNERS = ((0, 0, 0), (4, 0, 0), (4, 4, 0), (0, 4, 0), (0, 0, 4), (4, 0, 4), (4, 4, 4), (0, 4, 4), (2, 2, 2))


class Mesh:
    """Points (n, 2 or 3); cells by type, (m, n_nodes), 0-based; groups: name -> list of (type, index) or of nodes."""

    def __init__(self, points, cells, cell_groups=None, node_groups=None):
        self.points = np.asarray(points, float)
        self.cells = {kind: np.asarray(rows, int) for kind, rows in cells.items() if len(rows)}
        self.cell_groups = cell_groups or {}
        self.node_groups = node_groups or {}

    def nodes_where(self, test):
        """Nodes for which test(x, y) or test(x, y, z) holds."""
        return [i for i, point in enumerate(self.points) if test(*point)]

    def n_cells(self):
        return sum(len(rows) for rows in self.cells.values())


def block(kind, s, t, place=None, name="", sides=None):
    """A curved rectangle of cells. @param s, t parameters of the grid lines, increasing
    @param place maps parameters (s, t) to a point (x, y) and keeps the sense of rotation; None: the point is (s, t)
    @param sides "bottom" (t first), "right", "top", "left" -> name of the group of skin cells, whose normals leave the block"""
    skin = CELLS[kind][2]
    quadratic = skin == "SEG3"
    ns, nt = len(s) - 1, len(t) - 1
    numbers, points = {}, []

    def node(i, j):
        """Of the grid of half steps: even indices are grid lines."""
        if (i, j) not in numbers:
            numbers[i, j] = len(points)
            where = [(line[k // 2] + line[(k + 1) // 2]) / 2 for line, k in ((s, i), (t, j))]
            points.append(place(*where) if place else where)
        return numbers[i, j]

    def polygon(corners):
        """The nodes of a cell: corners, and middles of edges for a quadratic one."""
        nodes = [node(*c) for c in corners]
        if quadratic:
            ends = corners[1:] + corners[:1] if len(corners) > 2 else corners[1:]
            nodes += [node((a[0] + b[0]) // 2, (a[1] + b[1]) // 2) for a, b in zip(corners, ends)]
        return nodes

    cells = []
    for j in range(nt):
        for i in range(ns):
            square = [(2 * i, 2 * j), (2 * i + 2, 2 * j), (2 * i + 2, 2 * j + 2), (2 * i, 2 * j + 2)]
            if kind.startswith("QUAD"):
                cells.append(polygon(square) + ([node(2 * i + 1, 2 * j + 1)] if kind == "QUAD9" else []))
            else:  # diagonals of both directions
                first = (i + j) % 2
                for corners in ((0, 1, 2), (0, 2, 3)) if first else ((0, 1, 3), (1, 2, 3)):
                    cells.append(polygon([square[c] for c in corners]))
    mesh = Mesh([], {kind: cells})
    if name:
        mesh.cell_groups[name] = [(kind, c) for c in range(len(cells))]
    skins = []
    for side, group in (sides or {}).items():
        n = ns if side in ("bottom", "top") else nt
        first = len(skins)
        for k in range(n):
            skins.append(polygon({"bottom": [(2 * k, 0), (2 * k + 2, 0)], "right": [(2 * ns, 2 * k), (2 * ns, 2 * k + 2)],
                                  "top": [(2 * k + 2, 2 * nt), (2 * k, 2 * nt)], "left": [(0, 2 * k + 2), (0, 2 * k)]}[side]))
        mesh.cell_groups.setdefault(group, []).extend((skin, c) for c in range(first, len(skins)))
    if skins:
        mesh.cells[skin] = np.array(skins)
    mesh.points = np.array(points, float)
    return mesh


def brick(kind, lines, place=None, name="", sides=None, curved=False, cut=None):
    """A box of volume cells, each cube of the grid cut into cells of the kind. @param lines three arrays of parameters, increasing
    @param place maps parameters (r, s, t) to a point and keeps right-handedness; None: the point is (r, s, t)
    @param sides (axis, end: 0 or 1) -> name of the group of skin cells, whose normals leave the box
    @param curved put middle nodes by `place`, else into the middle of their vertices
    @param cut row of CUBE; None: the one of the kind's name"""
    spots = [[int(v) for v in spot] for spot in VOLUMES[kind][1].split()]
    cut = cut or kind.rstrip("0123456789")
    size = [len(line) - 1 for line in lines]
    numbers, points = {}, []

    def position(key):
        """Of a point of the grid of quarter steps."""
        at = [line[k // 4] + (line[min(k // 4 + 1, len(line) - 1)] - line[k // 4]) * (k % 4) / 4 for line, k in zip(lines, key)]
        return np.asarray(place(*at) if place else at, float)

    def node(vertices):
        """The middle of vertices given on the grid of quarter steps."""
        key = tuple(sum(v[i] for v in vertices) // len(vertices) for i in range(3))
        if key not in numbers:
            numbers[key] = len(points)
            points.append(position(key) if curved else np.mean([position(v) for v in vertices], axis=0))
        return numbers[key]

    def facet(vertices, axis, end):
        """Vertices of a plane facet in turn, seen from outside against the axis, and its middles as the cell's order has them."""
        u, v = ((axis + 1) % 3, (axis + 2) % 3) if end else ((axis + 2) % 3, (axis + 1) % 3)
        middle = np.mean(vertices, axis=0)
        turn = sorted(vertices, key=lambda k: np.arctan2(k[v] - middle[v], k[u] - middle[u]))
        nodes = [node([k]) for k in turn]
        if len(spots) > len(spots[0]) and any(len(spot) == 2 for spot in spots):
            nodes += [node(pair) for pair in zip(turn, turn[1:] + turn[:1])]
        if kind == "HEXA27":
            nodes.append(node(turn))
        quad = len(turn) == 4
        return f"{'QUAD' if quad else 'TRIA'}{len(nodes)}", nodes

    cells, skins = [], {}
    members = {group: [] for group in (sides or {}).values()}
    for base in np.ndindex(*size):
        turned = [cut in MIRRORED and b % 2 for b in base]
        for names in CUBE[cut]:
            corner = [tuple(4 * b + (4 - c if turn else c) for b, c, turn in zip(base, CORNERS[int(n)], turned)) for n in names]
            if sum(turned) % 2:
                corner = [corner[v] for v in MIRRORED[cut]]
            cells.append([node([corner[v] for v in spot]) for spot in spots])
            for (axis, end), group in (sides or {}).items():
                on = [k for k in corner if k[axis] == 4 * size[axis] * end]
                if len(on) >= 3:
                    skin, nodes = facet(on, axis, end)
                    members[group].append((skin, len(skins.setdefault(skin, []))))
                    skins[skin].append(nodes)
    mesh = Mesh(points, {kind: cells, **skins}, members)
    if name:
        mesh.cell_groups[name] = [(kind, c) for c in range(len(cells))]
    return mesh


def shaken(lines, amplitude, seed):
    """A `place` that moves every inner grid point at random; those of a side stay in it, those of an edge on it.
    @param amplitude in steps of the grid, along each axis; a number or a function of the grid point"""
    random, moved = np.random.default_rng(seed), {}
    most = amplitude if callable(amplitude) else lambda at: amplitude

    def place(*at):
        if at not in moved:
            steps = [0 if value in (line[0], line[-1]) else min(np.diff(line)[max(np.searchsorted(line, value) - 1, 0):][:2])
                     for line, value in zip(lines, at)]
            moved[at] = np.array(at) + most(at) * np.array(steps) * random.uniform(-1, 1, len(at))
        return moved[at]

    return place


def cubes(size, name="", sides=None, kind="HEXA8"):
    """A box of size[0] x size[1] x size[2] unit cubes as HEXA8, or as six TETRA4 each: as brick() makes it, for meshes of millions
    of cells. @param sides (axis, end: 0 or 1) -> name of the group of QUAD4 or TRIA3, whose normals leave the box"""
    numbers = np.arange(np.prod(np.add(size, 1))).reshape(np.add(size, 1))

    def corner(offset):
        return numbers[tuple(slice(o, o + n) for o, n in zip(offset, size))].ravel()

    places = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    order = [int(v) for v in VOLUMES[kind][1].split()]
    parts = [np.column_stack([corner(places[int(part[v])]) for v in order]) for part in CUBE[kind.rstrip("0123456789")]]
    mesh = Mesh(np.stack(np.meshgrid(*(np.arange(n + 1.0) for n in size), indexing="ij"), axis=-1).reshape(-1, 3),
                {kind: np.stack(parts, axis=1).reshape(-1, len(order))})
    if name:
        mesh.cell_groups[name] = [(kind, c) for c in range(len(mesh.cells[kind]))]
    # tetrahedra: the first and the last vertex of a cube are on the diagonals of its faces
    skin, facets = ("QUAD4", [[0, 1, 2, 3]]) if kind == "HEXA8" else ("TRIA3", [[0, 1, 2], [0, 2, 3]])
    skins = []
    for (axis, end), group in (sides or {}).items():
        layer = np.take(numbers, -1 if end else 0, axis=axis)
        layer = layer if axis != 1 else layer.T  # so that the axes turn to the right about the side's own
        square = [layer[:-1, :-1], layer[1:, :-1], layer[1:, 1:], layer[:-1, 1:]]
        rows = np.concatenate([np.column_stack([square[v].ravel() for v in facet]) for facet in facets])
        first = sum(map(len, skins))
        mesh.cell_groups.setdefault(group, []).extend((skin, c) for c in range(first, first + len(rows)))
        skins.append(rows if end else rows[:, ::-1])
    if skins:
        mesh.cells[skin] = np.concatenate(skins)
    return mesh


def union(meshes):
    """All of them, not connected; groups of one name are put together."""
    points, cells, cell_groups, node_groups = [], {}, {}, {}
    for mesh in meshes:
        first = sum(len(p) for p in points)
        points.append(mesh.points)
        for name, members in mesh.cell_groups.items():
            cell_groups.setdefault(name, []).extend((kind, c + sum(len(r) for r in cells.get(kind, []))) for kind, c in members)
        for name, members in mesh.node_groups.items():
            node_groups.setdefault(name, []).extend(n + first for n in members)
        for kind, rows in mesh.cells.items():
            cells.setdefault(kind, []).append(rows + first)
    return Mesh(np.concatenate(points), {kind: np.concatenate(rows) for kind, rows in cells.items()}, cell_groups, node_groups)


def weld(mesh, tolerance=1e-9):
    """Make points of the same place one node. @param tolerance absolute"""
    places, first = {}, []
    number = np.empty(len(mesh.points), int)
    for i, key in enumerate(map(tuple, np.round(mesh.points / tolerance).astype(np.int64))):
        if key not in places:
            places[key] = len(first)
            first.append(i)
        number[i] = places[key]
    return Mesh(mesh.points[first], {kind: number[rows] for kind, rows in mesh.cells.items()}, mesh.cell_groups,
                {name: sorted({int(number[n]) for n in members}) for name, members in mesh.node_groups.items()})


def graded(length, fine, until, growth):
    """Grid lines from 0 to `length`: steps of `fine` up to `until`, then each `growth` times the one before."""
    steps = [fine] * max(1, round(until / fine))
    while sum(steps) < length:
        steps.append(steps[-1] * growth)
    if len(steps) > 1 and sum(steps) - length > 0.5 * steps[-1]:
        steps.pop()
    lines = np.concatenate([[0.0], np.cumsum(steps)])
    return lines * (length / lines[-1])


# ---------------------------------------------------------------------------------------------------- MED


def _families(groups, n_entities, sign):
    """(family of each entity, family -> names): entities in the same groups are one family; 0 is in none."""
    member_of = [[] for _ in range(n_entities)]
    for name, members in groups.items():
        for m in sorted(set(members)):
            member_of[m].append(name)
    numbers, family = {}, np.zeros(n_entities, np.int32)
    for i, names in enumerate(member_of):
        if names:
            family[i] = numbers.setdefault(tuple(names), sign * (len(numbers) + 1))
    return family, {number: names for names, number in numbers.items()}


def _set(group, **attributes):
    for name, value in attributes.items():
        group.attrs[name] = np.int32(value) if isinstance(value, int) else np.bytes_(value) if isinstance(value, str) else value


def write_med(path, mesh, name="MESH"):
    """MED 4.1. Cells by type, in the order of the mesh; every group tracks the order of its links, without which libmed 4 does not
    find its families."""
    kinds = list(mesh.cells)
    first = dict(zip(kinds, np.cumsum([0] + [len(mesh.cells[kind]) for kind in kinds])))
    cell_groups = {g: [first[kind] + c for kind, c in members] for g, members in mesh.cell_groups.items()}
    cell_family, cell_names = _families(cell_groups, mesh.n_cells(), -1)
    node_family, node_names = _families(mesh.node_groups, len(mesh.points), 1)
    empty = {"ELEME": [g for g, m in mesh.cell_groups.items() if not m], "NOEUD": [g for g, m in mesh.node_groups.items() if not m]}
    with h5py.File(path, "w", track_order=True) as file:

        def make(where, **attributes):
            parts, here = where.strip("/").split("/"), file
            for part in parts:
                here = here[part] if part in here else here.create_group(part, track_order=True)
            _set(here, **attributes)
            return here

        make("INFOS_GENERALES", MAJ=4, MIN=1, REL=0)
        root = f"ENS_MAA/{name}"
        space = mesh.points.shape[1]
        axes = "".join(axis.ljust(16) for axis in "XYZ"[:space])
        make(root, DIM=space, ESP=space, REP=0, TYP=0, SRT=0, NXT=-1, NXI=-1, UNT="", UNI=" " * 32, NOM=axes, DES="")
        step = f"{root}/-0000000000000000001-0000000000000000001"
        make(step, CGT=1, NDT=-1, NOR=-1, PDT=-1.0, NXT=-1, NXI=-1, PVT=-1, PVI=-1)
        nodes = make(f"{step}/NOE", CGT=1, CGS=1, PFL="MED_NO_PROFILE_INTERNAL")
        nodes["COO"] = mesh.points.T.ravel()
        _set(nodes["COO"], CGT=1, NBR=len(mesh.points))
        nodes["FAM"] = node_family
        _set(nodes["FAM"], CGT=1, NBR=len(mesh.points))
        make(f"{step}/MAI", CGT=1)
        for kind in kinds:
            rows = mesh.cells[kind]
            med, dimension, _ = CELLS[kind]
            group = make(f"{step}/MAI/{med}", CGT=1, CGS=1, PFL="MED_NO_PROFILE_INTERNAL", GEO=100 * dimension + rows.shape[1])
            group["NOD"] = (rows.T.ravel() + 1).astype(np.int32)
            _set(group["NOD"], CGT=1, NBR=len(rows))
            group["FAM"] = cell_family[first[kind]:first[kind] + len(rows)]
            _set(group["FAM"], CGT=1, NBR=len(rows))
        make(f"FAS/{name}/FAMILLE_ZERO", NUM=0)
        for entity, families in (("ELEME", cell_names), ("NOEUD", node_names)):
            if empty[entity]:  # a family that no entity belongs to
                sign = -1 if entity == "ELEME" else 1
                families = {**families, sign * (len(families) + 1): tuple(empty[entity])}
            for number, names in families.items():
                family = f"FAS/{name}/{entity}/FAM_{number}"
                make(family, NUM=number)
                rows = np.array([list(text.encode().ljust(80, b"\0")) for text in names], np.int8)
                group = make(f"{family}/GRO", NBR=len(names))
                group.create_dataset("NOM", (len(names),), np.dtype((np.int8, (80,))))[...] = rows
