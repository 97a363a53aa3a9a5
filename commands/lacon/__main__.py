"""`python3 -m lacon` is the launcher."""

import sys

from lacon.main import main

sys.exit(main())
