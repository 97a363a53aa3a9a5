"""Pools of threads (concurrent.futures) that a command file gives commands: it ends when their work is done, and fails by a command that has failed in one
where it has not asked for the result. Python would keep that error to itself, and do what is left of the work when the study is closed."""

import functools
import importlib.machinery
import os
import sys
import threading

from ..core import labels
from ..core.messages import AsterError

_module = "concurrent.futures.thread"
_lock = threading.Lock()
_pending = set()  #: futures that are not done
_failed = []  #: those that an error has ended, in their order


class _Finder:
    """Follows pools from the import of their module on: it takes as long as a tenth of a run's start, and few command files want it."""

    @staticmethod
    def find_spec(name, path, _=None):
        if name != _module:
            return None
        sys.meta_path.remove(_Finder)
        spec = importlib.machinery.PathFinder.find_spec(name, path)
        load = spec.loader.exec_module

        def load_and_follow(module):
            load(module)
            _follow(module)

        spec.loader.exec_module = load_and_follow
        return spec


class _Work:
    """What a pool is given, and where it was."""

    def __init__(self, work, place):
        self.work, self.place = work, place

    def __call__(self, *args, **kwargs):
        return self.work(*args, **kwargs)


def follow():
    """Know of what pools are given from now on."""
    _failed.clear()
    if _module in sys.modules:
        _follow(sys.modules[_module])
    elif _Finder not in sys.meta_path:
        sys.meta_path.insert(0, _Finder)


@functools.cache
def _follow(module):
    from concurrent.futures import Future  # start-up: see _Finder

    class Followed(Future):
        """Knows whether anybody has asked how it ended."""

        asked = False

        def result(self, timeout=None):
            try:
                return super().result(timeout)
            finally:
                self.asked = self.asked or self.done()

        def exception(self, timeout=None):
            by_itself = sys._getframe(1).f_globals.get("__name__", "").startswith("concurrent.")  # wait(return_when=FIRST_EXCEPTION)
            try:
                return super().exception(timeout)
            finally:
                self.asked = self.asked or self.done() and not by_itself

    def end(future):
        with _lock:
            if not future.cancelled() and Future.exception(future):
                _failed.append(future)
            _pending.discard(future)

    submit = module.ThreadPoolExecutor.submit

    @functools.wraps(submit)
    def submit_and_follow(self, fn, /, *args, **kwargs):
        future = submit(self, _Work(fn, labels.location(labels.user_frame())), *args, **kwargs)
        if type(future) is Future:  # not one of another library's own
            future.__class__ = Followed
            with _lock:
                _pending.add(future)
            future.add_done_callback(end)
        return future

    module.ThreadPoolExecutor.submit = submit_and_follow


def is_idle():
    return not _pending


def wait():
    """Until what pools have been given is done."""
    while _pending:
        from concurrent.futures import wait  # start-up: see _Finder

        with _lock:
            futures = list(_pending)
        wait(futures)


def take_failures():
    """Errors that nobody has asked for, of commands; others are told as those of threads."""
    with _lock:
        failed = [future for future in _failed if not future.asked]
        _failed.clear()
    commands = []
    for future in failed:
        error = future.exception()
        if isinstance(error, AsterError):
            commands.append(error)
        else:
            threading.excepthook(threading.ExceptHookArgs((type(error), error, error.__traceback__, None)))
    return commands


def _forked():
    """What pools of the process that it comes from do is no work of this one."""
    global _lock
    _lock = threading.Lock()
    _pending.clear()
    _failed.clear()


os.register_at_fork(after_in_child=_forked)
