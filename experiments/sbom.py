#!/usr/bin/env python3
"""Writes the software bill of materials of an installed archive, in CycloneDX 1.5 (JSON): sbom.py TREE VERSION

TREE is what `cmake --install` with PKM_BUNDLE=ON has installed. The list has the libraries that are copied into the
archive and those that are compiled into the program, with the versions of their Debian packages, and the licences that
their copyright files name. It is written to share/doc/pkmopt/pkmopt.cdx.json. The time in it is SOURCE_DATE_EPOCH, so
that the same files give the same bytes.
"""

import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys
import time
import uuid

# Names of licences in Debian's copyright files that have an SPDX identifier.
SPDX = {"BSD-3-clause": "BSD-3-Clause", "BSD-2-clause": "BSD-2-Clause", "BSD-3-Clause": "BSD-3-Clause",
        "BSD-2-Clause": "BSD-2-Clause", "Expat": "MIT", "MIT": "MIT", "Apache-2.0": "Apache-2.0", "MPL-2.0": "MPL-2.0",
        "MPL-2": "MPL-2.0", "EPL-1.0": "EPL-1.0", "EPL-2.0": "EPL-2.0", "EPL": "EPL-1.0", "Zlib": "Zlib", "zlib": "Zlib",
        "LGPL-2+": "LGPL-2.0-or-later", "LGPL-2.1": "LGPL-2.1-only", "LGPL-2.1+": "LGPL-2.1-or-later",
        "LGPL-3+": "LGPL-3.0-or-later", "GPL-2": "GPL-2.0-only", "GPL-2+": "GPL-2.0-or-later", "GPL-3": "GPL-3.0-only",
        "GPL-3+": "GPL-3.0-or-later", "CeCILL-C": "CECILL-C", "CeCILL-C-V1": "CECILL-C"}


def query(package, field):
    done = subprocess.run(["dpkg-query", "--show", "--showformat=${%s}" % field, package], capture_output=True, text=True)
    return done.stdout.strip()


def licences_of(copyright_file):
    """The licences that a machine-readable copyright file names, as SPDX identifiers or by their names in Debian."""
    names = re.findall(r"^License:[ \t]*(\S.*)$", copyright_file.read_text(errors="replace"), re.MULTILINE)
    names = {name.strip() for name in names}
    if not names:
        return [{"license": {"name": "see licences/" + copyright_file.name}}]
    return [{"license": {"id": SPDX[name]} if name in SPDX else {"name": name}} for name in sorted(names)]


def plotly():
    """The JavaScript library in the page of `pkmopt report`, which is not from Debian."""
    page = pathlib.Path(__file__).resolve().parents[1] / "engine" / "report" / "page" / "package.json"
    name = "plotly.js-dist-min"
    version = json.loads(page.read_text())["dependencies"][name]
    return {"type": "library", "bom-ref": name, "name": name, "version": version, "purl": "pkg:npm/%s@%s" % (name, version),
            "licenses": [{"license": {"id": "MIT"}}], "description": "part of the page of `pkmopt report`"}


def component(licence, libraries):
    package = licence.name
    if package == "plotly.js":
        return plotly()
    version = query(package, "Version")
    found = {"type": "library", "bom-ref": package, "name": package, "licenses": licences_of(licence)}
    if version:
        found["version"] = version
        found["purl"] = "pkg:deb/debian/%s@%s?arch=%s" % (package, version.replace("+", "%2B").replace(":", "%3A"),
                                                         query(package, "Architecture"))
    owned = [library for library in libraries if package in library["owners"]]
    found["components"] = [{"type": "file", "name": library["name"],
                            "hashes": [{"alg": "SHA-256", "content": library["sha256"]}]} for library in owned]
    if not owned:
        del found["components"]
        found["description"] = "compiled into the program"
    return found


def owners_of(name):
    """The Debian packages that contain a library of this name; that of Ipopt is not in a folder of the architecture."""
    found = subprocess.run(["dpkg-query", "--search", "*-linux-gnu*/" + name, "/usr/lib/" + name], capture_output=True,
                           text=True)
    return sorted({line.split(":")[0] for line in found.stdout.splitlines()})


def main():
    tree, version = pathlib.Path(sys.argv[1]), sys.argv[2]
    documents = tree / "share" / "doc" / "pkmopt"
    # A link may be one of the system's choice among several packages (libblas.so.3), so look for the file behind it.
    libraries = [{"name": path.name, "owners": owners_of(path.resolve().name),
                  "sha256": hashlib.sha256(path.read_bytes()).hexdigest()}
                 for path in sorted(tree.glob("lib/**/pkmopt/*.so*"))]
    unknown = [library["name"] for library in libraries if not library["owners"]]
    if unknown:
        sys.exit("sbom.py: no Debian package contains " + ", ".join(unknown))
    licences = sorted((documents / "licences").iterdir())
    missing = {owner for library in libraries for owner in library["owners"]} - {path.name for path in licences}
    if missing:
        sys.exit("sbom.py: no copyright file of " + ", ".join(sorted(missing)))
    components = [component(licence, libraries) for licence in licences]
    when = time.gmtime(int(os.environ.get("SOURCE_DATE_EPOCH", time.time())))
    bill = {"bomFormat": "CycloneDX", "specVersion": "1.5", "version": 1,
            "metadata": {"timestamp": time.strftime("%Y-%m-%dT%H:%M:%SZ", when),
                         "component": {"type": "application", "bom-ref": "pkmopt", "name": "pkmopt", "version": version,
                                       "licenses": [{"license": {"id": "BSD-3-Clause"}}]}},
            "components": components,
            "dependencies": [{"ref": "pkmopt", "dependsOn": [each["bom-ref"] for each in components]}]}
    text = json.dumps(bill, sort_keys=True)
    bill["serialNumber"] = "urn:uuid:%s" % uuid.uuid5(uuid.NAMESPACE_URL, text)
    (documents / "pkmopt.cdx.json").write_text(json.dumps(bill, indent=2) + "\n")


if __name__ == "__main__":
    main()
