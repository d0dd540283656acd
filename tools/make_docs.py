#!/usr/bin/env python3
"""Makes what docs/ shows of the program with the program itself.

tools/make_docs.py THREAD           rewrites the pictures, the gallery and the outputs in the tutorial
tools/make_docs.py THREAD --check   compares the outputs in the tutorial only: prints what differs, exit code 1

docs/tutorial.md holds fenced blocks whose lines `$ thread ..` are commands, run one after another in one empty folder; what they
print follows each of them. docs/gallery.md holds a row for each framework of GALLERY, each kit of KITS and each rise of RISES.
Pictures are PNG files in docs/pictures, made by rsvg-convert and pdftoppm from the drawings of the program; the first one of README.md
is put together from several.
"""
import difflib
import json
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
PICTURES = os.path.join("docs", "pictures")
BEGIN, END = "<!-- the table that make docs writes -->", "<!-- end -->"
KITS_BEGIN = "<!-- the kits that make docs writes -->"
RISES_BEGIN = "<!-- the rises that make docs writes -->"

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

# Kits: of a plan of the gallery, or of a framework and the options of a plan; and the piece that is shown alone.
KITS = [
    ("dome", None, None, "B2"),
    ("tube", None, None, "C2"),
    ("sphere", None, None, "B3"),
    ("honeycomb-3", ["honeycomb", "--size", "3"], ["--cords", "8", "--ends", "any"], "C2"),
    ("voronoi", "assembly-instances/voronoi_S1_03-14-2019_w_layer.json", ["--cords", "6", "--ends", "any", "--objective", "length"], "13"),
]

# Rises: name, plan of data/, what is said of it, options. The first one is the film of README.md, too.
RISES = [
    ("rise-lines", "dome7-lines.json", "the dome on 14 straight cords", ["--pull", "3"]),
    ("rise-snake-1", "dome7-snake.json", "the same dome on one cord through all rows and columns", ["--seed", "1"]),
    ("rise-snake-2", "dome7-snake.json", "the same cord from another disorder", ["--seed", "2"]),
]

# The first picture of README.md: three pieces, a page of the booklet, the dome; px.
FIRST = """<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" width="1200" height="450">
<image x="0" y="0" width="200" height="150" xlink:href="B1.png"/>
<image x="0" y="145" width="200" height="150" xlink:href="B2.png"/>
<image x="0" y="290" width="200" height="150" xlink:href="A1.png"/>
<image x="215" y="16" width="296" height="418" xlink:href="page.png"/>
<rect x="215.5" y="16.5" width="295" height="417" fill="none" stroke="#b0b0b4"/>
<image x="520" y="30" width="680" height="400" xlink:href="whole.png"/>
</svg>
"""


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


def kit_to_png(run, plan, png, size, *options):
    run.thread("draw", plan, "-T", "picture", "--size", size, *options, "-o", os.path.abspath(png))


def newtons(value):
    return "%.3g N" % value


def metres(said):
    """The length of all cords; a unit that is not known counts as one in mm, as the program has it."""
    return "%.2f m" % (said["length"] * {"m": 1, "cm": 0.01, "in": 0.0254, "ft": 0.3048}.get(said["units"], 0.001))


def planned(run, name, source, options):
    """The framework planned and drawn: the commands, and what the plan says."""
    options = options if "--objective" in options else [*options, "--objective", "tortuosity"]
    made = isinstance(source, list)
    frame = name + ".json" if made else os.path.join("data", source)
    if made:
        run.thread("make", *source, "-o", frame)
    first = "`thread make %s -o %s`<br>" % (" ".join(source), frame) if made else ""
    said = json.loads(run.thread("plan", frame, *options, "--json", "-o", name + "-plan.json", "--draw", name))
    return first + "`thread plan %s`" % " ".join([frame, *options]), said


def gallery_row(run, entry, pictures):
    """The framework planned and drawn; its row of the table."""
    name, source, options = entry
    command, said = planned(run, name, source, options)
    svg_to_png(run.path(os.path.join(name, "overview.svg")), os.path.join(pictures, name + ".png"), 400)
    booklet = run.path(os.path.join(name, "sheets.pdf"))
    page_to_png(booklet, step_page(booklet), os.path.join(pictures, name + "-step.png"), 50)
    show = "<img src=\"pictures/%s.png\" width=\"%d\" alt=\"%s\">"
    return "| %s | %s | %s<br><br>%d pieces, %d interfaces; %d cord%s, %s in all; the hardest pull %s |" % (
        show % (name, 300, "the %s from above" % name), show % (name + "-step", 240, "a step of the %s" % name), command, said["nodes"],
        said["edges"], said["cords"], "" if said["cords"] == 1 else "s", metres(said), newtons(said["pull_factor"]))


def kit_row(run, entry, pictures):
    """The kit and one of its pieces drawn; its row of the table."""
    name, source, options, piece = entry
    command, plan = "", name + "-plan.json"
    if source:
        command = planned(run, name, source, options)[0] + "<br>"
    kit_to_png(run, plan, os.path.join(pictures, name + "-kit.png"), "600x420")
    kit_to_png(run, plan, os.path.join(pictures, name + "-piece.png"), "300x240", "--piece", piece)
    show = "<img src=\"pictures/%s-%s.png\" width=\"%d\" alt=\"%s\">"
    return "| %s | %s | %s`thread draw %s/plan.json -T picture`<br>`thread draw %s/plan.json -T picture --piece %s` |" % (
        show % (name, "kit", 420, "the pieces of the %s with the cords in them" % name),
        show % (name, "piece", 210, "piece %s of the %s" % (piece, name)), command, name, name, piece)


def with_table(page, begin, head, rows):
    """The page with the table behind a mark made anew."""
    before, rest = page.split(begin)
    return before + begin + "\n".join(["", "| %s |" % head, "|---|---|---|", *rows, ""]) + END + rest.split(END, 1)[1]


def gallery(run, page, pictures):
    """The page with its tables made anew."""
    page = with_table(page, BEGIN, "seen from outside | a page of the booklet | made by", [gallery_row(run, entry, pictures) for entry in GALLERY])
    return with_table(page, KITS_BEGIN, "whole | a piece, by a mouth | made by", [kit_row(run, entry, pictures) for entry in KITS])


def first_picture(run, pictures):
    """What becomes of the gallery's dome: pieces, paper, the dome itself."""
    for piece in ("B1", "B2", "A1"):
        kit_to_png(run, "dome-plan.json", run.path(piece + ".png"), "400x300", "--piece", piece)
    kit_to_png(run, "dome-plan.json", run.path("whole.png"), "1360x800")
    booklet = run.path(os.path.join("dome", "sheets.pdf"))
    page_to_png(booklet, step_page(booklet), run.path("page.png"), 75)
    with open(run.path("first.svg"), "w", encoding="utf-8") as f:
        f.write(FIRST)
    svg_to_png(run.path("first.svg"), os.path.join(pictures, "first.png"), 1200)


def rise_row(run, entry, pictures):
    """The plan's pieces let rise, as a film for README if it is the first; its row of the table: the first picture, the last one."""
    name, plan, what, options = entry
    source = os.path.join("data", plan)
    film = ["--film", os.path.abspath(os.path.join(pictures, "rise.png"))] if entry is RISES[0] else []
    said = run.thread("rise", source, *options, "--size", "480x300", "--frames", name, *film).split("\n")
    frames = sorted(os.listdir(run.path(name)))
    for frame, at in ((frames[0], "begin"), (frames[-1], "end")):
        shutil.copy(run.path(os.path.join(name, frame)), os.path.join(pictures, "%s-%s.png" % (name, at)))
    show = "<img src=\"pictures/%s-%s.png\" width=\"360\" alt=\"%s\">"
    return "| %s | %s | `thread rise %s`<br><br>%s: %s; %s |" % (
        show % (name, "begin", what + ", flat on the ground"), show % (name, "end", what + ", pulled"), " ".join([source, *options]), what,
        *said[1:3])


def rises(run, page, pictures):
    """The page with the table of what rises made anew."""
    return with_table(page, RISES_BEGIN, "flat on the ground | pulled | made by", [rise_row(run, entry, pictures) for entry in RISES])


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


def figures(run):
    """What the prose of the tutorial says of the dome: its words, with a group for the figure, and the figure."""
    with open(run.path("first/cords.csv"), encoding="utf-8") as f:
        head, *rows = [line.split(",") for line in f.read().strip().split("\n")]
    cut, knots, tails = (max(float(row[head.index(name)]) for row in rows) for name in ("cut", "knots", "tails"))
    plan = json.load(open(run.path("first/plan.json"), encoding="utf-8"))
    number = {2: "two", 16: "sixteen"}
    return [(r"\| (\d+) pieces \|", str(len(plan["framework"]["nodes"]))),
            (r"dome of (\w+) pieces", number[len(plan["framework"]["nodes"])]),
            (r"pieces on (\w+) cords", number[len(rows)]),
            (r"\| cord \| twice (\d+) cm", "%d" % (5 * math.ceil(cut / 50))),
            (r"list says, (\d+) mm each", "%.0f" % cut),
            (r"Put a stopper (\d+) mm from one end", "%.0f" % ((tails + knots) / 2))]


def with_figures(run, page):
    """The page with the figures in its prose as the program has them."""
    for words, figure in figures(run):
        found = re.search(words, page)
        if not found:
            sys.exit("make_docs: the tutorial does not say /%s/" % words)
        page = page[: found.start(1)] + figure + page[found.end(1):]
    return page


def tutorial_pictures(run, pictures):
    """Of the dome that the tutorial has planned by then."""
    for name in ("advice", "first/overview", "first/tension"):
        svg_to_png(run.path(name + ".svg"), os.path.join(pictures, "first-%s.png" % os.path.basename(name)), 620)
    kit_to_png(run, "first/plan.json", os.path.join(pictures, "first-kit.png"), "560x380")
    kit_to_png(run, "first/plan.json", os.path.join(pictures, "first-piece.png"), "300x240", "--piece", "A2")
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
    """Those that are made here; `make validate` and the tests of the page make the others, the guide's commands motion.svg."""
    os.makedirs(PICTURES, exist_ok=True)
    for name in os.listdir(PICTURES):
        if not name.startswith(("validation-", "page-", "experiments", "motion.svg")):
            os.remove(os.path.join(PICTURES, name))


def main():
    check = sys.argv[2:] == ["--check"]
    if len(sys.argv) < 2 or not check and len(sys.argv) > 2 or not os.access(sys.argv[1], os.X_OK):
        sys.exit(__doc__)
    run = Run(sys.argv[1])
    os.chdir(ROOT)
    same = True
    try:
        if not check:
            forget_pictures()
        pages = {name: os.path.join("docs", name) for name in ("tutorial.md", "gallery.md")}
        text = {name: open(path, encoding="utf-8").read() for name, path in pages.items()}
        same &= put(pages["tutorial.md"], with_figures(run, with_outputs(run, text["tutorial.md"])), check)
        if not check:
            tutorial_pictures(run, PICTURES)
            put(pages["gallery.md"], rises(run, gallery(run, text["gallery.md"], PICTURES), PICTURES), check)
            first_picture(run, PICTURES)
    finally:
        shutil.rmtree(run.folder)
    sys.exit(0 if same or not check else 1)


if __name__ == "__main__":
    main()
