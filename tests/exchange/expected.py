"""What a plan and its cords.csv say of every cord, for those who read its drawings: points in the order of the passes, and lengths."""
import csv
import json
import math


class Cords:
    def __init__(self, plan, table):
        with open(plan) as file:
            document = json.load(file)
        place = document["framework"]["nodes"]
        self.path = {"cord-" + cord["id"]: [place[node] for node in cord["nodes"]] for cord in document["cords"]}
        for cord in document["cords"]:  # to where it began
            if cord["closed"] and cord["nodes"][0] != cord["nodes"][-1]:
                self.path["cord-" + cord["id"]].append(place[cord["nodes"][0]])
        with open(table, newline="") as file:
            self.length = {"cord-" + row["cord"]: float(row["length"]) for row in csv.DictReader(file)}
        assert set(self.path) == set(self.length), (set(self.path), set(self.length))

    def compare_passes(self, name, edges, near):
        """edges: pairs of points in any order, one for each pass."""
        close = near * self.length[name]
        left = list(zip(self.path[name], self.path[name][1:]))
        for a, b in edges:
            fits = [k for k, (p, q) in enumerate(left) for x, y in ((p, q), (q, p)) if math.dist(a, x) + math.dist(b, y) <= close]
            assert fits, (name, a, b)
            del left[fits[0]]
        assert not left, (name, len(left))
        assert abs(sum(math.dist(a, b) for a, b in edges) - self.length[name]) <= close, name

    def compare(self, name, points, lanes, near):
        """points: of a cord, z upwards, in the framework's units; near: how exact the format is, of the cord's length. With lanes a
        pass that is alone runs from node to node; others have two points beside their edge, and the nodes where the cord starts and ends."""
        path, length = self.path[name], sum(map(math.dist, points, points[1:]))
        exact = self.length[name]
        if not lanes:
            assert len(points) == len(path), (name, len(points), len(path))
            assert all(math.dist(p, q) <= near * exact for p, q in zip(points, path)), name
            assert abs(length - exact) <= near * exact, (name, length, exact)
            return
        assert math.dist(points[0], path[0]) <= near * exact and math.dist(points[-1], path[-1]) <= near * exact, name
        at = 0
        for k, (p, q) in enumerate(zip(path, path[1:])):
            if math.dist(points[at], p) > near * exact and math.dist(points[at + 1], p) <= near * exact:
                at += 1
            if math.dist(points[at], p) <= near * exact and math.dist(points[at + 1], q) <= near * exact:
                at += 1
                continue
            for point, part in ((points[at + 1], .15), (points[at + 2], .85)):
                mid = [x + part * (y - x) for x, y in zip(p, q)]
                assert math.dist(point, mid) <= math.dist(p, q) / 3, (name, k)
            at += 2
        assert len(points) - 1 - at in (0, 1), (name, len(points), at)
