"""h5py, imported on first use: a launcher that only starts operators does not pay for it."""

import os

_module = None


def h5py():
    """The module. Its BLAS starts no threads: nothing here computes, and starting them costs more than the import."""
    global _module
    if _module is None:
        before = os.environ.get("OPENBLAS_NUM_THREADS")
        if before is None:
            os.environ["OPENBLAS_NUM_THREADS"] = "1"
        try:
            import h5py as module
        finally:
            if before is None:
                os.environ.pop("OPENBLAS_NUM_THREADS", None)
        _module = module
    return _module


def text_type():
    return h5py().string_dtype("utf-8")
