"""Lacon from Python: what a base holds as arrays and pictures, and studies as functions. docs/python.md.

    >>> import lacon
    >>> base = lacon.open("study.base")
    >>> base["RESULT"].contact().pressure.max()

The package is the launcher's too: start reading in main.py.
"""

import importlib

version = "0.1.0"

#: name -> module of this package that has it; imported when it is first asked for, so that the launcher starts quickly
_offered = {"open": "reader.base:open_base", "Base": "reader.base:Base", "Mesh": "reader.mesh:Mesh", "States": "reader.result:States",
            "Result": "reader.result:Result", "FailedStep": "reader.result:FailedStep", "Field": "reader.result:Field",
            "Patches": "reader.result:Patches", "run_study": "run.session:run_study", "Run": "run.session:Run",
            "RunFailed": "run.session:RunFailed", "Study": "run.session:Study", "Error": "core.messages:AsterError"}
__all__ = [*_offered, "version"]


def __getattr__(name):
    if name not in _offered:
        raise AttributeError(f"module 'lacon' has no attribute '{name}'")
    module, _, attribute = _offered[name].partition(":")
    return getattr(importlib.import_module(f".{module}", __name__), attribute)


def __dir__():
    return sorted(__all__)
