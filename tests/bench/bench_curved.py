"""What curved layers cost beside flat ones, in CPU time; the runs of both take turns.

    bench_curved.py ISOSLICE MODEL.stl ... [--runs N] [--field TEXT ...]

For each model: --field z, and the same with each field (cone:10 if none is given), with and without the check of the
tool's clearance. Goals: z 1.2 times, a cone 2.5 times what flat layers cost.
"""
import argparse
import os
import pathlib
import resource
import subprocess
import sys
import tempfile

JOB = ["--layer-height", "0.2", "--first-layer-height", "0.2", "--quiet"]


def spend(command):
    """CPU seconds; None if it fails."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode:
        print("   ", done.stderr.strip()[:200])
        return None
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def compare(program, model, fields, runs, folder):
    out = str(folder / "out.gcode")
    flat = [program, "slice", model, "-o", out, *JOB]
    jobs = {"flat": flat, "z": [*flat, "--field", "z"]}
    for field in fields:
        jobs[field] = [*flat, "--field", field]
        jobs[f"{field} unchecked"] = [*flat, "--field", field, "--no-check-clearance"]
    best, size = {}, {}
    for _ in range(runs):
        for name, command in list(jobs.items()):
            seconds = spend(command)
            if seconds is None:
                del jobs[name]
                continue
            best[name] = min(seconds, best.get(name, seconds))
            size[name] = os.path.getsize(out)
    print(pathlib.Path(model).name)
    for name in best:
        print(f"  {name:24} {best[name]:7.3f} s  {best[name] / best['flat']:6.2f} times  "
              f"{size[name] / 1e6:7.2f} MB, {size[name] / size['flat']:.2f} times", flush=True)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("models", nargs="+")
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--field", action="append", default=[])
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        for model in given.models:
            compare(given.program, model, given.field or ["cone:10"], given.runs, pathlib.Path(folder))
    return 0


sys.exit(main())
