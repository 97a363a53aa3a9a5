"""Files of units within a sandbox."""

import os
import pathlib


class Stage:
    """The folder that a launcher in a sandbox may write beside its base: in it, each unit has a folder for its file."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)

    def file(self, number, path):
        """Where the file of a unit is written that goes to `path`."""
        folder = self.folder / "units" / str(number)
        folder.mkdir(parents=True, exist_ok=True)
        return str(folder / os.path.basename(path))
