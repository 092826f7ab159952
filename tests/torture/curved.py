"""Print curved layers of random fields, cut contours by them and lead channels; see combine.py.

    curved.py ISOSLICE ISOPRINT [--collide CURVED_COLLIDE] [--cases N] [--first N] [--seconds S]
              [--models DIR] [--keep DIR] [--minimise] [--threads 1,4] [--only KIND] [-j N] [-v]

A case is a number. Checked of each: an exit code with a meaning, and a message that says what to look
at; no report of a sanitizer; an end in time; no file after a failure; the same bytes for any number of
threads. Of prints also: the printer's faults, no nozzle below the bed, filament as the report has it;
of chunky solid parts as much of it as the layers hold, and as much in the layers as in the part; and
that the tool is clear of what is printed, by another program.
"""
import argparse
import concurrent.futures
import glob
import json
import math
import os
import re
import sys
import tempfile
import time

import numpy

import combine
import nasty
import porous

DOCUMENTED = {2, 3, 4, 5, 6, 7, 8}


def pick(random, values):
    return values[int(random.integers(len(values)))]


def num(value):
    return f"{value:.4g}"


# ---- fields ----


def tame_field(random, size):
    """Rises with z and isn't steep, over parts of that size."""
    u = random.uniform
    kind = int(random.integers(9))
    bend = u(-0.25, 0.25)
    if kind == 0:
        return f"cone:{num(u(-22, 22))}"
    if kind == 1:
        return f"cone:{num(u(-20, 20))},{num(u(-size, size))},{num(u(-size, size))}"
    if kind == 2:
        return f"sphere:{num(u(-3, 3))},{num(u(-3, 3))},{num(-size * u(1.5, 4))}"
    if kind == 3:
        return f"wave:{num(u(0.1, 0.6))},{num(u(10, 40))},{num(u(-180, 180))}"
    if kind == 4:
        return f"plane:{num(u(-0.3, 0.3))},{num(u(-0.3, 0.3))},1"
    if kind == 5:
        return f"z + {num(bend)}*sqrt(x^2 + y^2)"
    if kind == 6:
        return f"z + {num(bend / size)}*(x^2 + y^2)"
    if kind == 7:
        return f"cylinder:{pick(random, 'xy')},{num(u(-2, 2))},{num(-size * u(1.2, 4))}"
    return f"z + {num(bend)}*abs(x) + {num(bend / 2)}*sin(y/{num(u(2, 8))})"


def any_field(random, size):
    """Of any kind with numbers of any size; most are refused."""
    def n():
        return num(pick(random, [0, 1, -1, random.uniform(-size, size), random.uniform(-90, 90),
                                 10 ** random.uniform(-6, 6), -10 ** random.uniform(-4, 6)]))
    texts = ["plane:{},{},{}", "cone:{}", "cone:{},{},{}", "sphere:{},{},{}", "cylinder:x,{},{}",
             "cylinder:y,{},{}", "cylinder:z,{},{}", "cylinder:y", "torus:{}", "torus:{},{},{},{}",
             "wave:{},{}", "wave:{},{},{}", "fan:x,{},{},{}", "fan:y,{},{},{}", "fan:z,{},{},{}"]
    text = pick(random, texts)
    return text.format(*[n() for _ in range(text.count("{}"))])


def expression(random, size, depth=0):
    if depth > 3 or random.random() < 0.25:
        return pick(random, ["x", "y", "z", "z", "pi", num(random.uniform(-size, size)),
                             num(random.uniform(-1, 1)), "1e9", "0", "-1"])
    e = lambda: expression(random, size, depth + 1)
    kind = int(random.integers(8))
    if kind < 3:
        return f"({e()} {pick(random, '+-*/^' if kind == 0 else '+-+*')} {e()})"
    if kind == 3:
        return f"{pick(random, ['sqrt', 'exp', 'log', 'sin', 'cos', 'tan', 'asin', 'atan', 'abs', 'floor', 'round', 'ceil'])}({e()})"
    if kind == 4:
        return f"{pick(random, ['min', 'max', 'hypot', 'atan2', 'mod'])}({e()}, {e()})"
    if kind == 5:
        return f"({e()} {pick(random, ['<', '>', '==', '>='])} {e()} ? {e()} : {e()})"
    if kind == 6:
        return f"clamp({e()}, {e()}, {e()})"
    return f"ramp({e()}, {e()}, {e()}, {e()}, {e()})"


WILD = ["z + 0/0", "1/0", "sqrt(x)", "log(z)", "z + floor(x)", "mod(z, 2)", "-z", "z*0", "5", "x", "z^9",
        "exp(z*10)", "z + 1e6*x", "1e300*z", "z*1e-9", "z*1000", "tan(z)", "z + sin(x*1000)", "z > 2 ? z : z + 1",
        "z + 1e-12*sin(1/x)", "abs(z - 2)", "max(z, 3)", "min(z, 3)", "z + 3*exp(-(x^2 + y^2)/2)", "sqrt(z)",
        "x*y*z", "hypot(x, y)", "atan2(y, x)", "z + atan2(y, x)", "z - 0.999999*z", "z/(1 + z^2)", "round(z)",
        "z + x^3", "ramp(z, 1, 2, 0, 10)", "auto-top", "auto-top:", "geodesic", "distance:", "distance:/no/such.stl",
        "ball:1", "plane:0,0,0", "cone:95", "wave:1,0", "", "z", " z ", "z + 0", "2*z", "z - 5", "x + y", "((((z))))"]


def field_of(random, size, second):
    kind = random.random()
    if kind < 0.5:
        return tame_field(random, size), "tame"
    if kind < 0.58:
        return "auto-top", "tame"
    if kind < 0.63:
        return "distance:" + second, "wild"
    if kind < 0.75:
        return any_field(random, size), "wild"
    if kind < 0.85:
        return pick(random, WILD), "wild"
    if kind < 0.93:
        return "z + " + num(random.uniform(-0.3, 0.3)) + "*" + expression(random, size), "wild"
    return expression(random, size), "wild"


# ---- models ----


def chunk(random):
    size = random.uniform(8, 16)
    return nasty.box([0, 0, 0], [size, size * random.uniform(0.7, 1.2), random.uniform(5, 9)]), {"chunky"}


def drum(random):
    return nasty.cylinder(random.uniform(4, 8), 0, random.uniform(4, 9), int(random.integers(5, 48)),
                          pick(random, [1, 1, 0.7])), {"chunky"}


def ball(random):
    return nasty.sphere(random.uniform(3, 6), 16, 24), {"round"}


def ring(random):
    return nasty.torus(random.uniform(4, 8), random.uniform(0.6, 2.5), 32, 16), {"round"}


def thin(random):
    thickness = random.uniform(0.1, 1.2)
    return nasty.box([0, 0, 0], [random.uniform(4, 14), thickness, random.uniform(1, 8)]), {"thin"}


def cup(random):
    outer = random.uniform(4, 9)
    inner = outer - random.uniform(0.3, 2)
    return numpy.concatenate([nasty.cylinder(outer, 0, 8, 24),
                              nasty.inverted(nasty.cylinder(inner, 1, 7, 24))]), {"thin"}


def tube(random):
    outer = random.uniform(4, 9)
    wall = random.uniform(0.8, 2.5)
    sides = int(random.integers(8, 40))
    made = nasty.torus(10, 1, 4, sides)  # four corners of a ring, moved to be upright
    angle = numpy.arctan2(made[..., 1], made[..., 0])
    reach = numpy.hypot(made[..., 0], made[..., 1]) - 10
    turn = numpy.round((numpy.arctan2(made[..., 2], reach) - numpy.pi / 4) / (numpy.pi / 2))
    out, up = numpy.isin(turn % 4, [0, 3]), numpy.isin(turn % 4, [0, 1])
    radius = numpy.where(out, outer, outer - wall)
    height = random.uniform(4, 12)
    upright = numpy.stack([radius * numpy.cos(angle), radius * numpy.sin(angle), up * height], -1)
    return upright, {"tube"}


def mandrel(random):
    """A tube that lies along x."""
    upright, _ = tube(random)
    return upright[..., [2, 0, 1]], {"lying"}


def sheet(random):
    barrel = nasty.cylinder(random.uniform(4, 10), 0, random.uniform(2, 6), 24)
    keep = [t for t in barrel if not numpy.ptp(t[:, 2]) < 1e-9 or t[:, 2].max() < 1e-9]
    return numpy.array(keep), {"open"}


def holes(random):
    ball = nasty.sphere(random.uniform(3, 6), 10, 14)
    return numpy.delete(ball, [3, 40, 41], axis=0), {"open"}


def speck(random):
    size = 10 ** random.uniform(-4, 0.3)
    return nasty.box([0, 0, 0], [size, size, 10 ** random.uniform(-3, 0.7)]), {"tiny"}


def large(random):
    width = random.uniform(150, 300)
    return nasty.box([0, 0, 0], [width, width, random.uniform(0.3, 1.2)]), {"large"}


def apart(random):
    return numpy.concatenate(
        [nasty.moved(nasty.box([0, 0, 0], [3, 3, h]), [x, y, z]) for x, y, h, z in
         [(0, 0, 4, 0), (20, 0, 2, 3), (0, 20, 5, 0)]]), {"islands"}


MODELS = [chunk, drum, ball, chunk, ring, thin, cup, tube, mandrel, sheet, holes, speck, apart, drum,
          nasty.heap, combine.shells, nasty.nest, combine.pocket, nasty.touching, combine.islands,
          nasty.needles, nasty.crumpled, nasty.sieve, nasty.comb, large, combine.slope]


def model_of(random, case, models):
    if models and case % 13 == 12:
        path = pick(random, models)
        return os.path.basename(path), path, set()
    make = MODELS[case % len(MODELS)]
    triangles, traits = make(random)
    traits = set(traits)
    extent = numpy.ptp(triangles.reshape(-1, 3), axis=0)
    if make is not large:
        triangles = triangles * min(1.0, 22 / max(extent[:2].max(), 1e-9), 9 / max(extent[2], 1e-9))
    return make.__name__, triangles, traits


def volume_of(triangles):
    a, b, c = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    return float((a * numpy.cross(b, c)).sum() / 6)


# ---- prints ----

PRINT = {
    "field_flat_base": [0], "field_base": [0.2, 1, 3, 50], "field_blend": [0.5, 2, 5, 100, 0.001],
    "field_slope": [5, 20, 60, 89], "field_tolerance": [0.001, 0.005, 0.1, 1],
    "check_clearance": [0], "clearance_tip": [0.05, 0.4, 3], "clearance_cone": [5, 60, 85],
    "clearance_cone_height": [0.5, 2, 20], "clearance_block": ["", "-5,-5,5,5", "0,0,30,1"],
    "clearance_carriage": ["", "-50,-5,5,5"], "clearance_gantry_height": [0, 5, 8],
    "layer_height": [0.1, 0.15, 0.3, 0.35], "first_layer_height": [0.1, 0.3, "150%"],
    "min_layer_height": [0.02, 0.15], "max_layer_height": [0.25, 0.3],
    "layer_heights": ["0.3,0.2,0.1"], "perimeters": [0, 1, 2, 5],
    "fill_density": ["0%", "15%", "40%", "100%"], "infill_every_layers": [2, 3],
    "top_solid_layers": [0, 1], "bottom_solid_layers": [0, 1], "arc_fitting": ["emit_center"],
    "duplicate": [2, 3], "duplicate_grid": ["2,1"], "complete_objects": [1], "split": [1],
    "z_offset": [0.1, -0.05, 2], "use_relative_e_distances": [0, 1], "use_volumetric_e": [1],
    "spiral_vase": [1], "adaptive_layers": [1], "fuzzy_skin": ["all", "external"], "ironing": [1],
    "brim_width": [2, 4], "skirts": [0, 2], "draft_shield": ["enabled"], "skirt_height": [3],
    "retract_lift": [0.3, 1], "wipe": [1], "avoid_crossing_perimeters": [1], "seam_position": ["rear", "random"],
    "xy_size_compensation": [-0.2, 0.2], "elefant_foot_compensation": [0.2], "cut": [1.5], "rotate": [30],
    "rotate_x": [90, 20], "scale": [0.5, 1.5], "nozzle_diameter": [0.6, 0.8], "extrusion_width": [0.5],
    "gcode_resolution": [0, 0.1], "solid_infill_every_layers": [3], "thin_walls": [0], "gap_fill_enabled": [0],
    "external_perimeters_first": [1], "infill_first": [1], "ensure_vertical_shell_thickness": [1],
    "only_one_perimeter_top": [1], "thick_bridges": [0], "use_firmware_retraction": [1], "gcode_comments": [1],
    "gcode_label_objects": ["octoprint", "firmware"], "events": ["2:color", "1:pause"],
    "center": ["60,70", "5,5"], "colorprint_heights": ["0.5,2"], "sheet_thickness": [1.2, 0.4],
    "lattice_map": ["cylinder", "sphere", "skin"], "lattice_cell": ["3", "ramp(z, 0, 6, 2, 5)"],
    "lattice_material": ["50"], "arrange": [1], "max_print_height": [4],
    "modifiers": ["MODIFIER fill_density=50% fill_angle=10", "MODIFIER fill_pattern=gyroid_sheet",
                  "MODIFIER fill_density=100%;MODIFIER fill_density=0%"],
}
REFUSED = {"adaptive_layers", "spiral_vase", "max_print_height", "center", "field_slope"}
MACHINES = {
    "kinematics_pivot": ["100,100,0", "100,100,-50", "0,0,0", "100,100,5"], "tilt_limits": ["-30,30", "0,90", "-5,5"],
    "turn_limits": ["-180,180", "-720,720", "0,90"], "tilt_speed": [5, 0.01], "turn_speed": [20, 10000],
    "rotary_feed": ["inverse_time"], "gcode_flavor": ["reprapfirmware", "klipper", "machinekit", "marlin"],
}
KINEMATICS = ["rotary_a", "rotary_b", "table_ac", "table_bc"]


def print_options(random, table, traits, steep):
    chosen = {}
    many = pick(random, [0.02, 0.06, 0.15])
    for key, values in PRINT.items():
        if key in table and random.random() < many * (0.1 if key in REFUSED else 1):
            chosen[key] = pick(random, values)
    if random.random() < 0.25:
        chosen["fill_pattern"] = pick(random, [w for w in table["fill_pattern"].words if w != "voxel_file"])
    if random.random() < 0.2 or "lying" in traits:
        chosen["kinematics"] = "rotary_a" if "lying" in traits else pick(random, KINEMATICS)
        for key, values in MACHINES.items():
            if random.random() < 0.12:
                chosen[key] = pick(random, values)
    if random.random() < 0.3 and not steep:
        chosen.update(fill_density="100%", skirts=0)
        chosen["perimeters"] = pick(random, [1, 2, 3])
    return chosen


PLAIN_SOLID = {"field", "field_flat_base", "field_base", "field_blend", "field_slope", "field_tolerance",
               "check_clearance", "clearance_tip", "clearance_cone", "clearance_cone_height", "clearance_block",
               "clearance_carriage", "clearance_gantry_height", "layer_height", "perimeters", "fill_density",
               "infill_every_layers", "duplicate", "duplicate_grid", "complete_objects", "z_offset", "split",
               "use_relative_e_distances", "skirts", "retract_lift", "wipe", "avoid_crossing_perimeters",
               "seam_position", "rotate", "infill_first", "external_perimeters_first", "gcode_comments", "center",
               "use_firmware_retraction", "gcode_label_objects", "kinematics", "kinematics_pivot", "tilt_speed",
               "turn_speed", "rotary_feed", "colorprint_heights", "top_solid_layers", "bottom_solid_layers",
               "use_volumetric_e"}


class Trace:
    """Least Z while lines are drawn or the nozzle travels, and filament in all."""

    def __init__(self, text):
        s = self.settings = combine.settings_of(text)
        letter = "A" if s["gcode_flavor"] in combine.AXIS_A else "E"
        relative = s["use_relative_e_distances"] == "1"
        self.area = 1.0 if s["use_volumetric_e"] == "1" else math.pi / 4 * float(s["filament_diameter"]) ** 2
        self.least, self.filament, self.bad = math.inf, 0.0, None
        e, begun, role = 0.0, False, ""
        for line in text.splitlines():
            if line.startswith(";"):
                if line.startswith(";TYPE:"):
                    role = line[6:]
                begun = begun or line.startswith(";Z:") or line.startswith(";LAYER_CHANGE")
                continue
            code = line.split(";", 1)[0]
            if not code.startswith("G"):
                continue
            if re.search(r"nan|inf", code, re.I):
                self.bad = line
            value = {k: float(v) for k, v in combine.WORD.findall(code)}
            command = int(value["G"])
            if command == 92:
                e = value.get(letter, e)
            if command > 3:
                continue
            if begun and "Z" in value and role != "Custom":
                self.least = min(self.least, value["Z"])
            if letter in value:
                delta = value[letter] if relative else value[letter] - e
                e = value[letter]
                if begun and role != "Custom":
                    self.filament += delta


def refusal(code, errors, allowed):
    """Whether it is one: of a documented code, with words in it."""
    if code not in allowed:
        return [f"exit {code}: {errors.strip()[-400:]}"]
    words = errors.strip()
    if len(words) < 15:
        return [f"message: exit {code}: {words!r}"]
    if re.search(r"\bnan\b|\binf\b|-?1\.79769e|%[a-z]", words):
        return [f"message: exit {code}: {words[-300:]}"]
    return []


def run_twice(given, base, ending, command):
    """Outputs by number of threads: (seconds, note, outputs, found)."""
    outputs, seconds = [], 0
    for threads in given.threads.split(","):
        out = f"{base}-{threads}.{ending}"
        if os.path.exists(out):
            os.remove(out)
        code, _, errors, took = combine.run(command(out, threads), 2 * given.slow)
        seconds = max(seconds, took)
        if code is None:
            return seconds, "", [], [f"hang: no end after {2 * given.slow} s"]
        if "Sanitizer" in errors or "runtime error" in errors:
            return seconds, "", [], [f"sanitizer: {errors[:2500]}"]
        if code != 0:
            found = refusal(code, errors, DOCUMENTED)
            if os.path.exists(out) or glob.glob(out + "*"):
                found.append(f"left: exit {code} and yet a file")
            if outputs:
                found.append(f"threads: exit {code} with {threads} threads: {errors[-200:]}")
            return seconds, f"exit {code}: {errors.strip()[-200:]}", [], found
        with open(out, "rb") as file:
            outputs.append(file.read())
    found = [f"slow: {seconds:.1f} s"] if seconds > given.slow else []
    if any(data != outputs[0] for data in outputs):
        found.append("threads: other bytes with more threads")
    return seconds, "", outputs, found


def judge_print(given, base, out, text, options, traits, mesh_volume, stl):
    with open(base + ".json") as file:
        try:
            report = json.load(file, parse_constant=lambda word: 1 / 0)
        except (ValueError, ZeroDivisionError):
            return "", ["report: not JSON"]
    found, trace = [], Trace(text)
    s = trace.settings
    if trace.bad:
        found.append(f"nan: {trace.bad}")
    straight = s["kinematics"] == "cartesian"
    if straight and trace.least < float(s["z_offset"]) - 0.01:
        found.append(f"bed: Z goes to {trace.least}")
    sliced = report["layers"]["sliced_volume_mm3"]
    said, done = 1000 * report["filament"]["cm3"], trace.filament * trace.area
    if abs(said - done) > 0.005 * said + 30:
        found.append(f"filament: the report says {said:.2f} mm3, E {done:.2f} mm3")
    note = f"{report['layers']['count']} layers, {len(text) >> 10} KiB"
    if "solid" in traits:
        ratio = (said - sliced) / max(sliced, 1e-9)
        note += f", solid {100 * ratio:+.2f} %"
        # Beads are round at corners, flat layers' too: of parts as small as these that is up to 2 %.
        if abs(said - sliced) > 0.025 * sliced + 1.0:
            found.append(f"solid: {said:.2f} mm3 of filament, {sliced:.2f} mm3 of layers")
    if mesh_volume:
        note += f", part {100 * (sliced / mesh_volume - 1):+.2f} %"
        # A layer is as thick as it is over all of its middle, where a flat top may have cut it in two.
        box = numpy.ptp(porous.read_stl(stl[0]).reshape(-1, 3), axis=0)
        cut = 0.5 * float(s["layer_height"]) * box[0] * box[1]
        if abs(sliced - mesh_volume) > 0.005 * mesh_volume + cut:
            found.append(f"part: {sliced:.2f} mm3 of layers, {mesh_volume:.2f} mm3 of part")
    if s["gcode_flavor"] in combine.MARLINS:
        command = combine.printer_command(given.printer, out, s)
        if not straight:
            command = [given.printer, "--run", out, "--bed=4000x4000x4000", "--origin=-2000,-2000,-2000",
                       "--filament", s["filament_diameter"], "--max-nozzle", "300", "--max-flow", "100000"]
        faults, _, errors, _ = combine.run(command)
        faulty = [line for line in errors.splitlines() if " fault " in line]
        if faulty or faults not in (0, 8):
            found.append(f"printer: {faults} {(faulty or [errors])[:3]}")
    return note, found


def collides(given, out, text, options, stl):
    """By brute force, what the engine found clear."""
    s = combine.settings_of(text)
    command = [given.collide, out, stl[0], "--tip", s["clearance_tip"], "--cone", s["clearance_cone"],
               "--cone-height", s["clearance_cone_height"], "--gantry", s["clearance_gantry_height"],
               "--carriage-height", s["clearance_carriage_height"]]
    for key in ("block", "carriage"):
        if s["clearance_" + key]:
            command += ["--" + key, s["clearance_" + key]]
    code, said, errors, _ = combine.run(command, 6)
    if code == 1:
        return [f"collide: {said[-600:]}"]
    return [f"collide: exit {code} {errors[-300:]}"] if code not in (0, None) else []


def examine_print(given, stl, base, options, traits, mesh_volume):
    words = [f"--{key.replace('_', '-')}={value}" for key, value in options.items()]
    seconds, note, outputs, found = run_twice(
        given, base, "gcode", lambda out, threads: [given.program, "slice", *stl, "-o", out, "--quiet", "--report",
                                                    base + ".json", f"--threads={threads}", *words])
    if not outputs:
        return seconds, note, found
    if options.get("spiral_vase") == "1" and re.match("(sphere|wave|cylinder|torus|fan):", options["field"]):
        found.append("spiral: not refused")
    text = outputs[0].decode("utf-8", "replace")
    out = f"{base}-{given.threads.split(',')[0]}.gcode"
    traits = set(traits)
    if set(options) <= PLAIN_SOLID and options.get("fill_density") == "100%" and \
            int(options.get("perimeters", 3)) > 0 and traits & {"chunky"}:
        traits.add("solid")
    whole = mesh_volume if "chunky" in traits and set(options) <= PLAIN_SOLID and \
        not {"duplicate", "duplicate_grid"} & set(options) else 0
    note, more = judge_print(given, base, out, text, options, traits, whole, stl)
    if given.collide and given.case % 5 == 0 and "check_clearance" not in options and len(text) < 2e6 and \
            "kinematics" not in options and not {"complete_objects", "z_offset", "center"} & set(options) and \
            options["field"] not in ("", "z"):
        more += collides(given, out, text, options, stl)
    return seconds, note, found + more


# ---- contours and channels ----


def examine_contours(given, stl, base, options, ending):
    words = [f"--{key.replace('_', '-')}={value}" for key, value in options.items()]
    seconds, note, outputs, found = run_twice(
        given, base, ending,
        lambda out, _: [given.program, "contours", *stl, "-o", out, "--quiet", *words])
    if outputs and ending == "json":
        try:
            made = json.loads(outputs[0], parse_constant=lambda word: 1 / 0)
            note = f"{len(made['levels'])} levels"
            if not all(math.isfinite(v) for level in made["levels"] for ring in level["contours"]
                       for point in ring for v in point):
                found.append("contours: a place that is no number")
        except (ValueError, ZeroDivisionError, KeyError) as error:
            found.append(f"contours: {error!r}")
    if outputs and re.search(rb"\bnan\b|\binf\b", outputs[0][:10 ** 6]) and ending != "mlk":
        found.append("contours: nan in it")
    return seconds, note or f"{len(outputs[0]) >> 10 if outputs else 0} KiB", found


def contour_options(random):
    chosen = {}
    for key, values in {"layer_height": [0.1, 0.3, 1, 5], "rotate_x": [30], "cut": [1], "view": ["30,20", "-200,95", "a"],
                        "sheet_thickness": [1], "duplicate": [2], "scale": [0.1, 3], "split": [1]}.items():
        if random.random() < 0.15:
            chosen[key] = pick(random, values)
    return chosen


def channel_options(random):
    chosen = {"pitch": pick(random, [2, 3, 5, 8, num(10 ** random.uniform(-1, 3))]),
              "depth": pick(random, [2, 3, 5, num(10 ** random.uniform(-1, 2))]),
              "section": pick(random, ["round:1", "round:2", "square:1.5", "rect:2x1", "oval:1x2", "polygon:5:2",
                                       f"round:{num(10 ** random.uniform(-1, 2))}", "round:0", "polygon:2:1", "ball:1"][
                                           :7 if random.random() < 0.95 else 10])}
    more = {"mode": ["planar", "pointwise", "geodesic"], "ports": ["none", "parallel", "series"], "start": [0, 1, 50],
            "side": ["front", "back", "left", "right"], "margin": [0, 5, 20, 1000], "wall": [0, 0.1, 0.5, 10],
            "bend": [0, 0.5, 3, 100], "levels": [2, 20, 81, 500], "samples": [8, 100, 1000], "sides": [3, 6, 256]}
    for key, values in more.items():
        if random.random() < (0.6 if key in ("mode", "ports", "wall") else 0.2):
            chosen[key] = pick(random, values)
    if random.random() < 0.2:
        chosen["holes"] = None
    return chosen


def examine_channels(given, stl, base, options, ending):
    words = [f"--{key}" + ("" if value is None else f"={value}") for key, value in options.items()]
    seconds, note, outputs, found = run_twice(given, base, ending, lambda out, _: [
        given.program, "channels", stl[0], "-o", out, "--quiet", "--report", base + ".json", *words])
    if outputs and ending == "stl":
        corner = porous.read_stl(f"{base}-{given.threads.split(',')[0]}.stl")
        if corner is None or not numpy.isfinite(corner).all():
            found.append("channels: a mesh that isn't one")
    return seconds, note or f"{ending} {len(outputs[0]) >> 10 if outputs else 0} KiB", found


# ---- a case ----


def prepare(given, case):
    random = numpy.random.default_rng([case, 9091])
    models = sorted(glob.glob(os.path.join(given.models, "*.stl"))) if given.models else []
    name, model, traits = model_of(random, case, models)
    base = os.path.join(given.keep, f"{name}-{case}")
    stl, size, mesh_volume = [base + ".stl"], 10, 0
    if isinstance(model, str):
        stl = [model]
    else:
        nasty.write_stl(stl[0], model)
        size = float(numpy.ptp(model.reshape(-1, 3), axis=0).max())
        mesh_volume = volume_of(numpy.float64(numpy.float32(model)))
    kind = given.only or pick(random, ["print"] * 4 + ["solid", "contours", "channels"])
    if kind == "solid":
        model, traits = pick(random, [chunk, drum])(random)
        stl = [base + ".stl"]
        nasty.write_stl(base + ".stl", model)
        size = float(numpy.ptp(model.reshape(-1, 3), axis=0).max())
        mesh_volume = volume_of(numpy.float64(numpy.float32(model)))
    second = base + "-second.stl"
    nasty.write_stl(second, nasty.moved(nasty.sphere(size, 12, 16), [0, 0, -size * random.uniform(0.6, 2)]))
    field, steep = field_of(random, max(size, 0.1), second)
    if kind == "solid":
        field, steep = tame_field(random, size), "tame"
    if kind in ("print", "solid"):
        options = {"field": field, **print_options(random, combine.read_options(given.program), traits, steep == "wild")}
        if kind == "solid":
            options = {k: v for k, v in options.items() if k in PLAIN_SOLID and k not in MACHINES}
            options.update(fill_density="100%", perimeters=pick(random, [1, 2, 3]), skirts=0)
            options.pop("kinematics", None)
        if options.get("kinematics") == "rotary_a" and "lying" in traits and random.random() < 0.8:
            half = numpy.ptp(model.reshape(-1, 3), axis=0)[2] / 2
            options["field"] = f"cylinder:x,0,{half:.4f}"
        if "open" in traits and random.random() < 0.7:
            options["sheet_thickness"] = 1.2
        if case % 11 == 4 and kind == "print":
            stl.append(base + "-other.stl")
            nasty.write_stl(stl[1], nasty.moved(nasty.box([0, 0, 0], [5, 6, 3]), [2 * size + 8, 0, 0]))
            traits = set()
        if "MODIFIER" in str(options.get("modifiers", "")):
            nasty.write_stl(base + "-part.stl", nasty.box([-3, -8, 0.7], [5, 4, 3.1]))
            options["modifiers"] = options["modifiers"].replace("MODIFIER", base + "-part.stl")
        look = lambda chosen: examine_print(given, stl, base, chosen, traits, mesh_volume if steep == "tame" else 0)
        verb = ["slice"]
    elif kind == "contours":
        options = {"field": pick(random, [field, field, "geodesic"]), **contour_options(random)}
        ending = pick(random, ["json", "svg", "mlk"])
        look = lambda chosen: examine_contours(given, stl, base, chosen, ending)
        verb = ["contours", "-o", "out." + ending]
    else:
        options = channel_options(random)
        ending = pick(random, ["stl", "svg", "mlk"])
        look = lambda chosen: examine_channels(given, stl, base, chosen, ending)
        verb = ["channels", "-o", "out." + ending]
    options = {k: None if v is None else str(v) for k, v in options.items()}
    return base, stl, verb, options, look


def check_case(given, case):
    given.case = case
    base, stl, verb, options, look = prepare(given, case)
    seconds, note, found = look(options)
    if found and given.minimise:
        kind = found[0].split(":")[0]
        for key in list(options):
            less = {k: v for k, v in options.items() if k != key}
            if key == "field" or (verb[0] == "channels" and key in ("pitch", "depth", "section")):
                continue
            again = look(less)[2]
            if any(f.split(":")[0] == kind for f in again):
                options, found = less, again
    if found:
        words = [f"--{key.replace('_', '-')}" + ("" if value is None else f"='{value}'")
                 for key, value in options.items()]
        found[0] += "\n    isoslice " + " ".join([*verb, *stl, *words])
    for path in glob.glob(base + "*"):
        if not (found and path.endswith(".stl") and not path.endswith(("-1.stl", "-2.stl", "-4.stl"))):
            os.remove(path)
    return f"{case} {os.path.basename(base)} {verb[0]} {options.get('field', '')}", seconds, note, found


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("printer")
    parser.add_argument("--collide", help="the program that looks for collisions by brute force")
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--cases", type=int, default=10 ** 9)
    parser.add_argument("--seconds", type=float, default=math.inf, help="begin no case after these")
    parser.add_argument("--models", help="folder of STL files, for every thirteenth case")
    parser.add_argument("--keep", help="folder for the models of cases that fail")
    parser.add_argument("--minimise", action="store_true", help="fewest options that fail alike")
    parser.add_argument("--only", choices=["print", "solid", "contours", "channels"])
    parser.add_argument("--slow", type=float, default=20,
                        help="seconds; a case that takes longer has hit a cliff")
    parser.add_argument("--threads", default="1,4")
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
