"""A mesh of a base as arrays."""

import io
from functools import cached_property

from ..base import contents
from ..core import catalog
from ..core.late import numpy
from . import pictures


#: as meshio calls the types of catalog/cells.toml
_meshio_types = {"POI1": "vertex", "SEG2": "line", "SEG3": "line3", "TRIA3": "triangle", "TRIA6": "triangle6", "QUAD4": "quad", "QUAD8": "quad8",
                 "QUAD9": "quad9", "TETRA4": "tetra", "TETRA10": "tetra10", "PENTA6": "wedge", "PENTA15": "wedge15", "PYRAM5": "pyramid",
                 "PYRAM13": "pyramid13", "HEXA8": "hexahedron", "HEXA20": "hexahedron20", "HEXA27": "hexahedron27"}


def as_picture(figure):
    """The bytes of a PNG file."""
    out = io.BytesIO()
    figure.savefig(out, format="png", dpi=100)
    return out.getvalue()


class Mesh:
    """A mesh; what it is made of is read when it is first asked for.

    `label` the variable of the study, `dimension` 2 or 3.
    """

    def __init__(self, open_file, label):
        """@param open_file opens the concept's file"""
        self._open = open_file
        self.label = label
        with open_file() as file:
            self.dimension = contents.dimension(file)
            self._sizes = contents.number_of_nodes(file), contents.number_of_cells(file)

    def __repr__(self):
        nodes, cells = self._sizes
        return f"<mesh {self.label}: {nodes} nodes, {cells} cells, dimension {self.dimension}>"

    def _read(self, what, *arguments):
        with self._open() as file:
            return what(file, *arguments)

    @cached_property
    def points(self):
        """Coordinates of the nodes, (n, 3)."""
        return self._read(contents.points)

    @cached_property
    def connectivity(self):
        """(offset, nodes): those of cell c are nodes[offset[c]:offset[c + 1]], in the order of catalog/cells.toml."""
        return self._read(contents.connectivity)

    @cached_property
    def _types(self):
        return self._read(contents.cell_types)

    @cached_property
    def cell_types(self):
        """Name of the type of each cell, (m): "TRIA6"."""
        names, types = self._types
        return numpy.array(names)[types]

    @cached_property
    def cells(self):
        """type -> (numbers of the cells of this type, their nodes): (k), (k, nodes of the type)"""
        names, types = self._types
        offset, nodes = self.connectivity
        found = {}
        for index in numpy.unique(types):
            members = numpy.flatnonzero(types == index)
            size = offset[members[0] + 1] - offset[members[0]]
            found[names[index]] = members, nodes[offset[members][:, None] + numpy.arange(size)]
        return found

    @cached_property
    def groups(self):
        """Group of cells -> numbers of its cells."""
        return self._read(contents.groups, "cells")

    @cached_property
    def node_groups(self):
        """Group of nodes -> numbers of its nodes."""
        return self._read(contents.groups, "nodes")

    @cached_property
    def patches(self):
        """The skin cells of each patch of a mesh that CREA_MAILLAGE has cut; otherwise nothing."""
        return self._read(contents.patches)

    @cached_property
    def patch_zones(self):
        """[(slave group, number of its first patch, number behind its last one)] of a mesh that was cut."""
        return self._read(contents.patch_zones)

    @cached_property
    def patch_measures(self):
        """(length or area of each patch, its centre), by the vertices of its cells: (p), (p, 3)"""
        patch = numpy.full(len(self.cell_types), -1)
        for number, cells in enumerate(self.patches):
            patch[cells] = number
        total, moment = numpy.zeros(len(self.patches)), numpy.zeros((len(self.patches), 3))
        for name, (numbers, nodes) in self.cells_of_dimension(self.dimension - 1).items():
            own = patch[numbers] >= 0
            corners = self.points[nodes[own, :catalog.cells()[name]["vertices"]]]
            fan = [(0, 1)] if corners.shape[1] == 2 else [(0, i, i + 1) for i in range(1, corners.shape[1] - 1)]
            for part in fan:
                first, *others = (corners[:, i] for i in part)
                sides = [other - first for other in others]
                measure = numpy.linalg.norm(sides[0], axis=1) if len(sides) == 1 else numpy.linalg.norm(numpy.cross(*sides), axis=1) / 2
                numpy.add.at(total, patch[numbers[own]], measure)
                numpy.add.at(moment, patch[numbers[own]], measure[:, None] * corners[:, part].mean(axis=1))
        return total, moment / numpy.where(total > 0, total, 1.0)[:, None]

    def cells_of_dimension(self, dimension):
        """As `cells`, those of a dimension."""
        types = catalog.cells()
        return {name: found for name, found in self.cells.items() if types[name]["dimension"] == dimension}

    @cached_property
    def boundary(self):
        """The facets that bound the body cells, by number of vertices: size -> (cells that they belong to, vertices seen from outside). In the plane
        the body cells themselves, by their vertices."""
        found = {}
        for name, (numbers, nodes) in self.cells_of_dimension(self.dimension).items():
            row = catalog.cells()[name]
            corners = [list(range(row["vertices"]))] if self.dimension == 2 else [facet[:_vertices(kind)] for kind, facet in row["facets"]]
            for vertices in corners:
                found.setdefault(len(vertices), []).append((numbers, nodes[:, vertices]))
        joined = {size: tuple(map(numpy.concatenate, zip(*parts))) for size, parts in found.items()}
        return joined if self.dimension == 2 else {size: _once(*part) for size, part in joined.items()}

    def polygons(self, cells):
        """Vertices of skin cells in turn, one array a cell."""
        offset, nodes = self.connectivity
        types = catalog.cells()
        return [nodes[offset[c]:offset[c] + types[self.cell_types[c]]["vertices"]] for c in cells]

    def to_meshio(self, points=None):
        """A meshio.Mesh with its groups of cells as cell sets. @param points instead of the initial ones  @throws ImportError without meshio"""
        import meshio  # optional

        blocks, sets = [], {name: [] for name in self.groups}
        for name, (numbers, nodes) in self.cells.items():
            row = catalog.cells()[name]
            turned = numpy.empty_like(nodes)
            turned[:, row["vtk_permutation"]] = nodes
            blocks.append((_meshio_types[name], turned))
            for group, members in self.groups.items():
                sets[group].append(numpy.flatnonzero(numpy.isin(numbers, members)))
        return meshio.Mesh(self.points if points is None else points, blocks, cell_sets=sets)

    def plot(self):
        """A picture: a matplotlib figure."""
        return pictures.bodies(self.points, self.dimension, self.boundary, title=f"{self.label}, {self._sizes[1]} cells")

    def _repr_png_(self):
        return as_picture(self.plot())


def _vertices(kind):
    """Of a facet type: 3 of TRIA6."""
    return catalog.cells()[kind]["vertices"]


def _once(owners, facets):
    """The facets that belong to one cell alone."""
    _, first, counts = numpy.unique(numpy.sort(facets, axis=1), axis=0, return_index=True, return_counts=True)
    alone = numpy.sort(first[counts == 1])
    return owners[alone], facets[alone]
