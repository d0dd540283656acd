"""The frameworks of the bench: shapes of `thread make`, these with every node moved, planar ones at random, and those of data/."""
import glob
import json
import math
import os
import random

HERE = os.path.dirname(os.path.abspath(__file__))

# What `thread make` is asked for to get about so many edges.
SHAPES = {
    "grid": lambda m: ("dome", round(math.sqrt(m / 2) + 0.5)),
    "sphere": lambda m: ("sphere", round(math.sqrt(m / 30))),
    "geodesic": lambda m: ("geodesic", round(math.sqrt(m / 15 + 0.1) - 0.33)),
    "tube": lambda m: ("tube", round(math.sqrt(m / 2)), "--rings", round(math.sqrt(m / 2))),
    "honeycomb": lambda m: ("honeycomb", round(math.sqrt(m / 9) + 0.17)),
}


def write_frame(path, nodes, edges):
    with open(path, "w", encoding="utf-8") as f:
        json.dump({"format": "thread-frame", "version": 1, "units": "mm", "nodes": nodes, "edges": edges}, f)


def shake(path):
    """Every node moved a little: lengths that have no common measure."""
    with open(path, encoding="utf-8") as f:
        frame = json.load(f)
    write_frame(path, [[x + random.uniform(-5, 5) for x in node] for node in frame["nodes"]], frame["edges"])


def write_planar(path, edges):
    """Points at random in the cells of a grid, joined along it and across some of its cells, some edges left out."""
    side = max(3, round(math.sqrt(edges / 2.3)))
    nodes = [[20 * (v % side + random.random()), 20 * (v // side + random.random()), 0] for v in range(side * side)]
    pairs = []
    for v in range(side * side):
        right, up = v % side < side - 1, v // side < side - 1
        pairs += [(v, v + 1)] if right else []
        pairs += [(v, v + side)] if up and (v % side == 0 or random.random() < 0.65) else []
        if right and up and random.random() < 0.65:
            pairs.append(random.choice([(v, v + side + 1), (v + 1, v + side)]))
    write_frame(path, nodes, pairs)


def real_frameworks():
    every = os.path.join(os.path.dirname(HERE), "data/*/*")
    return [p for kind in (".json", ".obj", "-nodes.csv") for p in sorted(glob.glob(every + kind))]


def data(*names):
    return [p for p in real_frameworks() if os.path.basename(p).split(".")[0] in names]
