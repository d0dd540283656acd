#!/usr/bin/env python3
"""What the thesis says of threading, asked of the command line: tests/validate/claims.py PROGRAM REPORT PICTURES

Appends sections to REPORT (Markdown) and writes plots (SVG) into the folder PICTURES. Exits 1 if a value is outside its bound.
Expected values are closed forms written here, not what the program said once.
"""
import json
import math
import os
import subprocess
import sys
import tempfile

GRAVITY = 9.80665
LENGTH, STRIP = 400.0, 400.0  # mm of the cantilever from the wall; g per 1,000 mm of it: of any width it weighs the same
BLUE, ORANGE, GREEN = "#0072B2", "#D55E00", "#009E73"


class Report:
    def __init__(self):
        self.lines, self.rows, self.outside = [], 0, 0

    def section(self, title, about):
        self.lines += ["", "## " + title, "", about, "", "| what | expected | found | error | bound | |",
                       "|---|---|---|---|---|---|"]

    def row(self, what, expected, found, error, bound, right):
        self.rows += 1
        self.outside += not right
        self.lines.append(f"| {what} | {expected} | {found} | {error} | {bound} | {'ok' if right else '**outside**'} |")

    def relative(self, what, expected, found, bound):
        error = found / expected - 1
        self.row(what, f"{expected:.5g}", f"{found:.5g}", f"{100 * error:+.3f} %", f"{100 * bound:.3g} %", abs(error) <= bound)

    def holds(self, what, expected, found, right):
        self.row(what, expected, found, "", "", right)


class Program:
    def __init__(self, path, folder):
        self.path, self.folder = os.path.abspath(path), folder

    def run(self, *arguments, codes=(0,)):
        done = subprocess.run([self.path, *map(str, arguments)], capture_output=True, text=True, cwd=self.folder)
        if done.returncode not in codes:
            sys.exit(f"{' '.join(map(str, arguments))}: exit {done.returncode}: {done.stderr}")
        return done

    def evaluate(self, *arguments):
        return json.loads(self.run("eval", *arguments, "--json").stdout)

    def frame(self, name, nodes, edges, feet):
        with open(os.path.join(self.folder, name), "w", encoding="utf-8") as out:
            json.dump({"units": "mm", "nodes": nodes, "edges": edges, "feet": feet}, out)


def plot(path, title, across, up, series, log=False):
    """Lines of (name, colour, [(x, y)]) in one pair of axes from 0, or logarithmic upwards."""
    wide, high, left, top = 130, 70, 24, 14
    xs = [x for _, _, points in series for x, _ in points]
    ys = [y for _, _, points in series for _, y in points]
    low = math.floor(math.log10(min(ys))) if log else 0
    size = 10 ** math.floor(math.log10(max(ys)))
    step_up = next(k * size for k in (0.2, 0.25, 0.5, 1, 2, 2.5) if 5 * k * size >= max(ys))
    most = math.ceil(math.log10(max(ys))) if log else 5 * step_up

    def place(x, y):
        part = ((math.log10(y) if log else y) - low) / (most - low)
        return left + wide * x / (1.1 * max(xs)), top + high * (1 - part)

    out = ['<svg xmlns="http://www.w3.org/2000/svg" width="190mm" height="106mm" viewBox="0 0 190 106">', "<style>text{"
           "font-family:'DejaVu Sans',Verdana,sans-serif;font-size:3.2px}</style>", '<rect width="190" height="106" fill="#fff"/>',
           f'<text x="{left}" y="8" style="font-size:4.4px">{title}</text>',
           f'<path d="M{left} {top}v{high}h{wide}" fill="none" stroke="#222" stroke-width=".35"/>',
           f'<text x="{left + wide / 2}" y="{top + high + 12}" text-anchor="middle">{across}</text>',
           f'<text x="{left}" y="{top - 1.5}">{up}</text>']
    for x in sorted(set(xs)):
        at = place(x, min(ys))[0]
        out.append(f'<text x="{at:.2f}" y="{top + high + 5}" text-anchor="middle">{x:g}</text>')
    for step in range(low, most + 1) if log else range(0, 6):
        y = 10.0 ** step if log else step * step_up
        at = top + high * (1 - (step - low) / (most - low) if log else 1 - step / 5)
        out.append(f'<path d="M{left} {at:.2f}h{wide}" stroke="#ddd" stroke-width=".2"/>'
                   f'<text x="{left - 1.5}" y="{at + 1.1:.2f}" text-anchor="end">{y:.3g}</text>')
    for k, (name, colour, points) in enumerate(series):
        where = [place(x, y) for x, y in points]
        thick = 0.6 * (len(series) - k)  # what is drawn first stays to be seen under what lies on it
        out.append(f'<path d="M{" L".join(f"{x:.2f} {y:.2f}" for x, y in where)}" fill="none" stroke="{colour}" '
                   f'stroke-width="{thick:g}"/>')
        out += [f'<circle cx="{x:.2f}" cy="{y:.2f}" r="{0.6 + thick:g}" fill="{colour}"/>' for x, y in where]
        out.append(f'<text x="{left + wide + 3}" y="{top + 5 + 6 * k}" fill="{colour}">{name}</text>')
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join(out) + "\n</svg>\n")


def picture(report, pictures, name, words):
    report.lines += ["", f"![{words}](pictures/{name})"]


# ---- Fig. 12 ----


def cantilever(program, n, width):
    """Newtons of a straight cord that hold n pieces of a width, in mm, out from a wall."""
    step = LENGTH / (n - 0.5)
    program.frame("row.json", [[i * step, 0, 1000] for i in range(n + 1)], [[i, i + 1] for i in range(n)], [0])
    program.run("plan", "row.json", "--cords", 1, "--ends", "any", "-q", "-o", "row.plan.json")
    density = STRIP / (width * width - math.pi / 4 * 4)  # g/cm3; the bore is 2 mm
    found = program.evaluate("row.plan.json", "--method", "structure", "--no-dynamics", "--clamp-feet", "--bead-diameter", width,
                             "--bore", 2, "--cord-diameter", 1, "--density", f"{density:.17g}")
    return found["holding"]["lower"]


def fig_12(report, program, pictures):
    report.section("The thesis's Fig. 12, by the command line",
                   "A row of pieces of 160 g, 400 mm long, held out from a wall (`--clamp-feet`) by one straight cord. Expected: "
                   "moments about the lower edge at the wall, weight x 200 mm / (width / 2), whatever the number of pieces.")
    weight = STRIP * LENGTH / 1e6 * GRAVITY
    numbers, widths = (3, 5, 10, 20, 40), (10, 14, 20, 28, 40)
    by_number = [(n, cantilever(program, n, 20)) for n in numbers]
    by_width = [(width, cantilever(program, 10, width)) for width in widths]
    for n, force in by_number:
        report.relative(f"{n} pieces 20 mm wide: holding pull, N", weight * LENGTH / 20, force, 1e-5)
    for width, force in by_width:
        report.relative(f"10 pieces {width} mm wide: holding pull, N", weight * LENGTH / width, force, 1e-5)
    plot(os.path.join(pictures, "validation-pieces.svg"), "Cantilever: pull against the number of pieces", "pieces, 20 mm wide",
         "pull, N", [("moments", ORANGE, [(n, weight * LENGTH / 20) for n in numbers]), ("found", BLUE, by_number)])
    plot(os.path.join(pictures, "validation-width.svg"), "Cantilever: pull against width", "width of 10 pieces, mm", "pull, N",
         [("moments", ORANGE, [(width, weight * LENGTH / width) for width in widths]), ("found", BLUE, by_width)])
    picture(report, pictures, "validation-pieces.svg", "Pull against the number of pieces: level")
    picture(report, pictures, "validation-width.svg", "Pull against width: its inverse")


# ---- Fig. 13 ----


def fig_13(report, program, pictures):
    report.section("The thesis's Fig. 13, by the command line",
                   "Loss at one mitred piece (`--law mitre`) as a part of mu F: sin(turn / 2). The capstan law's, 1 - exp(-mu turn), "
                   "is another formula and stands beside it in the plot.")
    found, capstan = [], []
    for angle in (15, 30, 45, 60, 75, 90, 120, 150):
        turn = math.radians(angle)
        program.frame("turn.json", [[-100, 0, 0], [0, 0, 0], [100 * math.cos(turn), 0, 100 * math.sin(turn)]], [[0, 1], [1, 2]],
                      [0])
        program.run("plan", "turn.json", "--cords", 1, "--ends", "any", "-q", "-o", "turn.plan.json")
        asked = ("turn.plan.json", "--mu", 0.2, "--mu-low", 0.2, "--mu-high", 0.2, "--pull", "start")
        loss = [program.evaluate(*asked, "--law", law)["evaluation"]["cords"][0]["loss"] for law in ("mitre", "capstan")]
        report.relative(f"{angle} degrees: loss / mu", math.sin(turn / 2), loss[0] / 0.2, 1e-9)
        report.relative(f"{angle} degrees, --law capstan: loss", 1 - math.exp(-0.2 * turn), loss[1], 1e-9)
        found.append((angle, loss[0] / 0.2))
        capstan.append((angle, loss[1] / 0.2))
    plot(os.path.join(pictures, "validation-mitre.svg"), "One piece: loss / mu against the turn, mu = 0.2", "turn, degrees",
         "loss / mu", [("mitre", BLUE, found), ("capstan", ORANGE, capstan)])
    picture(report, pictures, "validation-mitre.svg", "Loss at one piece against its turn")


# ---- Fig. 22, 25: states of one structure ----


def states(report, program, pictures, data):
    report.section("The thesis's Fig. 22 and 25, as far as statics go",
                   "One string or the other: a 7x7 dome on two cords stands by the long one alone and by the short one not at all. "
                   "And friction keeps what was once pulled in: drawn in, a dome of straight cords needs least and the snake "
                   "most; once the cords are in, it is the other way round. Newtons at all ends, above which an equilibrium "
                   "exists.")
    program.run("plan", os.path.join(data, "dome7.json"), "--cords", 2, "--ends", "feet", "-q", "-o", "two.json")
    asked = ("eval", "two.json", "--method", "structure", "--no-dynamics", "--pull")
    for pull, stands in (("A=none,B=both", True), ("A=both,B=none", False)):
        done = program.run(*asked, pull, codes=(0, 1, 4))
        word = "stands" if done.returncode == 0 else "falls at any pull" if "no pull holds" in done.stderr else done.stderr
        report.holds(f"two cords, --pull {pull}", "stands" if stands else "falls at any pull", word, (word == "stands") == stands)
    names = ("lines", "stairs", "snake")
    found = {}
    for name in names:
        found[name] = program.evaluate(os.path.join(data, f"dome7-{name}.json"), "--method", "structure", "--no-dynamics")
    drawn = [found[name]["equal_pulls"]["upper"] for name in names]
    kept = [found[name]["any_state"]["upper"] for name in names]
    report.holds("while being drawn in", "lines < stairs < snake", ", ".join(f"{x:.4g}" for x in drawn), drawn == sorted(drawn))
    report.holds("in any state that friction keeps", "snake < stairs < lines", ", ".join(f"{x:.4g}" for x in kept),
                 kept == sorted(kept, reverse=True))
    after = program.evaluate(os.path.join(data, "dome7-snake.json"), "--method", "structure", "--no-dynamics", "--schedule",
                             "all: pull both 131")
    report.holds("snake, pulled with 131 N, then let down to", "between any state and drawn in", f"{after['let_down']:.3g} N",
                 kept[2] <= after["let_down"] < drawn[2])
    plot(os.path.join(pictures, "validation-states.svg"), "Three threadings of the 7x7 dome", "1 lines, 2 stairs, 3 snake",
         "force at all ends, N", [("drawn in", BLUE, list(enumerate(drawn, 1))), ("any state", GREEN, list(enumerate(kept, 1)))],
         log=True)
    picture(report, pictures, "validation-states.svg", "Force that holds while drawn in and once in")


# ---- chapter 5 ----


def straightest(report, program, data):
    report.section("The thesis's chapter 5: straight runs turn least",
                   "Cords that go straight on through every piece turn least of all cords: the program's least, which it proves, is "
                   "summed up here from the geometry of straight runs.")
    lines = json.load(open(os.path.join(data, "dome7-lines.json"), encoding="utf-8"))
    nodes = lines["framework"]["nodes"]
    at = dict(zip(lines["framework"].get("names", range(len(nodes))), nodes))

    def turn(a, b, c):
        one, two = [q - p for p, q in zip(a, b)], [q - p for p, q in zip(b, c)]
        dot = sum(x * y for x, y in zip(one, two))
        return math.acos(max(-1.0, min(1.0, dot / math.hypot(*one) / math.hypot(*two))))

    def place(node):
        return at[node] if node in at else nodes[node]

    total = sum(turn(*(place(node) for node in cord["nodes"][k:k + 3])) for cord in lines["cords"]
                for k in range(len(cord["nodes"]) - 2))
    program.run("plan", os.path.join(data, "dome7.json"), "--objective", "tortuosity", "--minimize", "turning", "--cords", 14,
                "--ends", "any", "-q", "-o", "least.json")
    least = json.load(open(os.path.join(program.folder, "least.json"), encoding="utf-8"))
    report.relative("7x7 dome, 14 cords: least turning, degrees", math.degrees(total), math.degrees(least["metrics"]["turning"]),
                    1e-9)
    status = least["proof"]["turning"]["status"]
    report.holds("proved", "optimal", status, status == "optimal")
    rings, around = 7, 12
    program.run("make", "tube", "--size", around, "--rings", rings, "-o", "tube.json")
    program.run("plan", "tube.json", "--objective", "tortuosity", "--minimize", "turning", "--cords", around + rings, "--ends", "any",
                "-q", "-o", "tube.plan.json")
    tube = json.load(open(os.path.join(program.folder, "tube.plan.json"), encoding="utf-8"))
    report.relative(f"tube {around} x {rings}, {around + rings} cords: straight lines and open rings, degrees",
                    rings * (around - 1) * 360 / around, math.degrees(tube["metrics"]["turning"]), 1e-9)


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    program_path, report_path, pictures = sys.argv[1:]
    data = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "data")
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        program = Program(program_path, folder)
        fig_12(report, program, pictures)
        fig_13(report, program, pictures)
        states(report, program, pictures, data)
        straightest(report, program, data)
    report.lines += ["", f"{report.rows} values by the command line, {report.outside} outside their bound.", ""]
    with open(report_path, "a", encoding="utf-8") as out:
        out.write("\n".join(report.lines))
    print(f"{report.rows} values by the command line, {report.outside} outside their bound")
    sys.exit(1 if report.outside else 0)


if __name__ == "__main__":
    main()
