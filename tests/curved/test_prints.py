"""Whole prints with curved layers, judged by their G-code alone: does it fill the part, does the tool stay clear of what
is printed, does a printer take it, is it the same for any number of threads?

    test_prints.py CASE ISOSLICE VIRTUAL AUDIT COLLIDE [VOXEL]     CASE: one below, or 'all'
"""
import math
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "cli"))
sys.dont_write_bytecode = True

import parts  # noqa: E402
from synthetic import tube  # noqa: E402
from models import box, torus, turned, write_stl  # noqa: E402

ISOSLICE, VIRTUAL, AUDIT, COLLIDE = sys.argv[2:6]
VOXEL = sys.argv[6] if len(sys.argv) > 6 else "0.05"
SLICE = ["--fill-density", "100%", "--skirts", "0", "--layer-height", "0.2", "--first-layer-height", "0.2"]
LIMITS = ["--volume-within", "1", "--most-underfill", "1", "--most-spill", "1"]
WING = "((x+31.2)/60)"
WING = f"6.4*z/(4+24*(0.2969*sqrt({WING})-0.1260*{WING}-0.3516*{WING}^2+0.2843*{WING}^3-0.1036*{WING}^4))"
FAN = ["--field", "fan:y,-20,0,30"]
SLANT = ["--field", f"fan:y,{-30 - (20 * math.cos(math.radians(40)) - 20) / 2:.6f},0,30"]
MANDREL = ["--field", "cylinder:x,0,9", "--kinematics", "rotary_a"]

# part, options of the slicer, options of the checks. Where layers are known by a formula (no flat base) the audit works
# them out by itself; else it goes by where the beads are.
PRINTS = {
    "dome": [(parts.dome, ["--field", "sphere:0,0,-28.1576"], []),
             (parts.dome, ["--field", "z + 0.01*(x^2 + y^2)", "--field-base", "0.6", "--field-blend", "6"], [])],
    "wing": [(parts.wing, ["--field", WING, "--no-field-flat-base"], ["--field", WING])],
    "wing-auto": [(parts.wing, ["--field", "auto-top"], [])],
    "dome-auto": [(parts.dome, ["--field", "auto-top"], [])],
    "elbow": [(lambda: parts.elbow(inner=6), FAN + ["--kinematics", "table_bc"],
               FAN + ["--kinematics", "table_bc", "--pivot", "100,100,0"])],
    "elbow-ac": [(lambda: parts.elbow(inner=6, degrees=40, rings=30), SLANT + ["--kinematics", "table_ac"],
                  SLANT + ["--kinematics", "table_ac", "--pivot", "100,100,0"])],
    "mandrel": [(lambda: tube(7, 9, 8, 120), MANDREL, MANDREL + ["--pivot", "100,100,9"])],
    "elbow-upright": [(lambda: parts.elbow(degrees=35, inner=6, rings=24), ["--field", "plane:-0.3,0,1"], [])],
}
failures = []


def check(name, good, said=""):
    print("ok  " if good else "FAIL", name, flush=True)
    if not good:
        failures.append(name)
        print(said)


def run(*command):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr


def slice_it(folder, name, *options):
    out = folder / name
    code, said = run(ISOSLICE, "slice", folder / "part.stl", "-o", out, "--quiet", *SLICE, *options)
    return out if code == 0 else None, said


def whole(folder, name, part, options, checks):
    write_stl(folder / "part.stl", part())
    out, said = slice_it(folder, "one.gcode", "--threads", "1", *options)
    check(f"{name}: sliced", out is not None, said)
    if out is None:
        return
    other, said = slice_it(folder, "four.gcode", "--threads", "4", *options)
    check(f"{name}: the same by four threads", other is not None and other.read_bytes() == out.read_bytes(), said)
    code, said = run(AUDIT, out, folder / "part.stl", "--voxel", VOXEL, *checks, *LIMITS)
    check(f"{name}: fills the part", code == 0, said)
    code, said = run(COLLIDE, out, folder / "part.stl", *checks)
    check(f"{name}: stays clear", code == 0, said)
    code, said = run(VIRTUAL, "--run", out, "--quiet")
    check(f"{name}: printed", code == 0, said)


def without_settings(path):
    return [line for line in path.read_bytes().splitlines() if not line.startswith(b"; field = ")]


def flat(folder):
    """A field that is z prints as flat layers do."""
    models = {"box": box((0, 0, 0), (12, 9, 5)), "torus": torus(9, 3, 48, 24),
              "vase": turned([(6, 0), (9, 4), (5, 8)], lobes=5, depth=0.2, twist=1), "dome": parts.dome()}
    for name, model in models.items():
        write_stl(folder / "part.stl", model)
        for extra in ([], ["--fill-pattern", "gyroid", "--fill-density", "30%"], ["--first-layer-height", "0.3"]):
            plain, said = slice_it(folder, "plain.gcode", *extra)
            z, said_z = slice_it(folder, "z.gcode", *extra, "--field", "z")
            check(f"{name} {' '.join(extra)}: z is flat",
                  plain is not None and z is not None and without_settings(plain) == without_settings(z), said + said_z)


def main():
    wanted = list(PRINTS) + ["flat"] if sys.argv[1] == "all" else [sys.argv[1]]
    with tempfile.TemporaryDirectory() as name:
        for case in wanted:
            if case == "flat":
                flat(pathlib.Path(name))
            for one in PRINTS.get(case, []):
                whole(pathlib.Path(name), case, *one)
    return 1 if failures else 0


sys.exit(main())
