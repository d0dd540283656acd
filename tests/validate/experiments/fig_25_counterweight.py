"""Fig. 25: a dome with two cords through each bead: by itself, carried at its apex by a hand, and with a counterweight."""
import json
import os
import statistics

from experiments import last_frame, median_range, run

SIZE, PULL, SEEDS = 3, 10, 3
APEX = "B2"


def section(program, folder):
    commands = [f"thread make dome --size {SIZE} -o dome.json",
                "thread plan dome.json --distinct 2 --ends feet --objective tortuosity -q -o dome.plan.json"]
    for command in commands:
        run(program, command)
    rows, closed = [], {}
    weight = None
    for what, share in (("by itself", 0), ("a hand carries the apex", -1), ("counterweight", 0.1)):
        command = f"thread rise dome.plan.json --pull {PULL} --seeds {SEEDS}"
        if share < 0:
            command += f" --raise {APEX}"
        elif share > 0:
            command += f" --lift {APEX}={share * weight:.2g}"
            what = f"counterweight of {100 * share:g} % of the weight at the apex"
        commands.append(command)
        seen = json.loads(run(program, command + " --json -q"))
        weight = seen["weight"]
        runs = seen["runs"]
        up = [one["pull_up"] for one in runs if one["came_up"]]
        closed[share] = statistics.median(one["most_closed"] for one in runs) / seen["faces"]
        rows.append(f"| {what} | {len(up)} of {SEEDS} | {median_range(up) if up else '-'} | "
                    f"{median_range([one['most_closed'] for one in runs])} of {seen['faces']} | {median_range([one['off'] for one in runs])} |")
        if share <= 0:
            last_frame(program, command.replace(f" --seeds {SEEDS}", ""), os.path.join(folder, f"fig-25-{'raised' if share else 'alone'}.png"))
    assert closed[-1] >= 0.75, "carried at its apex, it leaves more than a quarter of the faces open"
    return "\n".join([
        "## Fig. 25: two cords through each bead, and a counterweight", "",
        "The thesis's larger dome had two cords through each bead, more friction therefore, and its apex was lifted while tension came back. A dome of "
        f"{SIZE} x {SIZE} pieces, {weight:.2g} N, two passes of different cords through every interface, from flat on the ground; every end is pulled with up to {PULL} N. "
        "The counterweight is less than the weight of the piece, which would leave the ground alone otherwise: slack cord has no end in the simulation.",
        "", "```", *(f"$ {command}" for command in commands), "```", "",
        "| help | comes up | at, N | faces closed at once | differs from the shape by, mm |", "|---|---|---|---|---|", *rows, "",
        "![the dome by itself](pictures/experiments/fig-25-alone.png)", "", "![its apex carried by a hand](pictures/experiments/fig-25-raised.png)"])
