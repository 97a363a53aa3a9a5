"""A run: command files, the study that they share, calls of commands, export files, timings."""
