"""How the launcher and its tools end: exit statuses, and errors that are shown."""

import sys

from . import messages

#: exit statuses
done, user_error, solution_failed, internal_error, check_failed = 0, 2, 3, 4, 5


def guarded(work):
    """What `work` returns, (exit status, words of the diagnosis); errors that it throws are shown."""
    try:
        return work()
    except messages.AsterError as error:
        for item in error.messages:
            messages.show(item)
        return error.status, error.diagnostic
    except FileNotFoundError as error:  # no catalogue: an installation that is not whole
        print(f"<F> <INTERNAL> {error}", file=sys.stderr)
        return internal_error, "<F>_ABNORMAL_ABORT"
