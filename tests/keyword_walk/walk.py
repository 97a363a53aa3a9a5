"""Which keywords change something: every command of a study is done again without each of its keywords, and what it makes is compared.

`install()` puts this into the launcher of a test run (launcher() makes such a one). What the walk finds goes to the file that WALK_FILE names, a line of JSON
each: [COMMAND/FACTOR/KEYWORD, "changes" or "same", the study as WALK_STUDY names it, what was another]. A keyword changes something where the concept (with what it refers to), what is printed or written, or the
error is another one without it; where the command refuses to go without, with another value in its place.
"""

import contextlib
import copy
import hashlib
import json
import os
import pathlib
import re
import shutil
import sys
import tempfile

import h5py
import numpy

#: commands that are a study's frame: again and without they are another study
FRAME = ("DEBUT", "POURSUITE", "FIN", "INCLUDE", "DEFI_FICHIER", "DETRUIRE", "INFO_EXEC_ASTER")
OWN = {"id", "label", "keywords", "command", "version", "references"}  # attributes that say what made a concept
SHOWN = pathlib.Path(__file__).resolve().parent / "shown.json"
WHEN = rb"[0-9]{2}/[0-9]{2}/[0-9]{4} [0-9]{2}:[0-9]{2}:[0-9]{2}"  # a file's own date is no effect of a keyword
TRIES = 8  # calls in which a keyword may show its effect, before the walk leaves it

#: keywords that change nothing by themselves in the call that gives them, and where they are seen instead
EXCUSED = (
    (r"^AFFE_MATERIAU/AFFE_VARC/", "stays with the concept, and acts in STAT_NON_LINE: keyword_effects_results.comm compares displacements"),
    (r"^TEST_\w+/(\w+/)?REFERENCE$", "says what VALE_REFE is, which is refused without it: tests/commands/test_checks.py"),
    (r"/MOMENT$", "stands with POINT or not at all; then columns are RESULT_X and MOMENT_X: tests/commands/test_post_releve_t.py"),
    (r"^PRE_GMSH/UNITE_MAILLAGE$", "the unit that LIRE_MAILLAGE reads then: keyword_effects_results.comm"),
    (r"^CREA_MAILLAGE/INFO$", "what a cut with bad cells prints: tests/operators/test_crea_maillage.py"),
    (r"^PROJ_CHAMP/DISTANCE_ALARME$", "an alarm: tests/operators/test_proj_champ.py"),
    (r"/CONVERGENCE/RESI_GLOB_RELA$", "linear studies meet any: tests/unit/evolution/convergence_test.cpp, newton_test.cpp"),
    (r"/CONVERGENCE/SIGM_REFE$", "linear studies meet any: the closed form of tests/verification/test_references.py"),
    (r"^STAT_NON_LINE/RECH_LINEAIRE/METHODE$", "CORDE and MIXTE differ where a secant leaves its bracket: tests/unit/evolution/line_search_test.cpp"),
    (r"/SOLVEUR/(ACCELERATION|LOW_RANK_SEUIL)$", "small matrices have no blocks to compress: tests/unit/assembly/mumps_engine_test.cpp"),
    (rf"^({'|'.join(FRAME)})/", "the frame of a study: tests/commands"),
)


def excuse(path):
    return next((why for pattern, why in EXCUSED if re.search(pattern, path)), "")


def lines(file):
    """What the walk has entered: [keyword, verdict, study, what was another]."""
    return [json.loads(line) for line in file.read_text(encoding="utf-8").splitlines()] if file.exists() else []


def found(file):
    """(keywords that have changed something, those that have been given and never have)"""
    verdicts = lines(file)
    changes = {path for path, verdict, *_ in verdicts if verdict == "changes"}
    return changes, {path for path, *_ in verdicts} - changes


def shown():
    """study -> the keywords that `run --record` found to change something there."""
    return json.loads(SHOWN.read_text(encoding="utf-8"))


def taken():
    """Every simple keyword that the catalogue calls taken."""
    from lacon.core import catalog
    from lacon.tools.keyword_table import kind_of

    def under(path, row):
        for name, keyword in row.get("keyword", {}).items():
            if keyword["type"] == "factor":
                yield from under(f"{path}/{name}", keyword)
            elif kind_of(keyword) == "taken":
                yield f"{path}/{name}"

    return {path for command in catalog.command_names() for path in under(command, catalog.command(command))}


def launcher(folder, programs):
    """A folder with the operators of `programs` and a launcher that walks. @return the folder"""
    folder.mkdir(parents=True, exist_ok=True)
    for program in programs.iterdir():
        link = folder / program.name
        link.unlink(missing_ok=True)
        if program.name != "lacon":
            link.symlink_to(program)
    commands = pathlib.Path(__file__).resolve().parents[2] / "commands"
    (folder / "lacon").write_text(f"#!{sys.executable}\nimport sys\nsys.path[:0] = {[str(commands), str(pathlib.Path(__file__).parent)]!r}\nimport walk\n"
                                  "walk.install()\nfrom lacon.main import main\nsys.exit(main())\n", encoding="utf-8")
    (folder / "lacon").chmod(0o755)
    return folder


def leaves(path, row, given):
    """(COMMAND/FACTOR/KEYWORD, its row) of every simple keyword in a call."""
    for name, value in given.items():
        keyword = row.get("keyword", {}).get(name)
        if keyword is None or value is None:
            continue
        if keyword["type"] == "factor":
            occurrences = value if isinstance(value, (list, tuple)) else [value]
            for occurrence in occurrences:
                if isinstance(occurrence, dict):
                    yield from leaves(f"{path}/{name}", keyword, occurrence)
        else:
            yield f"{path}/{name}", keyword


def changed(given, names, value=None):
    """Keywords without (or with another value of) the one at names, in every occurrence."""
    first, *rest = names
    made = dict(given)
    if not rest:
        if first in made:
            made.pop(first)
            if value is not None:
                made[first] = value
        return made
    under = made.get(first)
    if isinstance(under, dict):
        made[first] = changed(under, rest, value)
    elif isinstance(under, (list, tuple)):
        made[first] = [changed(one, rest, value) if isinstance(one, dict) else one for one in under]
    return made


def parts_of(path, named=lambda text: text):
    """name of a part -> digest, of a file; of one of HDF5 its datasets and attributes. @param named puts what they are in the place of ids"""
    if not h5py.is_hdf5(path):
        return {"": hashlib.sha256(re.sub(WHEN, b"", path.read_bytes())).hexdigest()}
    found = {}

    def look(name, item):
        for key, value in item.attrs.items():
            if key not in OWN:
                found[f"{name}@{key}"] = named(repr(value))
        if isinstance(item, h5py.Dataset) and item.name.rpartition("/")[2] != "file":
            value = item[()]
            plain = isinstance(value, numpy.ndarray) and not value.dtype.hasobject
            found[name] = hashlib.sha256(value.tobytes() if plain else named(repr(value)).encode()).hexdigest()

    with h5py.File(path) as file:
        look("", file)
        file.visititems(look)
    return found


def content(run, made, depth=3):
    """The parts of a concept, with what it refers to, or of anything else that a command returns."""
    if not hasattr(made, "base") or not hasattr(made, "id"):
        return {"value": repr(made)}

    def named(text):
        def what(match):
            there = match[0] != made.id and depth > 0 and run.base.path(match[0]).exists()
            return hashlib.sha256(repr(sorted(content(run, run.base.concept(match[0]), depth - 1).items())).encode()).hexdigest() if there else ""

        return re.sub(r"\b[a-z][a-z_]*_\d+\b", what, text)

    path = run.base.path(made.id)
    files = sorted(path.parent.rglob("*.h5")) if path.name == "index.h5" else [path]
    return {f"{k}{part}": value for k, file in enumerate(files) for part, value in parts_of(file, named).items()}


def files_of(run):
    """What commands that print have written so far: content by path, and what the run remembers of it."""
    paths = {pathlib.Path(path) for path in run.written_units.values()}
    return {path: path.read_bytes() for path in paths if path.is_file()}, dict(run.written_units), copy.deepcopy(getattr(run, "plots", None))


def put_files(run, state):
    content, units, drawings = state
    for path in {pathlib.Path(path) for path in run.written_units.values()} - content.keys():
        path.unlink(missing_ok=True)
    for path, was in content.items():
        path.write_bytes(was)
    run.written_units = dict(units)
    if drawings is not None:
        run.plots = copy.deepcopy(drawings)


@contextlib.contextmanager
def heard(lines):
    """What this process and those that it starts print goes to `lines`, without the seconds that end rows of Newton's table."""
    for stream in (sys.stdout, sys.stderr):
        stream.flush()
    were = [os.dup(1), os.dup(2)]
    with tempfile.TemporaryFile() as file:
        try:
            for number in (1, 2):
                os.dup2(file.fileno(), number)
            yield
        finally:
            for stream in (sys.stdout, sys.stderr):
                stream.flush()
            for number, was in zip((1, 2), were):
                os.dup2(was, number)
                os.close(was)
            file.seek(0)
            text = file.read().decode(errors="replace")
            lines.extend(re.sub(r"[0-9.]+\s*\|$", "|", line.rstrip()) for line in text.splitlines())


class Walk:
    def __init__(self, launcher_calls, current, plugins, error, to_be, kind_of):
        """@param to_be the type of a name that a command makes a concept of"""
        self.calls, self.current, self.plugins, self.error, self.to_be, self.kind_of = launcher_calls, current, plugins, error, to_be, kind_of
        self.file = pathlib.Path(os.environ["WALK_FILE"])
        self.busy = False

    def tried(self):
        """keyword -> how often it has been tried in vain; infinitely often where it has changed something."""
        tries = {}
        for path, verdict, *_ in lines(self.file):
            tries[path] = tries.get(path, 0) + (1 if verdict == "same" else TRIES)
        return tries

    def enter(self, path, verdict, where):
        """@param where the first part that is another one"""
        with self.file.open("a") as file:
            file.write(json.dumps([path, verdict, os.environ.get("WALK_STUDY", ""), where]) + "\n")

    def call(self, original, command, given):
        run = self.current.study
        if self.busy or run is None or not run.open or command.name in FRAME or getattr(run, "check", None):
            return original(command, **given)
        row = self.plugins.command(command.name)
        tries = self.tried()
        todo = {}
        for path, keyword in leaves(command.name, row, {k: v for k, v in given.items() if k != "reuse"}):
            if tries.get(path, 0) < TRIES and self.kind_of(keyword) == "taken":
                todo[path] = keyword
        if not todo:
            return original(command, **given)
        reused = given.get("reuse")
        before, written = self.saved(run, reused), files_of(run)
        named = {name: value.name if isinstance(value, self.to_be) else value for name, value in given.items()}
        names = {name for name, keyword in row.get("keyword", {}).items() if keyword.get("makes")}
        call, made, refused = self.with_names(original, names), None, None
        self.busy = True
        try:
            made = original(command, **given)
        except self.error as error:  # a refusal is what a command does too
            refused = error
        finally:
            self.busy = False
        after, left = self.saved(run, reused), files_of(run)
        self.busy = True
        checks = len(run.checks)
        try:
            first = self.outcome(run, call, command, named, before, reused, written)
            again = self.outcome(run, call, command, named, before, reused, written)
            noise = {part for part in first.keys() | again.keys() if first.get(part) != again.get(part)}
            for path, keyword in todo.items():
                parts = path.split("/")[1:]
                verdict, where = "same", ""
                for other in self.others(keyword):
                    now = self.outcome(run, call, command, changed(named, parts, other), before, reused, written)
                    if other is None and set(now) == {"error"} and now["error"].startswith("KEYWORD") and "error" not in first:
                        continue  # without it there is no command: with another value, then
                    others = sorted(part for part in (first.keys() | now.keys()) - noise if now.get(part) != first.get(part))
                    if others:
                        verdict, where = "changes", others[0]
                        break
                self.enter(path, verdict, where)
        finally:
            self.put(run, reused, after)
            put_files(run, left)
            for folder in (before, after):
                if folder:
                    shutil.rmtree(folder.parent, ignore_errors=True)
            del run.checks[checks:]
            self.busy = False
            if hasattr(made, "id") and hasattr(made, "label"):
                self.calls._enter(run, made.label, made, "")
        if refused:
            raise refused
        return made

    def with_names(self, original, names):
        """The command, called with a new CO of the same name in the place of each text that is the name of a concept to be made."""
        def call(command, **given):
            return original(command, **{name: self.to_be(value) if name in names and isinstance(value, str) else value for name, value in given.items()})

        return call

    @staticmethod
    def others(keyword):
        """What stands for the value: nothing first."""
        yield None
        if "into" in keyword:
            yield from keyword["into"]
        elif keyword["type"] == "real":
            yield from (0.37, 2.0)
        elif keyword["type"] == "integer":
            yield from (1, 2)
        else:
            yield "NOTHING"

    def outcome(self, run, call, command, given, before, reused, written):
        self.put(run, reused, before)
        put_files(run, written)
        said = []
        try:
            with heard(said):
                made = call(command, **given)
        except self.error as error:
            return {"error": error.id_message}
        except Exception as error:
            return {"error": type(error).__name__}
        parts = {f"said {k}": line for k, line in enumerate(said)}
        if made is not None:
            return {**parts, **content(run, made)}
        for unit, path in run.written_units.items():
            if pathlib.Path(path).is_file():
                parts.update({f"unit {unit} {part}": value for part, value in parts_of(pathlib.Path(path)).items()})
        return parts

    @staticmethod
    def saved(run, concept):
        """A copy of what reuse= changes, in a folder of its own."""
        if not hasattr(concept, "id"):
            return None
        path = run.base.path(concept.id)
        folder = pathlib.Path(tempfile.mkdtemp(prefix="walk_")) / "saved"
        if path.name == "index.h5":
            shutil.copytree(path.parent, folder)
        else:
            folder.mkdir()
            shutil.copy2(path, folder / path.name)
        return folder

    @staticmethod
    def put(run, concept, saved):
        if saved is None:
            return
        path = run.base.path(concept.id)
        if path.name == "index.h5":
            shutil.rmtree(path.parent, ignore_errors=True)
            shutil.copytree(saved, path.parent)
        else:
            shutil.copy2(saved / path.name, path)


def install():
    from lacon.core import current, labels, plugins
    from lacon.core.concepts import CO
    from lacon.core.messages import AsterError
    from lacon.run import calls
    from lacon.tools.keyword_table import kind_of

    walk, original = Walk(calls, current, plugins, AsterError, CO, kind_of), calls.Command.__call__
    labels.is_own = lambda frame, own=labels.is_own: own(frame) or frame.f_code.co_filename == __file__

    def called(command, *args, **given):
        return original(command, *args, **given) if args else walk.call(original, command, given)

    calls.Command.__call__ = called
