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
package=$(ls packages/pkmopt_*.deb) archive=$(ls packages/pkmopt-*.tar.gz) wheel=$(ls packages/pkmopt-*.whl)
# The package for Python: inverse and forward kinematics, a workspace with derivatives, a study with a function in
# Python that worker processes call, and its report.
cat >"$work/use.py" <<'PYTHON'
import os
import sys

import numpy as np
import pkmopt


def price(design):
    return 40 * design["a"] + 10 * design["b"]


if __name__ == "__main__":
    design = pkmopt.Mechanism("4ppa-2par").design()
    poses = [[0.4, 0.0, -0.3, 0.0], [0.42, 0.02, -0.31, 0.1]]
    joints = design.inverse(poses)
    assert np.abs(design.forward(joints, near=poses) - poses).max() < 1e-12, joints
    volume, gradient = design.volume_and_gradient()
    assert abs(volume - 0.55015737) < 1e-7, volume
    assert np.isfinite(list(gradient.values())).all(), gradient
    study = pkmopt.Study(
        "4ppa-2par",
        {"a": ("200 mm", "500 mm"), "b": ("500 mm", "1.2 m")},
        ["workspace-volume", {"type": "python", "call": price, "unit": "1"}],
        stages={"optimiser": "nsga2", "population": 8, "generations": 3},
    )
    results = study.run("python.h5", workers=2, overwrite=True)
    assert results.state == "finished" and len(results.front) > 0, results
    assert os.path.getsize(results.report("python.html", overwrite=True)) > 100_000
    print(pkmopt.version, "in", os.path.dirname(pkmopt.__file__), "by Python", sys.version.split()[0])
PYTHON
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
quietly inside apt-get update -q
quietly installed python3-numpy
cp -- "$work/use.py" "$root/root/"
step "use it from Python by PYTHONPATH" inside PYTHONPATH="/opt/some where/python" python3 use.py

fresh_system "the wheel, in a virtual environment"
cp -- "$wheel" "$work/use.py" "$root/root/"
quietly inside apt-get update -q
quietly installed python3-venv python3-numpy
step "create the environment" inside python3 -m venv --system-site-packages environment
step "pip install the wheel, without a network" inside environment/bin/pip install --no-index "${wheel##*/}"
step "use it from Python" inside environment/bin/python use.py

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

echo "== Python, manual, completion, scripts, library"
quietly inside apt-get install -q --yes ./pkmopt.deb python3-numpy
cp -- "$work/use.py" "$root/root/"
step "use it from Python" inside python3 use.py
quietly installed man-db bash-completion
cp -- "$root/etc/skel/.bashrc" "$root/root/"  # as for a normal user, with completion enabled
step "man pkmopt-run" inside sh -c 'man pkmopt-run | grep -q instruction-set'
step "pkmopt rep<TAB>" offered 'pkmopt report --help' 'pkmopt rep\t--help'
step "pkmopt run my-st<TAB>" offered 'pkmopt run my-study.toml' 'cd\npkmopt run my-st\t--help'
step "run a script of the experiments" inside /usr/share/pkmopt/experiments/2t1r-p-hybrid/motion-curves.sh curves

mapfile -t suggested < <(dpkg-deb --field "$package" Suggests | tr ',' '\n')
quietly installed g++ cmake make pkg-config ${suggested[*]}
cp -r --parents tests/packaging/external tests/own_mechanisms "$root/root/"
step "build and run the example in C" inside sh -c \
  'cc /usr/share/doc/pkmopt/example.c $(pkg-config --cflags --libs pkmopt) -o example &&
   ./example /usr/share/pkmopt/experiments/mechanisms/rotary-delta.toml'
step "build and use the functions for Octave" inside octave-cli --eval \
  "addpath /usr/share/pkmopt/matlab; pkmopt.build; disp(pkmopt.Mechanism('4ppa-2par').design().volume())"
step "build a program with its own mechanism" inside sh -c \
  'cmake -S tests/packaging/external -B build && cmake --build build --target scara'
step "run its study" inside build/scara run tests/packaging/external/scara.toml
exit $late
