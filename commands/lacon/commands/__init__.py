"""Commands that Python does itself, one file a family; implementations.py says which one does what."""
