"""draw.py ISOSLICE SAMPLE FOLDER [LATTICE...]: all pictures of the documents, drawn anew by isoslice itself.

ISOSLICE is the program, SAMPLE the maker of the sample part (build/release/tests/models/isoslice-sample),
FOLDER where the pictures go, LATTICE a pattern to draw instead of all. `./dev pictures` draws them in place."""

import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/cli"))

from models import box, moved, plate_with_hole, prism, turned, write_stl  # noqa: E402

PROGRAM, SAMPLE, FOLDER = (pathlib.Path(argument).resolve() for argument in sys.argv[1:4])
THIN = ["--layer-height", "0.2", "--first-layer-height", "0.2", "--skirts", "0"]


def run(*words):
    subprocess.run(list(map(str, words)), check=True, stdout=subprocess.DEVNULL)


def draw(work, name, model, layers, *options, columns=None, travels=False):
    """Some layers of a print; a model is triangles or a file."""
    if isinstance(model, list):
        write_stl(work / f"{name}.stl", model)
        model = work / f"{name}.stl"
    run(PROGRAM, "-q", model, "-o", work / f"{name}.gcode", *options)
    run(PROGRAM, "preview", "-q", work / f"{name}.gcode", "-o", FOLDER / f"{name}.svg", "--layers",
        layers, "--columns", columns or layers.count(",") + 1,
        *([] if travels else ["--no-travels"]))


def beam():
    """A beam on two pillars, with a step on top."""
    return (box((0, 0, 0), (6, 8, 4.1)) + box((22, 0, 0), (28, 8, 4.1)) +
            box((0, 0, 4), (28, 8, 7)) + box((0, 0, 6.5), (12, 8, 9)))


def comb():
    """A wedge, and blades 0.1 to 1.2 mm thick on a bar."""
    wedge = prism([[(0, -1), (20, 0), (0, 1)]], 0, 0.6)
    blades = [box((2 + 1.6 * i, 4, 0), (2 + 1.6 * i + 0.1 * (i + 1), 9, 0.6)) for i in range(12)]
    return sum(blades, wedge) + box((1, 2.5, 0), (22, 4.2, 0.6))


def main():
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        sample = work / "sample.stl"
        run(SAMPLE, sample)
        draw(work, "sample", sample, "20,30,75,200", *THIN[:2], "--gcode-resolution", "0.05",
             "--perimeters", "2", "--fill-pattern", "gyroid", "--solid-infill-below-area", "0",
             columns=2, travels=True)
        draw(work, "brim", sample, "1", "--brim-width", "5", "--brim-type", "outer_and_inner",
             "--gcode-resolution", "0.05", "--perimeters", "2")
        draw(work, "shells", beam(), "20,21,26,33,34,35", *THIN, "--perimeters", "1", "--fill-density",
             "15%", "--solid-infill-below-area", "0", columns=3)
        draw(work, "gap-fill", comb(), "2", *THIN, "--perimeters", "2")
        draw(work, "fuzzy-skin", plate_with_hole(9, 1, 4), "4", *THIN, "--fuzzy-skin", "external",
             "--perimeters", "2", "--fill-density", "20%", "--top-solid-layers", "0")
        arrange(work)
    for script in ("tests/fill/draw_patterns.sh", "tests/path/draw_paths.sh"):
        run("sh", ROOT / script, PROGRAM, FOLDER)
    run(sys.executable, "-B", ROOT / "docs/pictures/draw_channels.py", PROGRAM, FOLDER)
    run(sys.executable, "-B", ROOT / "docs/pictures/draw_fields.py", PROGRAM, FOLDER)
    run(sys.executable, "-B", ROOT / "docs/pictures/draw_curved.py", PROGRAM, FOLDER)
    run(sys.executable, "-B", ROOT / "docs/pictures/draw_lattices.py", PROGRAM, FOLDER,
        *sys.argv[4:])


def arrange(work):
    """Twenty objects of four kinds."""
    kinds = {
        "star": turned([(12, 0), (12, 1)], 90, lobes=5, depth=0.25),
        "triangle": prism([[(0, 0), (38, 0), (10, 26)]], 0, 1),
        "bar": box((0, 0, 0), (46, 9, 1)),
        "square": plate_with_hole(11, 1, 7),
    }
    files = []
    for kind, triangles in kinds.items():
        write_stl(work / f"{kind}.stl", triangles)
        files += [work / f"{kind}.stl"] * 5
    run(PROGRAM, "contours", "-q", "--arrange", *files, "--layer-heights", "1", "--layer-height", "0.3",
        "--gcode-resolution", "0.05", "--nozzle-diameter", "1.2", "--bed-shape", "0x0,180x0,180x180,0x180",
        "-o", FOLDER / "arranged.svg")


main()
