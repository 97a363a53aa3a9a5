"""DEFI_MATERIAU."""

from ..core.concepts import Concept


def defi_materiau(call):
    """One group a factor keyword, its parameters as attributes; a function by its id."""

    def fill(file):
        for name, occurrences in call.keywords.items():
            if isinstance(occurrences, list) and occurrences and isinstance(occurrences[0], dict):
                group = file.create_group(name)
                for parameter, value in occurrences[0].items():
                    group.attrs[parameter] = value.id if isinstance(value, Concept) else value

    return call.write("material", fill)
