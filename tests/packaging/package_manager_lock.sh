#!/usr/bin/env bash
# Installing packages waits for another package manager: a process holds the lock of the package lists, then that of dpkg,
# and releases each after two seconds. Works on a package database of its own, in FOLDER; apt asks nobody but root to lock.
#   package_manager_lock.sh FOLDER
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/../../experiments/debian-packages.sh"
((EUID == 0)) || exit 77
command -v apt-get >/dev/null || exit 77
folder=$1
rm -rf -- "$folder"
mkdir -p -- "$folder"/{etc/apt.conf.d,etc/preferences.d,lists/partial,cache/archives/partial,dpkg/updates,dpkg/info,log,repository,made/DEBIAN}
touch "$folder/dpkg/status" "$folder/etc/sources.list"

# A package that no machine has, and a repository that holds it.
printf 'Package: pkmopt-lock-test\nVersion: 1\nArchitecture: all\nMaintainer: nobody <nobody@localhost>\nDescription: test\n' \
  > "$folder/made/DEBIAN/control"
dpkg-deb --build "$folder/made" "$folder/repository/made.deb" >/dev/null
(cd -- "$folder/repository"
 cat ../made/DEBIAN/control
 printf 'Filename: ./made.deb\nSize: %d\nSHA256: %s\n' "$(stat -c %s made.deb)" "$(sha256sum made.deb | cut -d' ' -f1)") \
  > "$folder/repository/Packages"
echo "deb [trusted=yes] file:$folder/repository ./" > "$folder/etc/sources.list"
cat > "$folder/apt.conf" <<CONF
Dir::Etc "$folder/etc"; Dir::Etc::sourceparts "/dev/null"; Dir::Etc::parts "/dev/null";
Dir::State::lists "$folder/lists"; Dir::State::status "$folder/dpkg/status"; Dir::Cache "$folder/cache";
Dir::State::extended_states "$folder/extended_states"; Dir::Log "$folder/log"; APT::Sandbox::User "root";
DPkg::Options { "--admindir=$folder/dpkg"; "--force-all"; };
CONF
export APT_CONFIG=$folder/apt.conf

hold() {  # hold FILE: locks it for two seconds, as apt and dpkg lock
  python3 - "$1" <<'PYTHON' &
import fcntl, sys, time
with open(sys.argv[1], "w") as held:
    fcntl.lockf(held, fcntl.LOCK_EX)
    open(sys.argv[1] + ".is-held", "w").close()
    time.sleep(2)
PYTHON
  until [[ -e $1.is-held ]]; do sleep 0.05; done
}

hold "$folder/lists/lock"
pkm_update_lists > "$folder/update.txt"
grep -q "Another package manager is running" "$folder/update.txt"

hold "$folder/dpkg/lock-frontend"
begin=$SECONDS
pkm_install_missing pkmopt-lock-test
((SECONDS > begin)) || { echo "did not wait for dpkg"; exit 1; }
grep -q "Package: pkmopt-lock-test" "$folder/dpkg/status"

# Other errors are reported at once.
echo "deb [trusted=yes] file:$folder/nowhere ./" > "$folder/etc/sources.list"
begin=$SECONDS
! pkm_update_lists > /dev/null 2> "$folder/errors.txt" || { echo "a repository that is missing is no error"; exit 1; }
grep -q "$folder/nowhere" "$folder/errors.txt"
((SECONDS - begin < 60))
echo "waits for both locks"
