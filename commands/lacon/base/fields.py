"""Fields of results and of their own, read from their files; docs/structures.md section 3."""

from ..core.catalog import part
from ..core.hdf5 import text, texts
from ..core.late import numpy
from ..core.messages import fail
from . import contents


class FieldData:
    """A field at one instant.

    support (n) node or cell numbers, offset (n + 1) or None, values (r, c), present (r, c) of bool: row r of cell support[i] for
    offset[i] <= r < offset[i + 1]. `counted` (r, c) of bool: of what is present the values that enter extrema, sums, means and
    norms, `marked` of those that are no value (JEU = -1 without a master). A field of functions has their ids in `functions`, and indices into that list as values.
    """

    def __init__(self, file):
        self.name, self.quantity, self.location = (text(file.attrs[key]) for key in ("name", "quantity", "location"))
        self.mesh_id = text(file.attrs["mesh"])
        self.components, self.functions = texts(file, "components"), texts(file, "functions")
        self.support = file["support"][:]
        self.offset = file["offset"][:] if "offset" in file else None
        self.values = file["values"][:]
        presence = file["present"][:] if "present" in file else numpy.ones(self.values.shape, numpy.uint8)
        self.present, self.counted = presence != 0, presence == 1
        self.marked = presence == 3

    def type(self):
        """"NOEU_DEPL_R\""""
        return f"{self.location}_{self.quantity}"

    def rows(self):
        """(owner of each row: node or cell number; its place in it: point, or node of the cell), from 0"""
        if self.offset is None:
            return self.support, numpy.zeros(len(self.support), int)
        counts = numpy.diff(self.offset)
        return numpy.repeat(self.support, counts), numpy.arange(len(self.values)) - numpy.repeat(self.offset[:-1], counts)

    def on_nodes(self, count, counted=False):
        """(values, mask) over all `count` nodes of the mesh; mask is true where the component exists, or where it is counted."""
        values = numpy.zeros((count, len(self.components)))
        mask = numpy.zeros(values.shape, bool)
        values[self.support], mask[self.support] = self.values, self.counted if counted else self.present
        return values, mask

    def magnitude(self, component, count):
        """Of a field of nodes one value for each of `count` nodes: a component, or the root of the sum of the squares of all; nan where it is not."""
        values, mask = self.on_nodes(count)
        if component is not None:
            column = self.components.index(component)
            return numpy.where(mask[:, column], values[:, column], numpy.nan)
        return numpy.where(mask.any(axis=1), numpy.linalg.norm(values, axis=1), numpy.nan)

    def component(self, name):
        """(owners, values) of the rows where a component exists."""
        column = self.components.index(name)
        rows = self.present[:, column]
        return self.rows()[0][rows], self.values[rows, column]


def check_place(path, file, name, order):
    """@throws AsterError BASE_7 where the file is that of another field, or of another order number"""
    expected = part("field_of_order", field=name, order=order)
    is_field = "name" in file.attrs and "order" in file.attrs
    found = part("field_of_order", field=text(file.attrs["name"]), order=int(file.attrs["order"])) if is_field else contents.holds(file)
    if found != expected:
        fail("BASE_7", file=path, found=found, expected=expected)
