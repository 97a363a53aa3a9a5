"""Texts and lists of lists in HDF5 files, as docs/structures.md lays them out."""

import json

from .late import h5py


def text_type():
    """The type of variable-length UTF-8 texts."""
    return h5py.string_dtype("utf-8")


def text(value):
    """An attribute that is a text."""
    return value.decode() if isinstance(value, bytes) else str(value)


def texts(file, name):
    """A list of texts that an attribute of a file or group holds."""
    found = file.attrs.get(name, ())
    return json.loads(found) if isinstance(found, str) else list(map(text, found))


def ragged(group, name="values"):
    """Lists of different lengths: those that `offset` cuts the data set `name` into."""
    offset, items = group["offset"][:], group[name][:]
    return [items[first:last] for first, last in zip(offset[:-1], offset[1:])]
