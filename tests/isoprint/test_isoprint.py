"""isoprint as a user or a script meets it: flags, exit codes, messages, what reaches the printer."""

import os
import re
import resource
import subprocess
import threading

from bench import LONG, PRINTER, PROGRAM, ROOT, Bench, commands, events, executed, job, main

FLAGS = (ROOT / "firmware-io/cli/flags.inl").read_text()


class CommandLine(Bench):
    def test_help_names_every_flag_with_its_range(self):
        text = self.run_it("--help").stdout.decode()
        flags = re.findall(r"(?m)^FIO_FLAG\(\s*(\w+), ", FLAGS)
        self.assertGreater(len(flags), 25)
        for flag in flags:
            self.assertIn("--" + flag.replace("_", "-"), text)
        for fragment in ("1200 to 4000000", "0 to 86400", "1 to 64 lines", "Exit codes:", "Keys"):
            self.assertIn(fragment, " ".join(text.split()))
        self.assertLessEqual(max(map(len, text.splitlines())), 100)
        self.assertFalse([line for line in text.splitlines() if line.endswith(" ")])

    def test_the_manual_page_is_what_the_program_prints(self):
        self.assertEqual((ROOT / "docs/isoprint.1").read_text(), self.run_it("--man").stdout.decode(),
                         "make it anew: isoprint --man > docs/isoprint.1")

    def test_version(self):
        self.assertRegex(self.run_it("--version").stdout.decode(), r"^isoprint \d+\.\d+\.\d+\n$")

    def test_unknown_flags_suggest_the_nearest(self):
        for given, meant in (("--prot", "--port"), ("--resume_form", "--resume-from"),
                             ("--quite", "--quiet"), ("--dryrun", "--dry-run")):
            self.assertIn(f"is it {meant}?", self.fails(2, given, given, "part.gcode"))
        self.assertIn("see --help", self.fails(2, "-z", "-z"))

    def test_values_out_of_range_say_the_range(self):
        for arguments, fragment in (
                (("--baud", "100"), "1200 to 4000000"), (("--baud", "fast"), "--baud fast"),
                (("--wait", "-1"), "0 to 86400"), (("--window", "65"), "1 to 64 lines"),
                (("--window", "4:8"), "16 to 65536"), (("-n", "--bed", "10x10"), "XxYxZ"),
                (("--upload", "a b"), "without blanks"), (("--upload", "a" * 65), "64 characters"),
                (("--firmware", "windows"), "Marlin"), (("--port",), "PORT is due"),
                (("--log", "--json"), "FILE is due"),
                (("--json=1",), "takes no value"), (("--send", "M105\nM112"), "without line ends")):
            self.fails(2, fragment, *(arguments if arguments[0] == "--send" else
                                      ("part.gcode", *arguments)))

    def test_contradictions_name_both(self):
        for arguments, fragment in ((("--list", "--console"), "--list and --console"),
                                    (("a", "b"), "a and b"), (("part.gcode", "--probe"), "--list"),
                                    (("part.gcode", "--start"), "--upload"),
                                    (("x", "--console"), "takes no file"), ((), "no file given"),
                                    (("--resume-from", "12"), "which file"),
                                    (("part.gcode", "--bed", "9x9x9"), "--dry-run")):
            self.fails(2, fragment, *arguments)

    def test_a_port_that_is_none(self):
        for port, code, fragment in (("nonsense", 2, "usb:VID:PID"), ("virtual:none", 3, "none"),
                                     ("tty:/dev/none", 9, "/dev/none"), ("socket:none", 9, "none"),
                                     ("tcp:localhost:1", 9, "localhost"),
                                     ("usb:ffff:ffff", 9, "ffff:ffff")):
            self.fails(code, fragment, "part.gcode", "--port", port)
        for port, meant in (("/dev/ttyUSB0", "tty:/dev/ttyUSB0"), ("ttyACM1", "tty:/dev/ttyACM1")):
            self.fails(2, f"is it {meant}?", "part.gcode", "--port", port)
        for port in ("99999", "0"):
            self.fails(2, "from 1 to 65535", "part.gcode", "--port", f"tcp:localhost:{port}")
        self.assertFalse((self.at / "part.gcode.journal").exists())
        self.fails(2, "speed=x", "part.gcode", "--port", "virtual", "--virtual", "speed=x")

    def test_the_environment_names_a_port(self):
        self.fails(9, "/dev/none", "part.gcode", env={"ISOPRINT_PORT": "tty:/dev/none"})

    def test_the_printer_names_the_place_in_its_script(self):
        (self.at / "script").write_text("at line 5 reset\n# and\n")
        for arguments, line in ((("--do", "at lin 9 reset"), 1),
                                (("--script", "script", "--do", "at lin 9 reset"), 3)):
            done = subprocess.run([PRINTER, "--pty", "p", *arguments, "--", "true"], cwd=self.at,
                                  capture_output=True, timeout=LONG)
            self.assertEqual(2, done.returncode)
            self.assertIn(f"script, line {line}, column 4".encode(), done.stderr)

    def test_waiting_for_a_port(self):
        self.fails(9, "did not appear within 1 s", "part.gcode", "--port", "tty:/dev/none", "-w", "1")
        process = self.start("--send", "M114", "--port", f"tty:{self.at}/printer", "--wait", "100")
        self.printer("--speed", "instant")
        self.assertIn("X:", self.end(process, 0)[0])


class Jobs(Bench):
    def refused(self, code, fragment, text, name="bad.gcode"):
        (self.at / name).write_text(text)
        for arguments in ((name, "--port", "virtual"), ("--dry-run", name)):
            self.assertIn(fragment, self.fails(code, name, *arguments))

    def test_what_is_no_job(self):
        self.fails(3, "none.gcode", "none.gcode", "--port", "virtual")
        self.fails(3, ".", ".", "--port", "virtual")
        for text in ("", "\n\n", "; only\n; comments\n"):
            self.refused(3, "no command", text)
            self.fails(3, "no command", "-", "--port", "virtual", input=text.encode(), stdin=None)

    def test_what_is_something_else(self):
        """Taken for G-code, a model would be "printed", each of its lines unknown to the firmware."""
        stl = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
        for text, fragment in ((stl, "isoslice bad.gcode -o"),
                               ("v 0 0 0\nv 1 0 0\nf 1 2 3\n", "not G-code"), ("%PDF-1.4\n", "not G-code"),
                               ("[print]\nlayer_height = 0.2\n", "not G-code"),
                               ('{"a": 1}\n', "not G-code"), ("<svg/>\n", "not G-code"),
                               ("\x1f\b", "gunzip"), ("PK\x03\x04", "3MF")):
            self.refused(3, fragment, text)
        self.fails(3, "slice it first", "-", "--port", "virtual", input=stl.encode(), stdin=None)
        self.fails(3, "slice it first", "-n", "-", input=stl.encode(), stdin=None)

    def test_jobs_of_few_and_strange_commands(self):
        """Each would be refused if it were not G-code to somebody: Marlin, Klipper, grbl."""
        for text in ("g28", "G 28", "T0", "X10", "M117 hello", "N1 G28*18", "START_PRINT BED=60",
                     "start_print\nG28"):
            (self.at / "few.gcode").write_text(text + "\n")
            self.virtual("few.gcode", "-q")

    def test_what_a_job_must_not_hold_is_named_with_its_line(self):
        for command in ("M110 N5", "M112", "M28 a.g", "M29", "M410", "M999", "m112", "M0112"):
            self.refused(8, f"bad.gcode:3: a job must not hold {command}", f"G28\n;\n{command}\nG28\n")
        self.refused(8, "bad.gcode:2", "G28\nG1 " + "X1 Y1 " * 40 + "\n")

    def test_such_commands_in_a_pipe_end_the_job_safely(self):
        process = self.start("-", "--port", self.printer("--speed", "instant"), "-q",
                             stdin=subprocess.PIPE)
        process.stdin.write(b"G28\nM104 S60\nG1 X10 F6000\nM112\nG1 X20\n")
        process.stdin.close()
        process.stdin = None
        self.assertIn("standard input:4: a job must not hold M112", self.end(process, 8)[1])
        printed = self.printed()
        self.assertEqual(0, printed["fault_count"], "heaters left on, or halted")
        self.assertNotIn("G1 X20", executed(self.at / "executed"))

    def test_a_dry_run_measures_the_job(self):
        (self.at / "a.gcode").write_text("G28\nM109 S200\nM83\nG1 X10 Y20 Z0.2 F6000\n"
                                         "G1 X110 E5 F1200\nM104 S0\nM84\n")
        text = self.run_it("-n", "a.gcode").stdout.decode()
        self.assertIn("7 commands, 1 layers", text)
        self.assertIn("x 10.00 to 110.00, y 20.00 to 20.00", text)
        found = events(self.run_it("-n", "a.gcode", "--json").stdout.decode())
        self.assertEqual(["check", "end"], [event["event"] for event in found])
        self.assertAlmostEqual(5, found[0]["filament_mm"])
        self.assertAlmostEqual(110, found[0]["x_max"])
        self.run_it("-n", "a.gcode", "--bed", "120x100x100")
        message = self.fails(8, "a.gcode:5: fault outside", "-n", "a.gcode", "--bed", "100x100x100")
        self.assertIn("1 faults; nothing was sent", message)
        found = events(self.run_it("-n", "a.gcode", "--bed", "100x100x100", "--json",
                                   code=8).stdout.decode())
        self.assertEqual(("fault", 5, "outside"), tuple(found[0][k] for k in ("event", "line", "code")))
        self.assertEqual(8, found[-1]["status"])
        self.run_it("-n", "-", input=b"G28\n", stdin=None)

    def test_scripts_for_pause_and_cancel_are_checked(self):
        (self.at / "long.gcode").write_text("G4 P1\n" * 41)
        self.fails(2, "long.gcode:41", "part.gcode", "--on-pause", "long.gcode", "--port", "virtual")
        self.fails(3, "none", "part.gcode", "--on-cancel", "none", "--port", "virtual")


class Printing(Bench):
    def test_a_job_arrives_once_and_in_order(self):
        port = self.printer("--speed", "instant", "--check", "part.gcode")
        done = self.run_it("part.gcode", "--port", port)
        self.assertEqual(0, self.printed()["fault_count"])
        self.assertEqual(0, self.process.returncode)
        self.assertEqual(commands(self.text), executed(self.at / "executed"))
        message = done.stderr.decode()
        self.assertEqual(b"", done.stdout)
        self.assertIn(f"{len(commands(self.text))} commands, 0 sent again", message)
        self.assertRegex(message, r"isoprint: [2-8]\d %, layer \d+/10")
        self.assertNotIn("\r", message)
        self.assertEqual(["executed", "part.gcode", "summary"],
                         sorted(set(os.listdir(self.at)) - {"printer"}), "a journal was left")

    def test_a_damaged_link_is_mended(self):
        port = self.printer("--speed", "instant", "--seed", "3", "--flip-in", "0.03", "--flip-out",
                            "0.02", "--lose-ok", "0.01")
        done = self.run_it("part.gcode", "--port", port)
        self.assertEqual(commands(self.text), executed(self.at / "executed"))
        again = int(re.search(r"(\d+) sent again", done.stderr.decode())[1])
        self.assertGreater(again, 0)

    def test_many_complaints_are_counted_not_said(self):
        (self.at / "part.gcode").write_text("G28\n" + "M9999\n" * 300)
        done = self.run_it("part.gcode", "--port", "virtual", "--virtual", "speed=0", "--log", "log")
        said = done.stderr.decode()
        self.assertEqual(5, said.count("Unknown command"))
        self.assertIn("295 more messages", said)
        self.assertEqual(300, (self.at / "log").read_text().count('Unknown command: "M9999"'))

    def test_oks_before_the_output_they_belong_to(self):
        """An echo proves its line executed; no ok is due behind it."""
        (self.at / "a.gcode").write_text(job(layers=1))
        port = self.printer("--speed", "instant", "--check", "a.gcode", "--do", "at line 1 ok first")
        self.run_it("a.gcode", "--port", port, "-q")
        self.printed()
        self.assertEqual(0, self.process.returncode, "the printer's own check")

    def test_standard_input(self):
        port = self.printer("--speed", "instant", "--check", "part.gcode")
        self.run_it("-", "--port", port, input=self.text.encode(), stdin=None)
        self.assertEqual(commands(self.text), executed(self.at / "executed"))

    def test_a_pipe_may_be_slow(self):
        process = self.start("-", "--port", self.printer("--speed", "instant"), "-q",
                             stdin=subprocess.PIPE)
        for part in ("G28\nG1 X", "10 F6000\nG1 ", "X20\n", "G1 X30"):
            process.stdin.write(part.encode())
            process.stdin.flush()
            try:
                process.wait(0.3)
            except subprocess.TimeoutExpired:
                pass
        process.stdin.close()
        process.stdin = None
        self.end(process, 0)
        self.assertEqual(["G28", "G1 X10 F6000", "G1 X20", "G1 X30"], executed(self.at / "executed"))

    def test_quiet_says_nothing(self):
        done = self.virtual("part.gcode", "-q")
        self.assertEqual((b"", b""), (done.stdout, done.stderr))

    def test_heaters_off_at_the_end_of_a_job_that_leaves_them_on(self):
        (self.at / "hot.gcode").write_text("G28\nM104 S60\nM140 S40\nG1 X10 F6000\n")
        self.assertIn(b"left heaters on", self.virtual("hot.gcode").stderr)
        self.assertNotIn(b"left heaters on", self.virtual("part.gcode").stderr)
        self.run_it("hot.gcode", "--port", self.printer("--speed", "instant"), "--heaters-off", "-q")
        self.assertEqual(0, self.printed()["fault_count"])

    def test_window_and_firmware_by_hand(self):
        for more in (("--window", "1"), ("--window", "4:96"), ("--firmware", "marlin"),
                     ("--firmware", "Repetier"), ("--no-reset",)):
            with self.subTest(more):
                self.virtual("part.gcode", "-q", *more)

    def test_rates(self):
        self.virtual("part.gcode", "-q", "--baud", "250000")
        port = self.printer("--speed", "instant")
        message = self.run_it("part.gcode", "--port", port, "--baud", "auto").stderr.decode()
        self.assertIn("answers at 115200 bits/s", message)

    def test_the_log_is_the_dialogue(self):
        self.virtual("part.gcode", "-q", "--log", "log.txt")
        lines = (self.at / "log.txt").read_text().splitlines()
        entries = [re.fullmatch(r" *(\d+\.\d{6}) ([<>#]) (.*)", line) for line in lines]
        self.assertTrue(all(entries))
        self.assertIn("isoprint", entries[0][3])
        times = [float(entry[1]) for entry in entries]
        self.assertEqual(sorted(times), times)
        sent = [entry[3] for entry in entries if entry[2] == ">"]
        numbered = [re.fullmatch(r"N(\d+) (.*?) ?\*\d+", line) for line in sent]
        numbers = [int(match[1]) for match in numbered if match]
        self.assertEqual(list(range(numbers[0], numbers[0] + len(numbers))), numbers)
        bare = [match[2] for match in numbered if match]
        for command in commands(self.text):
            self.assertIn(command, bare)
        self.assertIn("ok", [entry[3] for entry in entries if entry[2] == "<"])

    def test_a_log_that_can_not_be_written(self):
        self.fails(7, "none/log", "part.gcode", "--log", "none/log", "--port", "virtual")
        if os.path.exists("/dev/full"):
            self.fails(7, "/dev/full", "part.gcode", "-q", "--log", "/dev/full", "--port", "virtual",
                       "--virtual", "speed=0")

    def test_a_limit_for_files_does_not_end_the_print(self):
        """ulimit -f: a signal of its own, which ends who does not know it, heaters on."""
        port = self.printer("--speed", "instant")
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (2000, 2000))
        done = self.run_it("part.gcode", "-q", "--log", "log", "--port", port, code=7, preexec_fn=limit)
        self.assertIn("log: could not be written", done.stderr.decode())
        self.assertEqual(commands(self.text), executed(self.at / "executed"))
        self.assertEqual(0, self.printed()["fault_count"])

    def test_events_follow_the_schema(self):
        found = events(self.virtual("part.gcode", "--json", options="speed=0 flip_in=0.02 seed=5")
                       .stdout.decode())
        self.assertEqual("start", found[0]["event"])
        self.assertEqual("end", found[-1]["event"])
        states = [event["state"] for event in found if event["event"] == "state"]
        self.assertEqual(["connecting", "printing", "finishing", "done"], states)
        kinds = {event["event"] for event in found}
        self.assertLessEqual({"start", "state", "firmware", "progress", "resend", "end"}, kinds)
        text = (ROOT / "docs/isoprint.md").read_text()
        for event in found:
            self.assertGreaterEqual(event["time"], 0)
            row = re.search(rf"(?m)^\| `{event['event']}` \| (.*) \|", text)
            self.assertIsNotNone(row, event)
            for key in set(event) - {"event", "time"}:
                self.assertIn(f"`{key}`", row[1], event)
        percents = [event["percent"] for event in found if event["event"] == "progress"]
        self.assertEqual(sorted(percents), percents)
        self.assertEqual((0, "", "", len(commands(self.text))),
                         tuple(found[-1][key] for key in ("status", "message", "resume", "accepted")))

    def test_every_failure_ends_with_an_event(self):
        for arguments in (("none.gcode",), ("part.gcode", "--port", "tty:/dev/none"),
                          ("--list",), ("-n", "none.gcode")):
            done = subprocess.run([PROGRAM, *arguments, "--json"], cwd=self.at, capture_output=True,
                                  timeout=LONG)
            last = events(done.stdout.decode())[-1]
            self.assertEqual(("end", done.returncode), (last["event"], last["status"]))
            self.assertEqual(done.returncode != 0, last["message"] != "")

    def test_a_reader_that_goes_away_does_not_end_the_print(self):
        port = self.printer("--speed", "instant")
        reading, writing = os.pipe()
        process = subprocess.Popen([PROGRAM, "part.gcode", "--json", "--port", port], cwd=self.at,
                                   stdout=writing, stderr=subprocess.PIPE, env=self.environment)
        os.close(writing)
        os.read(reading, 10)
        os.close(reading)
        error = process.communicate(timeout=LONG)[1].decode()
        self.assertEqual(7, process.returncode, error)
        self.assertIn("standard output can't be written", error)
        self.assertEqual(commands(self.text), executed(self.at / "executed"))

    def test_a_reader_that_sleeps_does_not_hold_the_printer_up(self):
        """Answers that tell a lot, into a pipe that nobody reads."""
        text = "G28\n" + "M114\nM503\n" * 600 + "M84\n"
        (self.at / "talk.gcode").write_text(text)
        port = self.printer("--speed", "instant")
        reading, writing = os.pipe()
        process = subprocess.Popen([PROGRAM, "talk.gcode", "--json", "--port", port], cwd=self.at,
                                   stdout=writing, stderr=subprocess.PIPE, env=self.environment)
        os.close(writing)
        error = process.communicate(timeout=LONG)[1].decode()
        os.close(reading)
        self.assertEqual(7, process.returncode, error)
        self.assertIn("not read in time", error)

    def test_what_isoslice_writes(self):
        slicer = os.environ.get("ISOSLICE_PROGRAM")
        if not slicer:
            self.skipTest("no isoslice")
        facets = "".join(
            f"facet normal 0 0 0\nouter loop\n{''.join(f'vertex {x} {y} {z}{chr(10)}' for x, y, z in t)}"
            "endloop\nendfacet\n" for t in box(8))
        (self.at / "part.stl").write_text(f"solid\n{facets}endsolid\n")
        port = self.printer("--speed", "instant")
        done = subprocess.run(["sh", "-c", f"'{slicer}' part.stl -o - | '{PROGRAM}' - --port {port}"],
                              cwd=self.at, capture_output=True, timeout=LONG, env=self.environment)
        self.assertEqual(0, done.returncode, done.stderr.decode())
        written = subprocess.run([slicer, "part.stl", "-o", "-"], cwd=self.at, capture_output=True,
                                 timeout=LONG).stdout.decode()
        self.assertEqual(len(commands(written)), int(re.search(r"(\d+) commands", done.stderr.decode())[1]))
        self.assertEqual(0, self.printed()["fault_count"])


def box(size):
    """Twelve triangles."""
    corner = [(x * size, y * size, z * size) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    faces = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
    return [tuple(corner[i] for i in t) for a, b, c, d in faces for t in ((a, b, c), (a, c, d))]


class Descriptors(Bench):
    """Standard ones that are closed, or nothing that could be read."""

    def with_redirections(self, redirections, code, *arguments):
        """By files, since a pipe would be opened anew and take the place of what is closed."""
        done = subprocess.run(["sh", "-c", f'exec "$@" {redirections}', "sh", PROGRAM, *arguments],
                              cwd=self.at, timeout=LONG, env=self.environment)
        self.assertEqual(code, done.returncode)

    def test_closed_standard_input_is_no_job(self):
        self.with_redirections("<&- >out 2>err", 3, "-", "--port", "virtual")
        self.assertIn("standard input can't be read", (self.at / "err").read_text())

    def test_closed_descriptors_are_not_taken_for_others(self):
        fast = ("part.gcode", "--port", "virtual", "--virtual", "speed=0")
        self.with_redirections("<&- >&- 2>&-", 0, *fast)
        self.with_redirections("<&- >&- 2>&-", 7, *fast, "--json")

    def test_a_console_whose_input_can_t_be_read_ends(self):
        self.with_redirections("</ >out 2>err", 3, "--console", "--port", "virtual", "--virtual",
                               "speed=0")
        self.assertIn("standard input can't be read", (self.at / "err").read_text())
        self.with_redirections("<&- >out 2>err", 3, "--console", "--port", "virtual", "--virtual",
                               "speed=0")


class Commands(Bench):
    def test_send_prints_the_answers(self):
        text = self.virtual("--send", "M503", "--send", "M114").stdout.decode()
        self.assertIn("M92 X", text)
        self.assertIn("\nX:0.00 Y:0.00 Z:0.00 E:0.00", text)
        self.assertEqual(2, text.split("\n").count("ok"))
        self.assertNotIn("FIRMWARE", text)

    def test_send_of_a_refused_command(self):
        done = self.virtual("--send", "nonsense", code=8)
        self.assertIn('Unknown command: "nonsense"', done.stdout.decode())
        self.assertIn(b"refused", done.stderr)
        self.virtual("--send", "M110 N1", code=2)

    def test_console(self):
        done = self.virtual("--console", input=b"M105\n; comment\n\nG28 X ; home\nM114", stdin=None)
        lines = done.stdout.decode().splitlines()
        self.assertRegex(lines[0], r"^ok T:")
        self.assertRegex(lines[-2], r"^X:0.00")
        self.assertEqual("ok", lines[-1])
        done = self.virtual("--console", input=b"M28 a\n" + b"x" * 9000 + b"\nM114\n", stdin=None)
        self.assertIn(b"X:", done.stdout)
        self.assertIn(b"M28", done.stderr)
        self.assertIn(b"too long", done.stderr)

    def test_an_empty_console_ends(self):
        self.virtual("--console", input=b"", stdin=None)

    def test_emergency_stop_by_hand(self):
        done = self.virtual("--send", "M112", code=11)
        self.assertIn(b"emergency stop", done.stderr)

    def test_as_json(self):
        found = events(self.virtual("--send", "M114", "--json").stdout.decode())
        answers = [event["text"] for event in found if event["event"] == "answer"]
        self.assertEqual("ok", answers[-1])
        self.assertEqual(2, len(answers))

    def test_nobody_answers(self):
        """The other end of a pseudo terminal that nobody reads."""
        master, slave = os.openpty()
        self.addCleanup(os.close, master)
        name = os.ttyname(slave)
        os.close(slave)
        self.fails(9, "no printer answers", "--send", "M105", "--port", f"tty:{name}")

    def test_hostile_answers_are_made_harmless(self):
        """Escape sequences from a printer reach neither the terminal nor the log as such."""
        server = Chatterbox(self.at / "socket", b"\x1b]0;owned\x07\xff\xfe\"\\ \xc3\xa9\n")
        server.start()
        done = self.run_it("--send", "M114", "--port", "socket:socket", "--log", "log", "--no-reset")
        server.join(LONG)
        self.assertNotIn(b"\x1b", done.stdout + done.stderr + (self.at / "log").read_bytes())
        self.assertIn("?]0;owned???\"\\ é".encode(), done.stdout)
        self.assertIn(rb"\x1b]0;owned\x07\xff\xfe", (self.at / "log").read_bytes())


class Chatterbox(threading.Thread):
    """A firmware that answers every line by an ok, and M114 by what it was given."""

    def __init__(self, path, answer):
        import socket
        super().__init__(daemon=True)
        self.answer = answer
        self.listener = socket.socket(socket.AF_UNIX)
        self.listener.bind(str(path))
        self.listener.listen(1)

    def run(self):
        link = self.listener.accept()[0]
        self.listener.close()
        with link, link.makefile("rb") as lines:
            for line in lines:
                if b"M114" in line:
                    link.sendall(self.answer)
                if b"M115" in line:
                    link.sendall(b"FIRMWARE_NAME:Marlin 2.1\n")
                echo = re.search(rb"M0*118 (\w+)", line)
                link.sendall((echo[1] + b"\n" if echo else b"") + b"ok\n" if line.strip() else b"")


class Card(Bench):
    def test_upload_and_start(self):
        port = self.printer("--speed", "instant")
        done = self.run_it("part.gcode", "--upload", "PART.GCO", "--port", port)
        self.assertIn(b"written to the card", done.stderr)
        self.assertEqual([], [line for line in executed(self.at / "executed") if "X50" in line])
        done = self.run_it("part.gcode", "--upload", "PART2.GCO", "--start", "--port", port)
        self.assertIn(b"written to the card and begun", done.stderr)
        self.until(lambda: [line for line in executed(self.at / "executed") if "X50" in line],
                   "the printer did not start from its card")

    def test_list(self):
        done = self.run_it("--list", "--json")
        for event in events(done.stdout.decode())[:-1]:
            self.assertEqual("port", event["event"])

    def test_list_asks_for_the_firmware(self):
        """A board on USB, if there is a way to play one here."""
        if os.environ.get("ISOPRINT_SANITIZED") == "1":
            self.skipTest("tests/usb does it with sanitizers")
        play = [PRINTER, "--usb", "ch340", "--quiet", "--speed", "instant", "--"]
        if subprocess.run([*play, "true"], capture_output=True, timeout=LONG).returncode != 0:
            self.skipTest("no umockdev")
        done = subprocess.run([*play, PROGRAM, "--list", "--probe"], capture_output=True, timeout=LONG)
        self.assertEqual(0, done.returncode, done.stderr.decode())
        row = done.stdout.decode().splitlines()[1]
        self.assertRegex(row, r"^usb:1a86:7523\S* +CH340 +ch341 +Marlin 2\.1")
        done = subprocess.run([*play, PROGRAM, "--list", "--probe", "--json"], capture_output=True,
                              timeout=LONG)
        found = events(done.stdout.decode())[0]
        self.assertEqual(("CH340", 0x1a86, 0x7523, True),
                         tuple(found[key] for key in ("board", "vendor", "product", "allowed")))
        self.assertIn("Marlin", found["firmware"])


if __name__ == "__main__":
    main()
