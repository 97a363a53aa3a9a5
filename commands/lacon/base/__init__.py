"""What a study leaves on disk and how it comes back: the base, contents of its concepts, names, expressions, orders to operators."""
