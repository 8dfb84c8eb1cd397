#!/usr/bin/env bash
# Builds the documentation website with Sphinx: docs/build.sh [PROGRAM [FOLDER]]
# PROGRAM (default: build/release/bin/pkmopt) generates the reference. It must have the version of these pages, i.e. that
# of CMakeLists.txt, which every page shows. The start page is FOLDER/html/index.html (default FOLDER: build/docs).
# Warnings and broken links within the site are errors. Installs missing packages.
set -euo pipefail
root=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)
program=$(realpath -- "${1:-$root/build/release/bin/pkmopt}")
out=$(realpath -m -- "${2:-$root/build/docs}")
if [[ ! -x $program ]]; then
  echo "docs/build.sh: there is no program $program; build it, or name another: docs/build.sh PROGRAM" >&2
  exit 1
fi
version=$(sed -nE 's/^project\(pkmopt VERSION ([0-9.]+).*/\1/p' "$root/CMakeLists.txt")
built=$("$program" --version | head -1)  # "pkmopt 0.1.0 (a1b2c3d4e5f6)"
if [[ $built != "pkmopt $version ("* ]]; then
  echo "docs/build.sh: $program is '$built'; expected version $version, which these pages describe: build it again" >&2
  exit 1
fi
source "$root/experiments/debian-packages.sh"
pkm_install_missing "${pkm_docs_packages[@]}"

# A copy of the pages, to which generated pages are added, and links to the rest of the repository, because pages
# include its READMEs.
tree=$out/tree
rm -rf -- "$tree" "$out"/{xml,doctrees,html}
mkdir -p -- "$tree"
for part in "$root"/*; do
  [[ $part == */docs || $part == */build* ]] || ln -s -- "$part" "$tree"
done
cp -R -- "$root/docs" "$tree/docs"
mkdir -p -- "$tree/docs/_static"
cp -RL -- /usr/share/javascript/katex "$tree/docs/_static/katex"
# Two corrections of Debian's furo theme: its script is split into ES modules, which browsers do not load from disk, so
# they are concatenated; its dark colours do not follow the system's setting, so they are repeated in a media query.
furo=/usr/lib/python3/dist-packages/furo/theme/furo/static
mkdir -- "$tree/docs/_static/scripts"
sed '/^import /d' "$furo"/scripts/{gumshoe-patched,furo}.js > "$tree/docs/_static/scripts/furo.js"
sed -n '/^@media not print/,/^$/p' "$furo/styles/furo.css" |
  sed 's/@media not print/@media screen and (prefers-color-scheme: dark)/; s/data-theme="dark"/data-theme="auto"/' \
    >> "$tree/docs/_static/site.css"

# Doxygen's XML of the public headers, for Breathe. The filter restores the names of unused function arguments, which
# are commented out in the source, and escapes templates in comments, which would be read as HTML.
cd -- "$tree"
doxygen - <<SETTINGS
INPUT = $(/usr/bin/python3 docs/cpp.py --headers)
OUTPUT_DIRECTORY = $out
STRIP_FROM_PATH = $tree
GENERATE_XML = YES
GENERATE_HTML = NO
GENERATE_LATEX = NO
EXTRACT_ALL = YES
MARKDOWN_SUPPORT = NO
QUIET = YES
WARN_IF_INCOMPLETE_DOC = NO
INPUT_FILTER = "sed -E 's@/[*]([a-z_]+)[*]/@\\1@; /^ *[/]{3} /{s@\`@@g; s@[<>]@\\\\&@g}'"
WARN_AS_ERROR = YES
SETTINGS

/usr/bin/python3 docs/cpp.py "$root" docs "$out/xml"
/usr/bin/python3 docs/reference.py "$program" "$root" docs
/usr/bin/python3 docs/notebooks.py docs
export PYTHONPATH=$root/bindings/python PYTHONDONTWRITEBYTECODE=1
PKMOPT_LIBRARY=$(dirname -- "$program")/../lib/libpkmopt.so.0  # of the program's build
export PKMOPT_LIBRARY
PKM_DOCS_VERSION=${built#pkmopt } PKM_DOCS_XML=$out/xml \
  /usr/bin/sphinx-build -q -W -n --keep-going -b html -d "$out/doctrees" docs "$out/html"
/usr/bin/python3 "$root/docs/links.py" "$out/html"
echo "$out/html/index.html"
