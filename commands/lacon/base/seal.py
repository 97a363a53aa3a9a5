"""Seals of the files of a base, docs/structures.md section 1: what `structures/seal.cpp` is for operators."""

import functools
import struct

from ..core.hdf5 import text
from ..core.late import h5py, numpy
from ..core.messages import fail

_newest = {"result": 2}  #: format of the files of a base that is written, and read with those before; of others 1
_mark = b"LACONSUM"
_length = 32
_part = 1 << 23  #: bytes at a time

#: what reading a file throws that is not laid out as it should be
_damage = (OSError, KeyError, ValueError, TypeError, IndexError, AttributeError, RuntimeError)

_known = {}  #: path -> the state of the file that was looked at last


class _Sums:
    def __init__(self):
        self.sum = self.sum_of_sums = numpy.uint64(0)

    def add(self, content):
        """@param content bytes; of a whole number of words but for the last ones"""
        words = numpy.frombuffer(content + bytes(-len(content) % 8), "<u8")
        with numpy.errstate(over="ignore"):
            ranks = numpy.arange(len(words), 0, -1, dtype=numpy.uint64)
            self.sum_of_sums += numpy.uint64(len(words)) * self.sum + (ranks * words).sum(dtype=numpy.uint64)
            self.sum += words.sum(dtype=numpy.uint64)

    def seal(self, length):
        return _mark + struct.pack("<QQQ", length, int(self.sum), int(self.sum_of_sums))


def of(content):
    """The seal of the content of a file."""
    sums = _Sums()
    sums.add(content)
    return sums.seal(len(content))


def open_checked(path):
    """An h5py.File to be read, whose content is that of its seal. @throws AsterError BASE_5, BASE_6, STUDY_7"""
    try:
        opened = (h5py.File if _is_sealed(path) else _unsealed())(path, "r")
    except OSError as error:
        fail("STUDY_7", file=path, reason=error)
    try:
        written, newest = int(opened.attrs.get("format", 1)), _newest.get(text(opened.attrs.get("lacon_type", "")), 1)
    except _damage:
        opened.close()
        fail("BASE_5", file=path)
    if not 1 <= written <= newest:
        opened.close()
        fail("BASE_6", file=path, format=written, known=newest)
    return opened


def has_mark(path):
    """Whether a file ends with a seal, be it that of its content or not."""
    try:
        with open(path, "rb") as file:
            file.seek(-_length, 2)
            return file.read().startswith(_mark)
    except OSError:  # one that is shorter too
        return False


def _is_sealed(path):
    """Whether a file has a seal. @throws AsterError BASE_5 where its content is another one, OSError"""
    with open(path, "rb") as file:
        length = file.seek(0, 2) - _length
        file.seek(max(length, 0))
        found = file.read()
        about = path.stat()
        state = about.st_ino, about.st_size, about.st_mtime_ns
        file.seek(0)
        sealed = found.startswith(_mark) or _is_longer_than_its_content(file.read(48), length + _length)
        if sealed and _known.get(path) != state:
            sums = _Sums()
            file.seek(0)
            for first in range(0, length, _part):
                sums.add(file.read(min(_part, length - first)))
            if found != sums.seal(length):
                fail("BASE_5", file=path)
            _known[path] = state
    return sealed


def _is_longer_than_its_content(head, size):
    """Whether a file is longer than HDF5 says that it is: so it had a seal, whatever is there now. HDF5 cuts off what it does not know where it changes a
    file; a disk that loses power may leave zeros. @param head its first 48 bytes"""
    return head.startswith(b"\x89HDF\r\n\x1a\n\0") and len(head) == 48 and size > int.from_bytes(head[40:], "little")


@functools.cache
def _unsealed():
    class Unsealed(h5py.File):
        """A file without seal: `with` tells what reading it throws as damage."""

        def __exit__(self, kind, error, trace):
            path = self.filename
            super().__exit__(kind, error, trace)
            if isinstance(error, _damage):
                fail("BASE_5", file=path)

    return Unsealed
