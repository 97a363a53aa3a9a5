"""What everything else stands on: messages, the catalogue, keywords against it, concepts as keywords hold them."""
