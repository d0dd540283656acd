# SPDX-License-Identifier: MIT
"""Cords through a COMPAS network, graph or mesh, by the package thread_plan.

    from compas.datastructures import Mesh
    from compas_thread import thread
    mesh = Mesh.from_obj("shell.obj")
    cords, plan = thread(mesh, units="m", cords=4, ends="feet")
    lines = [[mesh.vertex_coordinates(key) for key in cord] for cord in cords]
    plan.draw("pdf", "sheets.pdf")

Keyword arguments are those of Frame.plan: aims="turning", max_length=0.9 (in units), seconds=5, progress=print, .. Without any the plan
is the recommended one. ends="feet" are the lowest nodes, or those that feet= lists by their keys.
"""
import json

import thread_plan


def _parts(structure):
    """Keys, coordinates and edges of a Network, Graph (nodes) or Mesh (vertices)."""
    if hasattr(structure, "vertices"):
        keys = list(structure.vertices())
        return keys, [structure.vertex_coordinates(key) for key in keys], list(structure.edges())
    keys = list(structure.nodes())
    xyz = [[structure.node_attribute(key, axis) or 0.0 for axis in "xyz"] for key in keys]
    return keys, xyz, list(structure.edges())


def thread(structure, units="mm", feet=None, **options):
    """(keys along each cord, the thread_plan.Plan). thread_plan.Error: there is no plan; its text says why."""
    keys, xyz, edges = _parts(structure)
    index = {key: i for i, key in enumerate(keys)}
    given = {"format": "thread-frame", "version": 1, "units": units, "nodes": xyz, "edges": [[index[u], index[v]] for u, v in edges]}
    given["names"] = ["n%d" % i for i in range(len(keys))]
    frame = thread_plan.parse(json.dumps(given), "structure.json")
    # Nodes are called by their place in the list that was given; some may have been merged or dropped.
    place = [int(name[1:]) for name in frame.names]
    frame.set_feet("lowest" if feet is None else [place.index(index[key]) for key in feet])
    plan = frame.plan(**options)
    return [[keys[place[v]] for v in cord.nodes] for cord in plan.cords], plan
