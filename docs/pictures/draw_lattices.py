"""draw_lattices.py ISOSLICE FOLDER [PATTERN...]: the pictures of docs/lattices.md. A section of each
lattice (or of those named alone, as for a test), cut by `isoslice contours` out of what `isoslice
lattice` made, and layers of prints."""

import json
import math
import pathlib
import struct
import subprocess
import sys
import tempfile
import zlib

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/cli"))

from models import box, plate_with_hole, turned, write_stl  # noqa: E402

PROGRAM, FOLDER = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
SIDE, CELL, LEVEL = 15, 6, 1.1  # of the sections, mm
PATTERNS = """
    gyroid_sheet primitive_sheet diamond_sheet iwp_sheet neovius_sheet fischer_koch_sheet
    gyroid_solid primitive_solid diamond_solid iwp_solid neovius_solid fischer_koch_solid
    bcc_struts fcc_struts octet_struts kelvin_struts diamond_struts foam_struts
    foam_sheet bone_sheet bone_solid voxel_cubic voxel_random voxel_file""".split()
PATTERNS = sys.argv[3:] or PATTERNS
COLUMNS, STEP, LINE, SCALE = 6, 17, 2.6, 25  # squares in a row, their distance; units a mm
FINE = 1  # units that a line may be off


def run(*words):
    subprocess.run(list(map(str, words)), check=True, stdout=subprocess.DEVNULL)


def write_png(path, rows):
    """A grey picture, black where a row has 0."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    head = struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 0, 0, 0, 0)
    data = b"".join(b"\0" + bytes(row) for row in rows)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) +
                     chunk(b"IDAT", zlib.compress(data)) + chunk(b"IEND", b""))


def draw_cell(folder, n=24):
    """What voxel_file holds: an upright tube and bars that meet it, as pictures of its layers."""
    folder.mkdir()
    at = [(2 * i + 1) / n - 1 for i in range(n)]

    def is_inside(x, y, z):
        out = math.hypot(x, y)
        return 0.35 < out < 0.65 or (out > 0.5 and abs(z) > 0.4 and min(abs(x), abs(y)) < 0.2)

    for k, z in enumerate(at):
        write_png(folder / f"{k:03d}.png", [[255 * is_inside(x, y, z) for x in at] for y in at])


def section(work, pattern):
    """Contours at LEVEL, in units, from the square's middle, and y downwards."""
    file = ["--lattice-file", work / "cell"] if pattern == "voxel_file" else []
    run(PROGRAM, "lattice", "-q", work / "slab.stl", "-o", work / "lattice.stl", "--fill-pattern", pattern,
        "--lattice-cell", CELL, "--fill-density", "30%", "--voxel", "0.2", *file)
    run(PROGRAM, "contours", "-q", work / "lattice.stl", "-o", work / "lattice.json", "--layer-heights",
        2 * LEVEL, "--layer-height", "1", "--nozzle-diameter", "4", "--gcode-resolution", "0.04",
        "--center", "0,0", "--bed-shape", "-99x-99,99x-99,99x99,-99x99")
    levels = json.loads((work / "lattice.json").read_text())["levels"]
    assert len(levels) == 1 and abs(levels[0]["z"] - LEVEL) < 1e-6, levels
    return [[(round(x * SCALE), round(-y * SCALE)) for x, y in ring] for ring in levels[0]["contours"]]


def simplified(line):
    """Of points of a line those that it needs."""
    (ax, ay), (bx, by) = line[0], line[-1]
    length = math.hypot(bx - ax, by - ay)

    def off(p):
        if length == 0:
            return math.hypot(p[0] - ax, p[1] - ay)
        return abs((p[0] - ax) * (by - ay) - (p[1] - ay) * (bx - ax)) / length

    far = max(range(1, len(line) - 1), key=lambda i: off(line[i]), default=0)
    if far == 0 or off(line[far]) <= FINE:
        return [line[0], line[-1]]
    return simplified(line[:far + 1])[:-1] + simplified(line[far:])


def path_of(rings):
    words = []
    for ring in rings:
        (x, y), *others = simplified(ring + ring[:1])[:-1]
        words.append(f"M{x} {y}l")
        steps = []
        for nx, ny in others:
            steps.append(f"{nx - x} {ny - y}")
            x, y = nx, ny
        words.append(" ".join(steps).replace(" -", "-") + "z")
    return "".join(words)


def draw_sections(work):
    """All of them in one picture."""
    write_stl(work / "slab.stl", box((0, 0, 0), (SIDE, SIDE, 2 * LEVEL)))
    draw_cell(work / "cell")
    rows = math.ceil(len(PATTERNS) / COLUMNS)
    wide, high = COLUMNS * STEP + 1, rows * (STEP + LINE) + 1
    half = SIDE * SCALE / 2
    drawn = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{wide * 8}" height="{high * 8:.0f}" '
             f'viewBox="0 0 {wide * SCALE} {high * SCALE:.0f}" font-family="sans-serif" font-size="38" '
             'text-anchor="middle">',
             "<style>path{fill:#b03029;stroke:#333;stroke-width:2}</style>",
             '<rect width="100%" height="100%" fill="#fff"/>']
    for i, pattern in enumerate(PATTERNS):
        x = (i % COLUMNS + 0.5) * STEP * SCALE + SCALE / 2
        y = (i // COLUMNS * (STEP + LINE) + STEP / 2) * SCALE + LINE * SCALE
        drawn += [f'<g transform="translate({x:.0f},{y:.0f})">',
                  f'<text y="{-half - 14:.0f}">{pattern}</text>',
                  f'<rect x="{-half:.0f}" y="{-half:.0f}" width="{2 * half:.0f}" height="{2 * half:.0f}" '
                  'fill="#f2f2f0"/>', f'<path d="{path_of(section(work, pattern))}"/></g>']
    (FOLDER / "lattice-patterns.svg").write_text("\n".join([*drawn, "</svg>", ""]))


def draw(work, name, model, layer, *options):
    """A layer of a print."""
    write_stl(work / "model.stl", model)
    run(PROGRAM, "-q", work / "model.stl", "-o", work / "model.gcode", "--layer-height", "0.2",
        "--first-layer-height", "0.2", "--skirts", "0", "--perimeters", "1", "--top-solid-layers", "0",
        "--bottom-solid-layers", "0", *options)
    run(PROGRAM, "preview", "-q", work / "model.gcode", "-o", FOLDER / f"{name}.svg", "--layers", layer,
        "--no-travels")


def main():
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        draw_sections(work)
        draw(work, "lattice-graded", box((0, 0, 0), (54, 21, 3)), 8, "--fill-pattern", "gyroid_sheet",
             "--lattice-cell", "6", "--lattice-density", "ramp(x, -25, 25, 12, 70)", "--gcode-resolution",
             "0.04")
        draw(work, "lattice-cylinder", plate_with_hole(16, 3, 8), 7, "--fill-pattern",
             "gyroid_sheet", "--lattice-map", "cylinder", "--lattice-cell", "5", "--fill-density", "30%",
             "--gcode-resolution", "0.04", "--perimeters", "0")
        draw(work, "lattice-skin", turned([(13, 0), (13, 20)], 120, lobes=5, depth=0.2), 68,
             "--fill-pattern", "gyroid_sheet", "--lattice-cell", "6", "--lattice-density",
             "ramp(skin, 1, 6, 70, 12)", "--gcode-resolution", "0.05")


main()
