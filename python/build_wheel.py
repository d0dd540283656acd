#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Builds the wheel of thread_plan, by `make wheel` or by pip (a backend as in PEP 517, with no other package).

    python3 build_wheel.py FOLDER [LIBRARY]

With a library, a libthread.so that needs nothing but the C library, the wheel is of this processor and has it in it; without one it
is of any, and the system's libthread is used. The same files give the same bytes.
"""
import base64
import hashlib
import os
import platform
import re
import sys
import zipfile

HERE = os.path.dirname(os.path.abspath(__file__))


def _project():
    """The few lines of pyproject.toml that are needed: Python learned to read it in 3.11 only."""
    with open(os.path.join(HERE, "pyproject.toml"), encoding="utf-8") as file:
        return dict(re.findall(r'^(\w[\w-]*) = "(.*)"$', file.read(), re.M))


def _tag(library):
    if not library:
        return "py3-none-any"
    name, version = os.confstr("CS_GNU_LIBC_VERSION").split()
    if name != "glibc":
        raise SystemExit("build_wheel.py: a library of this system (%s) is of no platform that pip knows" % name)
    return "py3-none-manylinux_%s_%s" % (version.replace(".", "_"), platform.machine())


def _metadata(project):
    with open(os.path.join(HERE, project["readme"]), encoding="utf-8") as file:
        text = file.read()
    return ("Metadata-Version: 2.1\nName: %s\nVersion: %s\nSummary: %s\nLicense: GPL-3.0-or-later, the Python files MIT\n"
            "Requires-Python: %s\nDescription-Content-Type: text/markdown\n\n%s"
            % (project["name"], project["version"], project["description"], project["requires-python"], text))


def write(folder, library=None):
    """Writes the wheel into the folder; its name."""
    project, tag = _project(), _tag(library)
    stem = "%s-%s" % (project["name"].replace("-", "_"), project["version"])
    info = stem + ".dist-info/"
    entries = {}
    for name in sorted(os.listdir(os.path.join(HERE, "thread_plan"))):
        if name.endswith((".py", ".typed")):
            with open(os.path.join(HERE, "thread_plan", name), "rb") as file:
                entries["thread_plan/" + name] = file.read()
    if library:
        with open(library, "rb") as file:
            entries["thread_plan/lib/libthread.so.0"] = file.read()
    entries[info + "METADATA"] = _metadata(project).encode()
    entries[info + "WHEEL"] = ("Wheel-Version: 1.0\nGenerator: thread\nRoot-Is-Purelib: %s\nTag: %s\n"
                               % ("false" if library else "true", tag)).encode()
    record = ""
    for name, data in entries.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
        record += "%s,sha256=%s,%d\n" % (name, digest, len(data))
    entries[info + "RECORD"] = (record + info + "RECORD,,\n").encode()

    wheel = "%s-%s.whl" % (stem, tag)
    os.makedirs(folder, exist_ok=True)
    part = os.path.join(folder, wheel + ".part")
    with zipfile.ZipFile(part, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as out:
        for name, data in entries.items():
            entry = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
            entry.external_attr = 0o644 << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            out.writestr(entry, data)
    os.replace(part, os.path.join(folder, wheel))
    return wheel


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    return write(wheel_directory)


if __name__ == "__main__":
    if not 2 <= len(sys.argv) <= 3:
        raise SystemExit(__doc__)
    print(os.path.join(sys.argv[1], write(*sys.argv[1:])))
