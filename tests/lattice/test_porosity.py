"""Porosity asked and porosity printed, for every pattern.

    test_porosity.py ISOSLICE PART.stl CELL FROM TO PATTERN...

PART is a cube; each pattern is printed in it without walls or shells at 20, 50 and 80 %, and what
lies within the box from FROM to TO (mm, from the part's corner, whole cells of CELL mm apart) is
measured twice: by filament and by voxels. Both must be within 1 % of the volume.
"""
import subprocess
import sys
import tempfile

import printed

ALLOWED = 0.01
DENSITIES = (20, 50, 80)


def slice_part(isoslice, part, out, options):
    command = [isoslice, "slice", part, "-o", out, "--perimeters", "0", "--top_solid_layers", "0",
               "--bottom_solid_layers", "0", "--skirts", "0", "--layer_height", "0.2",
               "--first_layer_height", "0.2", "--first_layer_extrusion_width", "0.45", *options]
    subprocess.run(command, check=True, stderr=subprocess.PIPE)


def measure(isoslice, part, cell, window, pattern, density):
    with tempfile.NamedTemporaryFile(suffix=".gcode") as out:
        slice_part(isoslice, part, out.name,
                   ["--fill_pattern", pattern, "--fill_density", f"{density}%",
                    "--lattice_cell", str(cell), "--dont_arrange", "--bed_shape",
                    "-1x-1,100x-1,100x100,-1x100"])
        beads = printed.Beads(out.name)
    low, high = (window[0],) * 3, (window[1],) * 3
    return beads.share_of_filament(low, high), beads.share_of_voxels(low, high)


def main():
    isoslice, part, cell = sys.argv[1], sys.argv[2], float(sys.argv[3])
    window = tuple(map(float, sys.argv[4:6]))
    wrong = 0
    for pattern in sys.argv[6:]:
        for density in DENSITIES:
            filament, voxels = measure(isoslice, part, cell, window, pattern, density)
            bad = max(abs(filament - density / 100), abs(voxels - density / 100)) > ALLOWED
            wrong += bad
            print(f"{pattern:22} {density} %: filament {100 * filament:6.2f}, voxels "
                  f"{100 * voxels:6.2f}{'  WRONG' if bad else ''}", flush=True)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
