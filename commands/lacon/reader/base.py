"""A base that is looked at: `lacon.open("study.base")`."""

import pathlib

from ..base.base import look_into, once
from ..core.catalog import part
from ..core.messages import fail
from .mesh import Mesh
from .result import FailedStep, Result


class Base:
    """The meshes and results of a base by the variable of the study, base["MESH"]; also of a run in progress: what is there is looked up each time."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self._meshes = {}
        self._registered()

    def _registered(self):
        """The base as it is now. @throws AsterError READER_7, STUDY_6"""
        return look_into(self.folder, "lacon")

    def _labels(self, kind):
        base = self._registered()
        return base, base.labels(kind)

    @property
    def running(self):
        """{"process", "since"} of the run that uses the base now; None where there is none."""
        return self._registered().running()

    def needs(self, path):
        """Whether a file is one of this folder, or one that its study reads: no tool may replace it."""
        return self._registered().needs(path)

    @property
    def meshes(self):
        """label -> Mesh"""
        base, labels = self._labels("mesh")
        return {label: self._mesh(base, identifier, label) for label, identifier in labels.items()}

    @property
    def results(self):
        """label -> Result, those in progress among them; not one that a newer computation of this name, which solved no instant, was to replace"""
        base, labels = self._labels("result")
        failed = base.unfinished.without_instants().values()
        return {label: Result(_Files(self, base), identifier, label) for label, identifier in labels.items() if label not in failed}

    @property
    def failed_steps(self):
        """label -> FailedStep, of results that have no instant; one that has instants has it as `failed_step`."""
        base = self._registered()
        files = _Files(self, base)
        steps = {label: FailedStep(files, identifier, label) for identifier, label in base.unfinished.without_instants().items()}
        return {label: step for label, step in steps.items() if files.has_mesh_of(step)}

    def __getitem__(self, label):
        """The mesh or result of a label; of a computation that solved no instant the step that failed. @throws AsterError READER_1"""
        known = {**self.meshes, **self.results, **self.failed_steps}
        if label not in known:
            fail("READER_1", "lacon", label=label, folder=self.folder, known=", ".join(known) or part("none"))
        return known[label]

    def only_result(self, label=None):
        """The result of this label, or the one that there is: a solution or the step that failed, beside courses of temperatures.
        @throws AsterError READER_1, READER_5, READER_8"""
        if label:
            return self[label]
        found = self.results
        results = once({**{name: result for name, result in found.items() if "DEPL" in result.fields}, **self.failed_steps} or found)
        if not results:
            fail("READER_8", "lacon", folder=self.folder, reason=part("no_result_yet" if self.running else "no_result_left"))
        if len(results) > 1:
            fail("READER_5", "lacon", folder=self.folder, count=len(results), known=", ".join(results))
        return next(iter(results.values()))

    def __repr__(self):
        return f"<base {self.folder}: meshes {', '.join(self.meshes) or 'none'}; results {', '.join(self.results) or 'none'}>"

    def _mesh(self, base, identifier, label):
        """The same object as long as the file is the same."""
        path = base.path(identifier)
        state = identifier, path.stat().st_mtime_ns if path.exists() else 0  # to open one that is gone says so
        if state not in self._meshes:
            self._meshes[state] = Mesh(lambda: base.open(identifier), label)
        return self._meshes[state]


class _Files:
    """What a Result reads from."""

    def __init__(self, shown, base):
        self._shown, self._base = shown, base
        self.folder, self.open, self.failed_step = base.folder, base.open, base.failed_step

    def has_mesh_of(self, states):
        return self._base.path(states.mesh_id).exists()

    def mesh_of(self, identifier):
        return self._shown._mesh(self._base, identifier, self._base.label_of(identifier) or identifier)


def open_base(folder):
    """The base of a study, `study.base`. @throws AsterError READER_7 where there is none, STUDY_6 where it cannot be read"""
    return Base(folder)
