"""The pictures of the documents can be drawn anew: all of them, each small and well-formed."""

import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
import xml.dom.minidom

ROOT, PROGRAM, SAMPLE = (pathlib.Path(argument).resolve() for argument in sys.argv[1:4])
PICTURES = ROOT / "docs/pictures"
LARGEST = 100 * 1024


class Pictures(unittest.TestCase):
    def test_all_are_drawn_by_the_script(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([sys.executable, "-B", PICTURES / "draw.py", PROGRAM, SAMPLE, folder,
                            "gyroid_sheet", "voxel_file"], check=True, timeout=840)
            drawn = {path.name: path for path in pathlib.Path(folder).iterdir()}
            self.assertEqual({path.name for path in PICTURES.glob("*.svg")}, set(drawn))
            for name, path in drawn.items():
                self.assertGreater(len(xml.dom.minidom.parse(str(path)).getElementsByTagName("path")), 0)
                self.assertLess(path.stat().st_size, LARGEST, name)

    def test_all_are_shown_and_small(self):
        pages = [ROOT / "README.md", *(ROOT / "docs").glob("*.md")]
        shown = set(re.findall(r"\]\((?:docs/)?pictures/([^)]+)\)", "".join(p.read_text() for p in pages)))
        self.assertEqual({path.name for path in PICTURES.glob("*.svg")}, shown)
        for path in PICTURES.glob("*.svg"):
            self.assertLess(path.stat().st_size, LARGEST, path.name)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
