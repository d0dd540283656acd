#!/usr/bin/env python3
"""Mutation testing: breaks one place of a source file at a time and asks the focused tests whether they notice.

tools/mutants.py [--sample N] [--seed N] [--jobs N] [--survivors] [--list] [named | FILE.c ..]

A mutant is one file of C with one token or statement changed. It is compiled alone into a shared object that is loaded before
the library (make BUILD=mutants), so that nothing else is built again. Tests run one program or case after the other, fast ones
first, and stop at the first that fails.

  killed      a test failed, crashed or did not end in five times its time
  survived    all passed: a test is missing, or the change changes nothing
  equivalent  the compiler makes the same object of it, or tools/mutants/equivalent.txt says why it does the same (not counted)
  stillborn   it does not compile (not counted)

Without files: all of SUITES. `named`: only the mutants of tools/mutants/named.txt, which every run without files begins with.
Exit code 1 if a named mutant survived, if a line of either list fits no mutant, or if a file that `thread check` relies on has
fewer than 95 % killed in a whole run (not in a sample).
"""
import argparse
import concurrent.futures
import itertools
import os
import random
import re
import resource
import shutil
import subprocess
import sys
import time

TREE = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
LISTS = os.path.join("tools", "mutants")

# ---- which tests know a file: programs or program:case, in this order ----

CERTIFICATES = ["unit/test_check_rounding", "unit/test_check_cuts", "unit/test_check_cords", "unit/test_check_tubes", "unit/test_check_rules",
                "unit/test_prices", "unit/test_requests", "property/test_proofs", "unit/test_check", "property/test_several"]
TURNING = ["unit/test_check_turning", "property/test_turning_bound", "unit/test_turning_proof",
           "unit/test_turning_prices", "unit/test_tortuosity:more_cords_than_the_shortest_passes_hold"]
ADVERSARY, ATTACKS = ["property/test_adversary"], "20000"  # attacks of each kind
ADVERSARY_TURNING = ["property/test_adversary_turning", "property/test_adversary_claims"]
SYMMETRY = ["unit/test_check_symmetry", "unit/test_symmetry_plan"]
MATCHING = ["unit/test_blossom", "property/test_blossom", "property/test_moat"]
INTERIOR = ["unit/test_lp:interior_finds_the_shortest_way", "unit/test_lp:interior_finds_the_optimum_it_was_made_from",
            "unit/test_lp:interior_gives_up_and_stops"]
SUITES = {
    "graph/check/check.c": CERTIFICATES + ["unit/test_check_turning", "unit/test_symmetry_plan", "unit/test_evaluation"] + ADVERSARY,
    "graph/check/check_length.c": CERTIFICATES + ADVERSARY,
    "graph/check/check_walked.c": CERTIFICATES + ADVERSARY,
    "graph/check/check_certificate.c": CERTIFICATES + ADVERSARY,
    "graph/check/check_cords.c": CERTIFICATES + ADVERSARY,
    "graph/check/prices.c": CERTIFICATES + ADVERSARY,
    "graph/check/check_turning.c": TURNING + ADVERSARY_TURNING,
    "graph/check/turning_leaf.c": TURNING + ADVERSARY_TURNING,
    "graph/check/turning_proof.c": TURNING + ADVERSARY_TURNING,
    "graph/plan/turning.c": TURNING + ADVERSARY_TURNING,
    "graph/check/junction.c": ["unit/test_check_tubes", "unit/test_requests"],
    "graph/check/check_symmetry.c": SYMMETRY,
    "graph/check/check_group.c": SYMMETRY,
    "graph/framework/procrustes.c": ["unit/test_isometry"] + SYMMETRY,
    "graph/check/check_evaluation.c": ["unit/test_evaluation"],
    "lp/matching/blossom.c": MATCHING,
    "lp/matching/blossom_queue.c": MATCHING,
    "lp/matching/blossom_search.c": MATCHING,
    "lp/matching/blossom_shrink.c": MATCHING,
    "lp/matching/blossom_start.c": MATCHING,
    "lp/matching/blossom_tree.c": MATCHING,
    "lp/matching/moat.c": ["property/test_moat"],
    "lp/matching/nest.c": ["property/test_moat:a_negative_width_is_taken_from_the_moats_between_mates", "property/test_moat"],
    "lp/solver/interior.c": INTERIOR,
    "lp/solver/normal.c": ["unit/test_lp:normal_equations_are_solved", "unit/test_lp:equal_rows_are_solved_once"] + INTERIOR,
    "diagram/scene/lanes.c": ["unit/test_lanes", "unit/test_diagram:many_shapes_are_drawn_soundly"],
    "eval/cord/capstan.c": ["unit/test_capstan"],
    "eval/cord/profile.c": ["unit/test_capstan"],
}
CHECK_RELIES_ON = [f for f in SUITES if f.startswith("graph/")]

# ---- tokens ----

TOKEN = re.compile(
    r"""(?P<comment>/\*.*?\*/|//[^\n]*)|(?P<directive>^[ \t]*\#[^\n]*(?:\\\n[^\n]*)*)|(?P<string>L?"(?:\\.|[^"\\])*"|'(?:\\.|[^'\\])*')
    |(?P<number>0[xX][0-9a-fA-F]+[uUlL]*|(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?[uUlLfF]*)|(?P<name>[A-Za-z_]\w*)
    |(?P<mark>->|\+\+|--|<<=|>>=|<<|>>|<=|>=|==|!=|&&|\|\||[-+*/%&|^]=|[-+*/%<>=!~&|^?:;,.(){}\[\]])""",
    re.VERBOSE | re.MULTILINE | re.DOTALL)

SWAPS = {"<": "<=", "<=": "<", ">": ">=", ">=": ">", "==": "!=", "!=": "==", "&&": "||", "||": "&&", "+=": "-=", "-=": "+=",
         "|=": "=", "&=": "=", "^=": "=", "++": "--", "floor": "ceil", "ceil": "floor", "nearbyint": "floor", "fmin": "fmax",
         "fmax": "fmin", "fabs": "+", "true": "false", "false": "true", "break": "continue", "continue": "break"}
BINARY = {"+": "-", "-": "+", "*": "/", "/": "*", "%": "*"}
# Texts and sizes of memory; what happens without memory is held by the tests that let every allocation fail, under the sanitizers.
NOT_VERDICTS = {"thr_fail", "thr_calloc", "thr_realloc", "free", "assert", "thr_nomem"}


class Token:
    def __init__(self, kind, text, start):
        self.kind, self.text, self.start, self.end = kind, text, start, start + len(text)


def tokens_of(source):
    return [Token(m.lastgroup, m.group(), m.start()) for m in TOKEN.finditer(source)
            if m.lastgroup not in ("comment", "directive")]


def matching(tokens, i):
    """Index of the bracket that closes the one at i."""
    depth = 0
    for k in range(i, len(tokens)):
        depth += (tokens[k].text in "([{") - (tokens[k].text in ")]}") if tokens[k].kind == "mark" else 0
        if depth == 0:
            return k
    raise ValueError("unbalanced brackets")


def hidden(tokens):
    """Tokens that are arguments of a function in NOT_VERDICTS, or outside functions and not in a constant's value."""
    out, i = set(), 0
    while i < len(tokens) - 1:
        if tokens[i].text in NOT_VERDICTS and tokens[i + 1].text == "(":
            end = matching(tokens, i + 1)
            out.update(range(i, end + 1))
            i = end
        i += 1
    return out


def statement_around(source, at):
    """The lines of a statement in one, however they are broken."""
    begin = source.rfind("\n", 0, at) + 1
    while begin > 0 and re.search(r"[^;{}\s]\s*\Z", source[:begin]) and not re.search(r"(\*/|:|^#.*)\s*\Z", source[:begin].rsplit("\n", 2)[-2]):
        begin = source.rfind("\n", 0, begin - 1) + 1
    end = source.find("\n", at)
    while end >= 0 and not re.search(r"[;{}:]\s*(/\*.*\*/\s*)?\Z", source[begin:end]) and source[end + 1:end + 2].strip() == "":
        following = source.find("\n", end + 1)
        if following < 0 or not source[end:following].strip():
            break
        end = following
    return " ".join(source[begin:end if end >= 0 else None].split())


class Mutant:
    """One change: file[start:end] becomes `new`."""

    def __init__(self, path, source, start, end, operator, new, number=0, name=None):
        self.path, self.start, self.end, self.operator, self.new, self.name = path, start, end, operator, new, name
        self.line = source.count("\n", 0, start) + 1
        self.text = statement_around(source, start)
        self.number = number  # among those with this line's text and this operator, in the whole file
        self.verdict, self.killer, self.seconds = None, "", 0.0

    def key(self):
        return (self.path, self.operator, self.number, self.text)

    def mutated(self, source):
        return source[:self.start] + self.new + source[self.end:]


def binary(tokens, i):
    """Is the sign at i between two operands?"""
    before = tokens[i - 1]
    return before.kind in ("number", "name") and before.text not in ("return", "case", "sizeof") or before.text in (")", "]")


def size_of_array(source, t):
    line = source[source.rfind("\n", 0, t.start) + 1:t.start]
    return line.endswith("[") and re.match(r"[ \t]*(?:static |const )*(?:double|int|bool|char|path|thr_\w+|int64_t) [\w, ]*\[?[^=(]*$", line)


def changed_number(text):
    if re.fullmatch(r"[0-9]+", text):
        n = int(text)
        return ["1"] if n == 0 else ["0"] if n == 1 else [str(n - 1)]
    if re.fullmatch(r"[0-9.]+[eE]-[0-9]+", text):
        mantissa, exponent = re.split("[eE]", text)
        return [f"{mantissa}e{int(exponent) + 3}", f"{mantissa}e{int(exponent) - 3}"]
    return []


def token_changes(source, tokens):
    """(start, end, operator, new) of every change of one token, and of every condition."""
    skip, in_for = hidden(tokens), set()
    for i, t in enumerate(tokens):
        if t.text == "for" and tokens[i + 1].text == "(":
            in_for.update(range(i, matching(tokens, i + 1)))
        if i in skip or "thr_nomem" in source[max(source.rfind(c, 0, t.start) for c in ";{}"):source.find(";", t.start)]:
            continue
        if t.text == "if" and tokens[i + 1].text == "(":
            a, b = tokens[i + 1].end, tokens[matching(tokens, i + 1)].start
            if "(err" not in source[a:b] and source[a:b] not in ("st",):
                yield a, b, "if (false)", "false && (" + source[a:b] + ")"
                yield a, b, "if (true)", "true || (" + source[a:b] + ")"
        elif t.text in BINARY and t.kind == "mark" and binary(tokens, i):
            if t.text == "*" and (source[t.end] != " " or source[t.start - 1] != " "):
                continue  # a pointer's
            yield t.start, t.end, f"{t.text} -> {BINARY[t.text]}", BINARY[t.text]
        elif t.text in SWAPS and not (t.text == "++" and i in in_for):
            yield t.start, t.end, f"{t.text} -> {SWAPS[t.text]}", SWAPS[t.text]
        elif t.text == "!":
            yield t.start, t.end, "! dropped", ""
        elif t.kind == "number" and not size_of_array(source, t) and tokens[i - 1].text + tokens[i + 1].text != "{}":
            for new in changed_number(t.text):
                yield t.start, t.end, f"{t.text} -> {new}", new


STATEMENT = re.compile(r"^[ \t]+(?!return|break|continue|goto|free|else|if|for|while|do\b|case|default|\(void\))"
                       r"((?:\*|\+\+|--)*[\w\->.\[\]]+(?:\([^\n;{}]*\)|(?:\[[^\n;{}]*\]|->|\.|\w)* [-+*/|&^]?= [^\n;{}]*)|[^\n;=(){}]*(?:\+\+|--));[ \t]*$",
                       re.MULTILINE)


def statement_changes(source):
    """Assignments and calls that fill a line, dropped."""
    for m in STATEMENT.finditer(source):
        if not re.match(r"\w*(?:_destroy|free|assert)\(", m.group(1)):
            yield m.start(1), m.end(1), "statement dropped", "(void)0"


def mutants_of(path, source):
    tokens = tokens_of(source)
    body = source.find("\n{")  # nothing before the first function but constants
    changes = sorted(set(token_changes(source, tokens)) | set(statement_changes(source)))
    count, out = {}, []
    for start, end, operator, new in changes:
        line = source[source.rfind("\n", 0, start) + 1:]
        if not line.startswith(" ") and "=" not in line.split("\n")[0]:
            continue  # a declaration's
        m = Mutant(path, source, start, end, operator, new)
        key = m.key()
        m.number = count[key] = count.get(key, 0) + 1
        out.append(m)
    return out if body >= 0 else []


# ---- the two lists ----

def read_list(name):
    """Lines `a | b | ..` of a file in LISTS, without comments."""
    with open(os.path.join(LISTS, name), encoding="utf-8") as f:
        return [[part.strip() for part in line.split(" | ")] for line in f if line.strip() and not line.startswith("#")]


def named_mutants(sources):
    out = []
    for name, path, old, new in read_list("named.txt"):
        source = sources(path)
        # However the lines are broken, between words and within a text.
        found = list(re.finditer(r"\s+(?:\"\s+\")?".join(map(re.escape, old.split())), source))
        if len(found) != 1:
            raise SystemExit(f"tools/mutants/named.txt: {name}: \"{old}\" stands {len(found)} times in {path}; expected once")
        out.append(Mutant(path, source, found[0].start(), found[0].end(), "named", new, 1, name))
    return out


def mark_equivalent(mutants, whole_files):
    """Those that the list explains; returns the lines that fit none."""
    by_key = {}
    for m in mutants:
        by_key.setdefault((m.path, m.operator), []).append(m)
    stale = []
    for path, operator, numbers, text, reason in read_list("equivalent.txt"):
        found = [m for m in by_key.get((path, operator), []) if text in m.text and (numbers == "all" or str(m.number) in numbers.split())]
        for m in found:
            m.verdict, m.killer = "equivalent", reason
        if not found and path in whole_files:
            stale.append(f"{path}: {operator}: {text}")
    return stale


# ---- building and running ----

def cpu(who=resource.RUSAGE_CHILDREN):
    usage = resource.getrusage(who)
    return usage.ru_utime + usage.ru_stime


class Bench:
    """The library, the test programs, and what their runs take."""

    def __init__(self, out, programs):
        self.dir = os.path.join(out, "mutants")
        self.make = [os.environ.get("MAKE", "make"), "--no-print-directory", "BUILD=mutants", "OUT=" + out]
        self.tests = os.path.join(self.dir, "tests")
        goals = sorted({os.path.join(self.tests, p.split(":")[0]) for p in programs})
        subprocess.run(self.make + [f"-j{os.cpu_count()}"] + goals, check=True, stdout=subprocess.DEVNULL)
        flags = subprocess.run(self.make + ["list-flags"], check=True, stdout=subprocess.PIPE, text=True).stdout
        self.compiler = flags.strip("\n").split("\n")
        self.linker = list(itertools.takewhile(lambda word: not word.startswith("-"), self.compiler))
        self.seconds = {}

    def compile(self, source, work, path):
        """Object of a source below work, or None."""
        file = os.path.join(work, os.path.basename(path))
        with open(file, "w", encoding="utf-8") as f:
            f.write(source)
        done = subprocess.run(self.compiler + ["-w", "-c", "-x", "c", "-o", file + ".o", file], stderr=subprocess.DEVNULL)
        return file + ".o" if done.returncode == 0 else None

    def run(self, test, preload, limit):
        """Does the test pass?"""
        program, _, case = test.partition(":")
        env = dict(os.environ, CK_FORK="no", LD_PRELOAD=preload, THREAD_ADVERSARY_ATTACKS=ATTACKS)
        if case:
            env["CK_RUN_CASE"] = case
        else:
            env.pop("CK_RUN_CASE", None)
        with subprocess.Popen([os.path.join(self.tests, program)], env=env, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, start_new_session=True,
                              preexec_fn=lambda: limits(limit)) as process:
            try:
                said, failed = process.communicate(timeout=10 * limit + 20)
                if b"cannot be preloaded" in failed:
                    raise SystemExit(f"{preload} could not be loaded before tests/{test}")
                return process.returncode == 0 and b"Checks: 0," not in said
            except subprocess.TimeoutExpired:
                return False
            finally:
                try:
                    os.killpg(process.pid, 9)
                except ProcessLookupError:
                    pass

    def measure(self, tests):
        """CPU seconds of each test without any mutant; all must pass, and there must be such a test."""
        for test in tests:
            if test in self.seconds:
                continue
            before = cpu()
            if not self.run(test, "", 600):
                raise SystemExit(f"tests/{test} fails without any mutant")
            self.seconds[test] = cpu() - before


def limits(seconds):
    """CPU time, memory, no core files: of a test with a mutant, which may do anything."""
    resource.setrlimit(resource.RLIMIT_CPU, (int(seconds) + 1, int(seconds) + 2))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    resource.setrlimit(resource.RLIMIT_AS, (4 << 30, 4 << 30))


def judge(bench, m, source, work):
    """Fills m.verdict and m.killer."""
    os.makedirs(work, exist_ok=True)
    original = work + ".o"
    if not os.path.exists(original) or open(original + ".of", encoding="utf-8").read() != m.path:
        shutil.move(bench.compile(source, work, m.path), original)
        with open(original + ".of", "w", encoding="utf-8") as f:
            f.write(m.path)
    object_file = bench.compile(m.mutated(source), work, m.path)
    if object_file is None:
        m.verdict = "stillborn"
        return
    with open(original, "rb") as a, open(object_file, "rb") as b:
        if a.read() == b.read():
            m.verdict, m.killer = "equivalent", "the same object"
            return
    shared = os.path.join(work, "mutant.so")
    subprocess.run(bench.linker + ["-shared", "-o", shared, object_file], check=True)
    for test in SUITES[m.path]:
        if not bench.run(test, shared, max(2, 5 * bench.seconds[test])):
            m.verdict, m.killer = "killed", test
            return
    m.verdict = "survived"


# ---- the report ----

def describe(m):
    return f"{m.path}:{m.line}: {m.name or m.operator}" + (f" ({m.number})" if not m.name else "") + f": {m.text}"


def table(mutants):
    """Lines of killed / survived / equivalent / stillborn per file, and the share that was killed by file."""
    lines, share = [f"{'file':<32}{'killed':>8}{'survived':>10}{'equivalent':>12}{'stillborn':>11}{'killed of all':>15}"], {}
    paths = list(dict.fromkeys(m.path for m in mutants))
    groups = [(p, [p]) for p in paths] + [("what thread check relies on", [p for p in paths if p in CHECK_RELIES_ON]), ("all", paths)]
    for name, members in groups:
        n = {v: sum(m.verdict == v and m.path in members for m in mutants) for v in ("killed", "survived", "equivalent", "stillborn")}
        counted = n["killed"] + n["survived"]
        if not counted:
            continue
        share[name] = n["killed"] / counted
        lines.append(f"{name:<32}{n['killed']:>8}{n['survived']:>10}{n['equivalent']:>12}{n['stillborn']:>11}{100 * share[name]:>13.1f} %")
    return lines, share


def arguments():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--sample", type=int, default=0, help="so many mutants, chosen at random, instead of all")
    p.add_argument("--seed", type=int, default=1)
    p.add_argument("--jobs", type=int, default=os.cpu_count())
    p.add_argument("--survivors", action="store_true", help="only those that survived the last run of these files")
    p.add_argument("--list", action="store_true", help="print the mutants and run nothing")
    p.add_argument("--out", default="build", help="the folder for everything made")
    p.add_argument("files", nargs="*")
    return p.parse_args()


def choose(a, sources):
    """The mutants of this run, and the lines of equivalent.txt that fit none."""
    wanted = [f for f in a.files if f != "named"] or ([] if a.files else list(SUITES))
    unknown = [f for f in wanted if f not in SUITES]
    if unknown:
        raise SystemExit(f"tools/mutants.py: no tests are named for {unknown[0]}; they stand in SUITES")
    mutants = [m for path in wanted for m in mutants_of(path, sources(path))]
    stale = mark_equivalent(mutants, wanted)
    if a.survivors:
        with open(os.path.join(a.out, "mutants", "survivors.txt"), encoding="utf-8") as f:
            again = set(f.read().split("\n"))
        mutants = [m for m in mutants if describe(m).partition(": ")[2] in again]
    if a.sample and a.sample < len(mutants):
        chosen = set(random.Random(a.seed).sample(range(len(mutants)), a.sample))
        mutants = [m for i, m in enumerate(mutants) if i in chosen]
    named = named_mutants(sources) if not a.survivors and (not a.files or "named" in a.files) else []
    return named, named + mutants, stale


def run(a, mutants, sources):
    """Judges all, in a pool; progress on stderr."""
    waiting = [m for m in mutants if m.verdict is None]
    tests = [t for path in dict.fromkeys(m.path for m in waiting) for t in SUITES[path]]
    bench = Bench(a.out, tests)
    bench.measure(tests)
    work = os.path.join(bench.dir, f"work-{os.getpid()}")  # another run may go on in the same tree
    slots = [os.path.join(work, str(i)) for i in range(a.jobs)]
    before, done = cpu(), 0

    def one(m):
        slot = slots.pop()
        judge(bench, m, sources(m.path), slot)
        slots.append(slot)
        return m

    with concurrent.futures.ThreadPoolExecutor(a.jobs) as pool:
        for m in pool.map(one, waiting):
            done += 1
            print(f"{done}/{len(waiting)} {m.verdict:<10} {describe(m)}" + (f" [{m.killer}]" if m.killer else ""), file=sys.stderr, flush=True)
    shutil.rmtree(work, ignore_errors=True)
    if waiting:
        print(f"{len(waiting)} mutants, {(cpu() - before) / len(waiting):.2f} CPU s each", file=sys.stderr)


def main():
    os.chdir(TREE)
    a, texts = arguments(), {}

    def sources(path):
        if path not in texts:
            with open(path, encoding="utf-8") as f:
                texts[path] = f.read()
        return texts[path]

    named, mutants, stale = choose(a, sources)
    if a.list:
        print("\n".join(describe(m) for m in mutants))
        return 0
    run(a, mutants, sources)
    lines, share = table(mutants)
    survivors = [m for m in mutants if m.verdict == "survived"]
    print("\n".join(lines))
    for m in survivors:
        print("survived  " + describe(m))
    for line in stale:
        print("tools/mutants/equivalent.txt: fits no mutant: " + line)
    with open(os.path.join(a.out, "mutants", "survivors.txt"), "w", encoding="utf-8") as f:
        f.writelines(describe(m).partition(": ")[2] + "\n" for m in survivors)
    few = [p for p in CHECK_RELIES_ON if share.get(p, 1) < 0.95] if not (a.sample or a.survivors) else []
    for path in few:
        print(f"{path}: fewer than 95 % killed")
    return 1 if few or stale or any(m.verdict != "killed" for m in named) else 0


if __name__ == "__main__":
    sys.exit(main())
