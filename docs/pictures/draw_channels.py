"""draw_channels.py ISOSLICE FOLDER: the pictures of docs/channels.md, drawn by `isoslice channels`, and
sections of a mould, cut by `isoslice contours`."""

import json
import math
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/cli"))

from models import turned, write_stl  # noqa: E402

PROGRAM, FOLDER = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
SCALE = 20  # units a mm
LOOK = ["--pitch", "18", "--depth", "9", "--section", "round:7"]


def run(*words):
    subprocess.run(list(map(str, words)), check=True, stdout=subprocess.DEVNULL)


def bottle():
    body = [(26 + 3 * math.sin(z / 9), z) for z in range(0, 64, 2)]
    return turned([*body, (22, 66), (16, 72), (13, 80), (13, 92)], 96)


def bowl():
    """A dome with five lobes, upside down in its mould."""
    return turned([(44 * math.cos(math.radians(a)) ** 0.6, 44 * math.sin(math.radians(a)))
                   for a in range(0, 90, 3)] + [(0.4, 44)], 120, lobes=5, depth=0.07)


def path_of(rings, x0, y0):
    words = []
    for ring in rings:
        points = [(round((x - x0) * SCALE), round((y0 - y) * SCALE)) for x, y in ring]
        (x, y), *others = points
        words.append(f"M{x} {y}l")
        for nx, ny in others:
            words.append(f"{nx - x} {ny - y} ")
            x, y = nx, ny
        words.append("z")
    return "".join(words)


def sections(work):
    """Upright through the mould's middle, and level through its second ring."""
    drawn, right, high = [], 0, 0
    for turn, wanted in (("90", 0.5), ("0", 0.385)):
        run(PROGRAM, "contours", "-q", work / "mould.stl", "-o", work / "mould.json", "--rotate-x", turn,
            "--layer-height", "0.5", "--first-layer-height", "0.5", "--nozzle-diameter", "1", "--center", "0,0",
            "--bed-shape", "-200x-200,200x-200,200x200,-200x200", "--max-print-height", "400",
            "--gcode-resolution", "0.03")
        levels = json.loads((work / "mould.json").read_text())["levels"]
        rings = levels[int(wanted * len(levels))]["contours"]
        xs, ys = zip(*(point for ring in rings for point in ring))
        if turn == "90":
            rings = [[(x, -y) for x, y in ring] for ring in rings]
            ys = [-y for y in ys]
        drawn.append(f'<path transform="translate({right},0)" d="{path_of(rings, min(xs), max(ys))}"/>')
        right += round((max(xs) - min(xs) + 6) * SCALE)
        high = max(high, round((max(ys) - min(ys)) * SCALE))
    wide = right - 6 * SCALE
    (FOLDER / "channels-sections.svg").write_text("\n".join([
        f'<svg xmlns="http://www.w3.org/2000/svg" width="900" height="{high * 900 // wide}" '
        f'viewBox="-10 -10 {wide + 20} {high + 20}">',
        "<style>path{fill:#c9cfd6;fill-rule:evenodd;stroke:#333;stroke-width:5}</style>",
        '<rect x="-10" y="-10" width="100%" height="100%" fill="#fff"/>', *drawn, "</svg>", ""]))


def main():
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        write_stl(work / "bottle.stl", bottle())
        write_stl(work / "bowl.stl", bowl())
        for name, model, options in (("channels-parallel", "bottle", []),
                                     ("channels-series", "bottle", ["--ports", "series"]),
                                     ("channels-geodesic", "bowl", ["--ports", "none", "--mode", "geodesic"])):
            run(PROGRAM, "channels", "-q", work / f"{model}.stl", *LOOK, *options, "-o", FOLDER / f"{name}.svg")
        run(PROGRAM, "channels", "-q", work / "bottle.stl", *LOOK, "-o", work / "mould.stl")
        sections(work)


main()
