"""One call of a command, as the functions that do it get it."""

from ..core.messages import fail


class Call:
    def __init__(self, study, command, keywords, where, label, reused=None):
        self.study = study
        self.command = command
        self.keywords = keywords
        self.where = where
        self.label = label
        self.reused = reused

    def write(self, kind, fill):
        """The concept this call makes, or the one it changes in place."""
        return self.study.base.write_concept(kind, self.label, self.command, self.keywords, fill, self.reused)

    def fail(self, identifier, path="", **values):
        fail(identifier, f"{self.command}{'/' + path if path else ''}, {self.where}", **values)
