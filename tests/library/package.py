#!/usr/bin/env python3
"""The package thread_plan: what it gives beside what geometry says, and what it refuses. Says nothing if all is well."""
import copy
import errno
import inspect
import json
import math
import os
import pickle
import re
import signal
import tempfile
import threading
import time
import typing
import warnings
from fractions import Fraction

import thread_plan
from thread_plan import Frame

SQUARE = [(0, 0, 0), (30, 0, 0), (30, 40, 0), (0, 40, 0)]
SIDES = [(0, 1), (1, 2), (2, 3), (3, 0), (0, 2)]


def refused(kind, words, call):
    try:
        call()
    except kind as reason:
        assert words in str(reason), reason
    else:
        raise AssertionError("not refused: " + words)


def angle(a, b, c):
    """By which a cord turns that comes from a over b to c."""
    u, v = [q - p for p, q in zip(a, b)], [q - p for p, q in zip(b, c)]
    cos = sum(p * q for p, q in zip(u, v)) / math.dist(a, b) / math.dist(b, c)
    return math.acos(max(-1.0, min(1.0, cos)))


frame = Frame(SQUARE, SIDES)
assert frame.nodes == [tuple(map(float, p)) for p in SQUARE] and frame.edges == SIDES and len(set(frame.names)) == 4 and frame.notes == []

# The diagonal twice: 140 + 2 x 50.
plan = frame.plan(cords=1)
assert plan.proved and plan.summary.shortest and abs(plan.summary.length - 240) < 1e-9 and plan.summary.passes == 6
plan.check()
(cord,) = plan.cords
assert cord.ends[0] == cord.ends[1] and cord.passes == 6 and abs(cord.length - 240) < 1e-9
assert plan.frame.edges == SIDES and plan.frame.nodes == frame.nodes

# Tensions by the capstan law, walked by hand over the cord's own nodes: they differ by no more at a turn, and exactly so much on
# the way from the slackest pass to an end (the turn between two slackest passes is nobody's).
turns = [angle(*[SQUARE[n] for n in cord.nodes[k:k + 3]]) for k in range(cord.passes - 1)]
assert abs(sum(turns) - cord.turning) < 1e-9
for k, turn in enumerate(turns):
    assert abs(math.log(cord.tension[k + 1] / cord.tension[k])) <= 0.2 * turn + 1e-9
slack = [k for k, tension in enumerate(cord.tension) if tension == min(cord.tension)]
assert abs(math.log(cord.pull_start / cord.tension[slack[0]]) - 0.2 * sum(turns[:slack[0]])) < 1e-9
assert abs(math.log(cord.pull_end / cord.tension[slack[-1]]) - 0.2 * sum(turns[slack[-1]:])) < 1e-9
assert plan.summary.pull == max(cord.pull_start, cord.pull_end)

# From one odd node to the other, from given nodes, several cords.
assert abs(frame.plan(ends="any").summary.length - 190) < 1e-9
assert set(frame.plan(ends=[1, 3]).cords[0].ends) <= {1, 3}
assert set(Frame.shape("dome", 3).set_feet("rim").plan(ends="feet").cords[0].ends) <= {0, 1, 2, 3, 5, 6, 7, 8}
refused(thread_plan.BadInput, "closed", lambda: Frame.shape("sphere", 1).set_feet("rim"))
assert len(Frame.shape("dome", 5).set_feet().plan(cords=2, ends="feet").cords) == 2

# What is not said is chosen: cords that a hand can pull without a grip on the way.
dome = Frame.shape("dome", 7)
chosen = dome.plan()
assert len(chosen.cords) > 1 and all(c.pull_start <= 10 and c.pull_end <= 10 and c.grips == 0 for c in chosen.cords)
assert len(dome.plan(cords=4).cords) == 4
counted = dome.plan(ends={0: 1, 6: 1, 42: 2})
assert sorted(v for c in counted.cords for v in c.ends) == [0, 6, 42, 42]
advice = dome.advice()
assert advice["rows"][advice["recommended"]]["cords"] == len(chosen.cords), advice
for row in advice["rows"][::2]:  # of every row there is the plan
    advised = dome.advised(row["cords"], row["ends"])
    advised.check()
    facts = advised.summary
    assert len(advised.cords) == row["cords"] and abs(facts.length - row["length"]) < 1e-6 and abs(facts.pull - row["pull"]) < 1e-6, row
assert not Frame.shape("dome", 3).symmetries(ends="any", seconds=60)["stopped"]  # nor proved under every group
refused(thread_plan.Infeasible, "no row of 999", lambda: dome.advised(999))
assert dome.symmetries(ends="any", seconds=1)["groups"][0]["order"] == 8

# Written, read, drawn.
with tempfile.TemporaryDirectory() as folder:
    path = os.path.join(folder, "plan.json")
    plan.write(path)
    again = thread_plan.Plan.read(path)
    assert again.json() == plan.json() and again.proved
    assert plan.draw("svg", os.path.join(folder, "a.svg")) == open(os.path.join(folder, "a.svg"), "rb").read()
    frame.write("obj", os.path.join(folder, "a.obj"))
    assert thread_plan.read(os.path.join(folder, "a.obj"), units="m", scale=2).nodes[1] == (60.0, 0.0, 0.0)
told = "the file says that its unit is mm; units cm is taken instead"
assert thread_plan.parse(frame.write(), "a.json", units="cm").notes == [told] and not thread_plan.parse(frame.write(), "a.json", units="mm").notes
assert thread_plan.parse(frame.write("ply"), "a.ply").edges == SIDES
lie = plan.json().replace(b'"length": 240', b'"length": 140')
refused((thread_plan.Violated, thread_plan.BadInput), "length", lambda: thread_plan.Plan(lie).check())

# Progress is a plain function; it stops the search, and what it raises comes out.
heard = []
dome = Frame.shape("dome", 7).set_feet()
stopped = dome.plan(cords=4, ends="feet", aims="turning", progress=lambda what, best, bound: heard.append((what, best, bound)) or best < 1e9)
assert heard and all(isinstance(what, str) and 0 <= bound <= best for what, best, bound in heard), heard
assert chosen.eval("structure", progress=lambda what, best, bound: heard.append(what)) is chosen and isinstance(heard[-1], str)
assert chosen.draw("svg", progress=lambda *_: False) == chosen.draw("svg")
stopped.check()
hasty = dome.plan(progress=lambda *_: True)  # the recommended one, stopped at once
for made in (plan, stopped, hasty):
    assert thread_plan.Plan(made.json()).proved == made.proved
refused(ZeroDivisionError, "", lambda: dome.plan(cords=4, ends="feet", aims="turning", progress=lambda *_: 1 / 0))

# Who has asked to stop is not asked again; what was stopped says so, and whether a hand can pull it. The time is kept.
heard = []
assert dome.plan(cords=4, ends="feet", aims="turning", progress=lambda *_: not heard.append(1)).stopped and heard == [1]
assert not chosen.stopped and not plan.stopped
unproved = Frame.shape("dome", 4).plan(cords=10, seconds=60)  # whose search has ended by itself
assert not unproved.proved and not unproved.stopped, unproved
large = Frame.shape("dome", 20)
with warnings.catch_warnings(record=True) as said:
    warnings.simplefilter("always")
    began = time.monotonic()
    best = large.plan(progress=lambda what, best, bound: time.monotonic() > began + 0.2)
    assert time.monotonic() < began + 2 and best.stopped, time.monotonic() - began
    assert [w.category for w in said] == [thread_plan.StoppedWarning] * (best.summary.pull > 10), said
    assert all("of a hand" in str(w.message) for w in said), said
began = time.monotonic()
large.plan(cords=4, aims="max-turning", seconds=0.5)
assert time.monotonic() < began + 2

# Ctrl-C ends a call that nobody listens to, soon, and is heard afterwards as before.
signal.signal(signal.SIGINT, signal.default_int_handler)  # what runs in the background is started without
for call in (lambda: large.plan(cords=4, ends="any", aims="max-turning", seconds=0), best.rise, lambda: large.symmetries(ends="any")):
    began = time.monotonic()
    threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    refused(KeyboardInterrupt, "", call)
    assert time.monotonic() < began + 2, time.monotonic() - began
assert signal.getsignal(signal.SIGINT) is signal.default_int_handler

# Plans side by side, and how one comes up, as far as the time goes.
compared = thread_plan.compare([dome.plan(cords=1), chosen], "capstan")
assert [row["plan"] for row in compared["plans"]] == ["plan 1", "plan 2"] and compared["rankings"][0]["order"][0]["plan"] == "plan 2"
refused(thread_plan.BadInput, "plan 2 is for another", lambda: thread_plan.compare([plan, chosen], "capstan"))
refused(thread_plan.BadInput, "no report compare guess", lambda: thread_plan.compare([plan], "guess"))
refused(thread_plan.NotProved, "", lambda: chosen.rise(progress=lambda *_: True))
assert not compared["stopped"] and not advice["stopped"]
try:
    assert chosen.rise(seconds=5)["stopped"]
except thread_plan.NotProved:  # a machine so busy that nothing was seen in that time
    pass

# What they are, at a glance.
assert repr(dome) == "<Frame: 49 nodes, 84 edges, 4 feet, in mm>" and dome.units == "mm" and dome.feet == [0, 6, 42, 48], repr(dome)
assert repr(chosen).startswith("<Plan: %d cords, " % len(chosen.cords)) and repr(plan).endswith("proved the shortest>"), (chosen, plan)
assert repr(cord).startswith("<Cord A: 6 passes from node "), cord

# What stands by its weight and friction needs no pull, and says so.
with warnings.catch_warnings():
    warnings.simplefilter("error")
    stands = Frame.shape("dome", 5).set_feet().plan(ends="feet").eval("structure")
assert all((c.pull_start == c.pull_end == 0) == ("unpulled" in repr(c)) for c in stands.cords)
assert ("stands without any pull" in repr(stands)) == (stands.summary.pull == 0) == (max(c.pull_start for c in stands.cords) == 0)
assert len({cord, *plan.cords}) == 1 and {cord: 1}[plan.cords[0]] == 1

# Copies are of their own; errors travel between processes.
for made in (copy.copy(plan), copy.deepcopy(plan), pickle.loads(pickle.dumps(plan))):
    assert made.json() == plan.json() and made.proved == plan.proved
    made.close()
assert best.stopped and pickle.loads(pickle.dumps(best)).stopped and not pickle.loads(pickle.dumps(plan)).stopped
noted = thread_plan.parse(frame.write(), "a.json", units="cm")
assert noted.notes == [told] == pickle.loads(pickle.dumps(noted)).notes == copy.copy(noted).notes
assert plan.cords and pickle.loads(pickle.dumps(dome)).write() == dome.write() == copy.copy(dome).write()
error = pickle.loads(pickle.dumps(thread_plan.BadInput(3, "why")))
assert (type(error), error.status, str(error)) == (thread_plan.BadInput, 3, "why")

# Feet by a mask; no number is cut to an integer.
feet = [z < 1e-9 for _, _, z in dome.nodes]
assert json.loads(Frame(dome.nodes, dome.edges).set_feet(feet).write())["feet"] == json.loads(dome.write())["feet"]
refused(TypeError, "", lambda: dome.set_feet([0.9]))
refused(TypeError, "", lambda: Frame(SQUARE, [(0, 1.9)]))
refused(TypeError, "", lambda: dome.plan(cords="4"))
for mu in (Fraction(1, 4), 0.25):  # numbers of any type, as those of numpy
    assert dome.plan(cords=4, physics={"mu": mu, "seating": 5}).json() == dome.plan(cords=4, physics='{"mu": 0.25, "seating": 5}').json()
assert dome.plan(cords=4, aims=["length"], physics={"mu": 0.1}).summary.pull < dome.plan(cords=4, aims="length").summary.pull

# What is wrong is said.
refused(thread_plan.BadInput, "moon", lambda: frame.plan(ends="moon"))
refused(ValueError, "a.obj:1", lambda: thread_plan.parse("v 1 2 x\n", "a.obj"))
refused(OSError, "no.obj", lambda: thread_plan.read("no.obj"))
refused(TypeError, "speed", lambda: frame.plan(speed=1))
refused(TypeError, "cover", lambda: frame.plan(cover="x"))
refused(thread_plan.Infeasible, "", lambda: frame.plan(cords=1, cover=1, capacity=1))
refused(thread_plan.BadInput, "three", lambda: Frame([(0, 0)], []))
with Frame(SQUARE, SIDES) as lent:
    assert len(lent.edges) == 5
refused(ValueError, "closed", lambda: lent.nodes)

# Of a value that is no answer: its name, what was said, and what may be.
NAN = float("nan")
for asked, words in (
        (dict(cords=0), "cords: 0 is not 1 to 1000"), (dict(cords=(0, 2)), "the least of cords: 0 is not 1 to"),
        (dict(cords=True), "cords: True"), (dict(cords=-1), "cords: -1"), (dict(cords=10**12), "cords: 1000000000000"),
        (dict(cover=0), "cover: 0 is not 1 to 100"), (dict(cover=3, capacity=2), "capacity: 2 leaves no room for cover 3"),
        (dict(distinct=3, cover=2), "cover: 2, but distinct 3"), (dict(seconds=-1), "seconds: -1"), (dict(seconds=NAN), "seconds: nan"),
        (dict(threads=0), "threads: 0 is not 1 to 1000"), (dict(hand=0), "hand: 0 is not a force above 0"), (dict(hand=NAN), "hand: nan"),
        (dict(gap=-1), "gap: -1"), (dict(max_pull=0.5), "max_pull: 0.5 is not 1 or more"), (dict(max_length=NAN), "max_length: nan"),
        (dict(physics={"mu": NAN}), "physics: mu: not a finite number; expected 0 to 2"),
        (dict(physics={"seating": -1}), "physics: seating: -1 is out of range; expected more than 0 N"),
        (dict(physics={"bore": 1, "cord_diameter": 2}), "0 passes of a cord of 2 mm go through a bore of 1 mm"),
        (dict(ends=[True, False]), "ends: a mask of 2, but there are 49 nodes"), (dict(ends={99: 2}), "ends: there is no node 99, only 0 to 48"),
        (dict(aims="beauty"), "there are length, longest, turning")):
    refused((ValueError, thread_plan.Infeasible), words, lambda: dome.plan(**asked))
# Nor is what has another type than an option: it reaches no pointer.
for asked, words in (
        (dict(aims=3), "aims: 3 is none: aims are words"), (dict(aims=True), "aims: True"), (dict(aims=0), "aims: 0"), (dict(aims=2**40), "aims: 10"),
        (dict(physics=3), "physics: 3 is none: physics are a mapping"), (dict(physics=True), "physics: True"), (dict(request=3), "request: 3"),
        (dict(physics={"mu": {1}}), "physics: {1} is neither number nor text"), (dict(max_length="3"), "max_length: '3' is no number"),
        (dict(cords=(1, 2, 3)), "cords: (1, 2, 3) is neither"), (dict(ends=0), "ends: 0 is neither"), (dict(ends=b"feet"), "ends: b'feet' is neither"),
        (dict(progress=3), "progress: 3 is no function")):
    refused(TypeError, words, lambda: dome.plan(**asked))
refused(TypeError, "physics: 3", lambda: dome.advice(physics=3))
refused(TypeError, "aims: 3", lambda: dome.symmetries(aims=3))
refused(TypeError, "units: None is no text", lambda: Frame(SQUARE, SIDES, units=None))
refused(TypeError, "type: None is no text", lambda: plan.draw(None))
refused(TypeError, "{} is neither", lambda: thread_plan.Plan({}))
refused(TypeError, "feet: None is neither", lambda: dome.set_feet(None))
refused(TypeError, "edge 3: 1.9 is no integer", lambda: Frame(SQUARE, [*SIDES[:3], (3, 1.9)]))
refused(TypeError, "node 1: 'x' is no number", lambda: Frame([SQUARE[0], ("x", 0, 0)], SIDES))
refused(TypeError, "weld: '1' is no number", lambda: thread_plan.parse(frame.write(), "a.json", weld="1"))

# A hand that no number of cords meets is said; of a plan that is another one a hand says nothing.
with warnings.catch_warnings(record=True) as said:
    warnings.simplefilter("always")
    assert dome.plan(hand=0.5).summary.pull > 0.5
assert [w.category for w in said] == [thread_plan.PullWarning] and "more than the 0.5 N of a hand" in str(said[0].message), said
refused(thread_plan.BadInput, "hand: only for a recommended plan", lambda: dome.plan(cords=2, hand=1))

for flags in ([True] * 48, [True] * 50):
    refused(thread_plan.BadInput, "feet: a mask of %d, but there are 49 nodes" % len(flags), lambda: dome.set_feet(flags))
refused(thread_plan.BadInput, "seconds: nan", lambda: plan.eval(seconds=NAN))
refused(thread_plan.BadInput, "no method guess, only capstan, joint, structure", lambda: plan.eval("guess"))
refused(thread_plan.BadInput, "no document stl, only svg, ", lambda: plan.draw("stl"))
refused(thread_plan.BadInput, "no shape cube, only dome, ", lambda: Frame.shape("cube"))
refused(thread_plan.BadInput, "step is no format that is written; these are: ", lambda: frame.write("step"))
refused(TypeError, "plans: 'a' is none", lambda: thread_plan.compare(["a"]))
for call, path in ((thread_plan.read, "no.obj"), (lambda path: thread_plan.read("no.obj", edges=path), "no.obj"), (thread_plan.Plan.read, "no.json")):
    try:
        call(path)
    except FileNotFoundError as reason:
        assert (reason.errno, reason.filename) == (errno.ENOENT, path), reason
    else:
        raise AssertionError("read what is not there")

# The names that are typed are those that the library knows.
for kind, call, before in (
        (thread_plan.Shape, lambda: Frame.shape("?"), "only "), (thread_plan.Format, lambda: frame.write("?"), "these are: "),
        (thread_plan.Method, lambda: plan.eval("?"), "only "), (thread_plan.Document, lambda: plan.draw("?"), "only "),
        (thread_plan.Comparison, lambda: thread_plan.compare([plan], "?"), "and compare, ")):
    try:
        call()
    except thread_plan.BadInput as reason:
        known = re.split(", | and ", str(reason).split(before)[1].replace("compare ", ""))
        assert sorted(typing.get_args(kind)) == sorted(known + ["joint"] * (kind == thread_plan.Comparison)), (kind, known)

# A frame that is no frame: which node, which edge.
for points, pairs, words in (
        ([*SQUARE, (0, NAN, 0)], SIDES, "node 4 has a coordinate that is not a finite number"),
        (SQUARE, [*SIDES, (3, 40)], "edge 5 names node 40, but there are 4 nodes"),
        (SQUARE, [*SIDES, (3, 3)], "edge 5 has no length: it joins node 3 to itself"),
        (SQUARE, [*SIDES, (2, 0)], "an edge is given twice: 4 and 5 join node 2 to node 0"),
        ([*SQUARE, (30, -0.0, 0)], [*SIDES, (4, 3)], "two nodes are in one place: 1 and 4"),
        ([*SQUARE, (9, 9, 9)], SIDES, "node 4 has no edge")):
    refused(thread_plan.BadInput, words, lambda: Frame(points, pairs))

# What time ends keeps the best of what was tried: beyond the hand, and within a limit on the pull.
rings = [(math.pi / 6 * (1 + r), math.pi / 4 * k) for r in range(3) for k in range(8)]
shell = Frame([(0, 0, 300), *((300 * math.sin(a) * math.cos(b), 300 * math.sin(a) * math.sin(b), 300 * math.cos(a)) for a, b in rings)],
              [(1 + 8 * r + k, 1 + 8 * r + (k + 1) % 8) for r in range(3) for k in range(8)] + [(max(0, i - 8), i) for i in range(1, 25)])
with warnings.catch_warnings():
    warnings.simplefilter("ignore")
    hasty = shell.set_feet().plan(physics={"mu": 0.3, "seating": 5}, seconds=2)
assert hasty.summary.pull < 50 and (not hasty.stopped or repr(hasty).endswith("stopped>")), hasty
assert all(c.pull_start <= 4 and c.pull_end <= 4 for c in shell.plan(max_pull=4, cords=(1, 6), seconds=8).cords)

refused(thread_plan.BadInput, "ends[0]: there is no node 999", lambda: dome.plan(ends=[999]))
refused(thread_plan.Infeasible, "with set_feet or ends", lambda: Frame(SQUARE, SIDES).plan(ends="feet"))
refused(thread_plan.BadInput, "the least of cords", lambda: dome.plan(cords=(5, 4)))

assert thread_plan.__version__ == thread_plan.version()
assert all(name in thread_plan.__all__ for name, value in vars(thread_plan).items()
           if not name.startswith("_") and getattr(value, "__module__", "").startswith("thread_plan"))
for name in typing.get_args(thread_plan.Document):
    assert '"%s"' % name in thread_plan.Plan.draw.__doc__, name
for name in json.loads(chosen.json())["options"]["physics"]:
    assert '"%s"' % name in Frame.plan.__doc__, name

# Everything that is public says what it is; of a method also its own words, not those of a base.
for name in thread_plan.__all__:
    public = getattr(thread_plan, name)
    assert inspect.getdoc(public) or typing.get_origin(public), name
    for member, value in vars(public).items() if inspect.isclass(public) else ():
        assert member.startswith("_") or not (callable(value) or isinstance(value, (property, classmethod))) or value.__doc__, (name, member)

try:
    import numpy
except ImportError:
    numpy = None
if numpy is not None:
    arrays = Frame(numpy.array(SQUARE, dtype=float), numpy.array(SIDES))
    assert arrays.array().shape == (4, 3) and (arrays.edge_array() == numpy.array(SIDES)).all()
    assert arrays.plan(cords=1).json() == plan.json()
