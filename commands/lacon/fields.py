"""Fields of results, read from their files; docs/structures.md section 3."""

import json


class Field:
    """A field at one instant.

    support (n) node or cell numbers, offset (n + 1) or None, values (r, c), present (r, c) of bool: row r of cell support[i] for
    offset[i] <= r < offset[i + 1].
    """

    def __init__(self, base, name, mesh, location, components, support, offset, values, present):
        self.base = base
        self.name = name
        self.mesh_id = mesh
        self.location = location
        self.components = components
        self.support = support
        self.offset = offset
        self.values = values
        self.present = present

    def mesh(self):
        return self.base.concept(self.mesh_id)

    def __repr__(self):
        return f"<field {self.name} ({self.location}) {', '.join(self.components)}>"

    def toSimpleFieldOnNodes(self):
        return SimpleField(self, "coordinates")

    def toSimpleFieldOnCells(self):
        return SimpleField(self, "cells/type")


class SimpleField:
    """A field as two arrays over the whole mesh."""

    def __init__(self, field, dataset):
        self._field = field
        self._dataset = dataset

    def getComponents(self):
        return list(self._field.components)

    def getValues(self):
        """@return (values, mask), both (nodes or points, components); mask is true where the component exists"""
        import numpy

        field = self._field
        if field.offset is not None:
            return field.values, field.present
        with field.mesh().open() as file:
            count = file[self._dataset].shape[0]
        values = numpy.zeros((count, len(field.components)))
        mask = numpy.zeros(values.shape, bool)
        values[field.support] = field.values
        mask[field.support] = field.present
        return values, mask


def read_field(base, path):
    """The field of a file, `path` relative to the base."""
    import numpy

    from .hdf5 import h5py
    from .messages import fail

    try:
        file = h5py().File(base.folder / path, "r")
    except OSError as error:
        fail("STUDY_7", file=base.folder / path, reason=error)
    with file:
        values = file["values"][:]
        if "present" in file:
            present = file["present"][:].astype(bool)
        else:
            present = numpy.ones(values.shape, bool)
        components = file.attrs["components"]
        components = json.loads(components) if isinstance(components, str) else [
            c.decode() if isinstance(c, bytes) else str(c) for c in components]
        return Field(base, file.attrs["name"], file.attrs["mesh"], file.attrs["location"], components, file["support"][:],
                     file["offset"][:] if "offset" in file else None, values, present)
