"""Fig. 22: one row of boxes, two cords: drawn in by the one it is a rod, by the other a right angle."""
import json
import os

from experiments import last_frame, median_range, run

SIZE, PITCH, WIDTH, PULL, SEEDS = 7, 20, 16, 5, 10


def section(program, folder):
    # Round the corner the side of the middle box is the seat of the next one's face.
    corner, half = SIZE // 2, (PITCH + WIDTH) / 2
    nodes = [[(i - corner) * PITCH, 0, 0] for i in range(corner + 1)] + [[0, half + i * PITCH, 0] for i in range(SIZE - corner - 1)]
    with open("corner.json", "w", encoding="utf-8") as file:
        json.dump({"units": "mm", "nodes": nodes, "edges": [[i, i + 1] for i in range(SIZE - 1)]}, file)
    pieces = f"--channels lanes --width {WIDTH} --profile square --pull {PULL}"
    commands = [f"thread make row --size {SIZE} -o row.json", "thread plan row.json --cords 2 --distinct 2 --ends any -q -o row.plan.json",
                f"thread rise row.plan.json --slack B {pieces}",
                f"thread rise row.plan.json --slack A --shape B=corner.json {pieces}"]
    for command in commands[:2]:
        run(program, command)
    rows = []
    for name, what, command in (("A", "rod", commands[2]), ("B", "right angle", commands[3])):
        runs = json.loads(run(program, f"{command} --seeds {SEEDS} --json -q"))["runs"]
        up = [one for one in runs if one["came_up"]]
        assert 10 * len(up) >= 8 * SEEDS, f"cord {name} makes a {what} in {len(up)} of {SEEDS} runs only"
        off = max(one["off"] for one in up)
        assert off < 1, f"the {what} is {off:.2g} mm out of shape"
        rows.append(f"| {name} | {what} | {len(up)} of {SEEDS} | {median_range([one['pull_up'] for one in up])} | "
                    f"{median_range([one['off'] for one in up])} |")
        last_frame(program, command, os.path.join(folder, f"fig-22-{what.replace(' ', '-')}.png"))
    return "\n".join([
        "## Fig. 22: one row, two outcomes", "",
        f"{SIZE} boxes with two cords beside each other. Cord A goes straight through all. Cord B leaves the middle box by its side, on which the next "
        "box is seated: a shape of its own, `corner.json`, with the same nodes round a corner. From flat on the ground, in a line, one of the cords is "
        "drawn in, the other hangs slack. Nodes of `corner.json`, mm: "
        f"{', '.join(f'({x:g}, {y:g})' for x, y, _ in nodes)}.", "", "```", *(f"$ {command}" for command in commands), "```", "",
        "| cord | makes | runs | comes up at, N | differs from that shape by, mm |", "|---|---|---|---|---|", *rows, "",
        "![the row as a rod](pictures/experiments/fig-22-rod.png)", "", "![the row round a corner](pictures/experiments/fig-22-right-angle.png)"])
