"""Fig. 23: an arch of straight boxes, drawn in many times: where it kinks, and by how much.

Boxes whose faces are parallel fit a straight line, not an arch. Between two ends that are held nearer than the row is long, joints stay open.
A joint that is open by the angle a over its edge lengthens the cord, in the middle of faces of width w, by w sin(a / 2).
"""
import json
import math
import os
import random
import statistics

from experiments import last_frame, median_range, run, svg_file

PIECES, PITCH, LAID, WIDTH, RISE, SHAPES, SEEDS, PULL = 9, 20, 21, 12, 0.6, 8, 5, 5
KINK = 10  # degrees: a joint that is open


def linkage(nodes, rng):
    """A chance arch: the same first and last edge as `nodes`, and between them directions by chance which fall from edge to edge and
    close it (Newton's method with the least change)."""
    a, b = nodes[0], nodes[-1]
    first = math.atan2(nodes[1][2] - a[2], nodes[1][0] - a[0])
    length = math.dist(nodes[0], nodes[1])
    while True:
        way = [first] + sorted((first * (1 - 2 * rng.random()) for _ in range(len(nodes) - 3)), reverse=True) + [-first]
        for _ in range(50):
            x = sum(length * math.cos(t) for t in way) - (b[0] - a[0])
            z = sum(length * math.sin(t) for t in way) - (b[2] - a[2])
            rows = [(-length * math.sin(t), length * math.cos(t)) for t in way[1:-1]]
            xx, xz, zz = (sum(p[i] * p[j] for p in rows) for i, j in ((0, 0), (0, 1), (1, 1)))
            det = xx * zz - xz * xz
            if abs(det) < 1e-9:
                break
            u, v = (zz * x - xz * z) / det, (xx * z - xz * x) / det
            way[1:-1] = [t - u * p[0] - v * p[1] for t, p in zip(way[1:-1], rows)]
        if abs(x) + abs(z) < 1e-6 and all(p > q for p, q in zip(way, way[1:])):
            break
    points = [a]
    for t in way:
        points.append([points[-1][0] + length * math.cos(t), 0, points[-1][2] + length * math.sin(t)])
    return points


def kinks_of(points):
    """Degrees at the joints of boxes that lie along the points: the outer ones along their only edge, the others along the mean."""
    way = [math.atan2(q[2] - p[2], q[0] - p[0]) for p, q in zip(points, points[1:])]
    box = [way[0]] + [(p + q) / 2 for p, q in zip(way, way[1:])] + [way[-1]]
    return [math.degrees(abs(p - q)) for p, q in zip(box, box[1:])]


def excess(kinks):
    """mm of cord beyond that of the closed row."""
    return sum(WIDTH * math.sin(math.radians(k) / 2) for k in kinks)


def squares(kinks):
    return sum(k * k for k in kinks)


def histogram(found, chance):
    """Bars of both sets of kinks, a tenth of a right angle each."""
    wide, high, left, top, bins = 150, 66, 20, 14, 10
    step = 90 / bins

    def share(kinks):
        return [sum(min(int(k / step), bins - 1) == i for k in kinks) / len(kinks) for i in range(bins)]

    out = [f'<text x="{left}" y="8" style="font-size:4.4px">Kinks of an arch: drawn in (blue), and of arches by chance (orange)</text>']
    for shares, colour, shift in ((share(found), "#0072B2", 0), (share(chance), "#D55E00", 0.45)):
        for i, part in enumerate(shares):
            tall = high * part
            out.append(f'<rect x="{left + wide / bins * (i + 0.05 + shift):.2f}" y="{top + high - tall:.2f}" width="{wide / bins * 0.43:.2f}" '
                       f'height="{tall:.2f}" fill="{colour}"/>')
    for i in range(bins + 1):
        out.append(f'<text x="{left + wide / bins * i:.2f}" y="{top + high + 5}" text-anchor="middle">{i * step:g}</text>')
    for part in (0, 25, 50, 75, 100):
        out.append(f'<text x="{left - 1.5}" y="{top + high * (1 - part / 100) + 1.1:.2f}" text-anchor="end">{part} %</text>')
    out.append(f'<path d="M{left} {top}v{high}h{wide}" fill="none" stroke="#222" stroke-width=".35"/>'
               f'<text x="{left + wide / 2}" y="{top + high + 11}" text-anchor="middle">kink of a joint, degrees</text>')
    return out


def section(program, folder):
    commands = [f"thread make row --size {PIECES} -o row.json", "thread plan row.json --ends any -q -o row.plan.json",
                f"thread make arch --size {PIECES} --rise {RISE} --pitch {LAID} -o arch.json"]
    for command in commands:
        run(program, command)
    with open("arch.json", encoding="utf-8") as file:
        arch = json.load(file)
    rng, runs, laid = random.Random(23), [], []
    rise = (f"thread rise row.plan.json --lay chance-%d.json --held A1,{chr(64 + PIECES)}1 --width {WIDTH} --profile square --pull {PULL} "
            f"--seeds {SEEDS} --json -q")
    for i in range(SHAPES):
        points = linkage(arch["nodes"], rng)
        laid.append(kinks_of(points))
        with open(f"chance-{i + 1}.json", "w", encoding="utf-8") as file:
            json.dump({"units": "mm", "nodes": points, "edges": arch["edges"]}, file)
        runs += json.loads(run(program, rise % (i + 1)))["runs"]
    still = (rise % 1).replace(f" --seeds {SEEDS} --json -q", "")
    last_frame(program, still, os.path.join(folder, "fig-23-arch.png"))

    # What chance gives: as many arches that close between the same ends.
    chance = [kinks_of(linkage(arch["nodes"], rng)) for _ in range(400)]
    found = [one["kink"] for one in runs]
    open_joints = [sum(k > KINK for k in kinks) for kinks in found]
    chance_open = [sum(k > KINK for k in kinks) for kinks in chance]
    svg_file(os.path.join(folder, "fig-23-kinks.svg"), 190, 96, histogram([k for f in found for k in f], [k for c in chance for k in c]))

    # States: which joints are open, how often, and what cord each takes.
    states = {}
    for kinks in found:
        states.setdefault(tuple(i + 1 for i, k in enumerate(kinks) if k > KINK), []).append(kinks)
    order = sorted(states, key=lambda state: (-len(states[state]), state))
    often = [k for state in order if len(states[state]) > 1 for k in states[state]]
    seldom = [states[state][0] for state in order if len(states[state]) == 1]
    spread = max(statistics.pstdev(column) for column in zip(*states[order[0]]))
    above = sum(squares(k) > statistics.median(map(squares, chance)) for k in found)

    assert statistics.median(open_joints) < statistics.median(chance_open), "drawn in, an arch has no fewer kinks than by chance"
    assert statistics.median(map(squares, found)) > statistics.median(map(squares, chance)), "the sum of squares is no larger than by chance"
    assert spread < 15, "the same joints open by other angles"

    rows = [f"| open joints (more than {KINK}°) | {median_range(open_joints)} | {median_range(chance_open)} |",
            f"| sum of all kinks, degrees | {median_range(map(sum, found))} | {median_range(map(sum, chance))} |",
            f"| sum of their squares, thousands | {median_range([squares(k) / 1000 for k in found])} | "
            f"{median_range([squares(k) / 1000 for k in chance])} |",
            f"| cord beyond the closed row, mm | {median_range(map(excess, found))} | {median_range(map(excess, chance))} |"]
    table = [f"| {', '.join(map(str, state))} | {len(states[state])} | "
             f"{', '.join(f'{statistics.median(column):.0f}' for column in zip(*states[state]))} | "
             f"{statistics.median(map(excess, states[state])):.1f} |" for state in order]
    beside = (f" States that were seen more than once take {statistics.median(map(excess, often)):.1f} mm of cord in the middle, those seen once "
              f"{statistics.median(map(excess, seldom)):.1f} mm." if often and seldom else "")
    return "\n".join([
        "## Fig. 23: an arch that kinks", "",
        f"{PIECES} straight boxes of {PITCH} mm, {WIDTH} mm wide, between two that are held, nearer to each other than the row is long. They are laid as "
        f"arches by chance ({SHAPES}, `chance-1.json` and so on, each {SEEDS} times, turned a little by chance), and the cord is drawn in with up to {PULL} N.", "", "```",
        *(f"$ {command}" for command in commands), f"$ {rise % 1}", "```", "",
        f"The thesis: rather than a smooth arc, it forms a limited number of kinks; the sum of squares of the angles is largest. {len(found)} runs "
        "beside 400 arches by chance with the same ends (median, and range):", "", "| | drawn in | by chance |", "|---|---|---|", *rows, "",
        f"In {above} of {len(found)} runs the sum of squares is larger than the median by chance. Why: an open joint takes w sin(a / 2) of cord, which "
        "grows less than in proportion. Two ends in the plane fix three things, so that few large kinks take less cord than many small ones. "
        f"In the state seen most often each angle is within {spread:.1f}° (standard deviation) from run to run.{beside}", "",
        "| open joints | runs | median kinks from one end to the other, degrees | cord beyond the row, mm |", "|---|---|---|---|", *table, "",
        "![an arch of boxes with kinks](pictures/experiments/fig-23-arch.png)", "",
        "![histogram of the kinks](pictures/experiments/fig-23-kinks.svg)"])
