# The Debian 12 packages that pkmopt needs, and functions that install the missing ones. To be sourced by scripts.

pkm_build_packages=(
  g++ cmake ninja-build pkg-config  # tools
  libeigen3-dev                     # linear algebra
  libhdf5-dev libxxhash-dev         # study files and their checksum
  zlib1g-dev                        # PNG images
  libtomlplusplus-dev               # studies
  libnlopt-dev coinor-libipopt-dev  # solvers
  liblapack-dev                     # needed to link Ipopt
  libcli11-dev nlohmann-json3-dev   # command line, --json
  librandom123-dev                  # counter-based random numbers
)
# Packages with which the tests are compiled.
pkm_test_libraries=(
  libgtest-dev libgmock-dev libbenchmark-dev
  libfcl-dev                                  # independent computation of capsule distances
  libsimbody-dev                              # independent computation of drive forces
  libmujoco-dev                               # independent simulation of exported models
  libmpfi-dev                                 # independent interval arithmetic
  libopenmpi-dev openmpi-bin                  # runs with several processes
  clang-format-14
)
# Packages that the tests need when they run, in addition.
pkm_test_packages=(
  python3 python3-numpy python3-h5py          # independent reading of study files
  mypy                                        # annotations of the Python package
  python3-nbclient python3-nbformat python3-ipykernel python3-matplotlib  # notebooks and plots
  python3-scipy                               # comparison of optimisers
  octave octave-dev                           # generated code and the functions for MATLAB and Octave
  python3-jsonschema                          # validation of files by `pkmopt schema`
  python3-vtk9                                # reading of exported workspaces as in ParaView
  chromium                                    # tests of the pages of pkmopt report
  clang-14 libclang-rt-14-dev libomp-14-dev   # second compiler, its sanitizers and OpenMP
  slurm-wlm munge                             # runs started by a cluster's scheduler
  zsh fish                                    # completion of the command line
)
# For the documentation website: C++ interface, copy buttons, formulas, and the structure of study files.
pkm_docs_packages=(
  python3-sphinx python3-myst-parser furo python3-breathe doxygen python3-sphinx-copybutton libjs-katex python3-h5py python3-numpy
)
pkm_test_packages+=("${pkm_test_libraries[@]}" "${pkm_docs_packages[@]}")
# For the page of pkmopt report. Debian's package conflicts with a node from another source, so look for the command.
command -v npm >/dev/null || pkm_build_packages+=(npm)

# Seconds to wait for another package manager, which often runs on a machine that has just been started.
pkm_lock_timeout=600

# pkm_update_lists [PREFIX...]: runs `apt-get update` with the command prefix, for example sudo. Waits for the lock of
# the package lists, because apt itself waits only for that of dpkg.
pkm_update_lists() {
  local errors deadline=$((SECONDS + pkm_lock_timeout))
  until { errors=$("$@" env LC_ALL=C apt-get update -q 2>&1 >&3); } 3>&1; do
    if [[ $errors != *"Could not get lock"* ]] || ((SECONDS >= deadline)); then
      printf '%s\n' "$errors" >&2
      return 1
    fi
    echo "Another package manager is running; waiting for it"
    sleep 2
  done
}

# Further options of apt-get, for scripts that source this file.
pkm_apt_options=()

# pkm_install_missing PACKAGE...: installs the packages that are missing. Needs root rights only if there are any.
pkm_install_missing() {
  if ! command -v apt-get >/dev/null; then
    echo "apt-get not found; install the equivalents of these Debian 12 packages: $*"
    return 0
  fi
  local package missing=() as_root=()
  for package in "$@"; do
    [[ $(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null) == installed ]] ||
      missing+=("$package")
  done
  ((${#missing[@]})) || return 0
  if ((EUID != 0)); then
    if ! command -v sudo >/dev/null; then
      echo "Missing packages: ${missing[*]}; install them as root, or install sudo" >&2
      return 1
    fi
    as_root=(sudo)
  fi
  echo "Installing ${missing[*]}"
  pkm_update_lists "${as_root[@]}" || return 1
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -q --yes --no-install-recommends \
    -o DPkg::Lock::Timeout="$pkm_lock_timeout" "${pkm_apt_options[@]}" "${missing[@]}"
}
