"""Orders: one command with complete keywords, handed to the executable of its operator; docs/structures.md section 4."""

import contextlib
import errno
import json
import os
import signal
import socket
import stat
import sys
import threading
import time

from ..core import late, stack, streams
from ..core.catalog import part
from ..core.concepts import to_json
from ..core.late import subprocess
from ..core.messages import AsterError, ConvergenceError, InternalError, Message, SolutionError, fail, message
from ..core.plugins import operator, operator_folder
from . import expressions
from .processor import available_cores

#: seconds that an operator has to end; it needs less
patience = 1.8
#: what messages of a solution that failed in the linear solver, or for want of memory, begin with; any other is one of Newton's method
not_newton = ("SOLVER_", "MEMORY_")
#: what an operator says that a signal has ended between two instants, or while it waited for the values of a formula
ended_by_signal = ("EVOLUTION_30", "FORMULE_7")
#: of glibc's allocator: large blocks are to be in huge pages; older ones than 2.35 pass over it
_huge_pages = "glibc.malloc.hugetlb"
#: takes away the line of a terminal in which it stands
_empty_line = b"\r\033[K"
_running = []  #: operators that have been started and not ended


class Outcome:
    """What an operator's process came to."""

    def __init__(self, status, messages, phases, counts, seconds, log_lost=False):
        self.status = status  #: of the process; negative: the signal that ended it
        self.messages = messages
        self.phases = phases  #: name -> seconds, as the operator measured them
        self.counts = counts  #: name -> how many: factorisations, ...
        self.seconds = seconds  #: wall time of the process
        self.log_lost = log_lost


def order(command, study, keywords, where, result=None, units=None, written=()):
    """The order as JSON. `result`: {"id", "label", "reuse"}; `units`: number -> path."""
    made = {"format": 1, "command": command, "base": str(study.base.folder)}
    if result:
        made["result"] = result
    made["units"] = {str(k): str(v) for k, v in (units or {}).items()}
    if written:
        made["append"] = sorted(str(unit) for unit in written)
    made["source"] = where
    made["keywords"] = to_json(keywords)
    return made


def run(program, made, study, checks=False):
    """Start the operator on the order, or with `checks` on all of it but what takes long, and wait for it. @return its Outcome. @throws InternalError where it does not exist"""
    executable = operator(program)
    if not os.access(executable, os.X_OK):
        raise InternalError([message("INTERNAL_2", made["source"], program=program, folder=operator_folder())])
    stack.make_room(made["source"])
    order_file, status_file = _write_order(made, study)
    arguments = [executable, order_file, "--status", status_file, *["--verbose"] * study.verbose, *["--check"] * checks]
    sys.stdout.flush()
    sys.stderr.flush()
    start = time.perf_counter()
    ours, theirs = socket.socketpair()  # for formulae
    with ours, _terminal(study) as terminal:
        with theirs:  # an operator that ends a moment after the launcher still holds the base
            try:
                process = _start(arguments, study, theirs, terminal)
            except OSError as error:
                fail("STUDY_38", made["source"], program=program, reason=error.strerror)
        _wait(process, study, ours, terminal)
    seconds = time.perf_counter() - start
    *said, log_lost = _read_status(status_file, f"{made['command']}, {made['source']}")
    return Outcome(process.returncode, *said, seconds, log_lost)


def _write_order(made, study):
    """@return the order's file, and that of the status, which the operator is to write"""
    try:
        order_file, status_file = study.order_files(made["command"])
        status_file.unlink(missing_ok=True)
        order_file.write_text(json.dumps(made, ensure_ascii=False, indent=1), encoding="utf-8")
    except OSError as error:
        fail("STUDY_3", made["source"], folder=study.base.folder, reason=error.strerror)
    except UnicodeEncodeError as error:
        fail("STUDY_39", made["source"], text=ascii(error.object[error.start:error.end]))
    return order_file, status_file


def _environment(study):
    """What operators find in their environment, beside what the launcher has in its own."""
    environment = dict(os.environ)
    environment.setdefault("OPENBLAS_NUM_THREADS", "1")  # the operator takes one thread of OpenBLAS: no others are started
    tunables = environment.get("GLIBC_TUNABLES", "")
    if _huge_pages not in tunables:  # factors in huge pages, where the system leaves the choice to programs
        environment["GLIBC_TUNABLES"] = ":".join(filter(None, [tunables, f"{_huge_pages}=1"]))
    if study.threads:
        environment["LACON_THREADS"] = str(study.threads)
    environment["OMP_NUM_THREADS"] = environment.setdefault("LACON_THREADS", str(available_cores()))
    if study.ranks:
        environment["LACON_MPI"] = str(study.ranks)
    if study.hosts:
        environment["LACON_HOSTS"] = study.hosts
    return environment


def _start(arguments, study, theirs, terminal):
    """The operator's process. @param theirs its end of the socket for formulae @param terminal where it says how far it is, or None. @throws OSError"""
    environment = {**_environment(study), "LACON_FORMULAS": str(theirs.fileno()), "LACON_LAUNCHER": str(os.getpid())}
    inherited = [study.base.lock, theirs.fileno()]
    if terminal:
        environment["LACON_TERMINAL"] = str(terminal)
        inherited.append(terminal)
    return subprocess.Popen(arguments, env=environment, stderr=subprocess.PIPE if study.ignored_alarms else None, stdin=subprocess.DEVNULL,
                            stdout=subprocess.DEVNULL if study.check or study.quiet else None, pass_fds=inherited)


def _wait(process, study, ours, terminal):
    """Until the operator has ended, evaluate its formulae, and hand on what it says."""
    forward = None
    _running.append(process)
    try:
        late.load()  # while the operator works: checks, functions and FIN need it later
        if process.stderr:
            forward = threading.Thread(target=_forward, args=(process.stderr, study.ignored_alarms, terminal), daemon=True)
            forward.start()
        with ours.makefile("rwb") as stream:
            _serve_formulas(stream, study.base)
        process.wait()
        if forward:
            forward.join()
    except BaseException:
        _end(process)
        raise
    finally:
        _running.remove(process)
        if terminal and process.returncode:  # an operator that was killed leaves its line
            with contextlib.suppress(OSError):  # the terminal is gone
                os.write(terminal, _empty_line)


@contextlib.contextmanager
def _terminal(study):
    """A file for the line that says where an operator is, on the terminal of who waits for it; nothing where there is none, where the
    output goes on into a pipe, or tells each phase anyway."""
    shown = sys.stderr.isatty() and os.environ.get("TERM", "dumb") != "dumb" and not study.verbose and not study.check
    if not shown or stat.S_ISFIFO(os.fstat(sys.stdout.fileno()).st_mode):
        yield None
        return
    number = os.dup(sys.stderr.fileno())
    try:
        yield number
    finally:
        os.close(number)


def end_running():
    """End the operator that a thread of the command file waits for."""
    for process in list(_running):
        process.terminate()


def _end(process):
    """End an operator: it stores or gives up what it has in hand, for which it has no more than a moment."""
    process.terminate()
    try:
        process.wait(patience)
    except subprocess.TimeoutExpired:
        pass
    finally:
        process.kill()
        process.wait()


def _serve_formulas(stream, base):
    """Evaluate formulae for the operator as long as it runs."""
    try:
        expressions.serve(stream, base)
    except ConnectionError:
        pass  # the operator has died: its exit status says so


def _read_status(path, where):
    """(messages, phases, counts, whether its log took no more) of what an operator wrote about itself; nothing where it did not come to that."""
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
        messages = [Message(m["severity"], m["id"], m["text"], m.get("do", ""), where) for m in data.get("messages", [])]
        return messages, dict(data.get("seconds", {})), dict(data.get("counts", {})), data.get("log_lost", False)
    except (OSError, ValueError, KeyError, TypeError):
        return [], {}, {}, False


def _forward(stream, ignored, terminal):
    """Hand on what an operator says, without the alarms that the user does not want to see."""
    hidden, empty_line = False, _empty_line.decode() if terminal else ""
    for raw in stream:
        line = raw.decode(errors="replace")
        if line.startswith("<"):
            hidden = line.startswith("<A>") and any(f"<{identifier}>" in line for identifier in ignored)
        elif not line.startswith("    "):
            hidden = False
        if not hidden:
            with contextlib.suppress(BrokenPipeError):  # the operator goes on speaking
                sys.stderr.write(empty_line + line)
    with contextlib.suppress(BrokenPipeError):
        sys.stderr.flush()


def raise_failure(outcome, program, where):
    """The Python exception of an operator that did not end with 0."""
    fatal = [m for m in outcome.messages if m.severity in "FS"]
    if (outcome.status == -signal.SIGPIPE or any(m.id in ended_by_signal for m in fatal)) and streams.readers_gone():
        raise BrokenPipeError(errno.EPIPE, os.strerror(errno.EPIPE))
    if outcome.status == 2:
        raise AsterError(fatal or [message("COMMAND_6", where, program=program)], shown=bool(fatal))
    if outcome.status == 3:
        items = fatal or [message("COMMAND_7", where, program=program)]
        newton = not any(m.id.startswith(not_newton) for m in items)
        raise (ConvergenceError if newton else SolutionError)(items, shown=bool(fatal))
    if outcome.status in (126, 127):  # as the loader and shells say it
        raise InternalError([message("INTERNAL_4", where, program=program, folder=operator_folder())])
    if outcome.status < 0:
        try:
            name = signal.Signals(-outcome.status).name
        except ValueError:
            name = f"signal {-outcome.status}"
        raise InternalError([message("INTERNAL_3", where, program=program, how=part("process_ended_by", name=name))])
    if fatal and outcome.status == 4:
        raise InternalError(fatal, shown=True)
    raise InternalError([message("INTERNAL_3", where, program=program, how=part("exit_status_is", status=outcome.status))])
