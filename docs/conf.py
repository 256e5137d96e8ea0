"""Configuration of Sphinx: `make docs`."""

import logging
import sys
import tomllib
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent / "extensions"))

from figure_style import STYLE

import beetle_ik

# Examples log what they solve; the pages show their output alone.
logging.getLogger("beetle_ik").setLevel(logging.WARNING)

project = "beetle-ik"
copyright = "the beetle-ik developers"
version = release = beetle_ik.__version__

extensions = [
    "docstrings",
    "matplotlib.sphinxext.plot_directive",
    "myst_nb",
    "paper_figures",
    "recordings",
    "signatures",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.mathjax",
    "sphinx.ext.napoleon",
    "sphinx_copybutton",
    "sphinx_gallery.gen_gallery",
]
exclude_patterns = ["build", "gallery/*.ipynb"]
default_role = "py:obj"  # one backquote in docstrings

html_theme = "furo"
html_title = "beetle-ik"
html_copy_source = False
html_static_path = ["static"]
html_css_files = ["site.css"]
html_logo = "images/logo.svg"
html_favicon = "images/logo.svg"
html_theme_options = {
    "light_css_variables": {
        "color-brand-primary": "#00734f",
        "color-brand-content": "#00734f",
        "figure-filter": "none",
    },
    "dark_css_variables": {
        "color-brand-primary": "#3fc79a",
        "color-brand-content": "#3fc79a",
        "figure-filter": "invert(1) hue-rotate(180deg)",
    },
}

# The address of the repository, once it is filled in: pages link to their source.
_project = tomllib.loads(
    (Path(__file__).parents[1] / "pyproject.toml").read_text(encoding="utf-8")
)["project"]
if "FILL-IN" not in _project["urls"]["Repository"]:
    html_theme_options |= {
        "source_repository": _project["urls"]["Repository"],
        "source_branch": "main",
        "source_directory": "docs/",
    }

myst_html_meta = {
    "description": _project["description"],
    "keywords": ", ".join(_project["keywords"]),
}
myst_enable_extensions = ["colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 3

# Each page is a notebook; those with Python blocks are executed.
nb_custom_formats = {".md": ["notebooks.read", {}, False]}
nb_execution_mode = "auto"
nb_execution_in_temp = True
nb_execution_raise_on_error = True
nb_execution_timeout = 120  # s
nb_merge_streams = True

# Attributes of a docstring are fields, not items beside the members of the class.
napoleon_use_ivar = True

autodoc_default_options = {
    "members": True,
    "undoc-members": True,
    "member-order": "bysource",
}
autodoc_typehints = "signature"
autosummary_generate = False
copybutton_prompt_text = r">>> |\.\.\. "
copybutton_prompt_is_regexp = True
maximum_signature_line_length = 72

plot_formats = [("png", 120)]
plot_rcparams = STYLE
plot_html_show_formats = False
plot_html_show_source_link = False
plot_include_source = False
plot_working_directory = str(Path(__file__).parent)

sphinx_gallery_conf = {
    "examples_dirs": "../examples",
    "gallery_dirs": "gallery",
    "filename_pattern": r"\.py$",
    # A program for MuJoCo, with an argument.
    "ignore_pattern": r"29_wrong_model\.py$",
    "thumbnail_size": (640, 480),
    "within_subsection_order": "FileNameSortKey",
    "capture_repr": (),
    "reset_modules": ("matplotlib", "figure_style.reset"),
    "remove_config_comments": True,
    "show_memory": False,
    "show_signature": False,
    "write_computation_times": False,
    "min_reported_time": 10,
    "download_all_examples": False,
    "plot_gallery": "True",
    "abort_on_example_error": True,
}
