"""Sphinx: the documentation as a site. ./commands/docs puts the pages together and calls it."""

project = "Lacon"
author = "The Lacon project"
copyright = "The Lacon project"
extensions = ["myst_parser"]
myst_heading_anchors = 4
html_theme = "sphinx_rtd_theme"
html_static_path = ["static"]
html_css_files = ["wide.css"]  # tables of results are wider than the theme's 800 pixels
html_show_sphinx = False
html_show_copyright = False
html_show_sourcelink = False
exclude_patterns = []
suppress_warnings = ["myst.header"]  # a message is a heading of its own below the title
