"""Slice nasty models with odd options and hold what comes out against what must hold of any job.

    torture.py ISOSLICE ISOPRINT [--cases N] [--first N] [--maker NAME] [--pairs] [--keep DIR] [-j N]

A case is a number: it chooses the model and the options. Checked of each: an exit code that has a
meaning, and none of a defect; no report of a sanitizer; an end in time; the same bytes for one and
five threads; a virtual printer without faults or warnings; the volume of the layers against winding
numbers along columns; the volume of filament against that of the layers.
"""
import argparse
import concurrent.futures
import json
import os
import subprocess
import sys
import tempfile
import time

import numpy

import nasty

TIMEOUT = 20  # seconds; a case that takes longer has hit a cliff
REFUSALS = {4, 5, 6}  # not sliceable, too low for a layer, options at odds
THICKEST_FLOW = "100000"  # of a nozzle nobody has: flow is what the options ask for


def choose_options(random, traits):
    pick = lambda *values: values[random.integers(len(values))]
    nozzle = float(pick(0.2, 0.4, 0.6, 0.8))
    width = float(numpy.round(random.uniform(max(0.2, nozzle * 0.8), 1.2), 3))
    height = float(numpy.round(min(random.uniform(0.05, 0.6), width * 0.9, nozzle), 3))
    if "solid" in traits:
        width, height = 0.45, float(pick(0.1, 0.2, 0.3))
    options = {
        "nozzle-diameter": nozzle, "layer-height": height,
        "first-layer-height": pick(height, round(min(height * 1.5, nozzle), 3), "100%"),
        "extrusion-width": width, "first-layer-extrusion-width": pick(width, 0, "200%"),
        "perimeters": int(pick(0, 1, 2, 3, 8)), "fill-density": f"{pick(0, 5, 15, 40, 77, 100)}%",
        "fill-pattern": pick("rectilinear", "grid"),
        "fill-angle": pick(0, 45, 90, 30, 13.7, 360), "infill-overlap": f"{pick(0, 25, 50, 100)}%",
        "gcode-resolution": pick(0, 0.0125, 0.05, 0.2), "skirts": int(pick(0, 0, 1, 3)),
        "skirt-distance": pick(0, 2, 6), "top-solid-layers": int(pick(0, 1, 3, 7)),
        "bottom-solid-layers": int(pick(0, 1, 3, 7)), "retract-length": pick(0, 0.5, 2),
        "retract-lift": pick(0, 0, 0.2, 1), "retract-before-travel": pick(0, 2, 10),
    }
    if random.random() < 0.2:
        options["external-perimeter-extrusion-width"] = pick("120%", width * 0.8)
        options["infill-extrusion-width"] = pick("150%", width * 1.3)
    if random.random() < 0.15:
        options["layer-heights"] = ",".join(
            f"{v:.3f}" for v in numpy.minimum(random.uniform(0.05, 0.6, random.integers(1, 9)),
                                              min(nozzle, width * 0.9)))
    if "solid" not in traits and random.random() < 0.6:
        options.update({
            "top-solid-min-thickness": pick(0, 0.7, 30), "bottom-solid-min-thickness": pick(0, 1, 30),
            "ensure-vertical-shell-thickness": int(pick(0, 1)), "overhangs": int(pick(0, 1)),
            "solid-infill-every-layers": int(pick(0, 1, 2, 7)),
            "solid-infill-below-area": pick(0, 5, 70, 100000), "bridge-angle": pick(0, 33, 180),
            "bridge-flow-ratio": pick(0.1, 0.8, 2), "thick-bridges": int(pick(0, 1)),
        })
    flags = [pick("--use-relative-e-distances", "--no-use-relative-e-distances"),
             pick("--external-perimeters-first", "--no-external-perimeters-first")]
    if "solid" in traits:
        options.update({"fill-density": "100%", "fill-pattern": "rectilinear", "skirts": 0,
                        "infill-overlap": "0%", "first-layer-extrusion-width": 0})
        options["first-layer-height"] = height
        options.pop("external-perimeter-extrusion-width", None)
        options.pop("infill-extrusion-width", None)
    if "huge" in traits:
        options["layer-height"] = options["first-layer-height"] = max(height, 0.2)
        options["extrusion-width"] = max(width, 0.6)
        options.pop("layer-heights", None)
        options.pop("external-perimeter-extrusion-width", None)
        options.pop("infill-extrusion-width", None)
        options["nozzle-diameter"] = max(nozzle, 0.4)
    if "tall" in traits and height < 0.2:
        options["layer-height"] = options["first-layer-height"] = 0.2
    options["bed-shape"] = "0x0,1000x0,1000x1000,0x1000"
    options["max-print-height"] = 300
    words = [f"--{key}={value}" for key, value in options.items()]
    return words + flags


def run(command):
    begun = time.monotonic()
    try:
        done = subprocess.run(command, capture_output=True, text=True, errors="replace",
                              timeout=TIMEOUT * 4)
    except subprocess.TimeoutExpired:
        return None, "", "", time.monotonic() - begun
    return done.returncode, done.stdout, done.stderr, time.monotonic() - begun


def slowest(report):
    stage = max(report["stages"], key=lambda s: s["seconds"])
    return f"{stage['name']} {stage['seconds']:.1f} s"


def check_volume(report, triangles, traits, options, random):
    layers = report["layers"]
    if "closed" not in traits or any("layer-heights" in word for word in options):
        return []
    heights = [w.split("=")[1] for w in options if w.startswith(("--first-layer-height=",
                                                                 "--layer-height="))]
    height = float(heights[0])
    first = height if heights[1].endswith("%") else float(heights[1])
    tops = first + height * numpy.arange(layers["count"])
    thick = numpy.full(layers["count"], height)
    thick[0] = first
    volume, error = nasty.layer_volume(triangles, tops - thick / 2, thick, random)
    resolution = float([w.split("=")[1] for w in options if "gcode-resolution" in w][0])
    off = abs(volume - layers["sliced_volume_mm3"])
    a, b, c = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    surface = numpy.linalg.norm(numpy.cross(b - a, c - a), axis=1).sum() / 2
    allowed = 6 * error + 0.01 * volume + resolution * surface
    if off > allowed:
        return [f"volume: the layers hold {layers['sliced_volume_mm3']:.3f} mm3, the columns "
                f"{volume:.3f} +- {error:.3f}"]
    return []


def check_filament(report, traits, options):
    if "solid" not in traits:
        return []
    ratio = 1000 * report["filament"]["cm3"] / max(report["layers"]["sliced_volume_mm3"], 1e-9)
    if not 0.9 < ratio < 1.1:
        return [f"filament: {ratio:.3f} of the volume of the layers"]
    return []


def model_of(case, maker):
    random = numpy.random.default_rng(case)
    make = nasty.MAKERS[case % len(nasty.MAKERS)] if maker is None else getattr(nasty, maker)
    triangles, traits = make(random)
    traits = set(traits)
    if "thick" in traits and random.random() < 0.8:
        traits.add("solid")
    extent = numpy.ptp(triangles.reshape(-1, 3), axis=0)
    if extent[2] > 40:
        traits.add("tall")
    return make.__name__, triangles, traits, choose_options(random, traits), random


def check_case(case, maker, program, printer, folder, pairs):
    name, triangles, traits, options, random = model_of(case, maker)
    base = os.path.join(folder, f"{name}-{case}")
    nasty.write_stl(base + ".stl", triangles)
    label = f"{case} {name} ({len(triangles)} triangles)"
    found, seconds = [], 0
    outputs = []
    code = 0
    for threads in (1, 5) if pairs else (1 + case % 2,):
        out = f"{base}-{threads}.gcode"
        command = [program, base + ".stl", "-o", out, "--report", base + ".json", "--quiet",
                   f"--threads={threads}", *options]
        code, _, errors, took = run(command)
        seconds = max(seconds, took)
        if code is None:
            found.append(f"hang: no end after {TIMEOUT * 4} s")
            break
        if took > TIMEOUT:
            with open(base + ".json") as file:
                found.append(f"slow: {took:.1f} s, of these {slowest(json.load(file))}")
        if "Sanitizer" in errors or "runtime error" in errors:
            found.append("sanitizer: " + errors[-1500:])
        if code != 0:
            if code not in REFUSALS or (code == 4 and "closed" in traits):
                found.append(f"exit {code}: {errors.strip()[-300:]}")
            break
        with open(out, "rb") as file:
            outputs.append(file.read())
    with open(base + ".txt", "w") as file:
        file.write(" ".join(["isoslice", base + ".stl", *options]) + "\n")
    note = f"exit {code}" if code else ""
    if code == 0:
        if len(outputs) == 2 and outputs[0] != outputs[1]:
            found.append("threads: other bytes for 5 threads")
        faults, text, errors, _ = run([printer, "--run", out, "--bed", "1000x1000x310",
                                       "--max-flow", THICKEST_FLOW])
        if faults != 0 or "warnings 0" not in text:
            found.append(f"printer: {faults} {errors[:300]} {text[-120:] if not errors else ''}")
        with open(base + ".json") as file:
            report = json.load(file)
        found += check_volume(report, triangles, traits, options, random)
        found += check_filament(report, traits, options)
        note = (f"{report['layers']['count']} layers, {len(outputs[0]) >> 10} KiB, "
                f"{slowest(report)}")
    elif code is not None:
        note += ": " + errors.strip()[-160:]
    if not found:
        for ending in (".stl", ".json", ".txt", "-1.gcode", "-2.gcode", "-5.gcode"):
            if os.path.exists(base + ending):
                os.remove(base + ending)
    return label, seconds, note, found


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("printer")
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--cases", type=int, default=len(nasty.MAKERS) * 2)
    parser.add_argument("--maker")
    parser.add_argument("--pairs", action="store_true", help="one and five threads for every case")
    parser.add_argument("--keep", help="folder for the models of cases that fail")
    parser.add_argument("-v", "--verbose", action="store_true")
    parser.add_argument("-j", "--jobs", type=int, default=2)
    given = parser.parse_args()
    failed = 0
    with tempfile.TemporaryDirectory() as scratch, \
            concurrent.futures.ProcessPoolExecutor(given.jobs) as pool:
        folder = given.keep or scratch
        os.makedirs(folder, exist_ok=True)
        jobs = [pool.submit(check_case, case, given.maker, given.program, given.printer, folder,
                            given.pairs)
                for case in range(given.first, given.first + given.cases)]
        for job in concurrent.futures.as_completed(jobs):
            label, seconds, note, found = job.result()
            failed += bool(found)
            if given.verbose:
                print(f"{label}: {seconds:.2f} s {note}", flush=True)
            for line in found:
                print(f"FAILED {label}: {line}", flush=True)
    print(f"{given.cases} cases, {failed} failed")
    return failed > 0


if __name__ == "__main__":
    sys.exit(main())
