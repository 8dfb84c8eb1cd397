"""Sphinx' settings. docs/build.sh starts it, in a folder where docs/ lies beside the rest of the repository."""
import os
from pathlib import Path

from docutils import nodes
from sphinx import addnodes

project = "pkmopt"
author = "the pkmopt authors"
release = os.environ["PKM_DOCS_VERSION"]  # as the program that wrote the reference tells it
version = release.split()[0]
released = f"## [{version}] - unreleased" not in Path("../CHANGELOG.md").read_text()
copyright = f"2026, the pkmopt authors. Of version {release}"

extensions = ["myst_parser", "breathe", "sphinx.ext.mathjax", "sphinx_copybutton"]
nitpicky = True

myst_enable_extensions = ["deflist", "dollarmath", "substitution"]
myst_substitutions = {"version": version, "release": release, "state": "released" if released else "not released yet"}
myst_heading_anchors = 4

breathe_projects = {"pkmopt": os.environ["PKM_DOCS_XML"]}
breathe_default_project = "pkmopt"
breathe_show_include = False
# Names that have no pages here: of the standard library and of Eigen, of template parameters, and of types that headers
# for users only pass on.
nitpick_ignore_regex = [
    ("cpp:identifier", r"(std|Eigen)(::.*)?"),
    ("cpp:identifier", r"u?int\d+_t|size_t|pkm|S|N"),
    ("cpp:identifier", r"(Dual4|AxisVector|AxisMatrix|Vector|Matrix|MatrixUpTo|MatrixOf|SmallMatrix|Capsule|Scratch|"
                       r"SourceText|StartOutcome|StartAhead|StopReason|Front|kMostJoints|Obstacles|TimeGraph|graph)(<.*>|::.*)?"),
]

html_theme = "furo"
html_title = f"pkmopt {version}" + ("" if released else ", unreleased")
html_static_path = ["_static"]
html_css_files = ["katex/katex.css", "site.css"]
html_js_files = [("katex/katex.js", {"defer": "defer"}), ("katex/contrib/auto-render.js", {"defer": "defer"})]
html_copy_source = False
html_show_sphinx = False
mathjax_path = "formulas.js"  # KaTeX of the site itself sets the formulas: pages open without a network
copybutton_prompt_text = "$ "
copybutton_only_copy_prompt_lines = True
pygments_style = "xcode"  # its colours can be read on the ground of site.css
pygments_dark_style = "github-dark"

# Where the site has what a file of the repository says: file, or file#heading -> page#heading.
PAGES = {
    "README.md": "index",
    "engine/storage/README.md": "reference/study-file",
    "experiments/README.md": "reference/studies",
    "experiments/README.md#clearance": "theory/clearance#clearance-of-links",
    "experiments/README.md#the-hybrid-robot": "theory/2t1r-p-hybrid#the-paper-and-this-program",
    "experiments/README.md#workspaces-and-tables-for-other-programs": "reference/exports",
    "experiments/catalogue.md": "reference/catalogue/index",
    "experiments/mechanisms": "reference/mechanisms",
    "experiments/mechanisms/README.md": "reference/mechanisms",
    "experiments/slurm/README.md": "tutorials/cluster",
    "benchmarks/README.md": "speed",
    "CHANGELOG.md": "changes",
}


def links_of_included_files(app, document):
    """Links of READMEs that pages include are relative to those READMEs. They lead to the page that has the file's
    text, and to a copy of the file where no page has it."""
    root = Path(app.srcdir).parent
    for node in list(document.findall(addnodes.pending_xref)):
        source = Path(str(node.source).split(":")[0])
        if node.get("reftype") != "myst" or source.is_relative_to(app.srcdir):
            continue
        path, _, heading = node["reftarget"].partition("#")
        file = os.path.relpath(os.path.normpath(source.parent / path) if path else source, root)
        page = PAGES.get(f"{file}#{heading}") or PAGES.get(file)
        if page:
            name, _, anchor = page.partition("#")
            relative = os.path.relpath(name, os.path.dirname(app.env.docname) or ".")
            node["reftarget"] = f"{relative}.md" + (f"#{anchor}" if anchor else "")
        elif (root / file).is_file():
            copy = addnodes.download_reference(refdoc=app.env.docname, reftarget=f"/../{file}", refdomain=None,
                                               reftype="myst", refexplicit=True, refwarn=False)
            copy += [nodes.literal("", child.astext(), classes=["xref", "download"]) for child in node.children]
            node.replace_self(copy)


def setup(app):
    app.connect("doctree-read", links_of_included_files, priority=100)
