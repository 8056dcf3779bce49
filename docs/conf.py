"""Sphinx settings of the documentation; scripts/docs runs it."""
project = "Remote-sensing suite"
author = "The suite's authors"
extensions = ["myst_parser"]
myst_enable_extensions = ["colon_fence"]
myst_heading_anchors = 4
exclude_patterns = ["files.list"]
highlight_language = "none"
suppress_warnings = ["misc.highlighting_failure"]  # grammars are YAML with alternatives in them
html_theme = "alabaster"
html_theme_options = {"fixed_sidebar": True, "page_width": "1200px", "sidebar_width": "260px", "show_powered_by": False,
                      "description": "Scene preparation and radiometric rendering for remote sensing"}
html_sidebars = {"**": ["about.html", "searchbox.html", "navigation.html"]}
html_static_path = ["static"]
html_css_files = ["site.css"]
html_copy_source = False
html_show_sourcelink = False
html_show_copyright = False
