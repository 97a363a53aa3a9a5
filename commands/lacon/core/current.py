"""The run of this process: commands, messages and the assertions of a command file ask for it."""

import contextlib
import os
import threading

#: held by the thread that is in a command: those of a command file wait for one another
turn = threading.RLock()


def _forked():
    """The thread that held it is not in this process."""
    global turn
    turn = threading.RLock()


os.register_at_fork(after_in_child=_forked)


@contextlib.contextmanager
def others_take_turns():
    """While a command runs a text of the user's: threads that it starts and waits for call commands too."""
    held = 0
    with contextlib.suppress(RuntimeError):  # when nothing of it is held any more
        while True:
            turn.release()
            held += 1
    try:
        yield
    finally:
        for _ in range(held):
            turn.acquire()


#: a run.study.Study; nothing where no command file runs
study = None

#: name -> command, as command files call them; what objects do with fields is done by commands
commands = {}
