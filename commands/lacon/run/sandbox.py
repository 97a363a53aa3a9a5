"""`lacon --sandbox study.comm`: a command file is Python, and can do whatever its user can. In the sandbox (bubblewrap) it has no
network, and writes nothing but its base and the files of its units.

Another launcher runs within: it sees every file, may write the base and a stage, an empty folder, and takes all processes with it when
it ends. What it leaves in the stage under the name of a unit's file this one, which trusts it in nothing, puts to its place.
"""

import contextlib
import json
import os
import pathlib
import shutil
import signal
import stat
import subprocess
import sys
import tempfile

from ..base.base import may_be_base
from ..core.files import whole
from ..core.messages import fail
from ..core.plugins import operator_folder
from . import launch

#: folders of sockets and of other programs' files, which are empty within but for what the study names
_hidden = ("/tmp", "/run", "/var/tmp")
#: the folder that this package is in
_packages = str(pathlib.Path(__file__).resolve().parents[2])
_forwarded = (signal.SIGTERM, signal.SIGINT, signal.SIGHUP)


def run(options, units):
    """Run the study of a command line in the sandbox. @return exit status"""
    bwrap = shutil.which("bwrap")
    if bwrap is None:
        fail("STUDY_32", "--sandbox")
    export = launch.command_files(options.files, units)
    base = pathlib.Path(os.path.abspath(options.base or launch.base_of(export)))
    try:
        base.mkdir(exist_ok=True)
        if not may_be_base(base):  # all of it can be written within
            fail("STUDY_4", "--sandbox", folder=base)
        stage = tempfile.mkdtemp(prefix=f".{base.stem}_", suffix=".partial", dir=base.parent)
    except OSError as error:
        fail("STUDY_3", "--sandbox", folder=base, reason=error.strerror)
    try:
        os.mkdir(os.path.join(stage, "tmp"))
        status = _run_within([bwrap, *_walls(base, stage, export), *_inner(options, export, base, stage)])
        _deliver(pathlib.Path(stage), base, export, options.json)
    finally:
        shutil.rmtree(stage, ignore_errors=True)
    return status


def _walls(base, stage, export):
    """Options of bwrap: what is seen within."""
    walls = ["--ro-bind", "/", "/", "--dev", "/dev", "--proc", "/proc"]
    for folder in filter(os.path.isdir, _hidden):
        walls += ["--tmpfs", folder]
    seen = {os.getcwd(), str(operator_folder().parent), _packages}  # plug-ins are beside the folder of operators
    seen |= {os.path.dirname(os.path.abspath(path)) for path in (*export.commands, *export.named, *export.units.values())}
    seen |= {os.path.abspath(path) for name in ("LACON_CATALOG", "LACON_PLUGIN_PATH") for path in os.environ.get(name, "").split(":") if path}
    for path in sorted(seen):
        if path.startswith(tuple(f"{folder}/" for folder in _hidden)) and os.path.exists(path):
            walls += ["--ro-bind", path, path]
    for path in (str(base), stage):
        walls += ["--bind", path, path]
    # a session of its own: no keys are put into the terminal; process 1: when it ends, all others do
    return walls + ["--unshare-net", "--unshare-pid", "--unshare-ipc", "--unshare-uts", "--new-session", "--as-pid-1", "--die-with-parent",
                    "--setenv", "TMPDIR", os.path.join(stage, "tmp"), "--setenv", "LACON_BIN", str(operator_folder()), "--setenv", "PYTHONPATH", _packages,
                    "--unsetenv", "LACON_ORDERS", *_chdir(export, stage)]


def _chdir(export, stage):
    """Files that the study reads under their own name are copied to the working folder, which cannot be written."""
    return ["--chdir", os.path.join(stage, "tmp") if export.named else os.getcwd()]


def _inner(options, export, base, stage):
    """The command line of the launcher within."""
    words = [sys.executable, "-m", "lacon", "--stage", stage, "--base", str(base)]
    for number, path in export.units.items():
        words += ["--unit", f"{number}={os.path.abspath(path)}"]
    for name in ("fresh", "force", "timings", "verbose"):
        words += [f"--{name}"] * getattr(options, name)
    for name in ("checks", "threads", "mpi", "hosts"):
        if getattr(options, name) is not None:
            words += [f"--{name}", str(getattr(options, name))]
    if options.json:
        words += ["--json", os.path.join(stage, "json")]
    return words + [os.path.abspath(path) for path in options.files]


def _run_within(words):
    """Run bwrap; signals go to the launcher within, which ends by itself. @return exit status"""
    told, tells = os.pipe()
    with open(told, encoding="utf-8") as info:
        process = subprocess.Popen([words[0], "--info-fd", str(tells), *words[1:]], pass_fds=(tells,), stdin=subprocess.DEVNULL)
        os.close(tells)
        first = info.read()
    if not first:  # bwrap has said why
        process.wait()
        fail("STUDY_33", "--sandbox")
    inner = json.loads(first)["child-pid"]

    def forward(number, _):
        with contextlib.suppress(ProcessLookupError):
            os.kill(inner, number)

    before = {number: signal.signal(number, forward) for number in _forwarded if signal.getsignal(number) is not signal.SIG_IGN}
    try:
        status = process.wait()
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
        process.kill()
        process.wait()
    return status if 0 <= status < 128 else 4


def _deliver(stage, base, export, json_file):
    """Put what lies in the stage under the names of the units' files to its places."""
    data = {os.path.realpath(path) for path in (*export.commands, *export.named, *export.data)}
    for folder in sorted((stage / "units").glob("*")):
        number = int(folder.name) if folder.name.isdigit() else 0
        given = export.units.get(number)
        target = pathlib.Path(os.path.abspath(given)) if given else base.parent / f"{base.stem}.{number}"
        for path in sorted(folder.iterdir()):
            # pieces of a VTU file are called STEM_0001.vtu and the like
            if path.name == target.name or path.name.startswith((f"{target.stem}_", f"{target.stem}.") if given else f"{target.name}."):
                _put(path, target.parent / path.name, data)
    if json_file:
        _put(stage / "json", pathlib.Path(json_file), data)


def _put(path, target, data):
    """@throws AsterError COMMAND_8"""
    if not os.path.lexists(path):
        return
    try:
        # whatever a study makes there: no links, no devices, and no data overwritten
        if not stat.S_ISREG(os.lstat(path).st_mode) or os.path.realpath(target) in data or (os.path.exists(target) and not os.path.isfile(target)):
            raise OSError
        with whole(target) as partial:
            shutil.copyfile(path, partial, follow_symlinks=False)
    except OSError:
        fail("COMMAND_8", "--sandbox", unit=path.parent.name, file=target)
