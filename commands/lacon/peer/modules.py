"""What `import code_aster` finds: modules with the commands under the peer's names."""

import contextlib
import importlib.machinery
import sys
import types

from ..commands import checks
from ..core import current, labels, messages
from ..tables.table import Table
from .meshes import NewMesh


class TestCase:
    """code_aster's CA.TestCase: assertions that count as checks. A failed one is NOOK and does not stop the study."""

    def __init__(self):
        self._checks = []

    def __getattr__(self, name):
        import unittest  # start-up

        if not name.startswith("assert") or not hasattr(unittest.TestCase, name):
            raise AttributeError(f"CA.TestCase has no {name}")
        return lambda *arguments, **keywords: self._assert(name, arguments, keywords)

    def _assert(self, method, arguments, keywords):
        """Call a method of unittest's. @return what has to be entered with `with`, where it is called without a function"""
        import unittest  # start-up

        where = labels.location(labels.user_frame())
        value = arguments[0] if arguments and isinstance(arguments[0], (int, float)) else 0
        failure = None
        try:
            made = getattr(unittest.TestCase(), method)(*arguments, **keywords)
        except AssertionError as error:
            made, failure = None, error
        if not hasattr(made, "__exit__"):
            self._record(method, where, value, failure)
            return None

        @contextlib.contextmanager
        def block():
            failure = None
            try:
                with made as context:
                    yield context
            except AssertionError as error:
                failure = error
            self._record(method, where, value, failure)

        return block()

    def _record(self, method, where, value, failure):
        check = checks.Check(where, "assert", "", method[6:], "", None, "", value)
        met = checks.Judgement(1 if failure else 0, 0, 0, "ABSOLU")
        check.judge(met, met, "assertion", False)
        current.study.progress(f"NOOK {method} {where} {failure}" if failure else f"OK   {method} {where}")
        current.study.checks.append(check)
        self._checks.append(check)

    def printSummary(self):
        """The number of assertions so far; they are in the run's own summary too."""
        current.study.progress(f"assertions: {checks.summary(self._checks)}")


class _OneProcess:
    """The communicator of a command file, which is one process."""

    def Get_rank(self):
        return 0

    def Get_size(self):
        return 1

    rank, size = property(Get_rank), property(Get_size)

    def Barrier(self):
        pass


class OtherFailure(messages.SolutionError):
    """What code_aster tells apart in an `except` and Lacon never raises: laws are integrated exactly, contact has no loop of its own."""


#: code_aster's names of exceptions in CA and libaster, and those of its module aster, for versions before 15
_exceptions = {
    "AsterError": messages.AsterError, "AsterException": messages.AsterError, "ConvergenceError": messages.ConvergenceError,
    "SolverError": messages.SolutionError, "IntegrationError": OtherFailure, "ContactError": OtherFailure, "TimeLimitError": OtherFailure,
    "SolutionError": messages.SolutionError, "InternalError": messages.InternalError}
_former_exceptions = {
    "error": messages.AsterError, "FatalError": messages.AsterError, "NonConvergenceError": messages.ConvergenceError,
    "MatriceSinguliereError": messages.SolutionError, **dict.fromkeys(
        ("EchecComportementError", "BoucleContactError", "BoucleGeometrieError", "TraitementContactError", "MatriceContactSinguliereError",
         "ArretCPUError"), OtherFailure)}


class _Modules:
    """Finds the modules of code_aster that are made when they are imported, and says so for those that Lacon does not have."""

    _tensors = "code_aster.MacroCommands.Contrib."
    #: where code_aster has its Table, before version 15 and since
    tables = {"Utilitai.Table", "code_aster.Objects.table_py"}
    packages = {"code_aster.MacroCommands", "code_aster.MacroCommands.Contrib", "Utilitai", "code_aster.Objects"}
    made = packages | tables | {_tensors + "TensorModule", _tensors + "HookeTensor"}
    missing = {"code_aster", "Contrib", "Execution", "Macro", "Messages", "Miss", "Noyau", "Utilitai", "aster_core",
               "aster_fonctions", "run_aster"}

    def find_spec(self, name, path=None, target=None):
        if name in self.made:
            return importlib.machinery.ModuleSpec(name, self, is_package=name in self.packages)
        if name.partition(".")[0] in self.missing:
            raise ModuleNotFoundError(f"the module {name} is part of code_aster, and Lacon does not have it", name=name)
        return None

    def create_module(self, spec):
        return None

    def exec_module(self, module):
        if module.__name__ in self.tables:
            module.Table = Table
        if module.__name__.startswith(self._tensors):
            from . import tensors  # needs sympy

            vars(module).update({k: v for k, v in vars(tensors).items() if not k.startswith("__")})


def _utility(name):
    """code_aster.Utilities.sympy, where sympy is installed."""
    if name != "sympy":
        raise AttributeError(f"code_aster.Utilities has no {name} in Lacon")
    import sympy  # optional

    return sympy


def _module(name, content):
    """Make a module importable. What it does not have is refused by name."""
    module = types.ModuleType(name)
    vars(module).update(content)
    module.__all__ = sorted(content)

    def missing(attribute):
        raise AttributeError(f"{name} has no {attribute} in Lacon")

    module.__getattr__ = missing
    sys.modules[name] = module
    return module


def install(names):
    """Make the modules importable. `names`: every command, _F and CO."""
    syntax = {name: names[name] for name in ("_F", "CO")}

    def init(*options, **keywords):
        keywords.pop("CODE", None)
        return names["POURSUITE" if "--continue" in options else "DEBUT"](**keywords)

    def close(**keywords):
        return names["FIN"](**keywords)

    ca = _module("code_aster.CA", {**_exceptions, "TestCase": TestCase, "init": init, "close": close, "MPI": types.SimpleNamespace(ASTER_COMM_WORLD=_OneProcess()), "Mesh": lambda: NewMesh(names)})
    commands = _module("code_aster.Commands", names)
    utilities = _module("code_aster.Utilities", {})
    utilities.__getattr__ = _utility
    # until version 14
    cata = _module("code_aster.Cata", {})
    cata.Syntax, cata.Commands = _module("code_aster.Cata.Syntax", syntax), _module("code_aster.Cata.Commands", names)
    former = _module("Cata", {})
    former.cata = _module("Cata.cata", names)
    _module("Accas", syntax)
    _module("aster", {**_former_exceptions, "affiche": lambda unit, text: current.study.progress(text)})
    _module("libaster", _exceptions)
    root = types.ModuleType("code_aster", "The commands of Lacon under code_aster's name.")
    vars(root).update({name: vars(ca)[name] for name in ca.__all__})  # code_aster.TestCase of version 15
    root.CA, root.Commands, root.Utilities, root.Cata = ca, commands, utilities, cata
    sys.modules["code_aster"] = root
    for package in (root, cata, former):
        package.__path__ = []
    sys.meta_path.append(_Modules())
    return ca
