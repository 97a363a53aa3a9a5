"""Which module does which command; in it the function of the command's name, in small letters, takes a Call."""

import importlib

_families = {
    "begin_end": ("DEBUT", "POURSUITE", "FIN", "DETRUIRE"),
    "files": ("INCLUDE", "DEFI_FICHIER", "INFO_EXEC_ASTER", "PRE_GMSH"),
    "functions": ("DEFI_FONCTION", "DEFI_CONSTANTE", "DEFI_NAPPE", "CALC_FONC_INTERP"),
    "lists": ("DEFI_LIST_REEL", "DEFI_LIST_ENTI", "DEFI_LIST_INST"),
    "formulas": ("FORMULE",),
    "materials": ("DEFI_MATERIAU",),
    "test_resu": ("TEST_RESU",),
    "table_commands": ("CREA_TABLE", "IMPR_TABLE", "TEST_TABLE", "RECU_TABLE", "EXTR_TABLE"),
    "calc_table": ("CALC_TABLE",),
    "function_commands": ("IMPR_FONCTION", "TEST_FONCTION", "RECU_FONCTION", "CALC_FONCTION", "INFO_FONCTION"),
    "information": ("COPIER", "INFO_RESU", "MACR_INFO_MAIL"),
    "reading": ("LIRE_TABLE", "LIRE_FONCTION"),
    "post_releve_t": ("POST_RELEVE_T",),
}
#: commands with an operator -> what makes of their keywords those of the order
_prepared = {"AFFE_CHAR_MECA_F": ("nodal_forces", "along_the_mesh")}
_home = {command: family for family, commands in _families.items() for command in commands}


def commands():
    """Every command that Python does itself."""
    return tuple(_home)


def home(command):
    """The module that does a command."""
    return _home[command]


def implementation(command):
    """The function(call) of a command. Its module is imported when it is first called: a study uses few of them."""
    return getattr(importlib.import_module(f".{_home[command]}", __package__), command.lower())


def prepared(call):
    """The keywords of a command as its operator wants them."""
    if call.command not in _prepared:
        return call.keywords
    module, function = _prepared[call.command]
    return getattr(importlib.import_module(f".{module}", __package__), function)(call)
