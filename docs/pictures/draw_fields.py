"""draw_fields.py ISOSLICE FOLDER: how each field cuts one part, drawn by isoslice itself."""

import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/cli"))

from models import turned, write_stl  # noqa: E402

PROGRAM, FOLDER = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])

FIELDS = {
    "plane": "plane:0.3,0,1",
    "cone": "cone:25",
    "sphere": "sphere:0,0,-25",
    "cylinder": "cylinder:y,0,-12",
    "torus": "torus:14,0,0,-4",
    "wave": "wave:1.2,9,30",
    "fan": "fan:y,-40,0,40",
    "expression": "z - 5*exp(-((x - 6)^2 + (y + 7)^2)/60)",
    "geodesic": "geodesic",
}


def vase():
    """Five lobes that turn on their way up, a waist, and a shoulder."""
    profile = [(13, 0), (15, 4), (15.5, 8), (14, 12), (11.5, 16), (10, 20), (10.5, 24), (12.5, 27), (13, 29), (11, 30)]
    return turned(profile, 60, lobes=5, depth=0.1, twist=0.6)


def main():
    with tempfile.TemporaryDirectory() as folder:
        part = pathlib.Path(folder) / "vase.stl"
        write_stl(part, vase())
        for name, field in FIELDS.items():
            subprocess.run([PROGRAM, "contours", "-q", part, "--field", field, "--layer-height", "1",
                            "--first-layer-height", "1", "--nozzle-diameter", "2", "--field-tolerance", "0.03",
                            "--view=-65,28", "-o", FOLDER / f"field-{name}.svg"], check=True)


main()
