"""A result of a base, read by the launcher's own reader (commands/lacon/base), without its commands."""

import pathlib
import sys

import h5py
import numpy as np

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1]))

from lacon.base import contents  # noqa: E402
from lacon.base.base import ReadBase  # noqa: E402
from lacon.base.fields import FieldData  # noqa: E402
from lacon.base.seal import open_checked  # noqa: E402


def identifier_of(base, label):
    """The id of the concept of this label: mesh_3."""
    return ReadBase(base, "results.py").registry["labels"][label]


class MeshOfBase:
    """A mesh. .points (n, 2 or 3), .cells: list of (type, nodes), .groups: name -> cells, .patches: sub-cells of each"""

    def __init__(self, path):
        with h5py.File(path, "r") as mesh:
            self.points = contents.points(mesh)[:, :contents.dimension(mesh)]
            self.cells = contents.cells(mesh)
            self.groups = contents.groups(mesh, "cells")
            self.patches = contents.patches(mesh)


class Result:
    """The result of this label. .points (n, 2 or 3), .cells: list of (type, nodes), .groups: name -> cells, .orders, .instants"""

    def __init__(self, base, label):
        self.base = ReadBase(base, "results.py")
        self.index = self.base.open(self.base.registry["labels"][label])
        self.instants = dict(contents.instants(self.index))
        self.orders = list(self.instants)
        mesh = MeshOfBase(self.base.path(contents.reference(self.index, "mesh")))
        self.points, self.cells, self.groups, self.patches = mesh.points, mesh.cells, mesh.groups, mesh.patches

    def _field(self, name, order):
        with open_checked(self.base.folder / contents.field_file(self.index, name, order)) as file:
            return FieldData(file)

    def field(self, name, order):
        """@return (support, component -> values); rows of nodes or cells"""
        field = self._field(name, order)
        return field.support, dict(zip(field.components, field.values.T))

    def where_present(self, name, order, component):
        """The values of the places where the component exists."""
        return self._field(name, order).component(component)[1]

    def parameter(self, name):
        """One value an instant."""
        return contents.parameters(self.index)[name]

    def at_nodes(self, name, order, component):
        """One value a node, 0 where the field is not."""
        support, values = self.field(name, order)
        full = np.zeros(len(self.points))
        full[support] = values[component]
        return full

    def on_cells(self, name, order, component):
        """cell -> value"""
        support, values = self.field(name, order)
        return dict(zip(support.tolist(), values[component].tolist()))
