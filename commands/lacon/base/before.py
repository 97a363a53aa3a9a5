"""Copies of concepts that `reuse=` is about to change: there from before the operator runs until the registry tells what it has made.

A launcher that is killed in between leaves the copy, which the next run puts back: the command that was under way is lost, and no half of it stays.
"""

import os
import shutil

_suffix = ".before.partial"


def _copy(base, identifier):
    path = base.path(identifier)
    return path.with_name(path.name + _suffix)


def keep(base, identifier):
    """A second link to the file of a concept; give it to put_back() or remove it."""
    copy = _copy(base, identifier)
    copy.unlink(missing_ok=True)
    try:
        os.link(base.path(identifier), copy)
    except OSError:
        shutil.copy2(base.path(identifier), copy)
    return copy


def has_changed(base, identifier, copy):
    """Whether an operator that failed has stored the concept, or changed the one that `copy` is of; None where there was none."""
    path = base.path(identifier)
    return path.exists() and not (copy and os.stat(path).st_mtime_ns == os.stat(copy).st_mtime_ns)


def put_back(base, identifier, copy):
    os.replace(copy, base.path(identifier))


def put_back_all(base):
    """Where a run was killed: concepts that hold what the registry does not tell are what they were before. A result whose computation had begun is
    left: its order goes on with it (unfinished.py)."""
    told = base.kept.stand()
    for identifier in base.ids():
        copy = _copy(base, identifier)
        if not copy.exists() or identifier in base.unfinished.ids():
            continue
        if identifier in told:
            copy.unlink()  # killed behind the registry: the next one must not find it
        else:
            put_back(base, identifier, copy)
