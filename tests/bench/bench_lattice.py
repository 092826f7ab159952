"""What lattices cost: beside PrusaSlicer's gyroid, in memory, and as volumes.

    bench_lattice.py ISOSLICE [--only NAME]

    slicer  CPU of a 100 mm cube of gyroid, 4 mm cells, layers of 0.2 mm, beside PrusaSlicer's gyroid of the same
            density, and of the same volume of beads (where it is installed)
    memory  of G-code: a column of 2 mm cells, 50 and 400 mm high, and that cube
    volume  CPU and memory of 1 mm cells, eight voxels each, in cubes of 100 and 200 mm to .vdb
"""
import argparse
import os
import pathlib
import re
import shutil
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "cli"))
sys.dont_write_bytecode = True

from models import box, write_stl  # noqa: E402

from bench_stream import spend  # noqa: E402

GOALS = {"slicer": 5, "height": 1.1, "cube": 150e6, "vdb": 2e9, "linear": 10}
DENSITY = 35
JOB = ["--layer-height", "0.2", "--first-layer-height", "0.2", "--perimeters", "2", "--skirts", "0"]
verdicts = []


def verdict(what, value, goal, good):
    verdicts.append(good)
    print(f"  {'good' if good else 'SHORT'}: {what} {value}, goal {goal}", flush=True)


def cube(folder, name, x, y, z):
    path = str(folder / f"{name}.stl")
    write_stl(path, box((0, 0, 0), (x, y, z)))
    return path


def measured(command):
    """CPU seconds and bytes; what fails ends it all."""
    code, said, seconds, memory = spend(command)
    if code != 0:
        sys.exit(f"{command[0]}: exit {code}: {said[-400:]}")
    return seconds, memory


def filament(path):
    """mm, of whichever program's G-code."""
    with open(path, errors="replace") as file:
        file.seek(max(0, os.path.getsize(path) - 60000))
        return float(re.search(r"filament used \[mm\] = ([\d.]+)", file.read())[1])


def slicer(program, folder):
    part, out = cube(folder, "cube", 100, 100, 100), str(folder / "out.gcode")
    ours = min(measured([program, part, "-o", out, "--fill-pattern", "gyroid_sheet", "--lattice-cell", "4",
                         "--fill-density", f"{DENSITY}%", *JOB, "--quiet"])[0] for _ in range(3))
    length = filament(out)
    print(f"  isoslice: {ours:.2f} s, {length / 1000:.1f} m, {os.path.getsize(out) >> 20} MiB")
    other = shutil.which("prusa-slicer")
    if not other:
        print("  prusa-slicer is not installed")
        return

    def theirs(density):
        seconds, _ = measured([other, "--export-gcode", "--fill-pattern", "gyroid", "--fill-density",
                               f"{density:.2f}%", *JOB,
                               "-o", out, part])
        used = filament(out)
        print(f"  PrusaSlicer, {density:.1f} %: {seconds:.2f} s, {used / 1000:.1f} m, "
              f"{os.path.getsize(out) >> 20} MiB: {seconds / ours:.1f} times")
        return seconds, used
    seconds, used = theirs(DENSITY)
    verdict("CPU beside PrusaSlicer's, same density: 1 /", f"{seconds / ours:.1f}", GOALS["slicer"],
            seconds / ours >= GOALS["slicer"])
    if abs(used / length - 1) > 0.03:
        seconds, used = theirs(DENSITY * length / used)
        verdict("CPU beside PrusaSlicer's, same volume of beads: 1 /", f"{seconds / ours:.1f}", GOALS["slicer"],
                seconds / ours >= GOALS["slicer"])


def memory(program, folder):
    out, peak = str(folder / "out.gcode"), {}
    for height in (50, 400):
        seconds, peak[height] = measured(
            [program, cube(folder, "column", 20, 20, height), "-o", out, "--fill-pattern", "gyroid_sheet",
             "--lattice-cell", "2", "--max-print-height", "500", "--quiet"])
        print(f"  20 x 20 x {height} mm, 2 mm cells: {peak[height] / 1e6:.1f} MB, {seconds:.2f} s, "
              f"{os.path.getsize(out) / 1e6:.0f} MB of G-code")
    verdict("memory of 400 mm beside 50 mm", f"{peak[400] / peak[50]:.2f}", GOALS["height"],
            peak[400] / peak[50] <= GOALS["height"])
    seconds, used = measured([program, cube(folder, "cube", 100, 100, 100), "-o", out, "--fill-pattern",
                              "gyroid_sheet", "--lattice-cell", "4", "--fill-density", f"{DENSITY}%", "--quiet"])
    verdict("memory of a 100 mm cube, 4 mm cells", f"{used / 1e6:.0f} MB", f"{GOALS['cube'] / 1e6:.0f} MB",
            used < GOALS["cube"])


def volume(program, folder):
    seconds = {}
    for edge in (100, 200):
        out = str(folder / "out.vdb")
        seconds[edge], used = measured([program, "lattice", cube(folder, "cube", edge, edge, edge), "-o", out,
                                        "--lattice-cell", "1", "--fill-density", "50%", "--voxel", "0.125",
                                        "--quiet"])
        print(f"  {edge} mm cube, 1 mm cells: {seconds[edge]:.1f} s, {used / 1e6:.0f} MB, "
              f"{os.path.getsize(out) / 1e6:.0f} MB of .vdb", flush=True)
        verdict("memory", f"{used / 1e6:.0f} MB", f"{GOALS['vdb'] / 1e6:.0f} MB", used < GOALS["vdb"])
    verdict("CPU of eight times the volume", f"{seconds[200] / seconds[100]:.1f} times", GOALS["linear"],
            seconds[200] / seconds[100] <= GOALS["linear"])


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parts = {"slicer": slicer, "memory": memory, "volume": volume}
    parser.add_argument("--only", choices=parts)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        for name, part in parts.items():
            if given.only in (None, name):
                print(name, flush=True)
                part(given.program, pathlib.Path(folder))
    return 0 if all(verdicts) else 1


if __name__ == "__main__":
    sys.exit(main())
