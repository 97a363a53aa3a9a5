"""`lacon` for tests of whole studies with another solver: SOLVEUR of every order is METHODE=LACON_TEST_SOLVER. LACON_MPI is the number of processes, which share factors from LACON_MPI_FROM equations on."""

import os
import sys

sys.path.insert(0, os.path.join(os.environ["LACON_SOURCE_DIR"], "commands"))

from lacon.base import orders  # noqa: E402
from lacon.main import main  # noqa: E402

_order = orders.order


def order(*arguments, **named):
    made = _order(*arguments, **named)
    if "SOLVEUR" in made["keywords"] and "LACON_TEST_SOLVER" in os.environ:
        for solver in made["keywords"]["SOLVEUR"]:
            solver.update(METHODE=os.environ["LACON_TEST_SOLVER"], RESI_RELA=1e-8)
    return made


orders.order = order
sys.exit(main())
