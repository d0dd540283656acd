#!/usr/bin/env python3
"""The thesis's experiments, by commands of the program: tests/validate/experiments.py PROGRAM REPORT PICTURES [NAME ..]

Every module of tests/validate/experiments has section(program, folder) -> str: it runs commands in an empty folder, the current one, writes
pictures into `folder`, and returns its part of REPORT (Markdown). It fails (AssertionError or ValueError) where what it finds is not what it says. With
names only those modules are run, and the parts of the others stay as they are in REPORT. Exits 1 if one fails.
"""
import importlib
import os
import re
import shlex
import statistics
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
HEAD = """# The thesis's experiments

`make validate` writes this page (`tests/validate/experiments.py`): what the models of M. Nelson's thesis showed, asked of the program. Each
part fails if it finds something else than it says. Simulated (`thread rise`), with seeds: median and range.
"""
MARK = "<!-- {} -->"


def run(program, command):
    """Runs a command as it is typed, and returns what it prints."""
    words = shlex.split(command)
    done = subprocess.run([program, *words[1:]], capture_output=True, text=True)
    if done.returncode:
        raise AssertionError(f"{command}: exit {done.returncode}: {done.stderr.strip()}")
    return done.stdout


def median_range(values):
    """"1.3 (1.1 to 1.5)"."""
    values = sorted(values)
    return f"{statistics.median(values):.3g} ({values[0]:.3g} to {values[-1]:.3g})"


def svg_file(path, wide, high, parts):
    """Writes a picture, sizes in mm."""
    with open(path, "w", encoding="utf-8") as file:
        file.write(f'<svg xmlns="http://www.w3.org/2000/svg" width="{wide}mm" height="{high}mm" viewBox="0 0 {wide} {high}">'
                   "<style>text{font-family:'DejaVu Sans',Verdana,sans-serif;font-size:3.2px}</style>"
                   f'<rect width="{wide}" height="{high}" fill="#fff"/>\n' + "\n".join(parts) + "\n</svg>\n")


def last_frame(program, command, path, first=None):
    """Runs a rise and keeps the last picture of it, and the first one."""
    run(program, f"{command} --frames still --size 800x500 -q")
    pictures = [os.path.join("still", name) for name in sorted(os.listdir("still"))]
    os.replace(pictures[-1], path)
    if first:
        os.replace(pictures[0], first)


def main():
    if len(sys.argv) < 4:
        sys.exit(__doc__.splitlines()[0])
    program, report, pictures = (os.path.abspath(path) for path in sys.argv[1:4])
    names = sorted(name[:-3] for name in os.listdir(os.path.join(HERE, "experiments")) if name.endswith(".py") and name[0] != "_")
    unknown = set(sys.argv[4:]) - set(names)
    if unknown:
        sys.exit(f"there is no experiment {', '.join(sorted(unknown))}; there are {', '.join(names)}")
    folder = os.path.join(pictures, "experiments")
    os.makedirs(folder, exist_ok=True)
    sys.path.insert(0, HERE)
    sys.modules["experiments"] = sys.modules["__main__"]  # modules import the helpers above
    sys.path.insert(0, os.path.join(HERE, "experiments"))

    part, failed, home = {}, False, os.getcwd()
    if os.path.exists(report):
        with open(report, encoding="utf-8") as file:
            part = dict(re.findall(r"<!-- (\w+) -->\n(.*?)(?=\n<!-- |\Z)", file.read(), re.S))
    for name in names:
        if sys.argv[4:] and name not in sys.argv[4:]:
            continue
        with tempfile.TemporaryDirectory() as work:
            os.chdir(work)
            try:
                part[name] = importlib.import_module(name).section(program, folder).strip() + "\n"
                print(f"{name}: ok")
            except (AssertionError, ValueError) as error:
                failed = True
                print(f"{name}: {error}", file=sys.stderr)
            os.chdir(home)
    with open(report, "w", encoding="utf-8") as file:
        file.write(HEAD + "".join(f"\n{MARK.format(name)}\n{part[name].strip()}\n" for name in names if name in part))
    sys.exit(failed)


if __name__ == "__main__":
    main()
