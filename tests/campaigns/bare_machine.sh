#!/usr/bin/env bash
# A stranger's path on a bare Debian 12, in a folder made by debootstrap, each step timed. As root, with a network.
#   bare_machine.sh [FOLDER]  where to make it (default: a temporary one, removed afterwards)
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/../.."
source experiments/debian-packages.sh
pkm_install_missing debootstrap

root=${1:-}
if [[ -z $root ]]; then
  root=$(mktemp -d)
  trap 'umount -q "$root/proc" "$root/dev" || true; rm -rf --one-file-system "$root"' EXIT
fi
experiments/package.sh >/dev/null
package=$(ls packages/pkmopt_*.deb) archive=$(ls packages/pkmopt-*.tar.gz)

inside() { chroot "$root" /usr/bin/env -i PATH=/usr/bin:/bin:/usr/sbin:/sbin HOME=/root LANG=C.UTF-8 "$@"; }
total=0
step() {  # step NAME COMMAND...
  local name=$1 begin=${EPOCHREALTIME/./}
  shift
  "$@" >"$root/log" 2>&1 || { cat "$root/log"; echo "failed: $name"; exit 1; }
  local took=$((${EPOCHREALTIME/./} - begin))
  total=$((total + took))
  printf '%8.2f s  %s\n' "$((took / 10000))e-2" "$name"
}
begin_again() {
  total=0
  echo "== $1"
}

[[ -x $root/usr/bin/apt-get ]] || debootstrap --variant=minbase bookworm "$root" >/dev/null
mountpoint -q "$root/proc" || mount -t proc proc "$root/proc"
cp -- "$package" "$archive" "$root/root/"
inside apt-get update -q >/dev/null
inside apt-get install -q --yes --download-only --no-install-recommends "/root/${package##*/}" >/dev/null 2>&1

begin_again "the archive, where nothing is installed"
step "unpack" inside tar -xzf "/root/${archive##*/}" -C /root
step "the paper's study" inside sh -c 'cd /root && /root/pkmopt-*/bin/pkmopt run /root/pkmopt-*/share/pkmopt/experiments/4ppa-2par/paper-problem.toml --output archive.h5 --force'

begin_again "the package (already downloaded: what it asks for)"
step "apt install ./pkmopt.deb" inside apt-get install -q --yes --no-install-recommends "/root/${package##*/}"
step "pkmopt new mechanism" inside sh -c 'cd /root && pkmopt new mechanism my-delta --output my-delta.toml --force'
step "pkmopt new study" inside sh -c 'cd /root && pkmopt new study my-delta.toml --output my-study.toml --force'
step "pkmopt run" inside sh -c 'cd /root && pkmopt run my-study.toml --force'
step "pkmopt report" inside sh -c 'cd /root && pkmopt report my-study.h5 --force && test -s my-study.html'
printf '%8.2f s  in all (goal: 120)\n' "$((total / 10000))e-2"
((total < 120000000))
