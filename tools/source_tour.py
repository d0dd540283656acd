#!/usr/bin/env python3
"""Writes the lists of files in docs/source-tour.md from the heads of the files themselves.

tools/source_tour.py           rewrites the lists
tools/source_tour.py --check   compares only: prints what differs, exit code 1

Between a line `<!-- files of FOLDER -->` and the next `<!-- end -->` stands one row for each name in that folder: foo.c and foo.h are
one row, described by the first sentence of the comment that the source begins with (the header, if the source has none). Every
folder with sources has its list; one without is an error, as is a file without a head.
"""
import os
import re
import subprocess
import sys

PAGE = os.path.join("docs", "source-tour.md")
MODULES = ["include", "lib", "graph", "lp", "symmetry", "tortuosity", "planner", "eval", "diagram", "cli", "targets", "web"]
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


def rows(folder, names, bad):
    out = ["| file | what |", "|---|---|"]
    for name in sorted(names):
        endings = sorted(names[name], key=ENDINGS.index)
        heads = [first_sentence(os.path.join(folder, name + ending)) for ending in endings]
        what = next((head for head in heads if head), None)
        if what is None:
            bad.append("%s: begins with no comment that says what it is" % os.path.join(folder, name + endings[0]))
            continue
        out.append("| `%s` | %s |" % ("`, `".join([name + endings[0]] + endings[1:]), what))
    return out


def filled(page, bad):
    known, out, skipping = folders(), [], False
    seen = set()
    for line in page.split("\n"):
        begin = re.match(r"<!-- files of (\S+) -->", line)
        if line == "<!-- end -->":
            skipping = False
        if not skipping:
            out.append(line)
        if begin:
            folder = begin.group(1).rstrip("/")
            seen.add(folder)
            skipping = True
            if folder in known:
                out += rows(folder, known[folder], bad)
            else:
                bad.append("%s: lists files of %s/, which has none" % (PAGE, folder))
    bad += ["%s: has no list `<!-- files of %s -->`" % (PAGE, f) for f in sorted(set(known) - seen)]
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
            bad.append("%s: not what the heads of the files say; tools/source_tour.py writes it. First: %s" %
                       (PAGE, next((line for line in new.split("\n") if line not in old), "a line too many")))
    elif not bad:
        with open(PAGE, "w", encoding="utf-8") as f:
            f.write(new)
    print("\n".join(bad) if bad else "source tour: ok")
    sys.exit(1 if bad else 0)


if __name__ == "__main__":
    main()
