"""Tables in HDF5 files: docs/structures.md, section 2."""

from ..core.hdf5 import text_type
from ..core.late import numpy
from .table import Table


def write_table(group, table):
    """Store a table in an HDF5 group."""
    group.attrs["title"] = table.titr
    group.create_dataset("columns", data=table.para, dtype=text_type())
    group.create_dataset("types", data=table.type, dtype=text_type())
    for k, (name, kind) in enumerate(zip(table.para, table.type)):
        values = [row.get(name) for row in table.rows]
        present = numpy.array([v is not None for v in values], numpy.uint8)
        empty = {"I": 0, "R": 0.0, "K": ""}[kind[0]]
        group.create_dataset(f"values/{k}", data=[empty if v is None else v for v in values],
                             dtype={"I": "i8", "R": "f8", "K": text_type()}[kind[0]])
        if not present.all():
            group.create_dataset(f"present/{k}", data=present)


def read_table(group):
    """The table of an HDF5 group."""
    columns = {}
    kinds = group["types"].asstr()[:]
    for k, name in enumerate(group["columns"].asstr()[:]):
        data = group[f"values/{k}"]
        values = data.asstr()[:].tolist() if kinds[k][0] == "K" else data[:].tolist()
        if f"present/{k}" in group:
            values = [v if there else None for v, there in zip(values, group[f"present/{k}"][:])]
        columns[str(name)] = (str(kinds[k]), values)
    return Table.of_columns(columns, group.attrs["title"])


def make(call, table):
    """The table concept that a command makes."""
    return call.write("table", lambda file: write_table(file, table))
