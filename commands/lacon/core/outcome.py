"""How the launcher and its tools end: exit statuses, and errors that are shown."""

import contextlib
import os
import sys

from . import messages, streams

#: exit statuses
done, user_error, solution_failed, internal_error, check_failed = 0, 2, 3, 4, 5


def _is_nowhere():
    """Whether the working folder was removed."""
    try:
        os.getcwd()
    except FileNotFoundError:
        return True
    return False


def memory_used_up(where=""):
    """Say so. @return (exit status, words of the diagnosis)"""
    try:
        messages.show(messages.message("MEMORY_1", where))
    except MemoryError:  # there is none left for the catalogue either
        with contextlib.suppress(OSError):
            os.write(2, b"<S> <MEMORY_1> the memory is used up\n")
    return solution_failed, "<S>_ERROR"


def guarded(work):
    """What `work` returns, (exit status, words of the diagnosis); errors that it throws are shown."""
    try:
        return work()
    except messages.AsterError as error:
        for item in error.messages:
            messages.show(item)
        return error.status, error.diagnostic
    except KeyboardInterrupt:  # before the study takes signals, or behind its end
        messages.show(messages.message("STUDY_18", signal="SIGINT"))
        return internal_error, "<F>_ABNORMAL_ABORT"
    except MemoryError as error:
        error.__traceback__ = None  # what the frames hold is free for the message
        return memory_used_up()
    except OSError as error:
        lost = streams.unwritable(error)
        if lost:
            streams.let_go(lost)
            messages.show(messages.message("STUDY_34", reason=next(iter(lost.values()))))
            return user_error, "<F>_ERROR"
        if not isinstance(error, FileNotFoundError):
            raise
        if error.filename is None and _is_nowhere():
            messages.show(messages.message("STUDY_37"))
            return user_error, "<F>_ERROR"
        # no catalogue: an installation that is not whole
        print(f"<F> <INTERNAL> {error}", file=sys.stderr)
        return internal_error, "<F>_ABNORMAL_ABORT"
