"""Every command of the guide works: the lines that begin with isoslice, isoprint or isoprint-virtual
(or an echo for one of them) in blocks of shell text in README.md and docs/*.md. They run in the order of their page, in a folder with the
models and settings that the guide speaks of. `# exit code 5` behind a command says how it ends, else
it ends with 0. What has been sliced is printed on the virtual printer, and what is to be printed on
the one behind isoprint's port virtual, as fast as can be."""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

from models import box, dome, moved, plate_with_hole, prism, sleeve, turned, write_stl

ROOT, PROGRAM, PRINTER, HOST = (pathlib.Path(argument).resolve() for argument in sys.argv[1:5])
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
BUILT = re.compile(r"build/release/(engine|firmware-io)/cli/")
COMMAND = re.compile(r"(\w+=\S* )*(isoslice|isoprint|isoprint-virtual|echo \S+ \| isoprint)( |$)")

# What the guide's models are: small, but so that each command has something to do.
MODELS = {
    "part.stl": plate_with_hole(10, 5, 4) + moved(box((0, 0, 0), (6, 6, 9)), 14, -3),
    "core.stl": box((-9, -9, 0), (-2, 9, 9)),
    "side.stl": box((3, -9, 0), (9, 9, 9)),
    "base.stl": box((60, 60, 0), (76, 72, 14)),
    "lid.stl": box((80, 60, 0), (94, 72, 2)),
    "plate.stl": prism([[(x, 0), (x + 8, 0), (x + 4, 7)] for x in (0, 12, 24)], 0, 3),
    "vase.stl": turned([(9, 0), (11, 6), (8, 12)], 32, lobes=5, depth=0.1, twist=0.8),
    "house.stl": plate_with_hole(8, 6, 5) + moved(box((0, -8, 0), (5, 8, 6)), 12, 0),
    "dome.stl": dome(),
    "sleeve.stl": sleeve(),
    "cup.stl": turned([(24, 0), (30, 30), (28, 55)], 48),
    "broken.stl": box((0, 0, 0), (9, 9, 9))[:-2],
}
SETTINGS = {
    "printer.ini": "nozzle_diameter = 0.4\n",
    "filament.ini": "temperature = 210\n",
    "bundle.ini": "[print:fine]\nlayer_height = 0.1\n[filament:pla]\ntemperature = 200\n",
    "start.ini": "start_gcode = G28 ; {if layer_height < 0.2}fine{else}coarse{endif}\\n\n",
}


def commands_of(page):
    """(line, command) of each; a \\ at a line's end goes on on the next."""
    inside, joined, found = False, "", []
    for number, line in enumerate(page.read_text().splitlines(), 1):
        if line.startswith("```"):
            inside = line == "```sh"
        elif inside:
            joined += line.rstrip("\\").rstrip() + " " if line.endswith("\\") else line
            command = BUILT.sub("", joined)
            if not line.endswith("\\"):
                if COMMAND.match(command):
                    found.append((number, command))
                joined = ""
    return found


def anchors_of(page):
    """As GitHub names them."""
    titles = re.findall(r"(?m)^#+ (.*)$", page.read_text())
    return {re.sub(r"[^\w -]", "", title.lower()).replace(" ", "-") for title in titles}


class Guide(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.at = pathlib.Path(folder.name)
        for name, triangles in MODELS.items():
            write_stl(self.at / name, triangles)
        for name, text in SETTINGS.items():
            (self.at / name).write_text(text)
        programs = self.at / "bin"
        programs.mkdir()
        (programs / "isoslice").symlink_to(PROGRAM)
        (programs / "isoprint-virtual").symlink_to(PRINTER)
        (programs / "isoprint").write_text(f'#!/bin/sh\nexec "{HOST}" -q "$@" --virtual speed=0\n')
        (programs / "isoprint").chmod(0o755)
        (self.at / "profiles").symlink_to(ROOT / "profiles")
        self.environment = {k: v for k, v in os.environ.items() if k != "SOURCE_DATE_EPOCH"}
        self.environment["ISOPRINT_PORT"] = "virtual"
        self.environment["PATH"] = f"{programs}:{os.environ['PATH']}"
        for name in ("part.gcode", "earlier.gcode"):
            self.shell(f"isoslice part.stl -o {name}")

    def shell(self, command):
        command = command.replace(" --port auto", "")  # there is none where this runs
        code = re.search(r"# .*exit code (\d+)", command)
        done = subprocess.run(["sh", "-e", "-c", command], cwd=self.at, env=self.environment,
                              capture_output=True, timeout=120)
        self.assertEqual(int(code[1]) if code else 0, done.returncode, done.stderr.decode())
        if not code:
            self.assertEqual(b"", done.stderr, "a command of the guide that warns")

    def print_what_is_new(self, before):
        for path in self.at.glob("*.gcode"):
            if before.get(path) == path.stat().st_mtime_ns:
                continue
            text = path.read_text()
            flavour = re.search(r"(?m)^; gcode_flavor = (\S+)", text)[1]
            size = re.search(r"(?m)^; bed_shape = 0x0,(\d+)x0,\1x(\d+),", text)
            height = re.search(r"(?m)^; max_print_height = (\S+)", text)[1]
            if flavour not in ("marlin", "marlin2"):
                continue
            tools = "2" if re.search(r"(?m)^; lattice_material = \S", text) else "1"
            done = subprocess.run([PRINTER, "--run", path, "--tools", tools, "--bed",
                                   f"{size[1]}x{size[2]}x{height}"],
                                  capture_output=True, timeout=120)
            self.assertEqual(0, done.returncode, done.stderr.decode()[:1000])

    def test_every_command(self):
        count = 0
        for page in PAGES:
            if page.name == "virtual-printer-ci.md":
                continue  # its commands go together: tests/usb/manual.sh runs them
            for line, command in commands_of(page):
                with self.subTest(f"{page.name}:{line}: {command}"):
                    before = {p: p.stat().st_mtime_ns for p in self.at.glob("*.gcode")}
                    self.shell(command)
                    self.print_what_is_new(before)
                count += 1
        self.assertGreater(count, 40)

    def test_macros_of_the_guide(self):
        """What stands under "As `start_gcode`:" and the like is one."""
        for page in PAGES:
            for key, text in re.findall(r"As `(\w+_gcode)`:\n\n```\n(.*?)```", page.read_text(), re.S):
                line = text.strip().replace("\\", "\\\\").replace("\n", "\\n")
                (self.at / "macros.ini").write_text(f"{key} = {line}\n")
                with self.subTest(f"{page.name}, {key}"):
                    self.shell("isoslice part.stl --strict -c macros.ini -o macros.gcode")

    def test_pages_name_files_that_are_there(self):
        """Links and pictures of every page, and the index has every page."""
        for page in PAGES:
            for target, anchor in re.findall(r"\]\(([^)#\s]*)(#[^)]*)?\)", page.read_text()):
                if target.startswith("http"):
                    continue
                path = page.parent / target if target else page
                self.assertTrue(path.exists(), f"{page.name}: {target}")
                if anchor:
                    self.assertIn(anchor[1:], anchors_of(path), f"{page.name}: {target}{anchor}")
        index = (ROOT / "docs/index.md").read_text()
        for page in (ROOT / "docs").glob("*.md"):
            if page.name != "index.md":
                self.assertIn(f"]({page.name})", index)

    def test_names_in_pages_are_those_of_the_source(self):
        """`some_name` is an option, a function, a key of the report ...: the source has it, too."""
        sources = [path for folder in ("engine", "firmware-io") for path in (ROOT / folder).rglob("*")
                   if path.suffix in (".c", ".h", ".inl")]
        known = set(re.findall(r"\w+", " ".join(path.read_text() for path in sources)))
        for page in PAGES:
            named = set(re.findall(r"`([a-z]+(?:_[a-z0-9]+)+)`", page.read_text()))
            self.assertEqual(set(), named - known, page.name)

    def test_how_it_works_names_every_module(self):
        text = (ROOT / "docs/how-it-works.md").read_text()
        for path in (ROOT / "engine/src").iterdir():
            if path.is_dir() or path.suffix == ".c":
                self.assertIn(f"`{path.name}{'/' if path.is_dir() else ''}`", text)
        text = (ROOT / "docs/streaming.md").read_text()
        for path in (ROOT / "firmware-io/src").iterdir():
            self.assertIn(f"`{path.name}/`", text)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
