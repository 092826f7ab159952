"""isoslice contours --field, as a user meets it: links, JSON and pictures of contours in space."""

import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

import numpy

from models import box, write_stl

PROGRAM = pathlib.Path(sys.argv[1]).resolve()
SVG = "{http://www.w3.org/2000/svg}"


class SpaceContours(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.at = pathlib.Path(folder.name)
        write_stl(self.at / "cube.stl", box((-10, -10, 0), (10, 10, 20)))

    def cut(self, *arguments, code=0):
        done = subprocess.run([PROGRAM, "contours", "cube.stl", *arguments], cwd=self.at,
                              capture_output=True)
        self.assertEqual(code, done.returncode, done.stderr.decode())
        return done.stderr.decode()

    def picture(self, *arguments):
        self.cut("--layer-height", "1", "--first-layer-height", "1", "--nozzle-diameter", "2",
                 *arguments, "-o", "cube.svg")
        return xml.etree.ElementTree.parse(self.at / "cube.svg").getroot()

    def test_json_of_cylinders(self):
        self.cut("--field", "cylinder:z,25,0", "-o", "cube.json", "--layer-height", "0.4")
        levels = json.loads((self.at / "cube.json").read_text())["levels"]
        self.assertGreater(len(levels), 30)
        self.cut("-o", "flat.json")
        flat = numpy.array(json.loads((self.at / "flat.json").read_text())["levels"][0]["contours"][0])
        center = (flat.min(axis=0) + flat.max(axis=0)) / 2 + numpy.array([25, 0])
        offset = None
        for level in levels:
            for contour in level["contours"]:
                points = numpy.array(contour)
                far = numpy.hypot(*(points[:, :2] - center).T)
                offset = far[0] - level["r"] if offset is None else offset
                self.assertLess(abs(far - level["r"] - offset).max(), 1e-6)
                self.assertGreaterEqual(points[:, 2].min(), 0)
                self.assertLessEqual(points[:, 2].max(), 20)
        self.assertAlmostEqual(15, offset, delta=1e-3)

    def test_link_and_json_agree(self):
        for ending in "json", "mlk":
            self.cut("--field", "z + 0.02*x^2", "-o", f"cube.{ending}")
        data = (self.at / "cube.mlk").read_bytes()
        points = [p for level in json.loads((self.at / "cube.json").read_text())["levels"]
                  for contour in level["contours"] for p in contour]
        xyz = numpy.array(points)
        g = numpy.ascontiguousarray(xyz).astype("<f8")
        near = [i for i in range(0, len(data) - 24 * len(points) + 1, 8)
                if abs(numpy.frombuffer(data, "<f8", 3, i) - g[0]).max() < 1e-8]
        self.assertTrue(any(abs(numpy.frombuffer(data, "<f8", g.size, i).reshape(g.shape) - g).max()
                            < 1e-8 for i in near))

    def test_flat_in_other_words_is_flat(self):
        for name, field in ("none", []), ("z", ["--field", "z"]), ("plane", ["--field",
                                                                          "plane:0,0,1"]):
            self.cut(*field, "-o", f"{name}.svg")
            self.assertEqual((self.at / "none.svg").read_bytes(),
                             (self.at / f"{name}.svg").read_bytes())

    def test_picture_from_above(self):
        root = self.picture("--field", "cylinder:z,25,0", "--view", "0,90")
        scale = (float(root.get("width")) - 60) / 20
        groups = {g.get("class"): g for g in root.findall(f"{SVG}g")}
        self.assertEqual({"seen", "hidden"}, set(groups))
        for group in groups.values():
            count = 0
            for path in group.findall(f"{SVG}path"):
                radius = 15 + float(path.get("data-r"))
                for x, y in re.findall(r"[ML](-?[\d.]+) (-?[\d.]+)", path.get("d")):
                    # seen from above with x toward the eye's foot: right is y, up is -x
                    across, down = (float(x) - 30) / scale - 10, (float(y) - 30) / scale - 10
                    self.assertAlmostEqual(radius, math.hypot(across, down - 25),
                                           delta=0.03)
                    count += 1
            self.assertGreater(count, 100)

    def test_what_is_behind_is_pale(self):
        """From the front, the back of a cube is hidden and nothing else is."""
        root = self.picture("--field", "plane:0,0.6,0.8", "--view", "-90,0")
        scale = (float(root.get("width")) - 60) / 20
        across = {"seen": 0, "hidden": 0}
        for group in root.findall(f"{SVG}g"):
            for path in group.findall(f"{SVG}path"):
                runs = re.findall(r"M[^M]*", path.get("d"))
                for run in runs:
                    x = [float(p) for p in re.findall(r"[ML](-?[\d.]+) ", run)]
                    if (max(x) - min(x)) / scale > 19:
                        across[group.get("class")] += 1
        self.assertGreater(across["seen"], 15)
        self.assertGreater(across["hidden"], 15)

    def test_the_field_is_named_and_escaped(self):
        root = self.picture("--field", "z + max(x, 0)/9")
        self.assertEqual("z + max(x, 0)/9", root.find(f"{SVG}text").text)

    def test_what_is_refused(self):
        self.assertIn("two angles", self.cut("--view", "30", code=2))
        self.assertIn("two angles", self.cut("--view", "30,100", code=2))
        self.assertIn("no value", self.cut("--field", "sqrt(x)", "-o", "x.svg", code=6))
        self.assertIn("same all over", self.cut("--field", "3", "-o", "x.svg", code=6))
        self.assertFalse((self.at / "x.svg").exists())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
