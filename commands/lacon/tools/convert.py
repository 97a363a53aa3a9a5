"""`lacon convert mesh.msh mesh.med`: a mesh from one format to another, with the operators of LIRE_MAILLAGE and IMPR_RESU."""

import keyword
import os
import pathlib
import tempfile

from ..core.command_line import CommandLine
from ..run import execution, launch, study

#: what a file's suffix says: the FORMAT of LIRE_MAILLAGE, that of IMPR_RESU
read_formats = {".med": "MED", ".mmed": "MED", ".msh": "GMSH", ".mail": "ASTER"}
write_formats = {".med": "MED", ".pvd": "VTU", ".vtu": "VTU", ".msh": "GMSH", ".mail": "ASTER"}

_study = """DEBUT()
{name} = LIRE_MAILLAGE(UNITE=20, FORMAT='{read}')
IMPR_RESU(UNITE=80, FORMAT='{write}', RESU=_F(MAILLAGE={name}))
FIN()
"""


def parser():
    """Of its command line."""
    made = CommandLine(prog="lacon convert", description="Writes a mesh in another format.")
    made.add("source", metavar="MESH", help="the mesh: {formats}", filled={"formats": ", ".join(read_formats)})
    made.add("target", metavar="FILE", help="the file to write: {formats}; it is replaced where it is there",
             filled={"formats": ", ".join(write_formats)})
    return made


def run(arguments):
    """@return exit status"""
    asked = parser()
    options = asked.parse_args(arguments)
    formats = []
    for path, known in ((options.source, read_formats), (options.target, write_formats)):
        suffix = pathlib.Path(path).suffix.lower()
        if suffix not in known:
            asked.wrong("file_named", file=path, names=", ".join(known))
        formats.append(known[suffix])
    if os.path.exists(options.target) and os.path.exists(options.source) and os.path.samefile(options.source, options.target):
        asked.wrong("file_is_mesh", file=options.target)
    stem = pathlib.Path(options.source).stem
    provided = execution.provided_names()
    name = stem if stem.isidentifier() and not keyword.iskeyword(stem) and stem not in provided else "MESH"
    with tempfile.TemporaryDirectory(prefix="lacon_convert_") as folder:
        units = {20: options.source, 80: options.target}
        this = study.Study(pathlib.Path(folder) / "convert.base", units, provided=provided)
        text = _study.format(name=name, read=formats[0], write=formats[1])
        status, _ = launch.run_study(this, lambda: execution.run_text(this, "lacon convert", text))
    return status
