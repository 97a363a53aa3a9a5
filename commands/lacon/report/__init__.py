"""The page of `lacon report`: what is drawn of a result, what it shows to be trusted, and the file that holds it. The page itself is commands/viewer."""
