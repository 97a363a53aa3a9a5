"""What a base holds as arrays, for tools, Python programs and notebooks: open(folder) of base.py. Reads, and never changes anything."""
