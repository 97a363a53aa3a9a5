"""numpy, h5py and others, imported when something of them is first asked for: a launcher that only starts operators does not pay for them.
Files beside the command file that have names of Python's own modules do not get into their way."""

import contextlib
import os
import resource
import sys


_folders = set()  #: of command files


def look_in(folder):
    """Have command files find modules in this folder first."""
    _folders.add(folder)
    if folder not in sys.path:
        sys.path.insert(0, folder)


@contextlib.contextmanager
def _without_folders():
    """Imports find what Python has, not copy.py or logging.py beside the command file, also where this has imported it already."""
    path = sys.path[:]
    hidden = {name: module for name, module in list(sys.modules.items())
              if name.partition(".")[0] in sys.stdlib_module_names and os.path.dirname(getattr(module, "__file__", None) or "") in _folders}
    sys.path[:] = [folder for folder in path if os.path.abspath(folder) not in _folders]
    for name in hidden:
        del sys.modules[name]
    try:
        yield
    finally:
        sys.path[:] = path
        sys.modules.update(hidden)


class _Late:
    """Stands for a module, and has everything in it once it is imported."""

    def __init__(self, name):
        self._name = name

    def __getattr__(self, attribute):
        module = self._module()
        vars(self).update(vars(module))
        return getattr(module, attribute)

    def _module(self):
        """The module itself. Its BLAS starts no threads: nothing here computes much, and starting them costs more than the import."""
        before = os.environ.get("OPENBLAS_NUM_THREADS")
        if before is None:
            os.environ["OPENBLAS_NUM_THREADS"] = "1"
        try:
            with _without_folders():
                __import__(self._name)
                return sys.modules[self._name]
        except ImportError as error:
            if "failed to map segment" in str(error) and resource.getrlimit(resource.RLIMIT_AS)[0] != resource.RLIM_INFINITY:  # ulimit -v
                raise MemoryError from None
            raise
        finally:
            if before is None:
                os.environ.pop("OPENBLAS_NUM_THREADS", None)


numpy, h5py, subprocess = _Late("numpy"), _Late("h5py"), _Late("subprocess")


def load():
    """Import those that read results now, while there is time."""
    return h5py.File, numpy.array
