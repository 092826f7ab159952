#!/usr/bin/env python3
"""check_macros.py ISOSLICE: macros at random, evaluated by isoslice and by prusa-slicer.

Expressions of whole numbers, numbers, texts and conditions are written as the lines of one start
code that both slicers evaluate; the lines must be the same. Without prusa-slicer nothing is done.
"""
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile

from check_bundles import write_part

COUNT, SEED = 400, 5
OPTIONS = ["temperature[0]", "nozzle_diameter[0]", "layer_height", "perimeters", "fill_density",
           "max_print_height", "retract_length[0]", "first_layer_height", "infill_overlap",
           "external_perimeter_speed", "first_layer_print_min[0]", "first_layer_print_max[1]",
           "print_bed_size[0]", "total_layer_count", "external_perimeter_extrusion_width",
           "first_layer_extrusion_width", "support_material_xy_spacing", "infill_anchor",
           "machine_max_feedrate_x[0]", "bed_temperature[3]", "num_objects", "z_offset"]
FIXED = ["[temperature]", "[fill_density]", "[first_layer_height]", "[external_perimeter_speed]",
         "[temperature_0]", "[temperature_[current_extruder]]", "[bed_shape]", "[bed_shape_1]",
         "{bed_shape[2]}", "[first_layer_print_min]", "[first_layer_print_size_1]", "[wipe]",
         "{wipe[0]}", "[layer_height]", "{input_filename_base}", "{input_filename}",
         "{filament_type[0]}", "[filament_type]", "{has_wipe_tower}", "[has_wipe_tower]",
         "{total_toolchanges}", "[scale]", "{printer_notes}", "{extruder_offset[0]}",
         "{if printer_notes=~/.*MODEL_(MINI|MK3).*/}mini{else}other{endif}",
         "{if \"abc\"!~/b/}1{endif}", "{\"a\" + 1 + 2.50 + true}", "{digits(3.14159,7,3)}",
         "{zdigits(-3.14159,9,3)}", "{zdigits(42,6)}", "{random(4,4)}", "a}b]c",
         "{if false}1{elsif not (1 == 2)}2{else}3{endif}"]


def number(rng, depth):
    kind = rng.randrange(12)
    if depth == 0 or kind < 3:
        return rng.choice([str(rng.randrange(1, 50)), f"{rng.uniform(0, 30):.3f}",
                           rng.choice(OPTIONS)])
    if kind < 8:
        return (f"({number(rng, depth - 1)} {rng.choice('+-*/')} "
                f"{number(rng, depth - 1)})")
    if kind == 8:
        return f"-{number(rng, depth - 1)}"
    if kind == 9:
        return f"{rng.choice(['min', 'max'])}({number(rng, depth - 1)}, {number(rng, depth - 1)})"
    if kind == 10:
        return f"{rng.choice(['int', 'round'])}({number(rng, depth - 1)})"
    return f"({truth(rng, depth - 1)} ? {number(rng, depth - 1)} : {number(rng, depth - 1)})"


def truth(rng, depth):
    kind = rng.randrange(6)
    if depth == 0 or kind < 3:
        sign = rng.choice(["<", ">", "<=", ">=", "==", "!="])
        return f"({number(rng, max(depth - 1, 0))} {sign} {number(rng, max(depth - 1, 0))})"
    if kind == 3:
        return f"(not {truth(rng, depth - 1)})"
    return f"({truth(rng, depth - 1)} {rng.choice(['and', 'or', '&&'])} {truth(rng, depth - 1)})"


def lines_of(gcode):
    return {line.split(" ", 1)[0]: line for line in gcode.split("\n") if line.startswith(";@")}


def run(command):
    return subprocess.run(command, capture_output=True, text=True)


def both(isoslice, scratch, lines):
    """The lines as each slicer writes them; None for one that refuses."""
    ini, part = scratch / "o.ini", scratch / "part.stl"
    text = "\\n".join(lines)
    ini.write_text(f"start_gcode = G28\\n{text}\\n;end\nskirts = 0\nfirst_layer_height = 0.3\n"
                   "temperature = 215\nnozzle_diameter = 0.4\nprinter_notes = a\\nMODEL_MINI\\n\n"
                   "extruder_offset = 0x0\nfill_density = 15%\ninfill_overlap = 20%\n")
    results = []
    for name, command in (("ours", [isoslice, "-c", ini, part, "--quiet"]),
                          ("theirs", ["prusa-slicer", "-g", "--load", ini, part])):
        out = scratch / name
        out.unlink(missing_ok=True)
        done = run([*command, "-o", out])
        good = done.returncode == 0 and out.exists()
        results.append(lines_of(out.read_text()) if good else None)
    return results


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    if not shutil.which("prusa-slicer"):
        print("prusa-slicer is not installed: nothing to compare with")
        return
    rng = random.Random(SEED)
    macros = FIXED + ["{%s}" % number(rng, 3) for _ in range(COUNT)] + [
        "{if %s}yes{else}no{endif}" % truth(rng, 2) for _ in range(COUNT)]
    lines = [f";@{i} <{macro}>" for i, macro in enumerate(macros)]
    compared = refused = 0
    different = []
    with tempfile.TemporaryDirectory() as scratch_name:
        scratch = pathlib.Path(scratch_name)
        write_part(scratch / "part.stl")
        pending = [lines[i:i + 40] for i in range(0, len(lines), 40)]
        while pending:  # one that divides by zero spoils its block: then by halves
            block = pending.pop()
            ours, theirs = both(sys.argv[1], scratch, block)
            if (ours is None or theirs is None) and len(block) > 1:
                pending += [block[:len(block) // 2], block[len(block) // 2:]]
            elif ours is None or theirs is None:
                refused += theirs is None  # it evaluates what conditions leave out, too
                if theirs is not None:
                    different.append((block[0], ours, theirs))
            else:
                compared += len(theirs)
                different += [(line, ours.get(key), theirs[key]) for line in block
                              for key in [line.split(" ", 1)[0]] if ours.get(key) != theirs[key]]
    print(f"{compared} macros compared with prusa-slicer, {refused} that it refuses: "
          f"{len(different)} differ")
    for line, ours, theirs in different:
        print(f"  {line}\n    ours:   {ours}\n    theirs: {theirs}")
    sys.exit(1 if different else 0)


if __name__ == "__main__":
    main()
