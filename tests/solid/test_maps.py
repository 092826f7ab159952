"""A plain slice maps none of the heavy libraries, nor the modules around them: the program writes into
a pipe that nobody reads until /proc has been looked at."""

import fcntl
import pathlib
import select
import subprocess
import sys
import tempfile
import unittest

PROGRAM, SAMPLE = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
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
    def test_plain_slice(self):
        with tempfile.TemporaryDirectory() as folder:
            model = pathlib.Path(folder) / "part.stl"
            subprocess.run([SAMPLE, model], check=True)
            maps, size, code = maps_while_writing([PROGRAM, model, "-o", "-"])
        self.assertEqual(code, 0)
        self.assertGreater(size, 20000, "the program may have ended before it was looked at")
        self.assertIn("libc.so", maps)
        # A sanitizer's own runtime is C++.
        for name in HEAVY if "san.so" not in maps else HEAVY[:-1]:
            self.assertNotIn(name, maps)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
