"""Concepts as a command file sees them: the methods that files of code_aster call, on the contents that base/ reads."""
