"""Slice with many options at once and hold what comes out against what must hold of any print.

    combine.py ISOSLICE ISOPRINT [--cases N] [--first N] [--seconds S] [--models DIR]
               [--profiles DIR] [--keep DIR] [--minimise] [--threads 1,2,4] [-j N] [-v]

A case is a number: it chooses the model and the options, of which every kind and range comes from
`isoslice --list-options`. Checked of each: an exit code that has a meaning, and none of a defect; no
report of a sanitizer; an end in time; the same bytes for any number of threads and from the block of
settings at the end; a virtual printer without faults; and of the G-code by itself: numbers that are
numbers, moves inside the printer, layers that rise, the skirt first, beads as thick as they may be,
and filament as the report has it and, of solid prints, as the model has it.
"""
import argparse
import concurrent.futures
import glob
import json
import math
import os
import re
import resource
import signal
import subprocess
import sys
import tempfile
import time

import numpy

import nasty

LATTICE = re.compile(r"_(sheet|solid|struts|cubic|random|file)\b")
REFUSALS = {4, 5, 6}  # not sliceable, beyond the printer, options at odds
HOME = "G28\\nG1 Z5 F1200"

# What people set, where default and range alone don't tell. Numbers in lists are drawn as they are,
# in tuples from low to high.
SENSIBLE = {
    "inches": [0] * 9 + [1], "scale": [1, "50%", 1.3, 0.8], "scale_to_fit": ["", "30,30,30", "60,10,25"],
    "rotate": (-360, 360), "rotate_x": [0, 90, 180, 37.5], "rotate_y": [0, 90, 180, -12.5],
    "cut": [0, 1, 2.5, 4], "duplicate": [1, 2, 3, 5], "duplicate_grid": ["", "2,1", "2,2", "1,3"],
    "duplicate_distance": [6, 0, 1.5, 20], "extruder_clearance_radius": [5, 20, 1],
    "extruder_clearance_height": [20, 100, 5],
    "layer_height": [0.1, 0.15, 0.2, 0.25, 0.3], "first_layer_height": [0.2, 0.35, "100%", "150%"],
    "layer_heights": ["", "0.3,0.2,0.1", "0.1,0.3", "0.2,0.2,0.2,0.1,0.1,0.3"],
    "cusp_height": (0.01, 0.2), "min_layer_height": [0.07, 0.1, 0.05],
    "max_layer_height": [0, 0.25, 0.3], "gcode_resolution": [0, 0.0125, 0.05, 0.2],
    "z_offset": [0, 0.1, -0.1, 2], "xy_size_compensation": (-0.4, 0.4),
    "xy_hole_compensation": (-0.4, 0.4), "elefant_foot_compensation": (0, 0.5),
    "perimeters": [0, 1, 2, 3, 4, 8], "fuzzy_skin_thickness": [0.1, 0.3, 1],
    "fuzzy_skin_point_dist": [0.8, 0.2, 3], "fill_density": ["0%", "5%", "15%", "40%", "80%", "100%"],
    "fill_angle": (0, 360), "infill_overlap": ["0%", "25%", "50%", 0.1], "infill_anchor": ["600%", 0, 2],
    "infill_anchor_max": [50, 0, "300%"], "infill_every_layers": [1, 2, 3],
    "top_solid_layers": [0, 1, 3, 5], "bottom_solid_layers": [0, 1, 3, 5],
    "top_solid_min_thickness": [0, 0.7, 2], "bottom_solid_min_thickness": [0, 0.7, 2],
    "solid_infill_every_layers": [0, 1, 4], "solid_infill_below_area": [0, 70, 500],
    "bridge_angle": (0, 180), "bridge_flow_ratio": (0.5, 1.5), "ironing_flowrate": (5, 40),
    "ironing_spacing": [0.1, 0.3], "skirts": [0, 1, 3], "skirt_distance": [0, 2, 6],
    "skirt_height": [1, 2, 10], "min_skirt_length": [0, 4, 30], "brim_width": [0, 1, 4, 8],
    "brim_separation": [0, 0.1, 1],
    "extrusion_width": [0, 0.45, 0.6], "first_layer_extrusion_width": ["200%", 0, 0.5],
    "perimeter_extrusion_width": [0, 0.45, 0.5], "external_perimeter_extrusion_width": [0, 0.4, 0.5],
    "infill_extrusion_width": [0, 0.4, 0.7], "solid_infill_extrusion_width": [0, 0.42, 0.6],
    "top_infill_extrusion_width": [0, 0.35, 0.5], "filament_diameter": [1.75, 2.85],
    "filament_density": [0, 1.24], "filament_cost": [0, 25], "extrusion_multiplier": (0.8, 1.2),
    "filament_max_volumetric_speed": [0, 8], "max_volumetric_speed": [0, 5, 15],
    "temperature": [200, 240], "first_layer_temperature": [200, 215, 250],
    "bed_temperature": [0, 60], "first_layer_bed_temperature": [0, 65],
    "retract_length": [0, 0.5, 2, 5], "retract_restart_extra": [0, 0.05, -0.05],
    "retract_before_travel": [0, 2, 10], "retract_lift": [0, 0.2, 1], "retract_lift_above": [0, 1],
    "retract_lift_below": [0, 3], "retract_before_wipe": ["0%", "50%", "100%"],
    "avoid_crossing_perimeters_max_detour": [0, 10, "200%"],
    "slowdown_below_layer_time": [0, 5, 30], "fan_below_layer_time": [0, 15, 60],
    "min_fan_speed": [0, 20, 35], "max_fan_speed": [100, 60], "bridge_fan_speed": [100, 0, 70],
    "disable_fan_first_layers": [0, 1, 3], "full_fan_speed_layer": [0, 4, 8],
    "nozzle_diameter": [0.4, 0.4, 0.6, 0.8], "max_print_height": [200],
    "bed_shape": ["0x0,200x0,200x200,0x200", "-100x-100,100x-100,100x100,-100x100",
                  "0x0,300x0,300x250,0x250", "100x0,200x100,100x200,0x100"],
    "center": ["", "60,70", "100,100"],
    "start_gcode": [HOME, HOME + "\\nM117 layer [layer_height]",
                    HOME + "\\n{if perimeters > 2}M117 thick{else}M117 thin{endif}"],
    "end_gcode": ["M104 S0\\nM140 S0\\nM107\\nM84", "M107\\nM104 S0\\nM140 S0\\nG1 X0 Y10"],
    "layer_gcode": ["", "; at [layer_num] [layer_z]", "M117 {layer_num+1}"],
    "before_layer_gcode": ["", "; before [layer_num]"],
    "start_filament_gcode": ["", "M117 filament"], "end_filament_gcode": ["", "M117 bye"],
    "between_objects_gcode": ["", "M117 next"], "colorprint_heights": ["", "1.5", "0.5,2,100"],
    "events": ["", "2:color", "1:pause;1.01:template", "0.9:M117 here"],
    "color_change_gcode": ["M600"], "pause_print_gcode": ["M0 S1", "M601"],
    "template_custom_gcode": ["", "M117 templ"],
    "modifiers": ["", "MODIFIER fill_density=50% fill_angle=10", "MODIFIER fill_pattern=gyroid",
                  "MODIFIER fill_density=100%;MODIFIER fill_density=0%"],
    "travel_speed_z": [0, 10], "max_print_speed": [80, 150],
}

# What is worth turning often, since it changes the way of the whole print.
FREQUENT = ["layer_height", "perimeters", "fill_density", "fill_pattern", "top_fill_pattern",
            "bottom_fill_pattern", "seam_position", "brim_width", "brim_type", "skirts", "fuzzy_skin",
            "ironing", "arc_fitting", "wipe", "duplicate", "complete_objects", "adaptive_layers",
            "infill_every_layers", "gcode_flavor", "xy_size_compensation", "retract_lift",
            "avoid_crossing_perimeters", "extrusion_width", "nozzle_diameter", "cut", "split",
            "use_relative_e_distances", "thick_bridges", "overhangs", "ensure_vertical_shell_thickness"]

# Of no effect on how much is printed where the model is.
HARMLESS = ["external_perimeters_first", "seam_position", "top_fill_pattern", "bottom_fill_pattern",
            "fill_angle", "infill_first", "perimeters", "perimeter_speed", "infill_speed",
            "solid_infill_speed", "travel_speed", "max_volumetric_speed", "retract_length",
            "retract_lift", "retract_before_travel", "retract_layer_change", "wipe",
            "only_retract_when_crossing_perimeters", "avoid_crossing_perimeters",
            "use_firmware_retraction", "cooling", "slowdown_below_layer_time", "fan_always_on",
            "default_acceleration", "infill_acceleration", "use_relative_e_distances",
            "gcode_comments", "gcode_label_objects", "arc_fitting", "remaining_times", "center",
            "layer_height", "first_layer_height", "rotate", "mirror", "duplicate", "layer_heights",
            "adaptive_layers", "filament_diameter", "extrusion_width", "perimeter_extrusion_width",
            "external_perimeter_extrusion_width", "solid_infill_extrusion_width", "nozzle_diameter"]

SOLID_PATTERNS = ["rectilinear", "monotonic", "monotoniclines", "alignedrectilinear"]
MARLINS = {"marlin2", "marlin", "reprap", "repetier", "smoothie", "klipper"}


# ---- options ----


class Option:
    def __init__(self, line):
        key = max(34, line.index(" "))
        part = [line[:key], line[key + 2:key + 26], line[key + 28:key + 37], line[key + 39:]]
        self.key, self.initial, unit = (p.strip() for p in part[:3])
        self.percent = unit.endswith("%")
        text = part[3]
        bounds = re.match(r"(\S+) (to|or) (\S+)\s", text)
        self.low = self.high = None
        self.words = []
        if bounds:
            self.low, self.high = float(bounds[1]), float(bounds[3])
        self.switch = bool(bounds) and bounds[2] == "or"
        if not bounds:
            words = re.match(r"((?:[\w-]+, )+[\w-]+) {1,}", text)
            self.words = words[1].split(", ") if words else []
        self.whole = bool(bounds) and not self.switch and re.fullmatch(r"-?\d+", self.initial) \
            and "." not in self.initial

    def draw(self, random, wild):
        pick = lambda values: values[random.integers(len(values))]
        if self.switch:
            return pick(SENSIBLE.get(self.key, [0, 1]))
        if self.words:
            return pick(self.words)
        if wild and self.low is not None and self.initial:
            bound = pick([self.low, self.high])
            if random.random() < 0.5 and self.high > 0:
                low = max(self.low, self.high * 1e-6)
                bound = math.exp(random.uniform(math.log(low), math.log(self.high)))
            return number(bound, self.whole)
        if self.key in SENSIBLE:
            value = SENSIBLE[self.key]
            if isinstance(value, tuple):
                return number(random.uniform(*value), self.whole)
            return pick(value)
        if self.low is None or not self.initial:
            return None
        start = float(self.initial.rstrip("%")) or self.high ** 0.5
        value = min(max(start * random.uniform(0, 2.5), self.low), self.high)
        return number(value, self.whole)


def number(value, whole):
    return int(round(value)) if whole else float(f"{value:.4g}")


# Without a field they do nothing; with one, curved.py throws them.
OF_CURVED_LAYERS = re.compile("field|check_clearance|clearance_|kinematics|tilt_|turn_|rotary_")


def read_options(program):
    text = subprocess.run([program, "--list-options"], capture_output=True, text=True,
                          check=True).stdout
    lines = [line for line in text.splitlines()[1:] if re.match(r"[a-z_0-9]+ {2}", line)]
    return {option.key: option for option in map(Option, lines)
            if not OF_CURVED_LAYERS.match(option.key)}


# Extremes of these say nothing but that much work takes long.
TAME = {"scale", "inches", "duplicate", "duplicate_grid", "layer_heights", "bed_shape", "center",
        "z_offset", "max_print_height", "perimeters", "layer_height", "ironing_spacing", "skirts",
        "fuzzy_skin_point_dist", "cut", "rotate_x", "rotate_y", "scale_to_fit", "brim_width",
        "min_layer_height", "cusp_height", "nozzle_diameter", "temperature", "min_skirt_length",
        "first_layer_temperature", "bed_temperature", "first_layer_bed_temperature"}


def choose(random, table, traits):
    keys = sorted(table)
    solid = "solid" in traits
    chosen = {}
    if solid:
        keys = [k for k in HARMLESS if k in table]
    count = int(random.choice([1, 3, 8, 20, 60]))
    for _ in range(min(count, len(keys))):
        often = [k for k in FREQUENT if k in keys]
        pool = often if often and random.random() < 0.4 else keys
        chosen[pool[random.integers(len(pool))]] = None
    wild = set()
    if not solid and random.random() < 0.4:
        wild = {keys[random.integers(len(keys))] for _ in range(random.integers(1, 4))} - TAME
        chosen.update(dict.fromkeys(wild))
    drawn = {key: table[key].draw(random, key in wild) for key in sorted(chosen)}
    if not solid and random.random() < 0.06:
        drawn["spiral_vase"] = 1
    drawn = {key: value for key, value in drawn.items() if value is not None}
    agree(drawn, table, random, solid)
    return {key: str(value) for key, value in drawn.items()}


def agree(drawn, table, random, solid):
    """Most sets of options that are drawn one by one are at odds and would be refused."""
    if random.random() < 0.03 and not solid:
        return
    get = lambda key: drawn.get(key, table[key].initial)
    if int(get("spiral_vase")):
        drawn.update(perimeters=1, fill_density="0%", top_solid_layers=0)
        for key in ("duplicate", "duplicate_grid", "split", "arrange"):
            drawn.pop(key, None)
    nozzle = float(get("nozzle_diameter"))
    if nozzle < 0.3:
        drawn["layer_height"], drawn["first_layer_height"] = nozzle / 2, "100%"
    if float(get("min_fan_speed")) > float(get("max_fan_speed")):
        drawn.pop("min_fan_speed", None)
        drawn.pop("max_fan_speed", None)
    if 0 < float(get("max_layer_height")) < float(get("min_layer_height")):
        drawn.pop("max_layer_height", None)
        drawn.pop("min_layer_height", None)
    if get("gcode_flavor") in ("mach3", "machinekit", "sailfish", "makerware", "no-extrusion",
                               "teacup") and get("gcode_label_objects") == "firmware":
        drawn.pop("gcode_label_objects", None)
    if get("gcode_label_objects") == "firmware" and get("gcode_flavor") not in (
            "marlin2", "marlin", "klipper", "reprapfirmware"):
        drawn["gcode_label_objects"] = "octoprint"
    for key in [k for k in drawn if k.endswith("extrusion_width")]:
        width = drawn[key]
        if not str(width).endswith("%") and 0 < float(width) < nozzle * 0.8:
            drawn[key] = nozzle
    if solid:
        drawn["fill_density"], drawn["fill_pattern"] = "100%", "rectilinear"
        drawn["skirts"] = 0
        drawn["first_layer_extrusion_width"] = 0
        for key in ("top_fill_pattern", "bottom_fill_pattern"):
            if key in drawn and drawn[key] not in SOLID_PATTERNS:
                drawn[key] = "rectilinear"


# ---- models ----


def shells(random):
    """Bridges, overhangs, pockets: what makes roles of all sorts."""
    size = random.uniform(10, 24)
    made = [nasty.box([0, 0, 0], [size, 2.5, 6]), nasty.box([0, size, 0], [size, size + 2.5, 6]),
            nasty.box([0, 0, 5], [size, size + 2.5, 7])]
    if random.random() < 0.5:
        made.append(nasty.moved(nasty.cylinder(size / 5, 0, 9, 24, 0.4), [size / 2, size / 2, 7]))
    return numpy.concatenate(made), {"closed"}


def pocket(random):
    """A block with a round hole and a slot."""
    size = random.uniform(10, 20)
    outer = nasty.circle(size, int(random.integers(3, 60)))
    body = nasty.prism(outer, 0, 4)
    hole = nasty.inverted(nasty.cylinder(size * random.uniform(0.1, 0.4), 1, 3, 32))
    return numpy.concatenate([body, hole]), {"closed"}


def slope(random):
    return nasty.cylinder(random.uniform(6, 18), 0, random.uniform(2, 12),
                          int(random.integers(3, 60)), random.choice([0, 0.3, 0.8, 1.6])), {"closed"}


def islands(random):
    count = int(random.integers(2, 7))
    made = [nasty.moved(nasty.cylinder(random.uniform(1, 4), 0, random.uniform(1, 8), 17),
                        [10 * (k % 3), 10 * (k // 3), 0]) for k in range(count)]
    return numpy.concatenate(made), {"closed"}


PLAIN = [nasty.block, nasty.block, shells, pocket, slope, islands, nasty.heap, nasty.nest,
         nasty.touching, nasty.stairs, nasty.plate, nasty.comb, nasty.sieve, nasty.needles,
         nasty.hedgehog, nasty.crumpled, nasty.shallow, nasty.spiral, nasty.tower, nasty.tiny]


def small(triangles, limit=45.0):
    extent = numpy.ptp(triangles.reshape(-1, 3), axis=0)
    # Few, low layers: a combination is what is tried, not endurance.
    return triangles * min(1.0, limit / extent[:2].max(), 12.0 / extent[2])


def model_of(case, table, models):
    random = numpy.random.default_rng([case, 77])
    if models and case % 9 == 8:
        path = models[int(random.integers(len(models)))]
        return os.path.basename(path), path, {"closed"}, choose(random, table, {"closed"})
    make = PLAIN[case % len(PLAIN)]
    triangles, traits = make(random)
    traits = set(traits)
    if "thick" in traits:
        traits.add("solid")
    else:
        triangles = small(triangles)
    return make.__name__, triangles, traits, choose(random, table, traits)


# ---- the G-code by itself ----

WORD = re.compile(r"([A-Z])(-?[\d.]+)")
AXIS_A = {"mach3", "machinekit"}


def bed_of(settings):
    corner = [tuple(map(float, p.split("x"))) for p in settings["bed_shape"].split(",")]
    x, y = zip(*corner)
    return min(x), min(y), max(x), max(y)


def settings_of(text):
    found = {}
    for line in text[-60000:].splitlines():
        match = re.match(r"; (\w+) = ?(.*)", line)
        if match:
            found[match[1]] = match[2]
    return found


class Trace:
    """One pass over the G-code: places, amounts, roles, layers."""

    def __init__(self, text):
        self.settings = settings_of(text)
        self.found = []
        self.filament = 0.0
        self.roles = []
        self.tops = []
        self.widest = (0.0, 0)
        self.thickest = (0.0, 0)
        self.bounds = numpy.array([[math.inf] * 3, [-math.inf] * 3])
        self.walk(text)

    def say(self, kind, line, what):
        if len(self.found) < 4:
            self.found.append(f"{kind}: line {line}: {what}")

    def walk(self, text):
        s = self.settings
        flavour = s.get("gcode_flavor", "marlin2")
        letter = "A" if flavour in AXIS_A else "E"
        relative = s["use_relative_e_distances"] == "1" and letter == "E" \
            and flavour not in ("sailfish", "makerware")
        area = math.pi / 4 * float(s["filament_diameter"]) ** 2
        if s["use_volumetric_e"] == "1":
            area = 1.0
        self.area = area
        offset = float(s["z_offset"])
        vase = s["spiral_vase"] == "1"
        at, e, arrived = [0.0, 0.0, 0.0], 0.0, [False] * 3
        retracted = 0.0
        role, layer, top = "", 0, None
        lowest, width, height = math.inf, 0.0, 0.0
        thread = math.pi / 4 * float(s["nozzle_diameter"]) ** 2
        flow, bridge = float(s["extrusion_multiplier"]), float(s["bridge_flow_ratio"])
        even = letter == "E" and flavour in MARLINS
        # Beads of lattices tell their width as it was up to a fifth ago: not each has to tell its own.
        untold = 1.25 if LATTICE.search(s["fill_pattern"] + " " + s["modifiers"]) else 1.06
        for count, line in enumerate(text.splitlines(), 1):
            if line.startswith(";"):
                if line.startswith(";TYPE:"):
                    role = line[6:]
                    if layer and role != "Custom":
                        if not self.roles or self.roles[-1][1] != role or self.roles[-1][0] != layer:
                            self.roles.append((layer, role, count))
                elif line.startswith(";Z:"):
                    z = float(line[3:])
                    if top is not None and z < top and not (
                            s["complete_objects"] == "1" and z <= lowest + 1e-9):
                        self.say("order", count, f"layer at {z} after {top}")
                    top, lowest = z, min(lowest, z)
                    self.tops.append(z)
                    layer += 1
                elif line.startswith(";HEIGHT:"):
                    height = float(line[8:])
                elif line.startswith(";WIDTH:"):
                    width = float(line[7:])
                    if width > self.widest[0]:
                        self.widest = (width, count)
                continue
            code = line.split(";", 1)[0]
            lower = code.lower()
            if "nan" in lower or "inf" in lower:
                self.say("nan", count, line)
            if not code or code[0] != "G":
                continue
            words = WORD.findall(code)
            command = words[0][0] + words[0][1] if words else ""
            value = {k: float(v) for k, v in words[1:]}
            if command == "G92":
                if letter in value:
                    e = value[letter]
                continue
            if command not in ("G0", "G1", "G2", "G3"):
                continue
            begin = list(at)
            for k, axis in enumerate("XYZ"):
                if axis in value:
                    at[k], arrived[k] = value[axis], True
            delta = 0.0
            if letter in value:
                delta = value[letter] if relative else value[letter] - e
                e = value[letter]
            moved = math.dist(begin[:2], at[:2])
            if command in ("G2", "G3"):
                moved = self.arc(begin, at, value, command == "G3", count)
            if layer and role != "Custom":
                for k in range(3):
                    if arrived[k]:
                        self.bounds[0, k] = min(self.bounds[0, k], at[k])
                        self.bounds[1, k] = max(self.bounds[1, k], at[k])
            if not layer or role == "Custom":
                continue
            self.filament += delta
            if delta > 0 and moved > 0:
                bead = delta * area / (moved + 0.003)
                if bead > self.thickest[0]:
                    self.thickest = (bead, count)
                most = flow * max(width * height, 1.4 * thread * bridge if "ridge" in role or
                                  "Overhang" in role else 0)
                if even and bead > untold * most + 2e-5 * area / (moved + 0.003):
                    self.say("amount", count, f"{bead:.4f} mm2 of {width} x {height}: {line}")
                z = at[2] - offset
                if top is not None and abs(z - top) > 2e-3 and not (
                        vase and z <= top + 2e-3):
                    self.say("height", count, f"extrudes at {z:.4f} in the layer at {top}: {line}")
            elif delta > 0 and moved == 0 and delta > 12 + float(s["retract_length"]) + \
                    abs(float(s["retract_restart_extra"])):
                self.say("blob", count, line)
        self.last = at

    def arc(self, begin, at, value, left, count):
        cx, cy = begin[0] + value.get("I", 0), begin[1] + value.get("J", 0)
        radius, other = math.dist(begin[:2], (cx, cy)), math.dist(at[:2], (cx, cy))
        if abs(radius - other) > 0.01 + 1e-3 * radius:
            self.say("arc", count, f"radius {radius:.4f} at its start, {other:.4f} at its end")
        angle = math.atan2(at[1] - cy, at[0] - cx) - math.atan2(begin[1] - cy, begin[0] - cx)
        angle = angle % (2 * math.pi) if left else -angle % (2 * math.pi)
        return radius * (angle or 2 * math.pi)


def check_text(text, report, traits):
    trace = Trace(text)
    s, found = trace.settings, list(trace.found)
    nozzle = float(s["nozzle_diameter"])
    bed = bed_of(s)
    low, high = trace.bounds
    if numpy.isfinite(low).all():
        slack = 1e-3
        if low[0] < bed[0] - slack or low[1] < bed[1] - slack or high[0] > bed[2] + slack \
                or high[1] > bed[3] + slack:
            found.append(f"outside: moves from {low} to {high}")
        if high[2] - float(s["z_offset"]) > float(s["max_print_height"]) + slack:
            found.append(f"outside: rises to {high[2]}")
    widths = [nozzle * 5] + [float(s[k].rstrip("%")) for k in s
                             if k.endswith("extrusion_width") and not s[k].endswith("%")]
    # A strip that a bead is a little too narrow for gets one that is as wide as it.
    widths[1:] = [1.5 * width for width in widths[1:]]
    if trace.widest[0] > max(widths) * 1.01:
        found.append(f"wide: a bead of {trace.widest[0]} mm, line {trace.widest[1]}")
    flow = max(1.0, float(s["bridge_flow_ratio"])) * float(s["extrusion_multiplier"])
    # Small roundings: E has five decimals.
    thick = max(widths) * max(nozzle, float(s["layer_height"])) * flow
    if trace.thickest[0] > 1.05 * thick + 1e-4 * trace.area / 0.003:
        found.append(f"burst: {trace.thickest[0]:.3f} mm2, line {trace.thickest[1]}")
    first = [role for layer, role, _ in trace.roles if layer == trace.roles[0][0]]
    if int(s["skirts"]) > 0 and "Skirt/Brim" in first and first[0] != "Skirt/Brim":
        found.append(f"skirt: {first[0]} comes before it")
    if s["gcode_flavor"] not in ("no-extrusion", "sailfish", "makerware"):
        said = report["filament"]["cm3"] * 1000
        done = trace.filament * trace.area
        strand = math.pi / 4 * float(s["filament_diameter"]) ** 2
        back = (float(s["retract_length"]) + 1) * strand * 2
        if s["before_layer_gcode"] == "" and abs(said - done) > 0.005 * said + back + \
                abs(float(s["retract_restart_extra"])) * strand * report["print"]["retractions"]:
            found.append(f"filament: the report says {said:.2f} mm3, E {done:.2f} mm3")
    if "solid" in traits:
        ratio = said_ratio(report)
        if not 0.97 < ratio < 1.04:
            found.append(f"solid: filament is {ratio:.4f} of the volume of the layers")
    if not trace.tops and report["layers"]["count"] > 0:
        found.append("layers: none in the G-code")
    return found, trace


def said_ratio(report):
    return 1000 * report["filament"]["cm3"] / max(report["layers"]["sliced_volume_mm3"], 1e-9)


# ---- a case ----


def run(command, seconds=100):
    """Seconds are those of processors, whatever else the machine does; waiting is bounded too."""
    def limit():
        resource.setrlimit(resource.RLIMIT_CPU, (int(seconds) + 1, int(seconds) + 2))

    def used():
        usage = resource.getrusage(resource.RUSAGE_CHILDREN)
        return usage.ru_utime + usage.ru_stime
    begun = used()
    try:
        done = subprocess.run(command, capture_output=True, text=True, errors="replace",
                              timeout=max(300, 10 * seconds), preexec_fn=limit)
    except subprocess.TimeoutExpired:
        return None, "", "", used() - begun
    late = done.returncode in (-signal.SIGXCPU, -signal.SIGKILL)
    return None if late else done.returncode, done.stdout, done.stderr, used() - begun


def printer_command(printer, out, s):
    x0, y0, x1, y1 = bed_of(s)
    rise = abs(float(s["z_offset"]))
    size = f"{x1 - x0:g}x{y1 - y0:g}x{float(s['max_print_height']) + 2 * rise + 0.001:.3f}"
    tools = "2" if s.get("lattice_material") else "1"
    return [printer, "--run", out, "--tools", tools, f"--bed={size}", f"--origin={x0:g},{y0:g},{-rise:g}",
            "--filament", s["filament_diameter"], "--max-nozzle", "300", "--max-flow", "100000"]


def examine(given, stl, base, options, traits):
    """What is wrong of one set of options: (seconds, note, [kind: what])."""
    words = [f"--{key.replace('_', '-')}={value}" for key, value in options.items()]
    outputs, seconds = [], 0
    for threads in given.threads.split(","):
        out = f"{base}-{threads}.gcode"
        if os.path.exists(out):
            os.remove(out)
        code, _, errors, took = run([given.program, *stl, "-o", out, "--report", base + ".json",
                                     "--quiet", *given.base, f"--threads={threads}", *words], 2 * given.slow)
        seconds = max(seconds, took)
        if code is None:
            return seconds, "", [f"hang: no end after {2 * given.slow} s"]
        if "Sanitizer" in errors or "runtime error" in errors:
            where = re.findall(r"(?:runtime error: .*|SUMMARY: .*)", errors)
            return seconds, "", [f"sanitizer: {where[:1]} {errors[:1500]}"]
        if code != 0:
            wrong = code not in REFUSALS or (code == 4 and "closed" in traits
                                             and not refused_well(errors, options))
            if os.path.exists(out):
                return seconds, "", [f"left: exit {code} and yet a file"]
            return (seconds, f"exit {code}: {errors.strip()[-160:]}",
                    [f"exit {code}: {errors.strip()[-300:]}"] if wrong else [])
        with open(out, "rb") as file:
            outputs.append(file.read())
    found = []
    if seconds > given.slow:
        found.append(f"slow: {seconds:.1f} s")
    for data in outputs[1:]:
        if data != outputs[0]:
            found.append("threads: other bytes with more threads")
            break
    with open(base + ".json") as file:
        try:
            report = json.load(file, parse_constant=lambda word: 1 / 0)
        except (ValueError, ZeroDivisionError):
            return seconds, "", found + ["report: not JSON"]
    text = outputs[0].decode("utf-8", "replace")
    said, trace = check_text(text, report, traits)
    found += said
    again = base + "-again.gcode"
    code, _, errors, _ = run([given.program, *stl, "-o", again, "-c", out, "--quiet"])
    if code != 0:
        found.append(f"reread: exit {code}: {errors[-300:]}")
    else:
        with open(again, "rb") as file:
            if file.read() != outputs[0]:
                found.append("reread: other bytes from the block of settings")
        os.remove(again)
    if trace.settings["gcode_flavor"] in MARLINS:
        faults, text, errors, _ = run(printer_command(given.printer, out, trace.settings))
        # Klipper's own macros turn heaters off.
        faulty = [line for line in errors.splitlines()
                  if " fault " in line and not (given.base and "heater_left_on" in line)]
        if faulty or faults not in (0, 8):
            found.append(f"printer: {faults} {(faulty or [errors])[:3]}")
    return seconds, f"{report['layers']['count']} layers, {len(outputs[0]) >> 10} KiB", found


def profiles(folder, case):
    """Printer, filament and print of every sixth case come from files that there are."""
    if case % 6 or not folder:
        return []
    random = numpy.random.default_rng([case, 5])
    words = []
    for kind in ("printers", "filaments", "prints"):
        files = sorted(glob.glob(os.path.join(folder, kind, "*.ini")))
        words += ["-c", files[random.integers(len(files))]] if files else []
    return words


def refused_well(errors, options):
    return "high: too low for a first layer" in errors or "nothing is left of the model" in errors


def minimise(given, stl, base, options, traits, kind):
    """Leave out what the same kind of fault does without."""
    same = lambda less: any(f.split(":")[0] == kind
                            for f in examine(given, stl, base, less, traits)[2])
    step = max(1, len(options) // 2)
    begun = time.monotonic()
    while step and time.monotonic() - begun < 10 * given.slow:
        for key in range(0, len(options), step):
            keys = list(options)
            drop = set(keys[key:key + step])
            less = {k: v for k, v in options.items() if k not in drop}
            if drop and same(less):
                options = less
                step = min(step, max(1, len(options) // 2)) * 2
                break
        step //= 2
    return options


def check_case(given, case):
    table = read_options(given.program)
    models = sorted(glob.glob(os.path.join(given.models, "*.stl"))) if given.models else []
    name, model, traits, options = model_of(case, table, models)
    base = os.path.join(given.keep, f"{name}-{case}")
    given.base = profiles(given.profiles, case)
    if given.base:  # start and end are in the words of their firmware
        options.pop("gcode_flavor", None)
    stl = [model]
    if not isinstance(model, str):
        stl = [base + ".stl"]
        nasty.write_stl(stl[0], model)
    if case % 7 == 3:
        stl.append(base + "-second.stl")
        nasty.write_stl(stl[1], islands(numpy.random.default_rng(case))[0])
        traits = {"closed"}
    if "MODIFIER" in options.get("modifiers", ""):
        nasty.write_stl(base + "-part.stl", nasty.box([-3, -8, 0.7], [5, 4, 3.1]))
        options["modifiers"] = options["modifiers"].replace("MODIFIER", base + "-part.stl")
    seconds, note, found = examine(given, stl, base, options, traits)
    if found and given.minimise:
        kind = found[0].split(":")[0]
        options = minimise(given, stl, base, options, traits, kind)
        again = examine(given, stl, base, options, traits)[2]
        found = [f for f in again if f.split(":")[0] == kind] or found
    words = [f"--{key.replace('_', '-')}='{value}'" for key, value in options.items()]
    if found:
        found[0] += "\n    isoslice " + " ".join([*stl, *given.base, *words])
    for path in glob.glob(base + "*"):
        if not (found and path.endswith(".stl")):
            os.remove(path)
    return f"{case} {name}", seconds, note, found


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("printer")
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--cases", type=int, default=10 ** 9)
    parser.add_argument("--seconds", type=float, default=math.inf, help="begin no case after these")
    parser.add_argument("--profiles", help="folder of profiles, for every sixth case")
    parser.add_argument("--models", help="folder of STL files, for every ninth case")
    parser.add_argument("--keep", help="folder for the models of cases that fail")
    parser.add_argument("--minimise", action="store_true", help="fewest options that fail alike")
    parser.add_argument("--slow", type=float, default=20,
                        help="seconds; a case that takes longer has hit a cliff")
    parser.add_argument("--threads", default="1,2,4")
    parser.add_argument("-v", "--verbose", action="store_true")
    parser.add_argument("-j", "--jobs", type=int, default=2)
    given = parser.parse_args()
    failed, done, begun = 0, 0, time.monotonic()
    cases = iter(range(given.first, given.first + given.cases))
    with tempfile.TemporaryDirectory() as scratch, \
            concurrent.futures.ProcessPoolExecutor(given.jobs) as pool:
        given.keep = given.keep or scratch
        os.makedirs(given.keep, exist_ok=True)
        waiting = set()
        while True:
            while len(waiting) < 2 * given.jobs and time.monotonic() - begun < given.seconds:
                case = next(cases, None)
                if case is None:
                    break
                waiting.add(pool.submit(check_case, given, case))
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
    print(f"{done} cases, {failed} failed")
    return failed > 0


if __name__ == "__main__":
    sys.exit(main())
