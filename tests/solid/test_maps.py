"""A plain slice maps none of the heavy libraries, nor the modules around them: the program writes into
a pipe that nobody reads until /proc has been looked at."""

import fcntl
import pathlib
import select
import subprocess
import sys
import tempfile
import unittest

sys.path.append(str(pathlib.Path(__file__).parent.parent / "cli"))
from models import turned, write_stl

PROGRAM, SAMPLE = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
HAS_SOLID = sys.argv[3] == "1"
F_SETPIPE_SZ = 1031
HEAVY = ("embree", "openvdb", "tbb", "isoslice-solid", "isoslice-volume", "libpng", "stdc++")


def maps_while_writing(command):
    process = subprocess.Popen(command, stdout=subprocess.PIPE)
    fcntl.fcntl(process.stdout, F_SETPIPE_SZ, 4096)
    select.select([process.stdout], [], [], 120)
    maps = pathlib.Path(f"/proc/{process.pid}/maps").read_text()
    size = len(process.stdout.read())
    process.stdout.close()
    return maps, size, process.wait()


class Maps(unittest.TestCase):
    def maps(self, model, *options):
        maps, size, code = maps_while_writing([PROGRAM, model, "-o", "-", *options])
        self.assertEqual(code, 0)
        self.assertGreater(size, 20000, "the program may have ended before it was looked at")
        self.assertIn("libc.so", maps)
        return maps

    def assert_light(self, maps):
        # A sanitizer's own runtime is C++.
        for name in HEAVY if "san.so" not in maps else HEAVY[:-1]:
            self.assertNotIn(name, maps)

    def test_plain_slice(self):
        with tempfile.TemporaryDirectory() as folder:
            model = pathlib.Path(folder) / "vase.stl"
            write_stl(model, turned([(9, 0), (11, 6), (8, 12)], 64, lobes=5, depth=0.1, twist=0.8))
            self.assert_light(self.maps(model))

    def test_shells_unchecked_and_checked(self):
        with tempfile.TemporaryDirectory() as folder:
            model = pathlib.Path(folder) / "part.stl"
            subprocess.run([SAMPLE, model], check=True, stdout=subprocess.DEVNULL)
            self.assert_light(self.maps(model, "--check-solid", "off"))
            if HAS_SOLID:
                self.assertIn("isoslice-solid.so", self.maps(model, "--check-solid", "full"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
