"""What check_solid costs: CPU and memory of jobs with off, auto and full.

    bench_solid.py ISOSLICE [MODEL.stl...]

Two models are made: a plate of 289 spheres and a torus that lacks a triangle. The job is
PrusaSlicer's usual one, then nothing but one wall, of which the check is the largest share.
"""
import argparse
import math
import pathlib
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "cli"))
sys.dont_write_bytecode = True

from models import moved, torus, write_stl  # noqa: E402

from bench_stream import spend  # noqa: E402

GOAL = 1.1
JOBS = {"usual": [],
        "one wall": ["--perimeters", "1", "--fill-density", "0", "--top-solid-layers", "0",
                     "--bottom-solid-layers", "0"]}


def sphere(radius, rows=24):
    def point(i, j):
        polar, around = math.pi * i / rows, math.pi * (j % (2 * rows)) / rows
        r = radius * math.sin(polar) if 0 < i < rows else 0
        return (r * math.cos(around), r * math.sin(around), radius * math.cos(polar))

    triangles = []
    for i in range(rows):
        for j in range(2 * rows):
            a, b, c, d = point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)
            triangles += [(a, b, c)] * (i < rows - 1) + [(a, c, d)] * (i > 0)
    return triangles


def make_models(folder):
    plate, ring = str(folder / "plate.stl"), str(folder / "torus.stl")
    ball = sphere(5.2)
    write_stl(plate, [t for i in range(17) for j in range(17) for t in moved(ball, 10.9 * i, 10.9 * j)])
    write_stl(ring, torus(15, 6, 64, 48)[1:])
    return [plate, ring]


def measure(command, rounds):
    """The least CPU seconds, and bytes."""
    least = []
    for _ in range(rounds):
        code, said, seconds, memory = spend(command)
        if code != 0:
            sys.exit(f"{command[0]}: exit {code}: {said[-400:]}")
        least.append((seconds, memory))
    return min(s for s, _ in least), min(m for _, m in least)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("isoslice")
    parser.add_argument("model", nargs="*")
    parser.add_argument("--rounds", type=int, default=7)
    given = parser.parse_args()
    good = True
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        for model in given.model + make_models(folder):
            for job, flags in JOBS.items():
                base = None
                for mode in ("off", "auto", "full"):
                    seconds, memory = measure(
                        [given.isoslice, model, "-o", str(folder / "out.gcode"), "--threads", "1",
                         "--quiet", "--skirts", "0", "--check-solid", mode, *flags], given.rounds)
                    base = base or seconds
                    short = mode == "auto" and seconds > GOAL * base
                    good &= not short
                    print(f"{'SHORT ' if short else ''}{pathlib.Path(model).name}, {job}, {mode}: "
                          f"{1e3 * seconds:.1f} ms, {100 * (seconds / base - 1):+.1f} %, "
                          f"{memory >> 20} MiB", flush=True)
    print(f"auto costs {'at most' if good else 'MORE THAN'} {100 * (GOAL - 1):.0f} %")
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
