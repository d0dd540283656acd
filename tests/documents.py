#!/usr/bin/env python3
"""Holds the documents against each other and the program: tests/documents.py THREAD prints what differs, exit code 1.

Every entry of the glossary occurs in another document or in the program's help, and every word that docs/method.md defines (in
bold) is an entry. The guide and the man page have the exit codes of the program's table. Entries are the words of the first column of the tables, parted by commas; case, a plural s and what stands in
brackets do not count. Files of the source that the documents name in backquotes exist.
"""
import glob
import json
import os
import re
import subprocess
import sys

GLOSSARY = os.path.join("docs", "glossary.md")
METHOD = os.path.join("docs", "method.md")
COMMANDS = ["plan", "advise", "symmetries", "check", "eval", "compare", "draw", "info", "convert", "make"]


def read(path):
    with open(path, encoding="utf-8") as f:
        return f.read()


def plain(words):
    return re.sub(r"\s+", " ", words).strip().lower()


def documents():
    return ["README.md", "CONTRIBUTING.md", *sorted(glob.glob("docs/*.md"))]


def files_that_are_not():
    """(document, file) for every file with a folder that a document names and that is not there."""
    for page in documents():
        for path in re.findall(r"`((?:\w+/)+\w+\.(?:c|h|cpp|py|sh))`", read(page)):
            if not os.path.exists(path):
                yield page, path


def entries():
    rows = [line.split("|")[1] for line in read(GLOSSARY).split("\n") if line.startswith("| ")]
    return [plain(word) for row in rows if row.strip() != "term" for word in re.sub(r"\(.*?\)", "", row).split(",")]


def explained(program):
    """All that readers see: the other documents and the help of every command."""
    pages = [path for path in documents() if path != GLOSSARY]
    helps = [subprocess.run([program, command, "--help"], capture_output=True, text=True, check=True).stdout for command in COMMANDS]
    return plain("\n".join([read(page) for page in pages] + helps))


def exit_codes_missing(program):
    """(document, code) for every exit code that a document does not explain as `thread help exit-codes` does."""
    told = subprocess.run([program, "help", "exit-codes", "--json"], capture_output=True, text=True, check=True).stdout
    for code, meaning in json.loads(told).items():
        for page, line in (("docs/guide.md", "| %s | %s |" % (code, meaning)),
                           ("docs/thread.1", ".B %s\n%s\n" % (code, meaning.replace("-", "\\-")))):
            if line not in read(page):
                yield page, code


def main():
    program = os.path.abspath(sys.argv[1])
    os.chdir(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
    known, text = entries(), explained(program)
    bad = ["%s: '%s' is in no other document and in no help" % (GLOSSARY, word) for word in known if not re.search(r"\b" + re.escape(word), text)]
    bad += ["%s: '%s' is there twice" % (GLOSSARY, word) for word in sorted(set(known)) if known.count(word) > 1]
    defined = dict.fromkeys(plain(word) for word in re.findall(r"\*\*(.+?)\*\*", read(METHOD), re.DOTALL))
    bad += ["%s: '%s', which %s defines, is no entry" % (GLOSSARY, word, METHOD)
            for word in defined if word not in known and re.sub("s$", "", word) not in known]
    bad += ["%s: there is no %s" % each for each in files_that_are_not()]
    bad += ["%s: exit code %s is not explained as by thread help exit-codes" % each for each in exit_codes_missing(program)]
    print("\n".join(bad) if bad else "documents: ok")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
