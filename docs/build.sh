#!/usr/bin/env bash
# Builds the documentation as a site: docs/build.sh [PROGRAM [FOLDER]]
# The program writes the reference: by default build/release/bin/pkmopt. It has to be of the version of these pages, that
# of CMakeLists.txt, which every page of the site names. The site's first page is FOLDER/html/index.html, FOLDER being
# build/docs by default. Any warning is an error, and so is a link within the site that leads nowhere. Installs what is
# missing.
set -euo pipefail
root=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)
program=$(realpath -- "${1:-$root/build/release/bin/pkmopt}")
out=$(realpath -m -- "${2:-$root/build/docs}")
if [[ ! -x $program ]]; then
  echo "There is no program $program. Build it, or name another: docs/build.sh PROGRAM" >&2
  exit 1
fi
version=$(sed -nE 's/^project\(pkmopt VERSION ([0-9.]+).*/\1/p' "$root/CMakeLists.txt")
built=$("$program" --version | head -1)  # "pkmopt 0.1.0 (a1b2c3d4e5f6)"
if [[ $built != "pkmopt $version ("* ]]; then
  echo "These pages are of version $version, and $program says that it is $built: build it again" >&2
  exit 1
fi
source "$root/experiments/debian-packages.sh"
pkm_install_missing "${pkm_docs_packages[@]}"

# The pages and what is written for them, beside the rest of the repository, so that pages may include its READMEs.
tree=$out/tree
rm -rf -- "$tree" "$out"/{xml,doctrees,html}
mkdir -p -- "$tree"
for part in "$root"/*; do
  [[ $part == */docs || $part == */build* ]] || ln -s -- "$part" "$tree"
done
cp -R -- "$root/docs" "$tree/docs"
mkdir -p -- "$tree/docs/_static"
cp -RL -- /usr/share/javascript/katex "$tree/docs/_static/katex"
# Debian's furo has its script as modules, which a page from disk may not load, and has lost the colours that follow the
# system's: one script, and its dark colours once more.
furo=/usr/lib/python3/dist-packages/furo/theme/furo/static
mkdir -- "$tree/docs/_static/scripts"
sed '/^import /d' "$furo"/scripts/{gumshoe-patched,furo}.js > "$tree/docs/_static/scripts/furo.js"
sed -n '/^@media not print/,/^$/p' "$furo/styles/furo.css" |
  sed 's/@media not print/@media screen and (prefers-color-scheme: dark)/; s/data-theme="dark"/data-theme="auto"/' \
    >> "$tree/docs/_static/site.css"

# What the headers say, for Breathe. The filter lets it see the names of arguments that a function does not use.
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
INPUT_FILTER = "sed -E 's@/[*]([a-z_]+)[*]/@\\1@'"
WARN_AS_ERROR = YES
SETTINGS

/usr/bin/python3 docs/cpp.py "$root" docs "$out/xml"
/usr/bin/python3 docs/reference.py "$program" "$root" docs
PKM_DOCS_VERSION=${built#pkmopt } PKM_DOCS_XML=$out/xml \
  /usr/bin/sphinx-build -q -W -n --keep-going -b html -d "$out/doctrees" docs "$out/html"
cp -R -- experiments/mechanisms/pictures "$out/html/reference"  # named by <img> in an included README
/usr/bin/python3 "$root/docs/links.py" "$out/html"
echo "$out/html/index.html"
