#!/usr/bin/env bash
# packages_are_reproducible.sh SOURCE PROGRAM: packs the same files twice, written in another order and at another time,
# and compares the bytes of the archives, of the Debian packages and of the software bills of materials.
set -euo pipefail
source "$1/experiments/repack.sh"
export SOURCE_DATE_EPOCH=1700000000
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
library=$(ldd "$2" | sed -n 's/.*libnlopt.* => \(\S*\) .*/\1/p')

source=$1
build() {  # build FOLDER TIME NAME..
  local root=$work/$1 time=$2 name
  mkdir -p "$root/tree/share/doc/pkmopt/licences" "$root/tree/lib/pkmopt" "$root/deb/DEBIAN" "$root/deb/usr"
  for name in "${@:3}"; do echo "$name" | tee "$root/tree/$name" > "$root/deb/usr/$name"; done
  cp -L "$library" "$root/tree/lib/pkmopt/$(basename "$(readlink -f "$library")")"
  cp -L /usr/share/doc/libnlopt0/copyright "$root/tree/share/doc/pkmopt/licences/libnlopt0"
  printf 'Package: pkmopt\nVersion: 1\nArchitecture: all\nMaintainer: x <x@y.invalid>\nDescription: x\n' \
    > "$root/deb/DEBIAN/control"
  (cd "$root/deb" && find usr -type f -exec md5sum {} + > DEBIAN/md5sums)
  find "$root" -exec touch --date="@$time" {} +
  dpkg-deb --build "$root/deb" "$root/package.deb" > /dev/null
  pkm_repack_deb "$root/package.deb" > /dev/null
  python3 "$source/experiments/sbom.py" "$root/tree" 1.2.3
  pkm_pack_tree "$root/tree" "$root/tree.tar.gz"
}
build first 1600000000 a b c
build second 1650000000 c a b
for file in package.deb tree.tar.gz tree/share/doc/pkmopt/pkmopt.cdx.json; do cmp "$work/first/$file" "$work/second/$file"; done
python3 - "$work/first/tree/share/doc/pkmopt/pkmopt.cdx.json" <<'PYTHON'
import json
import sys

bill = json.load(open(sys.argv[1]))
nlopt, = bill["components"]
assert bill["metadata"]["component"]["version"] == "1.2.3", bill
assert nlopt["name"] == "libnlopt0" and nlopt["version"] and nlopt["licenses"], nlopt
assert nlopt["components"][0]["name"].startswith("libnlopt.so"), nlopt
PYTHON
