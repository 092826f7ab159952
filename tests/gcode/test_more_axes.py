"""Whole prints on machines that turn the part, by nothing but the file: with the axes turned back the
tip is on the field's levels and in the part, as fast as it is to be, and the printer takes as long as the file says."""

import math
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import unittest

PROGRAM, PRINTER = (str(pathlib.Path(argument).resolve()) for argument in sys.argv[1:3])
SIDE, DEEP = 12, 30  # mm: a cube, and how far below its foot the spheres' centre is
WORD = re.compile(r"([XYZABCEF])(-?[\d.]+)")


def cube(path):
    corner = [(x, y, z) for z in (0, SIDE) for y in (0, SIDE) for x in (0, SIDE)]
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    triangles = [t for a, b, c, d in faces for t in ((a, b, c), (a, c, d))]
    write(path, [[corner[i] for i in t] for t in triangles])


def sleeve(path):
    """Around x, from a radius of 6 mm to 9 mm, its axis 9 mm above the bed."""
    ring = [(math.sin(math.pi * i / 48), math.cos(math.pi * i / 48)) for i in range(97)]
    triangles = []
    for (s, c), (t, d) in zip(ring, ring[1:]):
        a, b = ([(x, r * p, 9 + r * q) for x, r in ((0, 9), (20, 9), (20, 6), (0, 6))]
                for p, q in ((s, c), (t, d)))
        for k in range(4):
            n = (k + 1) % 4
            triangles += [(a[k], b[n], a[n]), (a[k], b[k], b[n])]
    write(path, triangles)


def write(path, triangles):
    packed = [struct.pack("<12fH", 0, 0, 0, *a, *b, *c, 0) for a, b, c in triangles]
    path.write_bytes(bytes(80) + struct.pack("<I", len(packed)) + b"".join(packed))


def turned(point, axis, degrees):
    s, c = math.sin(math.radians(degrees)), math.cos(math.radians(degrees))
    x, y, z = point
    if axis == "A":
        return x, y * c - z * s, y * s + z * c
    if axis == "B":
        return x * c + z * s, y, z * c - x * s
    return x * c - y * s, x * s + y * c, z


class Move:
    def __init__(self, start, end, e, seconds, tips, top):
        self.start, self.end, self.e, self.seconds, self.tips = start, end, e, seconds, tips
        self.top = top  # mm: of the layer

    def speed(self):
        return math.dist(*self.tips) / self.seconds


def moves_of(text, axes, pivot=(100, 100, 0)):
    """Moves of the axes, with where the tip is over the part before and after."""
    at, feed, top, inverse, found = dict.fromkeys("XYZABC", 0.0), 0, 0, False, []

    def tip():
        point = tuple(at[k] - p for k, p in zip("XYZ", pivot))
        for axis in axes:
            point = turned(point, axis, -at[axis])
        return point

    before, known = tip(), False
    for line in text.splitlines():
        if line in ("G93", "G94"):
            inverse = line == "G93"
        if line.startswith(";Z:"):
            top = float(line[3:])
        if not line.startswith("G1 "):
            continue
        words = {letter: float(number) for letter, number in WORD.findall(line)}
        feed = words.get("F", feed)
        start = dict(at)
        at.update((k, v) for k, v in words.items() if k in at)
        mm = math.dist(*([s[k] for k in "XYZ"] for s in (start, at)))
        degrees = math.dist(*([s[k] for k in "ABC"] for s in (start, at)))
        after = tip()
        if mm + degrees > 0:
            seconds = 60 / feed if inverse else 60 * (mm or degrees) / feed
            if known:
                found.append(Move(start, dict(at), words.get("E", 0), seconds,
                                  (before, after), top))
            known = known or "X" in words
        before = after
    return found


class MoreAxes(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.at = pathlib.Path(folder.name)
        cube(self.at / "cube.stl")
        sleeve(self.at / "sleeve.stl")

    def printed(self, *options):
        subprocess.run([PROGRAM, "-q", "cube.stl", "-o", "x.gcode", "--field",
                        f"sphere:0,0,-{DEEP}", "--skirts", "0", "--no-check-clearance",
                        *options], cwd=self.at, check=True)
        return (self.at / "x.gcode").read_text()

    def check_moves(self, moves, axes):
        """Each at the pace of a role, or as fast as its slowest axis."""
        fastest = {axes[0]: 60, axes[1]: 180, "Z": 12}
        beads, paced = 0, 0
        for move in moves:
            share = max(abs(move.end[a] - move.start[a]) / move.seconds / most
                        for a, most in fastest.items())
            self.assertLess(share, 1.001)
            if move.e <= 0:
                continue
            x, y, z = move.tips[1]
            level = math.dist((x, y, z), (0, 0, -DEEP)) - DEEP
            self.assertLess(abs(level - move.top), 0.006)
            self.assertLess(max(abs(x), abs(y)), SIDE / 2 - 0.1)
            self.assertLess(move.speed(), 80.1)
            beads += 1
            paced += share > 0.97 or any(abs(move.speed() - v) < 0.04 * v
                                         for v in (15, 20, 30, 60, 80))
        self.assertGreater(beads, 2000)
        self.assertGreater(paced, 0.99 * beads)

    def test_tables_turn_the_part_under_the_tip(self):
        for kinematics, tilt in (("table_bc", "B"), ("table_ac", "A")):
            with self.subTest(kinematics):
                text = self.printed("--kinematics", kinematics, "--cooling=0")
                self.check_moves(moves_of(text, tilt + "C"), tilt + "C")

    def test_a_mandrel_turns_the_part_at_its_radius(self):
        """Halfway between two places of the axes, too."""
        subprocess.run([PROGRAM, "-q", "sleeve.stl", "-o", "x.gcode", "--field", "cylinder:x,0,9",
                        "--kinematics", "rotary_a", "--no-check-clearance"], cwd=self.at, check=True)
        moves = moves_of((self.at / "x.gcode").read_text(), "A", (100, 100, 9))
        inner, lines = [], 0
        for move in moves:
            if move.e <= 0:
                continue
            lines += 1
            self.assertLess(abs(move.tips[1][0]), 10)
            for t in (0.5, 1):
                y, z = (move.start[k] + t * (move.end[k] - move.start[k]) for k in "YZ")
                inner.append(math.hypot(y - 100, z - 9) - move.top)
        self.assertGreater(lines, 1000)
        self.assertLess(max(inner) - min(inner), 0.03)  # chords of the layer, field_tolerance
        self.assertLess(abs(sum(inner) / len(inner) - 6), 0.02)

    def test_inverse_time_says_the_same(self):
        usual = moves_of(self.printed("--kinematics", "table_bc"), "BC")
        text = self.printed("--kinematics", "table_bc", "--rotary-feed", "inverse_time",
                            "--gcode-flavor", "reprapfirmware")
        inverse = moves_of(text, "BC")
        self.assertEqual(len(usual), len(inverse))
        for a, b in zip(usual, inverse):
            self.assertEqual((a.end, a.e), (b.end, b.e))
            self.assertLess(abs(a.seconds - b.seconds), 0.02 * a.seconds + 1e-5)
        self.assertTrue(text.rindex("\nG94\n") > text.rindex("\nG93\n"))

    def test_the_printer_takes_as_long_as_estimated(self):
        text = self.printed("--kinematics", "table_bc", "--machine-limits-usage", "emit_to_gcode",
                            "--gcode-flavor", "marlin2")
        said = re.search(r"estimated printing time \(normal mode\) = (?:(\d+)m )?(\d+)s", text)
        estimate = 60 * int(said[1] or 0) + int(said[2])
        shown = subprocess.run([PRINTER, "--run", "x.gcode"], cwd=self.at, check=True, text=True,
                               capture_output=True).stdout
        self.assertIn("faults   0", shown)
        moving = sum(float(s) for s in re.findall(r"(?:extruding|travelling|retracting|lifting) "
                                                  r"([\d.]+) s", shown))
        self.assertLess(abs(moving - estimate), 0.05 * estimate, shown)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
