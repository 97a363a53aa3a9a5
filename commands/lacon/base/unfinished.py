"""Results whose computation has begun and not come to its end. Their index grows with each instant that is archived: whatever ends the run,
they are found under the variable they were to go to; and an operator that gets the same order goes on from their restart record.

Registry, key "unfinished": id -> {"label", "key": that of the order, see kept.py, "at": the version that it enriches, "where"}.
"""

from ..core.concepts import type_of
from . import contents


class Unfinished:
    """The entries of one open base."""

    def __init__(self, base):
        self.base = base

    @property
    def _entries(self):
        return self.base.registry.get("unfinished", {})  # without any the registry of a base is what it was before

    def begin(self, identifier, label, key, at, where, resumes):
        if not resumes:
            self.drop_record(identifier)  # of another order that enriched the same result
        self.replace_failed(identifier, label)
        self.base.registry.setdefault("unfinished", {})[identifier] = {"label": label, "key": key, "at": at, "where": where}
        self.base.write(where)

    def replace_failed(self, identifier, label):
        """This result takes the place of one of the same name that failed before any instant."""
        for other in [i for i in self.without_instants() if i != identifier and self._entries[i]["label"] == label]:
            self.base.drop(other)

    def end(self, identifier):
        """The computation is at its end, or nothing is left of it. Its record goes when the registry that says so is written."""
        self._entries.pop(identifier, None)
        if not self._entries:
            self.base.registry.pop("unfinished", None)

    def drop_record(self, identifier):
        """Remove the restart record of a result."""
        for path in (self.base.folder / identifier).glob("restart*.h5"):
            path.unlink(missing_ok=True)

    def find(self, kind, key):
        """The id of the one that an order of this key has begun; nothing where there is none, or nothing is taken up."""
        if key is None or not self.base.kept.look:
            return None
        return next((i for i, entry in self._entries.items() if type_of(i) == kind and entry["key"] == key), None)

    def version(self, identifier):
        """(version that it enriches, key of the order), nothing where there is none"""
        entry = self._entries.get(identifier, {})
        return [(entry["at"], entry["key"])] if entry.get("at") is not None else []

    def without_instants(self):
        """id -> label of those that have failed before any instant was solved: of them there are but the iterates of that step."""
        return {identifier: entry["label"] for identifier, entry in self._entries.items()
                if not self.base.path(identifier).exists() and self.base.failed_step(identifier).exists()}

    def ids(self):
        return set(self._entries)

    def labels(self):
        """label -> id of those that have instants"""
        return {entry["label"]: identifier for identifier, entry in self._entries.items()
                if entry["label"] and self.base.path(identifier).exists()}

    def found(self):
        """(label, last instant, where it was computed) of those that a study finds again."""
        for label, identifier in self.labels().items():
            with self.base.open(identifier) as file:
                if not contents.is_complete(file):
                    yield label, contents.instants(file)[-1][1], self._entries[identifier]["where"]
