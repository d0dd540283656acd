# SPDX-License-Identifier: MIT
"""Plans how cord is threaded through bead structures, proves the plan, draws it.

    import thread_plan

    frame = thread_plan.Frame.shape("dome", 7)          # or Frame(xyz, edges), read("shell.obj"), parse(bytes, "a.dxf")
    plan = frame.plan()                                  # what is recommended, or cords=4, ends="feet", aims="turning"
    for cord in plan.cords:
        print(cord.name, cord.length, cord.pull_start, cord.tension)
    plan.check()
    plan.write("plan.json")
    plan.draw("svg", "overview.svg")

Lengths are in the frame's units (Frame.units), angles in rad, forces in N, times in s; nodes and cords are numbers from 0. Coordinates
and edges may be lists or numpy arrays; Frame.array() and Frame.edge_array() give arrays where numpy is installed. Frames and plans are
freed with their last reference, or at the end of a `with` block.

Failures are exceptions with one line of text that says where, what, and what to do: BadInput (a ValueError: a file, a frame or an
option is wrong), Infeasible (there is no such threading), NotProved (time or progress ended a call before there was anything), Violated
(a claim of a plan is not true), OSError, MemoryError, or Error, of which the first four are. TypeError: no such option, or no value
for it.

What takes long hears `progress` and can be given `seconds`, of which it takes at most a tenth and 0.2 s more; Ctrl-C ends it within
half a second. `progress(what, best, bound)` is called in the thread of the call and at least every 0.1 s: what is being done in words,
the best value so far (a length, or rad of turning; inf: none yet) and what it cannot be less than. It ends the call by returning True,
and is not called again then; what it raises ends the call, too, and is raised there. Plan.stopped, and "stopped" in the dictionaries of
advice, symmetries, rise and compare, say that time or progress ended a call: what there is then is right as far as it goes.

Calls in several threads wait for each other: seconds and progress begin when the turn of a call comes. threads= lets one search use
several processors; processes (multiprocessing) run side by side, and frames and plans can be sent between them.
"""
from __future__ import annotations

import importlib
import json
import os
import signal
import threading
import warnings
from ctypes import POINTER, byref, c_char_p, c_double, c_int, c_size_t, c_void_p, sizeof
from dataclasses import dataclass
from typing import Any, Callable, Dict, Iterable, List, Literal, Mapping, Optional, Sequence, Tuple, TypeVar, Union

from . import _library
from ._library import BadInput, Error, Infeasible, NotProved, Violated

__all__ = ["BadInput", "Comparison", "Cord", "Document", "Ends", "Error", "Format", "Frame", "Heard", "Infeasible", "Method",
           "NotProved", "Physics", "Plan", "PullWarning", "Shape", "StoppedWarning", "Summary", "Violated", "__version__", "compare",
           "libraries", "parse", "read", "version"]

Heard = Callable[[str, float, float], Optional[bool]]
Ends = Union[Literal["closed", "any", "feet"], Iterable[int], Mapping[int, int]]
Shape = Literal["dome", "geodesic", "tube", "sphere", "honeycomb", "row", "arch", "alternating"]
Format = Literal["json", "obj", "csv", "ply", "dxf", "graphml"]
Method = Literal["capstan", "joint", "structure"]
Comparison = Literal["joint", "capstan", "structure", "all", "rise"]
Document = Literal["svg", "pdf", "steps", "html", "steps.csv", "cords.csv", "beads.csv", "channels.csv", "obj", "dxf", "gltf", "mat",
                   "compas", "sheets.html", "mat.html", "poster", "kit", "picture"]
Path = Union[str, "os.PathLike[str]"]
Words = Union[str, Sequence[str]]
Physics = Union[str, Mapping[str, Any]]
_ends = {"closed": 0, "any": 1, "feet": 2}


class PullWarning(UserWarning):
    """A cord of the recommended plan needs more pull than a hand has (Frame.plan): no number of cords was found that it can pull."""


class StoppedWarning(PullWarning):
    """The same, because the search was stopped."""


@dataclass(frozen=True)
class Cord:
    """A cord of a plan. Forces are those of the plan's evaluation (Plan.eval); without one, of the closed form while both ends are
    pulled until every pass has the seating tension."""

    name: str
    """"A", "B", .., as documents call it."""
    nodes: List[int]
    """Where it runs, passes + 1 nodes: of Frame.nodes, from 0."""
    length: float
    """In units of the frame, without tails and knots."""
    turning: float
    """rad, of all its turns on the way."""
    pull_start: float
    """N at nodes[0]: 0 = not pulled there, or after eval("structure") needed by nothing to stand; inf = beyond all numbers."""
    pull_end: float
    """N at nodes[-1]."""
    tension: Optional[List[float]]
    """N in every pass: tension[k] between nodes[k] and nodes[k + 1]; None: not known."""
    grips: Optional[int] = None
    """How often, at the least, the cord must be gripped and pulled tight somewhere on its way, beside the pull at its ends, for a hand
    of 10 N to leave the seating tension in every pass; 0: the ends are enough. None: not known, or the seating tension alone is more."""

    def __repr__(self) -> str:
        pulled = "pulled with %.3g and %.3g N" % (self.pull_start, self.pull_end)
        return "<Cord %s: %d passes from node %d to %d, %.6g long, %s>" % (
            self.name, self.passes, *self.ends, self.length, pulled if self.pull_start or self.pull_end else "stands unpulled")

    def __hash__(self) -> int:  # of what cannot be hashed by itself, as nodes are a list, which numpy takes as indices
        return hash((self.name, tuple(self.nodes)))

    @property
    def ends(self) -> Tuple[int, int]:
        """The nodes where it comes out; the same for a closed cord."""
        return self.nodes[0], self.nodes[-1]

    @property
    def passes(self) -> int:
        """Edges that it passes, one after another."""
        return len(self.nodes) - 1


@dataclass(frozen=True)
class Summary:
    """A plan in numbers."""

    length: float
    """Of all cords, in units of the frame."""
    bound: float
    """No such plan is shorter; 0: not known."""
    overlap: float
    """Of length, what passes edges again that have their passes."""
    turning: float
    """rad, of all cords, with the closing turns of closed ones."""
    largest_turning: float
    """rad, of the cord that turns most."""
    pull: float
    """N at an end, of the cord that needs most; inf: beyond all numbers."""
    passes: int
    """Of all cords."""
    u_turns: int
    """Turns by which a cord goes back into the edge that it came from."""
    shortest: bool
    """Proved: no such plan is shorter."""
    straightest: bool
    """Proved: no such plan turns less."""
    stopped: bool = False
    """Time or progress ended the search before it was done: the pull may be beyond a hand's."""


_Owned = TypeVar("_Owned", bound="_Owner")


class _Owner:
    """Holds a handle of the library, and frees it once."""

    _handle: c_void_p
    _free: Any

    def close(self) -> None:
        """Frees it now; nothing else can be done with it then."""
        handle, self._handle = getattr(self, "_handle", None), c_void_p()
        if handle:
            type(self)._free(handle)

    def __enter__(self: _Owned) -> _Owned:
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()

    def __del__(self) -> None:
        self.close()

    def _open(self) -> c_void_p:
        if not self._handle:
            raise ValueError("this %s is closed" % type(self).__name__.lower())
        return self._handle


class Frame(_Owner):
    """Nodes in space, which are bead pieces with an arm to the middle of each edge, and edges between them, the interfaces of two
    pieces, which cords pass. (With tube=True each edge is a piece.)

    Frame(xyz, edges, units="mm"): xyz are n points of three numbers, edges pairs of nodes from 0; both are copied, and may be numpy
    arrays of n x 3 and m x 2. units: of the numbers: "mm", "cm", "m", "in" or "ft". BadInput: two nodes in one place, an edge given
    twice or of no length, a node without an edge; read() and parse() mend such things.
    """

    _free = _library.lib.thread_frame_free
    _notes: Optional[List[str]] = None  # of the frame that this one is a copy of

    def __init__(self, xyz: Iterable[Sequence[float]], edges: Iterable[Sequence[int]], units: str = "mm") -> None:
        points, pairs = [tuple(p) for p in xyz], [tuple(e) for e in edges]
        if any(len(p) != 3 for p in points) or any(len(e) != 2 for e in pairs):
            raise BadInput(_library.BAD_INPUT, "a point has three coordinates, and an edge two nodes")
        flat = [_library.real("node %d" % i, x) for i, p in enumerate(points) for x in p]
        ends = [_library.whole("edge %d" % i, v) for i, e in enumerate(pairs) for v in e]
        self._handle = c_void_p()
        _library.call(_library.lib.thread_frame_make, c_int(len(points)), (c_double * len(flat))(*flat), c_int(len(pairs)),
                      (c_int * len(ends))(*ends), _library.text("units", units), byref(self._handle))

    def __reduce__(self) -> Any:
        return parse, (self.write("json"), "frame.json"), {"_notes": self.notes}

    def __repr__(self) -> str:
        if not self._handle:
            return "<Frame, closed>"
        return "<Frame: %d nodes, %d edges, %d feet, in %s>" % (len(self.nodes), len(self.edges), len(self.feet), self.units)

    @classmethod
    def _made(cls, function: Any, *args: Any) -> "Frame":
        frame = cls.__new__(cls)
        frame._handle = c_void_p()
        _library.call(function, *args, byref(frame._handle))
        return frame

    @classmethod
    def shape(cls, shape: Shape, size: int = 0) -> "Frame":
        """An example: "dome", "geodesic", "sphere", "tube", "honeycomb", "row", "arch" or "alternating". size: what `thread make`
        counts, of a dome the nodes per side; 0 is the usual one. In mm. BadInput: no such shape or size."""
        return cls._made(_library.lib.thread_frame_shape, _library.text("shape", shape), c_int(_library.whole("size", size)))

    @property
    def nodes(self) -> List[Tuple[float, float, float]]:
        """x, y and z of every node, z upwards, in units of the frame."""
        xyz = POINTER(c_double)()
        n = _library.lib.thread_frame_nodes(self._open(), byref(xyz))
        flat = xyz[:3 * n]
        return list(zip(flat[0::3], flat[1::3], flat[2::3]))

    @property
    def edges(self) -> List[Tuple[int, int]]:
        """The two nodes of every edge."""
        ends = POINTER(c_int)()
        n = _library.lib.thread_frame_edges(self._open(), byref(ends))
        flat = ends[:2 * n]
        return list(zip(flat[0::2], flat[1::2]))

    def array(self) -> Any:
        """The nodes as a numpy array of n x 3."""
        return importlib.import_module("numpy").array(self.nodes, dtype=float).reshape(-1, 3)

    def edge_array(self) -> Any:
        """The edges as a numpy array of n x 2."""
        return importlib.import_module("numpy").array(self.edges, dtype=int).reshape(-1, 2)

    @property
    def names(self) -> List[str]:
        """What documents call the nodes: "D4", .."""
        return [str(_library.lib.thread_frame_name(self._open(), c_int(i)).decode()) for i in range(len(self.nodes))]

    @property
    def feet(self) -> List[int]:
        """The nodes where cords may end with ends="feet" (set_feet)."""
        return [int(v) for v in self._facts().get("feet", [])]

    @property
    def units(self) -> str:
        """Of coordinates and lengths: "mm", "m", .."""
        return str(self._facts()["units"])

    def _facts(self) -> Dict[str, Any]:
        facts: Dict[str, Any] = json.loads(self.write("json"))
        return facts

    @property
    def notes(self) -> List[str]:
        """What reading merged, dropped or found odd, a line each."""
        if self._notes is not None:
            return list(self._notes)
        return [str(line) for line in _library.lib.thread_frame_notes(self._open()).decode().splitlines()]

    def set_feet(self, nodes: Union[str, Iterable[int]] = "lowest") -> "Frame":
        """Says where cord ends may come out with ends="feet": at these nodes, at the "lowest" ones, on the "rim", all
        along the borders of a shell, arches in the air too, or up to a height, "below=200mm". A mask, True or False for every
        node, does as well. Returns the frame. BadInput: no such nodes; nothing changes then."""
        if isinstance(nodes, str):
            _library.call(_library.lib.thread_frame_set_feet_where, self._open(), nodes.encode())
            return self
        feet = self._nodes("feet", nodes)
        _library.call(_library.lib.thread_frame_set_feet, self._open(), c_int(len(feet)), feet)
        return self

    def _nodes(self, name: str, nodes: Iterable[int]) -> Any:
        """An array of C ints of nodes, or of a mask that has True or False for every node."""
        if isinstance(nodes, bytes) or not isinstance(nodes, Iterable):
            raise TypeError("%s: %r is neither a list of nodes, nor a mask, nor a word for some" % (name, nodes))
        given = list(nodes)
        if given and all(_library.is_flag(v) for v in given):
            if len(given) != len(self.nodes):
                raise BadInput(_library.BAD_INPUT, "%s: a mask of %d, but there are %d nodes" % (name, len(given), len(self.nodes)))
            given = [v for v, is_one in enumerate(given) if is_one]
        return _library.ints(name, given)

    def set_passes(self, edge: int, cover: int, capacity: int = 0) -> None:
        """Says how many passes an edge, from 0, needs (1 to 100), and how many fit through it (0 = any number). BadInput: no such
        edge, or capacity below cover."""
        _library.call(_library.lib.thread_frame_set_passes, self._open(), *[
            c_int(_library.whole(name, value)) for name, value in (("edge", edge), ("cover", cover), ("capacity", capacity))])

    def write(self, format: Format = "json", path: Optional[Path] = None) -> bytes:
        """The bytes of the frame as "json", "obj", "csv", "ply", "dxf" or "graphml", which are also written to path, if there is one.
        BadInput: no such format."""
        return _kept(_library.received(_library.lib.thread_frame_write, self._open(), _library.text("format", format)), path)

    def plan(self, ends: Optional[Ends] = None, cords: Optional[Union[int, Tuple[int, int]]] = None,
             progress: Optional[Heard] = None, *, aims: Optional[Words] = None, seconds: Optional[float] = None,
             cover: Optional[int] = None, capacity: Optional[int] = None, distinct: Optional[int] = None,
             max_length: Optional[float] = None, max_pull: Optional[float] = None, tube: Optional[bool] = None,
             physics: Optional[Physics] = None, hand: Optional[float] = None, gap: Optional[float] = None,
             threads: Optional[int] = None, request: Optional[Physics] = None) -> "Plan":
        """Makes the best plan that the time allows; Plan.proved says whether nothing is better, Plan.stopped whether it was ended.

        If of cords, aims, distinct, max_length, max_pull, gap and request nothing is said it is the recommended plan, as of
        `thread plan FRAME`: as few cords as `hand` can pull, from the best ends, the shortest. One that was stopped before some
        were found that it can is a StoppedWarning; if none were found at all, a PullWarning. Else it is what
        `thread plan FRAME` makes with the same options.

        ends: "closed", "any", "feet" (set_feet), a list of nodes, a mask, or {node: number of ends}; of the recommended plan the
            best ones if they are not said, else "closed".
        cords: exactly so many in every component, 1 to 1000, or (least, most); without them as few as max_length and max_pull
            take, else as many as distinct, else 1.
        aims: what is to be least, first, second, ..: "length", "turning", "max-turning", "pull", "longest", "overlap", "steps",
            "paths"; "length+5%,turning". Without them "length", if the plan is not the recommended one: aims="length" alone is the
            shortest single cord of every component.
        seconds: for the call; 0 = until it is proved. Without them 20, or until it is proved of the shortest cords.
        cover, capacity: passes of every edge, from .. to; 1, or as many as distinct, to any number (0), or what goes through the
            bore that physics say.
        distinct: different cords that pass every edge, from 2; 0 = any.
        max_length: of a cord, in units of the frame. max_pull: at its ends, times the seating tension, from 1. 0 = any.
        tube: only edges are pieces, and the cord ties them at every node. False without.
        physics: of cord and beads, {"mu": 0.3, "seating": 5} or as JSON. Friction: "mu" 0.2 (cord on bead), "mu_low" and "mu_high"
            (what it may be: half of it, one and a half), "mu_bead" and "mu_ground" 0.25, "mu_power" and "mu_tension" (it falls as
            the tension grows, N), "wobble" (rad/m). Forces: "seating" 1 N (the tension that is left in the slackest pass),
            "gravity" (m/s2), "stiffness" (N), "bead_strength" (MPa). Sizes in mm: "cord_diameter", "bore", "bead_diameter";
            "bead_mass" (g), "density" (g/cm3). "preset": a set of them, as "pla-cotton". Plan.json has the values that were taken.
        hand: N that an end of the recommended plan may need; 10 without, which a hand manages time after time. BadInput with any
            other plan, whose pull max_pull limits.
        gap: %, 0 to 100, the search ends so near to its bound.
        threads: processors that it may use, 1 to 1000, 1 without; they change no result but of a search that time ends.
        request: all that is asked for, as "options" of a plan's JSON (Plan.json); the rest but seconds, gap and threads does not count.

        A frame in several components is planned in one go: every component has cords of its own, as many as are said.

        BadInput: an option is wrong. Infeasible: there is no such threading. NotProved: nothing was found in time.
        """
        said = dict(aims=aims, seconds=seconds, cover=cover, capacity=capacity, distinct=distinct, max_length=max_length,
                    max_pull=max_pull, tube=tube, physics=physics, hand=hand, gap=gap, threads=threads, request=request)
        given = self._asked(ends, cords, said)
        plan = Plan.__new__(Plan)
        plan._handle = c_void_p()
        status, error = _heard(given, progress, lambda text: int(_library.lib.thread_plan_make(
            self._open(), byref(given), byref(plan._handle), byref(text))))
        if not plan._handle:
            raise _library.failure(status, error)
        recommended = cords is None and not isinstance(ends, Mapping) and all(said[name] is None for name in (
            "aims", "distinct", "max_length", "max_pull", "gap", "request"))
        pull = plan.summary.pull
        if recommended and pull > (hand or 10):
            text = str(_library.failure(status, error)) if plan.stopped else (
                "a cord needs %.3g N at an end, more than the %g N of a hand; no number of cords was found that it can pull" % (
                    pull, hand or 10))
            warnings.warn(text, StoppedWarning if plan.stopped else PullWarning, stacklevel=2)
        return plan

    def advice(self, progress: Optional[Heard] = None, *, hand: Optional[float] = None, cover: Optional[int] = None,
               capacity: Optional[int] = None, physics: Optional[Physics] = None, seconds: Optional[float] = None,
               threads: Optional[int] = None) -> Dict[str, Any]:
        """Plans for every number of cords and kind of ends that may be worth it, in numbers, as `thread advise --json` says it: "rows",
        and in "recommended" which one of them, from 0, or None: no row stays within "hand". Options as of plan(). NotProved: no row
        was found in time. Of a row: "cords" in every component and their "ends"; "length" of all and "longest" cord, in units;
        "max_turning", rad, of the cord that turns most, and the bound on it; "pull", "pull_low", "pull_high": N at the hardest end
        with mu, mu_low and mu_high, both ends pulled, and "other_pull" at that cord's other end; "passes" of all cords, and "steps",
        those that no symmetry repeats; "frontier": no other row is as good in cords, length and pull, and better in one;
        "max_turning_status": "optimal" (proved the least), "bound" ("max_turning_bound" is what it cannot be less than) or "unknown".
        Of all rows: "complete", False: time or work was over before all numbers were tried; "left_out": rows that bought nothing, and
        are not shown; "hand", "seating", "mu", "mu_low" and "mu_high" that were taken. advised() makes the plan of a row."""
        return self._report("advice", None, progress, dict(
            hand=hand, cover=cover, capacity=capacity, physics=physics, seconds=seconds, threads=threads))

    def advised(self, cords: int, ends: Optional[Ends] = None, progress: Optional[Heard] = None, *, hand: Optional[float] = None,
                cover: Optional[int] = None, capacity: Optional[int] = None, physics: Optional[Physics] = None,
                seconds: Optional[float] = None, threads: Optional[int] = None) -> "Plan":
        """The plan of a row of advice() with the same options, which is searched for again: of so many cords in every component, with
        these ends, "closed", "any" or "feet", or of the first such row. Nothing is proved of it; plan() proves what it can.

            row = frame.advice()["rows"][2]
            plan = frame.advised(row["cords"], row["ends"])

        Infeasible: there is no such row."""
        data, stopped = _made(self._asked(ends, _library.whole("cords", cords), dict(
            hand=hand, cover=cover, capacity=capacity, physics=physics, seconds=seconds, threads=threads)),
            progress, _library.lib.thread_report, self._open(), b"row")
        plan = Plan(data)
        plan._stopped = stopped
        return plan

    def symmetries(self, ends: Optional[Ends] = None, progress: Optional[Heard] = None, *, aims: Optional[Words] = None,
                   cover: Optional[int] = None, tube: Optional[bool] = None, physics: Optional[Physics] = None,
                   seconds: Optional[float] = None, threads: Optional[int] = None) -> Dict[str, Any]:
        """The groups of the frame's symmetries and the best threading under each, in "groups", as `thread symmetries --json` says it.
        Options as of plan(); 20 s without seconds. NotProved: nothing was found in time."""
        return self._report("symmetries", ends, progress, dict(
            aims=aims, cover=cover, tube=tube, physics=physics, seconds=seconds, threads=threads))

    def _asked(self, ends: Optional[Ends], cords: Optional[Union[int, Tuple[int, int]]], options: Mapping[str, Any]) -> Any:
        if isinstance(cords, (list, tuple)) and len(cords) != 2:
            raise TypeError("cords: %r is neither a number nor (least, most)" % (cords,))
        least, most = cords if isinstance(cords, (list, tuple)) else (None, cords)
        given = _library.filled(_library.PlanOptions(), _library.lib.thread_plan_options_init,
                                dict(options, cords_least=least, cords=most))
        if isinstance(ends, str):
            if ends not in _ends:
                raise BadInput(_library.BAD_INPUT, 'ends: %r is not "closed", "any", "feet", a list of nodes or numbers of ends' % ends)
            given.ends = _ends[ends]
        elif isinstance(ends, Mapping):
            count = [0] * len(self.nodes)
            for v, n in zip(_library.ints("ends", ends), ends.values()):
                if not 0 <= v < len(count):
                    raise BadInput(_library.BAD_INPUT, "ends: there is no node %d, only 0 to %d" % (v, len(count) - 1))
                count[v] = n
            given.ends, given.end_count = 4, _library.ints("ends", count)
        elif ends is not None:
            node = self._nodes("ends", ends)
            given.ends, given.n_end_nodes, given.end_node = 3, len(node), node
        return given

    def _report(self, what: str, ends: Optional[Ends], progress: Optional[Heard], options: Mapping[str, Any]) -> Dict[str, Any]:
        return _reported(self._asked(ends, None, options), progress, _library.lib.thread_report, self._open(), what.encode())


class Plan(_Owner):
    """Cords through a frame, and what is proved of them: by Frame.plan(), Plan.read(path), or Plan(json), the text of its file.

    BadInput: it is no plan; check() says whether what it claims is true.
    """

    _free = _library.lib.thread_plan_free
    _stopped = False  # the plan that this one is a copy of

    def __init__(self, json: Union[str, bytes], name: str = "plan") -> None:
        """Reads a plan from its JSON; name is for messages."""
        text = json.encode() if isinstance(json, str) else json
        if not isinstance(text, (bytes, bytearray)):
            raise TypeError("a plan is read from its JSON, text or bytes, and %r is neither" % (json,))
        self._handle = c_void_p()
        _library.call(_library.lib.thread_plan_parse, bytes(text), c_size_t(len(text)), _library.text("name", name), byref(self._handle))

    def __reduce__(self) -> Any:
        return Plan, (self.json(),), {"_stopped": self.stopped}

    def __repr__(self) -> str:
        if not self._handle:
            return "<Plan, closed>"
        facts, n = self.summary, int(_library.lib.thread_plan_cords(self._open()))
        known = "proved the shortest" if facts.shortest else "proved the straightest" if facts.straightest else (
            "not proved")
        pulled = "at most %.3g N at an end" % facts.pull if facts.pull else "stands without any pull"
        return "<Plan: %d %s, %.7g %s, %s, %s>" % (
            n, "cord" if n == 1 else "cords", facts.length, self.frame.units, pulled, known + (", stopped" if facts.stopped else ""))

    @classmethod
    def read(cls, path: Path) -> "Plan":
        """Reads a plan from a file. OSError, BadInput."""
        with open(path, "rb") as file:
            return cls(file.read(), os.fspath(path))

    @property
    def frame(self) -> Frame:
        """A copy of the frame of this plan."""
        return parse(_library.received(_library.lib.thread_frame_write, c_void_p(_library.lib.thread_plan_frame(self._open())), b"json"),
                     "plan.json")

    @property
    def cords(self) -> List[Cord]:
        """All cords, with length, pulls and the tension of every pass."""
        return [self._cord(i) for i in range(_library.lib.thread_plan_cords(self._open()))]

    def _cord(self, i: int) -> Cord:
        facts = _library.CordFacts()
        _library.call(_library.lib.thread_plan_cord_summary, self._open(), c_int(i), byref(facts), c_size_t(sizeof(facts)))
        return Cord(name=facts.name.decode(), nodes=facts.node[:facts.passes + 1], length=facts.length, turning=facts.turning,
                    pull_start=facts.pull_start, pull_end=facts.pull_end,
                    tension=facts.tension[:facts.passes] if facts.tension else None, grips=facts.grips if facts.grips >= 0 else None)

    @property
    def summary(self) -> Summary:
        """Length, bound, turning, pull and so on."""
        facts = _library.SummaryFacts()
        _library.call(_library.lib.thread_plan_summary, self._open(), byref(facts), c_size_t(sizeof(facts)))
        return Summary(length=facts.length, bound=facts.bound, overlap=facts.overlap, turning=facts.turning,
                       largest_turning=facts.largest_turning, pull=facts.pull, passes=facts.passes, u_turns=facts.u_turns,
                       shortest=bool(facts.shortest), straightest=bool(facts.straightest),
                       stopped=bool(facts.stopped) or self._stopped)

    @property
    def proved(self) -> bool:
        """Has no such plan less cord, or does none turn less?"""
        return self.summary.shortest or self.summary.straightest

    @property
    def stopped(self) -> bool:
        """Did time or progress end its search before it was done? Then the pull may be beyond a hand's. A plan that was read knows
        nothing of its search: False."""
        return self.summary.stopped

    def check(self) -> None:
        """Verifies every claim of the plan without a solver; raises Violated, which says what is not true."""
        _library.call(_library.lib.thread_check, self._open())

    def eval(self, method: Method = "capstan", seconds: float = 0.0, progress: Optional[Heard] = None,
             threads: Optional[int] = None) -> "Plan":
        """Puts pulls and tensions by "capstan" (the closed form), "joint" (joints measured in simulation) or "structure" into the plan,
        which is returned; Plan.cords has them. seconds 0 = as long as it takes. "capstan" and "joint": the pulls that leave the
        seating tension in every pass. "structure": the least pulls at which the rigid pieces can stand while cords are drawn in,
        by limit analysis; 0 N, in every pass, too, is true of what weight and friction hold by themselves.
        BadInput: no such method. NotProved: the time was too short; the plan is as it was."""
        given, named = _options(dict(seconds=seconds, threads=threads)), _library.text("method", method)
        status, error = _heard(given, progress, lambda text: int(_library.lib.thread_eval_with(
            self._open(), named, byref(given), byref(text))))
        if status != _library.OK:
            raise _library.failure(status, error)
        return self

    def rise(self, seconds: float = 0.0, progress: Optional[Heard] = None) -> Dict[str, Any]:
        """Whether its pieces come up in simulation: laid flat on the ground, all ends of the cords pulled with a force that grows to
        50 N, as `thread rise --json` says it. It takes a minute of a processor for 49 pieces. NotProved: nothing was seen in time.

        "pieces": how many. "faces": passes of cords over faces between two pieces. "weight": N, of all pieces as they are printed.
        "closed_form", "limit_analysis": N at every end, what seats every pass, and what the closed shape cannot stand below.
        "seconds_a_frame": between two moments. "jam": where faces stay open, and what to try; not there if none do.
        "runs": one. In it "came_up": all faces are closed in the end, and it is upright; "pull_up": N at every end at which
        that was so, not there if it did not come up; "pull_down": N below which it fell when it was let down, not there if it did not
        fall or the time was over before; "most_closed": faces closed at once; "off": mm, of the
        node farthest from the drawn shape; "tilt": degrees; "kink", "twist": degrees for every pass; "moments": rows of time in s,
        N at every end, mm of cord drawn in, closed faces, mm of height, N of a hand that lifts."""
        return _reported(_options(dict(seconds=seconds)), progress, _library.lib.thread_report_plans,
                         byref(self._open()), c_int(1), b"rise")

    def json(self) -> bytes:
        """The plan as its file has it, which docs/plan-format.md describes: the same bytes for the same plan."""
        return _library.received(_library.lib.thread_plan_write, self._open())

    def write(self, path: Path) -> None:
        """Writes the plan to a file. OSError."""
        _kept(self.json(), path)

    def draw(self, type: Document = "svg", path: Optional[Path] = None, progress: Optional[Heard] = None,
             seconds: float = 0.0) -> bytes:
        """The bytes of a document as `thread draw --type` makes it, which are also written to path, if there is one: "svg"
        (the picture of all cords), "pdf" and "sheets.html" (the booklet), "html" (the viewer), "steps" (as text), the tables
        "steps.csv", "cords.csv", "beads.csv" and "channels.csv", the cords as "obj", "dxf", "gltf" or "compas", "mat" and "mat.html"
        (to lay the pieces out on), "poster", "picture" (PNG, of the printed pieces), "kit" (the pieces to print as 3MF:
        draw("kit", "kit.3mf"); `thread kit` with the file of the plan makes STL, too, and other sizes). BadInput: no such document, or the plan
        has not what it shows."""
        given = _options(dict(seconds=seconds))
        return _kept(_made(given, progress, _library.lib.thread_draw_with, self._open(), _library.text("type", type))[0], path)


def _options(given: Mapping[str, Any]) -> Any:
    return _library.filled(_library.PlanOptions(), _library.lib.thread_plan_options_init, given)


def _made(given: Any, progress: Optional[Heard], function: Any, *of: Any) -> Tuple[bytes, bool]:
    """The bytes that a function with options makes, and whether it was stopped before they were all."""
    data, n = c_void_p(), c_size_t()
    try:
        status, error = _heard(given, progress, lambda text: int(function(
            *of, byref(given), byref(data), byref(n), byref(text))))
    except BaseException:
        _library.lib.thread_free(data)
        raise
    if not data:
        raise _library.failure(status, error)
    return _library.taken(data, n), status == _library.NOT_PROVED


def _reported(given: Any, progress: Optional[Heard], function: Any, *of: Any) -> Dict[str, Any]:
    data, stopped = _made(given, progress, function, *of)
    report: Dict[str, Any] = json.loads(data)
    report["stopped"] = stopped
    return report


def _heard(given: Any, progress: Optional[Heard], call: Callable[[Any], int]) -> Tuple[int, Any]:
    """Status and text of a call with these options, while progress hears how far it is. Raises what that raised, and what Ctrl-C does."""
    raised: List[BaseException] = []
    if progress is not None and not callable(progress):
        raise TypeError("progress: %r is no function" % (progress,))

    def hear(_: Any, what: bytes, best: float, bound: float) -> int:
        try:
            return 1 if raised or (progress is not None and progress(what.decode(), best, bound)) else 0
        except BaseException as reason:
            raised.append(reason)
            return 1

    # What Ctrl-C raises between two lines of a callback is lost: the search is stopped first. Where nobody hears, it is heard here.
    main = threading.current_thread() is threading.main_thread()
    caught = main and signal.getsignal(signal.SIGINT) is signal.default_int_handler
    if caught:
        signal.signal(signal.SIGINT, lambda *_: raised.append(KeyboardInterrupt()))
    if main or progress is not None:
        given.progress = _library.Progress(hear)
    error = _library.Text()
    try:
        status = call(error)
    finally:
        if caught:
            signal.signal(signal.SIGINT, signal.default_int_handler)
    if raised:
        raise raised[0]
    return status, error


def _kept(data: bytes, path: Optional[Path]) -> bytes:
    if path is not None:
        with open(path, "wb") as file:
            file.write(data)
    return data


def read(path: Path, *, edges: Optional[str] = None, units: Optional[str] = None, weld: Optional[float] = None,
         scale: Optional[float] = None, flat: Optional[float] = None, up: Optional[str] = None, split: Optional[bool] = None,
         pick: Optional[int] = None, part: Optional[str] = None, all_layers: Optional[bool] = None, parallel: Optional[bool] = None,
         columns: Optional[str] = None) -> Frame:
    """Reads a frame from a file: OBJ, DXF, PLY, STL, CSV, JSON, GraphML, .. Frame.notes says what was merged or dropped, and
    whether its unit may be another one; look at them, as nothing else warns.

    edges: the second file of a pair of tables. columns: of a table of edges, both ends' columns, "a,b".
    units: of the numbers, where the file does not say: "m". scale: times every coordinate. up: "y" or "z".
    weld: nodes closer than this are one, in units of the frame. split: cut edges where a node lies on them.
    flat: rad, no edge between triangles that meet at less. parallel: keep parallel edges that differ in length.
    pick, part: which framework of a file that holds several, by number from 1, or by name. all_layers: hidden ones of a drawing, too.

    OSError: it cannot be read. BadInput says where, what, and what to do.
    """
    try:
        return Frame._made(_library.lib.thread_frame_read, os.fsencode(path), _read_options(dict(
            edges=edges, units=units, weld=weld, scale=scale, flat=flat, up=up, split=split, pick=pick, part=part, all_layers=all_layers,
            parallel=parallel, columns=columns)))
    except OSError:
        for name in (path, edges):  # as Python says it: FileNotFoundError, PermissionError, ..
            if name is not None:
                open(name, "rb").close()
        raise


def parse(data: Union[str, bytes], name: str, *, units: Optional[str] = None, weld: Optional[float] = None,
          scale: Optional[float] = None, flat: Optional[float] = None, up: Optional[str] = None, split: Optional[bool] = None,
          pick: Optional[int] = None, part: Optional[str] = None, all_layers: Optional[bool] = None, parallel: Optional[bool] = None,
          columns: Optional[str] = None) -> Frame:
    """Reads a frame from the text of a file; name is for messages, and its ending says what it is: "shell.obj". The rest as read()."""
    if not isinstance(data, (str, bytes, bytearray, memoryview)):
        raise TypeError("a frame is read from text or bytes, and %r is neither" % (data,))
    text = data.encode() if isinstance(data, str) else bytes(data)
    options = _read_options(dict(
        units=units, weld=weld, scale=scale, flat=flat, up=up, split=split, pick=pick, part=part, all_layers=all_layers,
        parallel=parallel, columns=columns))
    return Frame._made(_library.lib.thread_frame_parse, c_char_p(text), c_size_t(len(text)), _library.text("name", name), options)


def _read_options(options: Mapping[str, Any]) -> Any:
    return byref(_library.filled(_library.ReadOptions(), _library.lib.thread_read_options_init, options))


def compare(plans: Sequence[Plan], method: Comparison = "joint", seconds: float = 0.0, progress: Optional[Heard] = None,
            threads: Optional[int] = None) -> Dict[str, Any]:
    """Plans of one frame side by side, as `thread compare --json` says it: a row each in "plans", where they are called "plan 1", "plan
    2" and so on, and in "rankings" their order. method: "joint", "capstan", "structure", "all" of these, or "rise", of three runs each.
    Of a row: lengths in units, "turning_deg" and what ends with _deg in degrees, what ends with _percent in percent; "largest_pull",
    "other_pull", "total_pull": N by the closed form at the hardest end, the other end of that cord, all ends; "joint_pull" and so on
    by simulated joints; "holding_pull": what the structure needs to stand; "rise_up" of "rise_runs" come up, at a median "rise_pull",
    and fall below "rise_fall"; "rise_closed" of "rise_faces"; "frontier"; "best": the columns in which it is. None: not known.
    BadInput: no such method, or plans of different frames. NotProved: nothing was known in time."""
    for plan in plans:
        if not isinstance(plan, Plan):
            raise TypeError("compare takes a list of plans: %r is none" % (plan,))
    handles = (c_void_p * len(plans))(*[plan._open() for plan in plans])
    _library.text("method", method)
    what = "compare" if method == "joint" else "compare " + method
    return _reported(_options(dict(seconds=seconds, threads=threads)), progress, _library.lib.thread_report_plans, handles,
                     c_int(len(plans)), what.encode())


def version() -> str:
    """The version of the library: "0.1.0"."""
    number = int(_library.lib.thread_version())
    return "%d.%d.%d" % (number // 10000, number // 100 % 100, number % 100)


def libraries() -> str:
    """The versions of what is in it."""
    return str(_library.lib.thread_libraries().decode())


__version__ = version()
