#!/usr/bin/env python3
"""Damaged files of every format that is read, through the command line: an exit code that is documented for input (0, 3, 4 or 5),
one line on stderr where there is no plan and none where there is one, within 5 s of processor time.

    tests/formats/mutants.py PROGRAM [--each N] [--seed S] [--plan] [--keep FOLDER] [FORMAT ..]

N mutants of each format (default 40), of its files among tests/formats and tests/fuzz/corpus. Without --plan they are read by
`thread info -q`, with it planned through by `thread plan -q --time-limit 2` as well. --keep: mutants that fail are kept there.
Closes with "N passed, N failed"."""
import argparse
import os
import random
import resource
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
ENDINGS = {"csv": ("csv", "tsv"), "obj": ("obj",), "json": ("json",), "ply": ("ply",), "off": ("off",), "vef": ("vef",), "stl": ("stl",), "dxf": ("dxf",),
           "gltf": ("gltf", "glb"), "graphml": ("graphml",)}
NUMBERS = [b"0", b"-1", b"1", b"2147483648", b"-2147483649", b"99999999999999999999", b"1e999", b"-1e308", b"1e-320", b"nan", b"inf", b"0x10",
           b"1,5", b"", b"1.2.3"]
MOST_CPU = 5  # s


def samples(form):
    """[(ending, bytes)]: small files first, so that most mutants are of such."""
    found = []
    folders = [HERE, os.path.join(HERE, "..", "fuzz", "corpus", form)]
    for folder in folders:
        for name in sorted(os.listdir(folder)) if os.path.isdir(folder) else []:
            ending = name.rsplit(".", 1)[-1]
            if folder == HERE and ending not in ENDINGS[form]:
                continue
            with open(os.path.join(folder, name), "rb") as f:
                found.append((ending if ending in ENDINGS[form] else ENDINGS[form][0], f.read()))
    found.sort(key=lambda s: len(s[1]))
    return found


def numbers_in(data):
    """[(from, to)] of runs of digits and what belongs to them."""
    runs, i = [], 0
    while i < len(data):
        j = i
        while j < len(data) and data[j] in b"0123456789.-+eE":
            j += 1
        if j > i and any(c in b"0123456789" for c in data[i:j]):
            runs.append((i, j))
        i = max(j, i + 1)
    return runs


def damage(rng, data):
    """One change of a kind that editors, transfers and other programs make, or nobody."""
    kind, n = rng.randrange(9), len(data)
    if n == 0 or kind == 0:
        return data[:rng.randrange(n + 1)]
    i = rng.randrange(n)
    j = min(n, i + 1 + int(rng.expovariate(1 / 20)))
    if kind == 1:
        return data[:i] + bytes([data[i] ^ 1 << rng.randrange(8)]) + data[i + 1:]
    if kind == 2:
        return data[:i] + data[j:]
    if kind == 3:
        return data[:j] + data[i:j] * rng.choice((1, 2, 50)) + data[j:]
    if kind == 4:
        return data[:i] + bytes(rng.randrange(256) for _ in range(rng.randrange(1, 9))) + data[i:]
    if kind in (5, 6):
        runs = numbers_in(data) if n < 200000 else []
        if runs:
            i, j = rng.choice(runs)
            return data[:i] + rng.choice(NUMBERS) + data[j:]
    lines = data.split(b"\n")
    a, b = rng.randrange(len(lines)), rng.randrange(len(lines))
    if kind == 7:
        lines[a], lines[b] = lines[b], lines[a]
    else:
        lines[a:a + 1] = rng.choice(([], [lines[b], lines[a]], [lines[a] + b" " + lines[b]]))
    return b"\n".join(lines)


def run(argv):
    """(exit code, stderr, CPU s)"""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(argv, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, check=False, timeout=300)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return done.returncode, done.stderr, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def complaint(code, said, cpu):
    lines = said.count(b"\n")
    if code not in (0, 3, 4, 5):
        return f"exit code {code}"
    if lines != (0 if code == 0 else 1) or (said and not said.startswith(b"thread: ")):
        return f"exit code {code} and {lines} lines"
    if any(c < 32 and c != 10 or c == 127 for c in said):
        return "control characters in the message"
    if cpu > MOST_CPU:
        return f"{cpu:.1f} CPU s"
    return None


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--each", type=int, default=40)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--plan", action="store_true")
    parser.add_argument("--keep")
    parser.add_argument("formats", nargs="*")
    args = parser.parse_intermixed_args()
    program = os.path.abspath(args.program)
    passed = failed = 0
    with tempfile.TemporaryDirectory() as scratch:
        for name in os.listdir(HERE):
            if name.endswith(".bin"):  # of a glTF file, which finds it beside itself
                shutil.copy(os.path.join(HERE, name), scratch)
        for form in args.formats or ENDINGS:
            rng = random.Random(f"{args.seed} {form}")
            files = samples(form)
            assert files, f"no samples of {form}"
            codes = {}
            for i in range(args.each):
                ending, data = files[min(rng.randrange(len(files)), rng.randrange(len(files)))]
                for _ in range(rng.choice((1, 1, 2, 5))):
                    data = damage(rng, data)
                path = os.path.join(scratch, f"mutant.{ending}")
                with open(path, "wb") as f:
                    f.write(data)
                commands = [[program, "info", "-q", path]]
                if args.plan:
                    commands.append([program, "plan", path, "-q", "--time-limit", "2", "-o", os.path.join(scratch, "plan.json")])
                for argv in commands:
                    code, said, cpu = run(argv)
                    what = complaint(code, said, cpu)
                    codes[code] = codes.get(code, 0) + 1
                    passed, failed = passed + (what is None), failed + (what is not None)
                    if what:
                        print(f"{form} mutant {i} of seed {args.seed}, thread {argv[1]}: {what}\n  " + said[:600].decode("utf-8", "replace"))
                        if args.keep:
                            os.makedirs(args.keep, exist_ok=True)
                            with open(os.path.join(args.keep, f"{form}-{args.seed}-{i}.{ending}"), "wb") as f:
                                f.write(data)
            print(f"{form}: exit codes {', '.join(f'{c}: {codes[c]}' for c in sorted(codes))}")
    print(f"{passed} passed, {failed} failed")
    return failed > 0


if __name__ == "__main__":
    sys.exit(main())
