"""A result of a base, read with h5py alone (docs/structures.md)."""

import json
import pathlib

import h5py
import numpy as np


def identifier_of(base, label):
    """The id of the concept of this label: mesh_3."""
    return json.loads((pathlib.Path(base) / "base.json").read_text(encoding="utf-8"))["labels"][label]


class MeshOfBase:
    """A mesh. .points (n, 2 or 3), .cells: list of (type, nodes), .groups: name -> cells, .patches: sub-cells of each"""

    def __init__(self, path):
        with h5py.File(path, "r") as mesh:
            names = list(mesh["cells"].attrs["types"])
            self.points = mesh["coordinates"][:, :mesh.attrs["dimension"]]
            self.cells = list(zip((names[t] for t in mesh["cells/type"][()]), _ragged(mesh["cells"], "nodes")))
            self.groups = dict(zip(mesh["groups/cells/name"].asstr()[()], _ragged(mesh["groups/cells"], "values")))
            self.patches = _ragged(mesh["patches/cells"], "values") if "patches" in mesh else []


class Result:
    """The result of this label. .points (n, 2 or 3), .cells: list of (type, nodes), .groups: name -> cells, .orders, .instants"""

    def __init__(self, base, label):
        self.base = pathlib.Path(base)
        self.index = h5py.File(self.base / identifier_of(base, label) / "index.h5", "r")
        self.orders = self.index["order"][()].tolist()
        self.instants = dict(zip(self.orders, self.index["instant"][()].tolist()))
        mesh = MeshOfBase(self.base / f"{self.index.attrs['mesh']}.h5")
        self.points, self.cells, self.groups, self.patches = mesh.points, mesh.cells, mesh.groups, mesh.patches

    def _file(self, name, order):
        entry = self.index[f"fields/{name}"]
        return h5py.File(self.base / entry["file"].asstr()[entry["order"][()].tolist().index(order)], "r")

    def field(self, name, order):
        """@return (support, component -> values); rows of nodes or cells"""
        with self._file(name, order) as file:
            return file["support"][()], dict(zip(file.attrs["components"], file["values"][()].T))

    def where_present(self, name, order, component):
        """The values of the places where the component exists."""
        with self._file(name, order) as file:
            column = list(file.attrs["components"]).index(component)
            values = file["values"][:, column]
            return values[file["present"][:, column] != 0] if "present" in file else values

    def parameter(self, name):
        """One value an instant."""
        return self.index[f"parameters/{name}"][()]

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


def _ragged(group, values):
    offset, items = group["offset"][()], group[values][()]
    return [items[a:b] for a, b in zip(offset[:-1], offset[1:])]
