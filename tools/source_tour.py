#!/usr/bin/env python3
"""Writes what the folders of docs/source-tour.md offer from the heads of their headers.

tools/source_tour.py           rewrites the last column of the tables of folders
tools/source_tour.py --check   compares only: prints what differs, exit code 1

A row of such a table is `| folder/ | what for, by hand | headers |`, between a line `<!-- folders -->` and the next `<!-- end -->`.
The last column names each header of the folder with the first sentence of the comment that it begins with; headers that only
the folder's own files share (.._parts.h) are left out. Every folder with sources has its row, and every source and header begins
with a comment that says what it is, or its header does: what is missing is an error.
"""
import os
import re
import subprocess
import sys

PAGE = os.path.join("docs", "source-tour.md")
MODULES = ["include", "lib", "graph", "lp", "symmetry", "tortuosity", "planner", "eval", "diagram", "kit", "cli", "targets", "web"]
ENDINGS = [".c", ".h", ".cpp", ".S"]


def first_sentence(path):
    """Of the comment that the file begins with after its licence; None if it begins otherwise."""
    with open(path, encoding="utf-8") as f:
        text = f.read()
    found = re.match(r"(?:/\* SPDX[^\n]*\n)?/\*(.*?)\*/", text, re.DOTALL)
    if not found or found.group(1).startswith(" SPDX"):
        return None
    words = re.sub(r"\s*\n \*[ ]?", "\n", found.group(1)).split("\n\n")[0].replace("\n", " ").strip()
    end = re.search(r"(?<=[a-z)\"0-9][a-z)\"0-9])[.](?=\s|$)", words)
    return (words[: end.start()] if end else words).replace("|", "\\|")


def folders():
    """{folder: {name: [endings]}} of the sources that git knows."""
    out = {}
    for path in subprocess.run(["git", "ls-files", *MODULES], stdout=subprocess.PIPE, text=True, check=True).stdout.split():
        folder, base = os.path.split(path)
        name, ending = os.path.splitext(base)
        if ending in ENDINGS and os.path.exists(path):
            out.setdefault(folder, {}).setdefault(name, []).append(ending)
    return out


def without_head(known):
    """The sources that begin with no comment, and whose header, if there is one, does not either."""
    for folder, names in known.items():
        for name, endings in names.items():
            if not any(first_sentence(os.path.join(folder, name + ending)) for ending in endings):
                yield os.path.join(folder, name + endings[0])


def offered(folder, names):
    headers = sorted(name for name, endings in names.items() if ".h" in endings and not name.endswith("_parts"))
    told = [(name + ".h", first_sentence(os.path.join(folder, name + ".h"))) for name in headers]
    return "; ".join("`%s`%s" % (name, ": " + head if head else "") for name, head in told)


def filled(page, bad):
    known, out, seen, inside = folders(), [], set(), False
    for line in page.split("\n"):
        inside = (inside or line == "<!-- folders -->") and line != "<!-- end -->"
        row = re.match(r"(\| `([^`]+)/` \| [^|]* \|)", line) if inside else None
        if row and row.group(2) in known:
            seen.add(row.group(2))
            line = ("%s %s" % (row.group(1), offered(row.group(2), known[row.group(2)]))).rstrip() + " |"
        elif row:
            bad.append("%s: has a row for %s/, which has no sources" % (PAGE, row.group(2)))
        out.append(line)
    bad += ["%s: has no row for %s/" % (PAGE, folder) for folder in sorted(set(known) - seen)]
    bad += ["%s: begins with no comment that says what it is" % path for path in without_head(known)]
    return "\n".join(out)


def main():
    os.chdir(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
    with open(PAGE, encoding="utf-8") as f:
        page = f.read()
    bad = []
    new = filled(page, bad)
    if "--check" in sys.argv[1:]:
        if new != page:
            old = set(page.split("\n"))
            bad.append("%s: not what the heads of the headers say; tools/source_tour.py writes it. First: %s" %
                       (PAGE, next((line for line in new.split("\n") if line not in old), "a line too many")))
    elif not bad:
        with open(PAGE, "w", encoding="utf-8") as f:
            f.write(new)
    print("\n".join(bad) if bad else "source tour: ok")
    sys.exit(1 if bad else 0)


if __name__ == "__main__":
    main()
