# Debian 12 packages that pkmopt needs, and how the scripts get those that are missing. To be sourced.

pkm_build_packages=(
  g++ cmake ninja-build pkg-config  # tools
  libeigen3-dev                     # linear algebra
  libhdf5-dev libxxhash-dev         # study files and their checksum
  zlib1g-dev                        # pictures as dots
  libtomlplusplus-dev               # studies
  libnlopt-dev coinor-libipopt-dev  # solvers
  liblapack-dev                     # what Ipopt asks for when it is linked
  libcli11-dev nlohmann-json3-dev   # command line, --json
  librandom123-dev                  # counter-based random numbers
)
pkm_test_packages=(
  libgtest-dev libgmock-dev libbenchmark-dev
  libfcl-dev                                  # distances of capsules, computed by others
  libsimbody-dev                              # driving forces, computed by others
  libmpfi-dev                                 # intervals, computed by others
  python3 python3-numpy python3-h5py          # reads study files independently of us
  python3-vtk9                                # reads exported workspaces as ParaView does
  chromium                                    # looks at the pages of pkmopt report
  clang-14 libclang-rt-14-dev libomp-14-dev   # second compiler, its sanitizers and OpenMP
  clang-format-14
  libopenmpi-dev openmpi-bin                  # several processes
  slurm-wlm munge                             # and as a cluster starts them
)
# The documentation as a site: its C++ interface, its buttons and formulas, the places in a study file.
pkm_docs_packages=(
  python3-sphinx python3-myst-parser furo python3-breathe doxygen python3-sphinx-copybutton libjs-katex python3-h5py
)
pkm_test_packages+=("${pkm_docs_packages[@]}")
# For the page of pkmopt report. By the command's name: where node comes from elsewhere, Debian's package does not install.
command -v npm >/dev/null || pkm_build_packages+=(npm)

# Seconds to wait for another package manager, which a machine that has just been started often runs.
pkm_lock_timeout=600

# pkm_update_lists [PREFIX...]: `apt-get update`, run by the prefix. Waits for the lock of the lists: unlike that of dpkg,
# apt does not wait for it.
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

# Installs those of the named packages that are missing. Does nothing, and needs no rights, when none is.
pkm_install_missing() {
  if ! command -v apt-get >/dev/null; then
    echo "No apt-get here. What is needed is called in Debian 12: $*"
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
      echo "Missing packages, and neither root nor sudo to install them: ${missing[*]}" >&2
      return 1
    fi
    as_root=(sudo)
  fi
  echo "Installing ${missing[*]}"
  pkm_update_lists "${as_root[@]}" || return 1
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -q --yes --no-install-recommends \
    -o DPkg::Lock::Timeout="$pkm_lock_timeout" "${missing[@]}"
}
