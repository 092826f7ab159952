"""draw_curved.py ISOSLICE FOLDER: the pictures of docs/curved-layers.md. Layers of a curved print, as `isoslice
preview` draws them; the same part cut upright, bead by bead, out of two G-code files; and the tool that the
collision check has in mind, with its usual measures."""

import math
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/cli"))

from models import dome, write_stl  # noqa: E402

PROGRAM, FOLDER = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
FIELD = "sphere:0,0,-49.34"
PRINT = ["--layer-height", "0.3", "--first-layer-height", "0.3", "--skirts", "0"]
SCALE = 100  # units a mm, of sections
LOOK = ("<style>g{fill:none;stroke-linecap:round}.edge{stroke:#23303d}.even{stroke:#7fb2e5}.odd{stroke:#c3dcf3}"
        "</style>")


def run(*words):
    return subprocess.run(list(map(str, words)), check=True, capture_output=True, text=True).stdout


def crossings(path, y):
    """Of beads with the upright plane at y, layer by layer: (x, z of the tip, width in the plane, height)."""
    layers, at, width, height = [], {"X": 0.0, "Y": 0.0, "Z": 0.0}, 0.4, 0.3
    for line in path.read_text().splitlines():
        if line.startswith(";LAYER_CHANGE"):
            layers.append([])
        elif line.startswith(";WIDTH:"):
            width = float(line[7:])
        elif line.startswith(";HEIGHT:"):
            height = float(line[8:])
        if not re.match(r"G[01] ", line):
            continue
        words = {word[0]: float(word[1:]) for word in line.split(";")[0].split()[1:]}
        to = {axis: words.get(axis, at[axis]) for axis in at}
        way = [to[axis] - at[axis] for axis in "XYZ"]
        if layers and words.get("E", 0) > 0 and (at["Y"] - y) * (to["Y"] - y) < 0:
            share = (y - at["Y"]) / way[1]
            wide = height + (width - height) * min(math.hypot(*way) / abs(way[1]), 4)
            layers[-1].append((at["X"] + share * way[0], at["Z"] + share * way[2], wide, height))
        at = to
    return [sorted(layer) for layer in layers]


def slope_at(layer, i):
    """How steep a layer lies at one of its beads, from those beside it."""
    beside = [b for b in layer[max(i - 2, 0):i + 3] if abs(b[0] - layer[i][0]) < 3]
    x, z = (sum(b[k] for b in beside) / len(beside) for k in (0, 1))
    over = sum((b[0] - x) ** 2 for b in beside)
    return sum((b[0] - x) * (b[1] - z) for b in beside) / over if over > 1e-6 else 0


def section(layers, middle, name):
    """A bead is a line as thick as it is high, with round ends."""
    drawn = []
    for k, layer in enumerate(layers):
        words = {}
        for i, (x, z, wide, high) in enumerate(layer):
            slope = slope_at(layer, i)
            c = 1 / math.hypot(1, slope)
            half = max(wide - high, 0.01) / 2
            mx, mz = x - middle + slope * c * high / 2, z - c * high / 2
            words.setdefault(round(high / 0.03) * 3, []).append(
                f"M{round((mx - half * c) * SCALE)} {round(-(mz - half * slope * c) * SCALE)}"
                f"l{round(2 * half * c * SCALE)} {round(-2 * half * slope * c * SCALE)}")
        for high, lines in words.items():
            drawn.append(f'<g class="edge" stroke-width="{high}"><path id="{name}{k}-{high}" d="{"".join(lines)}"/>'
                         f'</g><use class="{"odd" if k % 2 else "even"}" stroke-width="{high - 7}" '
                         f'href="#{name}{k}-{high}"/>')
    return drawn


def hills(wide=40, deep=9, count=80):
    """A bar whose top goes up and down."""
    xs = [wide * (i / count - 0.5) for i in range(count + 1)]
    tops = [6.5 + 1.5 * math.sin(0.3 * x) + 0.02 * x for x in xs]
    quads = []
    for a, b, p, q in zip(xs, xs[1:], tops, tops[1:]):
        quads += [((a, 0, 0), (b, 0, 0), (b, 0, q), (a, 0, p)),
                  ((b, deep, 0), (a, deep, 0), (a, deep, p), (b, deep, q)),
                  ((a, 0, p), (b, 0, q), (b, deep, q), (a, deep, p)),
                  ((a, deep, 0), (b, deep, 0), (b, 0, 0), (a, 0, 0))]
    for x, z, front, back in ((xs[0], tops[0], deep, 0), (xs[-1], tops[-1], 0, deep)):
        quads.append(((x, front, 0), (x, back, 0), (x, back, z), (x, front, z)))
    return [triangle for a, b, c, d in quads for triangle in ((a, b, c), (a, c, d))]


def draw_sections(work, name, model, fields, size):
    """Under each other, one a field; size is the room for one, mm."""
    wide, high = round(size[0] * SCALE), round(size[1] * SCALE)
    rows = len(fields)
    drawn = [f'<svg xmlns="http://www.w3.org/2000/svg" width="900" height="{900 * rows * high // wide}" '
             f'viewBox="{-wide // 2} 0 {wide} {rows * high}" font-family="sans-serif" font-size="{wide // 55}">',
             LOOK, f'<rect x="{-wide // 2}" y="0" width="100%" height="100%" fill="#fff"/>']
    write_stl(work / f"{name}.stl", model)
    for i, field in enumerate(fields):
        run(PROGRAM, "-q", work / f"{name}.stl", "-o", work / f"{name}.gcode", *PRINT, "--fill-density", "100%",
            "--perimeters", "2", "--center", "100,100", "--field", field)
        drawn += [f'<text x="{SCALE - wide // 2}" y="{i * high + wide // 40}">field = {field}</text>',
                  f'<g transform="translate(0,{(i + 1) * high - 40})">',
                  f'<path d="M{-wide // 2} 0h{wide}" stroke="#000" stroke-width="6"/>',
                  *section(crossings(work / f"{name}.gcode", 100.3003), 100, f"{name}{i}"), "</g>"]
    (FOLDER / f"curved-{name}.svg").write_text("\n".join([*drawn, "</svg>", ""]))


def defaults():
    """Of the options clearance_..., in the program's own words."""
    found = {}
    for name, value in re.findall(r"(?m)^\s*(clearance_\w+)\s+([-\d.,]+)", run(PROGRAM, "--list-options")):
        found[name] = [float(number) for number in value.split(",")]
    return found


def draw_tool():
    """From the side, to scale; the layer below it bends."""
    d, scale = defaults(), 8
    tip, angle = d["clearance_tip"][0] / 2, d["clearance_cone"][0]
    cone, carriage, gantry = (d[f"clearance_{k}_height"][0] for k in ("cone", "carriage", "gantry"))
    block, plate = d["clearance_block"], d["clearance_carriage"]
    wide = tip + cone * math.tan(math.radians(angle))

    def y(z):
        return (gantry + 5 - z) * scale

    def box(x0, x1, z0, z1, colour):
        return (f'<rect x="{x0 * scale:.1f}" y="{y(z1):.1f}" width="{(x1 - x0) * scale:.1f}" '
                f'height="{(z1 - z0) * scale:.1f}" fill="{colour}" stroke="#333"/>')

    def height(x, z, name, of):
        return (f'<path class="size" d="M{x * scale:.1f} {y(0):.1f}V{y(z):.1f}m-4 0h8"/>'
                f'<path class="thin" d="M{x * scale:.1f} {y(z):.1f}H{of * scale:.1f}"/>'
                f'<text x="{x * scale + 6:.1f}" y="{y(z) + 16:.1f}">{name}</text>')

    left, right, low = -plate[2] - 12, plate[2] + 26, -7
    hill = " ".join(f"{'M' if i == 0 else 'L'}{x * scale:.1f} {y(3 - math.hypot(x + 22, 60) + 60.75):.1f}"
                    for i, x in enumerate(range(int(left), int(right) + 1)))
    drawn = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{(right - left) * scale:.0f}" '
        f'height="{y(low):.0f}" viewBox="{left * scale:.0f} 0 {(right - left) * scale:.0f} {y(low):.0f}" '
        'font-family="sans-serif" font-size="14">',
        "<style>.size{stroke:#b03029;fill:none}.thin{stroke:#b03029;fill:none;stroke-dasharray:2 4}</style>",
        f'<rect x="{left * scale:.0f}" y="0" width="100%" height="100%" fill="#fff"/>',
        box(left, right, gantry, gantry + 5, "#d8d8d4"),
        box(plate[0], plate[2], carriage, gantry, "#e6e6e2"),
        box(block[0], block[2], cone, carriage, "#f0c9a8"),
        f'<path d="M{-tip * scale:.1f} {y(0):.1f}L{-wide * scale:.1f} {y(cone):.1f}H{wide * scale:.1f}'
        f'L{tip * scale:.1f} {y(0):.1f}z" fill="#e3b04b" stroke="#333"/>',
        f'<path d="{hill}V{y(low):.1f}H{left * scale:.1f}z" fill="#c3dcf3" stroke="#23303d"/>',
        f'<text x="{(plate[0] + 2) * scale:.0f}" y="{y(gantry + 1.8):.0f}">the gantry, wherever the nozzle is</text>',
        f'<text x="{(plate[0] + 2) * scale:.0f}" y="{y(gantry - 4):.0f}">clearance_carriage</text>',
        f'<text x="{(block[0] + 1) * scale:.0f}" y="{y(carriage - 3):.0f}">clearance_block</text>',
        f'<text x="{2 * wide * scale:.0f}" y="{y(3.4):.0f}">clearance_cone</text>',
        f'<path class="size" d="M0 {y(0):.1f}V{y(cone - 1):.1f}M0 {y(cone - 2):.1f}A{(cone - 2) * scale:.1f} '
        f'{(cone - 2) * scale:.1f} 0 0 1 {(cone - 2) * scale * math.sin(math.radians(angle)):.1f} '
        f'{y((cone - 2) * math.cos(math.radians(angle))):.1f}L{2 * wide * scale - 6:.0f} {y(3):.0f}"/>',
        f'<text x="{-1.5 * scale:.0f}" y="{y(-3.6):.0f}" text-anchor="end">clearance_tip</text>',
        f'<path class="size" d="M{-tip * scale:.1f} {y(-1.6):.1f}h{2 * tip * scale:.1f}m0 -4v8m{-2 * tip * scale:.1f} 0v-8"/>',
        f'<path class="size" d="M{0:.1f} {y(-1.6):.1f}L{-1.3 * scale:.1f} {y(-3.3):.1f}"/>',
        height(plate[2] + 3, cone, "clearance_cone_height", block[2]),
        height(plate[2] + 2, carriage, "clearance_carriage_height", plate[2]),
        height(plate[2] + 1, gantry, "clearance_gantry_height", plate[2]),
        "</svg>", ""]
    (FOLDER / "curved-tool.svg").write_text("\n".join(drawn))


def main():
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        write_stl(work / "dome.stl", dome())
        draw_sections(work, "section", dome(), ["z", FIELD], (30, 12.4))
        draw_sections(work, "auto-top", hills(), ["z", "auto-top"], (42, 9.5))
        run(PROGRAM, "-q", work / "dome.stl", "-o", work / "dome.gcode", *PRINT, "--field", FIELD,
            "--fill-pattern", "gyroid", "--perimeters", "2", "--field-tolerance", "0.05")
        run(PROGRAM, "preview", "-q", work / "dome.gcode", "-o", FOLDER / "curved-layers.svg", "--layers",
            "1,12,24,-1", "--columns", "2", "--view=-70,35", "--no-travels")
    draw_tool()


main()
