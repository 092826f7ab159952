"""isoslice lattice, as a user meets it: meshes and volumes that are what the report says, and what is refused."""

import json
import os
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest

import numpy

from models import box, moved, turned, write_stl

PROGRAM = pathlib.Path(sys.argv[1]).resolve()


def read_stl(path):
    data = path.read_bytes()
    count = struct.unpack_from("<I", data, 80)[0]
    assert len(data) == 84 + 50 * count
    rows = numpy.frombuffer(data, numpy.uint8, offset=84).reshape(count, 50)
    return rows[:, 12:48].copy().view("<f4").reshape(count, 3, 3).astype(float)


def volume_of(corners):
    return numpy.einsum("ij,ij->i", corners[:, 0], numpy.cross(corners[:, 1], corners[:, 2])).sum() / 6


def area_of(corners):
    sides = numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return numpy.linalg.norm(sides, axis=1).sum() / 2


class Lattice(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.at = pathlib.Path(folder.name)
        write_stl(self.at / "part.stl", box((30, 5, 2), (42, 17, 12)))

    def run_it(self, *arguments, code=0, **more):
        environment = {**os.environ, **more}
        done = subprocess.run([PROGRAM, *arguments], cwd=self.at, capture_output=True, timeout=250,
                              env=environment)
        self.assertEqual(code, done.returncode, (arguments, done.stderr.decode()))
        self.assertNotIn(b"Sanitizer", done.stderr)
        return done

    def lattice(self, *arguments):
        """The block of the report."""
        done = self.run_it("lattice", "part.stl", *arguments, "--json")
        return json.loads(done.stdout)["lattice"]

    def info(self, name):
        return json.loads(self.run_it("info", "--json", name).stdout)[0]

    def test_a_mesh_is_closed_and_as_porous_as_asked(self):
        told = self.lattice("-o", "out.stl", "--lattice-cell", "4", "--fill-density", "40%", "--voxel", "0.15")
        found = self.info("out.stl")
        self.assertEqual(("mesh", found["triangles"]), (told["output"], told["triangles"]))
        self.assertEqual({0}, {v for k, v in found["defects"].items()})
        self.assertAlmostEqual(0.6, told["porosity"], delta=0.01)
        self.assertAlmostEqual(0.6, told["porosity_asked"], places=9)
        self.assertAlmostEqual(1440, told["part_mm3"], delta=3)
        self.assertAlmostEqual(0.4, found["volume"] / 1440, delta=0.01)
        corners = read_stl(self.at / "out.stl")
        self.assertAlmostEqual(told["material_mm3"], volume_of(corners), delta=0.01 * 1440)
        self.assertAlmostEqual(1, told["surface_mm2"] / area_of(corners), delta=0.03)
        # at the place of the model
        numpy.testing.assert_allclose(corners.reshape(-1, 3).min(0), (30, 5, 2), atol=0.08)
        numpy.testing.assert_allclose(corners.reshape(-1, 3).max(0), (42, 17, 12), atol=0.08)

    def test_the_specific_surface_of_thin_gyroid_sheets(self):
        told = self.lattice("-o", "out.stl", "--lattice-cell", "4", "--fill-density", "20%")
        self.assertAlmostEqual(2 * 3.0915 / 4, told["specific_surface_per_mm"], delta=0.08)
        self.assertAlmostEqual(0.2 * 4 / 3.0915, told["wall_mean_mm"], delta=0.03)
        self.assertGreater(told["wall_smallest_mm"], 0.2)
        sizes = told["pore_size_mm"]
        self.assertLess(sizes["d10"], sizes["d90"])
        self.assertLessEqual(sizes["d90"], sizes["largest"])

    def test_the_same_bytes_every_time(self):
        for name, threads in (("a", "1"), ("b", "3")):
            for ending in ("stl", "vdb"):
                self.run_it("lattice", "part.stl", "--voxel", "0.25", "--fill-density", "40%", "--threads",
                            threads, "-o", f"{name}.{ending}")
        for ending in ("stl", "vdb"):
            self.assertEqual((self.at / f"a.{ending}").read_bytes(), (self.at / f"b.{ending}").read_bytes())

    def test_a_volume_can_be_the_cell_of_another_lattice(self):
        told = self.lattice("-o", "out.vdb", "--fill-density", "40%", "--voxel", "0.2")
        self.assertEqual("distance", told["output"])
        self.assertIn(b"lattice", (self.at / "out.vdb").read_bytes())
        self.run_it("lattice", "part.stl", "--fill-pattern", "voxel_file", "--lattice-file", "out.vdb",
                    "--lattice-cell", "12", "--voxel", "0.3", "--fill-density", "40%", "-o", "again.stl")

    def test_a_skin_closes_and_a_drain_opens(self):
        base = ["--fill-pattern", "octet_struts", "--fill-density", "30%", "--voxel", "0.2",
                "--lattice-skin", "1"]
        done = self.run_it("lattice", "part.stl", *base, "--lattice-open", "-o", "out.stl", code=8)
        self.assertIn(b"closed", done.stderr)
        self.assertFalse((self.at / "out.stl").exists())
        closed = self.lattice(*base, "-o", "closed.stl")
        self.assertEqual(1, closed["closed_pores"])
        self.assertAlmostEqual(0.7 * 10 * 10 * 8, closed["closed_mm3"], delta=50)
        self.assertEqual(2, self.info("closed.stl")["shells"])
        opened = self.lattice(*base, "--lattice-open", "--lattice-drain", "1,1", "-o", "open.stl")
        self.assertEqual(0, opened["closed_pores"])
        self.assertEqual(1, self.info("open.stl")["shells"])
        self.assertAlmostEqual(closed["porosity"], opened["porosity"], delta=0.01)

    def test_pieces_that_hold_to_nothing_are_gone(self):
        write_stl(self.at / "part.stl", turned([(3, 0), (7, 4), (2, 12)]))
        told = self.lattice("-o", "out.stl", "--lattice-cell", "5", "--fill-density", "20%", "--voxel", "0.12")
        self.assertEqual(told["pieces"] - told["pieces_removed"], 1)
        self.assertEqual(1, self.info("out.stl")["shells"])

    def test_bodies_of_a_part_keep_a_piece_each(self):
        write_stl(self.at / "part.stl", box((0, 0, 0), (8, 8, 8)) + moved(box((0, 0, 0), (8, 8, 8)), 12, 0))
        told = self.lattice("-o", "out.stl", "--lattice-cell", "4", "--fill-density", "40%", "--voxel", "0.2")
        self.assertEqual(told["pieces"] - told["pieces_removed"], 2)
        self.assertEqual(2, self.info("out.stl")["shells"])

    def test_gcode_has_the_lattice_alone(self):
        told = self.lattice("-o", "out.gcode", "--lattice-cell", "6", "--fill-density", "40%")
        self.assertEqual("gcode", told["output"])
        text = (self.at / "out.gcode").read_text()
        self.assertIn("\n; fill_pattern = gyroid_sheet\n", text)
        self.assertIn(";TYPE:Internal infill", text)
        self.assertNotIn("erimeter\n", text)
        self.assertNotIn(";TYPE:Solid", text)
        self.lattice("-o", "skin.gcode", "--lattice-cell", "6", "--lattice-skin", "0.8")
        self.assertIn("erimeter\n", (self.at / "skin.gcode").read_text())

    def test_walls_thinner_than_beads_are_told(self):
        """5 % of cells of 3 mm are walls of 0.05 mm."""
        for density, cell, code in (("5%", "3", ["lattice-thin"]), ("25%", "4", [])):
            self.run_it("lattice", "part.stl", "-o", "out.gcode", "--lattice-cell", cell, "--fill-density",
                        density, "--report", "out.json")
            report = json.loads((self.at / "out.json").read_text())
            self.assertEqual(code, [w["code"] for w in report["warnings"]])

    def test_gcode_without_modules(self):
        """Beside a program that is by itself there is none."""
        alone = self.at / "alone"
        alone.mkdir()
        shutil.copy(PROGRAM, alone / "isoslice")
        def run(code, *arguments):
            done = subprocess.run([alone / "isoslice", "lattice", "part.stl", *arguments], cwd=self.at,
                                  capture_output=True, timeout=250)
            self.assertEqual(code, done.returncode, done.stderr.decode())
            return done.stderr.decode()
        self.assertIn("[lattice-not-analysed]", run(0, "-o", "out.gcode"))
        self.assertIn("lattice_open", run(6, "-o", "out.gcode", "--lattice-open"))
        self.assertIn("isoslice-", run(6, "-o", "out.stl"))

    def test_what_needs_a_module_says_which_and_leaves_nothing(self):
        alone = self.at / "alone"
        alone.mkdir()
        shutil.copy(PROGRAM, alone / "isoslice")
        sheet = ("--fill-pattern", "gyroid_sheet")
        for code, missing, *arguments in (
                (0, "", *sheet, "--quiet"),
                (0, "", *sheet, "--quiet", "--lattice-map", "cylinder", "--lattice-density", "10 + z"),
                (6, "isoslice-solid.so", *sheet, "--lattice-map", "skin"),
                (6, "isoslice-solid.so", *sheet, "--lattice-density", "10 * skin"),
                (6, "isoslice-volume.so", *sheet, "--lattice-density", "grid", "--lattice-grid", "none.vdb"),
                (6, "isoslice-volume.so", "--fill-pattern", "voxel_file", "--lattice-file", "none.vdb"),
                (6, "isoslice-volume.so", "--fill-pattern", "voxel_file", "--lattice-file", "none%d.png"),
                (6, "isoslice-volume.so", "--repair", "volume"),
                (6, "isoslice-solid.so", "--check-solid", "full")):
            done = subprocess.run([alone / "isoslice", "part.stl", "-o", "out.gcode", *arguments], cwd=self.at,
                                  capture_output=True, timeout=250,
                                  env={**os.environ, "ISOSLICE_MODULES": "/nonexistent"})
            said = done.stderr.decode()
            self.assertEqual(code, done.returncode, (arguments, said))
            self.assertIn(missing, said)
            self.assertEqual(code != 0, "install it" in said and "ISOSLICE_MODULES" in said, said)
            self.assertEqual(code == 0, (self.at / "out.gcode").exists())
            (self.at / "out.gcode").unlink(missing_ok=True)

    def test_damaged_files_are_refused(self):
        """Cut off anywhere, or with bytes that are others: read or refused as damaged."""
        self.run_it("lattice", "part.stl", "-o", "cell.vdb", "--voxel", "0.8", "--quiet")
        whole = (self.at / "cell.vdb").read_bytes()
        random = numpy.random.default_rng(7)
        # OpenVDB leaks what it has read so far of a damaged file.
        environment = {**os.environ, "ASAN_OPTIONS": os.environ.get("ASAN_OPTIONS", "") + ":detect_leaks=0"}
        for case in range(9):
            bad = bytearray(whole)
            if case % 3 == 0:
                bad = bad[:int(random.integers(len(bad)))]
            else:
                for _ in range(8):
                    bad[int(random.integers(len(bad)))] = int(random.integers(256))
            (self.at / "bad.vdb").write_bytes(bad)
            done = subprocess.run([PROGRAM, "part.stl", "--quiet", "-o", "out.gcode", "--fill-pattern", "voxel_file",
                                   "--lattice-file", "bad.vdb"], cwd=self.at, capture_output=True, timeout=250,
                                  env=environment)
            said = done.stderr.decode(errors="replace")
            self.assertIn(done.returncode, (0, 3) if case % 3 else (3,), said)
            self.assertNotIn("Sanitizer", said)
            if done.returncode:
                self.assertIn("bad.vdb", said)

    def test_what_is_refused(self):
        write_stl(self.at / "broken.stl", box((0, 0, 0), (9, 9, 9))[:-2])
        for code, fragment, *arguments in (
                (2, "no model", "-o", "out.stl"),
                (2, "-o", "part.stl"),
                (2, "out.obj", "part.stl", "-o", "out.obj"),
                (2, "take the place", "part.stl", "-o", "part.stl"),
                (2, "--voxel", "part.stl", "-o", "out.stl", "--voxel", "fine"),
                (2, "report", "part.stl", "-o", "out.stl", "--report", "out.stl"),
                (3, "nowhere.stl", "nowhere.stl", "-o", "out.stl"),
                (4, "broken.stl", "broken.stl", "-o", "out.stl"),
                (6, "fill_pattern", "part.stl", "-o", "out.stl", "--fill-pattern", "grid"),
                (6, "lattice_skin", "part.stl", "-o", "out.stl", "--lattice-drain", "0,0"),
                (6, "lattice_cell", "part.stl", "-o", "out.stl", "--lattice-cell", "x +"),
                (6, "without a unit", "part.stl", "-o", "out.stl", "--lattice-density", "30%"),
                (7, "nowhere", "part.stl", "-o", "nowhere/out.stl", "--voxel", "0.4"),
                (69, "GB", "part.stl", "-o", "out.stl", "--voxel", "0.001")):
            before = sorted(self.at.rglob("*"))
            done = self.run_it("lattice", *arguments, code=code)
            message = done.stderr.decode().splitlines()[-1]
            self.assertIn(fragment, message)
            self.assertTrue(message.startswith("isoslice: "), message)
            self.assertEqual(before, sorted(self.at.rglob("*")), "a failure left something behind")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[2:], verbosity=1)
