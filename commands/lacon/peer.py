"""What `import code_aster` finds: modules with the commands under the peer's names."""

import sys
import types

from . import messages


class TestCase:
    """code_aster's CA.TestCase: assertions that count as checks. A failed one is NOOK and does not stop the study."""

    def _record(self, method, arguments, keywords):
        import unittest

        from . import checks, labels, study

        where = labels.location(labels.user_frame())
        value = arguments[0] if arguments and isinstance(arguments[0], (int, float)) else 0
        check = checks.Check(where, "assert", "", method[6:], "", None, "", value)
        try:
            getattr(unittest.TestCase(), method)(*arguments, **keywords)
            met = checks.Judgement(0, 0, 0, "ABSOLU")
            text = f"OK   {method} {where}"
        except AssertionError as error:
            met = checks.Judgement(1, 0, 0, "ABSOLU")
            text = f"NOOK {method} {where} {error}"
        check.judge(met, met, "assertion", False)
        study.current.progress(text)
        study.current.checks.append(check)

    def __getattr__(self, name):
        if not name.startswith("assert"):
            raise AttributeError(name)
        return lambda *arguments, **keywords: self._record(name, arguments, keywords)

    def printSummary(self):
        """The run's own summary has these checks too."""


def install(names):
    """Make the modules importable. `names`: every command, _F and CO."""
    root = types.ModuleType("code_aster", "The commands of Lacon under code_aster's name.")
    root.__path__ = []
    commands = types.ModuleType("code_aster.Commands")
    vars(commands).update(names)
    commands.__all__ = sorted(names)
    utilities = types.ModuleType("code_aster.Utilities")
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

    for name, function in (("init", init), ("close", close)):
        setattr(ca, name, function)
        setattr(root, name, function)
    root.CA, root.Commands, root.Utilities = ca, commands, utilities
    for exception in ("AsterError", "ConvergenceError"):
        setattr(root, exception, getattr(messages, exception))
    for module in (root, commands, utilities, ca):
        sys.modules[module.__name__] = module
    return ca
