# Functions that write packages whose bytes depend on the contents of the files only. All times are SOURCE_DATE_EPOCH.

# pkm_pack_tree FOLDER FILE.tar.gz: packs a folder, with sorted names and without owners.
pkm_pack_tree() {
  tar --create --sort=name --mtime="@$SOURCE_DATE_EPOCH" --owner=0 --group=0 --numeric-owner --format=gnu \
      --mode='u+rw,go=rX' --directory "$(dirname "$1")" "$(basename "$1")" | gzip -9n > "$2"
}

# pkm_repack_deb FILE.deb: repacks a Debian package in place.
pkm_repack_deb() {
  local folder
  folder=$(mktemp -d)
  dpkg-deb --raw-extract "$1" "$folder/package"
  LC_ALL=C sort --key=2 --output="$folder/package/DEBIAN/md5sums" "$folder/package/DEBIAN/md5sums"
  find "$folder/package" -exec touch --no-dereference --date="@$SOURCE_DATE_EPOCH" {} +
  dpkg-deb --root-owner-group --threads-max=1 --build "$folder/package" "$1"
  rm -rf "$folder"
}
