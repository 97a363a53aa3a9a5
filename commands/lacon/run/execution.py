"""Runs command files: Python files that find every command in their namespace."""

import ast
import builtins
import contextlib
import math
import os
import pathlib
import re
import shutil
import signal
import site
import sys
import sysconfig
import threading
import tokenize
import traceback
import warnings

from ..base import names as namespace
from ..core import catalog, labels, late, messages, outcome, streams
from ..core.catalog import part
from ..core.files import is_readable
from ..core.messages import AsterError, NeedsRun, fail, message, show
from ..core.nearest import nearest
from ..peer import modules
from . import pools
from .calls import all_commands


def provided_names():
    """What a command file finds without importing it: mathematics, every command, _F, CO, CA, the exceptions of commands."""
    names = {k: v for k, v in vars(math).items() if not k.startswith("_")}
    commands = all_commands()
    names.update(commands)
    names["CA"] = modules.install(commands)
    names["AsterError"] = messages.AsterError
    names["ConvergenceError"] = messages.ConvergenceError
    return names


def check_files(files):
    """@throws AsterError where a command file cannot be read, before anything runs"""
    for path in files:
        if not os.path.isfile(path) or not is_readable(path):
            fail("STUDY_14", str(path), file=path, reason=part("file_not_there" if not os.path.exists(path) else "not_a_readable_file"))
        for name in ("numpy", "h5py"):  # the folder of a command file comes first where modules are looked for
            for hidden_by in (f"{name}.py", os.path.join(name, "__init__.py")):
                if os.path.isfile(os.path.join(os.path.dirname(os.path.abspath(path)), hidden_by)):
                    fail("STUDY_36", str(path), file=hidden_by, package=name)


class Failure(Exception):
    """A command file stopped: exit status, words of the diagnosis."""

    def __init__(self, status, diagnostic):
        self.status, self.diagnostic = status, diagnostic


_longest_timer = 1e9  # seconds, thirty years


class TimeOver(BaseException):
    """The time limit of an export file is over; no exception that a command file may catch by Exception."""

    def __init__(self, seconds):
        super().__init__(f"{seconds:g} s")
        self.seconds = seconds


class Ended(BaseException):
    """A signal ends the run; no exception that a command file may catch by Exception."""

    def __init__(self, number):
        super().__init__(signal.Signals(number).name)


caught = set()  # signals that end the run by an exception
_masks = threading.local()  # of signals, before a thread forks


def _before_fork():
    _masks.now = signal.pthread_sigmask(signal.SIG_BLOCK, caught)


def _in_parent():
    signal.pthread_sigmask(signal.SIG_SETMASK, _masks.now)


def _in_child():
    """A handler of Python runs between two of its instructions: of a pool's process that waits for work, a signal that came just before would not be the end."""
    for number in caught:
        signal.signal(number, signal.SIG_DFL)
    _in_parent()


os.register_at_fork(before=_before_fork, after_in_parent=_in_parent, after_in_child=_in_child)


@contextlib.contextmanager
def signals():
    """Raise Ended at the signals that ask a run to end; one that is ignored (nohup) stays so. Processes that the command file forks end as any other."""
    def end(number, _):
        raise Ended(number)

    before = {number: signal.getsignal(number) for number in (signal.SIGTERM, signal.SIGHUP, signal.SIGINT, signal.SIGXCPU)}
    caught.update(number for number, handler in before.items() if handler is not signal.SIG_IGN)
    for number in caught:
        signal.signal(number, end)
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
        caught.clear()


@contextlib.contextmanager
def readers():
    """Raise Ended where whoever reads the output has gone, as after `lacon study.comm | head`; what is still to be said then leads nowhere.
    @throws AsterError STUDY_34 where the output cannot be written
    """
    try:
        yield
    except KeyboardInterrupt as error:  # that a command file raises: at Ctrl-C it is Ended
        raise Ended(signal.SIGINT).with_traceback(error.__traceback__) from None
    except BaseException as error:
        streams.take_back()
        gone, lost = streams.readers_gone(), streams.unwritable(error)
        streams.let_go(lost)
        if gone and isinstance(error, BrokenPipeError):
            raise Ended(signal.SIGPIPE).with_traceback(error.__traceback__) from None
        if lost:
            fail("STUDY_34", place(error), reason=next(iter(lost.values())))
        raise


@contextlib.contextmanager
def time_limit(seconds):
    """Raise TimeOver after that many seconds; 0, and more than a timer has, are no limit. @throws Failure where no command file has begun"""
    def over(*_):
        raise TimeOver(seconds)

    if not 0.0 < seconds < _longest_timer:
        yield
        return
    before = signal.signal(signal.SIGALRM, over)
    try:
        signal.setitimer(signal.ITIMER_REAL, seconds)
        yield
    except TimeOver as error:
        _refuse_more_time(error)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)


def run_files(study, files):
    """Run the files in one namespace. @throws Failure, after the reason was printed"""
    values = study.names.values
    values["__name__"] = "__main__"
    values["__builtins__"] = builtins
    sources = [_read(path) for path in files]
    study.texts = [(os.path.basename(path), text) for path, text in sources]
    if "POURSUITE" in sources[0][1] or "--continue" in sources[0][1]:
        # a name that the saved study lost is explained where it is first used
        values["__builtins__"] = namespace.Builtins({})
    labels.sources.update(sources)
    for path, source in sources:
        for included in _included(path, source):
            study.protect(included)
    empty = [path for path, source in sources if _is_empty(path, source)]
    if len(empty) == len(sources):
        fail("STUDY_51", empty[0], file=empty[0])
    for path in empty:
        study.inform("STUDY_52", path, file=path)
    for path, source in sources:
        values["__file__"] = path
        _run_file(study, path, source, values)


def _is_empty(path, source):
    """Whether a text has no statement: a file may have been cut off to nothing."""
    with contextlib.suppress(AsterError):  # said where the text is run
        return not _as_python(path, lambda: ast.parse(source, path)).body
    return False


def _included(path, source):
    """The files that are there and that a text includes by names it gives: no result may replace them before it comes to that."""
    if "INCLUDE" not in source:
        return
    with contextlib.suppress(AsterError):  # said where the text is run
        for node in ast.walk(_as_python(path, lambda: ast.parse(source, path))):
            if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "INCLUDE":
                for keyword in node.keywords:
                    if keyword.arg == "DONNEE" and isinstance(keyword.value, ast.Constant):
                        included = os.path.join(os.path.dirname(path), str(keyword.value.value))
                        if os.path.isfile(included):
                            yield included


def run_text(study, name, text):
    """Run a text as a command file of that name. @throws Failure, after the reason was printed"""
    study.names.values.update(__name__="__main__", __builtins__=builtins)
    labels.sources[name] = text
    _run_file(study, name, text, study.names.values)


def include(path, values):
    """Run a file with the names of the study. @throws AsterError where it is not Python; what its commands throw"""
    path, source = _read(path)
    labels.sources[path] = source
    exec(_compiled(path, source), values)


def _read(path):
    """@return (path, text). @throws AsterError where it is no text"""
    try:
        with tokenize.open(path) as file:
            return str(path), file.read()
    except (SyntaxError, UnicodeDecodeError) as error:
        _refuse_other_encoding(path)
        fail("STUDY_16", str(path), reason=error)
    except OSError as error:
        fail("STUDY_14", str(path), file=path, reason=error.strerror)


def _refuse_other_encoding(path):
    """@throws AsterError where a text is not in UTF-8 and does not say what it is in"""
    content = pathlib.Path(path).read_bytes()
    if re.search(rb"^[ \t\f]*#.*?coding[:=]", b"\n".join(content.split(b"\n", 2)[:2]), re.MULTILINE):
        return
    try:
        content.decode()
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        fail("STUDY_35", f"{path}:{line}", byte=f"0x{content[error.start]:02X}")


def _compiled(path, source):
    return _as_python(path, lambda: compile(ast.parse(source, path), path, "exec"))


def _as_python(path, read):
    """What `read` makes of a text. @throws AsterError where it is not Python"""
    try:
        with warnings.catch_warnings():
            # titles hold escapes that Python does not know; they are no concern of the user's
            warnings.simplefilter("ignore", SyntaxWarning)
            warnings.simplefilter("ignore", DeprecationWarning)
            return read()
    except SyntaxError as error:
        fail("STUDY_16", f"{error.filename}:{error.lineno}", reason=error.msg)
    except ValueError as error:  # a null byte
        fail("STUDY_16", str(path), reason=error)
    except (RecursionError, MemoryError):
        fail("STUDY_16", str(path), reason=part("too_nested"))


def _wait_for_threads(others):
    """Until those that the command file has started have ended, and its pools are idle: each may give work to the other."""
    done = False
    while not done:
        done = pools.is_idle()
        pools.wait()
        for thread in threading.enumerate():
            # those of a pool wait for work until Python ends
            pooled = getattr(getattr(thread, "_target", None), "__module__", "") == "concurrent.futures.thread"
            if thread not in others and not thread.daemon and not pooled:
                thread.join()
                done = False


@contextlib.contextmanager
def _threads():
    """A command file ends when its threads have, those of pools too, and fails by a command that has failed in one of them."""
    failed, others = [], threading.excepthook

    def told(thrown):
        if isinstance(thrown.exc_value, AsterError):
            failed.append(thrown.exc_value)
        else:
            others(thrown)

    pools.follow()
    threading.excepthook = told  # and stays: what threads throw behind a failure is no more to be said
    before = threading.enumerate()
    ended = None
    try:
        yield
    except SystemExit as error:
        if error.code not in (None, 0):
            raise
        ended = error
    _wait_for_threads(before)
    failed += pools.take_failures()
    if failed:
        raise failed[0]
    if ended:
        raise ended


def _run_file(study, path, source, values):
    folder = os.path.dirname(os.path.abspath(path))
    late.look_in(folder)
    try:
        with readers(), _threads():
            exec(_compiled(path, source), values)
    except AsterError as error:
        _report(error)
        raise Failure(error.status, error.diagnostic) from None
    except SystemExit as error:
        if error.code not in (None, 0):
            show(message("STUDY_17", place(error), code=error.code))
            raise Failure(2, "<F>_ERROR") from None
    except TimeOver as error:
        _refuse_more_time(error)
    except Ended as error:
        show(message("STUDY_18", place(error), signal=error))
        raise Failure(4, "<F>_ABNORMAL_ABORT") from None
    except namespace.LostName as error:
        show(error.item._replace(where=place(error)))
        raise Failure(2, "<F>_ERROR") from None
    except NameError as error:
        _print_traceback(error)
        show(_unknown_name(error, study))
        raise Failure(2, "<F>_ERROR") from None
    except MemoryError as error:
        _refuse_more_memory(error)
    except Exception as error:
        if _is_in(study.base_folder, error):
            show(message("STUDY_3", place(error), folder=error.filename, reason=error.strerror))
            raise Failure(2, "<F>_ERROR") from None
        _refuse(error)
    except (NeedsRun, Failure):
        raise
    except BaseException as error:  # of the command file's own
        _refuse(error)


def _refuse_more_time(error):
    """@throws Failure"""
    show(message("STUDY_25", place(error), seconds=f"{error.seconds:g}"))
    raise Failure(3, "<S>_CPU_LIMIT") from None


def _refuse_more_memory(error):
    """@throws Failure"""
    files = [entry.filename for entry in traceback.extract_tb(error.__traceback__) if not entry.filename.startswith((*_libraries, "<frozen"))]
    if str(error) and files and not files[-1].startswith(labels.package):  # numpy says which array of the command file is too large
        _refuse(error)
    where = place(error)
    error.__traceback__ = None  # what the frames hold is free for the message
    raise Failure(*outcome.memory_used_up(where)) from None


def _refuse(error):
    """A Python error of the command file. @throws Failure"""
    try:
        text = str(error)
    except Exception:  # of its own making too
        text = "its text cannot be made"
    _print_traceback(error)
    show(message("STUDY_19", place(error), kind=type(error).__name__, text=text))
    raise Failure(2, "<F>_ERROR") from None


def _is_in(base, error):
    """A file of the base cannot be written, removed, linked: a disk that is full, or read-only."""
    return isinstance(error, OSError) and isinstance(error.filename, (str, os.PathLike)) and os.path.abspath(error.filename).startswith(os.path.abspath(base))


def _report(error):
    """Why a command failed and where the study stopped."""
    if not error.shown:  # by the operator, which knows the line from its order
        for item in error.messages:
            show(item)
    entries = _user_entries(error)
    if len(entries) > 1:  # called through the user's own functions
        lines = [f"    called from {entry.filename}:{entry.lineno}" for entry in reversed(entries[:-1])]
        print("\n".join(lines), file=sys.stderr, flush=True)


def _user_entries(error):
    """The traceback without the frames of this package, and of what does the work of pools."""
    return [entry for entry in traceback.extract_tb(error.__traceback__)
            if not entry.filename.startswith((labels.package, "<frozen")) and not labels.is_of_pool(entry.filename)]


#: where the modules of Python and its packages are
_libraries = tuple({*sysconfig.get_paths().values(), *site.getsitepackages()})


def place(error):
    """"study.comm:12": the line of a command file at which an exception was thrown, or at which it called what has thrown it."""
    entries = [entry for entry in _user_entries(error) if not entry.filename.startswith(_libraries)]
    return f"{entries[-1].filename}:{entries[-1].lineno}" if entries else ""


def _print_traceback(error):
    sys.stdout.flush()
    print("Traceback (most recent call last):", file=sys.stderr)
    print("".join(traceback.format_list(_user_entries(error))), end="", file=sys.stderr)
    print("".join(traceback.format_exception_only(error)), end="", file=sys.stderr, flush=True)


def _unknown_name(error, study):
    """A command is meant where the name is called, and otherwise a name of the study; commands that are not available are no help."""
    name, where = error.name or "", place(error)
    command = nearest(name, catalog.command_names(), 0.7) if name.isupper() and _is_called(name, where) else ""
    if study.killed and not command:  # the run that this one goes on with, and saved no plain Python data
        return message("STUDY_24", where, name=name)
    return message("STUDY_20", where, name=name, nearest=command or nearest(name, study.names.user(), 0.6))


def _is_called(name, where):
    """Whether the line at a place calls what has this name."""
    path, _, number = where.rpartition(":")
    lines = labels.sources.get(path, "").splitlines()[int(number or 1) - 1:]
    return bool(lines) and re.search(rf"\b{re.escape(name)}\s*\(", lines[0]) is not None


@contextlib.contextmanager
def delivered(files):
    """Files that the study reads under their own name lie in the working folder while it runs."""
    placed = []
    try:
        for path in files:
            if not path.is_file():
                fail("STUDY_14", str(path), file=path, reason=part("file_not_there"))
            target = os.path.abspath(path.name)
            if os.path.exists(target):
                if not os.path.samefile(path, target):
                    fail("STUDY_21", str(path), file=path, target=target)
                continue
            shutil.copyfile(path, target)
            placed.append(target)
        late.look_in(os.getcwd())
        yield
    finally:
        for target in placed:
            with contextlib.suppress(OSError):
                os.unlink(target)
