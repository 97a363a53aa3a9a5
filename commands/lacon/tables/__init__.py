"""Tables and curves as Python objects, as text and as pictures. Nothing here knows a base."""
