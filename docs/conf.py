"""Configuration of Sphinx for the site (docs/developers/site.md); docs/build calls it."""
import os
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT / "docs/_ext"), str(ROOT / "build/release/python")]

project = "plica"
author = "The plica authors"
copyright = "the plica authors"
version = release = re.search(r'^version = "(.+)"', (ROOT / "pyproject.toml").read_text(encoding="utf-8"), re.M)[1]

extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx.ext.mathjax", "sphinx_design",
              "sphinx_copybutton", "sphinxcontrib.bibtex", "plica_site"]
exclude_patterns = ["requirements.txt", "_ext", "_static"]

# Pages: Markdown as on code hosts.
myst_enable_extensions = ["dollarmath", "amsmath", "colon_fence", "html_image"]
myst_heading_anchors = 4
myst_url_schemes = ["http", "https", "mailto", "source", "bib"]
myst_dmath_double_inline = True

# Notebooks: run only with `docs/build --run-notebooks`; unchanged ones are not run again.
nb_execution_mode = os.environ.get("PLICA_NOTEBOOKS", "off")
nb_execution_cache_path = str(ROOT / "build/site-notebooks/cache")
nb_execution_in_temp = True
nb_execution_timeout = 300
nb_execution_raise_on_error = True
nb_execution_show_tb = True
nb_output_stderr = "remove"  # progress bars
nb_merge_streams = True

# The Python reference, from the docstrings.
default_role = "py:obj"
autodoc_typehints = "none"
autodoc_member_order = "bysource"
napoleon_google_docstring = False
napoleon_use_ivar = True
napoleon_use_param = False
napoleon_use_rtype = False
add_module_names = False

bibtex_bibfiles = ["references.bib"]
bibtex_cite_id = "cite-{key}"

# The theme, with nothing from the network.
html_theme = "pydata_sphinx_theme"
html_title = "plica"
html_static_path = ["_static", "../build/site-mathjax/tex-svg.js"]
html_css_files = ["plica.css"]
mathjax_path = "tex-svg.js"
html_show_sourcelink = False
html_copy_source = False
html_theme_options = {
    "logo": {"text": "plica"},
    "navbar_align": "left",
    "header_links_before_dropdown": 7,
    "show_prev_next": False,
    "show_toc_level": 2,
    "secondary_sidebar_items": {"**": ["page-toc"], "index": [], "gallery": []},
    "footer_start": ["copyright"],
    "footer_end": [],
    "pygments_light_style": "default",
    "pygments_dark_style": "github-dark",
}
html_sidebars = {"index": [], "gallery": [], "source/**": []}
