"""What a name that is not known was probably to be."""

from . import catalog


def nearest(name, known):
    """"; the nearest one is X", or nothing."""
    import difflib  # start-up: only a wrong name needs it

    if not isinstance(name, str):
        return ""
    upper = {str(k).upper(): str(k) for k in known}
    close = difflib.get_close_matches(name.upper(), upper, 1, 0.5)
    return catalog.part("nearest", name=upper[close[0]]) if close else ""
