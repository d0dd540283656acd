#!/usr/bin/env python3
"""Verifies plans of `thread` without any of its code: written from docs/plan-format.md, with Python's standard library only.

    tools/check_plan.py [-q] [--time-limit S] PLAN..        - is standard input; S seconds at most for each plan (8 for each 20 MB; 0: any time)

What is verified of each plan and for which plans it holds, in the words of `thread check`, or the first violation. Exit code, the worst of all plans:
0 every claim holds, 1 a claim does not hold, 2 usage, 3 not a plan that can be read, 5 not judged in the time or in 2 GB. Sums are exact (integers, fractions of
doubles); only angles, distances and the tolerances that the page states are floating point. Section names are the page's.
"""
import cmath
import copy
import functools
import gc
import heapq
import itertools
import json
import math
import re
import resource
import signal
import struct
import sys
from fractions import Fraction

TOLERANCE = Fraction(1, 10**9)
UNIT = 2**44  # of prices in proofs of turning and of tied length


class Violation(Exception):
    """A claim that does not hold."""


class Unreadable(Exception):
    """No plan, or of another version."""


class NotChecked(Exception):
    """Judging the plan takes too long, or too much memory. That is a failure."""


MOST_STEPS = 3e7  # of the recursions for prices of walks, in that time
bounded = False  # is there a limit on the time, unless the caller stated one?
SECONDS, BYTES, MEMORY = 8, 20e6, 2 * 10**9  # for a plan of so many bytes or less, in proportion for larger ones; memory for any


def bound_work(seconds, size):
    """From here on there are so many seconds, by default for a plan of this size; 0: any time."""
    global bounded
    bounded = seconds is None
    seconds = SECONDS * max(1, size / BYTES) if seconds is None else seconds

    def give_up(*_):
        raise NotChecked(f"not done in {seconds:g} s (--time-limit allows more)")

    signal.signal(signal.SIGALRM, give_up)
    signal.setitimer(signal.ITIMER_REAL, seconds)


def require(holds, text):
    if not holds:
        raise Violation(text)


# ---- JSON ----


def texts(value):
    """All texts in a value."""
    if type(value) is str:
        yield value
    elif type(value) in (list, dict):
        for child in value if type(value) is list else [*value, *value.values()]:
            yield from texts(child)


def parse(data):
    def refuse(word):
        raise Unreadable(f"not valid JSON: {word}")

    def pairs(items):
        members = dict(items)
        return members if len(members) == len(items) else refuse("a member comes twice")

    def real(text):
        value = float(text)
        if not math.isfinite(value):
            refuse(f"{text} is out of range")
        minus_zero = math.copysign(1, value) < 0 == value  # hashed as it is
        return int(value) if value.is_integer() and abs(value) <= 2**53 and not minus_zero else value

    def whole(text):
        value = int(text) if len(text) < 25 else refuse(f"{text} is out of range")
        return value if -(2**63) <= value < 2**63 else refuse(f"{text} is out of range")

    try:
        long = re.search(rb"[0-9]{19}", data)  # else no integer is out of range
        value = json.loads(data.decode("utf-8-sig"), parse_constant=refuse, parse_float=real, parse_int=whole if long else None, object_pairs_hook=pairs)
        if b"\\" in data and any(b"\0" in text.encode("utf-8") for text in texts(value)):  # encode refuses half characters
            refuse("a text with a character 0")
        return value
    except (ValueError, RecursionError) as error:
        raise Unreadable(f"not valid JSON: {error}") from None


KINDS = {"text": str, "integer": int, "truth": bool, "list": list, "object": dict}


def member(holder, key, kind, place, low=None, high=None, default=...):
    """holder[key], of the kind (`number`: integer or real, as a float) and in [low, high]; default if it may be missing."""
    if key not in holder:
        if default is not ...:
            return default
        raise Violation(f"{place}.{key}: missing" if place else f"{key}: missing")
    value = holder[key]
    if kind == "integer" and type(value) is float and value == 0:  # -0.0
        value = holder[key] = 0
    good = type(value) in (int, float) if kind == "number" else type(value) is KINDS[kind]
    value = float(value) + 0.0 if good and kind == "number" else value  # -0.0 is 0
    if good and (low is None or value >= low) and (high is None or value <= high):
        return value
    name = f"{place}.{key}" if place else key
    require(good, f"{name}: not of type {kind}")
    require(low is None or value >= low, f"{name}: {value} is below {low}")
    raise Violation(f"{name}: {value} is above {high}")


def choice(holder, key, place, words, default=...):
    value = member(holder, key, "text", place, default=default)
    require(value in words, f"{place}.{key}: not one of {', '.join(map(str, words))}")
    return value


def integers(value, place, low, high, n=None):
    if type(value) is list and 0.0 in value:  # and perhaps -0.0
        value[:] = [0 if type(x) is float and x == 0 else x for x in value]
    require(type(value) is list and all(type(x) is int for x in value), f"{place}: not a list of integers")
    require(n is None or len(value) == n, f"{place}: {len(value)} values, expected {n}")
    require(all(low <= x <= high for x in value), f"{place}: a value is not within {low} to {high}")
    return value


@functools.lru_cache(maxsize=None)
def words_of(names):
    return frozenset(names.split())


def known(holder, names, place):
    for key in holder:
        if key not in words_of(names):
            raise Violation(f"{place}.{key}: not known, and cannot be checked")


INT64 = 2**63 - 1


def clean(text):
    """Foreign text, for one line of a terminal."""
    return "".join(c if c.isprintable() else " " for c in text)


# ---- framework ----

# millimetres of a unit; None: nobody knows
UNITS = {"um": 0.001, "micron": 0.001, "microns": 0.001, "mm": 1, "cm": 10, "dm": 100, "m": 1000, "km": 1e6, "in": 25.4, "inch": 25.4,
         "inches": 25.4, "ft": 304.8, "foot": 304.8, "feet": 304.8, "yd": 914.4, "yard": 914.4, "yards": 914.4, "unit": None, "units": None,
         "unitless": None, "unknown": None, "none": None, "mi": 1609344, "mile": 1609344, "miles": 1609344, "us-ft": 1200000 / 3937, "us-in": 100000 / 3937,
         "us-yd": 3600000 / 3937, "us-mi": 6336000000 / 3937, "mil": 0.0254, "uin": 2.54e-5, "microinch": 2.54e-5, "microinches": 2.54e-5,
         "nm": 1e-6, "angstrom": 1e-7, "angstroms": 1e-7, "dam": 1e4, "hm": 1e5, "gm": 1e12, "au": 1.495978707e14, "ly": 9.4607304725808e18,
         "pc": 3.0856775814913673e19, "parsec": 3.0856775814913673e19, "parsecs": 3.0856775814913673e19}
for prefix, size in (("", 1000), ("nano", 1e-6), ("micro", 0.001), ("milli", 1), ("centi", 10), ("deci", 100), ("deca", 1e4), ("hecto", 1e5),
                     ("kilo", 1e6), ("giga", 1e12)):
    UNITS.update({prefix + metre: size for metre in ("meter", "meters", "metre", "metres")})
SHORT = {0.001: "um", 1: "mm", 10: "cm", 100: "dm", 1000: "m", 1e6: "km", 25.4: "in", 304.8: "ft", 914.4: "yd", 1609344: "mi", 1200000 / 3937: "us-ft",
         100000 / 3937: "us-in", 3600000 / 3937: "us-yd", 6336000000 / 3937: "us-mi", 0.0254: "mil", 2.54e-5: "uin", 1e-6: "nm", 1e-7: "angstrom",
         1e4: "dam", 1e5: "hm", 1e12: "Gm", 1.495978707e14: "au", 9.4607304725808e18: "ly", 3.0856775814913673e19: "pc", None: "unit"}
CONTROL = re.compile("[\x00-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069\ufffe\uffff]")


class Frame:
    """Half-edge 2 e + s is edge e seen from its end s; at[v] lists those of node v by ascending edge."""

    def __init__(self, o):
        place = "framework"
        self.units = member(o, "units", "text", place, default="mm")
        require(self.units.isascii() and self.units.lower() in UNITS, "framework.units: no unit of length")
        self.unit = SHORT[UNITS[self.units.lower()]]
        nodes = member(o, "nodes", "list", place)
        edges = member(o, "edges", "list", place)
        require(nodes and edges, "framework: no nodes or no edges")
        for v, p in enumerate(nodes):
            good = type(p) is list and len(p) == 3 and all(type(x) in (int, float) and abs(x) < 1e100 for x in p)
            require(good, f"framework.nodes[{v}]: not three numbers below 1e100")
        self.xyz = [tuple(map(float, p)) for p in nodes]
        self.n = len(nodes)
        self.edge = [tuple(integers(e[:2] if type(e) is list else e, f"framework.edges[{i}]", 0, self.n - 1, 2)) for i, e in enumerate(edges)]
        self.m = len(edges)
        require(all(a != b for a, b in self.edge), "framework.edges: an edge from a node to itself")
        require(len({frozenset(e) for e in self.edge}) == self.m, "framework.edges: two edges between the same nodes")
        require(len(set(self.xyz)) == self.n, "framework.nodes: two nodes at one place")
        self.at = [[] for _ in range(self.n)]
        for h in range(2 * self.m):
            self.at[self.tail(h)].append(h)
        require(all(self.at), "framework.nodes: a node without an edge")
        self.read_edges(o)
        names = member(o, "names", "list", place, default=None)
        require(names is None or len(names) == self.n and all(type(x) is str for x in names), "framework.names: not a name per node")
        require(names is None or len({CONTROL.sub(" ", x) for x in names}) == self.n, "framework.names: two nodes of one name")
        self.names = names or [str(v) for v in range(self.n)]
        self.feet = set(integers(member(o, "feet", "list", place, default=[]), "framework.feet", 0, self.n - 1))
        require(member(o, "hash", "text", place) == self.hash(), f"framework.hash: the framework's is {self.hash()}")
        self.components()

    def tail(self, h):
        return self.edge[h >> 1][h & 1]

    def read_edges(self, o):
        given = member(o, "lengths", "list", "framework", default=None)
        self.own_lengths = given is not None
        if given is None:
            self.length = []
            for a, b in self.edge:
                x, y, z = (q - p for p, q in zip(self.xyz[a], self.xyz[b]))
                self.length.append(math.sqrt(x * x + y * y + z * z))
        else:
            require(len(given) == self.m and all(type(x) in (int, float) for x in given), "framework.lengths: not a number per edge")
            self.length = [float(x) for x in given]
        require(all(0 < x < math.inf for x in self.length), "framework.lengths: not more than 0")
        self.exact = [Fraction(x) for x in self.length]
        self.cover, self.capacity = (self.passes(o, key) for key in ("covers", "capacities"))
        self.cover = self.cover and [x or 1 for x in self.cover]

    def passes(self, o, key):
        """A list per edge, 0 for what is not said; None if nothing is."""
        given = member(o, key, "list", "framework", default=[0] * self.m)
        given = integers([0 if x is None else x for x in given], f"framework.{key}", 0, 100, self.m)
        return given if any(given) else None

    def hash(self):
        """FNV-1a, 64 bits, of little-endian numbers."""
        data = struct.pack("<ii", self.n, self.m) + b"".join(struct.pack("<ddd", *p) for p in self.xyz)
        data += b"".join(struct.pack("<ii", *e) for e in self.edge) + struct.pack(f"<{self.m}d", *self.length)
        data += bytes(v in self.feet for v in range(self.n))
        if self.cover is not None:
            data += struct.pack(f"<{self.m}i", *self.cover)
        if self.capacity is not None:
            data += b"capacity" + struct.pack(f"<{self.m}i", *self.capacity)
        value = 14695981039346656037
        for byte in data:
            value = (value ^ byte) * 1099511628211 & 2**64 - 1
        return f"{value:016x}"

    def components(self):
        self.component = [-1] * self.n
        self.pieces = []  # their nodes, ascending
        for root in range(self.n):
            if self.component[root] < 0:
                stack, piece = [root], [root]
                self.component[root] = len(self.pieces)
                while stack:
                    for h in self.at[stack.pop()]:
                        w = self.tail(h ^ 1)
                        if self.component[w] < 0:
                            self.component[w] = len(self.pieces)
                            stack.append(w)
                            piece.append(w)
                self.pieces.append(sorted(piece))

    def edges_of(self, c):
        return [e for e in range(self.m) if self.component[self.edge[e][0]] == c]

    def angle(self, a, b):
        """Of the turn between two half-edges that leave one node: 0 straight on, pi back."""
        if a == b:
            return math.pi
        u, v = ([q - p for p, q in zip(self.xyz[self.tail(h)], self.xyz[self.tail(h ^ 1)])] for h in (a, b))
        s, t = max(map(abs, u)), max(map(abs, v))
        u, v = [x / s for x in u], [x / t for x in v]
        cross = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
        return math.atan2(math.hypot(*cross), -sum(x * y for x, y in zip(u, v)))

    def is_step(self, a, b):
        """Is it a turn of 90 degrees or more, to 1e-6? In doubles, in the page's order."""
        scaled = []
        for h, sign in ((a, -1), (b, 1)):
            u = [sign * (q - p) for p, q in zip(self.xyz[self.tail(h)], self.xyz[self.tail(h ^ 1)])]
            largest = max(map(abs, u))
            scaled.append([x / largest for x in u])
        (a0, a1, a2), (b0, b1, b2) = scaled
        d = a0 * b0 + a1 * b1 + a2 * b2
        return a == b or d <= 0 or d * d <= 1e-12 * ((a0 * a0 + a1 * a1 + a2 * a2) * (b0 * b0 + b1 * b1 + b2 * b2))

    def distances(self, sources, without=-1, most=math.inf):
        """Shortest way from the nearest source to every node, not over one edge; None where it is longer than most."""
        best = [None] * self.n
        queue = [(0.0, v) for v in sources]
        while queue:
            d, v = heapq.heappop(queue)
            if best[v] is None:
                best[v] = d
                for h in self.at[v]:
                    if best[self.tail(h ^ 1)] is None and h >> 1 != without and d + self.length[h >> 1] <= most:
                        heapq.heappush(queue, (d + self.length[h >> 1], self.tail(h ^ 1)))
        return best


# ---- options ----

PHYSICS = {"mu": (0, 2), "mu_low": (0, 2), "mu_high": (0, 3), "mu_bead": (0, 2), "mu_ground": (0, 2), "cord_diameter": (0, 1e9),
           "bore": (0, 1e9), "bead_diameter": (0, 1e9), "density": (0, 25), "bead_mass": (0, 1e9), "seating": (5e-324, 1e9),
           "gravity": (0, 1000), "wobble": (0, 10), "mu_power": (0, 1), "mu_tension": (0, 1e9), "stiffness": (0, 1e12), "bead_strength": (0, 1e6)}
DEFAULTS = {None: {"mu": 0.2, "mu_low": 0, "mu_high": 0, "mu_bead": 0.25, "mu_ground": 0.25, "cord_diameter": 0, "bore": 0, "bead_diameter": 0,
                   "density": 1.24, "bead_mass": 0, "seating": 1, "gravity": 9.80665, "wobble": 0, "mu_power": 0, "mu_tension": 0, "stiffness": 0, "bead_strength": 0},
            "pla-cotton": {"mu": 0.25, "mu_low": 0.15, "mu_high": 0.45, "mu_bead": 0.3, "mu_ground": 0.3},
            "pla-braid": {"mu": 0.18, "mu_low": 0.1, "mu_high": 0.3, "mu_bead": 0.3, "mu_ground": 0.3},
            "pla-monofilament": {"mu": 0.25, "mu_low": 0.12, "mu_high": 0.4, "mu_bead": 0.3, "mu_ground": 0.3},
            "pla-waxed": {"mu": 0.2, "mu_low": 0.1, "mu_high": 0.35, "mu_bead": 0.3, "mu_ground": 0.3},
            "pla-elastic": {"mu": 0.3, "mu_low": 0.15, "mu_high": 0.5, "mu_bead": 0.3, "mu_ground": 0.3},
            "eps-nylon": {"mu": 0.3, "mu_low": 0.15, "mu_high": 0.5, "mu_bead": 0.5, "mu_ground": 0.5, "density": 0.02},
            "wood-paracord": {"mu": 0.3, "mu_low": 0.2, "mu_high": 0.4, "mu_bead": 0.24, "mu_ground": 0.3, "cord_diameter": 4, "density": 0.5}}


def check_physics(o, place):
    known(o, "preset note " + " ".join(PHYSICS), place)
    preset = choice(o, "preset", place, DEFAULTS) if "preset" in o else None
    member(o, "note", "text", place, default="")
    values = {**DEFAULTS[None], **DEFAULTS[preset]}
    if preset and "mu" in o:
        values["mu_low"] = values["mu_high"] = 0
    return {key: member(o, key, "number", place, low, high, default=values[key]) for key, (low, high) in PHYSICS.items()}


class Options:
    def __init__(self, o, f):
        p = "options"
        known(o, "objective joint cover capacity distinct cords max_length max_pull balance ends end_nodes end_counts needles order crossings engine confirm turning symmetry"
              " time_limit gap physics", p)
        self.objective = choice(o, "objective", p, ("length", "tortuosity", "symmetry"))
        self.tube = choice(o, "joint", p, ("solid", "tube")) == "tube"
        self.cover = member(o, "cover", "integer", p, 1, 100)
        self.capacity = member(o, "capacity", "integer", p, 1, 2**31 - 1, default=0)
        self.balance = member(o, "balance", "truth", p, default=False)
        self.max_length = member(o, "max_length", "number", p, 5e-324, default=None)
        self.max_pull = member(o, "max_pull", "number", p, 1, default=None)
        member(o, "time_limit", "number", p, 0)
        member(o, "gap", "number", p, 0, 100, default=None)
        member(o, "needles", "integer", p, 1, 2, default=0)
        choice(o, "order", p, ("hand", "planned", "starts"), default="planned")
        self.crossings = choice(o, "crossings", p, ("allow", "forbid", "price"), default="allow")
        require(self.crossings == "allow" or not self.tube, "options.crossings: not with tube joints")
        choice(o, "engine", p, ("auto", "lp", "matching"), default="auto")
        choice(o, "confirm", p, ("auto", "always", "never"), default="auto")
        require(self.objective == "length" or "confirm" not in o, "options.confirm: only with objective length")
        self.mu = check_physics(member(o, "physics", "object", p), p + ".physics")["mu"]
        self.read_cords(o)
        self.read_ends(o, f)
        self.read_turning(o)
        self.read_symmetry(o)
        self.read_distinct(o)
        self.need = [max(self.cover, f.cover[e] if f.cover else 1) for e in range(f.m)]
        self.most = []  # passes that fit through each edge, None: any number
        for e in range(f.m):
            limits = [x for x in (self.capacity, f.capacity[e] if f.capacity else 0) if x]
            self.most.append(min(limits) if limits else None)
            require(self.most[e] is None or self.most[e] >= self.need[e], f"edge {e}: needs more passes than fit")

    def read_cords(self, o):
        cords = o.get("cords")
        if type(cords) is dict:
            known(cords, "least most", "options.cords")
            self.least = member(cords, "least", "integer", "options.cords", 1, 1000)
            self.cords = member(cords, "most", "integer", "options.cords", self.least, 1000)
        else:
            self.least = self.cords = member(o, "cords", "integer", "options", 1, 1000)

    def read_distinct(self, o):
        least = self.least if self.objective != "symmetry" or self.counted else self.cords  # else of one of the components
        self.distinct = member(o, "distinct", "integer", "options", 2, min(self.cover, least), default=0)
        require(not self.distinct or self.objective != "tortuosity" or self.tour == "least", "options.distinct: not with a classical tour")

    def alike(self, f):
        """Does every cord pass every edge, each of them being on its own?"""
        return (self.distinct and self.objective != "symmetry" and self.distinct == self.cords == self.least == self.cover and self.ends != "counts" and not self.tube
                and not (self.capacity or f.cover or f.capacity))

    def read_ends(self, o, f):
        self.ends = choice(o, "ends", "options", ("closed", "any", "feet", "nodes", "counts"))
        require(("end_nodes" in o) == (self.ends == "nodes"), "options.end_nodes: with ends `nodes`, and only with them")
        require(("end_counts" in o) == (self.ends == "counts"), "options.end_counts: with ends `counts`, and only with them")
        self.count = {}
        self.allowed = {"closed": set(), "any": set(range(f.n)), "feet": f.feet}.get(self.ends)
        if self.ends == "nodes":
            nodes = integers(member(o, "end_nodes", "list", "options"), "options.end_nodes", 0, f.n - 1)
            self.allowed = set(nodes)
        if self.ends == "counts":
            for i, pair in enumerate(member(o, "end_counts", "list", "options")):
                v, number = integers(pair, f"options.end_counts[{i}]", 0, max(f.n - 1, 2000), 2)
                require(v < f.n and 1 <= number <= 2000 and v not in self.count, f"options.end_counts[{i}]: not so many ends at a node")
                self.count[v] = number
            self.allowed = set(self.count)

    def read_turning(self, o):
        require(("turning" in o) == (self.objective == "tortuosity"), "options.turning: with that objective, and only with it")
        self.tour = None
        if self.objective == "tortuosity":
            t, p = member(o, "turning", "object", "options"), "options.turning"
            known(t, "cost length_slack minimize tour pairings nodes", p)
            member(t, "nodes", "integer", p, 1, 2**31 - 1, default=1)
            self.cost = choice(t, "cost", p, ("angle", "sine", "step", "uturn"))
            self.slack = None if t.get("length_slack", 0) is None else member(t, "length_slack", "number", p, 0)
            self.minimize = choice(t, "minimize", p, ("turning", "max-turning", "pull"))
            self.pull = self.minimize == "pull"
            require(not self.pull or self.cost == "angle", f"{p}.cost: a pull is of angles")
            self.tour = choice(t, "tour", p, ("least", "fleury", "hierholzer"))
            choice(t, "pairings", p, ("keep", "ignore"))

    def read_symmetry(self, o):
        require(("symmetry" in o) == (self.objective == "symmetry"), "options.symmetry: with that objective, and only with it")
        self.counted = True  # is the number of cords asked for?
        if self.objective == "symmetry":
            s, p = member(o, "symmetry", "object", "options"), "options.symmetry"
            self.counted = member(s, "counted", "truth", p, default=False)
            self.least = self.least if self.counted else 1
            known(s, "group geometric counted prefer", p)
            self.group = s.get("group")
            if s.get("group", 0) is not None:
                require(1 <= len(member(s, "group", "text", p).encode()) <= 15, "options.symmetry.group: not 1 to 15 bytes")
            if s.get("geometric", "") is not None:
                member(s, "geometric", "number", p, 0)
            aims = member(s, "prefer", "list", p)
            require(sorted(map(str, aims)) == ["overlap", "paths", "steps", "turning"], "options.symmetry.prefer: not each once")

    def price(self, f, a, b):
        """Of the turn between two half-edges that leave one node."""
        angle = f.angle(a, b)
        if self.objective != "tortuosity" or self.cost == "angle":
            return angle
        if self.cost == "uturn":
            return float(a == b)
        return math.sin(angle / 2) if self.cost == "sine" else float(f.is_step(a, b))


# ---- cords ----


class Cord:
    """Its passes as half-edges that leave the node where the pass begins."""

    def __init__(self, o, i, f):
        place = f"cords[{i}]"
        require(type(o) is dict, f"{place}: not an object")
        number, name = i + 1, ""
        while number:
            number, letter = divmod(number - 1, 26)
            name = chr(65 + letter) + name
        require(member(o, "id", "text", place) == name, f"{place}.id: not {name}")
        self.id = name
        edges = integers(member(o, "edges", "list", place), place + ".edges", 0, f.m - 1)
        self.nodes = integers(member(o, "nodes", "list", place), place + ".nodes", 0, f.n - 1, len(edges) + 1)
        require(edges, f"{place}: no passes")
        self.half = []
        for k, e in enumerate(edges):
            ends = self.nodes[k], self.nodes[k + 1]
            require(ends in (f.edge[e], f.edge[e][::-1]), f"cord {name}, pass {k + 1}: edge {e} does not join nodes {ends[0]} and {ends[1]}")
            self.half.append(2 * e + (ends[0] == f.edge[e][1]))
        self.component = f.component[self.nodes[0]]
        require(member(o, "component", "integer", place) == self.component, f"{place}.component: not {self.component}")
        self.closed = self.nodes[0] == self.nodes[-1]
        require(member(o, "closed", "truth", place) == self.closed, f"{place}.closed: not so")

    def turns(self, closing):
        """Pairs of half-edges that leave one node: of the pass that arrives there, and of the one that leaves."""
        pairs = [(h ^ 1, g) for h, g in zip(self.half, self.half[1:])]
        return pairs + [(self.half[-1] ^ 1, self.half[0])] if closing else pairs

    def length(self, f):
        return sum(f.exact[h >> 1] for h in self.half)


class Plan:
    left_out = False  # was anything that a plan of version 1 proves within its limit on the pull?

    def leave_out_older_pull(self):
        """Claims about cords that a pass parts are not verified any more, nor what rests on them."""
        stated, proof = self.proof, dict(self.proof)
        by_walks = "walks" in (stated.get("length") or {})
        self.left_out, self.proof = by_walks or "pull" in stated, proof
        proof.pop("pull", None)
        if by_walks:
            proof.pop("length")
            proof.pop("cords", None)
            if (stated.get("turning") or {}).get("length_limit") is not None:
                proof.pop("turning")

    def __init__(self, o):
        if type(o) is not dict or o.get("format") != "thread-plan":
            raise Unreadable("format: not a thread plan")
        if type(o.get("version")) is not int or o["version"] not in (1, 2):
            raise Unreadable("version: neither 1 nor 2")
        member(o, "generator", "text", "", default="")
        f = self.frame = Frame(member(o, "framework", "object", ""))
        self.options = Options(member(o, "options", "object", ""), f)
        self.options.old_pull = o["version"] == 1
        cords = member(o, "cords", "list", "")
        require(cords, "cords: none")
        self.cords = [Cord(c, i, f) for i, c in enumerate(cords)]
        self.file = o
        self.proof = member(o, "proof", "object", "")
        known(self.proof, "length cords pull turning", "proof")
        if self.options.old_pull:
            self.leave_out_older_pull()
        self.closing = self.options.ends == "closed"
        self.passes = [0] * f.m
        for cord in self.cords:
            for h in cord.half:
                self.passes[h >> 1] += 1
        self.lengths = [cord.length(f) for cord in self.cords]
        self.length = sum(self.lengths)
        self.extra = [x - n for x, n in zip(self.passes, self.options.need)]
        self.per_piece = [sum(c.component == k for c in self.cords) for k in range(len(f.pieces))]

    def compared(self, c):
        """Cords of component c that its length is compared with: as many, where the fewest are asked for before the shortest."""
        o = self.options
        return self.per_piece[c] if o.max_length is not None and o.counted and o.least < o.cords else o.cords

    def different(self):
        """Different cords over every edge of plans like this one: what is asked for, if it has them."""
        return self.options.distinct if self.options.distinct and self.met == self.frame.m else 1

    def close(self, stated, value, scale, name):
        require(abs(Fraction(stated) - Fraction(value)) <= TOLERANCE * Fraction(scale), f"{name}: stated {stated}, but it is {float(value)}")


def check_cords(p):
    """Walks, ends, passes, numbers, lengths, joints."""
    f, o = p.frame, p.options
    for e in range(f.m):
        require(p.extra[e] >= 0, f"edge {e}: {p.passes[e]} of {o.need[e]} passes")
        require(o.most[e] is None or p.passes[e] <= o.most[e], f"edge {e}: {p.passes[e]} passes, {o.most[e]} fit")
    found = {}
    for cord in p.cords:
        require(cord.closed or not p.closing, f"cord {cord.id}: not closed")
        for v in (cord.nodes[0], cord.nodes[-1]):
            require(p.closing or v in o.allowed, f"cord {cord.id}: an end at node {v}, where none may be")
            found[v] = found.get(v, 0) + 1
    require(o.ends != "counts" or found == o.count, "cords: not the numbers of ends at the nodes that were asked for")
    if not o.counted:
        require(o.cords == max(p.per_piece), "options.cords: not the number in the component that has most")
    elif o.objective != "length" or p.proof.get("length") is not None:
        for k, number in enumerate(p.per_piece):
            require(o.least <= number <= o.cords, f"component {k}: {number} cords")
    for cord, length in zip(p.cords, p.lengths):
        require(o.max_length is None or length <= Fraction(o.max_length) * (1 + TOLERANCE), f"cord {cord.id}: longer than max_length")
    if o.tube:
        check_tied(p)


def check_tied(p):
    f = p.frame
    root = list(range(2 * f.m))

    def find(h):
        while root[h] != h:
            root[h] = root[root[h]]
            h = root[h]
        return h

    for cord in p.cords:
        for a, b in cord.turns(p.closing):
            require(a != b, f"cord {cord.id}: turns back at node {f.tail(a)}")
            root[find(a)] = find(b)
    for v in range(f.n):
        require(len({find(h) for h in f.at[v]}) == 1, f"node {v}: the cords do not tie its edges together")


def check_metrics(p):
    f, m = p.frame, member(p.file, "metrics", "object", "")
    known(m, "length base_length overlap passes most_passes turning max_turning worst_turn u_turns"
          + (" distinct" if p.options.distinct else "") + (" crossings" if p.options.crossings != "allow" else ""), "metrics")
    base = sum(f.exact[e] * n for e, n in enumerate(p.options.need))
    angles = [[f.angle(a, b) for a, b in cord.turns(p.closing)] for cord in p.cords]
    p.turning = [math.fsum(x) for x in angles]
    total = math.fsum(p.turning)
    for key, value, scale in (("length", p.length, p.length), ("base_length", base, p.length), ("overlap", p.length - base, p.length),
                              ("turning", total, 1 + total), ("max_turning", max(p.turning), 1 + total),
                              ("worst_turn", max((a for x in angles for a in x), default=0), 1 + total)):
        p.close(member(m, key, "number", "metrics"), value, scale, "metrics." + key)
    back = sum(a == b for cord in p.cords for a, b in cord.turns(p.closing))
    for key, value in (("passes", sum(p.passes)), ("most_passes", max(p.passes)), ("u_turns", back)):
        require(member(m, key, "integer", "metrics") == value, f"metrics.{key}: not {value}")


def arms_around(f, v):
    """Place of each half-edge of a node in their order around the direction in which they spread least: that is the eigenvector of the least
    eigenvalue of the sum of their outer products, by power iteration on what it lacks to its trace, from the normal of the widest angle with
    the first arm."""
    def cross(a, b):
        return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]

    def dot(a, b):
        return sum(x * y for x, y in zip(a, b))

    arms = []
    for h in f.at[v]:
        d = [b - a for a, b in zip(f.xyz[v], f.xyz[f.edge[h >> 1][1 - (h & 1)]])]
        size = math.sqrt(dot(d, d))
        arms.append([x / size for x in d] if size else [0.0] * 3)
    spread = [[sum(d[i] * d[j] for d in arms) for j in range(3)] for i in range(3)]
    trace, most, normal = spread[0][0] + spread[1][1] + spread[2][2], 1e-12, [0.0] * 3
    for d in arms:
        c = cross(arms[0], d)
        if dot(c, c) > most * (1 + 1e-9):
            normal = c
        most = max(most, dot(c, c))
    for step in range(100):
        size = math.sqrt(dot(normal, normal))
        if not size:
            break
        normal = [x / size for x in normal]
        if step < 99:
            normal = [trace * x - dot(row, normal) for x, row in zip(normal, spread)]
    along, most = [0.0] * 3, 0
    for d in arms:
        up = dot(d, normal)
        flat = [x - up * y for x, y in zip(d, normal)]
        if dot(flat, flat) > most + 1e-9:
            along, most = flat, dot(flat, flat)
    across, angle = cross(normal, along), {}
    for h, d in zip(f.at[v], arms):
        x, y = dot(d, along), dot(d, across)
        angle[h] = round(math.atan2(y, x) * 1e9) if x * x + y * y > 1e-18 else 0
    return {h: i for i, h in enumerate(sorted(f.at[v], key=lambda h: (angle[h], h)))}


def check_crossings(p):
    """Pairs of channels of a node with four different arms that lie alternately around it."""
    if p.options.crossings == "allow":
        return
    channels, crossings = [[] for _ in range(p.frame.n)], 0
    for cord in p.cords:
        for a, b in cord.turns(p.closing):
            channels[p.frame.tail(a)].append((a, b))
    for v, list_of in enumerate(channels):
        rank = arms_around(p.frame, v)
        chords = [sorted((rank[a], rank[b])) for a, b in list_of]
        for i, (a, b) in enumerate(chords):
            crossings += sum(len({a, b, c, d}) == 4 and (a < c < b) != (a < d < b) for c, d in chords[:i])
    require(member(p.file["metrics"], "crossings", "integer", "metrics") == crossings, f"metrics.crossings: not {crossings}")
    require(p.options.crossings == "price" or not crossings, "options.crossings: forbidden, and there are some")


def check_distinct(p):
    """How many edges are passed by enough different cords; without all of them nothing is optimal."""
    if not p.options.distinct:
        return
    cords = [set() for _ in range(p.frame.m)]
    for i, cord in enumerate(p.cords):
        for h in cord.half:
            cords[h >> 1].add(i)
    p.met = sum(len(c) >= p.options.distinct for c in cords)
    require(member(p.file["metrics"], "distinct", "integer", "metrics") == p.met, f"metrics.distinct: not {p.met}")
    for claim in [x for x in p.proof.values() if type(x) is dict]:
        for part in [claim] + [x for x in claim.values() if type(x) is dict]:
            require(p.met == p.frame.m or part.get("status") != "optimal", "proof: optimal, but some edges have too few different cords")


def bridge_needs(p):
    """Passes of every edge, where several different cords over a bridge need more: those that pass it once have an end on either side."""
    f, o = p.frame, p.options
    needs = list(o.need)
    for e, (a, b) in enumerate(f.edge):
        side, waiting = {a}, [a]
        while waiting and b not in side:
            v = waiting.pop()
            for h in f.at[v]:
                w = f.tail(h ^ 1)
                if h >> 1 != e and w not in side:
                    side.add(w)
                    waiting.append(w)
        if b in side:
            continue
        other = next(set(piece) for piece in f.pieces if a in piece) - side
        ends = [sum(o.count.get(v, 0) for v in part) if o.ends == "counts" else 2 * o.cords * len(part & o.allowed) for part in (side, other)]
        needs[e] = max(needs[e], 2 * o.distinct - min(o.distinct, *ends))
    return needs


def parts(p):
    """What the proofs are about: the plan, with what its bridges need if it has that, or if every cord passes every edge each of its
    rounds of cords by itself."""
    if not (p.options.alike(p.frame) and p.met == p.frame.m):
        needs = bridge_needs(p) if p.options.distinct and p.options.objective != "symmetry" else p.options.need
        if needs == p.options.need or any(x < y for x, y in zip(p.passes, needs)):
            return [p]
        r = copy.copy(p)
        r.frame, r.options = copy.copy(p.frame), copy.copy(p.options)
        r.frame.cover, r.options.need = needs, needs
        r.extra = [x - y for x, y in zip(p.passes, needs)]
        return [r]
    rounds = []
    for i in range(p.options.distinct):
        r = copy.copy(p)
        r.options = copy.copy(p.options)
        r.options.cover = r.options.cords = r.options.least = 1
        r.options.distinct = 0
        r.options.need = [1] * p.frame.m
        chosen = [[k for k, c in enumerate(p.cords) if c.component == piece][i] for piece in range(len(p.frame.pieces))]
        r.cords, r.lengths = [p.cords[k] for k in chosen], [p.lengths[k] for k in chosen]
        r.turning = [p.turning[k] for k in chosen]
        r.length = sum(r.lengths)
        r.passes = [0] * p.frame.m
        for cord in r.cords:
            for h in cord.half:
                r.passes[h >> 1] += 1
        r.extra = [x - 1 for x in r.passes]
        require(min(r.extra) >= 0, "cords: one does not pass every edge")
        r.per_piece = [1] * len(p.frame.pieces)
        r.proof = dict(p.proof)
        for key, names in (("length", ("lower_bound",)), ("turning", ("price", "lower_bound", "length_limit"))):
            if type(r.proof.get(key)) is dict:
                r.proof[key] = {k: x / p.options.distinct if k in names and type(x) in (int, float) else x for k, x in r.proof[key].items()}
        rounds.append(r)
    return rounds


# ---- proof.length, solid joints ----


class Cuts:
    """A forest of node sets: their parity, and what of their values an edge leaves or a node is in."""

    def __init__(self, cuts, place, piece, odd):
        n = len(cuts)
        self.parent, self.above, self.sets = [None] * n, [0] * n, {}
        parity, tree = [0] * n, [0] * n
        piece = set(piece)
        self.value = []
        for i, cut in enumerate(cuts):
            require(type(cut) is dict, f"{place}.cuts[{i}]: not an object")
            known(cut, "value nodes parent", f"{place}.cuts[{i}]")
            self.value.append(member(cut, "value", "integer", f"{place}.cuts[{i}]", 0))
            self.parent[i] = member(cut, "parent", "integer", f"{place}.cuts[{i}]", i + 1, n - 1, default=None)
        for i in reversed(range(n)):
            up = self.parent[i]
            tree[i] = i if up is None else tree[up]
            self.above[i] = self.value[i] + (0 if up is None else self.above[up])
        for i, cut in enumerate(cuts):
            nodes = integers(member(cut, "nodes", "list", f"{place}.cuts[{i}]"), f"{place}.cuts[{i}].nodes", 0, INT64)
            require(all(a < b for a, b in zip(nodes, nodes[1:])), f"{place}.cuts[{i}].nodes: not ascending")
            for v in nodes:
                require(v in piece, f"{place}.cuts[{i}]: node {v} is not in the component")
                held = self.sets.setdefault(v, {})
                require(tree[i] not in held, f"{place}.cuts[{i}]: node {v} comes twice in its tree")
                held[tree[i]] = i
                parity[i] ^= v in odd
            require(parity[i], f"{place}.cuts[{i}]: an even number of odd nodes")
            if self.parent[i] is not None:
                parity[self.parent[i]] ^= 1

    def held(self, v):
        return sum(self.above[i] for i in self.sets.get(v, {}).values())

    def left(self, a, b):
        """Sum of the values of the sets that hold one of two nodes."""
        total = 0
        for tree, i in self.sets.get(a, {}).items():
            j = self.sets.get(b, {}).get(tree)
            total += self.above[i]
            while j is not None and i is not None and i != j:  # up to the lowest set round both
                if i < j:
                    i = self.parent[i]
                else:
                    j = self.parent[j]
            if i is not None and j is not None:
                total -= 2 * self.above[i]
        return total + self.held(b)


def shortest_loop(f, e):
    """Edges of the shortest loop over edge e; 10 if there is none that is shorter."""
    (a, b), seen, front = f.edge[e], {f.edge[e][0]}, [f.edge[e][0]]
    for steps in range(1, 9):
        front = [f.tail(h ^ 1) for v in front for h in f.at[v] if h >> 1 != e]
        if b in front:
            return steps + 1
        front = list(set(front) - seen)
        seen.update(front)
    return 10


def places(f, o, e, n, price):
    """Price of the places that n passes over edge e are."""
    if o.ends != "closed":
        return n * sum(price(v) for v in f.edge[e] if v in o.allowed)
    return price(0) * (n // 2 * 2 + (n % 2 and Fraction(2, shortest_loop(f, e))))


class Certificate:
    """Of one component. least(j): least length of its cords if they have j ends."""

    def __init__(self, p, o, place, c):
        f, opt = p.frame, p.options
        known(o, "component scale denominator end_price join sum place_prices cuts", place)
        require(member(o, "component", "integer", place) == c, f"{place}.component: not {c}")
        self.scale = Fraction(member(o, "scale", "number", place, 5e-324))
        self.unit = member(o, "denominator", "integer", place, 1, 2**40)
        self.end_price = member(o, "end_price", "integer", place, 0)
        require(self.end_price == 0 or opt.ends not in ("closed", "counts"), f"{place}.end_price: not 0")
        piece, edges = f.pieces[c], f.edges_of(c)
        self.base = sum(f.exact[e] * opt.need[e] for e in edges)
        self.own = self.base + sum(f.exact[e] * p.extra[e] for e in edges)
        self.weight = {}
        for e in edges:
            product = f.length[e] * float(self.scale)
            require(product < 1e18, f"{place}.scale: too large")
            self.weight[e] = round(product)
        join = sum(self.weight[e] * p.extra[e] for e in edges)
        require(member(o, "join", "integer", place) == join, f"{place}.join: not {join}")
        prices = self.read_prices(o, place, piece, opt)
        odd = {v for v in piece if (sum(opt.need[h >> 1] for h in f.at[v]) + opt.count.get(v, 0)) % 2}
        self.constant, limit = 0, {}
        if prices:
            self.constant = self.priced(p, prices, piece, edges, limit, odd, place)
        else:
            limit = {e: self.weight[e] * self.unit for e in edges if opt.most[e] != opt.need[e]}
        cuts = Cuts(member(o, "cuts", "list", place), place, piece, odd)
        self.sum, self.cuts, self.has_prices = sum(cuts.value), cuts, bool(prices)
        require(member(o, "sum", "integer", place) == self.sum, f"{place}.sum: not {self.sum}")
        for e, most in limit.items():
            require(cuts.left(*f.edge[e]) <= most, f"{place}: the cuts over edge {e} add up to more than its weight")
        for v in piece:
            require(opt.ends == "counts" or v not in opt.allowed or cuts.held(v) <= self.end_price,
                    f"{place}: the cuts round node {v} add up to more than the end price")
        self.up = self.round_up(p, edges, bool(prices))
        extra = [e for e in edges if p.extra[e]]
        total = sum(f.exact[e] for e in edges)
        weight = self.weight_bound(2 * p.compared(c))
        require(weight <= join, f"{place}: proves a weight of {weight}, but the plan's extra passes have {join}")
        closes = weight == join and all(self.weight[e] for e in extra)
        self.optimal = not extra or closes and self.own - self.base - self.as_length(join) <= TOLERANCE * total

    def read_prices(self, o, place, piece, opt):
        stated = member(o, "place_prices", "list", place, default=[])
        require(not stated or opt.objective != "symmetry", f"{place}.place_prices: not with objective symmetry")
        counts = opt.ends == "counts"
        integers(stated, place + ".place_prices", 0, INT64, (len(piece) if counts else 1) if stated else 0)
        return stated and (dict(zip(piece, stated)) if counts else {None: stated[0]})

    def priced(self, p, prices, piece, edges, limit, odd, place):
        """Fills the edges' limits, changes the parity of nodes; gives what the bound has beside the cuts."""
        f, o = p.frame, p.options
        price = lambda v: prices[v] if None not in prices else prices[None]
        total = sum(price(v) * o.count.get(v, 0) for v in piece) if o.ends == "counts" else price(0) * 2 * o.least
        for e in edges:
            held = places(f, o, e, o.need[e], price)
            room = None if o.most[e] is None else o.most[e] - o.need[e]
            cost = lambda x: math.floor(self.weight[e] * self.unit * x - (places(f, o, e, o.need[e] + x, price) - held))
            require(room is not None or cost(2) >= 0, f"{place}: edge {e} is cheaper the more it is passed")
            even, odd_passes = [0], [1]
            if room is not None:
                even, odd_passes = [0, room // 2 * 2], [1, room - 1 + room % 2] if room else []
            least = min(map(cost, even))
            if odd_passes:
                other = min(map(cost, odd_passes))
                limit[e] = abs(other - least)
                if other < least:
                    odd ^= set(f.edge[e])
                least = min(least, other)
            total += least - math.ceil(held)
        return total

    def round_up(self, p, edges, priced):
        """Of every edge with room: what its weight is more than its length, its weight as a length, the most extra passes it may need."""
        o, rows = p.options, []
        for e in edges:
            room = None if o.most[e] is None else o.most[e] - o.need[e]
            most = max(1, 2 * o.cords - o.need[e]) if priced else 1
            stretched = self.weight[e] / self.scale
            if room != 0:
                rows.append((max(Fraction(0), stretched - p.frame.exact[e]), stretched, most if room is None else min(room, most)))
        return rows

    def as_length(self, weight):
        """Length that extra passes of at least this weight have at least."""
        part = Fraction(1, 2 * 10**9)
        one = weight / self.scale - sum(up * most for up, _, most in self.up)
        two = (1 - part) * weight / self.scale - sum(max(Fraction(0), up - part * whole) * most for up, whole, most in self.up)
        return max(Fraction(0), one, two)

    def weight_bound(self, ends):
        """Weight that extra passes with so many ends have at least."""
        return max(0, -(-(self.sum + self.constant - ends * self.end_price) // self.unit))

    def least(self, ends):
        return self.base + self.as_length(self.weight_bound(ends))


def check_claim(claim, own, optimal, bound, more, place, gap=True):
    """status, lower_bound and gap of a claim, against what is proved. more: added to a value for what its rounding is a part of."""
    status = choice(claim, "status", place, ("optimal", "bound"))
    stated = Fraction(member(claim, "lower_bound", "number", place, 0))
    slack, proved = TOLERANCE * (more + own), own if optimal else bound
    require(bound <= own + slack, f"{place}: the proof gives {float(bound):.12g}, which is more than the plan's own {float(own):.12g}")
    require(status == "bound" or optimal, f"{place}: not optimal, {float(bound):.12g} is proved")
    require(stated <= proved + TOLERANCE * (more + proved), f"{place}.lower_bound: stated {float(stated):.12g}, but {float(bound):.12g} is proved")
    require(status == "bound" or abs(stated - own) <= slack, f"{place}.lower_bound: not the plan's own")
    if gap:
        value = (own - stated) / own if own else 0
        require(abs(Fraction(member(claim, "gap", "number", place, 0)) - value) <= TOLERANCE, f"{place}.gap: not {float(value)}")


def check_length(p):
    """The claim about length, if there is one."""
    claim = member(p.proof, "length", "object", "proof", default=None)
    if claim is None:
        return
    place = "proof.length"
    known(claim, "status lower_bound slack gap method certificate proof walks", place)
    if p.options.tube:
        require("walks" not in claim, f"{place}.walks: not with tube joints")
        require("certificate" not in claim, f"{place}.certificate: not with tube joints")
        p.tied = Tied(p, member(claim, "proof", "object", place))
        optimal, bound = p.tied.optimal, p.tied.least
    else:
        require("proof" not in claim, f"{place}.proof: only with tube joints")
        stated = member(claim, "certificate", "list", place)
        require(len(stated) == len(p.frame.pieces), f"{place}.certificate: not one per component")
        p.certificate = []
        for c, o in enumerate(stated):
            require(type(o) is dict, f"{place}.certificate[{c}]: not an object")
            p.certificate.append(Certificate(p, o, f"{place}.certificate[{c}]", c))
        least = [c.own if c.optimal else c.least(2 * p.compared(i)) for i, c in enumerate(p.certificate)]
        optimal = all(c.optimal for c in p.certificate)
        if not optimal:
            few = few_edges_lengths(p)
            if "walks" in claim:
                few = [max(x, y) for x, y in zip(few, pulled_lengths(p, member(claim, "walks", "object", place), place + ".walks"))]
            optimal = all(c.optimal or x >= c.own * (1 - TOLERANCE) for c, x in zip(p.certificate, few))
            least = [max(x, y) for x, y in zip(least, few)]
        bound = sum(least)
    check_claim(claim, p.length, optimal, bound, 0, place)
    p.least = p.length if optimal else bound
    p.least_stated = min(p.least, Fraction(claim["lower_bound"])) if p.options.old_pull else p.least
    slack = p.options.slack if p.options.objective == "tortuosity" else None
    if "slack" in claim:
        choice(claim, "slack", place, ("open",))
    elif slack is not None:
        longest = (1 + Fraction(slack)) * (1 + 2 * TOLERANCE) * p.least
        require(p.length <= longest, f"{place}: the cords are longer than {float(longest)}, the slack above what is proved")


# ---- proofs of turning ----


class Model:
    """Columns of the turns, extra passes, ends and U-turns of plans, and the least price that multipliers prove."""

    def __init__(self, p, cords, most_passes, free, cut=None):
        """cut: what a turn counts for at most; solid cords turn back at every node then, and connections are never counted exactly."""
        f, o = self.f, self.o = p.frame, p.options
        self.cut = cut
        weigh = lambda a, b: 0 if free else min(math.floor(Fraction(o.price(f, a, b)) * UNIT), math.inf if cut is None else cut)
        self.tied, self.need = o.tube, o.need
        self.cords = cords  # closed cords of a component at most
        self.most_passes = most_passes
        self.most = [max(o.need[e], min(most_passes, o.most[e] or most_passes)) for e in range(f.m)]
        if o.ends == "counts":
            self.group, self.supply = list(range(f.n)), [(o.count.get(v, 0),) * 2 for v in range(f.n)]
        else:
            self.group = f.component
            self.supply = [(0, 0) if o.ends == "closed" else (2 * o.least, 2 * o.cords)] * len(f.pieces)
        self.weight, self.high = {}, {}
        for v in range(f.n):
            for i, a in enumerate(f.at[v]):
                for b in f.at[v][i + 1:]:
                    self.weight[a, b] = weigh(a, b)
                    self.high[a, b] = min(self.most[a >> 1], self.most[b >> 1])
                if v in o.allowed:
                    self.weight[a, -1] = 0
                    self.high[a, -1] = min(self.most[a >> 1], self.supply[self.group[v]][1])
            for a in f.at[v] if (len(f.at[v]) == 1 or cut is not None) and not self.tied else []:
                self.weight[a, a] = weigh(a, a)
                self.high[a, a] = self.most[a >> 1] // 2
        self.rate = Fraction(0)
        if free:
            self.rate = min(Fraction(f.m) / sum(f.exact), Fraction(5000) / max(f.exact))
        for e in range(f.m):
            self.weight[2 * e, 2 * e + 1] = math.floor(f.exact[e] * self.rate * UNIT)
            self.high[2 * e, 2 * e + 1] = self.most[e] - o.need[e]
        self.limit = None  # of the length of all cords

    def column(self, a, b):
        key = (a, b) if (a, b) in self.weight else (b, a)
        require(key in self.weight, f"no column of half-edges {a} and {b}")
        return key

    def open(self, c):
        """Have the cords of component c ends?"""
        return any(self.supply[k][0] for k in {self.group[v] for v in self.f.pieces[c]})

    def component(self, h):
        """Of a half-edge, or of the ends that are counted together, which come after these."""
        f = self.f
        return f.component[f.tail(h)] if h < 2 * f.m else f.component[self.group.index(h - 2 * f.m)]

    def component_of(self, halves):
        """The last place of a list by components for those of several."""
        components = {self.component(h) for h in halves}
        return components.pop() if len(components) == 1 else -1

    def apply(self, dual, place):
        """Reduced costs of the columns; what multipliers give in every component, last in several at once; and what the limit on the
        length takes."""
        f, cost, gain, taken = self.f, dict(self.weight), [0] * (len(self.f.pieces) + 1), 0
        for h, y in enumerate(dual["potentials"]):
            gain[self.component(h)] += y * self.need[h >> 1]
            cost[h & ~1, h | 1] += y
        for a, b in cost:
            if b < 0:
                cost[a, b] -= dual["potentials"][a] + dual["ends"][self.group[f.tail(a)]]
            elif a >> 1 != b >> 1 or a == b:
                cost[a, b] -= dual["potentials"][a] + dual["potentials"][b]
        for k, (y, (low, high)) in enumerate(zip(dual["ends"], self.supply)):
            if y:
                gain[self.component(2 * f.m + k)] += y * (low if y >= 0 else high)
        if dual["length"] and self.limit is not None:
            longest = max(f.exact)
            for e in range(f.m):
                cost[2 * e, 2 * e + 1] += Fraction(dual["length"]) * self.length[e] / longest
            base = sum(x * n for x, n in zip(f.exact, self.need))
            taken = Fraction(dual["length"]) * max(Fraction(0), Fraction(self.limit) - base) / longest
        for row in dual["odd_sets"]:
            gain[self.component_of(row["members"])] += self.odd_set(row, cost, place)
        for row in dual["groups"]:
            gain[self.component_of(2 * e for e in row["members"])] += self.a_group(row, cost, place)
        for row in dual["partitions"]:
            self.partition(row, cost, gain, place)
        for row in dual["junctions"]:
            gain[f.component[row["node"]]] += self.junction(row, cost, place)
        for row in dual["ranks"]:
            self.partition(row, cost, gain, place, True)
        for v in range(f.n) if dual["ranks"] else []:
            if self.ranked(v):
                gain[f.component[v]] += self.ranked_node(v, dual["ranks"], cost)
        return cost, gain, taken

    def widest(self, cost, gain, taken):
        """Least values of the cords of every component, and last of all, with columns in their widest limits. Rows of several components
        take only off the prices in one of them, and the limit on the length holds for each."""
        value = [x - taken for x in gain[:-1]] + [sum(gain) - taken]
        for c, x in cost.items():
            value[self.component(c[0])] += min(0, x * self.high[c])
            value[-1] += min(0, x * self.high[c])
        return value

    def ranked(self, v):
        """Are connections at the node counted exactly?"""
        return 2 <= len(self.f.at[v]) <= 8 and self.cut is None

    def ranked_node(self, v, ranks, cost):
        """Least price of turns at the node, with one at every half-edge at least, less what the connections gain. Turns of a price
        below 0 are counted as columns and are free here; what the others cost is in this minimum only."""
        at, states = self.f.at[v], {}
        start = tuple(range(len(at)))
        prices = {(a, b): max(cost[at[a], at[b]], 0) for a in start for b in start if a < b}
        for a, b in prices:
            cost[at[a], at[b]] = min(cost[at[a], at[b]], 0)
        states[start] = 0  # the least price of turns that join half-edges so; every half-edge has the lowest of its part
        for (a, b), price in prices.items():
            for parts, least in list(states.items()):
                low, high = sorted((parts[a], parts[b]))
                joined = tuple(low if x == high else x for x in parts)
                states[joined] = min(states.get(joined, least + price), least + price)
        best = None
        for parts, least in states.items():
            if any(parts.count(x) == 1 for x in parts):
                continue
            for row in ranks:
                least -= row["value"] * self.rank([row["blocks"][h >> 1] for h in at], parts)
            best = least if best is None else min(best, least)
        return best

    @staticmethod
    def rank(blocks, parts):
        """Connections between blocks: blocks less the sets that they fall into when every part is joined."""
        sets = {frozenset(i for i, x in enumerate(blocks) if x == b) for b in blocks}
        n = len(sets)
        for part in set(parts):
            members = frozenset(i for i, x in enumerate(parts) if x == part)
            touched = {s for s in sets if s & members}
            sets = sets - touched | {frozenset().union(*touched)}
        return n - len(sets)

    def odd_set(self, row, cost, place):
        f, y, inside = self.f, row["value"], set(row["members"])
        parity = sum(self.supply[h - 2 * f.m][0] if h >= 2 * f.m else self.need[h >> 1] for h in inside)
        require(parity % 2, f"{place}: an odd set is even")
        touched = set()
        for h in inside:
            if h < 2 * f.m:
                touched.add((h & ~1, h | 1))
                touched.add((h, -1))
                touched.update((min(h, g), max(h, g)) for g in f.at[f.tail(h)])
            else:
                touched.update((g, -1) for v in range(f.n) if self.group[v] == h - 2 * f.m for g in f.at[v])
        for a, b in touched:
            other = b if b >= 0 else 2 * f.m + self.group[f.tail(a)]
            if (a, b) in cost and (a in inside) != (other in inside):
                cost[a, b] -= y
        return y

    def a_group(self, row, cost, place):
        f, y, inside = self.f, row["value"], set(row["members"])
        good = False
        for c in {f.component[f.edge[e][0]] for e in inside}:
            good |= self.open(c) or self.cords == 1 and not inside.issuperset(f.edges_of(c))
        require(good, f"{place}: a group need not be connected to the rest")
        for a, b in cost:
            if b < 0 and a >> 1 in inside or b >= 0 and (a >> 1 in inside) != (b >> 1 in inside):
                cost[a, b] -= y
        return 2 * y

    def blocks(self, blocks, place):
        require(set(blocks) == set(range(max(blocks) + 1)), f"{place}: a block number is not in use")

    def partition(self, row, cost, gain, place, rank=False):
        f, y, block = self.f, row["value"], row["blocks"]
        require(self.o.ends == "closed", f"{place}: partitions are for closed cords")
        self.blocks(block, place)
        owner = {}
        for e in range(f.m):
            c = f.component[f.edge[e][0]]
            require(owner.setdefault(block[e], c) == c, f"{place}: a block in two components")
        for c in range(len(f.pieces)):
            gain[c] += y * max(0, list(owner.values()).count(c) - self.cords)
        for v in range(f.n):
            here = {block[h >> 1] for h in f.at[v]}
            if len(here) < 2 or rank and self.ranked(v):
                continue
            share = Fraction(y * (len(here) - 1), len(here))
            odd = {b for b in here if sum(self.need[h >> 1] for h in f.at[v] if block[h >> 1] == b) % 2}
            for i, a in enumerate(f.at[v]):
                if block[a >> 1] not in odd:
                    cost[a & ~1, a | 1] -= share / 2
                for b in f.at[v][i + 1:]:
                    if block[a >> 1] != block[b >> 1]:
                        cost[a, b] -= share
            gain[f.component[v]] -= share / 2 * len(odd)

    def junction(self, row, cost, place):
        require(self.tied, f"{place}: junctions are for tube joints")
        at = self.f.at[row["node"]]
        require(len(row["blocks"]) == len(at), f"{place}: not a block per edge at the node")
        self.blocks(row["blocks"], place)
        for i, a in enumerate(at):
            for j in range(i):
                if row["blocks"][i] != row["blocks"][j]:
                    cost[at[j], a] -= row["value"]
        return row["value"] * max(row["blocks"])

    def read_dual(self, o, place):
        f = self.f
        require(type(o) is dict, f"{place}: not an object")
        known(o, "potentials ends length odd_sets groups partitions ranks junctions", place)
        dual = {"length": member(o, "length", "integer", place, 0)}
        for key, n in (("potentials", 2 * f.m), ("ends", len(self.supply))):
            dual[key] = integers(member(o, key, "list", place), f"{place}.{key}", -INT64, INT64, n)
        for key, list_name, most, n in (("odd_sets", "members", 2 * f.m + len(self.supply) - 1, None), ("groups", "members", f.m - 1, None),
                                        ("partitions", "blocks", f.m - 1, f.m), ("ranks", "blocks", f.m - 1, f.m),
                                        ("junctions", "blocks", f.m - 1, None)):
            dual[key] = member(o, key, "list", place, default=[] if key in ("ranks", "junctions") else ...)
            for i, row in enumerate(dual[key]):
                name = f"{place}.{key}[{i}]"
                require(type(row) is dict, f"{name}: not an object")
                known(row, f"value {list_name}" + " node" * (key == "junctions"), name)
                member(row, "value", "integer", name, 0)
                values = integers(member(row, list_name, "list", name), f"{name}.{list_name}", 0, most, n)
                require(list_name == "blocks" or all(a < b for a, b in zip(values, values[1:])), f"{name}.members: not ascending")
                require(values, f"{name}: empty")
                if key == "junctions":
                    member(row, "node", "integer", name, 0, f.n - 1)
        require(dual["length"] <= 2**58 and all(abs(y) <= 2**58 for y in dual["potentials"] + dual["ends"]), f"{place}: a multiplier is too large")
        sums = {key: sum(row["value"] for row in dual[key]) for key in ("odd_sets", "groups", "partitions", "junctions", "ranks")}
        require(sums.pop("ranks") <= 2**58 and sum(sums.values()) <= 2**61, f"{place}: multipliers add up to too much")
        return dual

    def read(self, o, place):
        """The proof, checked for shape; bound() adds it up."""
        known(o, "tree multipliers walks symmetries", place)
        images = member(o, "symmetries", "list", place, default=[])
        self.symmetries = [self.symmetry(x, f"{place}.symmetries[{i}]") for i, x in enumerate(images)]
        self.lower()
        self.walks = member(o, "walks", "object", place, default=None)
        self.tree = member(o, "tree", "list", place)
        duals = member(o, "multipliers", "list", place)
        self.duals = [self.read_dual(d, f"{place}.multipliers[{i}]") for i, d in enumerate(duals)]
        require(self.tree, f"{place}.tree: empty")
        parents = [0] * len(self.tree)
        for i, node in enumerate(self.tree):
            name = f"{place}.tree[{i}]"
            require(type(node) is dict, f"{name}: not an object")
            if "multipliers" in node:
                known(node, "multipliers", name)
                member(node, "multipliers", "integer", name, 0, len(duals) - 1)
                continue
            known(node, "low high a b value orbit", name)
            integers(member(node, "orbit", "list", name, default=[]), f"{name}.orbit", 0, len(images) - 1)
            for key in ("low", "high"):
                parents[member(node, key, "integer", name, i + 1, len(self.tree) - 1)] += 1
            a, b = (member(node, key, "integer", name, low, 2 * self.f.m - 1) for key, low in (("a", 0), ("b", -1)))
            self.column(a, b)
            member(node, "value", "integer", name, 0, 10**6)
        require(parents == [0] + [1] * (len(self.tree) - 1), f"{place}.tree: not a tree")

    def symmetry(self, image, place):
        """A map of half-edges, as a list of the images of all columns' keys; it must map plans to plans."""
        f = self.f
        integers(image, place, 0, 2 * f.m - 1, f.m)
        g = [image[h >> 1] ^ h & 1 for h in range(2 * f.m)]
        require(len(set(g)) == 2 * f.m, f"{place}: an edge is the image of two")
        for v in range(f.n):
            tails = {f.tail(g[h]) for h in f.at[v]}
            require(len(tails) <= 1, f"{place}: the edges of node {v} come apart")
            require(not tails or len(f.at[v]) == len(f.at[tails.pop()]), f"{place}: node {v} is joined with another")
            for h in f.at[v]:
                require(self.supply[self.group[v]] == self.supply[self.group[f.tail(g[h])]], f"{place}: other numbers of cord ends")
        require(all(self.need[e] == self.need[image[e] >> 1] and self.most[e] == self.most[image[e] >> 1] for e in range(f.m)),
                f"{place}: other numbers of passes")
        out = {}
        for a, b in self.weight:
            out[a, b] = self.column(g[a], g[b] if b >= 0 else b)
            require(self.high[a, b] == self.high[out[a, b]], f"{place}: a column of another limit")
        return out

    def lower(self):
        """Prices of columns, and lengths under the limit, become the least of all their images under any symmetries in turn."""
        self.length = list(self.f.exact)
        changed = bool(self.symmetries)
        while changed:
            changed = False
            for image in self.symmetries:
                for c, d in image.items():
                    least = min(self.weight[c], self.weight[d])
                    changed |= self.weight[c] > least or self.weight[d] > least
                    self.weight[c] = self.weight[d] = least
                    if c[0] ^ 1 == c[1]:
                        short = min(self.length[c[0] >> 1], self.length[d[0] >> 1])
                        changed |= self.length[c[0] >> 1] > short or self.length[d[0] >> 1] > short
                        self.length[c[0] >> 1] = self.length[d[0] >> 1] = short

    def bound(self, place):
        """Least price over all leaves, in units of 1 / UNIT; None if no plan is left. bound_of: of the cords of every component."""
        applied = []
        for i, dual in enumerate(self.duals):
            cost, gain, taken = self.apply(dual, f"{place}.multipliers[{i}]")
            applied.append((cost, self.widest(cost, gain, taken)))
        best, stack = None, [(0, 0, ())]
        box, log, moved = {}, [], len(applied) <= len(self.weight)  # limits of the columns; what they were; are values kept up to date?
        values = [list(widest) for _, widest in applied] if moved else []

        def set_limits(c, limits):
            low, high = limits or (0, self.high[c])
            least, most = box.get(c, (0, self.high[c]))
            for (cost, _), value in zip(applied, values):
                more = min(cost[c] * low, cost[c] * high) - min(cost[c] * least, cost[c] * most)
                value[self.component(c[0])] += more
                value[-1] += more
            if limits:
                box[c] = limits
            else:
                del box[c]

        while stack:
            i, changes, narrower = stack.pop()
            while len(log) > changes:
                set_limits(*log.pop())
            for c, low, high in narrower:
                least, most = box.get(c, (0, self.high[c]))
                log.append((c, box.get(c)))
                set_limits(c, (max(low, least), min(high, most)))
            node = self.tree[i]
            if "multipliers" in node:
                k = node["multipliers"]
                if moved:
                    value = values[k]
                else:
                    cost, value = applied[k][0], list(applied[k][1])
                    for c, (low, high) in box.items():
                        more = min(cost[c] * low, cost[c] * high) - min(0, cost[c] * self.high[c])
                        value[self.component(c[0])] += more
                        value[-1] += more
                best = list(value) if best is None else list(map(min, best, value))
                continue
            c = self.column(node["a"], node["b"])
            orbit = [self.symmetries[k] for k in node.get("orbit", [])]
            for image in orbit:
                kept = all(box.get(image[d], (0, self.high[d])) == limits for d, limits in box.items())
                require(kept, f"{place}.tree[{i}].orbit: a symmetry does not keep what was decided before")
            low, high = box.get(c, (0, self.high[c]))
            below = [(d, 0, node["value"]) for d in {c, *(image[c] for image in orbit)}]
            if all(box.get(d, (0, 0))[0] <= most for d, _, most in below):
                stack.append((node["low"], len(log), below))
            if max(low, node["value"] + 1) <= high:
                stack.append((node["high"], len(log), [(c, node["value"] + 1, high)]))
        if best is None:
            return None
        self.bound_of = [max(0, x) for x in best[:-1]]
        self.share_bounds()
        return best[-1]

    def share_bounds(self):
        """The leaves are about a plan or one of its images: what is proved of a component is so of those that are its images."""
        changed = len(self.bound_of) > 1
        while changed:
            changed = False
            for image in self.symmetries:
                for c, d in image.items():
                    a, b = self.component(c[0]), self.component(d[0])
                    least = min(self.bound_of[a], self.bound_of[b])
                    changed |= self.bound_of[a] > least or self.bound_of[b] > least
                    self.bound_of[a] = self.bound_of[b] = least


class Tied:
    """The proof of least length with tube joints."""

    def __init__(self, p, o):
        f, place = p.frame, "proof.length.proof"
        degree = max(map(len, f.at))
        cords = 1 if p.options.ends == "closed" else p.options.cords
        self.base = sum(f.exact[e] * n for e, n in enumerate(p.options.need))
        self.model = Model(p, cords, 2 * (max(p.options.need) + degree + 2 * cords) + 1, True)
        self.model.read(o, place)
        require(self.model.walks is None, f"{place}.walks: of the cord that turns most only")
        self.least = self.least_length(place)
        require(self.least is not None, f"{place}: proves that there is no plan")
        self.optimal = p.length - self.least <= TOLERANCE * p.length

    def least_length(self, place):
        bound = self.model.bound(place)
        return None if bound is None else self.base + max(Fraction(0), Fraction(bound) / UNIT / self.model.rate)


# ---- components of few edges ----

FEW_EDGES, FEW_SUMMED, FEW_SETS, FEW_SHARED, PULL_SETS = 18, 12, 2**18, 400000, 2**16
ONE, LEAST = {}, {}  # tables that were made before, and what they came to


class FewEdges:
    """Least cost of a cord that passes at least each set of a component's edges, as far as it is no more than enough, and of several
    cords."""

    def __init__(self, p, edges, turning, enough):
        f, o = p.frame, p.options
        self.n, self.enough = len(edges), enough if len(edges) > FEW_SUMMED else math.inf
        key = (repr(f.xyz), repr(f.edge), repr(f.length), tuple(edges), turning and o.cost, o.ends, tuple(sorted(o.allowed)), o.tube,
               self.enough)
        if key not in ONE:
            ONE[key] = self.table(f, o, edges, turning)
        self.key, self.one = key, ONE[key]

    def table(self, f, o, edges, turning):
        index = {e: i for i, e in enumerate(edges)}
        halves = [h for e in edges for h in (2 * e, 2 * e + 1)]
        first = {h: 0.0 if turning else f.length[h >> 1] for h in halves}
        steps = {}  # of half-edge h, passed away from its node
        for h in halves:
            v = f.tail(h ^ 1)
            onward = [g for g in f.at[v] if g != h ^ 1 or not (o.tube or turning and len(f.at[v]) > 1)]
            steps[h] = [(g, o.price(f, h ^ 1, g) if turning else f.length[g >> 1]) for g in onward]
        one = [math.inf] * (1 << self.n)
        closed = o.ends == "closed"
        for i, e in enumerate(edges if closed else [None]):
            starts = [2 * e] if closed else [h for h in halves if f.tail(h) in o.allowed]
            cost = [None] * (1 << self.n)
            closing = {h: y for h in halves for g, y in steps[h] if closed and g == 2 * e}
            for h in starts:
                at = 1 << index[h >> 1]
                cost[at] = cost[at] or {}
                cost[at][h] = first[h]
            for mask in range(1, 1 << self.n):
                if cost[mask] is not None:
                    self.settle(mask, cost, steps, index, i if closed else 0)
                    for h, x in cost[mask].items():
                        if closed:
                            x += closing.get(h, math.inf) - first[2 * e]
                        elif f.tail(h ^ 1) not in o.allowed:
                            continue
                        if x <= self.enough:
                            one[mask] = min(one[mask], x)
                    cost[mask] = None
        for i in range(self.n if self.n <= FEW_SUMMED else 0):
            for mask in range(1 << self.n):
                if not mask >> i & 1:
                    one[mask] = min(one[mask], one[mask | 1 << i])
        return one

    def keep_to(self, limit):
        self.key, self.one = (self.key, limit), [x if x <= limit else math.inf for x in self.one]

    def settle(self, mask, cost, steps, index, lowest):
        here = cost[mask]
        queue = [(x, h) for h, x in here.items()]
        heapq.heapify(queue)
        while queue:
            x, h = heapq.heappop(queue)
            if x > here[h]:
                continue
            for g, y in steps[h]:
                i = index[g >> 1]
                if i < lowest or x + y > self.enough:
                    continue
                to = here
                if not mask >> i & 1:
                    if cost[mask | 1 << i] is None:
                        cost[mask | 1 << i] = {}
                    to = cost[mask | 1 << i]
                if x + y < to.get(g, math.inf):
                    to[g] = x + y
                    if to is here:
                        heapq.heappush(queue, (x + y, g))

    def least(self, low, high, dearest):
        """Of low .. high cords, the cheapest number: of the dearest cord, or in all."""
        key = (self.key, low, min(high, max(low, self.n + 1)), dearest)  # more only cost more
        if key not in LEAST:
            LEAST[key] = self.cheapest(low, high, dearest)
        return LEAST[key]

    def cheapest(self, low, high, dearest):
        join = max if dearest else (lambda a, b: a + b)
        best, result = self.one, math.inf
        for n in range(1, min(high, self.n) + 1):
            if n > 1:
                best = self.one_more(best, join)
            if low <= n:
                result = min(result, best[-1])
        if high > self.n:  # more cords than edges: the others may be any
            n = max(low, self.n + 1)
            result = min(result, max(best[-1], self.one[0]) if dearest else best[-1] + (n - self.n) * self.one[0])
        return result

    def suffice(self, cords):
        """Do so many cords, each no dearer than enough, pass everything? Unions of sets are counted by sums over all parts."""
        fields, half = 1 << self.n, min(cords, self.n) // 2
        low = []  # of every edge, 64 bits for each set without it
        for i in range(self.n):
            bits, span = (1 << (64 << i)) - 1, 2 << i
            while span < fields:
                bits |= bits << 64 * span
                span *= 2
            low.append(bits)

        def packed(some):
            return int.from_bytes(struct.pack(f"<{fields}Q", *some), "little")

        def unpacked(number):
            return struct.unpack(f"<{fields}Q", number.to_bytes(8 * fields, "little"))

        def sums(number, sign):
            for i, bits in enumerate(low):
                number += sign * ((number & bits) << (64 << i))
            return number

        def union(a, b):
            pairs = [x * y for x, y in zip(unpacked(sums(a, 1)), unpacked(sums(b, 1)))]
            return packed([int(x > 0) for x in unpacked(sums(packed(pairs), -1))])

        some = packed([int(x <= self.enough) for x in self.one])
        for i, bits in enumerate(low):  # and all their parts
            some |= some >> (64 << i) & bits
        if half == 0:
            return some >> 64 * (fields - 1) > 0
        first = some
        for bit in bin(half)[3:]:
            first = union(first, first)
            if bit == "1":
                first = union(first, some)
        others = union(first, some) if min(cords, self.n) % 2 else first
        return any(x and y for x, y in zip(unpacked(first), reversed(unpacked(others))))

    def dearest(self, low, high):
        """Least cost of the dearest of low .. high cords; of many edges, enough if it is that or more, else 0."""
        if self.n <= FEW_SUMMED:
            return self.least(low, high, True)
        key = (self.key, high)
        if key not in LEAST:
            LEAST[key] = 0 if self.suffice(high) else self.enough
        return LEAST[key]

    def fit(self, cords, limit):
        """Is none of so many cords above the limit, which is enough?"""
        return self.least(cords, cords, True) <= limit if self.n <= FEW_SUMMED else self.suffice(cords)

    def one_more(self, best, join):
        more = [join(self.one[0], best[0])]
        for mask in range(1, 1 << self.n):
            lowest = mask & -mask
            rest = part = mask ^ lowest
            least = math.inf
            while True:
                least = min(least, join(self.one[part | lowest], best[rest ^ part]))
                if not part:
                    break
                part = (part - 1) & rest
            more.append(least)
        return more


    def different(self, each, low, high):
        """In all, of low .. high cords of which every edge is passed by so many different ones; 0: one, or too many sets."""
        if each == 1 or (2 * each + 1) ** self.n > FEW_SHARED:
            return 0
        stride = [(each + 1) ** i for i in range(self.n)]
        offset = [sum(s for i, s in enumerate(stride) if mask >> i & 1) for mask in range(1 << self.n)]
        needs = (each + 1) ** self.n
        holds = [sum(1 << i for i, s in enumerate(stride) if x // s % (each + 1)) for x in range(needs)]
        best, result = [0.0] + [math.inf] * (needs - 1), math.inf
        for n in range(1, min(high, each * self.n) + 1):
            more = [self.one[0] + best[0]]
            for x in range(1, needs):
                lowest = holds[x] & -holds[x]
                rest = part = holds[x] ^ lowest
                least = math.inf
                while True:
                    least = min(least, self.one[part | lowest] + best[x - offset[part | lowest]])
                    if not part:
                        break
                    part = (part - 1) & rest
                more.append(least)
            best = more
            if low <= n:
                result = min(result, best[-1])
        if high > each * self.n:
            result = min(result, best[-1] + (max(low, each * self.n + 1) - each * self.n) * self.one[0])
        return result

    def different_fit(self, each, cords, limit):
        """Can so many cords, none dearer than the limit, pass every edge so that it has each different ones? Also where that would
        take long to find out."""
        key = (self.key, each, cords, limit)
        if key not in LEAST:
            LEAST[key] = Different(self.n, [x <= limit for x in self.one]).fit([(1 << self.n) - 1] * each, cords)
        return LEAST[key]


class Different:
    """Sets of n edges, of which a cord passes one at most. Needs are a list of sets: the edges that lack one cord at least, two .."""

    ROUNDS, WORK = 200, 2**29

    def __init__(self, n, fits):
        self.n, self.fits, self.failed, self.work = n, fits, {}, 0
        for bit in (1 << i for i in range(n)):
            for mask in range(1 << n):
                if not mask & bit and fits[mask | bit]:
                    fits[mask] = True
        bits = [1 << i for i in range(n)]
        self.most = [m for m in range(1, 1 << n) if fits[m] and not any(fits[m | b] for b in bits if not m & b)]
        self.holding = [[m for m in self.most if m & b] for b in bits]
        self.weigh()

    def weights(self, of):
        """Of sets, in two halves."""
        tables = [[0], [0]]
        for i, w in enumerate(of):
            tables[2 * i >= self.n] += [w + x for x in tables[2 * i >= self.n]]
        return tables, (self.n + 1) // 2

    def weight(self, mask):
        return self.low[mask & self.half] + self.high[mask >> self.shift]

    def weigh(self):
        """Whole weights of edges: what one cord passes weighs self.heaviest at most. Edges of the heaviest set get lighter, again and again."""
        of, best = [10**6] * self.n, None
        for _ in range(self.ROUNDS):
            (low, high), shift = self.weights(of)
            half = (1 << shift) - 1
            most, mask = max(((low[m & half] + high[m >> shift], m) for m in self.most), default=(0, 0))
            if most and (best is None or sum(of) * best[1] > best[0] * most):
                best = sum(of), most, low, high
            of = [w - w // 12 if mask >> i & 1 else w for i, w in enumerate(of)]
        self.shift, self.half = shift, half
        _, self.heaviest, self.low, self.high = best or (0, 0, low, high)

    def fit(self, needs, cords):
        some, all_of_them = needs[0], needs[cords - 1] if cords <= len(needs) else 0
        if not some:
            return True
        if len(needs) > cords and needs[cords] or not self.fits[all_of_them]:
            return False
        if sum(map(self.weight, needs)) > cords * self.heaviest:
            return False
        key = tuple(needs)
        if cords == 1 or self.work > self.WORK:
            return True
        if self.failed.get(key, 0) >= cords:
            return False
        self.work += len(self.most)
        shortest = min((self.holding[i] for i in range(self.n) if some >> i & 1), key=len)
        for mask in {m & some for m in shortest if not all_of_them & ~m}:
            left = [a & ~(mask & ~b) for a, b in zip(needs, needs[1:] + [0])]
            if self.fit(left, cords - 1):
                return True
        self.failed[key] = cords
        return False


def few_edges(p, turning, enough):
    """Per component: its FewEdges, or None if it is large; and the least and the most cords it may have."""
    f, o, sets, found = p.frame, p.options, FEW_SETS, []
    for c in range(len(f.pieces)):
        number = sum(o.count.get(v, 0) for v in f.pieces[c]) // 2 if o.ends == "counts" else None
        low, high = (o.least, o.cords) if number is None else (number, number)
        edges = f.edges_of(c)
        small = high > 1 and len(edges) <= FEW_EDGES and 1 << len(edges) <= sets
        sets -= (1 << len(edges)) if small else 0
        found.append((FewEdges(p, edges, turning, enough) if small else None, low, high))
    return found


def few_edges_bounds(p, turning, enough):
    """(Least cost in all, 0 if a component is large; of the dearest cord of any that is not, which is known up to enough)"""
    rows = few_edges(p, turning, float(enough) * (1 - 5e-10))
    dearest = max([t.dearest(low, high) for t, low, high in rows if t], default=0)
    summed = all(t and t.n <= FEW_SUMMED for t, _, _ in rows)
    total = sum(t.least(low, high, False) for t, low, high in rows) if summed else 0
    return Fraction(min(total, sys.float_info.max)), Fraction(min(dearest, sys.float_info.max))


SHORT_EDGES, SHORT_STATES = 128, 2**19 + 2**16


class ShortCords:
    """Sets of edges that cords no longer than the limit pass, found from walk to walk, and whether so many of them are enough."""

    WORK = 2**24

    def __init__(self, p, limit):
        f, o = p.frame, p.options
        self.f, self.limit, self.states, self.failed, self.work = f, limit, 0, {}, 0
        self.closed, self.allowed = o.ends == "closed", o.allowed
        self.half = [min(f.length[h >> 1] for h in f.at[v]) / 2 if f.at[v] else 0 for v in range(f.n)]
        found = set()
        for first in range(f.n) if self.closed else [None]:
            self.walks(first, found)
        self.most = self.largest(found)
        self.holding = [[s for s in self.most if s >> e & 1] for e in range(f.m)]
        self.weigh(sum(1 << e for e in range(f.m) if o.need[e]))

    def back(self, first):
        """From every node the shortest way to where a cord may end, through nodes from the first on."""
        f = self.f
        way = {v: 0.0 for v in ([first] if self.closed else self.allowed)}
        queue = [(0.0, v) for v in way]
        heapq.heapify(queue)
        while queue:
            x, v = heapq.heappop(queue)
            for h in f.at[v] if x <= way[v] else []:
                w, y = f.tail(h ^ 1), x + f.length[h >> 1]
                if (first is None or w >= first) and y < way.get(w, math.inf):
                    way[w] = y
                    heapq.heappush(queue, (y, w))
        return way

    def walks(self, first, found):
        f, way = self.f, self.back(first)
        steps = {v: [(f.tail(h ^ 1), 1 << (h >> 1), f.length[h >> 1]) for h in f.at[v] if f.tail(h ^ 1) in way] for v in way}
        ends = {first} if self.closed else self.allowed
        best = {(0, v): 0.0 for v in ends}
        queue = [(0.0, 0, v) for v in ends]
        heapq.heapify(queue)
        while queue:
            x, passed, v = heapq.heappop(queue)
            if x > best[passed, v]:
                continue
            if passed and v in ends:
                found.add(passed)
            for w, bit, y in steps[v]:
                y += x
                key = (passed | bit, w)
                if y + way[w] <= self.limit and y < best.get(key, math.inf):
                    best[key] = y
                    heapq.heappush(queue, (y, *key))
                    require(self.states + len(best) <= SHORT_STATES, "proof.cords.sets: more sets than are tried")
        self.states += len(best)

    def largest(self, sets):
        """Those that are part of no other."""
        kept, holding = [], [[] for _ in range(self.f.m)]
        for s in sorted(sets, key=lambda s: -bin(s).count("1")):
            edges = [e for e in range(self.f.m) if s >> e & 1]
            if not any(s & ~t == 0 for t in min((holding[e] for e in edges), key=len)):
                kept.append(s)
                for e in edges:
                    holding[e].append(s)
        return kept

    def weigh(self, needed):
        """Whole weights of edges by their bytes: no set weighs more than self.heaviest, and what is needed weighs much."""
        of, best = [2**30 if needed >> e & 1 else 0 for e in range(self.f.m)], None
        self.needed, self.bytes = needed, (self.f.m + 7) // 8
        for _ in range(max(20, min(300, 2**20 // (len(self.most) + 1)))):
            self.tables = self.tables_of(of)
            most, s = max(((self.weight(s), s) for s in self.most), default=(0, 0))
            if most and (best is None or self.weight(needed) * best[1] > best[0] * most):
                best = self.weight(needed), most, self.tables
            of = [w - w // 24 if s >> e & 1 else w for e, w in enumerate(of)]
        _, self.heaviest, self.tables = best or (0, 0, self.tables)

    def tables_of(self, of):
        tables = []
        for i in range(self.bytes):
            table = [0]
            for w in of[8 * i : 8 * i + 8]:
                table += [w + x for x in table]
            tables.append(table)
        return tables

    def weight(self, s):
        return sum(t[b] for t, b in zip(self.tables, s.to_bytes(self.bytes, "little")))

    def least(self, lacking, cords):
        """No so many cords over these edges are shorter together: odd nodes without an end need half of their shortest edge more."""
        f, total, odd = self.f, 0.0, {}
        while lacking:
            e = (lacking & -lacking).bit_length() - 1
            lacking &= lacking - 1
            total += f.length[e]
            for v in f.edge[e]:
                odd[v] = not odd.get(v)
        free = []
        for v in (v for v, is_odd in odd.items() if is_odd):
            if not self.closed and v in self.allowed:
                free.append(self.half[v])
            else:
                total += self.half[v]
        return total + sum(sorted(free)[: max(0, len(free) - 2 * cords)])

    def too_much(self, lacking, cords):
        self.work += 1
        return self.weight(lacking) > cords * self.heaviest or self.least(lacking, cords) > cords * self.limit * (1 + 1e-9)

    def fit(self, lacking, cords):
        """Do so many cords pass what is lacking? Also where that would take long to find out."""
        if not lacking or self.work > self.WORK:
            return True
        if cords == 0 or self.failed.get(lacking, 0) >= cords:
            return False
        shortest = min((self.holding[e] for e in range(self.f.m) if lacking >> e & 1), key=len)
        if cords == 1:
            return any(lacking & ~s == 0 for s in shortest)
        kept = []
        for s in sorted({s & lacking for s in shortest}, key=lambda s: -bin(s).count("1")):
            if not self.too_much(lacking & ~s, cords - 1) and not any(s & ~t == 0 for t in kept):
                kept.append(s)
                if self.fit(lacking & ~s, cords - 1):
                    return True
        self.failed[lacking] = cords
        return False


def short_cords_longest(p, claimed):
    """The longest cord, up to a claimed bound, where all sets of edges that cords below it pass are too few."""
    f, o, limit = p.frame, p.options, float(claimed) * (1 - 5e-10)
    cords = ShortCords(p, limit)
    number = min(o.cords, f.m)
    fit = not cords.too_much(cords.needed, number) and cords.fit(cords.needed, number)
    return Fraction(0 if fit else limit)


def few_edges_longest(p, enough):
    """The least of the longest cord in any component that is not large, which is known up to enough."""
    each = p.different()
    if each == 1:
        return few_edges_bounds(p, False, enough)[1]
    limit = float(enough) * (1 - 5e-10)
    small = [(t, high) for t, _, high in few_edges(p, False, limit) if t]
    return Fraction(limit if any(not t.different_fit(each, high, limit) for t, high in small) else 0)


def few_edges_lengths(p):
    """Per component the least length of its cords together, of as many as length is compared with; 0 if it is large."""
    f, o, sets, found = p.frame, p.options, FEW_SETS, []
    for c in range(len(f.pieces)):
        number = sum(o.count.get(v, 0) for v in f.pieces[c]) // 2 if o.ends == "counts" else None
        low, high = (o.least, p.compared(c)) if number is None else (number, number)
        edges = f.edges_of(c)
        small = high > 1 and len(edges) <= FEW_SUMMED and 1 << len(edges) <= sets
        sets -= (1 << len(edges)) if small else 0
        table = FewEdges(p, edges, False, math.inf) if small else None
        if table and o.max_length is not None:
            table.keep_to(o.max_length * (1 + 2 * TOLERANCE))
        each = p.different()
        least = (table.different(each, low, high) or table.least(low, high, False)) if small else 0
        found.append(Fraction(min(least, sys.float_info.max)))
    return found


# ---- proof.cords ----


def longest_unit(f):
    """The longest step that every edge is a whole number of, within 1e-10 of its length; 0 if it takes over 1000 to the longest."""
    longest = max(f.length)
    for k in range(1, 1001):
        unit = longest / k
        if all(abs(x - round(x / unit) * unit) <= 1e-10 * x for x in f.length):
            return Fraction(longest) / k
    return 0


def forced_detour(p, enough):
    """Shortest cord over the worst edge; stops at one that is enough."""
    f, o = p.frame, p.options
    best = 0.0
    way = f.distances(o.allowed)
    for e in sorted(range(f.m), key=lambda e: -f.length[e]):
        a, b = f.edge[e]
        if p.closing:
            back = f.distances([a], e, f.length[e])[b]
            value = f.length[e] + (f.length[e] if back is None else back)
        else:
            value = way[a] + f.length[e] + way[b]
        best = max(best, value)
        if best >= enough:
            break
    return Fraction(best)


def ways_in(p, c):
    """The longest cord of component c by cuts round where cords may end, which each crosses twice that passes anything beyond."""
    f, o, certificate = p.frame, p.options, p.certificate[c]
    if o.ends not in ("any", "feet", "nodes") or certificate.has_prices:
        return Fraction(0)
    cuts, nodes, edges, number = certificate.cuts, f.pieces[c], f.edges_of(c), o.cords
    inside = [set() for _ in cuts.value]
    for v, held in cuts.sets.items():
        for i in held.values():
            while i is not None:
                inside[i].add(v)
                i = cuts.parent[i]
    left = [sum(1 << e for e in edges if (f.edge[e][0] in s) != (f.edge[e][1] in s)) for s in inside]
    rounding = max((Fraction(1, 2) / (f.exact[e] * certificate.scale) for e in edges if f.exact[e]), default=Fraction(0))
    unit = certificate.unit * certificate.scale * (1 + rounding)
    way, best = f.distances([v for v in nodes if v in o.allowed]), Fraction(0)
    if any(way[v] is None for v in nodes):
        return best
    base = sum(o.need[e] * f.exact[e] for e in edges)
    for radius in sorted({way[v] for v in nodes})[:-1]:
        crossing = [e for e in edges if min(way[v] for v in f.edge[e]) <= radius < max(way[v] for v in f.edge[e])]
        mask, shortest = sum(1 << e for e in crossing), min(f.exact[e] for e in crossing)
        value = sum(y for y, edges_left in zip(cuts.value, left) if not edges_left & mask) - 2 * number * certificate.end_price
        more = max(0, 2 * number - sum(o.need[e] for e in crossing)) * shortest
        every = (base + max(0, value) / unit + more) / number
        beyond = sum(o.need[e] * f.exact[e] for e in edges if min(way[v] for v in f.edge[e]) > radius)
        best = max(best, min(every, beyond / (number - 1) + 2 * shortest) if number > 1 else every)
    return best


def fewest_cords(p):
    """Cords in all components together that no plan has fewer of."""
    o, limit, total, each = p.options, Fraction(p.options.max_length) * (1 + 2 * TOLERANCE), 0, p.different()
    for c, (table, j, _) in enumerate(few_edges(p, False, float(limit))):
        base = sum(p.frame.exact[e] * o.need[e] for e in p.frame.edges_of(c))
        while j < p.per_piece[c]:
            least = base if o.tube or "length" not in p.proof else p.certificate[c].least(2 * j)
            if least <= j * limit and (table is None or (table.fit(j, limit) if each == 1 else table.different_fit(each, j, float(limit)))):
                break
            j += 1
        total += j
    return fewest_tied(p, total, limit) if o.tube and "length" in p.proof else total


def fewest_tied(p, j, limit):
    """The same from j on by the proof of tied length."""
    j = max(math.ceil(p.tied.least / limit), j)
    if p.options.ends in ("any", "feet", "nodes") and len(p.frame.pieces) == 1:
        supply = p.tied.model.supply
        while j < p.per_piece[0]:
            p.tied.model.supply = [(2 * j, 2 * j)]
            least = p.tied.least_length("proof.length.proof")
            if least is not None and least <= j * limit:
                break
            j += 1
        p.tied.model.supply = supply
    return j


def check_cords_claim(p):
    claim = member(p.proof, "cords", "object", "proof", default=None)
    if claim is None:
        return
    o, place = p.options, "proof.cords"
    known(claim, "longest fewest walks sets", place)
    stated = member(claim, "longest", "object", place)
    known(stated, "status length lower_bound", place + ".longest")
    own = max(p.lengths)
    p.close(member(stated, "length", "number", place + ".longest"), own, own, place + ".longest.length")
    cords = [o.cords if o.ends != "counts" else p.per_piece[c] for c in range(len(p.frame.pieces))]
    if o.tube or "length" not in p.proof:
        least = [sum(p.frame.exact[e] * o.need[e] for e in p.frame.edges_of(c)) for c in range(len(p.frame.pieces))]
        bound = max(x / k for x, k in zip(least, cords))
        if "length" in p.proof:
            bound = max(bound, p.tied.least / (len(p.cords) if o.ends == "counts" else o.cords * len(p.frame.pieces)))
    else:
        rows = [(c, p.compared(i) < o.cords and o.ends not in ("closed", "counts")) for i, c in enumerate(p.certificate)]
        least = [c.own if c.optimal and not fewer else c.least(2 * o.cords) for c, fewer in rows]
        bound = max(x / k for x, k in zip(least, cords))
    if "walks" in claim:
        walks = Walks(p)
        walks.read(member(claim, "walks", "object", place), place + ".walks")
        here = walks.component
        bound = max(bound, walks.bound(cords[here], least[here] * (1 - Fraction(1, 10**11)), place + ".walks"))
    claimed = member(stated, "lower_bound", "number", place + ".longest")
    bound = max(bound, forced_detour(p, claimed))
    bound = max(bound, few_edges_longest(p, claimed))
    if bound < claimed and not o.tube and "length" in p.proof:
        bound = max([bound] + [ways_in(p, c) for c in range(len(p.frame.pieces))])
    require(claim.get("sets", True) is True, f"{place}.sets: not true")
    of_one = len(p.frame.pieces) == 1 and p.frame.m <= SHORT_EDGES and not o.tube and o.ends != "counts"
    require("sets" not in claim or of_one, f"{place}.sets: not of this framework")
    if "sets" in claim and bound < claimed * (1 - TOLERANCE):
        bound = max(bound, short_cords_longest(p, claimed))
    unit = longest_unit(p.frame)
    if unit:
        bound = max(bound, unit * math.ceil(bound / unit * (1 - 2 * TOLERANCE)))
    optimal = own - bound <= TOLERANCE * own
    check_claim(stated, own, optimal, bound, 0, place + ".longest", gap=False)
    if "fewest" in claim:
        require(o.max_length is not None and o.least < o.cords, f"{place}.fewest: without max_length and a range of cords")
        stated, place = member(claim, "fewest", "object", place), place + ".fewest"
        known(stated, "status lower_bound", place)
        number, fewest = member(stated, "lower_bound", "integer", place, 1), fewest_cords(p)
        require(number <= fewest <= len(p.cords), f"{place}.lower_bound: stated {number}, but {fewest} is proved")
        status = choice(stated, "status", place, ("optimal", "bound"))
        require(status == "bound" or number == len(p.cords), f"{place}.status: not optimal")


# ---- proof.turning ----


class Walks:
    """Walks that cords can be, over half-edges with the weights of their turns, or over nodes with the lengths of edges."""

    def __init__(self, p, weight=None):
        self.f, self.need, self.closed, self.turning = p.frame, p.options.need, p.closing, weight is not None
        f = p.frame
        count = p.options.count if p.options.ends == "counts" else None
        self.open = set() if p.closing else {v for v in p.options.allowed if count is None or count[v]}
        self.bits = 44 if self.turning else 44 - math.frexp(max(f.length))[1]
        self.after = {}  # place: (the next one, half-edge passed, what counts in units, what it is worth)
        if self.turning:  # half-edge d, passed away from its node
            for d in range(2 * f.m):
                keys = [(h, weight.get((min(h, d ^ 1), max(h, d ^ 1)))) for h in f.at[f.tail(d ^ 1)]]
                self.after[d] = [(h, h, w, w) for h, w in keys if w is not None]
        else:
            size = [x * Fraction(2) ** self.bits for x in f.exact]
            for v in range(f.n):
                self.after[v] = [(f.tail(h ^ 1), h, math.floor(size[h >> 1]), math.ceil(size[h >> 1])) for h in f.at[v]]

    def node_of(self, place):
        return self.f.tail(place ^ 1) if self.turning else place

    def forced(self, pulled=False):
        """The most that the turns over a single edge come to, from end to end; pulled: up to the edge from one end."""
        least = {d: 0 for d in range(2 * self.f.m) if self.f.tail(d ^ 1) in self.open}
        queue, done = [(0, d) for d in least], set()
        heapq.heapify(queue)
        while queue:
            total, d = heapq.heappop(queue)
            if d in done:
                continue
            done.add(d)
            for h in self.f.at[self.f.tail(d)]:  # walks that arrive over h and go on along d
                here = next((total + w for to, _, w, _ in self.after[h ^ 1] if to == d), None)
                if here is not None and here < least.get(h ^ 1, math.inf):
                    least[h ^ 1] = here
                    heapq.heappush(queue, (here, h ^ 1))
        if pulled:
            return max([min(least.get(h, math.inf) for h in (2 * e, 2 * e + 1)) for e in range(self.f.m) if {2 * e, 2 * e + 1} & least.keys()], default=0)
        return max([least[2 * e] + least[2 * e + 1] for e in range(self.f.m) if 2 * e in least and 2 * e + 1 in least], default=0)

    def read(self, o, place):
        known(o, "unit units edges nodes memory " + ("turning" if self.turning else "length"), place)
        self.unit = member(o, "unit", "integer", place, 1, 2**63 - 1)
        self.units = member(o, "units", "integer", place, 0, 2**31 - 3)
        self.all = member(o, "turning" if self.turning else "length", "integer", place, 0, 2**56)
        self.edge = integers(member(o, "edges", "list", place), place + ".edges", 0, 2**63 - 1, self.f.m)
        self.node = integers(member(o, "nodes", "list", place), place + ".nodes", 0, 2**63 - 1, self.f.n)
        self.memory = [
            (member(x, "edge", "integer", place + ".memory", 0, self.f.m - 1), member(x, "places", "list", place + ".memory"))
            for x in member(o, "memory", "list", place, default=[])
        ]
        priced = [self.f.component[self.f.edge[e][0]] for e in range(self.f.m) if self.edge[e]]
        priced += [self.f.component[v] for v in range(self.f.n) if self.node[v]]
        self.component = priced[0] if priced else 0
        require(set(priced) <= {self.component}, f"{place}: prices in two components")

    def check(self, place):
        """The prices are allowed; the places of their component in the order of the recursion."""
        f, c = self.f, self.component
        require(self.closed or not self.open.isdisjoint(f.pieces[c]), f"{place}: of a component without cord ends")
        require(all(not y or self.needed_at(v) % 2 for v, y in enumerate(self.node)), f"{place}.nodes: an even number")
        require(Fraction(4 * UNIT, self.unit) <= 10**9, f"{place}.unit: out of range")
        places = [x for x in self.after if f.component[self.node_of(x)] == c]
        largest = max(self.passing(h) + self.node[f.tail(h ^ 1)] for h in range(2 * f.m))
        require((largest + self.worth(4 * UNIT)) * (self.units + 2) * (len(places) + 1) < 2**61, f"{place}: prices too large")
        order = next((x for x in (self.sort(places, units) for units in (512, 64, 8, 1)) if x), None)
        require(order, f"{place}.unit: steps below one unit go round in a circle")
        return order

    def remember(self, places, starts, place):
        """Where walks remember: self.remembered[x] are the edges that they remember at place x. Returns the sets of edges that a
        walk may know of at each place, if walks start at places with the edges that they have passed there."""
        f = self.f
        self.remembered = {x: set() for x in places}
        ascending = lambda row: all(a < b for a, b in zip(row, row[1:]))
        require(ascending([e for e, _ in self.memory]), f"{place}.memory: edges are not ascending")
        for e, at in self.memory:
            integers(at, place + ".memory.places", 0, 2**31)
            require(f.component[f.edge[e][0]] == self.component and self.need[e] == 1, f"{place}.memory: edge {e}")
            require(ascending(at) and set(at) <= self.remembered.keys(), f"{place}.memory: places of edge {e}")
            for x in at:
                self.remembered[x].add(e)
        require(all(len(row) <= 16 for row in self.remembered.values()), f"{place}.memory: too much")
        require(sum(2 ** len(row) for row in self.remembered.values()) <= 2**20, f"{place}.memory: too much")
        sets = {x: set() for x in places}
        queue = [(x, frozenset(passed) & self.remembered[x]) for x, passed in starts]
        while queue:
            x, known_edges = queue.pop()
            if known_edges not in sets[x]:
                sets[x].add(known_edges)
                queue.extend((to, self.then(known_edges, h, to)) for to, h, _, _ in self.after[x])
        return sets

    def then(self, known_edges, h, to):
        """What a walk remembers at the place that it comes to over h."""
        return (known_edges | {h >> 1}) & self.remembered[to]

    def needed_at(self, v):
        return sum(self.need[h >> 1] for h in self.f.at[v])

    def sort(self, places, units):
        """Places after those that they step to in fewer units; None: such steps go round in a circle."""
        order, state = [], {}
        for root in places:
            stack = [(root, False)]
            while stack:
                d, done = stack.pop()
                if done:
                    state[d] = 2
                    order.append(d)
                elif d not in state:
                    state[d] = 1
                    stack.append((d, True))
                    after = [to for to, _, w, _ in self.after[d] if w < self.unit * units]
                    if any(state.get(to) == 1 for to in after):
                        return None
                    stack.extend((to, False) for to in after)
        return order

    def passing(self, h):
        return self.edge[h >> 1] + self.node[self.f.tail(h)] + self.node[self.f.tail(h ^ 1)]

    def first_passing(self, h, known_edges):
        return self.passing(h) - (self.edge[h >> 1] if h >> 1 in known_edges else 0)

    def worth(self, weight):
        return -(-self.all * weight // UNIT)

    def most(self, order, steps, ends, longest):
        """A function of a place and of units: the most that walks with so many left are worth from there, or None. Units that are near
        `units` are known last. So many are found at once as steps back in the order have at least."""
        number, nothing = {x: i for i, x in enumerate(order)}, -(2**80)  # worths are below 2^62
        moves = [[(number[to], u, y) for to, u, y in steps[x] if u <= self.units and to in number] for x in order]
        width = min([u for i, row in enumerate(moves) for to, u, _ in row if to >= i] + [1024])
        values, lowest = [[nothing] * longest for _ in order], -longest  # of each place, from so many units on
        for r in range(0, self.units + 1, width):
            n = min(width, self.units + 1 - r)
            for i, (x, row) in enumerate(zip(order, moves)):
                more = [[v + y for v in values[to][r - u - lowest : r - u - lowest + n]] for to, u, y in row]
                more.append([ends.get(x, nothing)] * n)
                values[i] += map(max, *more) if len(more) > 1 else more[0]
            spare = r + n - lowest - longest
            if spare > 2 * longest + 4096:
                lowest += spare
                for row in values:
                    del row[:spare]

        def value(x, r):
            found = values[number[x]][r - lowest] if x in number else nothing
            return found if found > nothing / 2 else None

        return value

    @staticmethod
    def bound_work(work, values, place):
        """The page's limits, and what is done here in the time, which is known beforehand."""
        require(work <= 5e8 and values <= 2**26, f"{place}.units: too many")
        if bounded and work > MOST_STEPS:
            raise NotChecked(f"{place} takes {work:.3g} steps (--time-limit allows more)")

    def all_worth(self, order, steps, ends, longest):
        """Of the walks with all units left, from each place that has any."""
        rows = self.most(order, steps, ends, longest)
        return {x: rows(x, self.units) for x in order if rows(x, self.units) is not None}

    def best(self, firsts, rows):
        values = [(rows(to, self.units - u), y) for to, u, y in firsts if u <= self.units]
        return max([x + y for x, y in values if x is not None], default=0)

    def bound(self, cords, least, place):
        """Price of the turns of some cord, or its length, if any plan has at most so many and all theirs is so much at least."""
        f, places = self.f, self.check(place)
        homes = sorted(x for x in places if not self.turning or x % 2 == 0) if self.closed else []
        if self.closed:
            starts = [(x, []) for x in homes]
        elif self.turning:
            starts = [(d, [d >> 1]) for d in places if f.tail(d) in self.open]
        else:
            starts = [(to, [h >> 1]) for v in places if v in self.open for to, h, _, _ in self.after[v]]
        sets = self.remember(places, starts, place)
        order = [(x, known_edges) for x in places for known_edges in sorted(sets[x], key=sorted)]
        steps = {
            (x, known_edges): [
                ((to, self.then(known_edges, h, to)), w // self.unit, self.first_passing(h, known_edges) + self.worth(y))
                for to, h, w, y in self.after[x]
            ]
            for x, known_edges in order
        }
        longest = min(self.units, max((u for row in steps.values() for _, u, _ in row), default=0)) + 1
        work = self.units * sum(map(len, steps.values())) * (len(homes) if self.closed else 1)
        self.bound_work(work, longest * len(order), place)
        most = 0
        if self.closed:  # those that begin at the lowest of their edges, or nodes
            group = (lambda x: x >> 1) if self.turning else (lambda x: x)
            for home in homes:
                here = [x for x in order if group(x[0]) >= group(home)]
                ends = {x: 0 for x in here if x[0] == home}
                most = max(most, self.best(steps[home, frozenset()], self.most(here, steps, ends, longest)))
        else:
            ends = {x: self.node[self.node_of(x[0])] for x in order if self.node_of(x[0]) in self.open}
            nothing = frozenset()
            if self.turning:
                firsts = [
                    ((d, self.then(nothing, d, d)), 0, self.passing(d) + self.node[f.tail(d)]) for d in places if f.tail(d) in self.open
                ]
            else:
                firsts = [
                    ((to, self.then(nothing, h, to)), w // self.unit, self.passing(h) + self.worth(y) + self.node[v])
                    for v in places
                    if v in self.open
                    for to, h, w, y in self.after[v]
                ]
            most = self.best(firsts, self.most(order, steps, ends, longest))
        needed = self.all * math.floor(least * Fraction(2) ** self.bits) // UNIT
        needed += sum(y * self.need[e] for e, y in enumerate(self.edge))
        needed += sum(y * (self.needed_at(v) + 1) for v, y in enumerate(self.node) if y)
        require(needed > cords * max(0, most), f"{place}: the prices prove nothing")
        return self.unit * (self.units + 1) / Fraction(2) ** self.bits


class PulledWalks(Walks):
    """Walks with a turn before and after which they turn by no more than a pull overcomes, less their lengths.
    any_pull: by no more than their prices say."""

    def __init__(self, p, any_pull=False):
        f = p.frame
        super().__init__(p, {(h, k): math.floor(f.angle(h, k) * UNIT) for h in range(2 * f.m) for k in f.at[f.tail(h)] if h <= k})
        o = p.options
        self.turning_allowed = -1
        if any_pull:
            return
        require(o.max_pull is not None and o.mu > 0, "proof.length.walks: there is no limit on the pull")
        limit = math.log(o.max_pull)
        self.turning_allowed = math.floor(math.ldexp((limit + 2e-9 * (1 + limit)) / o.mu, 44))

    def read(self, o, place):
        known(o, "unit units bits edges nodes memory", place)
        stated = dict(o, turning=0)
        self.bits_of_length = member(stated, "bits", "integer", place, 0, 44)
        del stated["bits"]
        super().read(stated, place)
        require((self.units + 1) * self.unit > self.turning_allowed, f"{place}.units: leave out cords that are within the pull")
        scale = Fraction(2) ** (self.bits_of_length - math.frexp(max(self.f.length))[1])
        self.cost = [math.floor(x * scale) for x in self.f.exact]
        self.scale = scale

    def passing(self, h):
        return super().passing(h) - self.cost[h >> 1]

    def length(self, cords, place):
        """Of so many cords at most, together."""
        places, f, best = self.check(place), self.f, 0
        begins = set(f.pieces[self.component]) & (set(range(f.n)) if self.closed else self.open)
        sets = self.remember(places, [(d, [d >> 1]) for d in places if f.tail(d) in begins], place)
        order = [(x, known_edges) for x in places for known_edges in sorted(sets[x], key=sorted)]
        steps = {
            (x, known_edges): [
                ((to, self.then(known_edges, h, to)), w // self.unit, self.first_passing(h, known_edges)) for to, h, w, _ in self.after[x]
            ]
            for x, known_edges in order
        }
        longest = min(self.units, max((u for row in steps.values() for _, u, _ in row), default=0)) + 1
        homes = [[v] for v in f.pieces[self.component]] if self.closed else [self.open & set(f.pieces[self.component])]
        self.bound_work(self.units * sum(map(len, steps.values())) * len(homes), longest * len(order), place)
        for home in map(set, homes):
            more = (lambda v: 0) if self.closed else (lambda v: self.node[v])
            ends = {x: more(self.node_of(x[0])) for x in order if self.node_of(x[0]) in home}
            after = self.all_worth(order, steps, ends, longest)
            # over the cut turn, or to an end without one
            over = {x: max((after[to] + y for to, _, y in steps[x] if to in after), default=-math.inf) for x in order}
            after = {x: max(y, ends.get(x, -math.inf)) for x, y in over.items() if x in ends or y > -math.inf}
            before = self.all_worth(order, steps, after, longest)
            firsts = [(d, (d, self.then(frozenset(), d, d))) for d in places if f.tail(d) in home]
            best = max([best] + [before[x] + self.passing(d) + more(f.tail(d)) for d, x in firsts if x in before])
        needed = sum(y * self.need[e] for e, y in enumerate(self.edge))
        needed += sum(y * (self.needed_at(v) + 1) for v, y in enumerate(self.node) if y)
        return max(Fraction(0), (needed - cords * best) / self.scale)


def pulled_lengths(p, o, place):
    """What prices of walks prove of the length of each component."""
    walks = PulledWalks(p)
    walks.read(o, place)
    here = walks.component
    cords = p.options.cords if p.options.ends != "counts" else p.per_piece[here]
    return [walks.length(cords, place) if c == here else 0 for c in range(len(p.frame.pieces))]


def largest_bound(p, model, number, place):
    """Of the price of the cord that turns most, from the number of cords, each component's least, single edges and the prices of
    walks."""
    walks = Walks(p, model.weight)
    bound = Fraction(walks.forced(), UNIT)
    for c, least in enumerate(model.bound_of):
        ends = sum(p.options.count.get(v, 0) for v in p.frame.pieces[c]) if p.options.ends == "counts" else 0
        bound = max(bound, Fraction(least) / UNIT / (ends // 2 or number))
    if model.walks is not None:
        walks.read(model.walks, place + ".walks")
        bound = max(bound, walks.bound(number, Fraction(model.bound_of[walks.component]) / UNIT, place + ".walks"))
    return bound


def all_half_turns(f, tube):
    """Weights of the turns from half-edges of one node to others, and but for tubes back into them."""
    return {(h, k): math.floor(f.angle(h, k) * UNIT) for h in range(2 * f.m) for k in f.at[f.tail(h)] if h <= k and (h < k or not tube)}


def least_pull(p, model, largest, place):
    """Of the turning on a side of some cord's cut turn, whatever the pull. largest: what is claimed of it."""
    f, o = p.frame, p.options
    walks = Walks(p, all_half_turns(f, o.tube))
    bound = Fraction(walks.forced(True), UNIT)
    cut = member(largest, "cut", "integer", place + ".largest", 1, math.floor(math.pi * UNIT), default=None)
    if cut is not None:
        other = Model(p, o.cords, model.most_passes, False, cut)
        other.limit = model.limit
        other.read({k: v for k, v in p.proof["turning"]["proof"].items() if k != "walks"}, place + ".proof")
        all_turns = other.bound(place + ".proof")
        require(all_turns is not None, f"{place}.proof: proves that there is no plan")
        bound = max(bound, (each_turns(p, other, o.cords, all_turns) - (2 if p.closing else 1) * Fraction(cut, UNIT)) / 2)
    if model.walks is not None:
        require(not o.tube, f"{place}.proof.walks: with tube joints none are within a pull")
        walks = PulledWalks(p, True)
        walks.read(model.walks, place + ".proof.walks")
        require(walks.bits_of_length == 0, f"{place}.proof.walks.bits: not 0")
        count = o.cords if o.ends != "counts" else p.per_piece[walks.component]
        require(walks.length(count, place + ".proof.walks") > 0, f"{place}.proof.walks: their prices prove nothing")
        bound = max(bound, Fraction(walks.unit) * (walks.units + 1) / UNIT)
    stated = member(largest, "lower_bound", "number", place + ".largest", 0)
    stated -= 5e-10 * (1 + stated)
    least = [sum(o.count.get(v, 0) for v in piece) // 2 if o.ends == "counts" else o.cords for piece in f.pieces]
    if stated > bound and few_within(p, o, stated, least, [x + 1 for x in least]) != least:
        bound = Fraction(stated)
    return bound


def each_turns(p, model, cords, all_turns):
    """What some cord turns at least."""
    f, o = p.frame, p.options
    each = max(Fraction(0), Fraction(all_turns) / UNIT) / (cords * len(f.pieces))
    for c, least in enumerate(model.bound_of):
        counted = sum(o.count.get(v, 0) for v in f.pieces[c]) // 2 if o.ends == "counts" else cords
        each = max(each, Fraction(least) / UNIT / (counted or cords))
    return each


def common_angle(f, most):
    """The largest of pi, pi / 2 .. pi / 180 of which every turn is a multiple, within 9e-10 / most; None if there is none."""
    parts, tolerance, seen = list(range(1, 181)), 9e-10 / most, set()
    for halves in f.at:
        for a, b in itertools.combinations(halves, 2):
            angle = f.angle(a, b)
            if angle in seen:
                continue
            seen.add(angle)
            parts = [k for k in parts if abs(angle * k / math.pi - round(angle * k / math.pi)) * math.pi / k <= tolerance]
            if not parts:
                return None
    return math.pi / parts[0]


def round_up(angle, edges, bound):
    rounding = 0.95e-9 * edges
    if angle is None or bound <= rounding:
        return bound
    return max(bound, Fraction(math.ceil((float(bound) - rounding) / angle) * angle - rounding))


def check_turning(p):
    claim = member(p.proof, "turning", "object", "proof", default=None)
    if claim is None:
        return
    f, o, place = p.frame, p.options, "proof.turning"
    require(o.tour == "least", f"{place}: only with objective tortuosity and tour least")
    known(claim, "status price lower_bound gap pairing_bound largest most_passes length_limit method proof", place)
    for cord in p.cords:
        for a, b in cord.turns(p.closing):
            require(a != b or len(f.at[f.tail(a)]) == 1, f"cord {cord.id}: turns back at node {f.tail(a)}, which has other edges")
    prices = [math.fsum(o.price(f, a, b) for a, b in cord.turns(p.closing)) for cord in p.cords]
    price = math.fsum(prices)
    most = member(claim, "most_passes", "integer", place, max(max(p.passes), 4 * max(o.need) + 4), 10**6)
    limit = None if claim.get("length_limit", 0) is None else member(claim, "length_limit", "number", place, 0)
    require(limit is None or o.slack is not None, f"{place}.length_limit: the options allow any length")
    require(limit is None or "length" in p.proof, f"{place}.length_limit: without a proof of the least length")
    needed = None if limit is None else (1 + Fraction(o.slack)) * p.least_stated
    require(limit is None or limit >= needed * (1 - TOLERANCE / 200), f"{place}.length_limit: the options allow up to {float(needed or 0)}")
    require(limit is None or p.length <= Fraction(limit) * (1 + TOLERANCE), f"{place}.length_limit: the plan is longer")
    model = Model(p, o.cords, most, False)
    model.limit = None if limit is None else max(Fraction(limit), p.length) * (1 + TOLERANCE / 100)
    model.read(member(claim, "proof", "object", place), place + ".proof")
    bound = model.bound(place + ".proof")
    require(bound is not None, f"{place}.proof: proves that there is no plan")
    bound = max(Fraction(0), Fraction(bound) / UNIT)
    largest = member(claim, "largest", "object", place)
    # A turning that is said to be the least has to be proved up to the rounding of prices, any other bound to its last digits.
    rounding = 2 * TOLERANCE * Fraction(math.pi if o.cost == "angle" else 1) * sum(min(x, 2 * n) for x, n in zip(p.passes, o.need))
    stated = member(largest, "lower_bound", "number", place + ".largest", 0)
    is_least = member(largest, "status", "text", place + ".largest") == "optimal"
    few, few_largest = few_edges_bounds(p, True, max(0, stated - 0.9 * float(rounding)) if is_least else stated)
    bound = max(bound, few)
    if p.closing and o.cost in ("angle", "sine"):  # Fenchel 1929; sin(x / 2) >= x / pi
        bound = max(bound, Fraction(2 * math.pi if o.cost == "angle" else 2) * o.least * len(f.pieces))
    whole = common_angle(f, most) if o.cost == "angle" else None
    bound = round_up(whole, f.m, bound)
    optimal = price - bound <= rounding
    scale = 1 + price
    p.close(member(claim, "price", "number", place), price, scale, place + ".price")
    check_claim(claim, Fraction(price), optimal, bound, 1, place)
    member(claim, "pairing_bound", "number", place, 0, default=0)  # of older plans: no longer verified
    known(largest, "status price lower_bound" + (" cut" if o.pull else ""), place + ".largest")
    dearest = max(larger_part([f.angle(a, b) for a, b in cord.turns(False)], False) for cord in p.cords) if o.pull else max(prices)
    p.close(member(largest, "price", "number", place + ".largest"), dearest, scale, place + ".largest.price")
    number = len(p.cords) if o.ends == "counts" else o.cords * len(f.pieces)
    each = len(p.cords) if o.ends == "counts" else o.cords
    if o.pull:
        share = least_pull(p, model, largest, place)
    else:
        share = max((Fraction(price) if optimal else bound) / number, few_largest, largest_bound(p, model, each, place + ".proof"))
    share = round_up(whole, f.m, share)
    require(share - dearest <= rounding, f"{place}: some cord is proved to turn by {float(share)}, more than any does")
    attained = dearest - share <= rounding
    check_claim(largest, Fraction(dearest), attained, share, 1, place + ".largest", gap=False)


# ---- proof.pull ----


def partings(before, old):
    """Sums that are left to both ends of a cord, parted at every turn, which counts for neither; in plans of version 1 at every pass."""
    return [(x, before[-1] - y) for x, y in zip(before, before if old or len(before) == 1 else before[1:])]


def larger_part(turns, old):
    return min(map(max, partings(list(itertools.accumulate(turns, initial=0.0)), old)))


def check_pulls(p):
    """Pulled at both ends: the larger part of the turning, parted where that is least."""
    o = p.options
    for cord in p.cords if o.max_pull is not None else []:
        part = larger_part([p.frame.angle(a, b) for a, b in cord.turns(False)], o.old_pull)
        require(o.mu * part <= math.log(o.max_pull) + 1e-9 * (1 + math.log(o.max_pull)), f"cord {cord.id}: needs more than options.max_pull")


def few_within(p, o, allowed, least, enough):
    """Per component the number of cords, from the least on and up to enough, that pass all its edges, if turns on either side of a cut
    turn come to so much at most. The least where that is not known."""
    f, looked, found = p.frame, 0, list(least)
    for c in range(len(f.pieces)):
        edges = f.edges_of(c)
        if len(edges) > FEW_SUMMED or not edges:
            continue
        looked += (1 << len(edges)) * (len(f.pieces[c]) if o.ends == "closed" else 1)
        if looked > PULL_SETS:
            break
        some = set()  # of edges that a cord passes
        for homes in [{v} for v in f.pieces[c]] if o.ends == "closed" else [set(o.allowed) & set(f.pieces[c])]:
            reached = {}
            for (mask, h), turned in sides(f, o.tube, edges, homes, allowed).items():
                reached.setdefault(f.tail(h ^ 1), set()).add(mask)
            for masks in map(largest, reached.values()):
                some.update(a | b for a in masks for b in masks)
        everything, unions, number = (1 << len(edges)) - 1, {0}, 0
        some = largest(some)
        while number < enough[c] and (number < found[c] or everything not in unions):
            more = set(largest({a | b for a in unions for b in some}.union(unions)))
            number = enough[c] if more == unions and everything not in more else number + 1  # no number passes more
            unions = more
        found[c] = max(found[c], number)
    return found


def largest(masks):
    """The sets that are in no other."""
    found = []
    for mask in sorted(masks, key=lambda x: -x.bit_count() if hasattr(x, "bit_count") else -bin(x).count("1")):
        if not any(mask & ~x == 0 for x in found):
            found.append(mask)
    return found


def sides(f, tube, edges, homes, allowed):
    """Least turning of the walks from some nodes that pass just a set of edges, and last a half-edge: not more than allowed."""
    index = {e: i for i, e in enumerate(edges)}
    best, queue = {}, [(0.0, 1 << index[h >> 1], h) for v in homes for h in f.at[v]]
    onward = {h: [(g, f.angle(h ^ 1, g)) for g in f.at[f.tail(h ^ 1)] if g != h ^ 1 or not tube] for e in edges for h in (2 * e, 2 * e + 1)}
    heapq.heapify(queue)
    while queue:
        turned, mask, h = heapq.heappop(queue)
        if (mask, h) in best:
            continue
        best[mask, h] = turned
        for g, angle in onward[h]:
            there = mask | 1 << index[g >> 1], g
            if turned + angle <= allowed and there not in best:
                heapq.heappush(queue, (turned + angle, *there))
    return best


def too_few(p, claim, place):
    """Some cord turns too much if there are so few in every component."""
    o, f = copy.copy(p.options), p.frame
    cords = member(claim, "excluded", "integer", place, 1, 1000)
    o.least, o.cords, o.cost = min(o.least, cords), cords, "angle"
    require(o.mu > 0, f"{place}: without friction")
    other = copy.copy(p)
    other.options = o
    ends = 2 if p.closing else 1  # turns that are passed by nobody
    limit = Fraction(math.log(o.max_pull))
    allowed = (limit + 2 * TOLERANCE * (1 + limit)) / Fraction(o.mu)
    bound = Fraction(0)  # on a side of a cut turn
    walks = Walks(other, all_half_turns(f, o.tube))
    bound = Fraction(walks.forced(True), UNIT)
    if "proof" in claim:
        most = member(claim, "most_passes", "integer", place, 10**6, 10**6)
        cut = member(claim, "cut", "integer", place, 1, math.floor(math.pi * UNIT))
        model = Model(other, cords, most, False, cut)
        model.read(member(claim, "proof", "object", place), place + ".proof")
        all_turns = model.bound(place + ".proof")
        require(all_turns is not None, f"{place}.proof: proves that there is no plan")
        require(model.walks is None, f"{place}.proof.walks: not within a pull")
        bound = max(bound, (each_turns(other, model, cords, all_turns) - ends * Fraction(cut, UNIT)) / 2)
    least = [sum(o.count.get(v, 0) for v in piece) // 2 if o.ends == "counts" else cords for piece in f.pieces]
    fits = bound <= allowed and few_within(p, o, float(allowed), least, [x + 1 for x in least]) == least
    require(not fits, f"{place}: {cords} cords are not proved to be too few")
    return cords


def alone(p, c):
    """Component c as a framework of its own, with what is asked of it and as many cords as it has."""
    f, part = p.frame, copy.copy(p)
    g, o = part.frame, part.options = copy.copy(f), copy.copy(p.options)
    edges, number = f.edges_of(c), {v: i for i, v in enumerate(f.pieces[c])}
    g.n, g.m, g.pieces, g.component = len(number), len(edges), [list(range(len(number)))], [0] * len(number)
    g.xyz, g.edge = [f.xyz[v] for v in f.pieces[c]], [tuple(number[v] for v in f.edge[e]) for e in edges]
    g.at = [[] for _ in number]
    for h in range(2 * g.m):
        g.at[g.tail(h)].append(h)
    for holder, names in (g, "length exact cover capacity"), (o, "need most"), (part, "passes extra"):
        for name in names.split():
            values = getattr(holder, name)
            setattr(holder, name, values and [values[e] for e in edges])
    g.feet = {number[v] for v in f.feet if v in number}
    o.allowed = o.allowed and {number[v] for v in o.allowed if v in number}
    o.count = {number[v]: n for v, n in o.count.items() if v in number}
    part.per_piece = [p.per_piece[c]]
    return part


def check_pull(p):
    check_pulls(p)
    claim = member(p.proof, "pull", "object", "proof", default=None)
    if claim is None:
        return
    o, place = p.options, "proof.pull"
    require(o.max_pull is not None, f"{place}: without a limit on the pull")
    if "parts" not in claim:
        check_fewest(p, claim, place)
        return
    known(claim, "status lower_bound parts", place)
    claims = member(claim, "parts", "list", place)
    require(len(claims) == len(p.frame.pieces) <= 100, f"{place}.parts: not one for each of at most 100 components")
    for c, part in enumerate(claims):
        require(type(part) is dict, f"{place}.parts[{c}]: not an object")
        check_fewest(alone(p, c), part, f"{place}.parts[{c}]")
    judge_fewest(claim, sum(part["lower_bound"] for part in claims), len(p.cords), place)


def judge_fewest(claim, proved, cords, place):
    number = member(claim, "lower_bound", "integer", place, 1)
    require(number <= proved and number <= cords, f"{place}.lower_bound: stated {number}, but {proved} is proved")
    status = choice(claim, "status", place, ("optimal", "bound"))
    require(status == "bound" or number == cords, f"{place}.status: not optimal")


def check_fewest(p, claim, place):
    o = p.options
    known(claim, "status lower_bound excluded most_passes cut proof walks", place)
    require(("proof" in claim) == ("most_passes" in claim) >= ("cut" in claim), f"{place}: a part of the proof is missing")
    proofs = ("proof" in claim) + ("walks" in claim)
    require(proofs <= ("excluded" in claim), f"{place}: not one proof of what is excluded")
    cords = 0
    if "excluded" in claim and "walks" not in claim:
        cords = too_few(p, claim, place)
    if "walks" in claim:
        cords = member(claim, "excluded", "integer", place, 1, 1000)
        walks = PulledWalks(p)
        walks.read(member(claim, "walks", "object", place), place + ".walks")
        require(walks.bits_of_length == 0, f"{place}.walks.bits: not 0")
        most = o.cords if o.ends != "counts" else p.per_piece[walks.component]
        require(walks.length(min(cords, most), place + ".walks") > 0, f"{place}: {cords} cords are not proved to be too few")
    fewest = sum(p.per_piece)
    if o.ends != "counts":
        least = [o.least] * len(p.frame.pieces)
        if o.mu > 0:
            limit = Fraction(math.log(o.max_pull))
            least = few_within(p, o, float((limit + 2 * TOLERANCE * (1 + limit)) / Fraction(o.mu)), least, p.per_piece)
        fewest = sum(least) + max(0, cords + 1 - max(least))
    judge_fewest(claim, fewest, sum(p.per_piece), place)


# ---- symmetry ----


def least_rotation(text):
    """The first in order of all rotations (Booth 1980, in Shiloach's two-pointer form)."""
    twice, n, i, j, k = text + text, len(text), 0, 1, 0
    while i < n and j < n and k < n:
        a, b = twice[i + k], twice[j + k]
        if a == b:
            k += 1
            continue
        if a > b:
            i += k + 1
        else:
            j += k + 1
        j += i == j
        k = 0
    i = min(i, j)
    return twice[i:i + n]


class Paths:
    """Cords as strings of nodes, for comparing them; turning ones run round: any start, either way."""

    def __init__(self, p, retraced):
        free = p.closing or p.options.ends == "any" and not p.options.tube
        always = p.closing or retraced
        self.round = [free and cord.closed and (always or cord.half[0] >> 1 != cord.half[-1] >> 1) for cord in p.cords]
        self.text = ["".join(map(chr, cord.nodes[:-1] if r else cord.nodes)) for cord, r in zip(p.cords, self.round)]

    def form(self, i, image):
        text = self.text[i].translate(image)
        if self.round[i]:
            return "o" + min(least_rotation(text), least_rotation(text[::-1]))
        return "-" + min(text, text[::-1])

    def maps(self, i, group):
        """How many elements of the group map cord i to itself, those that move its nodes alike counting once."""
        own, images = self.form(i, {}), {self.text[i].translate(image): image for image in group}
        return sum(self.form(i, image) == own for image in images.values())

    def ways(self, i, group):
        """In how many ways (direction and start) cord i is its own image under an element of the group."""
        text, found = self.text[i], set()
        for image in group:
            moved = text.translate(image)
            for back in (False, True):
                own = text[::-1] if back else text
                if not self.round[i]:
                    found.update([back] if own == moved else [])
                    continue
                at = (own + own).find(moved)
                while 0 <= at < len(text):
                    found.add((back, at))
                    at = (own + own).find(moved, at + 1)
        return len(found)


def point_groups(order):
    """{name: (elements of order 2, greatest order, elements that mirror, inversions, greatest order of a turn)} of this order."""
    table = {"C1": (1, 0, 1, 0, 0, 1), "Cs": (2, 1, 2, 1, 0, 1), "Ci": (2, 1, 2, 1, 1, 1), "T": (12, 3, 3, 0, 0, 3),
             "Th": (24, 7, 6, 12, 1, 3), "Td": (24, 9, 4, 12, 0, 3), "O": (24, 9, 4, 0, 0, 4), "Oh": (48, 19, 6, 24, 1, 4),
             "I": (60, 15, 5, 0, 0, 5), "Ih": (120, 31, 10, 60, 1, 5)}
    for n in range(2, order + 1):
        even, odd = 1 - n % 2, n % 2
        table[f"C{n}"] = (n, even, n, 0, 0, n)
        table[f"C{n}h"] = (2 * n, 1 + 2 * even, math.lcm(n, 2), n, even, n)
        table[f"C{n}v"] = (2 * n, n + even, max(n, 2), n, 0, n)
        table[f"D{n}"] = (2 * n, n + even, max(n, 2), 0, 0, n)
        table[f"D{n}h"] = (4 * n, 2 * (n + even) + 1, math.lcm(n, 2), 2 * n, even, n)
        table[f"D{n}d"] = (4 * n, 2 * n + 1, 2 * n, 2 * n, odd, n)
        table[f"S{2 * n}"] = (2 * n, 1, 2 * n, n, odd, n)
    return {name: row[1:] for name, row in table.items() if row[0] == order}


def element_order(g):
    result, seen = 1, set()
    for v in range(len(g)):
        n = 0
        while v not in seen:
            seen.add(v)
            v, n = g[v], n + 1
        result = math.lcm(result, n or 1)
    return result


def eigenvectors(a):
    """Of a symmetric 3 x 3 matrix, as columns (Jacobi's rotations)."""
    a, v = [row[:] for row in a], [[float(i == j) for j in range(3)] for i in range(3)]
    for _ in range(30):
        for p, q in ((0, 1), (0, 2), (1, 2)):
            if abs(a[p][q]) <= 1e-300:
                continue
            t = 0.5 * math.atan2(2 * a[p][q], a[q][q] - a[p][p])
            c, s = math.cos(t), math.sin(t)
            for rows in (a, v):
                for row in rows:
                    row[p], row[q] = c * row[p] - s * row[q], s * row[p] + c * row[q]
            a[p], a[q] = [c * x - s * y for x, y in zip(a[p], a[q])], [s * x + c * y for x, y in zip(a[p], a[q])]
    return v


def cross(u, v):
    return [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]


def dot(u, v):
    return sum(x * y for x, y in zip(u, v))


def unit(u):
    size = math.hypot(*u)
    return [x / size for x in u] if size else None


class Shape:
    """Nodes about their centroid, in parts of the root mean square distance from it."""

    def __init__(self, f):
        centre = [math.fsum(x) / f.n for x in zip(*f.xyz)]
        nodes = [[x - c for x, c in zip(p, centre)] for p in f.xyz]
        size = math.sqrt(math.fsum(dot(p, p) for p in nodes) / f.n)
        self.nodes = [[x / size for x in p] for p in nodes]
        spread = [[math.fsum(p[i] * p[j] for p in self.nodes) for j in range(3)] for i in range(3)]
        axes = list(zip(*eigenvectors(spread)))
        self.flat = min(math.fsum(dot(p, a) ** 2 for p in self.nodes) for a in axes) < 1e-8 * f.n

    def motion(self, g):
        """The orthogonal matrix that moves the nodes nearest to their images: (it, root mean square distance left, largest one)."""
        m = [[math.fsum(self.nodes[w][i] * p[j] for w, p in zip(g, self.nodes)) for j in range(3)] for i in range(3)]
        axes = list(zip(*eigenvectors([[sum(row[i] * row[j] for row in m) for j in range(3)] for i in range(3)])))
        moved = [[dot(row, a) for row in m] for a in axes]
        order = sorted(range(3), key=lambda i: -math.hypot(*moved[i]))
        v = [axes[i] for i in order]
        u = [unit(moved[order[0]])]
        second = [x - dot(moved[order[1]], u[0]) * y for x, y in zip(moved[order[1]], u[0])]
        if math.hypot(*second) < 1e-9 * len(g):  # on a line any direction across will do
            second = cross(u[0], [float(i == min(range(3), key=lambda k: abs(u[0][k]))) for i in range(3)])
        u.append(unit(second))
        third = cross(u[0], u[1])
        turned = dot(cross(v[0], v[1]), v[2]) < 0
        if turned if self.flat else dot(third, moved[order[2]]) < 0:
            third = [-x for x in third]
        u.append(third)
        q = [[sum(u[k][i] * v[k][j] for k in range(3)) for j in range(3)] for i in range(3)]
        left = [math.dist([dot(row, p) for row in q], self.nodes[w]) for w, p in zip(g, self.nodes)]
        return q, math.sqrt(math.fsum(x * x for x in left) / len(left)), max(left)


def check_shape(p, group, order, name):
    """What the name says of the group, and the tolerance that was asked for of its elements."""
    asked = p.file["options"]["symmetry"]
    wanted, tolerance = asked["group"], asked["geometric"]
    if wanted is not None and not wanted.isdigit():
        require(wanted == name, f"symmetry.name: {name or 'none'}, but {wanted} was asked for")
    if not name and tolerance is None:
        return
    shape = Shape(p.frame)
    orders, turns, mirrors, inversions = [], [1], 0, 0
    for g in group:
        q, residual, farthest = shape.motion(g)
        require(not name or residual <= 0.05 + 1e-9, f"symmetry.name: an element is {residual:.3g} away from an isometry")
        require(tolerance is None or farthest <= tolerance + 2e-9, f"symmetry: an element is {farthest:.3g} away from an isometry")
        orders.append(element_order(g))
        if dot(q[0], cross(q[1], q[2])) < 0:
            mirrors += 1
            inversions += orders[-1] == 2 and q[0][0] + q[1][1] + q[2][2] < -1
        else:
            turns.append(orders[-1])
    if name:
        row = point_groups(order).get(name)
        require(row is not None and row[:2] == (orders.count(2), max(orders)), f"symmetry.name: {name} is another group")
        require(shape.flat or row[2:] == (mirrors, inversions, max(turns)), f"symmetry.name: {name} has other mirrors")


def generate(generators, n, order):
    """The group, as tuples; gives up beyond its stated order."""
    identity = tuple(range(n))
    group, front = {identity}, [identity]
    while front:
        g = front.pop()
        for s in generators:
            h = tuple(s[v] for v in g)
            if h not in group:
                group.add(h)
                front.append(h)
                require(len(group) <= order, "symmetry.order: the generators make a larger group")
    return group


def check_automorphism(p, g, name):
    f, o = p.frame, p.options
    require(sorted(g) == list(range(f.n)), f"{name}: not a permutation")
    edges = set(map(frozenset, f.edge))
    for e, (a, b) in enumerate(f.edge):
        require(frozenset((g[a], g[b])) in edges, f"{name}: edge {e} does not go to an edge")
    require({g[v] for v in f.feet} == f.feet and {g[v] for v in o.allowed} == o.allowed, f"{name}: feet or ends go elsewhere")


def check_symmetry(p):
    require(("symmetry" in p.file) == (p.options.objective == "symmetry"), "symmetry: with that objective, and only with it")
    if "symmetry" not in p.file:
        return
    s, place, n = member(p.file, "symmetry", "object", ""), "symmetry", p.frame.n
    require(p.options.ends != "counts", "symmetry: not with ends `counts`")
    known(s, "order name generators images cords steps retraced unique_paths", place)
    order = member(s, "order", "integer", place, 1, 1024)
    generators = [integers(g, f"symmetry.generators[{i}]", 0, n - 1, n) for i, g in enumerate(member(s, "generators", "list", place))]
    for i, g in enumerate(generators):
        check_automorphism(p, g, f"symmetry.generators[{i}]")
    group = generate(generators, n, order)
    require(len(group) == order, f"symmetry.order: the generators make {len(group)} elements")
    name = member(s, "name", "text", place)
    check_shape(p, group, order, name)
    images = [tuple(integers(g, f"symmetry.images[{i}]", 0, n - 1, n)) for i, g in enumerate(member(s, "images", "list", place))]
    require(images and images[0] == tuple(range(n)), "symmetry.images: the first is not the identity")
    require(all(g in group for g in images), "symmetry.images: an image is not in the group")
    check_copies(p, s, [list(g) for g in generators], [list(g) for g in images], group)


def check_copies(p, s, generators, images, group):
    retraced = member(s, "retraced", "truth", "symmetry", default=False)  # else as in older plans
    paths, identity, n = Paths(p, retraced), {}, len(p.cords)
    forms = [paths.form(i, identity) for i in range(n)]
    table = lambda g: dict(enumerate(g))
    for g in generators:
        require(sorted(paths.form(i, table(g)) for i in range(n)) == sorted(forms), "symmetry: a generator does not map the cords to the cords")
    rows = member(s, "cords", "list", "symmetry")
    require(len(rows) == n, "symmetry.cords: not one per cord")
    unique = set()
    for i, row in enumerate(rows):
        name = f"symmetry.cords[{i}]"
        require(type(row) is dict, f"{name}: not an object")
        known(row, "of image", name)
        of = member(row, "of", "integer", name, 0, n - 1)
        image = member(row, "image", "integer", name, 0, len(images) - 1)
        require(type(rows[of]) is dict and rows[of].get("of") == of, f"{name}.of: not a unique path")
        require(of != i or image == 0, f"{name}.image: of a unique path it is 0")
        require(paths.form(of, table(images[image])) == forms[i], f"{name}: not that image of cord {of}")
        unique.add(of)
    seen = {}
    for i in unique:
        for g in group:
            other = seen.setdefault(paths.form(i, table(g)), i)
            require(other == i, f"symmetry: cords {other} and {i} are images of each other, and both unique paths")
    require(member(s, "unique_paths", "integer", "symmetry") == len(unique), f"symmetry.unique_paths: not {len(unique)}")
    tables = [table(g) for g in group]
    ends = [2 if p.options.ends == "any" and not r else 0 for r in paths.round]  # each a step, for it may be anywhere
    count = paths.maps if retraced else paths.ways
    steps = sum(Fraction(len(p.cords[i].half) + ends[i], count(i, tables)) for i in unique)
    p.close(member(s, "steps", "number", "symmetry"), steps, steps, "symmetry.steps")


# ---- evaluation ----

RAMP = ((243, 211, 80), (238, 176, 50), (227, 142, 36), (211, 110, 39), (190, 79, 49), (165, 51, 57), (138, 23, 62), (106, 5, 64), (75, 2, 58))


def near(stated, value, scale, name):
    require(abs(stated - value) <= 1e-9 * scale, f"{name}: stated {stated}, but it is {value}")


def colour(tension, low, high):
    """Of a tension, red green blue: even steps for equal ratios."""
    span = math.log(high / low) if low > 0 else math.inf
    at = (len(RAMP) - 1) * math.log(tension / low) / span if span > 0 and tension > 0 and span < math.inf else 0
    i = min(int(max(at, 0)), len(RAMP) - 2)
    return [a + (max(at, 0) - i) * (b - a) for a, b in zip(RAMP[i], RAMP[i + 1])]


def held(tension, exponent, physics):
    """What turns with that exponent hold against a tension, on its tight side (on its slack side if negative): with mu_power n the
    tension to the power 1 - n grows by (1 - n) x exponent x mu_tension to the same power."""
    m = 1 - physics["mu_power"]
    if m in (0, 1):
        return tension * math.exp(min(exponent, 700))
    if tension <= 0:
        return physics["mu_tension"] * (m * exponent) ** (1 / m) if exponent > 0 else 0.0
    grown = m * exponent * (physics["mu_tension"] / tension) ** m
    return tension * math.exp(math.log1p(grown) / m) if grown > -1 else 0.0


class Rope:
    """One cord while its schedule is followed: docs/plan-format.md, the steps of a schedule. largest: for tension_most."""

    def __init__(self, turns, metres, physics, largest):
        self.turns, self.metres, self.physics, self.largest = turns, metres, physics, largest
        self.tension, self.free, self.kept = [0.0] * len(metres), {"start", "end"}, None
        self.sums = [0.0]
        for x in turns:
            self.sums.append(self.sums[-1] + x)

    def raise_from(self, at, force, low, high):
        for k in range(low, high + 1):
            self.tension[k] = max(self.tension[k], held(force, -abs(self.sums[k] - self.sums[at]), self.physics))

    def lowered(self, end, force):
        new = self.tension
        for at in {"start": (0,), "end": (-1,), "both": (0, -1)}[end]:
            new = [min(x, held(force, abs(s - self.sums[at]), self.physics)) for x, s in zip(new, self.sums)]
        return new

    def do(self, s):
        last, ends = len(self.tension) - 1, {"start", "end"} if s["end"] == "both" else {s["end"]}
        if s["do"] == "pull":
            self.free, self.kept = set(), None
            for end in ends:
                self.raise_from(0 if end == "start" else last, s["force"], 0, last)
            self.settle()
        elif s["do"] == "grip":
            at, sides = s["pass"], ends - self.free
            require(at <= last, "evaluation.schedule: a grip beyond the cord")
            if sides:
                self.raise_from(at, s["force"], 0 if "start" in sides else at, last if "end" in sides else at)
            self.kept = None if len(sides) != 1 else at if "start" in sides else at - 1
            self.settle()
        else:
            if s["do"] == "release" or s["slip"]:
                self.rest()
                self.tension = self.lowered(s["end"], s["force"]) if s["do"] == "release" else self.slipped(s)
            self.free -= ends

    def rest(self):
        self.kept = None
        self.settle()

    def slipped(self, s):
        """Until the cord is shorter by the slip: sum of (tension lost) x length / EA."""
        stiffness = self.physics["stiffness"]
        require(stiffness > 0, "evaluation.schedule: a knot slips, but the stiffness is not known")
        shorter = lambda new: math.fsum((a - b) * m for a, b, m in zip(self.tension, new, self.metres)) / stiffness * 1000
        low, high = 0.0, max(self.tension[0], self.tension[-1])
        if shorter(self.lowered(s["end"], 0.0)) <= s["slip"]:
            return self.lowered(s["end"], 0.0)
        for _ in range(200):
            middle = (low + high) / 2
            low, high = (middle, high) if shorter(self.lowered(s["end"], middle)) > s["slip"] else (low, middle)
        return self.lowered(s["end"], high)

    def fails(self, k):
        """1 if the pass before turn k is tighter than the turn holds, -1 if the one behind it is, else 0."""
        if k == self.kept:
            return 0
        a, b = self.tension[k], self.tension[k + 1]
        if a <= b:
            return -(b > held(a, self.turns[k], self.physics) * (1 + 1e-12))
        return int(a > held(b, self.turns[k], self.physics) * (1 + 1e-12))

    def settle(self):
        t, n = self.tension, len(self.tension)
        if self.physics["stiffness"] > 0:
            for k in range(n - 1):
                if self.fails(k):
                    self.slip_over(k, self.fails(k) > 0)
        else:
            take, sign = (max, -1) if self.largest else (min, 1)
            for k in range(n - 1):
                if k != self.kept:
                    t[k + 1] = take(t[k + 1], held(t[k], sign * self.turns[k], self.physics))
            for k in range(n - 2, -1, -1):
                if k != self.kept:
                    t[k] = take(t[k], held(t[k + 1], sign * self.turns[k], self.physics))
        for end, way in (("start", range(n)), ("end", range(n - 1, -1, -1))):
            most = 0.0
            for k in way if end in self.free else ():
                turn = k if end == "start" else k - 1
                t[k] = min(t[k], most)
                if turn == self.kept or not 0 <= turn < n - 1:
                    break
                most = held(most, self.turns[turn], self.physics)

    def slip_over(self, k, falls):
        """Passes a .. b come to differ by all that the turns between hold, their stretch kept, as few as hold against those beside."""
        t, a, b = self.tension, k, k + 1
        while True:
            tight = self.sums[a if falls else b]
            shares = lambda force: [held(force, -abs(s - tight), self.physics) for s in self.sums[a:b + 1]]
            stretch = lambda row: math.fsum(x * m for x, m in zip(row, self.metres[a:]))
            want, low, high = stretch(t[a:b + 1]), 0.0, max(t[a:b + 1])
            if self.physics["mu_power"] in (0, 1):
                low = high = want / stretch(shares(1.0))
            for _ in range(200 if low < high else 0):
                middle = (low + high) / 2
                low, high = (middle, high) if stretch(shares(middle)) < want else (low, middle)
            row = shares(high)
            more = lambda x, y, turn: x > held(y, self.turns[turn], self.physics) * (1 + 1e-12)
            wider_a = a > 0 and a - 1 != self.kept and (more(t[a - 1], row[0], a - 1) if falls else more(row[0], t[a - 1], a - 1))
            wider_b = b < len(t) - 1 and b != self.kept and (more(row[-1], t[b + 1], b) if falls else more(t[b + 1], row[-1], b))
            if not (wider_a or wider_b):
                t[a:b + 1] = row
                return
            a, b = a - wider_a, b + wider_b


class Pulled:
    """The record of one cord."""

    def __init__(self, p, e, o, i):
        self.place, cord = f"evaluation.cords[{i}]", p.cords[i]
        require(type(o) is dict, f"{self.place}: not an object")
        known(o, "id known pull turning taut_turning force other_force loss work error slackest refused tension tension_most colours exponents", self.place)
        require(member(o, "id", "text", self.place) == cord.id, f"{self.place}.id: not {cord.id}")
        self.pull = choice(o, "pull", self.place, ("start", "end", "both", "none"))
        self.force = self.other = 0
        self.tension = []
        if not member(o, "known", "truth", self.place):
            require(len(o) == 3, f"{self.place}: more than is known")
            return
        self.angles = [p.frame.angle(a, b) for a, b in cord.turns(False)]
        values = {key: member(o, key, "number", self.place, 0) for key in "turning taut_turning force other_force loss work error".split()}
        tension = member(o, "tension", "list", self.place)
        require(len(tension) == len(cord.half), f"{self.place}.tension: not one per pass")
        self.tension = [member({"tension": x}, "tension", "number", self.place, 0) for x in tension]
        member(o, "refused", "integer", self.place, 0, 0 if e.method == "capstan" else len(self.angles))
        self.colours = member(o, "colours", "list", self.place)
        self.force, self.other = values["force"], values["other_force"]
        self.slackest = member(o, "slackest", "integer", self.place, 0, len(tension) - 1)
        self.metres = [p.frame.length[h >> 1] * (UNITS[p.frame.units.lower()] or 1) / 1000 for h in cord.half]
        require(("exponents" in o) == (bool(e.steps) or e.taut), f"{self.place}.exponents: with a schedule or tight turns, and only with them")
        self.steps = self.turns(e, o)
        if e.taut:
            total = e.physics["mu"] * (values["taut_turning"] - math.fsum(self.angles)) + math.fsum(self.exponents_by_law(e))
            near(math.fsum(self.steps), total, 1 + e.physics["mu"] * math.fsum(self.angles), f"{self.place}.exponents: their sum")
        require(bool(e.steps) or "tension_most" not in o, f"{self.place}.tension_most: without a schedule")
        if e.steps:
            self.check_schedule(e, o, values, [s for s in e.steps if s["cord"] == cord.id])
            return
        self.check_values(e, values, math.fsum(self.angles))
        if e.method == "capstan" and self.pull != "none":
            self.check_law(e)

    def exponents_by_law(self, e):
        """What every turn, and the way from the middle of a pass to that of the next, costs."""
        mu, wobble = e.physics["mu"], e.physics["wobble"]
        ways = [(a + b) / 2 for a, b in zip(self.metres, self.metres[1:])]
        turn = (lambda x: mu * x) if e.law == "capstan" else (lambda x: -math.log(max(1 - mu * math.sin(x / 2), 5e-324)))
        return [turn(x) + mu * wobble * way for x, way in zip(self.angles, ways)]

    def turns(self, e, o):
        """The exponents: by the law, or as stated, and then by the law too where that can be."""
        law = self.exponents_by_law(e) if e.method != "joint" and not e.taut else []
        if "exponents" not in o:
            return law
        turns = [member({"x": x}, "x", "number", self.place, 0) for x in member(o, "exponents", "list", self.place)]
        require(len(turns) == len(self.tension) - 1, f"{self.place}.exponents: not one per turn")
        for stated, x in zip(turns, law):
            near(stated, x, 1 + x, f"{self.place}.exponents")
        return turns

    def check_schedule(self, e, o, values, steps):
        """The tensions that the steps leave, each the least or the largest state that the turns allow, turn after turn."""
        turns = self.steps
        near(values["turning"], math.fsum(self.angles), 1 + values["turning"], self.place + ".turning")
        slack = [s["do"] for s in steps] == ["none"]
        require(steps and (slack or all(s["do"] != "none" for s in steps)), f"{self.place}: none is the only step of a cord, and each cord has a step")
        require(self.pull == ("none" if slack else "both"), f"{self.place}.pull: after a schedule")
        require(not slack or not any(self.tension) and "tension_most" not in o, f"{self.place}: the schedule leaves it slack")
        most = self.tension
        if "tension_most" in o:
            most = [member({"x": x}, "x", "number", self.place, 0) for x in member(o, "tension_most", "list", self.place)]
            require(len(most) == len(self.tension), f"{self.place}.tension_most: not one per pass")
        for key, stated, largest in (("tension", self.tension, False), ("tension_most", most, True)):
            rope = Rope(turns, self.metres, e.physics, largest)
            for s in steps if not slack else ():
                rope.do(s)
            rope.rest()
            for k, (x, y) in enumerate(zip(stated, rope.tension)):
                near(x, y, max(y, 1e-6 * max(rope.tension)), f"{self.place}.{key}[{k}]")
        hardest = max([s["force"] for s in steps if s["do"] in ("pull", "grip")], default=0)
        loss = 1 - self.tension[self.slackest] / hardest if hardest else 0
        for key, value in (("force", hardest), ("other_force", 0), ("work", hardest), ("loss", loss)):
            near(values[key], value, max(value, 1), f"{self.place}.{key}")
        require(self.tension[self.slackest] == min(self.tension), f"{self.place}.slackest: not the least tension")
        require(e.method == "joint" or e.taut or values["taut_turning"] == values["turning"], f"{self.place}.taut_turning: not the turning")
        require(values["error"] == 0 or e.method != "capstan", f"{self.place}.error: of a closed form")

    def check_values(self, e, values, turning):
        near(values["turning"], turning, 1 + turning, self.place + ".turning")
        if e.method != "joint" and not e.taut:
            require(values["taut_turning"] == values["turning"], f"{self.place}.taut_turning: not the turning")
        require(values["error"] == 0 or e.method != "capstan", f"{self.place}.error: of a closed form")
        first, last = self.tension[0], self.tension[-1]
        force, other = {"start": (first, 0), "end": (last, 0), "both": (max(first, last), min(first, last)), "none": (0, 0)}[self.pull]
        for key, value in (("force", force), ("other_force", other), ("work", force + other)):
            near(values[key], value, max(value, values[key]), f"{self.place}.{key}")
        slack = self.tension[self.slackest]
        require(slack == min(self.tension), f"{self.place}.slackest: not the least tension")
        near(values["loss"], 1 - slack / force if force else 0, 1, self.place + ".loss")
        require(self.pull != "none" or not any(self.tension), f"{self.place}.tension: of a cord that is not pulled")
        self.from_end = self.slackest
        if self.pull == "both":
            self.from_end = self.slackest + (not e.old_pull and len(self.tension) > 1)
            require(self.from_end < len(self.tension), f"{self.place}.slackest: no turn behind it")
            near(self.tension[self.from_end], slack, slack, f"{self.place}.tension[{self.from_end}]: behind the slackest pass")
        ways = {"none": [], "start": [self.tension[self.slackest::-1]], "end": [self.tension[self.slackest:]]}
        for way in ways["start"] + ways["end"] if self.pull == "both" else ways[self.pull]:
            require(all(a <= b * (1 + 1e-9) for a, b in zip(way, way[1:])), f"{self.place}: tension falls towards a pulled end")

    def check_law(self, e):
        """Every tension, from the slackest pass, and that no other pass would do with less pull."""
        before = [0.0]
        for x in self.exponents_by_law(e):
            before.append(before[-1] + x)
        total, at = before[-1], before[self.slackest]
        ways = {"start": [total - x for x in before], "end": before, "both": list(map(max, partings(before, e.old_pull)))}[self.pull]
        require(ways[self.slackest] <= min(ways) + 1e-9 * (1 + total), f"{self.place}.slackest: another pass needs less pull")
        for k, x in enumerate(before):
            expected = held(e.physics["seating"], at - x if k <= self.slackest else x - before[self.from_end], e.physics)
            require(self.tension[k] > 0 and abs(math.log(self.tension[k]) - math.log(expected)) <= 1e-9 * (1 + total),
                    f"{self.place}.tension[{k}]: not by the law")

    def check_colours(self, low, high):
        require(len(self.colours) == len(self.tension), f"{self.place}.colours: not one per pass")
        for text, tension in zip(self.colours, self.tension):
            good = type(text) is str and re.fullmatch("#[0-9a-f]{6}", text)
            rgb = good and [int(text[k:k + 2], 16) for k in (1, 3, 5)]
            require(good and all(abs(a - b) <= 1.5 for a, b in zip(rgb, colour(tension, low, high))), f"{self.place}.colours: not so")


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def plus(a, b, times=1.0):
    return tuple(x + times * y for x, y in zip(a, b))


class Standing:
    """The limit analysis: beads as rigid bodies (SI units), and what each stated mechanism proves."""

    ASKED = ("holding", "equal", "any_state", "after", "loaded", "carried", "carried_after", "stretch", "tightest")
    AFTER = ("after", "carried_after", "stretch", "tightest")

    def __init__(self, p, e, cords, o):
        place = self.place = "evaluation.structure"
        known(o, "model clamped taut tilt azimuth strength let_down loads drawn stills answers", place)
        self.model = member(o, "model", "integer", place, 1, 2, default=1)
        self.frame, self.physics, self.cords, self.scheduled = p.frame, e.physics, cords, bool(e.steps)
        self.strength = member(o, "strength", "number", place, 0, default=0) or math.inf
        self.old_pull = p.options.old_pull
        self.paths = [[h >> 1 for h in cord.half] for cord in p.cords]
        self.clamped = member(o, "clamped", "truth", place)
        self.tilt, self.azimuth = tilt, azimuth = member(o, "tilt", "number", place, 0), member(o, "azimuth", "number", place)
        require(tilt < math.pi / 2, f"{place}.tilt: a right angle or more")
        self.down = (math.sin(tilt) * math.cos(azimuth), math.sin(tilt) * math.sin(azimuth), -math.cos(tilt))
        require(all(cord.tension for cord in cords), f"{place}: not every cord is known")
        done = {}
        for step in e.steps or []:
            if step["do"] != "grip":
                done.update({(step["cord"], end): step["do"] for end in ("start", "end") if step["end"] in (end, "both")})
        self.tied = [i for i, cord in enumerate(p.cords) if self.model > 1 and done.get((cord.id, "start")) == done.get((cord.id, "end")) == "knot"]
        self.knotted = {edge for i in self.tied for edge in self.paths[i]}
        self.bodies()
        self.loads = [self.load(x) for x in member(o, "loads", "list", place)] if "loads" in o else []
        require("loads" not in o or self.loads, f"{place}.loads: empty")
        drawn = member(o, "drawn", "list", place)
        require(len(drawn) == len(cords), f"{place}.drawn: not one per cord")
        self.drawn = [self.draw(x, cord) for x, cord in zip(drawn, cords)]
        answers = member(o, "answers", "list", place)
        require(answers, f"{place}.answers: empty")
        self.found = [self.answer(x) for x in answers]
        found = [(asked, proved) for asked, _, proved in self.found]
        if not self.scheduled:
            self.check_tensions(next((x for asked, x in found[::-1] if asked == "holding"), None) or 0.0)
        if "let_down" in o:
            least = max([x for asked, x in found if asked == "any_state" and x] or [0])
            require(self.scheduled and member(o, "let_down", "number", place, 0) >= least * (1 - 1e-6), f"{place}.let_down: no state holds with that")

    def bodies(self):
        """Centres, masses and mass centres of the beads; middle, axis and sides of the faces; feet."""
        f, v = self.frame, self.physics
        metre, self.width, bore = UNITS[f.units.lower()] / 1000, v["bead_diameter"] / 1000, v["bore"] / 1000
        self.at = [tuple(metre * x for x in xyz) for xyz in f.xyz]
        area = self.width**2 - math.pi / 4 * bore**2
        volume, moment = [0.0] * f.n, [(0.0, 0.0, 0.0)] * f.n
        self.face, self.level, self.play = [], (1.0, 0.0), 0.0
        if self.model > 1:
            self.play = max(0.0, (v["bore"] - v["cord_diameter"]) / 2000)
            ways = (plus(self.at[b], self.at[a], -1) for a, b in f.edge)
            slopes = ((x / math.hypot(x, y), y / math.hypot(x, y)) for x, y, z in ways if math.hypot(x, y) > 1e-9 * math.hypot(x, y, z))
            self.level = next(slopes, self.level)
        for a, b in f.edge:
            way = plus(self.at[b], self.at[a], -1)
            length = math.dist(self.at[a], self.at[b])
            axis = tuple(x / length for x in way)
            level = math.hypot(axis[0], axis[1])
            side = (-axis[1] / level, axis[0] / level, 0.0) if level > 1e-9 else (*self.level, 0.0)
            self.face.append((tuple((x + y) / 2 for x, y in zip(self.at[a], self.at[b])), axis, side, cross(axis, side)))
            for node, sign in ((a, 1), (b, -1)):
                arm, k = length / 2, len(f.at[node])
                near = min(self.width / 2, arm)
                off = near * (1 - 2 / k) if k > 2 else 0.0
                volume[node] += area * (arm - off)
                moment[node] = plus(moment[node], axis, sign * area * (arm**2 - off * near) / 2)
        self.centre = [plus(at, m, 1 / x) for at, m, x in zip(self.at, moment, volume)]
        self.weight = [(v["bead_mass"] / 1000 if v["bead_mass"] else 1000 * v["density"] * x) * v["gravity"] for x in volume]
        lowest, size = min(z for _, _, z in self.at), math.dist(*[[side(x) for x in zip(*self.at)] for side in (min, max)])
        self.feet = f.feet or {i for i, x in enumerate(self.at) if x[2] <= lowest + 1e-6 * size}

    def load(self, o):
        known(o, "node force", self.place + ".loads")
        force = member(o, "force", "list", self.place)
        require(len(force) == 3, f"{self.place}.loads: not three numbers")
        return member(o, "node", "integer", self.place, 0, self.frame.n - 1), [member({"x": x}, "x", "number", self.place) for x in force]

    def draw(self, o, cord):
        """Exponents before every pass, the ends that are pulled, and the slackest pass, which has to be one."""
        known(o, "pull slackest", self.place + ".drawn")
        pull, last = choice(o, "pull", self.place, ("start", "end", "both", "none")), len(cord.tension) - 1
        slackest = member(o, "slackest", "integer", self.place, 0, last)
        before = [0.0, *itertools.accumulate(cord.steps)]
        reach = list(map(max, partings(before, self.old_pull)))
        fits = {"start": slackest == last, "end": slackest == 0, "none": slackest == 0,
                "both": slackest < len(reach) and reach[slackest] <= min(reach) + 1e-9 * (1 + before[-1])}[pull]
        require(fits, f"{self.place}.drawn: the slackest pass is another")
        require(self.scheduled or pull == cord.pull, f"{self.place}.drawn: pulled otherwise")
        return before, pull, slackest

    def tensions(self, i, asked):
        """Of cord i at a pull of 1, or as the schedule leaves them."""
        before, pull, slackest = self.drawn[i]
        if asked in self.AFTER:
            return self.cords[i].tension
        if pull == "none":
            return [0.0] * len(before)
        if asked == "holding":
            behind = slackest + (pull == "both" and not self.old_pull and len(before) > 1)
            end = {"start": before[slackest], "end": before[-1] - before[slackest], "both": max(before[slackest], before[-1] - before[behind])}[pull]
            return [math.exp((before[slackest] - x if k <= slackest else x - before[behind]) - end) for k, x in enumerate(before)]
        near = [min(600, x, before[-1] - x) for x in before]
        return [math.exp(x if asked == "any_state" else -x) for x in near]

    def check_tensions(self, pull):
        for i, cord in enumerate(self.cords):
            for k, (stated, x) in enumerate(zip(cord.tension, self.tensions(i, "holding"))):
                near(stated, pull * x, pull * x * (1 + self.drawn[i][0][-1]), f"{cord.place}.tension[{k}]")

    def answer(self, o):
        """What was asked, at which pull, and what is proved: None if nothing is."""
        place = self.place + ".answers"
        known(o, "asked pull found resists proved mechanism", place)
        asked = choice(o, "asked", place, self.ASKED)
        of_load = asked in ("carried", "carried_after")
        require(("pull" in o) == (asked == "carried"), f"{place}.pull: with carried, and only with it")
        require(self.scheduled or asked not in self.AFTER, f"{place}: without a schedule")
        require(self.model > 1 or asked not in ("stretch", "tightest"), f"{place}: {asked}, of the first model")
        require("resists" not in o or asked == "stretch" and "proved" in o, f"{place}.resists: only with a stretch that is proved")
        resists = member(o, "resists", "number", place, 0, default=None)
        require(self.loads or not of_load and asked != "loaded", f"{place}: without a load")
        require(("proved" in o) == ("mechanism" in o), f"{place}: what is proved, and by what, come together")
        pull = member(o, "pull", "number", place, 0, default=1)
        found = member(o, "found", "number", place, 0, default=None)
        if "proved" not in o:
            return asked, pull, None
        proved = member(o, "proved", "number", place, 0)
        if found is not None:
            require(found <= proved * (1 + 1e-6) if of_load else found >= proved * (1 - 1e-6), f"{place}.found: an equilibrium where there is none")
        self.check_mechanism(asked, of_load, pull, proved, resists, member(o, "mechanism", "list", place))
        return asked, pull, proved

    def tightening(self, parting, strength, stretch, resists):
        """The most that knotted cords resist beyond the tensions that the schedule leaves: along every cord the best for each tension of
        its last pass so far, a concave function by its corners."""
        sums = []
        for i in self.tied:
            corners, before = None, self.drawn[i][0]
            for k, (edge, least) in enumerate(zip(self.paths[i], self.cords[i].tension)):
                length = math.dist(*(self.at[x] for x in self.frame.edge[edge]))
                high, gain = max(least, min(strength, least + stretch / length)), parting[edge] - resists * length
                if corners is None:
                    corners = [(least, 0.0), (high, 0.0)]
                else:
                    factor, best = math.exp(before[k] - before[k - 1]), max(range(len(corners)), key=lambda j: corners[j][1])
                    corners = [(t / factor, x) for t, x in corners[:best + 1]] + [(t * factor, x) for t, x in corners[best:]]
                    low, high = (min(max(t, corners[0][0]), corners[-1][0]) for t in (least, high))
                    inner = [c for c in corners if low < c[0] < high]
                    ends = []
                    for t in (low, high):
                        j = next(j for j, c in enumerate(corners) if c[0] >= t)
                        (t0, x0), (t1, x1) = corners[max(j - 1, 0)], corners[j]
                        ends.append((t, x1 if t1 <= t or t1 <= t0 else x0 + (x1 - x0) * (t - t0) / (t1 - t0)))
                    corners = [ends[0], *inner, ends[1]]
                corners = [(t, x + gain * (t - least)) for t, x in corners]
            sums.append(max(x for _, x in corners))
        return math.fsum(sums)

    def check_mechanism(self, asked, of_load, pull, proved, resists, numbers):
        f, v, place = self.frame, self.physics, f"{self.place}: {asked}"
        require(len(numbers) == 6 * f.n, f"{place}: not six numbers for every node")
        numbers = [float(member({"x": x}, "x", "number", place)) for x in numbers]
        moves = [(tuple(numbers[i:i + 3]), tuple(numbers[i + 3:i + 6])) for i in range(0, len(numbers), 6)]
        velocity = lambda node, at: plus(moves[node][0], cross(moves[node][1], plus(at, self.centre[node], -1)))
        corners = lambda middle, one, other: [plus(plus(middle, one, s * self.width / 2), other, t * self.width / 2) for s in (1, -1) for t in (1, -1)]

        bead = max(math.hypot(*x) for x, _ in moves)
        require(abs(bead - 1) <= 1e-9, f"{place}: the fastest bead has the speed {bead}, not 1")
        faces = [[(velocity(a, at), velocity(b, at)) for at in corners(middle, one, other)] for (a, b), (middle, _, one, other) in zip(f.edge, self.face)]
        sides = 16 if self.model > 1 else 4
        ring = [cmath.rect(self.width / 2 / math.cos(math.pi / sides), math.pi * (2 * i + 1) / sides) * complex(*self.level) for i in range(sides)]
        feet = [] if self.clamped else [[velocity(foot, plus(self.at[foot], (z.real, z.imag, -self.width / 2))) for z in ring] for foot in self.feet]
        fastest = max([bead] + [math.hypot(*x) for face in faces for pair in face for x in pair] + [math.hypot(*x) for foot in feet for x in foot])
        require(fastest < math.inf, f"{place}: a bead turns too fast")

        def opens(apart, normal, mu):
            along = dot(apart, normal)
            return along >= mu * math.hypot(*plus(apart, normal, -along)) - 1e-13 * fastest

        for face, (_, axis, _, _) in zip(faces, self.face):
            require(all(opens(plus(b, a, -1), axis, v["mu_bead"]) for a, b in face), f"{place}: beads go into each other")
        for foot in feet:
            require(all(opens(x, (0, 0, 1), v["mu_ground"]) for x in foot), f"{place}: a foot goes into the ground")
        if self.clamped:
            require(not any(x for foot in self.feet for x in moves[foot][0] + moves[foot][1]), f"{place}: a foot that is held moves")
        press = [0.0] * f.m
        for i, path in enumerate(self.paths):
            for edge, x in zip(path, self.tensions(i, asked)):
                press[edge] += pull * x
        falling = [w * d * x for w, (move, _) in zip(self.weight, moves) for d, x in zip(self.down, move)]
        load = [dot(force, velocity(node, self.at[node])) for node, force in self.loads] if of_load or asked == "loaded" else []
        resistance = [sign * press[i] * dot(axis, velocity(node, middle)) for i, ((a, b), (middle, axis, _, _)) in enumerate(zip(f.edge, self.face))
                      for node, sign in ((a, -1), (b, 1))]
        resistance += [press[i] * self.play * math.hypot(*cross(axis, plus(moves[b][1], moves[a][1], -1))) for i, ((a, b), (_, axis, _, _)) in enumerate(zip(f.edge, self.face))]
        parting = [math.fsum((sum(s * dot(axis, velocity(node, middle)) for node, s in ((a, -1), (b, 1))), self.play * math.hypot(*cross(axis, plus(moves[b][1], moves[a][1], -1)))))
                   for (a, b), (middle, axis, _, _) in zip(f.edge, self.face)]
        after, stretch = asked in self.AFTER and asked != "after", 0.0
        if asked == "carried_after" and self.strength == math.inf:
            require(all(parting[e] <= 1e-13 * fastest for e in self.knotted), f"{place}: a face with knotted cord opens")
        elif asked == "stretch":
            if resists is None:
                resists = max([0.0] + [parting[e] / math.dist(*(self.at[x] for x in f.edge[e])) for e in self.knotted])
            stretch = proved * resists + self.tightening(parting, self.strength, proved, resists)
        elif after:
            stretch = self.tightening(parting, proved if asked == "tightest" else self.strength, math.inf, 0.0)
        times = [1, proved, 1] if of_load else [1, 1, 1] if after else [1, 1, proved]
        sums = [x * math.fsum(terms) for x, terms in zip(times, (falling, load, resistance))]
        slip = 1e-14 * math.fsum(x * abs(y) for x, terms in zip(times, (falling, load, resistance)) for y in terms) + 1e-14 * stretch
        most = (0 if of_load else sum(self.weight)) + sum(math.hypot(*force) for _, force in self.loads if load)
        drive = math.fsum(load) if of_load else sums[0] + sums[1]
        require(drive > max(slip, 1e-7 * fastest * most), f"{place}: nothing drives the mechanism")
        claimed = abs(sums[1]) if of_load else stretch if after else abs(sums[2])
        require(sums[0] + sums[1] - sums[2] - stretch >= -slip - 1e-9 * claimed, f"{place}: the powers do not prove {proved}")


class Evaluation:
    def __init__(self, p, o):
        place = "evaluation"
        known(o, "method law physics seed time_step iterations largest total seated scale cords schedule structure", place)
        self.old_pull = p.options.old_pull
        self.method = choice(o, "method", place, ("capstan", "joint", "structure"))
        require(("law" in o) == (self.method == "capstan"), "evaluation.law: with method capstan, and only with it")
        self.law = choice(o, "law", place, ("capstan", "mitre"), default="capstan")
        self.check_physics(p, member(o, "physics", "object", place))
        member(o, "seed", "integer", place, 0, 2**53)
        for key in ("time_step", "iterations"):
            member(o, key, "number", place, 5e-324)
        rows = member(o, "cords", "list", place)
        require(len(rows) == len(p.cords), "evaluation.cords: not one per cord")
        self.steps = [self.step(p, s) for s in member(o, "schedule", "list", place)] if "schedule" in o else []
        require("schedule" not in o or self.steps, "evaluation.schedule: empty")
        require("structure" not in o or self.method == "structure", "evaluation.structure: of another method")
        self.taut = "structure" in o and member(member(o, "structure", "object", place), "taut", "truth", "evaluation.structure")
        self.cords = cords = [Pulled(p, self, row, i) for i, row in enumerate(rows)]
        largest, total = max(c.force for c in cords), math.fsum(c.force + c.other for c in cords)
        near(member(o, "largest", "number", place), largest, largest, "evaluation.largest")
        near(member(o, "total", "number", place), total, total, "evaluation.total")
        if "seated" in o:
            self.check_seated(p, cords, member(o, "seated", "number", place, 0, 1))
        tensions = [x for c in cords for x in c.tension if x > 0 or not self.steps] or [0]
        scale = member(o, "scale", "object", place)
        known(scale, "low high", "evaluation.scale")
        for key, value in (("low", min(tensions)), ("high", max(tensions))):
            require(member(scale, key, "number", "evaluation.scale") == value, f"evaluation.scale.{key}: not {value}")
        for cord in cords:
            if cord.tension:
                cord.check_colours(min(tensions), max(tensions))
        self.standing = Standing(p, self, cords, o["structure"]) if "structure" in o else None

    def check_seated(self, p, cords, stated):
        """The part of the gaps that are pressed with the seating tension; those at the threshold count either way."""
        press = {}
        for cord, row in zip(p.cords, cords):
            require(len(row.tension) == len(cord.half), "evaluation.seated: not every cord is known")
            for h, x in zip(cord.half, row.tension):
                press[h >> 1] = press.get(h >> 1, 0) + x
        low, high = (sum(x >= self.physics["seating"] * (1 + s) for x in press.values()) / len(press) for s in (1e-8, -1e-8))
        require(low - 1e-9 <= stated <= high + 1e-9, f"evaluation.seated: {stated}, but the tensions seat {high}")

    def step(self, p, o):
        place = "evaluation.schedule"
        known(o, "cord do end pass force slip", place)
        do = choice(o, "do", place, ("pull", "grip", "release", "knot", "none"))
        require(("end" in o) == (do != "none"), f"{place}: end: not for {do}")
        end = choice(o, "end", place, ("start", "end", "both")) if do != "none" else "both"
        cord = member(o, "cord", "text", place)
        require(cord in [c.id for c in p.cords], f"{place}: no such cord")
        require(("pass" in o) == (do == "grip") and ("force" in o) == (do not in ("knot", "none")) and ("slip" in o) == (do == "knot"), f"{place}: not for {do}")
        return {"cord": cord, "do": do, "end": end, "pass": member(o, "pass", "integer", place, 0, default=0),
                "force": member(o, "force", "number", place, 0, default=0), "slip": member(o, "slip", "number", place, 0, default=0)}

    def check_physics(self, p, o):
        """Complete, and such that the parts fit."""
        self.physics = v = check_physics(o, "evaluation.physics")
        f = p.frame
        millimetres = UNITS[f.units.lower()]
        require(millimetres, "evaluation.physics: sizes, but nobody knows how long a unit is")
        shortest = min(math.dist(f.xyz[a], f.xyz[b]) for a, b in f.edge) * millimetres
        require(0 < v["cord_diameter"] < v["bore"] < min(shortest, v["bead_diameter"]), "evaluation.physics: cord, bore, bead and edges do not fit")
        require(0 < v["mu_low"] <= v["mu"] <= v["mu_high"], "evaluation.physics: the band of mu does not hold it")
        require(v["density"] or v["bead_mass"], "evaluation.physics: beads without mass")
        require(v["mu_tension"] or not v["mu_power"], "evaluation.physics.mu_tension: missing")
        require(v["mu_power"] in (0, 1) or self.law == "capstan" and self.method == "capstan", "evaluation.physics.mu_power: with another law")


def check_evaluation(p):
    p.evaluation = Evaluation(p, member(p.file, "evaluation", "object", "")) if "evaluation" in p.file else None


# ---- what is said of a plan that holds: word for word what `thread check` says ----


def some(n, one, many=None):
    return f"{n} {one if n == 1 else many or one + 's'}"


def proof_words(claim, value, less, least):
    """What is proved of a value that should be small: of a claim with `status` and `lower_bound`."""
    if claim["status"] == "optimal":
        return f"proved: {less}"
    if not claim["lower_bound"] > 0:
        return f"how near that is to the {least} is not known"
    above = max(0.0, 100 * (value / claim["lower_bound"] - 1))
    unit = 0.01 if above < 10 else 0.1 if above < 100 else 1
    return f"at most {'%.6g' % (unit * max(0, math.ceil(above / unit - 1e-9)))} % above the {least} (proved)"


def length_words(p):
    o, claim = p.options, p.proof.get("length")
    if claim is None:
        return "nothing is claimed"
    few_first = o.max_length is not None and o.counted and o.least < o.cords
    least = "shortest possible with so many cords" if few_first else "shortest possible"
    if o.objective == "symmetry":
        least = "shortest cords without symmetry"
    return proof_words(claim, p.file["metrics"]["length"], "with so many cords nothing shorter exists" if few_first else "nothing shorter exists", least)


def fewest_words(p, number, within):
    """A bound that is no more than the number of cords asked for was not proved, but asked for."""
    pieces, least = len(p.frame.pieces), p.options.least
    if number <= 1 or least > 1 and number <= least * pieces or p.options.ends == "counts":
        return ""
    asked = f"from {least} cords{' in each component' if pieces > 1 else ''} on, " if least > 1 else ""
    return f"; proved: {asked}fewer than {number}{'' if least > 1 else ' cords'} are impossible{within}"


def cords_words(p):
    claim, pull, words = p.proof.get("cords"), p.proof.get("pull"), ""
    if claim and p.options.balance:
        longest = claim["longest"]
        words += f"; longest cord {'%.7g' % longest['length']} {p.frame.unit}: " + proof_words(longest, longest["length"], "it can be no shorter", "shortest possible")
    if claim and "fewest" in claim:
        words += fewest_words(p, claim["fewest"]["lower_bound"], "")
    if pull:
        words += fewest_words(p, pull["lower_bound"], " within that pull")
    return words + ("; every joint tied" if p.options.tube else "")


def turning_words(p):
    o, claim = p.options, p.proof.get("turning")
    if o.objective != "tortuosity":
        return ""
    words = f"; turning {math.degrees(p.file['metrics']['turning']):.1f} deg: "
    if claim is None:
        return words + "nothing is claimed"
    angles, largest = o.cost == "angle", claim["largest"]
    if not angles:
        words += f"price {'%.9g' % claim['price']} ({o.cost}), "
    words += proof_words(claim, claim["price"], "nothing turns less" if angles else "nothing has a lower price", "least possible")
    if len(p.cords) == 1 and o.minimize == "turning":
        return words
    if o.pull:
        words += f"; the cord that is hardest to pull, {math.degrees(largest['price']):.1f} deg before an end: "
        return words + proof_words(largest, largest["price"], "it cannot be less", "least possible")
    words += f"; the cord that turns most, {math.degrees(largest['price']):.1f} deg: " if angles else f"; the dearest cord, {'%.6g' % largest['price']}: "
    return words + proof_words(largest, largest["price"], "it cannot turn less" if angles else "it cannot cost less", "least possible")


def symmetry_words(p):
    s = p.file.get("symmetry")
    name = s and (s["name"] and s["name"] + " ")
    return f"; group {name}of order {s['order']}, {some(s['unique_paths'], 'unique path')}, {'%g' % s['steps']} learned steps" if s else ""


def terms(p):
    """For which plans the claims hold."""
    o, f, claims, n = p.options, p.frame, p.proof, len(p.options.allowed)
    words = {"closed": "closed cords", "any": "cord ends at any node", "feet": f"cord ends at the {some(n, 'foot', 'feet')}",
             "nodes": f"cord ends at {n} given {'node' if n == 1 else 'nodes'}",
             "counts": f"given numbers of cord ends at {some(n, 'node')}"}[o.ends]
    words += f"; {some(o.cover, 'pass', 'passes')} of every edge or more" + (", as the framework says" if f.cover else "")
    words += f", by {o.distinct} different cords" if o.distinct else ""
    words += f", at most {o.capacity}" if o.capacity else ""
    words += (" or what the framework allows" if o.capacity else ", at most what the framework allows") if f.capacity else ""
    if o.ends == "counts":
        words += f"; {some(len(p.cords), 'cord')}"
    else:
        words += f"; {o.least} to {o.cords} cords" if o.least < o.cords else f"; {some(o.cords, 'cord')}"
        words += f" in each of {len(f.pieces)} components" if len(f.pieces) > 1 else ""
    words += f", none longer than {'%.12g' % o.max_length} {f.unit}" if o.max_length is not None else ""
    words += f", none that needs more than {'%.6g' % o.max_pull} times the seating tension at mu = {'%g' % o.mu}" if o.max_pull is not None else ""
    words += "; tube joints" if o.tube else "; solid joints"
    words += "; lengths of edges as given, not from their nodes" if f.own_lengths else ""
    bounded, back = "; for the %s: at most %d passes of an edge", ", back only at nodes with one edge"
    pull = claims.get("pull", {})
    most = [part["most_passes"] for part in [pull] + pull.get("parts", []) if "proof" in part]
    if most:
        words += bounded % ("fewest cords", min(most))
    if "turning" in claims:
        limit = claims["turning"].get("length_limit")
        words += bounded % ("turning", claims["turning"]["most_passes"]) + back + (" (for the pull anywhere)" if o.pull else "")
        words += f", at most {limit:.6f} {f.unit}" if limit is not None else ""
    return words


def step_words(s):
    """A step of a schedule."""
    if s["do"] == "none":
        return f"{s['cord']} none"
    grip = f" {s['pass'] + 1} {'%.6g' % s['force']} from" if s["do"] == "grip" else ""
    number = s["force"] if s["do"] in ("pull", "release") else s["slip"] or None if s["do"] == "knot" else None
    return f"{s['cord']} {s['do']}{grip} {s['end']}" + ("" if number is None else " %.6g" % number)


def structure_terms(p, standing):
    """All that the answers of the limit analysis depend on."""
    v, g = standing.physics, lambda x: "%.6g" % (x + 0.0)
    words = f"beads of {g(v['bead_mass'])} g" if v["bead_mass"] > 0 else f"beads of {g(v['density'])} g/cm3"
    words += f", {g(v['bead_diameter'])} mm wide, cords " + (f"of {g(v['cord_diameter'])} mm anywhere in" if standing.model > 1 else "in the middle of")
    words += f" bores of {g(v['bore'])} mm; friction {g(v['mu_bead'])} of beads, {g(v['mu_ground'])} of the ground, {g(v['mu'])} of cords"
    words += f" and {g(v['wobble'])} rad/m of wobble" if v["wobble"] > 0 else ""
    words += "; turns of the tight cords" if p.evaluation.taut else "; turns in the middles of the beads"
    words += "; feet are held" if standing.clamped else "; feet stand on discs" if standing.model > 1 else "; feet stand on squares"
    words += f" on ground that leans by {g(math.degrees(standing.tilt))} degrees towards {g(math.degrees(standing.azimuth))}" if standing.tilt > 0 else ""
    words += f"; gravity {g(v['gravity'])} m/s2"
    ways = (("both", "pulled at both ends"), ("start", "pulled at the start"), ("end", "pulled at the end"), ("none", "slack"))
    drawn = [(sum(pull == way for _, pull, _ in standing.drawn), text) for way, text in ways]
    words += "; " + ", ".join(f"{some(n, 'cord')} {text}" for n, text in drawn if n)
    steps = [step_words(s) for s in p.evaluation.steps]
    words += "; schedule " + ", ".join(steps[:24]) if steps else ""
    words += f" and {len(steps) - 24} more" if len(steps) > 24 else ""
    words += f"; knotted cords bear {g(standing.strength)} N" if standing.strength < math.inf else ""
    loads = [f"({', '.join(map(g, force))}) N at {CONTROL.sub(' ', p.frame.names[node])}" for node, force in standing.loads]
    words += "; load " + ", ".join(loads[:8]) if loads else ""
    return words + (f" and {len(loads) - 8} more" if len(loads) > 8 else "")


BELOW = {"holding": "N at the harder ends, while the cords are drawn in, nothing holds it", "equal": "N at all ends, while the cords are drawn in, nothing holds it",
         "any_state": "N at all ends, whatever was done to the cords before, nothing holds it", "after": "of the tensions that the schedule leaves nothing holds it",
         "loaded": "N at all ends, while the cords are drawn in, it does not carry the load",
         "stretch": "N m, by which the tension of knotted cord grows x its length, nothing holds it after the schedule",
         "tightest": "N in every pass of knotted cord nothing holds it after the schedule"}


def structure_lines(p, standing):
    lines = [f"terms of the structure: {structure_terms(p, standing)}"]
    for asked, pull, proved in standing.found:
        if proved is None:
            continue
        if asked in BELOW:
            lines.append(f"below {'%.6g' % proved} {BELOW[asked]}: verified")
        elif asked == "carried":
            lines.append(f"{'%.6g' % pull} N at all ends carry no more than {'%.4g' % proved} times the load: verified")
        else:
            lines.append(f"after the schedule it carries no more than {'%.4g' % proved} times the load: verified")
    return lines + ["not verified: that the equilibria which the limit analysis found exist"]


def said(p):
    """The lines about a plan that holds."""
    o, e, metrics = p.options, p.evaluation, p.file["metrics"]
    lines = [f"holds: {some(len(p.cords), 'cord')}, {metrics['passes']} passes, every edge covered, {'%.7g' % metrics['length']} {p.frame.unit}: "
             f"{length_words(p)}{cords_words(p)}{turning_words(p)}{symmetry_words(p)}", f"terms: {terms(p)}"]
    if o.objective == "tortuosity" and o.slack is not None:
        proved = "length" in p.proof and "slack" not in p.proof["length"]
        lines.append(f"cord at most {'%g' % (100 * o.slack + 0.0)} % above the least length: {'verified' if proved else 'not verified'}")
    if o.objective == "symmetry" and (o.group or "")[:1].isdigit():
        lines.append(f"not verified: that the group is row {o.group} of a table of symmetries")
    if p.proof.get("turning", {}).get("pairing_bound", 0) > 0:
        lines.append("not verified: pairing_bound, which plans no longer state")
    if e and e.method != "capstan" and (not e.standing or e.taut):
        lines.append("not verified: the turns of the tight cords; what follows from them is" if e.taut else
                     f"not verified: the tensions, which method {e.method} measured; what follows from them is")
    if p.left_out:
        lines.append("not verified: what a plan of version 1 proves within its limit on the pull")
    if o.old_pull and (o.max_pull is not None or e and (e.standing or not e.steps and any(cord.pull == "both" for cord in e.cords))):
        lines.append("pulls at both ends are those of plans of version 1, which ask both for the pass in the middle: more than is needed")
    return lines + (structure_lines(p, e.standing) if e and e.standing else [])


def check(data):
    """Lines that say what is verified of a plan; Violation or Unreadable. What is of a type, or so large, that it cannot be computed
    with is a violation, too."""
    try:
        return verify(data)
    except (TypeError, AttributeError, KeyError, IndexError, ValueError, ArithmeticError, RecursionError) as error:
        raise Violation(f"a member of a wrong type or size: {error}") from None


def verify(data):
    """The same, with Python's own exceptions."""
    p = Plan(parse(data))
    check_cords(p)
    check_metrics(p)
    check_distinct(p)
    check_crossings(p)
    check_symmetry(p)
    for part in parts(p):
        check_length(part)
        check_cords_claim(part)
        check_pull(part)
        check_turning(part)
    check_evaluation(p)
    return said(p)


def main(arguments):
    quiet, seconds, names = False, None, []
    rest = iter(arguments)
    for x in rest:
        if x == "-q":
            quiet = True
        elif x == "--time-limit":
            seconds = next(rest, "")
        elif x.startswith("-") and x != "-":
            names = []
            break
        else:
            names.append(x)
    try:
        seconds = None if seconds is None else max(0.0, float(seconds))
    except ValueError:
        names = []
    if not names:
        sys.stderr.write(__doc__)
        return 2
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    gc.disable()  # what is left over is small
    resource.setrlimit(resource.RLIMIT_DATA, (MEMORY, resource.getrlimit(resource.RLIMIT_DATA)[1]))
    worst = 0
    for name in names:
        code, words = judge(name, seconds)
        if code:
            print(clean(f"{name}: {words}"), file=sys.stderr)
        elif not quiet:
            print(clean(f"{name}: {words[0]}"))
            print("".join(f"  {line}\n" for line in words[1:]), end="")
        worst = max(worst, code)
    return worst


def judge(name, seconds):
    """Exit code of a plan, and the lines about it or why it fails."""
    try:
        try:
            if name == "-":
                data = sys.stdin.buffer.read()
            else:
                with open(name, "rb") as file:
                    data = file.read()
            bound_work(seconds, len(data))
            return 0, check(data)
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)
    except Violation as error:
        return 1, str(error)
    except (Unreadable, OSError) as error:
        return 3, str(getattr(error, "strerror", None) or error)
    except NotChecked as error:
        return 5, f"not checked: {error}"
    except MemoryError:
        return 5, f"not checked: needs more than {MEMORY / 1e6:g} MB"


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
