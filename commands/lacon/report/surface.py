"""What is drawn of a mesh: the facets that bound its bodies (in the plane its cells), faces and edges of them, the skins in contact apart."""

from ..core import catalog
from ..core.late import numpy

#: plane faces of a facet, by its local nodes: curved ones are bent at their middle nodes
_faces = {"TRIA3": [(0, 1, 2)], "QUAD4": [(0, 1, 2, 3)],
          "TRIA6": [(0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)],
          "QUAD8": [(0, 4, 7), (4, 1, 5), (5, 2, 6), (7, 6, 3), (4, 5, 6, 7)],
          "QUAD9": [(0, 4, 8, 7), (4, 1, 5, 8), (8, 5, 2, 6), (7, 8, 6, 3)]}
#: odd numbers without a pattern, by which vertices become one number
_factors = (0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9, 0x27D4EB2F165667C5)


def _key(vertices):
    """One number for each row, whatever the order of its vertices."""
    ordered = numpy.sort(vertices.astype(numpy.uint64), axis=1) + numpy.uint64(1)
    with numpy.errstate(over="ignore"):
        return sum(ordered[:, c] * numpy.uint64(_factors[c]) for c in range(ordered.shape[1]))


class Facets:
    """Facets of one type: `kind`, `nodes` (n, nodes of the type), `cells` (n) that they belong to, `first` the number of the first one."""

    def __init__(self, kind, nodes, cells):
        self.kind, self.nodes, self.cells = kind, nodes, cells
        self.vertices = catalog.cells()[kind]["vertices"]
        self.first = 0

    def __len__(self):
        return len(self.cells)

    def numbers(self):
        return self.first + numpy.arange(len(self))


def boundary(mesh):
    """[Facets] that belong to one body cell alone; in the plane the body cells."""
    body = mesh.cells_of_dimension(mesh.dimension)
    if mesh.dimension == 2:
        return [Facets(name, nodes, numbers) for name, (numbers, nodes) in body.items()]
    parts = {}
    for name, (numbers, nodes) in body.items():
        for kind, local in catalog.cells()[name]["facets"]:
            parts.setdefault(kind, []).append((nodes[:, local], numbers))
    joined = [Facets(kind, *map(numpy.concatenate, zip(*members))) for kind, members in parts.items()]
    keys = [_key(facets.nodes[:, :facets.vertices]) for facets in joined]
    alone = _alone(numpy.concatenate(keys))
    found = []
    for facets, mask in zip(joined, numpy.split(alone, numpy.cumsum([len(k) for k in keys])[:-1])):
        if mask.any():
            found.append(Facets(facets.kind, facets.nodes[mask], facets.cells[mask]))
    return found


def _alone(keys):
    """Whether each key is there once."""
    order = numpy.argsort(keys, kind="stable")
    ordered = keys[order]
    same = numpy.concatenate([[False], ordered[1:] == ordered[:-1], [False]])
    found = numpy.empty(len(keys), bool)
    found[order] = ~(same[1:] | same[:-1])
    return found


def parts_of(nodes_of_facets, n_nodes):
    """The connected part of each node, numbered from 0; -1 for nodes of no facet. @param nodes_of_facets [(n, k)] arrays"""
    ends = numpy.concatenate([numpy.repeat(numpy.cumsum([0, *[len(a) for a in nodes_of_facets[:-1]]])[i] + numpy.arange(len(a)), a.shape[1])
                              for i, a in enumerate(nodes_of_facets)])
    nodes = numpy.concatenate([a.ravel() for a in nodes_of_facets])
    order = numpy.argsort(nodes, kind="stable")
    starts = numpy.flatnonzero(numpy.concatenate([[True], numpy.diff(nodes[order]) > 0]))
    own = nodes[order][starts]
    widths = numpy.concatenate([numpy.full(len(a), a.shape[1]) for a in nodes_of_facets])
    facet_starts = numpy.concatenate([[0], numpy.cumsum(widths)[:-1]])
    label = numpy.arange(n_nodes)
    while True:
        least = numpy.minimum.reduceat(label[nodes], facet_starts)
        new = label.copy()
        new[own] = numpy.minimum(label[own], numpy.minimum.reduceat(least[ends[order]], starts))
        new = new[new]
        if (new == label).all():
            break
        label = new
    found = numpy.full(n_nodes, -1)
    found[own] = numpy.unique(label[own], return_inverse=True)[1]
    return found


def _sides(zones):
    """(number of the zone, name, "slave" or "master", cells) of each skin in contact."""
    for number, (slave, master, slaves, masters) in enumerate(zones):
        yield number, slave, "slave", slaves
        yield number, master, "master", masters


class _Places:
    """Where keys are in a list."""

    def __init__(self, keys):
        self._order = numpy.argsort(keys, kind="stable")
        self._sorted = keys[self._order]

    def of(self, keys):
        """(places, whether they are there)"""
        at = numpy.minimum(numpy.searchsorted(self._sorted, keys), len(self._sorted) - 1)
        return self._order[at], self._sorted[at] == keys


class Drawing:
    """The surfaces of a mesh, each a dictionary for the page.

    `nodes` numbers of the nodes that are drawn; `facet_cells` (f) the body cell of each facet (of a skin in the plane, that under it);
    `facet_skins` (f) its skin cell in contact, -1 for none; `facet_patches` (f) its patch, -1 for none; `parts` names of the bodies.
    """

    def __init__(self, mesh, zones):
        """@param zones contents.contact_zones()"""
        self.mesh = mesh
        facets = boundary(mesh)
        for one, first in zip(facets, numpy.cumsum([0, *map(len, facets)])):
            one.first = int(first)
        self.facets = facets
        part = parts_of([one.nodes for one in facets], len(mesh.points))
        self.parts = self._names(facets, part)
        self._patch_of_cell = numpy.full(len(mesh.cell_types), -1)
        for number, cells in enumerate(mesh.patches):
            self._patch_of_cell[cells] = number
        used = numpy.zeros(len(mesh.points), bool)
        for one in facets:
            used[one.nodes] = True
        self.nodes = numpy.flatnonzero(used)
        self._renumbered = numpy.cumsum(used) - 1
        self.facet_cells = numpy.concatenate([one.cells for one in facets])
        self.facet_skins = numpy.full(len(self.facet_cells), -1)
        self.surfaces = []
        (self._skins_in_plane if mesh.dimension == 2 else self._skins_in_space)(zones)
        in_contact = numpy.zeros(len(self.facet_cells), bool)
        for surface in self.surfaces:
            if "facets" in surface:
                in_contact[surface["facets"]] = True
        of_facet = numpy.concatenate([part[one.nodes[:, 0]] for one in facets])
        for number, name in enumerate(self.parts):
            chosen = numpy.flatnonzero((of_facet == number) & ~in_contact[:len(of_facet)])
            self._add(chosen, {"name": name, "kind": "body", "zone": -1, "part": number})
        for surface in self.surfaces:
            surface.setdefault("part", int(part[surface.pop("node")]) if "node" in surface else -1)
        self.facet_patches = numpy.where(self.facet_skins >= 0, self._patch_of_cell[self.facet_skins], -1)

    def _names(self, facets, part):
        """Of each part the group that has its cells and no other ones; otherwise a number."""
        cells = numpy.concatenate([one.cells for one in facets])
        owner = numpy.concatenate([part[one.nodes[:, 0]] for one in facets])
        names = [f"body {number + 1}" for number in range(owner.max() + 1)]
        inside = numpy.zeros(len(self.mesh.cell_types), bool)
        for name, members in self.mesh.groups.items():
            inside[:] = False
            inside[members] = True
            of_group = inside[cells]
            found = numpy.unique(owner[of_group])
            if len(found) == 1 and (of_group == (owner == found[0])).all():
                names[found[0]] = name
        return names

    def _skin_keys(self):
        """The key of each skin cell of the mesh, 0 of others."""
        keys = numpy.zeros(len(self.mesh.cell_types), numpy.uint64)
        for name, (numbers, nodes) in self.mesh.cells_of_dimension(self.mesh.dimension - 1).items():
            keys[numbers] = _key(nodes[:, :catalog.cells()[name]["vertices"]])
        return keys

    def _skins_in_space(self, zones):
        """The facets that skin cells lie on."""
        place = _Places(numpy.concatenate([_key(one.nodes[:, :one.vertices]) for one in self.facets]))
        skins = self._skin_keys()
        for number, names, kind, cells in _sides(zones):
            found, there = place.of(skins[cells])
            free = there & ((self.facet_skins[found] < 0) | (kind == "slave"))
            self.facet_skins[found[free]] = cells[free]
            self._add(found[there], {"name": names, "kind": kind, "zone": number})

    def _skins_in_plane(self, zones):
        """Skins are lines, facets of their own behind those of the bodies; the body lies to their left."""
        edges, middles, owners = [], [], []
        for one in self.facets:
            middle = self.mesh.points[one.nodes[:, :one.vertices]].mean(axis=1)
            for a in range(one.vertices):
                edges.append(_key(one.nodes[:, [a, (a + 1) % one.vertices]]))
                middles.append(middle)
                owners.append(one.cells)
        place, middles, owners, skins = _Places(numpy.concatenate(edges)), numpy.concatenate(middles), numpy.concatenate(owners), self._skin_keys()
        for number, names, kind, cells in _sides(zones):
            at, there = place.of(skins[cells])
            ends, of = [], []
            for name, (numbers, nodes) in self.mesh.cells_of_dimension(1).items():
                rows = numpy.flatnonzero(numpy.isin(cells, numbers))
                own = nodes[numpy.searchsorted(numbers, cells[rows])]
                first, last = self.mesh.points[own[:, 0]], self.mesh.points[own[:, 1]]
                along, inward = last - first, middles[at[rows]] - first
                turned = there[rows] & (along[:, 0] * inward[:, 1] - along[:, 1] * inward[:, 0] < 0)
                own[turned, :2] = own[turned, 1::-1]
                chain = [0, 1] if own.shape[1] == 2 else [0, 2, 1]
                for pair in zip(chain[:-1], chain[1:]):
                    ends.append(own[:, pair])
                    of.append(rows + len(self.facet_cells))
            ends, of = numpy.concatenate(ends), numpy.concatenate(of)
            self.facet_cells = numpy.concatenate([self.facet_cells, numpy.where(there, owners[at], cells)])
            self.facet_skins = numpy.concatenate([self.facet_skins, cells])
            self.surfaces.append({"name": names, "kind": kind, "zone": number, "node": int(ends[0, 0]), "segments": self._renumbered[ends],
                                  "segment_facets": of})

    def _add(self, chosen, about):
        """A surface of these facets: faces of three and of four nodes, edges."""
        triangles, quads, edges = [], [], []
        for one in self.facets:
            rows = chosen[(chosen >= one.first) & (chosen < one.first + len(one))] - one.first
            if not len(rows):
                continue
            nodes = one.nodes[rows]
            for face in _faces[one.kind]:
                (triangles if len(face) == 3 else quads).append((nodes[:, face], rows + one.first))
            for k in range(one.vertices):
                ends = [k, (k + 1) % one.vertices]
                chain = ends if nodes.shape[1] == one.vertices else [ends[0], one.vertices + k, ends[1]]
                edges += [nodes[:, pair] for pair in zip(chain[:-1], chain[1:])]
        if not triangles and not quads:
            return
        for name, members, width in (("triangles", triangles, 3), ("quads", quads, 4)):
            about[name] = self._renumbered[numpy.concatenate([m[0] for m in members])] if members else numpy.empty((0, width), int)
            about[f"{name[:-1]}_facets"] = numpy.concatenate([m[1] for m in members]) if members else numpy.empty(0, int)
        pairs = numpy.sort(numpy.concatenate(edges), axis=1)
        once = numpy.unique(pairs[:, 0] * len(self.mesh.points) + pairs[:, 1])
        about["edges"] = self._renumbered[numpy.column_stack(numpy.divmod(once, len(self.mesh.points)))]
        about.update(facets=chosen, node=int(self.nodes[about["edges"][0, 0]]))
        self.surfaces.append(about)
