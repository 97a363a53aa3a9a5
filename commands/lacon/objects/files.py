"""Files that methods of concepts write, by the commands that write them."""

from ..core import current


def print_med(path, **what):
    """@param what keywords of IMPR_RESU/RESU"""
    commands = current.commands
    number = commands["DEFI_FICHIER"](ACTION="ASSOCIER", FICHIER=str(path), ACCES="NEW", TYPE="BINARY")
    try:
        commands["IMPR_RESU"](FORMAT="MED", UNITE=number, RESU=what)
    finally:
        commands["DEFI_FICHIER"](ACTION="LIBERER", UNITE=number)
