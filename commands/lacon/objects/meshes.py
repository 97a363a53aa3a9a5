"""Meshes and models as a command file sees them."""

import re

from ..base import contents
from ..core import catalog, current, labels
from ..core.concepts import CO, Concept
from ..core.late import numpy
from ..core.nearest import nearest
from .files import print_med


_linear = {"POI1", "SEG2", "TRIA3", "QUAD4", "TETRA4", "PENTA6", "PYRAM5", "HEXA8"}


class Mesh(Concept):
    type = "mesh"

    def _read(self, what, *arguments):
        """What a function of contents.py finds in its file."""
        with self.open() as file:
            return what(file, *arguments)

    def getNumberOfNodes(self):
        return self._read(contents.number_of_nodes)

    def getNumberOfCells(self):
        return self._read(contents.number_of_cells)

    def getDimension(self):
        return self._read(contents.dimension)

    def getCoordinates(self):
        return Coordinates(self)

    def group(self, kind, name):
        """Members of a group, 0-based; None where there is no such group. `kind` is "cells" or "nodes"."""
        return self._read(contents.group, kind, name)

    def group_names(self, kind):
        return self._read(contents.group_names, kind)

    def is_deformed(self):
        """Whether nodes are where MODI_MAILLAGE with DEFORME has moved them."""
        return self._read(contents.is_deformed)

    def nodes_of(self, cells):
        """Nodes of cells, one cell after the other."""
        return self._read(contents.nodes_of, cells)

    def are_lines(self, cells):
        names, types = self._read(contents.cell_types)
        return all(names[t].startswith("SEG") for t in set(types[cells].tolist()))

    def chain_of(self, cells):
        """Nodes of line cells that form one open chain, along it in the direction of the first cell, as MACR_LIGN_COUPE has them (chain_of_lines);
        None where they form none."""
        if not len(cells) or not self.are_lines(cells):
            return None
        offset, nodes = self._read(contents.connectivity)
        own = [nodes[offset[c]:offset[c + 1]].tolist() for c in cells]
        around = {}  # vertex -> cells there, by place
        for i, line in enumerate(own):
            for vertex in line[:2]:
                around.setdefault(vertex, []).append(i)
        counts = [len(lines) for lines in around.values()]
        if counts.count(1) != 2 or max(counts) > 2:
            return None
        used = set()

        def walk(i, start):
            """Nodes beyond `start`, leaving it through line `i`."""
            found = []
            while i is not None:
                used.add(i)
                forward = own[i][0] == start
                start = own[i][forward]
                found += [*own[i][2:][::1 if forward else -1], start]
                i = next((j for j in around[start] if j not in used), None)
            return found

        first = own[0][0]
        ahead = walk(0, first)
        behind = [node for i in around[first] if i not in used for node in walk(i, first)]
        return [*behind[::-1], first, *ahead] if len(used) == len(own) else None

    def lines_among(self, nodes):
        """The line cells that have all their nodes among some."""
        names, types = self._read(contents.cell_types)
        offset, own = self._read(contents.connectivity)
        lines = numpy.flatnonzero(numpy.isin(types, [t for t, name in enumerate(names) if name.startswith("SEG")]))
        return [int(c) for c in lines if numpy.isin(own[offset[c]:offset[c + 1]], nodes).all()]

    def node_counts(self, cells):
        """How many nodes each of some cells has."""
        offset, _ = self._read(contents.connectivity)
        return offset[cells + 1] - offset[cells]

    def getGroupsOfCells(self, local=False):
        return self.group_names("cells")

    def getGroupsOfNodes(self, local=False):
        return self.group_names("nodes")

    def hasGroupOfCells(self, name, local=False):
        return name in self.group_names("cells")

    def hasGroupOfNodes(self, name, local=False):
        return name in self.group_names("nodes")

    def getCells(self, groups=()):
        """Numbers from 0 of the cells of a group or of several, in the mesh's order; of all without groups."""
        if not groups:
            return list(range(self.getNumberOfCells()))
        return sorted({int(cell) for name in _names(groups) for cell in self._members("cells", name)})

    def getNodes(self, groups=()):
        """Numbers from 0 of the nodes of groups (of nodes; else of cells: their nodes), in the mesh's order; of all without groups."""
        if not groups:
            return list(range(self.getNumberOfNodes()))
        found = set()
        for name in _names(groups):
            if name in self.group_names("nodes"):
                found.update(self._members("nodes", name).tolist())
            else:
                found.update(self.getNodesFromCells(name))
        return sorted(found)

    def getNodesFromCells(self, groups):
        connectivity = self.getConnectivity()
        return sorted({node for cell in self.getCells(groups) for node in connectivity[cell]})

    def _members(self, kind, name):
        members = self.group(kind, name)
        if members is None:
            known = self.group_names(kind)
            raise ValueError(f"{self.label or self.id} has no group of {kind} '{name}'{nearest(name, known)}")
        return members

    def getConnectivity(self):
        """Nodes of each cell, from 0, in the order of catalog/cells.toml."""
        offset, nodes = (part.tolist() for part in self._read(contents.connectivity))
        return [nodes[first:last] for first, last in zip(offset[:-1], offset[1:])]

    def getCellTypeName(self, cell):
        """"TRIA6\""""
        names, types = self._read(contents.cell_types)
        return names[types[cell]]

    def getMinMaxEdgeSizes(self, groups):
        """(least, greatest) distance between the ends of the edges of the cells of a group or of several."""
        lengths = self.edge_lengths(groups)
        if not lengths:
            raise ValueError(f"getMinMaxEdgeSizes: the cells of {groups} have no edges")
        return float(min(lengths)), float(max(lengths))

    def edge_lengths(self, groups=()):
        """Distances between the ends of the edges of the cells of a group or of several, of all without groups."""
        names, types = self._read(contents.cell_types)
        offset, nodes = self._read(contents.connectivity)
        points = self.getCoordinates().toNumpy()
        return [numpy.linalg.norm(points[nodes[offset[cell] + a]] - points[nodes[offset[cell] + b]])
                for cell in self.getCells(groups) for a, b in catalog.edges(names[types[cell]])]

    def refine(self, ntimes=1, info=1):
        """The mesh with every edge cut in two, `ntimes` times over: MACR_ADAP_MAIL."""
        label, mesh = labels.label(labels.user_frame()) or "refined", self
        for _ in range(ntimes):
            made = CO(label)
            current.commands["MACR_ADAP_MAIL"](MAILLAGE_N=mesh, MAILLAGE_NP1=made, ADAPTATION="RAFFINEMENT_UNIFORME", INFO=info)
            mesh = made
        return mesh

    def convertToQuadratic(self, info=1):
        return current.commands["CREA_MAILLAGE"](MAILLAGE=self, LINE_QUAD={"TOUT": "OUI"}, INFO=info)

    def convertToLinear(self, info=1):
        return current.commands["CREA_MAILLAGE"](MAILLAGE=self, QUAD_LINE={"TOUT": "OUI"}, INFO=info)

    def printMedFile(self, path, local=True):
        print_med(path, MAILLAGE=self)

    def isQuadratic(self):
        """Whether it has cells of the second order."""
        names, types = self._read(contents.cell_types)
        return any(names[t] not in _linear for t in set(types.tolist()))

    def isParallel(self):
        return False

    def getInnerNodes(self):
        """Those of this process: all."""
        return self.getNodes()

    def getInnerCells(self):
        return self.getCells()

    def getOuterNodes(self):
        return []

    getOuterCells = getOuterNodes

    def getCellName(self, cell):
        return f"M{cell + 1}"

    def getNodeName(self, node):
        return f"N{node + 1}"

    def number_of(self, kind, name):
        """The node or cell of this name, counted from 0; None where there is none: the one member of a group of the name, or N12, NO12; M12, MA12."""
        own = self.group(kind, name)
        if own is not None and len(own) == 1:
            return int(own[0])
        count = self.getNumberOfNodes() if kind == "nodes" else self.getNumberOfCells()
        number = re.fullmatch({"nodes": "NO?", "cells": "MA?"}[kind] + "([1-9][0-9]*)", name)
        return int(number[1]) - 1 if number and int(number[1]) <= count else None

    def LIST_GROUP_MA(self):
        """[(name, number of cells)]"""
        return [(name, len(self._members("cells", name))) for name in self.group_names("cells")]

    def LIST_GROUP_NO(self):
        """[(name, number of nodes)]"""
        return [(name, len(self._members("nodes", name))) for name in self.group_names("nodes")]


class Coordinates:
    """What Mesh.getCoordinates() returns."""

    def __init__(self, mesh):
        self._mesh = mesh

    def toNumpy(self):
        """(n, 3) array"""
        return self._mesh._read(contents.points)

    def __getitem__(self, node):
        """[x, y, z] of a node, counted from 0"""
        with self._mesh.open() as file:
            return file["coordinates"][node].tolist()

    def getValues(self):
        """x1, y1, z1, x2, ... as a list"""
        return self.toNumpy().ravel().tolist()


class Model(Concept):
    type = "model"

    def getMesh(self):
        with self.open() as file:
            return self.base.concept(contents.reference(file, "mesh"))


def _names(groups):
    return [groups] if isinstance(groups, str) else list(groups)
