"""Print lattices of all kinds, and make parts of them, with options at random; see combine.py.

    porous.py ISOSLICE ISOPRINT [--cases N] [--first N] [--seconds S] [--keep DIR] [--minimise]
              [--threads 1,2] [--no-parts] [-j N] [-v]

A case is a number. Two of three are prints, held against all that combine.py holds a print
against; of the others `isoslice lattice` makes a mesh, a volume or a print: the same bytes for any
number of threads, a mesh that is closed and finite, a report whose figures agree.
"""
import argparse
import concurrent.futures
import glob
import json
import math
import os
import struct
import sys
import tempfile
import time

import numpy

import combine
import nasty

BOUND = {"EXPRESSION": [
    "ramp(z, 0, 4, 10, 60)", "30 + 20*sin(x)", "x > 0 ? 10 : 70", "floor(mod(x, 2))*50 + 10",
    "sqrt(x)*10", "log(x)", "0/0", "1/0", "-5", "1e300", "exp(1000)", "x/y*10", "clamp(r*5, 5, 95)",
    "ramp(skin, 0, 2, 80, 20)", "100", "0", "99.99", "0.001", "50 + 1e-12*x", "z < 1 ? 0/0 : 40",
    "tan(x)*30", "(x^2 + y^2)^0.5*4", "mod(x*7919, 100)", "-x"],
    "CELL": ["4", "2.5", "8", "0.9", "3", "60", "1000", "ramp(r, 0, 15, 3, 6)", "ramp(z, 0, 6, 2, 5)",
             "x > 0 ? 2 : 5", "3 + x*0.1", "0/0", "-1", "0", "sqrt(x)", "ramp(skin, 0, 3, 2, 4)",
             "2 + abs(y)", "1e-9", "1e12", "3 + sin(x)"]}
MAPS = ["xyz", "xyz", "xyz", "cylinder", "sphere", "skin", "skin_cylinder"]
PART_REFUSED = {4, 5, 6, 8, 69}


# ---- what is chosen ----


def pick(random, values):
    return values[int(random.integers(len(values)))]


def density(random):
    kind = random.random()
    if kind < 0.15:
        return pick(random, [0.1, 1, 99, 99.9, 100, 0, 50])
    return round(float(random.uniform(3, 97)), 1)


def lattice_options(random, patterns):
    chosen = {"fill_pattern": pick(random, patterns), "fill_density": f"{density(random)}%"}
    chosen["lattice_cell"] = pick(random, BOUND["CELL"]) if random.random() < 0.4 else \
        f"{math.exp(random.uniform(math.log(1.2), math.log(12))):.3g}"
    if random.random() < 0.06:
        chosen["lattice_cell"] = pick(random, ["0.2", "0.4"])
    if random.random() < 0.4:
        chosen["lattice_density"] = pick(random, BOUND["EXPRESSION"])
    if random.random() < 0.5:
        chosen["lattice_map"] = pick(random, MAPS)
    if random.random() < 0.3:
        chosen["lattice_seed"] = int(random.integers(10 ** 6))
    if "random" in chosen["fill_pattern"]:
        chosen["lattice_pore"] = round(float(random.uniform(0.05, 1)), 2)
    return chosen


PRINT = {
    "perimeters": [0, 1, 2, 4], "layer_height": [0.1, 0.2, 0.3], "infill_every_layers": [1, 2, 3],
    "top_solid_layers": [0, 3], "bottom_solid_layers": [0, 3], "arc_fitting": ["emit_center", "disabled"],
    "duplicate": [2], "complete_objects": [1], "infill_first": [1], "extrusion_width": [0.4, 0.6],
    "infill_overlap": ["0%", "25%", "50%"], "solid_infill_below_area": [0, 70], "fuzzy_skin": ["all"],
    "infill_extrusion_width": [0.35, 0.8], "nozzle_diameter": [0.4, 0.8], "brim_width": [2],
    "rotate": [0, 30, 90], "gcode_resolution": [0, 0.0125, 0.1], "only_retract_when_crossing_perimeters": [1],
    "avoid_crossing_perimeters": [1], "infill_anchor": [0, 2], "infill_anchor_max": [0, 30],
    "spiral_vase": [0, 0, 0, 1], "cut": [2.1], "split": [1], "solid_infill_every_layers": [3],
    "ensure_vertical_shell_thickness": [0, 1], "wipe": [1], "adaptive_layers": [1],
    "only_one_perimeter_top": [1], "infill_only_where_needed": [1], "lattice_material": ["", "", "50"],
    "modifiers": ["MODIFIER fill_pattern=gyroid_sheet", "MODIFIER fill_pattern=rectilinear",
                  "MODIFIER fill_pattern=octet_struts fill_density=80%", "MODIFIER fill_density=5%"],
}


def print_options(random, table):
    chosen = {}
    for key in PRINT:
        if key in table and random.random() < 0.18:
            chosen[key] = pick(random, PRINT[key])
    if chosen.get("spiral_vase"):
        chosen.update(perimeters=1, fill_density="0%", top_solid_layers=0)
        chosen.pop("duplicate", None)
    if "modifiers" in chosen:  # a cut would move what they lie in
        chosen.pop("cut", None)
        chosen.pop("split", None)
    if chosen.get("duplicate") == 2 and random.random() < 0.5:
        chosen["complete_objects"] = 1
    return chosen


# ---- models ----


def cube(random):
    size = random.uniform(4, 16)
    return nasty.box([0, 0, 0], [size, size * random.uniform(0.3, 1), random.uniform(1, 8)]), {"closed"}


def mast(random):
    return nasty.cylinder(random.uniform(0.5, 3), 0, 25, int(random.integers(3, 20))), {"closed"}


def sheet(random):
    """An open cup: it has no inside but with a thickness."""
    ring = nasty.cylinder(random.uniform(4, 10), 0, random.uniform(2, 6), 24)
    keep = [t for t in ring if not numpy.ptp(t[:, 2]) < 1e-9 or t[:, 2].max() < 1e-9]
    return numpy.array(keep), {"open"}


def nested(random):
    size = random.uniform(6, 14)
    made = [nasty.box([0, 0, 0], [size, size, 5])]
    for step in range(1, int(random.integers(2, 4))):
        inner = nasty.box([step, step, step * 0.8], [size - step, size - step, 5 - step * 0.8])
        made.append(nasty.inverted(inner) if random.random() < 0.6 else inner)
    return numpy.concatenate(made), {"closed"}


def ball(random):
    return nasty.sphere(random.uniform(2, 7), 16, 24), {"closed"}


def ring(random):
    return nasty.torus(random.uniform(4, 8), random.uniform(0.6, 2.5), 32, 16), {"closed"}


def speck(random):
    size = random.uniform(0.05, 1.2)
    return nasty.box([0, 0, 0], [size, size, random.uniform(0.3, 3)]), {"tiny"}


MODELS = [cube, ring, ball, mast, nested, cube, combine.shells, sheet, combine.pocket, speck,
          combine.islands, nasty.sieve, nasty.comb, nasty.heap, nasty.needles, nasty.touching]


def model_of(random, case):
    make = MODELS[case % len(MODELS)]
    triangles, traits = make(random)
    traits = set(traits) - {"thick", "solid"}
    extent = numpy.ptp(triangles.reshape(-1, 3), axis=0)
    triangles = triangles * min(1.0, 22 / max(extent[:2].max(), 1e-9), (26 if make is mast else 9) / extent[2])
    return make.__name__, triangles, traits


# ---- a part of its own ----


def read_stl(path):
    data = open(path, "rb").read()
    count = struct.unpack_from("<I", data, 80)[0]
    if len(data) != 84 + 50 * count:
        return None
    rows = numpy.frombuffer(data, numpy.uint8, offset=84).reshape(count, 50)
    return rows[:, 12:48].copy().view("<f4").reshape(count, 3, 3)


def check_mesh(path, figures, box):
    corner = read_stl(path)
    if corner is None or len(corner) != figures["triangles"]:
        return ["mesh: its size is not what the report says"]
    if len(corner) == 0:
        return []
    if not numpy.isfinite(corner).all():
        return ["mesh: a corner that is no number"]
    found = []
    flat = corner.reshape(-1, 3)
    low, high = flat.min(0), flat.max(0)
    slack = 2 * figures["voxel_mm"]
    if (low < box[0] - slack).any() or (high > box[1] + slack).any():
        found.append(f"mesh: from {low} to {high}, its part from {box[0]} to {box[1]}")
    ids = numpy.unique(flat, axis=0, return_inverse=True)[1].reshape(-1, 3)
    edge = numpy.concatenate([ids[:, [0, 1]], ids[:, [1, 2]], ids[:, [2, 0]]]).astype(numpy.int64)
    edge = edge[edge[:, 0] != edge[:, 1]]
    count = len(flat)
    ahead, back = edge[:, 0] * count + edge[:, 1], edge[:, 1] * count + edge[:, 0]
    if not numpy.array_equal(numpy.sort(ahead), numpy.sort(back)):
        found.append("mesh: open edges")
    return found


def check_figures(figures):
    def bad(value, low, high):
        return not isinstance(value, (int, float)) or not low <= value <= high
    found = []
    for key in ("porosity", "porosity_with_skin", "porosity_asked"):
        if figures.get(key) is not None and bad(figures[key], -1e-9, 1 + 1e-9):
            found.append(f"figures: {key} is {figures[key]}")
    for key, value in figures.items():
        if key.endswith(("_mm", "_mm2", "_mm3")) and isinstance(value, (int, float)) and value < -1e-9:
            found.append(f"figures: {key} is {value}")
    if figures.get("material_mm3") and figures["material_mm3"] > 1.05 * figures["part_mm3"] + 0.5:
        found.append(f"figures: {figures['material_mm3']} mm3 of material in {figures['part_mm3']}")
    return found


def part_options(random, fine):
    chosen, words = {}, []
    if random.random() < 0.4:
        chosen["lattice_skin"] = round(float(random.uniform(0.2, 3)), 2)
        if random.random() < 0.5:
            chosen["lattice_drain"] = pick(random, ["0,0", "-2,1,3,0.5", "100,100"])
            chosen["lattice_drain_diameter"] = pick(random, [0.3, 2, 50])
    if random.random() < 0.3:
        chosen["lattice_open"] = 1
    if not fine or random.random() < 0.5:  # by itself a 24th of a cell: small cells take their time
        words.append(f"--voxel={pick(random, [0.15, 0.3, 0.3, 0.5, 1, 5])}")
    return chosen, words


def examine_part(given, stl, base, options, words, box):
    ending = words[0]
    flags = [f"--{key.replace('_', '-')}={value}" for key, value in options.items()] + words[1:]
    outputs, seconds = [], 0
    for threads in given.threads.split(","):
        out = f"{base}-{threads}.{ending}"
        code, said, errors, took = combine.run(
            [given.program, "lattice", *stl, "-o", out, "--quiet", "--report", base + ".json",
             f"--threads={threads}", *flags], 2 * given.slow)
        seconds = max(seconds, took)
        if code is None:
            return seconds, "", [f"hang: no end after {2 * given.slow} s"]
        if "Sanitizer" in errors or "runtime error" in errors:
            return seconds, "", [f"sanitizer: {errors[:1500]}"]
        if code != 0:
            told = f"exit {code}: {errors.strip()[-200:]}"
            if os.path.exists(out):
                return seconds, "", [f"left: exit {code} and yet a file"]
            return seconds, told, [] if code in PART_REFUSED and errors.strip() else [told]
        with open(out, "rb") as file:
            outputs.append(file.read())
    found = []
    if seconds > given.slow:
        found.append(f"slow: {seconds:.1f} s")
    if any(data != outputs[0] for data in outputs[1:]) and ending != "vdb":
        found.append("threads: other bytes with more threads")
    with open(base + ".json") as file:
        try:
            report = json.load(file, parse_constant=lambda word: 1 / 0)
        except (ValueError, ZeroDivisionError):
            return seconds, "", found + ["report: not JSON"]
    figures = report.get("lattice")
    if figures and "voxels" in figures:
        found += check_figures(figures)
    if ending == "stl":
        found += check_mesh(out, figures, box)
    if ending == "gcode":
        found += combine.check_text(outputs[0].decode("utf-8", "replace"), report, set())[0]
    return seconds, f"{ending} {len(outputs[0]) >> 10} KiB", found


# ---- a case ----


def prepare(given, case):
    table = combine.read_options(given.program)
    patterns = [w for w in table["fill_pattern"].words if "_" in w and w != "voxel_file"]
    random = numpy.random.default_rng([case, 4242])
    name, triangles, traits = model_of(random, case)
    base = os.path.join(given.keep, f"{name}-{case}")
    stl = [base + ".stl"]
    nasty.write_stl(stl[0], triangles)
    options = lattice_options(random, patterns)
    if "open" in traits and random.random() < 0.8:
        options["sheet_thickness"] = 1.2
    part = None
    if case % 3 == 2 and given.parts:
        more, words = part_options(random, options["lattice_cell"] in ("4", "8", "60", "1000"))
        part = [pick(random, ["stl", "stl", "vdb", "gcode"]), *words]
        options.update(more)
    else:
        options.update(print_options(random, table))
        if "MODIFIER" in str(options.get("modifiers", "")):
            nasty.write_stl(base + "-part.stl", nasty.box([-3, -8, 0.7], [5, 4, 3.1]))
            options["modifiers"] = options["modifiers"].replace("MODIFIER", base + "-part.stl")
    if traits & {"open", "tiny", "spoilt"}:
        traits.discard("closed")
    flat = numpy.float32(triangles).reshape(-1, 3)
    box = numpy.array([flat.min(0), flat.max(0)])
    if "open" in traits:
        box += [[-1] * 3, [1] * 3]
    return base, stl, {key: str(value) for key, value in options.items()}, part, traits, box


def check_case(given, case):
    base, stl, options, part, traits, box = prepare(given, case)
    given.base = []

    def look(chosen):
        if part:
            return examine_part(given, stl, base, chosen, part, box)
        return combine.examine(given, stl, base, chosen, traits)

    seconds, note, found = look(options)
    if found and given.minimise:
        kind = found[0].split(":")[0]
        for key in list(options):
            less = {k: v for k, v in options.items() if k != key}
            again = look(less)[2]
            if any(f.split(":")[0] == kind for f in again):
                options, found = less, again
    if found:
        words = [f"--{key.replace('_', '-')}='{value}'" for key, value in options.items()]
        verb = ["lattice", "-o", "out." + part[0], *part[1:]] if part else []
        found[0] += "\n    isoslice " + " ".join([*verb, *stl, *words])
    for path in glob.glob(base + "*"):
        if not (found and path.endswith("stl") and not path.endswith(("-1.stl", "-2.stl"))):
            os.remove(path)
    return f"{case} {os.path.basename(base)}", seconds, note, found


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("printer")
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--cases", type=int, default=10 ** 9)
    parser.add_argument("--seconds", type=float, default=math.inf, help="begin no case after these")
    parser.add_argument("--keep", help="folder for the models of cases that fail")
    parser.add_argument("--minimise", action="store_true", help="fewest options that fail alike")
    parser.add_argument("--slow", type=float, default=20,
                        help="seconds; a case that takes longer has hit a cliff")
    parser.add_argument("--threads", default="1,2")
    parser.add_argument("--no-parts", dest="parts", action="store_false",
                        help="prints only: they need no module")
    parser.add_argument("-v", "--verbose", action="store_true")
    parser.add_argument("-j", "--jobs", type=int, default=2)
    given = parser.parse_args()
    failed, done, begun = 0, 0, time.monotonic()

    with tempfile.TemporaryDirectory() as scratch, \
            concurrent.futures.ProcessPoolExecutor(given.jobs) as pool:
        given.keep = given.keep or scratch
        os.makedirs(given.keep, exist_ok=True)
        waiting, case = set(), given.first
        while True:
            while len(waiting) < 2 * given.jobs and case < given.first + given.cases and \
                    time.monotonic() - begun < given.seconds:
                waiting.add(pool.submit(check_case, given, case))
                case += 1
            if not waiting:
                break
            ready, waiting = concurrent.futures.wait(waiting, return_when="FIRST_COMPLETED")
            for job in ready:
                label, seconds, note, found = job.result()
                failed += bool(found)
                done += 1
                if given.verbose:
                    print(f"{label}: {seconds:.2f} s {note}", flush=True)
                for line in found:
                    print(f"FAILED {label}: {line}", flush=True)
    print(f"{done} cases, {failed} failed, {time.monotonic() - begun:.0f} s")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
