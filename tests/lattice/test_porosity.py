"""Porosity asked and porosity printed, for every pattern.

    test_porosity.py ISOSLICE PART.stl CELL FROM TO PATTERN...

PART is a cube, or "cube" for one of 20 mm; each pattern is printed in it without walls or shells at
20, 50 and 80 %, and what lies within the box from FROM to TO (mm, from the part's corner, whole
cells of CELL mm apart) is measured twice: by filament and by voxels. Both must be within 1 % of the
volume. Of windows longer than two cells, which random patterns need, voxels are counted in every
eighth layer, and filament tells what the layers between have more or less.

    test_porosity.py ISOSLICE PART.stl graded

A cube of 20 mm whose density rises by 1.5 % a mm, in z and then in x: the means over slabs of 5 mm,
one cell thick and two by two cells wide, must be within 2 % of what is asked in their middle.
"""
import os
import struct
import subprocess
import sys
import tempfile

import printed

ALLOWED, ALLOWED_LOCALLY = 0.01, 0.02
DENSITIES = (20, 50, 80)


def slice_part(isoslice, part, out, options):
    command = [isoslice, "slice", part, "-o", out, "--perimeters", "0", "--top_solid_layers", "0",
               "--bottom_solid_layers", "0", "--skirts", "0", "--layer_height", "0.2",
               "--first_layer_height", "0.2", "--first_layer_extrusion_width", "0.45", *options]
    subprocess.run(command, check=True, stderr=subprocess.PIPE)


def printed_beads(isoslice, part, cell, pattern, density):
    with tempfile.NamedTemporaryFile(suffix=".gcode") as out:
        slice_part(isoslice, part, out.name,
                   ["--fill_pattern", pattern, *density, "--lattice_cell", str(cell),
                    "--dont_arrange", "--bed_shape", "-1x-1,100x-1,100x100,-1x100"])
        return printed.Beads(out.name)


def measure(beads, low, high, every=1, step=0.05):
    filament = beads.share_of_filament(low, high)
    if every == 1:
        return filament, beads.share_of_voxels(low, high, step)
    more, layers = 0.0, [k for k, (z, _) in enumerate(beads.layers) if low[2] < z < high[2]]
    for layer in layers[::every]:
        z, h = beads.layers[layer]
        box = (*low[:2], z), (*high[:2], z + h)
        more += beads.share_of_voxels(*box, step) - beads.share_of_filament(*box)
    return filament, filament + more / len(layers[::every])


def check(name, density, got, allowed):
    bad = max(abs(share - density / 100) for share in got) > allowed
    print(f"{name:22} {density:5.2f} %: filament {100 * got[0]:6.2f}, voxels "
          f"{100 * got[1]:6.2f}{'  WRONG' if bad else ''}", flush=True)
    return bad


def check_patterns(isoslice, part, cell, low, high, patterns):
    wrong = 0
    every, step = (8, 0.1) if high - low > 2 * cell else (1, 0.05)
    for pattern in patterns:
        for density in DENSITIES:
            beads = printed_beads(isoslice, part, cell, pattern,
                                  ["--fill_density", f"{density}%"])
            got = measure(beads, (low,) * 3, (high,) * 3, every, step)
            wrong += check(pattern, density, got, ALLOWED)
    return wrong


def check_graded(isoslice, part):
    wrong = 0
    for pattern in ("gyroid_sheet", "gyroid_solid"):
        for text, axis in (("20+1.5*z", 2), ("35+1.5*x", 0)):
            beads = printed_beads(isoslice, part, 5, pattern, ["--lattice_density", text])
            for k in range(1, 3) if axis == 0 else range(4):
                low, high = [5.0] * 3, [15.0] * 3
                low[axis], high[axis] = 5.0 * k, 5.0 * k + 5
                asked = 20 + 1.5 * (5 * k + 2.5)
                got = measure(beads, low, high, 4, 0.1)
                wrong += check(f"{pattern} {text} {5 * k}..", asked, got, ALLOWED_LOCALLY)
    return wrong


def write_cube(path, edge=20.0):
    """Its twelve triangles: two to each side, seen from outside."""
    with open(path, "wb") as file:
        file.write(bytes(80) + struct.pack("<I", 12))
        for axis in range(3):
            for side in (0.0, edge):
                ring = [(0.0, 0.0), (edge, 0.0), (edge, edge), (0.0, edge)]
                if side == 0:
                    ring.reverse()
                corners = [(u, v, side) for u, v in ring]
                corners = [tuple(c[(k - axis - 1) % 3] for k in range(3)) for c in corners]
                for k in (1, 2):
                    triangle = corners[0] + corners[k] + corners[k + 1]
                    file.write(struct.pack("<12fH", 0, 0, 0, *triangle, 0))


def run(isoslice, part, arguments):
    if arguments[0] == "graded":
        return check_graded(isoslice, part)
    cell, low, high = map(float, arguments[:3])
    return check_patterns(isoslice, part, cell, low, high, arguments[3:])


def main():
    isoslice, part = sys.argv[1:3]
    with tempfile.TemporaryDirectory() as room:
        if part == "cube":
            part = os.path.join(room, "cube.stl")
            write_cube(part)
        return 1 if run(isoslice, part, sys.argv[3:]) else 0


if __name__ == "__main__":
    sys.exit(main())
