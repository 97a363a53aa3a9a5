"""numpy and h5py, imported when something of them is first asked for: a launcher that only starts operators does not pay for them."""

import os
import resource
import sys


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
            __import__(self._name)
            return sys.modules[self._name]
        except ImportError as error:
            if "failed to map segment" in str(error) and resource.getrlimit(resource.RLIMIT_AS)[0] != resource.RLIM_INFINITY:  # ulimit -v
                raise MemoryError from None
            raise
        finally:
            if before is None:
                os.environ.pop("OPENBLAS_NUM_THREADS", None)


numpy, h5py = _Late("numpy"), _Late("h5py")


def load():
    """Import both now, while there is time."""
    return h5py.File, numpy.array
