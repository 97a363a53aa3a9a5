"""Standard input, output and error: one that the caller has closed, and one whose reader has gone."""

import errno
import os
import select
import sys

_no_place = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO, errno.EBADF)


def open_closed():
    """A stream that the caller has closed (`>&-`) leads nowhere; otherwise the next file that is opened, one of the base's, would get its number."""
    for number, name, mode in ((0, "stdin", "r"), (1, "stdout", "w"), (2, "stderr", "w")):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # gets the lowest number that is free, which is this one
            os.set_inheritable(number, True)
        if getattr(sys, name) is None:
            setattr(sys, name, open(number, mode, encoding="utf-8", errors="backslashreplace", closefd=False))


def unwritable(error):
    """{1, 2: why} of the output and the log where they take no more, as a file on a disk that is full, if `error` may come from that. Tries them: of what
    could not be written Python keeps nothing that would tell."""
    found = {}
    if isinstance(error, OSError) and error.filename is None and error.errno in _no_place:
        for number in (1, 2):
            try:
                os.write(number, b"\n")
            except OSError as reason:
                found[number] = reason.strerror
    return found


def refuse_lost_log():
    """What an operator has said is lost. @throws OSError as if it had been said here"""
    number = errno.EPIPE if readers_gone() else errno.ENOSPC
    raise OSError(number, os.strerror(number))


def take_back():
    """Output and log that a command file has closed, or put to None, are the process's own again, or lead nowhere."""
    for name in ("stdout", "stderr"):
        stream, own = getattr(sys, name), getattr(sys, f"__{name}__")
        if stream is None or getattr(stream, "closed", False):
            setattr(sys, name, None if own is None or own.closed else own)
    if None in (sys.stdout, sys.stderr):
        open_closed()


def readers_gone():
    """Whether nobody reads the output or the log any more (`lacon study.comm | head`)."""
    return any(_has_lost_its_reader(number) for number in (1, 2))


def let_go(unwritable=()):
    """What is still to be said where nobody reads it, or where it cannot be written, leads nowhere. @param unwritable 1, 2: output, log"""
    for number in (1, 2):
        if number in unwritable or _has_lost_its_reader(number):
            nowhere = os.open(os.devnull, os.O_WRONLY)
            if nowhere != number:
                os.dup2(nowhere, number)
            if nowhere > 2:  # otherwise one was closed, and this is one now
                os.close(nowhere)


def _has_lost_its_reader(number):
    poll = select.poll()
    poll.register(number, 0)
    return any(event & select.POLLERR for _, event in poll.poll(0))
