#!/usr/bin/env bash
# package_manager_lock.sh FOLDER: checks that installing packages waits for other package managers. Another process
# holds the lock of the package lists, then that of dpkg, and releases each after two seconds. Uses a separate package
# database in FOLDER. Skipped (exit code 77) unless run as root, because apt uses the locks only then.
set -euo pipefail
source "$(dirname -- "${BASH_SOURCE[0]}")/../../experiments/debian-packages.sh"
((EUID == 0)) || exit 77
command -v apt-get >/dev/null || exit 77
folder=$1
rm -rf -- "$folder"
mkdir -p -- "$folder"/{etc/apt.conf.d,etc/preferences.d,lists/partial,cache/archives/partial,dpkg/updates,dpkg/info,log,repository,made/DEBIAN}
touch "$folder/dpkg/status" "$folder/etc/sources.list"

# A package that is not installed anywhere, and a repository that contains it.
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

hold() {  # hold FILE: locks the file for two seconds by fcntl, like apt and dpkg
  python3 - "$1" <<'PYTHON' &
import fcntl, sys, time
with open(sys.argv[1], "w") as file:
    fcntl.lockf(file, fcntl.LOCK_EX)
    open(sys.argv[1] + ".is-locked", "w").close()
    time.sleep(2)
PYTHON
  until [[ -e $1.is-locked ]]; do sleep 0.05; done
}

hold "$folder/lists/lock"
pkm_update_lists > "$folder/update.txt"
grep -q "Another package manager is running" "$folder/update.txt"

hold "$folder/dpkg/lock-frontend"
begin=$SECONDS
pkm_install_missing pkmopt-lock-test
((SECONDS > begin)) || { echo "did not wait for dpkg"; exit 1; }
grep -q "Package: pkmopt-lock-test" "$folder/dpkg/status"

# Other errors are reported immediately.
echo "deb [trusted=yes] file:$folder/nowhere ./" > "$folder/etc/sources.list"
begin=$SECONDS
! pkm_update_lists > /dev/null 2> "$folder/errors.txt" || { echo "a missing repository was not reported"; exit 1; }
grep -q "$folder/nowhere" "$folder/errors.txt"
((SECONDS - begin < 60))
echo "waits for both locks"
