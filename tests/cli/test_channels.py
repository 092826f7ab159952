"""isoslice channels, as a user meets it: bodies and moulds that are what the report says, and what is refused."""

import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
import xml.dom.minidom

import numpy

from models import box, turned, write_stl

PROGRAM = pathlib.Path(sys.argv[1]).resolve()
LOOK = ["--pitch", "20", "--depth", "10", "--section", "round:8"]


def read_stl(path):
    data = pathlib.Path(path).read_bytes()
    count = int.from_bytes(data[80:84], "little")
    assert len(data) == 84 + 50 * count
    rows = numpy.frombuffer(data, numpy.uint8, offset=84).reshape(count, 50)
    return rows[:, 12:48].copy().view("<f4").reshape(count, 3, 3).astype(float)


def volume_of(corners):
    return numpy.einsum("ij,ij->i", corners[:, 0], numpy.cross(corners[:, 1], corners[:, 2])).sum() / 6


def is_closed(corners):
    """Each edge is there as often one way as the other, once."""
    points, ids = numpy.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    ids = ids.reshape(-1, 3)
    edges = numpy.concatenate([ids[:, [0, 1]], ids[:, [1, 2]], ids[:, [2, 0]]])
    there = edges[:, 0] * len(points) + edges[:, 1]
    back = edges[:, 1] * len(points) + edges[:, 0]
    return len(numpy.unique(there)) == len(there) and set(there) == set(back)


class Channels(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.at = pathlib.Path(folder.name)
        write_stl(self.at / "part.stl", turned([(30, 0), (10, 40)], 96))

    def run_it(self, *arguments, code=0):
        environment = {k: v for k, v in os.environ.items() if k != "SOURCE_DATE_EPOCH"}
        done = subprocess.run([PROGRAM, *arguments], cwd=self.at, capture_output=True, timeout=250,
                              env=environment)
        self.assertEqual(code, done.returncode, (arguments, done.stderr.decode()))
        self.assertNotIn(b"Sanitizer", done.stderr)
        return done

    def channels(self, *arguments, model="part.stl"):
        """The block of the report."""
        done = self.run_it("channels", model, *LOOK, *arguments, "--json")
        return json.loads(done.stdout)["channels"]

    def test_channels_and_mould_by_the_name_of_the_file(self):
        found = self.channels("-o", "channels.stl")
        bodies = read_stl(self.at / "channels.stl")
        self.assertTrue(is_closed(bodies))
        self.assertEqual(found["triangles"], len(bodies))
        self.assertAlmostEqual(1, volume_of(bodies) / found["volume_mm3"], 6)
        area = 16 * 32 / 2 * math.sin(2 * math.pi / 32)  # of a polygon in a circle of 4 mm
        self.assertAlmostEqual(1, found["volume_mm3"] / (area * found["length_mm"]), 3)
        self.assertLess(abs(found["volume_mm3"] / (area * found["length_mm"]) - 1), 2e-4)

        found = self.channels("-o", "mould.stl")
        mould = read_stl(self.at / "mould.stl")
        self.assertTrue(is_closed(mould))
        size = numpy.subtract(found["mould_max"], found["mould_min"])
        part = volume_of(read_stl(self.at / "part.stl"))
        self.assertAlmostEqual(1, found["part_mm3"] / part, 5)
        expected = size.prod() - part - volume_of(bodies)
        self.assertLess(abs(volume_of(mould) / expected - 1), 5e-6)
        numpy.testing.assert_allclose(found["mould_min"], mould.min((0, 1)), atol=1e-4)
        numpy.testing.assert_allclose(found["mould_max"], mould.max((0, 1)), atol=1e-4)

        info = json.loads(self.run_it("info", "--json", "mould.stl").stdout)[0]
        self.assertEqual(2, info["shells"])  # the outside with all channels, and the part
        self.assertEqual(0, sum(v for v in info["defects"].values()))

    def test_write_wins_over_the_name(self):
        self.run_it("channels", "part.stl", "-o", "a.stl", "--write", "mould")
        self.run_it("channels", "part.stl", "-o", "Mold-7.STL")
        self.run_it("channels", "part.stl", "-o", "mould-2.stl", "--write", "channels")
        self.run_it("channels", "part.stl", "-o", "b.stl")
        files = [(self.at / name).read_bytes() for name in ("a.stl", "Mold-7.STL", "mould-2.stl", "b.stl")]
        self.assertEqual(files[0], files[1])
        self.assertEqual(files[2], files[3])
        self.assertNotEqual(files[0], files[3])
        folder = self.at / "moulds"
        folder.mkdir()
        self.run_it("channels", "part.stl", "-o", "moulds/x.stl")  # a folder's name says nothing
        self.assertEqual(files[3], (folder / "x.stl").read_bytes())
        done = self.run_it("channels", "part.stl", "-o", "-")
        self.assertEqual(files[3], done.stdout)

    def test_pitches_are_those_of_the_cone(self):
        found = self.channels("-o", "x.svg", "--pitch", "8", "--section", "round:4", "--ports", "none")
        slope = math.sqrt(1.25)
        self.assertEqual(6, len(found["rings"]))
        for i, ring in enumerate(found["rings"]):
            self.assertAlmostEqual((4 + 8 * i) / slope, ring["z_mm"], 2)
            self.assertAlmostEqual(4 + 8 * i, ring["measured_mm"], 2)
        self.assertLess(found["pitch_error_max"], 1e-4)
        self.assertLess(abs(found["pitch_error_total"]), 1e-4)
        self.assertAlmostEqual(8, found["wall_to_part"]["mm"], 1)
        self.assertAlmostEqual(4, found["wall_between"]["mm"], 1)

    def test_pointwise_is_nearer_to_the_surface_than_planar(self):
        def leaning(p):
            return (p[0] + 0.45 * p[2], p[1], p[2])

        write_stl(self.at / "slant.stl", [[leaning(p) for p in t] for t in
                                          turned([(30 - z / 2, z) for z in range(0, 41)], 120)])
        error = {mode: self.channels("-o", "x.svg", "--mode", mode, "--pitch", "12", "--section", "round:4",
                                     "--ports", "none", model="slant.stl")["height_error_rms"]
                 for mode in ("planar", "pointwise", "geodesic")}
        self.assertGreater(error["planar"], 0.05)
        self.assertLess(error["pointwise"], 0.005)
        self.assertLess(error["geodesic"], 0.025)  # of another distance, but nearly the same

    def test_a_link_of_middles(self):
        found = self.channels("-o", "x.mlk", "--ports", "series")
        self.assertEqual(1, found["count"])
        data = (self.at / "x.mlk").read_bytes()
        self.assertGreater(len(data), 100 * (24 + 4 + 4))

    def test_pictures(self):
        for ports in ("none", "parallel", "series"):
            self.run_it("channels", "part.stl", *LOOK, "--ports", ports, "-o", f"{ports}.svg")
            drawn = xml.dom.minidom.parse(str(self.at / f"{ports}.svg")).getElementsByTagName("path")
            self.assertGreater(len(drawn), 500)

    def test_ports_are_on_the_side_that_is_asked_for(self):
        for side, axis, end in (("left", 0, 0), ("right", 0, 1), ("front", 1, 0), ("back", 1, 1)):
            found = self.channels("-o", "channels.stl", "--side", side)
            bodies = read_stl(self.at / "channels.stl")
            face = (found["mould_min"], found["mould_max"])[end][axis]
            there = numpy.unique(bodies.reshape(-1, 3)[abs(bodies.reshape(-1, 3)[:, axis] - face) < 1e-5], axis=0)
            self.assertEqual(4 * 32, len(there))

    def test_a_box(self):
        write_stl(self.at / "part.stl", box((10, 20, 5), (70, 60, 55)))
        found = self.channels("-o", "mould.stl")
        self.assertTrue(is_closed(read_stl(self.at / "mould.stl")))
        self.assertEqual(2, found["count"])
        numpy.testing.assert_allclose([15, 35], [ring["z_mm"] for ring in found["rings"]], atol=1e-3)

    def test_the_same_bytes(self):
        for name in ("mould-1.stl", "mould-2.stl"):
            self.run_it("channels", "part.stl", "--ports", "series", "-o", name)
        self.assertEqual((self.at / "mould-1.stl").read_bytes(), (self.at / "mould-2.stl").read_bytes())

    def test_refusals(self):
        for code, word, *arguments in (
                (2, "-o", "part.stl"),
                (2, "no file", "-o", "x.stl"),
                (2, "more than one", "part.stl", "part.stl", "-o", "x.stl"),
                (2, ".stl, .mlk or .svg", "part.stl", "-o", "x.gcode"),
                (2, "take the place", "part.stl", "-o", "part.stl"),
                (2, "report", "part.stl", "-o", "x.stl", "--report", "x.stl"),
                (2, "section", "part.stl", "-o", "x.stl", "--section", "round"),
                (2, "section", "part.stl", "-o", "x.stl", "--sides", "2"),
                (2, "--pitch", "part.stl", "-o", "x.stl", "--pitch", "wide"),
                (2, "--mode", "part.stl", "-o", "x.stl", "--mode", "cubic"),
                (2, "none, parallel, series", "part.stl", "-o", "x.stl", "--ports", "two"),
                (2, "--side", "part.stl", "-o", "x.stl", "--side", "up"),
                (2, "--write", "part.stl", "-o", "x.stl", "--write", "all"),
                (2, "--write", "part.stl", "-o", "x.svg", "--write", "mould"),
                (2, "layer-height", "part.stl", "-o", "x.stl", "--layer-height", "0.2"),
                (3, "nothing.stl", "nothing.stl", "-o", "x.stl"),
                (4, "no channel", "part.stl", "-o", "x.stl", "--pitch", "200"),
                (6, "pitch", "part.stl", "-o", "x.stl", "--pitch", "0"),
                (6, "depth", "part.stl", "-o", "x.stl", "--depth", "3"),
                (6, "levels", "part.stl", "-o", "x.stl", "--levels", "1"),
                (7, "", "part.stl", "-o", "nowhere/x.stl"),
                (8, "wall to the part at (", "part.stl", "-o", "x.stl", "--wall", "7"),
                (8, "between them at (", "part.stl", "-o", "x.stl", "--pitch", "10"),
                (8, "bends by a radius", "part.stl", "-o", "x.stl", "--bend", "50", "--ports", "none")):
            with self.subTest(" ".join(arguments)):
                done = self.run_it("channels", *arguments, code=code)
                self.assertIn(word, done.stderr.decode())
                self.assertFalse((self.at / "x.stl").exists())

    def test_a_refusal_has_its_report(self):
        self.run_it("channels", "part.stl", "-o", "x.stl", "--wall", "7", "--report", "r.json", code=8)
        report = json.loads((self.at / "r.json").read_text())
        self.assertEqual(8, report["status"])
        self.assertAlmostEqual(6, report["channels"]["wall_to_part"]["mm"], 1)

    def test_help_has_every_flag_with_its_range(self):
        text = " ".join(self.run_it("channels", "--help").stdout.decode().split())
        for flag in ("pitch", "depth", "section", "sides", "mode", "start", "levels", "samples", "holes",
                     "ports", "side", "margin", "wall", "bend", "write", "report", "json"):
            self.assertIn(f"--{flag} ", text)
        self.assertNotIn("--layer-height", text)
        self.assertIn("0.1 to 1000", text)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
