#!/usr/bin/env bash
# Whole processes on large frameworks, from file to file: user CPU seconds and peak memory of `thread plan` (read, plan, check, write) and
# `thread check` on domes, best of three. growth: CPU seconds per edge over those of the size before. / json: CPU seconds over what
# Python's json module (in C) takes to read the same files and, for a plan, to write plan.json: a floor for moving the text alone.
# SIZES are the sides of the domes (edges: 2 x side x side). THREAD names the program.
set -eu
cd "$(dirname "$0")/.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
exec python3 - "${THREAD:-build/release/thread}" "$work" "${SIZES:-71 224 707}" <<'PYTHON'
import os, sys
thread, work, sizes = sys.argv[1], sys.argv[2], sys.argv[3].split()

def run(*command):
    """Least user CPU seconds of three runs, and peak megabytes, with what the command's own children take."""
    best, peak = float("inf"), 0
    for _ in range(3):
        pid = os.fork()
        if pid == 0:
            os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
            os.execvp(command[0], command)
        _, status, used = os.wait4(pid, 0)
        if status:
            sys.exit("failed: " + " ".join(command))
        best, peak = min(best, used.ru_utime), max(peak, used.ru_maxrss / 1024)
    return best, peak

def floor(reads, writes=None):
    code = "import json\n" + "".join(f"d = json.load(open({name!r}))\n" for name in reads)
    return run(sys.executable, "-c", code + (f"open({writes!r}, 'w').write(json.dumps(d))" if writes else ""))[0]

print(f"{'edges':>8} {'plan (s)':>9} {'MB':>6} {'growth':>7} {'/ json':>7} {'check (s)':>10} {'MB':>6} {'growth':>7} {'/ json':>7}")
before = None
for side in sizes:
    frame, plan, edges = work + "/frame.json", work + "/plan.json", 2 * int(side) * (int(side) - 1)
    run(thread, "make", "dome", "--size", side, "-q", "-o", frame)
    made, checked = run(thread, "plan", frame, "-q", "-o", plan), run(thread, "check", "-q", plan)
    rows = [(made, floor([frame, plan], work + "/copy.json")), (checked, floor([plan]))]
    now = [cpu / edges for (cpu, _), _ in rows]
    growth = [f"{a / b:7.2f}" if before and b > 0 else f"{'-':>7}" for a, b in zip(now, before or now)]
    print(f"{edges:8}", *(f"{cpu:{width}.2f} {peak:6.0f} {grown} {cpu / least:7.2f}"
                          for ((cpu, peak), least), grown, width in zip(rows, growth, (9, 10))), flush=True)
    before = now
PYTHON
