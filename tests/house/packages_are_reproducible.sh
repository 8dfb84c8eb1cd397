#!/usr/bin/env bash
# packages_are_reproducible.sh SOURCE PROGRAM: packs the same files twice, written in another order and at another time,
# and compares the bytes of the archives, of the Debian packages, of the wheels and of the software bills of materials.
set -euo pipefail
source=$1
program=$2
source "$source/experiments/repack.sh"
export SOURCE_DATE_EPOCH=1700000000
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# Ipopt's library is not in a folder of the architecture, and that of BLAS is a link of the system's alternatives.
library_of() { ldd "$program" | sed -n "s/.*$1.* => \\(\\S*\\) .*/\\1/p"; }
build() {  # build FOLDER TIME NAME..
  local root=$work/$1 time=$2 name
  mkdir -p "$root/tree/share/doc/pkmopt/licences" "$root/tree/lib/pkmopt" "$root/deb/DEBIAN" "$root/deb/usr"
  for name in "${@:3}"; do echo "$name" | tee "$root/tree/$name" > "$root/deb/usr/$name"; done
  for name in nlopt ipopt blas; do
    library=$(readlink -f "$(library_of "lib$name\\.so")")
    owner=$(dpkg-query --search "$library" | cut -d: -f1)
    cp "$library" "$root/tree/lib/pkmopt/"
    cp "/usr/share/doc/$owner/copyright" "$root/tree/share/doc/pkmopt/licences/$owner"
  done
  ln -s "$(basename "$library")" "$root/tree/lib/pkmopt/libblas.so.3-x86_64-linux-gnu"
  mkdir -p "$root/tree/python/pkmopt"
  touch "$root/tree/python/pkmopt/__init__.py" "$root/tree/lib/libpkmopt.so.0" "$root/tree/share/doc/pkmopt/LICENSE"
  printf 'Package: pkmopt\nVersion: 1\nArchitecture: all\nMaintainer: x <x@y.invalid>\nDescription: x\n' \
    > "$root/deb/DEBIAN/control"
  (cd "$root/deb" && find usr -type f -exec md5sum {} + > DEBIAN/md5sums)
  find "$root" -exec touch --date="@$time" {} +
  dpkg-deb --build "$root/deb" "$root/package.deb" > /dev/null
  pkm_repack_deb "$root/package.deb" > /dev/null
  python3 "$source/experiments/sbom.py" "$root/tree" 1.2.3
  pkm_pack_tree "$root/tree" "$root/tree.tar.gz"
  python3 "$source/bindings/python/make_wheel.py" "$root/tree" 1.2.3 "$root/wheel" > /dev/null
}
build first 1600000000 a b c
build second 1650000000 c a b
wheel=wheel/pkmopt-1.2.3-py3-none-manylinux_2_36_x86_64.whl
for file in package.deb tree.tar.gz tree/share/doc/pkmopt/pkmopt.cdx.json $wheel; do
  cmp "$work/first/$file" "$work/second/$file"
done
python3 - "$work/first/tree/share/doc/pkmopt/pkmopt.cdx.json" <<'PYTHON'
import json
import sys

bill = json.load(open(sys.argv[1]))
ipopt, blas, nlopt = bill["components"]
assert "libblas.so.3-x86_64-linux-gnu" in [each["name"] for each in blas["components"]], blas
assert ipopt["components"][0]["name"].startswith("libipopt.so"), ipopt
assert bill["metadata"]["component"]["version"] == "1.2.3", bill
assert nlopt["name"] == "libnlopt0" and nlopt["version"] and nlopt["licenses"], nlopt
assert nlopt["components"][0]["name"].startswith("libnlopt.so"), nlopt
PYTHON
python3 - "$work/first/$wheel" <<'PYTHON'
import sys
import zipfile

for entry in zipfile.ZipFile(sys.argv[1]).infolist():
    assert entry.date_time == (1980, 1, 1, 0, 0, 0), entry
PYTHON
rm "$work/first/tree/share/doc/pkmopt/licences/libnlopt0"
if python3 "$source/experiments/sbom.py" "$work/first/tree" 1.2.3 2> "$work/errors"; then
  echo "sbom.py accepts a library without its licence"
  exit 1
fi
grep -q "no copyright file of libnlopt0" "$work/errors"
