"""Sphinx's configuration of the site. docs/make_site.py lays the pages out, and builds it."""

import symfpu

project = "symfpu"
author = "the symfpu developers"
project_copyright = author
version = release = symfpu.__version__

extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx_copybutton",
    "sphinx_design",
    "press.docstrings",
    "press.formulas",
    "press.links",
]
root_doc = "index"
exclude_patterns = ["README.md"]
nitpicky = True
smartquotes = False
show_warning_types = True

myst_enable_extensions = ["colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 3
nb_execution_mode = "off"  # pictures and numbers are those stored; tests run the notebooks
nb_mime_priority_overrides = [
    ("html", "text/html", 1),
    ("html", "image/png", 2),
    ("html", "text/latex", 3),
]

autodoc_member_order = "bysource"
autodoc_typehints = "none"
add_module_names = False
python_use_unqualified_type_names = True
toc_object_entries_show_parents = "hide"

html_math_renderer = "mathml"
html_theme = "pydata_sphinx_theme"
html_title = f"symfpu {version}"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_show_sourcelink = False
html_copy_source = False
html_theme_options = {
    "logo": {"text": "symfpu"},
    "navigation_with_keys": False,
    "show_nav_level": 1,
    "header_links_before_dropdown": 6,
    "footer_start": ["copyright"],
    "footer_end": [],
    "secondary_sidebar_items": ["page-toc"],
}
copybutton_prompt_text = r">>> |\.\.\. |\$ "
copybutton_prompt_is_regexp = True
