# SPDX-License-Identifier: MIT
"""Cords through a COMPAS network, graph or mesh, by the program thread.

    from compas.datastructures import Mesh
    from compas_thread import thread
    cords, summary = thread(Mesh.from_obj("shell.obj"), cords=4, ends="feet", feet="lowest")
    lines = [[mesh.vertex_coordinates(key) for key in cord] for cord in cords]

Keyword arguments are options of `thread plan`: max_length=900 is --max-length 900, balance=True is --balance.
"""
import json
import os
import subprocess
import tempfile


def _parts(structure):
    """Keys, coordinates and edges of a Network, Graph (nodes) or Mesh (vertices)."""
    if hasattr(structure, "vertices"):
        keys = list(structure.vertices())
        return keys, [structure.vertex_coordinates(key) for key in keys], list(structure.edges())
    keys = list(structure.nodes())
    xyz = [[structure.node_attribute(key, axis) or 0.0 for axis in "xyz"] for key in keys]
    return keys, xyz, list(structure.edges())


def thread(structure, program="thread", **options):
    """(keys along each cord, summary). RuntimeError: there is no plan; its text says why."""
    keys, xyz, edges = _parts(structure)
    index = {key: i for i, key in enumerate(keys)}
    frame = {"format": "thread-frame", "version": 1, "nodes": xyz, "edges": [[index[u], index[v]] for u, v in edges]}
    words = [program, "plan", "-", "--json"]
    for name, value in options.items():
        if value is not False and value is not None:
            words.append("--" + name.replace("_", "-") + ("" if value is True else "=" + str(value)))
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "plan.json")
        run = subprocess.run(words + ["-o", path], input=json.dumps(frame), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        if not os.path.exists(path):  # exit code 5 with a plan: not all is proved
            raise RuntimeError(run.stderr.strip())
        with open(path) as file:
            plan = json.load(file)
    # Nodes are called by their number in the list that thread was given; some may have been merged or dropped.
    names = plan["framework"].get("names") or range(len(plan["framework"]["nodes"]))
    return [[keys[int(names[v])] for v in cord["nodes"]] for cord in plan["cords"]], json.loads(run.stdout)
