"""Command lines in the language of the user: `lacon --help`, that of each tool, and what is wrong with options."""

import argparse
import contextlib

from . import catalog


@contextlib.contextmanager
def _own_words():
    """argparse asks gettext for its words, and Python brings no French ones: the catalogue has them."""
    plain = argparse._, argparse.ngettext
    argparse._, argparse.ngettext = catalog.option_words, lambda one, several, count: catalog.option_words(one if count == 1 else several)
    try:
        yield
    finally:
        argparse._, argparse.ngettext = plain


class CommandLine(argparse.ArgumentParser):
    """An ArgumentParser whose description, epilog and help lines are said by the catalogue (options.fr.toml)."""

    def __init__(self, *, description, epilog=None, **more):
        with _own_words():
            super().__init__(description=catalog.option_words(description), epilog=epilog and catalog.option_words(epilog), **more)

    def add(self, *names, help, group=None, filled=(), **how):  # noqa: A002
        """add_argument(). @param group a group of this command line that gets it  @param filled the gaps of its help line"""
        return (group or self).add_argument(*names, help=catalog.option_words(help).format(**dict(filled)), **how)

    def parse_args(self, *arguments, **named):
        with _own_words():
            return super().parse_args(*arguments, **named)

    def format_usage(self):
        with _own_words():
            return super().format_usage()

    def format_help(self):
        with _own_words():
            return super().format_help()

    def wrong(self, name, **values):
        """End: what is wrong is a row of messages/parts.toml with its gaps filled."""
        with _own_words():
            self.error(catalog.part(name, **values))
