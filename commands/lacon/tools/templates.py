"""Studies that run as they are: the folders of commands/studies/templates, each a command file and the script of its mesh."""

import pathlib
import shutil

from ..core import outcome
from ..core.catalog import part
from ..core.messages import fail
from ..core.nearest import nearest

_studies = pathlib.Path(__file__).resolve().parents[2] / "studies"
_shared = _studies / "meshes.py"  #: what their meshes are made with


def known():
    """name -> the first sentence of its command file"""
    found = {}
    for folder in sorted((_studies / "templates").iterdir()):
        with open(folder / f"{folder.name}.comm", encoding="utf-8") as file:
            found[folder.name] = file.readline().lstrip("# ").strip().partition(". ")[0].rstrip(".")
    return found


def write(name, folder=None):
    """Put a template into a folder of its own. @return exit status  @throws AsterError NEW_1, NEW_2, STUDY_3"""
    names = list(known())
    if name not in names:
        fail("NEW_1", "lacon new --template", name=name, nearest=nearest(name, names), known=", ".join(names))
    target = pathlib.Path(folder or name)
    if target.exists():
        fail("NEW_2", "lacon new --template", folder=target)
    try:
        target.mkdir(parents=True)
        for path in (_studies / "templates" / name / f"{name}.comm", _studies / "templates" / name / "mesh.py", _shared):
            shutil.copyfile(path, target / path.name)
    except OSError as error:
        fail("STUDY_3", "lacon new --template", folder=target, reason=error.strerror)
    print(part("template_made", folder=target, name=name))
    return outcome.done
