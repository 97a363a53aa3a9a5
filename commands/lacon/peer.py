"""What `import code_aster` finds: modules with the commands under the peer's names."""

import sys
import types

from . import messages


class TestCase:
    """code_aster's CA.TestCase: assertions that count as checks. A failed one is NOOK and does not stop the study."""

    def __init__(self):
        self._checks = []

    def __getattr__(self, name):
        import unittest

        if not name.startswith("assert") or not hasattr(unittest.TestCase, name):
            raise AttributeError(f"CA.TestCase has no {name}")
        return lambda *arguments, **keywords: self._assert(name, arguments, keywords)

    def _assert(self, method, arguments, keywords):
        """Call a method of unittest's. @return what has to be entered with `with`, where it is called without a function"""
        import contextlib
        import unittest

        from . import labels

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
        from . import checks, study

        check = checks.Check(where, "assert", "", method[6:], "", None, "", value)
        met = checks.Judgement(1 if failure else 0, 0, 0, "ABSOLU")
        check.judge(met, met, "assertion", False)
        study.current.progress(f"NOOK {method} {where} {failure}" if failure else f"OK   {method} {where}")
        study.current.checks.append(check)
        self._checks.append(check)

    def printSummary(self):
        """The number of assertions so far; they are in the run's own summary too."""
        from . import checks, study

        study.current.progress(f"assertions: {checks.summary(self._checks)}")


class _Modules:
    """Finds the modules of code_aster that are made when they are imported, and says so for those that Lacon does not have."""

    _tensors = "code_aster.MacroCommands.Contrib."
    made = {"code_aster.MacroCommands", "code_aster.MacroCommands.Contrib", _tensors + "TensorModule", _tensors + "HookeTensor"}
    missing = {"code_aster", "Accas", "Cata", "Contrib", "Execution", "Macro", "Messages", "Miss", "Noyau", "Utilitai", "aster", "aster_core",
               "aster_fonctions", "libaster", "run_aster"}

    def find_spec(self, name, path=None, target=None):
        import importlib.machinery

        if name in self.made:
            return importlib.machinery.ModuleSpec(name, self, is_package=not name.endswith(("TensorModule", "HookeTensor")))
        if name.partition(".")[0] in self.missing:
            raise ModuleNotFoundError(f"the module {name} is part of code_aster, and Lacon does not have it", name=name)
        return None

    def create_module(self, spec):
        return None

    def exec_module(self, module):
        if module.__name__.startswith(self._tensors):
            from . import tensors

            vars(module).update({k: v for k, v in vars(tensors).items() if not k.startswith("__")})


def _utility(name):
    """code_aster.Utilities.sympy, where sympy is installed."""
    if name != "sympy":
        raise AttributeError(f"code_aster.Utilities has no {name} in Lacon")
    import sympy

    return sympy


def install(names):
    """Make the modules importable. `names`: every command, _F and CO."""
    root = types.ModuleType("code_aster", "The commands of Lacon under code_aster's name.")
    root.__path__ = []
    commands = types.ModuleType("code_aster.Commands")
    vars(commands).update(names)
    commands.__all__ = sorted(names)
    utilities = types.ModuleType("code_aster.Utilities")
    utilities.__getattr__ = _utility
    utilities.__all__ = []
    ca = types.ModuleType("code_aster.CA")
    ca.TestCase = TestCase
    for exception in (messages.AsterError, messages.ConvergenceError, messages.SolutionError, messages.InternalError):
        setattr(ca, exception.__name__, exception)
    ca.SolverError = messages.SolutionError
    ca.AsterException = messages.AsterError

    def init(*options, **keywords):
        keywords.pop("CODE", None)
        return names["POURSUITE" if "--continue" in options else "DEBUT"](**keywords)

    def close(**keywords):
        return names["FIN"](**keywords)

    ca.init, ca.close = init, close
    vars(root).update({name: value for name, value in vars(ca).items() if not name.startswith("__")})  # code_aster.TestCase of version 15
    root.CA, root.Commands, root.Utilities = ca, commands, utilities
    for module in (root, commands, utilities, ca):
        sys.modules[module.__name__] = module
    sys.meta_path.append(_Modules())
    return ca
