"""Sphinx over the Markdown of the tree: docs/site/build copies it and states where the parts are."""
import pathlib
import re

TREE = pathlib.Path(__file__).resolve().parents[2]

project = "saccade"
author = copyright = "the saccade authors"
version = release = re.search(r"project\(saccade VERSION ([0-9.]+)", (TREE / "CMakeLists.txt").read_text())[1]

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.autosummary", "sphinx.ext.napoleon", "sphinx_copybutton"]
root_doc = "README"
include_patterns = ["*.md", "docs/*.md", "docs/**/*.md", "reports/*.md", "reports/benchmark/README.md", "tests/calibration/README.md", "examples/ci/README.md",
                    "submit/README.md"]
exclude_patterns = ["docs/site/*"]

# The slugs of headings are those of GitHub, which the links of the pages mean.
myst_heading_anchors = 5
highlight_language = "none"
# Excerpts of files, with "..." where something is left out, are no valid JSON or YAML.
suppress_warnings = ["misc.highlighting_failure", "myst.header"]

autodoc_member_order = "bysource"
autodoc_typehints = "signature"
napoleon_google_docstring = False

html_theme = "furo"
html_title = f"saccade {version}"
html_show_sphinx = False
html_show_sourcelink = False
html_copy_source = False
