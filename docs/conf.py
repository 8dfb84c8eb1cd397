"""Sphinx configuration of the documentation website.

docs/build.sh runs Sphinx in a folder with a copy of docs/ and links to the rest of the repository."""
import os
import re
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

myst_enable_extensions = ["deflist", "dollarmath", "substitution", "html_image"]
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

# Files of the repository that are pages of the site as a whole. The pages exist on the site only.
FILES = {
    "CHANGELOG.md": "changes",
    "CONTRIBUTING.md": "contributing",
    "benchmarks/README.md": "benchmarks",
    "engine/accelerators/crr_cru/README.md": "theory/derivation-3crr-r-cru",
    "engine/accelerators/four_ppa_two_par/README.md": "theory/derivation-4ppa-2par",
    "engine/accelerators/hybrid/README.md": "theory/derivation-2t1r-p-hybrid",
    "engine/expression/README.md": "theory/expression",
    "engine/generic/corner_curves/README.md": "theory/derivation-corner-curves",
    "engine/generic/edges/README.md": "theory/derivation-edges",
    "engine/workspace/bounds/README.md": "theory/derivation-bounds",
    "experiments/slurm/README.md": "slurm",
    "tests/README.md": "tests",
}
for file, page in FILES.items():
    name = os.path.relpath(f"../{file}", os.path.dirname(page) or ".")
    Path(f"{page}.md").write_text(f"```{{include}} {name}\n:relative-images:\n```\n")

# Other files that pages link to: file, or file#heading -> page, or page#heading, of the site.
PAGES = {
    "README.md": "index",
    "engine/public_headers.txt": "reference/cpp/index",
    "engine/storage/README.md": "reference/study-file",
    "experiments/README.md": "reference/study/examples",
    "experiments/mechanisms": "reference/mechanism/examples",
    "experiments/mechanisms/README.md": "reference/mechanism/examples",
}


def page_of(file, heading):
    """Return (page, heading) of the site that shows a file of the repository; (None, "") if there is none."""
    notebook = re.fullmatch(r"docs/(notebooks/\S+)\.ipynb", file)
    if notebook:
        return notebook[1], ""
    if file in FILES:
        return FILES[file], heading
    page = PAGES.get(f"{file}#{heading}") or PAGES.get(file)
    return tuple(page.split("#")) if page and "#" in page else (page, "")


def links_to_files(app, document):
    """Redirect links to files of the repository, such as READMEs, to the page of the site that shows the file.

    Links in included READMEs are relative to the README. A file that no page shows is copied to the site."""
    root = Path(app.srcdir).parent
    folder = os.path.dirname(app.env.docname)
    for node in list(document.findall(lambda n: isinstance(n, (addnodes.pending_xref, addnodes.download_reference)))):
        source = Path(str(node.source).split(":")[0])
        if node.get("reftype") != "myst":
            continue
        included = not source.is_relative_to(app.srcdir)
        path, _, heading = node["reftarget"].partition("#")
        base = source.parent if included else Path(app.srcdir) / folder
        file = os.path.relpath(os.path.normpath(base / path) if path else source, root)
        page, anchor = page_of(file, heading)
        copied = isinstance(node, addnodes.download_reference)
        if page and (included or path):
            target = os.path.relpath(page, folder or ".") + ".md" + (f"#{anchor}" if anchor else "")
            if not copied:
                node["reftarget"] = target
                continue
            link = addnodes.pending_xref(refdoc=app.env.docname, reftarget=target, reftype="myst", refdomain=None,
                                         refexplicit=True, refwarn=True)
            link.source, link.line = node.source, node.line
            link += [nodes.inline("", child.astext(), classes=["xref", "myst"]) for child in node.children]
            node.replace_self(link)
        elif not copied and (included or not file.startswith("docs/")) and (root / file).is_file():
            copy = addnodes.download_reference(refdoc=app.env.docname, reftarget=f"/../{file}", refdomain=None,
                                               reftype="myst", refexplicit=True, refwarn=False)
            copy += [nodes.literal("", child.astext(), classes=["xref", "download"]) for child in node.children]
            node.replace_self(copy)


def setup(app):
    app.connect("doctree-read", links_to_files, priority=100)
