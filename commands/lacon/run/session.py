"""Studies from Python: run_study() for command files, Study for commands as functions of a program or a notebook."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile

from ..core import catalog, current, messages, outcome
from ..core.concepts import CO, Concept, _F
from ..reader.base import open_base
from . import execution, study

_package = pathlib.Path(__file__).resolve().parents[2]


class Run:
    """What a run of command files came to: `status` (0 done, 2 an error of the user, 3 the solution failed, 4 internal error or interrupted, 5 a check is NOOK),
    `diagnostic`, `output` and `log` (what it has said), `checks` (of TEST_RESU, dictionaries), `base` (None where there is none)."""

    def __init__(self, status, output, log, report, folder):
        self.status, self.output, self.log = status, output, log
        self.checks, self.diagnostic = report.get("checks", []), report.get("diagnostic", "")
        self.base = open_base(folder) if (folder / "base.json").exists() else None

    def __repr__(self):
        checks = f", {len(self.checks)} checks" if self.checks else ""
        return f"<run: {self.diagnostic or 'status ' + str(self.status)}{checks}; {self.base!r}>"


class RunFailed(Exception):
    """A run did not end well; `run` is the Run."""

    def __init__(self, run):
        self.run = run
        super().__init__(run.log.strip() or run.output.strip()[-2000:] or f"exit status {run.status}")


def run_study(*files, units=None, base=None, fresh=False, threads=None, check=True):
    """Run command files, or one export file, in a process of their own, as `lacon FILE ...` does.

    @param units number -> file  @param base folder; otherwise STUDY.base beside the first file  @param fresh empty the base first
    @param check throw RunFailed where it does not end well  @return a Run
    """
    folder = pathlib.Path(base or pathlib.Path(files[0]).with_suffix(".base"))
    arguments = [*map(os.fspath, files), "--base", os.fspath(folder)]
    for number, path in (units or {}).items():
        arguments += ["--unit", f"{number}={os.fspath(path)}"]
    arguments += ["--fresh"] if fresh else []
    arguments += ["--threads", str(threads)] if threads else []
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, [str(_package), os.environ.get("PYTHONPATH", "")]))}
    with tempfile.TemporaryDirectory(prefix="lacon_run_") as scratch:
        report = pathlib.Path(scratch) / "report.json"
        done = subprocess.run([sys.executable, "-m", "lacon", *arguments, "--json", report], env=environment, capture_output=True, text=True,
                              errors="replace", stdin=subprocess.DEVNULL, check=False)
        said = json.loads(report.read_text(encoding="utf-8")) if report.exists() else {}
    came = Run(done.returncode, done.stdout, done.stderr, said, folder)
    if check and came.status != outcome.done:
        raise RunFailed(came)
    return came


class Study:
    """Commands as functions of a Python program, on a base of their own::

        with lacon.Study("press.base", units={20: "press.med"}) as study:
            mesh = study.LIRE_MAILLAGE(UNITE=20)

    It begins with DEBUT and ends with FIN. A concept is called after the variable it is assigned to, as in a command file; a command that fails throws
    lacon.Error. One study at a time.
    """

    def __init__(self, base, units=None, fresh=False, threads=None, quiet=True):
        """@param base folder of the base  @param units number -> file  @param fresh empty the base first  @param quiet print messages alone"""
        self._study = study.Study(pathlib.Path(base), {k: os.fspath(v) for k, v in (units or {}).items()}, fresh, threads)
        self._study.quiet = quiet
        self._commands = execution.all_commands()
        self._made = 0
        self.F, self.CO = _F, CO

    def __enter__(self):
        if current.study is not None:
            raise RuntimeError("another study is open: end it first")
        current.study = self._study
        try:
            self._commands["DEBUT"]()
        except BaseException:
            self._close()
            raise
        return self

    def __exit__(self, kind, *_):
        try:
            if kind is None and self._study.open:
                self._commands["FIN"]()
        finally:
            self._close()

    def _close(self):
        try:
            self._study.close()
        finally:
            current.study = None

    @property
    def base(self):
        """The base as lacon.open() shows it."""
        return open_base(self._study.base_folder)

    @property
    def checks(self):
        """What TEST_RESU has found so far."""
        return self._study.checks

    def __dir__(self):
        return [*super().__dir__(), *catalog.command_names()]

    def __getattr__(self, name):
        if name.startswith("_") or name not in self._commands:
            raise AttributeError(f"there is no command {name}")
        command = self._commands[name]

        def call(**keywords):
            made = command(**keywords)
            if isinstance(made, Concept):
                self._name(made)
            return made

        call.__name__, call.__doc__ = name, command.__doc__
        return call

    def _name(self, made):
        """A concept is one of the study's as long as the study lasts; without a variable it is called after its type."""
        if not made.label.isidentifier():
            self._made += 1
            made.label = f"{made.type}_{self._made}"
        self._study.names.values[made.label] = made


Error = messages.AsterError
