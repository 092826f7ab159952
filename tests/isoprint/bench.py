"""What the tests of isoprint stand on: a job, the program, and a printer that isn't one."""

import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest

PROGRAM, PRINTER, ROOT = (pathlib.Path(argument).resolve() for argument in sys.argv[1:4])
LONG = int(os.environ.get("ISOPRINT_PATIENCE", "240"))  # s: nothing is waited for longer


def job(layers=10, moves=40):
    """A print of `layers` layers as a slicer would write it."""
    lines = ["; a job", "G28", "M104 S60", "M83", "G92 E0", "G1 X50 Y50 Z5 F6000"]
    for layer in range(layers):
        lines += [";LAYER_CHANGE", f"G1 Z{0.2 * (layer + 1):.2f} F600"]
        lines += [f"G1 X{50 + move % 7} Y{60 + move % 11} F{3000 + layer}" for move in range(moves)]
    return "\n".join(lines + ["M104 S0", "M140 S0", "M84", ""])


def commands(text):
    """What of a file is to be executed."""
    bare = (line.split(";")[0].strip() for line in text.splitlines())
    return [line for line in bare if line]


HOST = re.compile(r"^M0*(110|115|118|155|105|400|114)\b")


def executed(path):
    """The lines of the job that the printer made, as its own log has them. A line whose N was damaged
    is an unknown command to it, and does nothing."""
    return [line for line in path.read_text(errors="replace").splitlines()
            if re.match("[GMT][0-9]", line) and not HOST.match(line)]


class Bench(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.at = pathlib.Path(folder.name)
        self.environment = {k: v for k, v in os.environ.items() if k != "ISOPRINT_PORT"}
        self.text = job()
        (self.at / "part.gcode").write_text(self.text)

    def run_it(self, *arguments, code=0, **more):
        environment = {**self.environment, **more.pop("env", {})}
        more.setdefault("stdin", subprocess.DEVNULL) if "input" not in more else None
        done = subprocess.run([PROGRAM, *arguments], cwd=self.at, capture_output=True, timeout=LONG,
                              env=environment, **more)
        self.assertNotIn(b"Sanitizer", done.stderr, done.stderr.decode(errors="replace"))
        self.assertEqual(code, done.returncode, (arguments, done.stderr.decode(errors="replace")))
        return done

    def fails(self, code, fragment, *arguments, **more):
        """The message names what is wrong."""
        message = self.run_it(*arguments, code=code, **more).stderr.decode()
        self.assertIn(fragment, message)
        self.assertTrue(message.startswith("isoprint: "), message)
        return message

    def virtual(self, *arguments, options="speed=0", **more):
        return self.run_it(*arguments, "--port", "virtual", "--virtual", options, **more)

    def printer(self, *options):
        """A printer on a pseudo terminal; returns its port. self.printed() ends it."""
        link = self.at / "printer"
        if hasattr(self, "process"):
            self.process.kill()
            self.process.wait()
            link.unlink(missing_ok=True)
        # its summary and its own verdict go to files: pipes that nobody reads could fill up
        with open(self.at / "summary", "wb") as summary:
            self.process = subprocess.Popen(
                [PRINTER, "--pty", link, "--executed", self.at / "executed", "--json", *options],
                cwd=self.at, stdout=summary, stderr=subprocess.STDOUT, env=self.environment)
        self.addCleanup(self.process.wait)
        self.addCleanup(self.process.kill)
        self.until(link.exists, "the printer never came")
        return f"tty:{link}"

    def printed(self):
        """The summary of the printer."""
        self.process.terminate()
        self.process.wait(timeout=LONG)
        text = (self.at / "summary").read_text()
        self.assertNotIn("Sanitizer", text)
        return json.loads(text[text.index("{"):text.rindex("}") + 1])

    def start(self, *arguments, **more):
        process = subprocess.Popen([PROGRAM, *arguments], cwd=self.at, env=self.environment,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                   stdin=more.pop("stdin", subprocess.DEVNULL), **more)
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.kill)
        return process

    def end(self, process, code):
        out, err = process.communicate(timeout=LONG)
        self.assertNotIn(b"Sanitizer", err, err.decode(errors="replace"))
        self.assertEqual(code, process.returncode, err.decode(errors="replace"))
        return out.decode(), err.decode()

    def until(self, condition, what):
        end = time.monotonic() + LONG
        while not condition():
            self.assertLess(time.monotonic(), end, what)
            time.sleep(0.01)

    def lines_made(self):
        path = self.at / "executed"
        return len(executed(path)) if path.exists() else 0


def events(text):
    return [json.loads(line) for line in text.splitlines()]


def main():
    unittest.main(module="__main__", argv=sys.argv[:1] + sys.argv[4:], verbosity=1)
