"""The limit of the stack (ulimit -s), which a shell or a batch system may have set too low for operators: one that passes it is killed without a word."""

import contextlib
import resource

from .messages import fail

_least = 512 << 10  #: bytes; 300 kB were enough for every solver, 200 were not
_usual = 8 << 20  #: what systems give


def make_room(where):
    """Raise the limit of this process, and of those that it starts, where it is too low. @throws AsterError STUDY_48 where the system does not allow that"""
    now, most = resource.getrlimit(resource.RLIMIT_STACK)
    if now == resource.RLIM_INFINITY or now >= _least:
        return
    wanted = _usual if most == resource.RLIM_INFINITY else min(_usual, most)
    with contextlib.suppress(OSError, ValueError):
        resource.setrlimit(resource.RLIMIT_STACK, (wanted, most))
        now = wanted
    if now < _least:
        fail("STUDY_48", where, limit=now >> 10, least=_least >> 10)
