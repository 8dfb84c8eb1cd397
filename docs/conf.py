"""Sphinx configuration of the documentation website.

docs/build.sh runs Sphinx in a folder with a copy of docs/ and links to the rest of the repository."""
import os
from pathlib import Path

from docutils import nodes
from sphinx import addnodes

project = "pkmopt"
author = "the pkmopt authors"
release = os.environ["PKM_DOCS_VERSION"]  # version and revision of the program that wrote the reference
version = release.split()[0]
released = f"## [{version}] - unreleased" not in Path("../CHANGELOG.md").read_text()
copyright = f"2026, the pkmopt authors. Version {release}"

extensions = ["myst_parser", "breathe", "sphinx.ext.mathjax", "sphinx_copybutton", "sphinx.ext.autodoc"]
nitpicky = True

myst_enable_extensions = ["deflist", "dollarmath", "substitution"]
myst_substitutions = {"version": version, "release": release, "state": "released" if released else "not released yet"}
myst_heading_anchors = 4

breathe_projects = {"pkmopt": os.environ["PKM_DOCS_XML"]}
breathe_default_project = "pkmopt"
breathe_show_include = False
# Identifiers without a page: those of the standard library and Eigen, template parameters, and types that the public
# headers use but users do not need.
nitpick_ignore_regex = [
    ("cpp:identifier", r"(std|Eigen)(::.*)?"),
    ("cpp:identifier", r"u?int\d+_t|size_t|pkm|S|N|pkm::Abilities"),
    ("cpp:identifier", r"(Dual|Dual4|VoxelGrid|AxisVector|AxisMatrix|Vector|Matrix|MatrixUpTo|MatrixOf|SmallMatrix|"
                       r"Capsule|Scratch|SourceText|StartOutcome|UnmergedRun|StopReason|Front|kMaxJoints|Obstacles|"
                       r"TimeGraph|ConfigValue|TomlValue|LargestSolidFinder|SampledValue|BuiltMachines|LimbCopy|Yield|"
                       r"ToleranceModel|expression)"
                       r"(<.*>|::.*)?"),
]

# The reference of the Python package is made from its docstrings; annotations would name types without a page.
autodoc_typehints = "none"
autodoc_member_order = "bysource"
nitpick_ignore_regex.append(("py:.*", r"(numpy|pandas|matplotlib)\..*"))

html_theme = "furo"
html_title = f"pkmopt {version}" + ("" if released else ", unreleased")
html_static_path = ["_static"]
html_css_files = ["katex/katex.css", "site.css"]
html_js_files = [("katex/katex.js", {"defer": "defer"}), ("katex/contrib/auto-render.js", {"defer": "defer"})]
html_copy_source = False
html_show_sphinx = False
mathjax_path = "formulas.js"  # the site's own copy of KaTeX renders the formulas, so that pages work offline
copybutton_prompt_text = "$ "
copybutton_only_copy_prompt_lines = True
pygments_style = "xcode"  # sufficient contrast on the background of site.css
pygments_dark_style = "github-dark"

# Pages of the site that include a file of the repository: file, or file#heading -> page#heading.
PAGES = {
    "README.md": "index",
    "engine/accelerators/four_ppa_two_par/README.md": "theory/4ppa-2par",
    "engine/storage/README.md": "reference/study-file",
    "experiments/README.md": "reference/studies",
    "experiments/README.md#certified-bounds": "theory/certain",
    "experiments/README.md#clearance": "theory/clearance#clearance-of-links",
    "experiments/README.md#models-for-simulation-programs": "reference/exports#models-for-simulation-programs",
    "experiments/README.md#motions": "reference/motions",
    "experiments/README.md#the-hybrid-robot": "theory/2t1r-p-hybrid#the-paper-and-this-program",
    "experiments/README.md#workspaces-and-tables-for-other-programs": "reference/exports",
    "experiments/catalogue.md": "reference/catalogue/index",
    "experiments/keys.md": "reference/keys",
    "experiments/mechanisms": "reference/mechanisms",
    "experiments/mechanisms/README.md": "reference/mechanisms",
    "experiments/slurm/README.md": "tutorials/cluster",
    "benchmarks/README.md": "speed",
    "CHANGELOG.md": "changes",
}


def links_of_included_files(app, document):
    """Resolve links in included READMEs, which are relative to the README.

    They are redirected to the page that includes the target, or to a copy of the target if no page includes it."""
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
