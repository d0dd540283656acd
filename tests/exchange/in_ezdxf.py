"""Reads FILE, which was drawn of PLAN with cords.csv CSV, plain or with lanes, by ezdxf, and compares every cord."""
import os
import sys

import ezdxf

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from expected import Cords  # noqa: E402

path, plan, table, how = sys.argv[1:]
cords = Cords(plan, table)
document = ezdxf.readfile(path)
audit = document.audit()
assert not audit.errors and not audit.fixes, (audit.errors, audit.fixes)
assert document.header["$INSUNITS"] == 4, document.header["$INSUNITS"]  # millimetres
lines = {line.dxf.layer: line for line in document.modelspace().query("POLYLINE")}
assert set(lines) == set(cords.path), (sorted(lines), sorted(cords.path))
for name, line in lines.items():
    cords.compare(name, [tuple(v.dxf.location) for v in line.vertices], how == "lanes", 1e-8)  # of which cords.csv has the digits
    assert document.layers.get(name).dxf.color > 0, name
print("ezdxf: %d cords" % len(lines))
