#!/usr/bin/env python3
"""Runs the command of every row of `thread advise`, and says which plans are not what their rows say.

tests/golden/each_row.py FRAME [OPTION ..]; run in a scratch folder, with thread on the path.
"""
import json
import subprocess
import sys


def run(*command):
    return json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


def near(a, b):
    return abs(a - b) <= 1e-9 * abs(b)


said = " ".join(sys.argv[1:])
rows = run("thread", "advise", *sys.argv[1:], "--json")["rows"]
differ = 0
for row in rows:
    subprocess.run(row["command"] + " -q -o row.json", shell=True, check=True)
    subprocess.run(["thread", "check", "-q", "row.json"], check=True)
    pulled = run("thread", "eval", "row.json", "--json")["evaluation"]["largest"]
    with open("row.json", encoding="utf-8") as file:
        plan = json.load(file)
    measured = plan["metrics"]
    fits = (len(plan["cords"]) == row.get("cords_in_all", row["cords"]) and plan["options"]["ends"] == row["ends"]
            and near(measured["length"], row["length"]) and near(measured["max_turning"], row["max_turning"]) and near(pulled, row["pull"]))
    if not fits:
        differ += 1
        print(f"{said}: {row['command']} makes {len(plan['cords'])} cords, {measured['length']}, turning {measured['max_turning']}, {pulled} N")
print(f"{'every row' if rows and not differ else 'NOT every row'} is the plan of its command")
