"""Every profile slices, with every other; nothing in them is unknown, and a printer can run the result."""

import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

from models import box, moved, plate_with_hole, write_stl

ROOT, PROGRAM, PRINTER, SAMPLE = (pathlib.Path(argument).resolve() for argument in sys.argv[1:5])
PRINTERS, FILAMENTS, PRINTS = (sorted((ROOT / "profiles" / kind).glob("*.ini"))
                               for kind in ("printers", "filaments", "prints"))


def settings(path):
    return dict(re.findall(r"(?m)^(\w+) = (.*)$", path.read_text()))


class Profiles(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.at = pathlib.Path(folder.name)

    def slice_with(self, model, *profiles):
        flags = [word for path in profiles for word in ("-c", path)]
        done = subprocess.run([PROGRAM, "--strict", *flags, model, "-o", self.at / "part.gcode",
                               "--report", self.at / "report.json"], capture_output=True, timeout=120)
        self.assertEqual((0, b""), (done.returncode, done.stderr))
        text = (self.at / "part.gcode").read_text()
        wanted = {key: value for path in profiles for key, value in settings(path).items()}
        used = dict(re.findall(r"(?m)^; (\w+) = (.*)$", text[text.index("_config = begin"):]))
        for key, value in wanted.items():
            self.assertEqual(value, used[key], key)
        if wanted["gcode_flavor"] == "marlin2":
            x, y = re.match(r"0x0,(\d+)x0,\1x(\d+),0x\2$", wanted["bed_shape"]).groups()
            done = subprocess.run([PRINTER, "--run", self.at / "part.gcode", "--json", "--bed",
                                   f"{x}x{y}x{wanted['max_print_height']}"],
                                  capture_output=True, timeout=120)
            self.assertEqual((0, ""), (done.returncode, done.stderr.decode()[:1000]))
            limit = float(wanted["filament_max_volumetric_speed"])
            self.assertLess(json.loads(done.stdout)["highest_flow"], 1.15 * limit)
        return text, json.loads((self.at / "report.json").read_text())

    def test_there_are_some_of_each_kind(self):
        for kind in (PRINTERS, FILAMENTS, PRINTS):
            self.assertGreater(len(kind), 1)

    def test_each_goes_with_each(self):
        write_stl(self.at / "part.stl", plate_with_hole(10, 3, 4) + moved(box((0, 0, 0), (6, 6, 5)), 14, -3))
        for printer in PRINTERS:
            for filament in FILAMENTS:
                for kind in PRINTS:
                    with self.subTest(f"{printer.stem}, {filament.stem}, {kind.stem}"):
                        text, report = self.slice_with(self.at / "part.stl", printer, filament, kind)
                        self.assertIn("[g] = ", text)
                        self.assertEqual([], report["warnings"])
                        hot = settings(filament)["first_layer_temperature"]
                        self.assertRegex(text, rf"(?m)^(M109 S{hot}|G10 P0 S{hot})$")

    def test_each_slices_the_sample(self):
        sample = self.at / "sample.stl"
        subprocess.run([SAMPLE, sample], check=True, capture_output=True)
        for i, printer in enumerate(PRINTERS):
            with self.subTest(printer.stem):
                text, report = self.slice_with(sample, printer, FILAMENTS[i % len(FILAMENTS)],
                                               PRINTS[i % len(PRINTS)])
                self.assertEqual([], report["warnings"])
                self.assertGreater(report["print"]["seconds"], 3600)
                self.assertLess(report["print"]["seconds"], 10 * 3600)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
