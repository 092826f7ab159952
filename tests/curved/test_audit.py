"""Is the audit right? Prints that fill a part exactly, and what is wrong on purpose.

    test_audit.py AUDIT [VOXEL]
"""
import math
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "cli"))
sys.dont_write_bytecode = True

from models import write_stl  # noqa: E402
from synthetic import between, ring_stack, tube, wound_tube  # noqa: E402

AUDIT, VOXEL = sys.argv[1], sys.argv[2] if len(sys.argv) > 2 else "0.1"
HEIGHT, RADIUS, LAYERS = 3, 5, 15
failures = []


def check(name, good, figures):
    print("ok  " if good else "FAIL", name)
    if not good:
        failures.append(name)
        print("    ", figures)


def audit(folder, print_, part, *options):
    code, stl = folder / "print.gcode", folder / "part.stl"
    print_.save(code)
    write_stl(stl, part)
    done = subprocess.run([AUDIT, code, stl, "--voxel", VOXEL, *options], capture_output=True, text=True)
    figures = {"exit": done.returncode, "said": done.stderr}
    for line in done.stdout.splitlines():
        name, _, value = line.partition(" ")
        figures[name] = float(value.split()[0])
    return figures


def complete(f, gap=0.2):
    return (abs(f["volume_pct"]) < 0.1 and f["gap_pct"] < gap and f["spill_gap_pct"] < 1.2
            and f["worst_layer_pct"] < 1 and f["odd_beads"] == 0)


def shapes(folder):
    cone = math.tan(math.radians(20))
    bowl = {"cone": (lambda r: cone * r, "z - tan(20*pi/180)*sqrt(x^2+y^2)"),
            "roof": (lambda r: cone * (RADIUS - r), f"z + {cone:.12f}*hypot(x, y)"),
            "paraboloid": (lambda r: 0.02 * r * r, "z - 0.02*(x^2 + y^2)")}
    for name, (bottom, field) in bowl.items():
        part, stack = between(bottom, HEIGHT, RADIUS), ring_stack(bottom, HEIGHT, RADIUS, LAYERS)
        f = audit(folder, stack, part, "--field", field)
        check(f"{name} is filled", complete(f), f)
        check(f"{name} is filled by boxes", f["flat_pct"] < 4 and f["overfill_pct"] < 4, f)
        f = audit(folder, stack, part)
        check(f"{name} is filled, seen from its beads alone",
              abs(f["volume_pct"]) < 0.1 and f["underfill_pct"] < 0.5 and f["spill_pct"] < 3, f)


def broken(folder):
    slope = math.tan(math.radians(20))

    def bottom(r):
        return slope * r

    def figures(*options, **changes):
        return audit(folder, ring_stack(bottom, HEIGHT, RADIUS, LAYERS, **changes), part, "--field",
                     f"z - {slope:.12f}*sqrt(x^2+y^2)", *options)

    part = between(bottom, HEIGHT, RADIUS)
    for layer in (7, LAYERS - 1):
        f = figures("--slack", "0.02", missing=(layer,))
        check(f"layer {layer} is missing", abs(f["volume_pct"] + 100 / LAYERS) < 0.2 and f["underfill_pct"] > 3.5, f)
    f = figures(flow=0.9)
    check("10 % less comes out", abs(f["volume_pct"] + 10) < 0.2, f)
    f = figures(flow=0.8)
    check("20 % less comes out, and gapes", abs(f["volume_pct"] + 20) < 0.2 and f["gap_pct"] > 5, f)
    f = figures(flow=1.1)
    check("10 % more comes out", abs(f["volume_pct"] - 10) < 0.2 and f["overfill_pct"] > 7, f)
    f = figures(shift=(0.3, 0, 0))
    check("all is shifted by 0.3 mm", f["gap_pct"] > 1.2 and f["spill_gap_pct"] > 1.2, f)
    f = figures(shift=(0, 0, 0.3))
    check("all is too high by 0.3 mm", f["spill_pct"] > 5, f)
    f = figures(shift=(0.5, 0, 0), shifted=9)
    check("one layer is shifted", f["worst_layer_pct"] > 40, f)
    f = figures(shift=(0, 0, 0.1), shifted=9)
    check("one layer is half a layer too high", f["worst_layer_pct"] > 15, f)
    limits = ("--volume-within", "1", "--most-gap", "1", "--most-layer", "5", "--most-spill", "3",
              "--most-underfill", "2")
    f = figures(*limits)
    check("limits are kept", f["exit"] == 0, f)
    for name, changes in {"volume_pct": {"flow": 0.9}, "worst_layer_pct": {"missing": (3,)},
                          "spill_pct": {"shift": (0.8, 0, 0)}, "gap_pct": {"flow": 0.7}}.items():
        f = figures(*limits, **changes)
        check(f"the limit of {name} is seen", f["exit"] == 1 and name in f["said"], f)


def turned(folder):
    part = tube(6, 8, 5)
    machine = ("--kinematics", "rotary_a", "--pivot", "100,100,8", "--field", "cylinder:x,0,8")
    f = audit(folder, wound_tube(6, 8, 5, 10), part, *machine)
    check("a tube is wound", complete(f, 0.4) and f["tilt_deg"] < 0.1, f)
    f = audit(folder, wound_tube(6, 8, 5, 10, step=40), part, *machine)
    check("moves that turn far are arcs", complete(f, 0.4), f)
    f = audit(folder, wound_tube(6, 8, 5, 10, rounds=0.5), part, *machine)
    check("half of it comes out", abs(f["volume_pct"] + 50) < 0.2 and f["gap_pct"] > 25, f)
    f = audit(folder, wound_tube(6, 8, 5, 10), part, "--kinematics", "rotary_a", "--pivot", "100,101,8",
              "--field", "cylinder:x,0,8")
    check("a mandrel beside its place is seen", f["tilt_deg"] > 5, f)


with tempfile.TemporaryDirectory() as name:
    shapes(pathlib.Path(name))
    broken(pathlib.Path(name))
    turned(pathlib.Path(name))
sys.exit(1 if failures else 0)
