#!/usr/bin/env python3
"""Makes what docs/ shows of the program with the program itself.

tools/make_docs.py THREAD           rewrites the pictures, the gallery and the outputs in the tutorial
tools/make_docs.py THREAD --check   compares the outputs in the tutorial only: prints what differs, exit code 1

docs/tutorial.md holds fenced blocks whose lines `$ thread ..` are commands, run one after another in one empty folder; what they
print follows each of them. docs/gallery.md holds one row of numbers for each framework of GALLERY. Pictures are PNG files in
docs/pictures, made by rsvg-convert and pdftoppm from the drawings of the program.
"""
import difflib
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
PICTURES = os.path.join("docs", "pictures")
BEGIN, END = "<!-- the table that make docs writes -->", "<!-- end -->"

# What each row of the gallery is: its name, where the framework is from (a shape to make, or a file of data/), and the options
# of the plan.
GALLERY = [
    ("dome", ["dome", "--size", "7"], ["--cords", "4", "--ends", "feet"]),
    ("tube", ["tube", "--size", "12", "--rings", "7"], ["--cords", "6", "--ends", "feet"]),
    ("sphere", ["sphere", "--size", "2"], ["--cords", "6", "--ends", "any"]),
    ("geodesic", ["geodesic", "--size", "2"], ["--cords", "4", "--ends", "feet"]),
    ("honeycomb", ["honeycomb", "--size", "4"], ["--cords", "12", "--ends", "any"]),
    ("pattern", ["dome", "--size", "6"], ["--objective", "symmetry", "--ends", "feet"]),
    ("barrel", "jax_fdm/barrel.obj", ["--feet", "lowest", "--cords", "10", "--ends", "any"]),
    ("monkey-saddle", "jax_fdm/monkey_saddle.json", ["--cords", "2", "--ends", "any"]),
    ("tree", "assembly-instances/robarch_tree_S.json", ["--cords", "6", "--ends", "feet"]),
    ("tower", "conmech/tower_3D.json", ["--cords", "3", "--ends", "feet"]),
]


class Run:
    """The program in an empty folder of its own, with its own cache."""

    def __init__(self, program):
        self.folder = tempfile.mkdtemp()
        self.env = dict(os.environ, PATH=os.path.dirname(os.path.abspath(program)) + os.pathsep + os.environ["PATH"],
                        XDG_CACHE_HOME=os.path.join(self.folder, ".cache"), NO_COLOR="1", COLUMNS="120")
        os.symlink(os.path.join(ROOT, "data"), os.path.join(self.folder, "data"))

    def text(self, command):
        """What a line of shell prints, its two streams as a reader sees them."""
        done = subprocess.run(command, shell=True, cwd=self.folder, env=self.env, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if done.returncode:
            sys.exit("make_docs: `%s` ended with %d:\n%s" % (command, done.returncode, done.stdout))
        return done.stdout

    def thread(self, *words):
        done = subprocess.run(["thread", *words], cwd=self.folder, env=self.env, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        if done.returncode not in (0, 5): # 5: a plan whose proof leaves a gap
            sys.exit("make_docs: thread %s ended with %d:\n%s" % (" ".join(words), done.returncode, done.stderr))
        return done.stdout

    def path(self, name):
        return os.path.join(self.folder, name)


def svg_to_png(svg, png, width):
    subprocess.run(["rsvg-convert", "--width", str(width), "--keep-aspect-ratio", "--background-color", "white", "-o", png, svg], check=True)


def step_page(pdf):
    """The first page of a booklet with a step."""
    text = subprocess.run(["pdftotext", "-raw", pdf, "-"], stdout=subprocess.PIPE, text=True, check=True).stdout
    return next(page for page, words in enumerate(text.split("\f"), 1) if "Check: the " in words)


def page_to_png(pdf, page, png, dots):
    subprocess.run(["pdftoppm", "-png", "-singlefile", "-r", str(dots), "-f", str(page), "-l", str(page), pdf, png[: -len(".png")]], check=True)


def newtons(value):
    return "%.3g N" % value


def gallery_row(run, entry, pictures):
    """The framework planned and drawn; its row of the table."""
    name, source, options = entry
    options = options if "--objective" in options else [*options, "--objective", "tortuosity"]
    made = isinstance(source, list)
    frame = name + ".json" if made else os.path.join("data", source)
    if made:
        run.thread("make", *source, "-o", frame)
    said = json.loads(run.thread("plan", frame, *options, "--json", "-o", name + "-plan.json", "--draw", name))
    svg_to_png(run.path(os.path.join(name, "overview.svg")), os.path.join(pictures, name + ".png"), 400)
    booklet = run.path(os.path.join(name, "sheets.pdf"))
    page_to_png(booklet, step_page(booklet), os.path.join(pictures, name + "-step.png"), 50)
    first = "`thread make %s -o %s`<br>" % (" ".join(source), frame) if made else ""
    command = first + "`thread plan %s`" % " ".join([frame, *options])
    show = "<img src=\"pictures/%s.png\" width=\"%d\" alt=\"%s\">"
    return "| %s | %s | %s<br><br>%d pieces, %d interfaces; %d cord%s, %.2f m in all; the hardest pull %s |" % (
        show % (name, 300, "the %s from above" % name), show % (name + "-step", 240, "a step of the %s" % name), command, said["nodes"],
        said["edges"], said["cords"], "" if said["cords"] == 1 else "s", said["length"] / 1000, newtons(said["pull_factor"]))


def gallery(run, page, pictures):
    """The page with its table made anew."""
    head, rest = page.split(BEGIN)
    rows = [gallery_row(run, entry, pictures) for entry in GALLERY]
    table = ["", "| seen from outside | a page of the booklet | made by |", "|---|---|---|", *rows, ""]
    return head + BEGIN + "\n".join(table) + END + rest.split(END, 1)[1]


def with_outputs(run, page):
    """The page with what its commands print behind them."""
    def block(found):
        out = []
        for line in found.group(1).split("\n"):
            if line.startswith("$ "):
                out.append(line)
                out.extend(run.text(line[2:]).rstrip("\n").split("\n"))
        return "```\n" + "\n".join(out) + "\n```"
    return re.sub(r"```\n(\$ .*?)\n```", block, page, flags=re.DOTALL)


def tutorial_pictures(run, pictures):
    """Of the dome that the tutorial has planned by then."""
    for name in ("advice", "first/overview", "first/tension"):
        svg_to_png(run.path(name + ".svg"), os.path.join(pictures, "first-%s.png" % os.path.basename(name)), 620)
    pages = int(re.search(r"Pages: *(\d+)", subprocess.run(["pdfinfo", run.path("first/sheets.pdf")], stdout=subprocess.PIPE, text=True,
                                                           check=True).stdout).group(1))
    for page in range(1, pages + 1):
        page_to_png(run.path("first/sheets.pdf"), page, os.path.join(pictures, "first-page-%d.png" % page), 50)


def put(path, text, check):
    """Writes the page, or tells how it differs; true if it is as it was."""
    with open(path, encoding="utf-8") as f:
        old = f.read()
    if check:
        sys.stdout.writelines(difflib.unified_diff(old.splitlines(True), text.splitlines(True), path, path + " as made"))
    elif old != text:
        with open(path, "w", encoding="utf-8") as f:
            f.write(text)
    return old == text


def forget_pictures():
    """Those that are made here; `make validate` and the tests of the page make the others."""
    os.makedirs(PICTURES, exist_ok=True)
    for name in os.listdir(PICTURES):
        if not name.startswith(("validation-", "page-")):
            os.remove(os.path.join(PICTURES, name))


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    check = "--check" in sys.argv[2:]
    run = Run(sys.argv[1])
    os.chdir(ROOT)
    same = True
    try:
        if not check:
            forget_pictures()
        pages = {name: os.path.join("docs", name) for name in ("tutorial.md", "gallery.md")}
        text = {name: open(path, encoding="utf-8").read() for name, path in pages.items()}
        same &= put(pages["tutorial.md"], with_outputs(run, text["tutorial.md"]), check)
        if not check:
            tutorial_pictures(run, PICTURES)
            put(pages["gallery.md"], gallery(run, text["gallery.md"], PICTURES), check)
    finally:
        shutil.rmtree(run.folder)
    sys.exit(0 if same or not check else 1)


main()
