"""What files of code_aster import: its modules under their names, symbolic tensors."""
