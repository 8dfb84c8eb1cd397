#!/usr/bin/env bash
# Installs and uses the packages on a minimal Debian 12 system as a new user would, in root folders made by debootstrap,
# and times each step. Needs root and a network. Uses the packages in packages/, and builds them if there are none.
#   bare_machine.sh [FOLDER]  keeps the minimal root folder in FOLDER for later runs
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/../.."
source experiments/debian-packages.sh
pkm_install_missing debootstrap lintian

work=$(mktemp -d)
root=$work/root bare=${1:-$work/bare}
leave() { if mountpoint -q "$root/proc"; then umount "$root/proc"; fi; }
trap 'leave; rm -rf --one-file-system "$work"' EXIT

fresh_system() {  # fresh_system TITLE: starts with a root folder in which nothing is installed
  leave
  rm -rf --one-file-system "$root"
  cp -a --reflink=auto -- "$bare" "$root"
  mount -t proc proc "$root/proc"
  total=0
  echo "== $1"
}
inside() { chroot "$root" /usr/bin/env -i -C /root PATH=/usr/bin:/bin:/usr/sbin:/sbin HOME=/root LANG=C.UTF-8 "$@"; }
installed() { inside apt-get install -q --yes --no-install-recommends "$@"; }
quietly() { "$@" >"$work/log" 2>&1 || { cat "$work/log"; echo "failed: $*"; exit 1; }; }
late=0
step() {  # step NAME COMMAND...
  local name=$1 begin=${EPOCHREALTIME/./}
  shift
  quietly "$@"
  local took=$((${EPOCHREALTIME/./} - begin))
  total=$((total + took))
  printf '%8.2f s  %s\n' "$((took / 10000))e-2" "$name"
}
goal() {  # goal SECONDS WHAT
  printf '%8.2f s  total: %s (goal: %d)\n' "$((total / 10000))e-2" "$2" "$1"
  ((total < $1 * 1000000)) || late=1
}
# offered LINE TYPED: expects that bash prints LINE when TYPED is entered in a terminal (\t: tab key)
offered() {
  { sleep 1; printf "$2"'\nexit\n'; } |
    script -qec "chroot '$root' /usr/bin/env -i HOME=/root TERM=dumb LANG=C.UTF-8 /bin/bash -i" /dev/null |
    tee /dev/stderr | grep "$1"
}

ls packages/pkmopt* >/dev/null 2>&1 || quietly experiments/package.sh
package=$(ls packages/pkmopt_*.deb) archive=$(ls packages/pkmopt-*.tar.gz)
quietly lintian --allow-root --fail-on error,warning "$package"
[[ -x $bare/usr/bin/apt-get ]] || quietly debootstrap --variant=minbase bookworm "$bare"

fresh_system "the archive, without installed packages, in a folder with a space in its name"
cp -- "$archive" "$root/root/archive.tar.gz"
inside mkdir -p "/opt/some where"
step "unpack" inside tar -xzf archive.tar.gz -C "/opt/some where" --strip-components=1
step "run the study of the paper" inside "/opt/some where/bin/pkmopt" run --output paper.h5 \
  "/opt/some where/share/pkmopt/experiments/4ppa-2par/paper-problem.toml"
step "write its report" inside "/opt/some where/bin/pkmopt" report paper.h5
step "write a proof" inside "/opt/some where/bin/pkmopt" certify --proof proof.txt --gap 0.2 \
  "/opt/some where/share/pkmopt/experiments/mechanisms/orthoglide.toml"
step "check the proof" inside "/opt/some where/bin/pkmopt-check-proof" proof.txt
goal 60 "from the archive to the first report"

fresh_system "the package"
cp -- "$package" "$root/root/pkmopt.deb"
quietly inside apt-get update -q
quietly installed --download-only ./pkmopt.deb
step "apt install ./pkmopt.deb, with its dependencies already downloaded" installed ./pkmopt.deb
step "pkmopt new mechanism" inside pkmopt new mechanism my-delta --output my-delta.toml
step "pkmopt new study" inside pkmopt new study my-delta.toml --output my-study.toml
step "pkmopt check" inside pkmopt check my-study.toml
step "pkmopt run" inside pkmopt run my-study.toml
goal 60 "from the package to the end of the first study"
step "pkmopt report" inside pkmopt report my-study.h5
inside test -s my-study.html
goal 120 "from the package to the first report"

echo "== manual, completion, scripts, library"
quietly installed man-db bash-completion
cp -- "$root/etc/skel/.bashrc" "$root/root/"  # as for a normal user, with completion enabled
step "man pkmopt-run" inside sh -c 'man pkmopt-run | grep -q instruction-set'
step "pkmopt rep<TAB>" offered 'pkmopt report --help' 'pkmopt rep\t--help'
step "pkmopt run my-st<TAB>" offered 'pkmopt run my-study.toml' 'cd\npkmopt run my-st\t--help'
step "run a script of the experiments" inside /usr/share/pkmopt/experiments/2t1r-p-hybrid/motion-curves.sh curves

mapfile -t suggested < <(dpkg-deb --field "$package" Suggests | tr ',' '\n')
quietly installed g++ cmake make pkg-config ${suggested[*]}
cp -r --parents tests/packaging/external tests/own_mechanisms "$root/root/"
step "build a program with its own mechanism" inside sh -c \
  'cmake -S tests/packaging/external -B build && cmake --build build --target scara'
step "run its study" inside build/scara run tests/packaging/external/scara.toml
exit $late
