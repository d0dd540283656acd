"""Fig. 24: the first dome, 7 x 7 pieces, its cords pulled at four feet: flat on the ground, and from a heap."""
import json
import os
import statistics

from experiments import last_frame, median_range, run, svg_file

PULL, SEEDS = 10, 3


def section(program, folder):
    commands = ["thread make dome --size 7 -o dome.json", "thread plan dome.json --cords 4 --ends feet --objective tortuosity -q -o dome.plan.json"]
    for command in commands:
        run(program, command)
    rows, lines = [], []
    for start, colour, height in (("flat", "#0072B2", 20), ("heap", "#D55E00", 26)):
        command = f"thread rise dome.plan.json --start {start} --pull {PULL} --seeds {SEEDS}"
        commands.append(command)
        seen = json.loads(run(program, command + " --json -q"))
        runs, faces = seen["runs"], seen["faces"]
        up = [one["pull_up"] for one in runs if one["came_up"]]
        closed = [100 * one["most_closed"] / faces for one in runs]
        rows.append(f"| {start} | {len(up)} of {SEEDS} | {median_range(up) if up else '-'} | {median_range(closed)} | "
                    f"{median_range([one['off'] for one in runs])} |")
        for one in runs:
            way = " L".join(f"{24 + 120 * min(moment[1], PULL) / PULL:.2f} {80 - 66 * moment[3] / faces:.2f}" for moment in one["moments"])
            lines.append(f'<path d="M{way}" fill="none" stroke="{colour}" stroke-width=".6"/>')
        lines.append(f'<text x="148" y="{height}" fill="{colour}">{start}</text>')
        last_frame(program, command.replace(f" --seeds {SEEDS}", ""), os.path.join(folder, f"fig-24-{start}.png"))

        # Some of the faces always close; what else is seen stands in the table as it is.
        assert statistics.median(closed) > (50 if start == "flat" else 10), f"from {start} hardly a face closes"
    lines += ['<path d="M24 14v66h120" fill="none" stroke="#222" stroke-width=".35"/>',
              '<text x="24" y="8" style="font-size:4.4px">Closed faces against the pull at every end</text>',
              '<text x="84" y="92" text-anchor="middle">pull, N</text>']
    for part in (0, 0.5, 1):
        lines += [f'<text x="{24 + 120 * part}" y="85" text-anchor="middle">{PULL * part:g}</text>',
                  f'<text x="22" y="{81 - 66 * part}" text-anchor="end">{100 * part:g} %</text>']
    svg_file(os.path.join(folder, "fig-24-faces.svg"), 170, 96, lines)
    return "\n".join([
        "## Fig. 24: the dome of 7 x 7 pieces", "",
        f"The thesis's first dome came up by itself when the cords at its four feet were pulled. Here every end is pulled with up to {PULL} N, from flat on "
        "the ground, and dropped in a heap.", "", "```", *(f"$ {command}" for command in commands), "```", "",
        "| from | comes up | at, N | faces closed at once, % | differs from the shape by, mm |", "|---|---|---|---|---|", *rows, "",
        "![the dome, from flat](pictures/experiments/fig-24-flat.png)", "", "![the dome, from a heap](pictures/experiments/fig-24-heap.png)", "",
        "![closed faces against the pull](pictures/experiments/fig-24-faces.svg)"])
