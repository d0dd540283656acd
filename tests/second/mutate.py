"""Mutants of plans: small changes of their JSON, most of which make a claim false."""
import copy

WORDS = {
    "status": ["optimal", "bound"], "objective": ["length", "tortuosity", "symmetry"], "joint": ["solid", "tube"],
    "ends": ["closed", "any", "feet", "nodes", "counts"], "cost": ["angle", "sine", "step", "uturn"], "minimize": ["turning", "max-turning", "pull"],
    "tour": ["least", "fleury", "hierholzer"], "pairings": ["keep", "ignore"], "slack": ["open", "x"], "units": ["mm", "Inches", "metre", "unit", "feets", "mm "], "method": ["capstan", "joint", "structure"], "law": ["capstan", "mitre"], "pull": ["start", "end", "both"],
    "name": ["", "C1", "C2", "Cs", "Ci", "C2v", "D2", "C4", "D2d", "C4v", "C3v", "D4", "D2h", "S4", "Td", "O", "Th", "D3h", "D3d"],
}
NEAR = (10**9 - 20, 10**9 - 7, 10**9 - 2, 10**9 - 1, 10**9 + 1)  # over 10^9: near the tolerances
FACTORS = (0, 0.5, 0.999999, 1 - 1e-8, 1 - 1e-11, 1 + 1e-11, 1 + 1e-8, 1.000001, 1.5, 2, -1)


def places(value, holder=None, key=None, found=None):
    """All (holder, key) below a value."""
    found = [] if found is None else found
    if holder is not None:
        found.append((holder, key))
    items = value.items() if type(value) is dict else enumerate(value) if type(value) is list else ()
    for k, child in items:
        places(child, value, k, found)
    return found


def change_number(random, holder, key):
    value = holder[key]
    if random.random() < 0.03:
        holder[key] = float(value)
        return
    if type(value) is float:
        holder[key] = value * random.choice(FACTORS) if random.random() < 0.9 else value + random.choice((1, -1, 1e-7))
        return
    ways = [value + 1, value - 1, value + 2, 2 * value, -value, 0, value + random.randint(-9, 9)]
    if abs(value) > 1000:
        ways += [value + value // 1000, value - value // 1000, value // 2, value + 4096, value * 3]
    siblings = [x for x in holder if type(x) is int] if type(holder) is list else []
    holder[key] = random.choice(siblings) if siblings and random.random() < 0.3 else random.choice(ways)


def change_list(random, value):
    way = random.randrange(5)
    i = random.randrange(len(value))
    if way == 0:
        del value[i]
    elif way == 1:
        value.insert(random.randint(0, len(value)), copy.deepcopy(value[i]))
    elif way == 2:
        j = random.randrange(len(value))
        value[i], value[j] = value[j], value[i]
    elif way == 3:
        value.reverse()
    else:
        value.append(value.pop(0))


def change(random, holder, key):
    value = holder[key]
    if type(value) is dict and value and random.random() < 0.9:
        del value[random.choice(list(value))]
    elif type(value) is list and value:
        change_list(random, value)
    elif type(value) is bool:
        holder[key] = not value
    elif type(value) in (int, float):
        change_number(random, holder, key)
    elif type(value) is str and key in WORDS:
        holder[key] = random.choice(WORDS[key])
    else:
        holder[key] = random.choice((None, 1, "x", [], {}))


def move_node(random, plan):
    """A node goes from one cut to another."""
    for certificate in plan["proof"].get("length", {}).get("certificate", []):
        cuts = [c for c in certificate["cuts"] if c["nodes"]]
        if len(cuts) > 1:
            source, target = random.sample(cuts, 2)
            node = random.choice(source["nodes"])
            source["nodes"].remove(node)
            target["nodes"] = sorted(target["nodes"] + [node])


def scale_proof(random, plan):
    """Multipliers a little smaller or larger, all alike."""
    up, down = random.choice(((1, 2), (999, 1000), (2, 1), (1001, 1000), (0, 1), (3, 4)) + tuple((k, 10**9) for k in NEAR))
    for holder, key in places(plan["proof"]):
        if key in ("value", "end_price") and type(holder[key]) is int and "low" not in holder:
            holder[key] = holder[key] * up // down
        if key in ("potentials", "ends", "place_prices") and type(holder[key]) is list:
            holder[key] = [x * up // down for x in holder[key]]
        if key == "length" and "potentials" in holder:
            holder[key] = holder[key] * up // down


def scale_weights(random, plan):
    for certificate in plan["proof"].get("length", {}).get("certificate", []):
        certificate["scale"] *= random.choice((0.5, 2, 1.0000001, 0.001, 1e-9, 1 + 1e-12, 3))


def new_option(random, plan):
    """A stated option that the plan may or may not keep to."""
    o, length = plan["options"], plan["metrics"].get("length", 1)
    n = len(plan["framework"]["nodes"])
    way = random.randrange(13)
    if way == 10 and "length" in plan["proof"]:
        plan["proof"]["length"]["slack"] = "open"
    elif way == 11 and "symmetry" in plan:
        o["symmetry"]["geometric"] = random.choice((None, 0, 1e-9, 0.01, 0.3, 2))
        o["symmetry"]["group"] = random.choice((None, "2", plan["symmetry"]["name"], *WORDS["name"]))
        if random.random() < 0.5:
            move_nodes(random, plan)
    elif way == 0:
        o["cords"] = random.choice((1, 2, 3, {"least": 1, "most": 2}, {"least": 1, "most": 3}, {"least": 2, "most": 3}))
    elif way == 1:
        o["capacity"] = random.randint(1, 4)
    elif way == 2:
        o["max_length"] = length * random.choice((0.3, 0.5, 0.51, 0.7, 1, 1.0000001))
    elif way == 12:
        o["max_pull"] = o.get("max_pull", 3) * random.choice((0.9, 1, 1 + 1e-8, 1.1, 5))
    elif way == 3:
        o["ends"] = "nodes"
        o["end_nodes"] = sorted(random.sample(range(n), random.randint(1, n)))
    elif way == 4:
        o["cover"] = random.randint(1, 3)
    elif way == 5:
        o["balance"] = True
    elif way == 6:
        o["ends"] = random.choice(WORDS["ends"][:3])
    elif way == 7:
        o["joint"] = "tube" if o["joint"] == "solid" else "solid"
    elif way == 8 and "turning" in o:
        o["turning"]["length_slack"] = random.choice((None, 0, 0.1, 1))
    else:
        m = len(plan["framework"]["edges"])
        key = random.choice(("covers", "capacities", "lengths", "feet"))
        plan["framework"][key] = {"covers": [1 + (random.random() < 0.1) for _ in range(m)],
                                  "capacities": [random.choice((1, 2, 3, None, None, None)) for _ in range(m)],
                                  "lengths": [random.choice((10, 10.5, 20)) for _ in range(m)],
                                  "feet": sorted(random.sample(range(n), random.randint(0, n)))}[key]


def move_nodes(random, plan):
    """Out of their symmetric places, a little."""
    for p in plan["framework"]["nodes"]:
        for k in range(3):
            p[k] += random.choice((0, 1e-8, 0.1, 1)) * random.random()


def change_orbits(random, plan):
    """Symmetries of a proof of turning, or what is decided by them: moved, exchanged, made up; or a framework that has them not."""
    proof = plan["proof"]["turning"]["proof"]
    m, images = len(plan["framework"]["edges"]), proof.setdefault("symmetries", [])
    inner = [node for node in proof["tree"] if "low" in node]
    way = random.randrange(7)
    if way == 0 or not images:
        images.append([2 * e for e in range(m)])
    image = random.choice(images)
    e, f = random.randrange(m), random.randrange(m)
    if way == 1:
        image[e], image[f] = image[f], image[e]
    elif way == 2:
        image[e] ^= 1
    elif way == 3:
        other = random.choice(images)  # one after the other is a symmetry as well
        image[:] = [other[h >> 1] ^ h & 1 for h in image]
    elif way == 4:
        key = random.choice(("covers", "capacities"))
        plan["framework"].setdefault(key, [1] * m if key == "covers" else [None] * m)[e] = 2
    elif inner:
        node = random.choice(inner)
        orbit = node.setdefault("orbit", [])
        if orbit and way == 5:
            orbit.pop(random.randrange(len(orbit)))
        else:
            orbit.append(random.randrange(len(images)))


def weaken(random, plan):
    """A claim of a bound only, near what is proved or far from it."""
    claims = [c for c, key in places(plan["proof"]) if key == "lower_bound" and type(c[key]) in (int, float)]
    for claim in random.sample(claims, random.randint(1, len(claims))) if claims else []:
        if type(claim["lower_bound"]) is int:
            claim["lower_bound"] += random.choice((-1, 1))
        else:
            claim["lower_bound"] *= random.choice((0, 0.5, 1 - 1e-5, 1 - 1e-7, 1 - 1e-10, 1, 1 + 1e-10, 1 + 1e-8, 1 + 1e-5))
        if random.random() < 0.8:
            claim["status"] = "bound"
        own = claim.get("price", plan["metrics"].get("length"))
        if "gap" in claim and own:
            claim["gap"] = (own - claim["lower_bound"]) / own


def repair(random, plan, frame_hash):
    """States sums, weights and the hash as they are after a change, so that what comes behind them is reached."""
    for certificate in plan["proof"].get("length", {}).get("certificate", []):
        if random.random() < 0.8:
            certificate["sum"] = sum(cut["value"] for cut in certificate["cuts"])
    if random.random() < 0.9:
        frame_hash(plan)


TYPES = (None, True, 1, 0.5, "x", [], [1], {}, {"x": 1})  # a value of each type, and lists and objects that hold something


def single_changes(plan):
    """(path, way) of every change of one value: leave it out, another number, another type. Of the elements of a list, which are alike,
    the first two and the last."""
    waiting = [((), plan)]
    while waiting:
        path, value = waiting.pop()
        if path:
            yield path, "left out"
            yield from ((path, i) for i, other in enumerate(TYPES) if type(other) is not type(value) or type(value) in (list, dict))
            if type(value) in (int, float):
                yield from ((path, way) for way in ("0", "-0.0", "1e-13", "1e13"))
        if type(value) is dict:
            waiting += [((*path, key), child) for key, child in value.items()]
        elif type(value) is list:
            waiting += [((*path, i), value[i]) for i in sorted({0, 1, len(value) - 1}) if i < len(value) and value]


def changed_once(plan, path, way, frame_hash):
    """A copy with one change."""
    plan = copy.deepcopy(plan)
    holder = plan
    for key in path[:-1]:
        holder = holder[key]
    key, value = path[-1], holder[path[-1]]
    if way == "left out":
        del holder[key]
    elif type(way) is int:
        holder[key] = copy.deepcopy(TYPES[way])
    else:
        other = float(way) if way in ("0", "-0.0") else value * float(way)
        holder[key] = int(other) if type(value) is int and way != "-0.0" and other == int(other) else other
    if path != ("framework", "hash"):
        try:
            frame_hash(plan)
        except (KeyError, TypeError, IndexError, AttributeError, ValueError, ArithmeticError):
            pass  # no framework any more
    return plan


def mutant(random, plan, frame_hash):
    """A changed copy. frame_hash(plan) states the framework's hash."""
    plan = copy.deepcopy(plan)
    try:
        for _ in range(random.choice((1, 1, 1, 2, 3))):
            way = random.randrange(13)
            if way < 5 or way == 11:
                part = [plan.get(x) for x in ("proof", "proof", "options", "symmetry", "cords", "metrics", "framework", "evaluation") if x in plan]
                found = places(random.choice(part))
                if found:
                    change(random, *random.choice(found))
            elif way == 12:
                change_orbits(random, plan)
            else:
                (move_node, scale_proof, scale_weights, new_option, weaken, weaken)[way - 5](random, plan)
        repair(random, plan, frame_hash)
    except (KeyError, TypeError, IndexError, AttributeError, ValueError):
        pass  # two changes that do not go together: what there is so far is a mutant too
    return plan
