"""Does the check by brute force see collisions? Moves of the tool that touch, and that just don't.

    test_collide.py COLLIDE
"""
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "cli"))
sys.dont_write_bytecode = True

from models import box, write_stl  # noqa: E402
from synthetic import Writer  # noqa: E402

COLLIDE = sys.argv[1]
AREA = 0.2 * 0.4  # of a bead's section
failures = []


def wall(out, x, height):
    """A wall along Y from 90 to 110, one bead thick."""
    layers = round(height / 0.2)
    for k in range(1, layers + 1):
        out.layer(0.2)
        out.travel(X=x, Y=90 if k % 2 else 110, Z=0.2 * k)
        out.bead(20 * AREA, X=x, Y=110 if k % 2 else 90, Z=0.2 * k)


def touches(folder, expected, height, *places, turned=(), options=()):
    """A wall; then a dot that is printed at each of the places (X, Y, Z) around it, from far above."""
    out = Writer()
    wall(out, 100, height)
    out.travel(X=100, Y=100, Z=150)
    for x, y, z in places:
        out.layer(0.2)
        out.travel(X=x, Y=y, Z=150, **dict(turned))
        out.travel(X=x, Y=y, Z=z)
        out.bead(0.3 * AREA, X=x, Y=y + 0.3, Z=z)
        out.travel(X=x, Y=y, Z=150)
    code, stl = folder / "moves.gcode", folder / "box.stl"
    out.save(code)
    write_stl(stl, box((0, 0, 0), (30, 30, 30)))
    done = subprocess.run([COLLIDE, code, stl, "--told", *options], capture_output=True, text=True)
    hit = next((line for line in done.stdout.splitlines() if line.startswith("collision of")), "")
    good = done.returncode == (1 if expected else 0) and (not expected or f"of the {expected} " in hit)
    name = f"wall of {height} mm, nozzle at {places}{turned}: {expected or 'clear'}"
    print("ok  " if good else "FAIL", name)
    if not good:
        failures.append(name)
        print(done.returncode, done.stdout, done.stderr)


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        # flat tip 0.8 mm, side 45 degrees, block 20 mm wide from 6 mm on, carriage 60 mm wide from 20, gantry at 40;
        # the wall's side is at x 100.2 or so, its top 0.1 mm further in
        touches(folder, "", 4, (105, 100, 0.2))
        touches(folder, "nozzle", 4, (104, 100, 0.2))
        touches(folder, "", 6, (111, 100, 0.2))
        touches(folder, "nozzle", 6, (106, 100, 0.2))
        touches(folder, "heater block", 6.6, (109, 100, 0.2))
        touches(folder, "", 6.6, (111, 100, 0.2))
        touches(folder, "", 19.8, (120, 100, 0.2))
        touches(folder, "carriage", 20.6, (120, 100, 0.2))
        touches(folder, "", 20.6, (131, 100, 0.2))
        touches(folder, "gantry", 40.6, (195, 100, 0.2))
        touches(folder, "", 39.8, (195, 100, 0.2))
        touches(folder, "nozzle", 2, (100.5, 100, 1.7))
        touches(folder, "", 2, (100.5, 100, 1.85))
        touches(folder, "", 4, (104, 100, 0.2), options=("--cone", "20"))
        touches(folder, "", 20.6, (120, 100, 0.2), options=("--carriage", "0,0,0,0"))
        # a mandrel at half a turn lies beneath: the wall hangs from it and nothing is in the way
        rotary = ("--kinematics", "rotary_a", "--pivot", "100,100,0")
        touches(folder, "", 4, (104, 100, 0.2), turned={"A": 180}.items(), options=rotary)
        touches(folder, "nozzle", 4, (104, 100, 0.2), turned={"A": 360}.items(), options=rotary)
    return 1 if failures else 0


sys.exit(main())
