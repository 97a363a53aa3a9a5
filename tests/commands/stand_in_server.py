"""Runs stand-ins for operators quickly: one process that has imported h5py forks for each order.

The executables that the launcher starts are clients: they send their arguments, environment and outputs, and end as the fork ended,
by the same signal too.
"""

import atexit
import json
import os
import pathlib
import signal
import socket
import sys
import tempfile
import traceback

CLIENT = """#!{python} -SE
import json, os, socket, sys
server = socket.socket(socket.AF_UNIX)
server.connect({address!r})
socket.send_fds(server, [json.dumps([sys.argv, dict(os.environ), os.getcwd()]).encode()], [1, 2])
server.shutdown(socket.SHUT_WR)
status = int(server.recv(64))
if status < 0:
    os.kill(os.getpid(), -status)
sys.exit(status)
"""


def start():
    """Fork the server, which lasts as long as this process. @return text of a client"""
    folder = tempfile.mkdtemp(prefix="lacon_stand_in_")
    address = os.path.join(folder, "socket")
    listener = socket.socket(socket.AF_UNIX)
    listener.bind(address)
    listener.listen(16)
    code = compile(pathlib.Path(__file__).with_name("stand_in.py").read_text(encoding="utf-8"), "stand_in.py", "exec")
    child = os.fork()
    if child == 0:
        try:
            serve(listener, code)
        finally:
            os._exit(1)
    listener.close()

    def stop():
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)
        os.unlink(address)
        os.rmdir(folder)

    atexit.register(stop)
    return CLIENT.format(python=sys.executable, address=address)


def serve(listener, code):
    import h5py  # noqa: F401, imported once for every fork

    while True:
        connection, _ = listener.accept()
        if os.fork() == 0:
            listener.close()
            message, outputs, _, _ = socket.recv_fds(connection, 1 << 20, 2)
            while part := connection.recv(1 << 20):
                message += part
            worker = os.fork()
            if worker == 0:
                connection.close()
                os._exit(work(code, outputs, *json.loads(message)))
            status = os.waitstatus_to_exitcode(os.waitpid(worker, 0)[1])
            connection.sendall(str(status).encode())
            os._exit(0)
        connection.close()
        reap()


def reap():
    """Collect forks that have ended."""
    try:
        while os.waitpid(-1, os.WNOHANG)[0]:
            pass
    except ChildProcessError:
        pass


def work(code, outputs, arguments, environment, folder):
    """One stand-in, in a process of its own. @return its exit status"""
    for target, source in zip((1, 2), outputs):
        os.dup2(source, target)
    sys.stdout, sys.stderr = os.fdopen(1, "w"), os.fdopen(2, "w")
    sys.argv = arguments
    os.environ.clear()
    os.environ.update(environment)
    os.chdir(folder)
    status = 0
    try:
        exec(code, {"__name__": "stand_in"})
    except SystemExit as end:
        status = end.code or 0
    except BaseException:
        traceback.print_exc()
        status = 70
    sys.stdout.flush()
    sys.stderr.flush()
    return status
