"""The site of the documents: Sphinx over a copy of docs that scripts/site.sh makes.

The pages stay as they are on their own; what Sphinx wants otherwise is changed while it reads them. The first
page is the README of the repository.
"""

import os
import re
import shutil
from pathlib import Path

SOURCE = Path(__file__).parent
ROOT = Path(re.search("^ROOT = (.*)$", (SOURCE / "place").read_text(), re.M)[1])

project = "vcor"
author = "the vcor developers"
release = version = re.search(r'^version = "(.*)"$', (ROOT / "fpm.toml").read_text(), re.M)[1]
extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx-mathjax-offline"]
root_doc = "index"
exclude_patterns = ["README.md", "site"]
html_theme = "furo"
html_title = f"vcor {release}"
html_static_path = ["site/static"]
html_css_files = ["vcor.css"]
html_logo = "site/logo.svg"
highlight_language = "none"
if "GITHUB_REPOSITORY" in os.environ:
    html_theme_options = {
        "source_repository": "{GITHUB_SERVER_URL}/{GITHUB_REPOSITORY}/".format(**os.environ),
        "source_branch": "main",
        "source_directory": "docs/",
    }

myst_enable_extensions = ["dollarmath", "html_image"]
myst_heading_anchors = 4
nb_execution_mode = "force"
nb_execution_raise_on_error = True
nb_execution_timeout = 600
autodoc_member_order = "bysource"
autodoc_typehints = "description"
# Pygments knows no csv
suppress_warnings = ["misc.highlighting_failure"]

# The order in which a reader needs the pages
PARTS = {
    "Begin": ["getting_started", "which_model", "recipes", "tutorial"],
    "Impacts": ["impact", "structures", "validity", "accuracy", "faq"],
    "Materials": ["materials", "data", "identification"],
    "Use": ["sweeps", "figures", "page", "python", "python_api", "exchange"],
    "Reference": ["commands", "input", "output"],
    "Background": ["theory", "numerics", "measurements", "reproducing_the_paper", "measured", "changes"],
}


def toctree():
    """Every page of the site, by its part."""
    named = {page for pages in PARTS.values() for page in pages}
    found = {path.stem for path in SOURCE.glob("*.md")} - {"README", "index"}
    extra = sorted(found - named)
    parts = PARTS if not extra else {**PARTS, "More": extra}
    text = ""
    for part, pages in parts.items():
        listed = [page for page in pages if (SOURCE / f"{page}.md").exists() or page == "tutorial"]
        text += "\n```{toctree}\n:hidden:\n:caption: " + part + "\n\n" + "\n".join(listed) + "\n```\n"
    return text


def link(folder):
    """Links of a page in a folder: to what the site does not have, such as a folder of the repository, the
    words alone."""

    def change(found):
        words, target = found[1], found[2]
        if target.endswith("tutorial.ipynb"):
            return f"[{words}](tutorial.ipynb)"
        path = (folder / target.partition("#")[0]).resolve()
        if path == (ROOT / "README.md").resolve():
            return f"[{words}](index.md)"
        outside = path.suffix == ".md" and not path.is_relative_to(SOURCE.resolve())
        return words if path.is_dir() or outside else found[0]

    return change


def start(text):
    """The README as the first page: no badge, its folder is one above that of the pages."""
    text = re.sub(r"^\[!\[.*?\]\([^)]*\)\]\([^)]*\) ", "", text, flags=re.M)
    text = re.sub(r"\[([^\]]+)\]\(docs/README.md\)", r"\1", text)
    text = text.replace('src="docs/', 'src="').replace("](docs/", "](").replace("](CHANGELOG.md)", "](changes.md)")
    return re.sub(r"\]\((?=examples/|CONTRIBUTING|CITATION|LICENSE)", "](../", text)


def prepare(_app, name, source):
    """Mathematics in blocks as MyST has it; a list of all pages below the first."""
    text = start(source[0]) if name == root_doc else source[0]
    text = re.sub("^```math$", "```{math}", text, flags=re.M)
    if name != "tutorial":
        folder = (SOURCE / name).parent
        text = re.sub(r"\[([^\]]+)\]\((\.\./[^)\s]+)\)", link(folder), text)
    if name == root_doc:
        text += '\n<a href="fortran/index.html">Reference of the Fortran library</a>\n' + toctree()
    if name == "exchange":
        pages = sorted(path.stem for path in (SOURCE / "exchange").glob("*.md"))
        text += "\n```{toctree}\n:hidden:\n\n" + "\n".join(f"exchange/{page}" for page in pages) + "\n```\n"
    source[0] = text


def finish(app, error):
    """Figures that pages show by HTML, which Sphinx does not see."""
    if error is None:
        for path in SOURCE.rglob("*.svg"):
            target = Path(app.outdir) / path.relative_to(SOURCE)
            target.parent.mkdir(exist_ok=True, parents=True)
            shutil.copy(path, target)


def setup(app):
    """Connect the two."""
    app.connect("source-read", prepare)
    app.connect("build-finished", finish)
