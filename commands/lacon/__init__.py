"""The command language of Lacon: runs code_aster command files. Start reading in main.py."""

version = "0.1.0"
