#!/usr/bin/env bash
# bare_debian.sh PACKAGE.deb [FOLDER]: installs the package by apt in a minimal Debian 12, which debootstrap makes in
# FOLDER, and uses the program, the package for Python and the C interface there. Needs root, debootstrap and a mirror
# of Debian; takes some two minutes.
set -euo pipefail
package=$(realpath "$1")
root=${2:-$(mktemp -d)}
trap 'rm -rf --one-file-system "$root"' EXIT

debootstrap --variant=minbase bookworm "$root" "${PKM_MIRROR:-http://deb.debian.org/debian}" > "$root.log"
cp /etc/resolv.conf "$root/etc/"
cp -r /etc/apt/apt.conf.d/. "$root/etc/apt/apt.conf.d/"
cp "$package" "$root/pkmopt.deb"
inside() { chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root DEBIAN_FRONTEND=noninteractive "$@"; }

inside apt-get update -qq
inside apt-get install -qq -y --no-install-recommends /pkmopt.deb python3-numpy gcc libc6-dev pkg-config > "$root.log"

echo "== program"
inside pkmopt --version
inside sh -c 'cd /tmp && pkmopt run /usr/share/pkmopt/experiments/4ppa-2par/paper-problem.toml -o paper.h5 --quiet && pkmopt show paper.h5 | head -3'
echo "== Python"
inside python3 -c '
import pkmopt
study = pkmopt.Study("4ppa-2par", {"a": (0.2, 0.5)}, "workspace-volume", stages={"optimiser": "ga", "generations": 5})
best = study.run("/tmp/python.h5").best
print(pkmopt.version, best["design"], best["objectives"])
assert abs(pkmopt.Mechanism("4ppa-2par").design().workspace().volume - 0.55015737) < 1e-7'
echo "== C"
inside sh -c 'cd /tmp && printf "%s\n" "#include <pkmopt.h>" "#include <stdio.h>" "int main(void) { return puts(pkmopt_version()) < 0; }" > a.c && gcc a.c $(pkg-config --cflags --libs pkmopt) -o a && ./a'
echo "installed and used in a bare Debian"
