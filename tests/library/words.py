#!/usr/bin/env python3
"""Texts of the library speak of members of its structs, not of options of commands: every option that a text in the folders behind
include/thread.h names is, with _ for -, a word of that header, of the physics or of a request, or stands in the table of
lib/library.c. Says nothing if all is well."""
import glob
import json
import os
import re
import sys

os.chdir(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
FOLDERS = "lib graph lp symmetry tortuosity planner eval diagram kit".split()
# for people at the command: what a command's page, a booklet's text and option tables say, which are no status of the library
ELSEWHERE = {"lib/documents.c", "graph/plan/request_fields.c", "diagram/sheets/sheets_last.c", "planner/rivals.c", "lib/library.c"}


def texts(path):
    """The string literals of a file, those that follow each other joined."""
    with open(path, encoding="utf-8") as file:
        code = re.sub(r"/\*.*?\*/", "", file.read().replace("'\"'", ""), flags=re.S)
    return re.findall(r'"((?:\\.|[^"\\])*)"', re.sub(r'(?<!\\)"\s+"', "", code))


with open("include/thread.h", encoding="utf-8") as header:
    known = set(re.findall(r"\w+", re.sub(r"/\*.*?\*/", "", header.read(), flags=re.S)))
with open("docs/plan.schema.json", encoding="utf-8") as schema:
    defined = json.load(schema)["$defs"]
    known |= set(defined["physics"]["properties"]) | set(defined["options"]["properties"])
with open("lib/library.c", encoding="utf-8") as library:
    said = re.findall(r'\{"([^"]*)", "[^"]*"\}', library.read())

missing = []
for folder in FOLDERS:
    for path in sorted(glob.glob(folder + "/**/*.c*", recursive=True)):
        for text in texts(path) if path not in ELSEWHERE else ():
            for words in said:
                text = text.replace(words, "")
            missing += ["%s: --%s in: %s" % (path, option, text) for option in re.findall(r"--([a-z][a-z-]*)", text)
                        if option.replace("-", "_") not in known]
print("\n".join(missing), end="\n" if missing else "")
sys.exit(bool(missing))
