#!/usr/bin/env python3
"""Makes a wheel of the package pkmopt from an installed archive: make_wheel.py TREE VERSION FOLDER

TREE is what `cmake --install` with PKM_BUNDLE=ON has installed: python/pkmopt, the library libpkmopt.so.0 and the
folder of the libraries that it needs. The wheel holds all of them, serves every Python from 3.11 on, because nothing
in it is compiled for a version of Python, and Linux on x86-64 with glibc 2.36 or later. Prints its path.
"""

import base64
import hashlib
import pathlib
import re
import subprocess
import sys
import zipfile

PLATFORM = "manylinux_2_36_x86_64"


def loaded_name(library):
    """The name by which other libraries need this one. A wheel has no links, so its file must have that name."""
    dynamic = subprocess.run(["readelf", "--dynamic", "--wide", library], check=True, capture_output=True, text=True).stdout
    return re.search(r"\(SONAME\).*\[(.+)\]", dynamic).group(1)


def main():
    tree, version, folder = pathlib.Path(sys.argv[1]), sys.argv[2], pathlib.Path(sys.argv[3])
    library = next(tree.glob("**/libpkmopt.so.0"))
    files = {"pkmopt/%s" % path.name: path for path in sorted((tree / "python" / "pkmopt").glob("*")) if path.is_file()}
    files["pkmopt/lib/libpkmopt.so.0"] = library.resolve()
    for path in (library.parent / "pkmopt").glob("*.so*"):
        if not path.is_symlink():
            files["pkmopt/lib/pkmopt/%s" % loaded_name(path)] = path

    info = "pkmopt-%s.dist-info" % version
    texts = {
        info + "/METADATA": "Metadata-Version: 2.1\nName: pkmopt\nVersion: %s\n"
        "Summary: Kinematics, workspaces and optimisation of parallel robots\nLicense: BSD-3-Clause\n"
        "Requires-Python: >=3.11\nRequires-Dist: numpy>=1.24\n" % version,
        info + "/WHEEL": "Wheel-Version: 1.0\nGenerator: make_wheel.py\nRoot-Is-Purelib: false\nTag: py3-none-%s\n" % PLATFORM,
    }
    files[info + "/sboms/pkmopt.cdx.json"] = tree / "share/doc/pkmopt/pkmopt.cdx.json"
    for licence in sorted(tree.glob("share/doc/pkmopt/licences/*")) + [tree / "share/doc/pkmopt/LICENSE"]:
        files["%s/licences/%s" % (info, licence.name)] = licence

    folder.mkdir(parents=True, exist_ok=True)
    wheel = folder / ("pkmopt-%s-py3-none-%s.whl" % (version, PLATFORM))
    record = []
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED) as archive:
        contents = [(name, path.read_bytes()) for name, path in sorted(files.items())]
        contents += [(name, text.encode()) for name, text in texts.items()]

        def write(name, data):
            entry = zipfile.ZipInfo(name)  # without the time, so that the same files give the same wheel
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = (0o755 if ".so" in name else 0o644) << 16
            archive.writestr(entry, data)

        for name, data in contents:
            write(name, data)
            digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
            record.append("%s,sha256=%s,%d" % (name, digest, len(data)))
        record.append(info + "/RECORD,,")
        write(info + "/RECORD", ("\n".join(record) + "\n").encode())
    print(wheel)


if __name__ == "__main__":
    main()
