"""`CA.Mesh()` of code_aster: a mesh that a method reads into it."""

import re

from ..core import labels
from ..core.concepts import CO


class NewMesh(CO):
    """No mesh yet; readMedFile() and the like make it one, by LIRE_MAILLAGE."""

    def __init__(self, commands):
        """@param commands by name"""
        super().__init__(labels.label(labels.user_frame()) or "mesh")
        self._commands = commands

    def readMedFile(self, path, meshname="", *_, **__):
        self._read(path, FORMAT="MED", **({"NOM_MED": meshname} if meshname else {}))

    def readAsterFile(self, path, *_, **__):
        self._read(path, FORMAT="ASTER")

    def readGmshFile(self, path, *_, **__):
        self._read(path, FORMAT="GMSH")

    def __getattr__(self, name):
        raise AttributeError(f"this mesh has nothing in it yet, and no {name}: readMedFile, readAsterFile and readGmshFile read one")

    def _read(self, path, **keywords):
        """fort.20 is unit 20, any other path a file."""
        unit = re.fullmatch(r"(?:.*/)?fort\.([1-9][0-9]?)", str(path))
        number = int(unit[1]) if unit else self._commands["DEFI_FICHIER"](ACTION="ASSOCIER", FICHIER=str(path), ACCES="OLD", TYPE="BINARY")
        made = self._commands["LIRE_MAILLAGE"](UNITE=number, **keywords)
        if not unit:
            self._commands["DEFI_FICHIER"](ACTION="LIBERER", UNITE=number)
        self.become(made.base, made.id)
