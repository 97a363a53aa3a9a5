"""Files that are written wholly or not at all; second names of files."""

import contextlib
import errno
import os
import shutil


@contextlib.contextmanager
def whole(path):
    """`with whole(path) as partial:` write the file `partial`; behind it, the file has its name. Whatever goes wrong removes it and goes on.

    A device, as /dev/stdout, which a renamed file would replace, is written itself; a link stays one, and the file that it means is written.
    """
    path = os.path.realpath(path)
    if os.path.exists(path) and not os.path.isfile(path):
        yield path
        return
    partial = f"{path}.partial"
    try:
        yield partial
        os.replace(partial, path)
    except BaseException:
        with contextlib.suppress(OSError):
            os.unlink(partial)
        raise


def write_whole(path, text):
    """A text file in UTF-8. @throws OSError"""
    with whole(path) as partial, open(partial, "w", encoding="utf-8") as file:
        file.write(text)


def why_not_written(path):
    """What the system says to who would write a file here; None where nothing is in the way."""
    path = os.path.realpath(path)
    folder = os.path.dirname(path)
    if os.path.isdir(path):
        return os.strerror(errno.EISDIR)
    if not os.path.isdir(folder):
        return os.strerror(errno.ENOENT)
    is_device = os.path.exists(path) and not os.path.isfile(path)
    return None if is_device or os.access(folder, os.W_OK) else os.strerror(errno.EACCES)


def is_readable(path):
    """Whether a file gives its first byte: the rights alone do not say so, of a disk that fails or of a file of /proc."""
    try:
        with open(path, "rb") as file:
            file.read(1)
        return True
    except OSError:
        return False


def link(source, target):
    """Give a file a second name, or a copy where the file system has no such thing; what has the name is replaced."""
    target.parent.mkdir(exist_ok=True)
    partial = target.with_name(target.name + ".link.partial")
    partial.unlink(missing_ok=True)
    try:
        os.link(source, partial)
    except OSError:
        shutil.copy2(source, partial)
    os.replace(partial, target)
