"""Fig. 19 and 21: bent beads that hang on a cord and are shaken: each turns over from the last, since the row is longest so, and hangs lowest.

The two ends are straight pieces, which are as good turned by any angle: the passes between the others count.
"""
import concurrent.futures
import json
import math
import os
import random

from experiments import last_frame, median_range, run, svg_file

SIZE, PITCH, RISE, WIDTH, SEEDS = 7, 20, 0.3, 10, 10
APART, ASIDE = 1.4, 0.15  # pitches: from node to node as laid, and by how much each is off the line by chance
OVER, TIGHT = 1.06, 4  # the pull at the top, in weights of what hangs there
SHAKE, REST, SHAKING = "3@15", "0.001@15", 3  # mm and times a second; hardly at all; s
NEAR = 20  # degrees


def multiply(a, b):
    """Of quaternions x y z w: first b, then a."""
    (ax, ay, az, aw), (bx, by, bz, bw) = a, b
    return (aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx, aw * bz + ax * by - ay * bx + az * bw,
            aw * bw - ax * bx - ay * by - az * bz)


def twists(frame, nodes):
    """Degrees by which each piece of a row is turned about the edge from the one before it, against the drawn row."""
    found = []
    for i, (p, q) in enumerate(zip(nodes, nodes[1:])):
        (x, y, z, w), other = frame[7 * i + 3:7 * i + 7], frame[7 * i + 10:7 * i + 14]
        off = multiply((-x, -y, -z, w), other)
        about = sum(a * (v - u) for a, u, v in zip(off, p, q)) / math.dist(p, q)
        found.append(math.degrees(2 * math.atan2(about if off[3] >= 0 else -about, abs(off[3]))))
    return found


def lay(name, rng):
    """A row that hangs down with its faces apart, its bends turned by chance: nodes a little off a plumb line."""
    nodes = []
    for i in range(SIZE):
        angle = 2 * math.pi * rng.random()
        nodes.append([ASIDE * PITCH * math.cos(angle), ASIDE * PITCH * math.sin(angle), (SIZE - 1 - i) * APART * PITCH])
    with open(name, "w", encoding="utf-8") as file:
        json.dump({"units": "mm", "nodes": nodes, "edges": [[i, i + 1] for i in range(SIZE - 1)]}, file)


def turned(row, angles):
    """Degrees from each bend to the next, 0 .. 180, of the inner passes. row: what is drawn."""
    return [abs((row + angle + 180) % 360 - 180) for angle in angles[1:-1]]


def histogram(sets):
    """Bars of sets of angles, a bin NEAR degrees; what chance gives as a line."""
    wide, high, left, top, bins = 150, 60, 20, 16, 180 // NEAR
    out = ['<text x="20" y="6" style="font-size:4.4px">From each bend to the next</text>']
    for k, (what, colour, angles) in enumerate(sets):
        out.append(f'<text x="{left + 48 * k}" y="12" fill="{colour}">{what}</text>')
        for i in range(bins):
            tall = high * sum(min(int(angle / NEAR), bins - 1) == i for angle in angles) / len(angles)
            out.append(f'<rect x="{left + wide / bins * (i + 0.06 + 0.29 * k):.2f}" y="{top + high - tall:.2f}" width="{wide / bins * 0.28:.2f}" '
                       f'height="{tall:.2f}" fill="{colour}"/>')
    chance = top + high * (1 - 1 / bins)
    out += [f'<path d="M{left} {chance:.2f}h{wide}" stroke="#222" stroke-width=".35" stroke-dasharray="2 1"/>',
            f'<text x="{left + 2}" y="{chance - 1.5:.2f}">chance</text>',
            f'<path d="M{left} {top}v{high}h{wide}" fill="none" stroke="#222" stroke-width=".35"/>',
            f'<text x="{left + wide / 2}" y="{top + high + 11}" text-anchor="middle">degrees</text>']
    out += [f'<text x="{left + wide / bins * i:.2f}" y="{top + high + 5}" text-anchor="middle">{NEAR * i}</text>' for i in range(bins + 1)]
    out += [f'<text x="{left - 1.5}" y="{top + high * (1 - part / 100) + 1.1:.2f}" text-anchor="end">{part} %</text>' for part in (0, 50, 100)]
    return out


def section(program, folder):
    commands, nodes = [], {}
    for row in (180, 90):
        commands += [f"thread make alternating --size {SIZE} --pitch {PITCH} --rise {RISE}{' --twist 90' if row == 90 else ''} -o row{row}.json",
                     f"thread plan row{row}.json --ends any -q -o row{row}.plan.json"]
    for command in commands:
        run(program, command)
    for row in (180, 90):
        with open(f"row{row}.json", encoding="utf-8") as file:
            nodes[row] = json.load(file)["nodes"]
    rng = random.Random(19)
    for i in range(SEEDS):
        lay(f"chance-{i + 1}.json", rng)

    # The lowest piece is tied to the cord, the highest is in the hand that holds the cord.
    rise = (f"thread rise row%d.plan.json --lay chance-%d.json --held A1 --ends start --width {WIDTH} --pull %.3g --shake %s "
            f"--shaking {SHAKING} --tune time-step=2")
    hanging = json.loads(run(program, rise.split(" --lay")[0] % 180 + f" --held A1 --width {WIDTH} --start shape --pull 0.01 --json -q"))["weight"]

    def hang(case):
        row, over, shake, i = case
        run(program, rise % (row, i + 1, over * hanging, shake) + f" -q -o seen-{row}-{over}-{shake}-{i}.json")
        with open(f"seen-{row}-{over}-{shake}-{i}.json", encoding="utf-8") as file:
            one = json.load(file)["runs"][0]
        return turned(row, twists(one["frames"][0], nodes[row])), turned(row, one["twist"]), max(one["kink"])

    seen = {}
    sets = [(180, OVER, REST), (180, OVER, SHAKE), (180, TIGHT, SHAKE), (90, OVER, SHAKE)]
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        for key in sets:
            laid, last, kink = zip(*pool.map(hang, [(*key, i) for i in range(SEEDS)]))
            seen[key] = {"laid": sum(laid, []), "last": sum(last, []), "kink": kink}
    still = rise % (180, 1, OVER * hanging, SHAKE)
    commands += [rise % (row, 1, over * hanging, shake) for row, over, shake in sets]
    last_frame(program, still, os.path.join(folder, "fig-21-shaken.png"), os.path.join(folder, "fig-21-laid.png"))

    rows, near = [], {}
    for what, key, when in (("as laid", sets[1], "laid"), ("drawn in, not shaken", sets[0], "last"), ("drawn in and shaken", sets[1], "last"),
                            (f"the same, pulled with {TIGHT} times the weight", sets[2], "last"),
                            ("the row drawn with 90°, drawn in and shaken", sets[3], "last")):
        angles = seen[key][when]
        near[key, when] = 100 * sum(angle > 180 - NEAR for angle in angles) / len(angles)
        square = 100 * sum(abs(angle - 90) < NEAR / 2 for angle in angles) / len(angles)
        rows.append(f"| {what} | {near[key, when]:.0f} % | {square:.0f} % | {median_range(angles)} | "
                    f"{median_range(seen[key]['kink']) if when == 'last' else '-'} |")
    chance, idle, shaken, tight = 100 * NEAR / 180, near[sets[0], "last"], near[sets[1], "last"], near[sets[2], "last"]
    assert shaken > 4 * chance, "shaken, the row does not alternate"
    assert shaken > tight, "where friction holds more, it alternates no less"
    svg_file(os.path.join(folder, "fig-21-turns.svg"), 190, 92,
             histogram([("as laid", "#999999", seen[sets[1]]["laid"]), ("not shaken", "#D55E00", seen[sets[0]]["last"]),
                        ("shaken", "#0072B2", seen[sets[1]]["last"])]))
    return "\n".join([
        "## Fig. 19 and 21: beads that alternate", "",
        f"{SIZE} pieces, all but the ends bent by {2 * math.degrees(math.atan(RISE)):.0f}°: cylinders with mitred ends. The highest is held, the others, "
        f"{hanging:.3g} N, hang on a cord that is tied to the lowest one and pulled at the top with {OVER:g} times their weight, so that hardly more "
        f"than their weight presses faces together. They begin apart, turned by chance ({SEEDS} times, `chance-1.json` and so on: nodes "
        f"{APART * PITCH:g} mm apart on a plumb line, each {ASIDE * PITCH:g} mm off it by chance). The hand goes to and fro by {SHAKE.split('@')[0]} mm, "
        f"{SHAKE.split('@')[1]} times a second, each time in a direction by chance, for {SHAKING} s; or by a thousandth of a mm, which is not to shake, for as long.", "",
        "```", *(f"$ {command}" for command in commands), "```", "",
        f"Told is the angle about the cord from each bend to the next; 180° is a zigzag. Within {NEAR}° of it chance puts {chance:.0f} %, as within "
        f"{NEAR / 2:g}° of 90°; as laid there is more of it, since a node that is off the line bends the row both ways. Pulled so little, "
        "faces are not all closed in the end.", "",
        f"| | within {NEAR}° of 180° | within {NEAR / 2:g}° of 90° | degrees from bend to bend | largest kink of a run, degrees |", "|---|---|---|---|---|", *rows, "",
        "Why: closed faces turn on each other about the cord at no cost of cord. What hangs is lowest where the row is longest, and that is the zigzag. "
        f"Friction of the faces, which the pull presses together, holds against that: more so at {TIGHT} times the weight. " +
        ("Shaking lifts faces off each other for a moment, and more of them get there. " if shaken > idle + 5 else
         "Shaking is not what does it here: while the row is drawn in, its faces are open, and turn. ") +
        "Bent pieces know of no other angle: those of the row that is drawn with 90° are the same ones, and go to 180° as well. The thesis's 90° beads had mitres that were "
        "turned to each other in every bead; a piece of two arms has none.", "",
        "![as laid, by chance](pictures/experiments/fig-21-laid.png)", "", "![drawn in and shaken](pictures/experiments/fig-21-shaken.png)", "",
        "![histogram of the angles](pictures/experiments/fig-21-turns.svg)"])
