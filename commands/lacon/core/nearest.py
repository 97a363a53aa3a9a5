"""What a name that is not known was probably to be."""

from . import catalog


def nearest(name, known, likeness=0.5):
    """"; the nearest one is X", or nothing. @param likeness that it must have at least, 1 being the same"""
    import difflib  # start-up: only a wrong name needs it

    if not isinstance(name, str):
        return ""
    upper = {str(k).upper(): str(k) for k in known}
    close = difflib.get_close_matches(name.strip().upper(), upper, 1, likeness)
    return catalog.part("nearest", name=upper[close[0]]) if close else ""
