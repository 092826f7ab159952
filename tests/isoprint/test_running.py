"""What happens to a running print: signals, keys, killed hosts, pulled plugs, endless jobs."""

import fcntl
import os
import random
import re
import resource
import signal
import subprocess
import termios
import time

from bench import LONG, PROGRAM, ROOT, Bench, commands, events, executed, job, main

SANITIZED = os.environ.get("ISOPRINT_SANITIZED") == "1"


class Running(Bench):
    def setUp(self):
        super().setUp()
        self.text = job(layers=12, moves=50) + "; estimated printing time (normal mode) = 2m 0s\n"
        (self.at / "part.gcode").write_text(self.text)
        self.job = commands(self.text)

    def after(self, lines, process):
        """Until so many lines of the job are made."""
        self.until(lambda: self.lines_made() >= lines or process.poll() is not None, "nothing is made")
        self.assertIsNone(process.poll(), process.poll() is not None and process.stderr.read())

    def assert_begins_like_the_job(self, least):
        made = executed(self.at / "executed")
        same = next((i for i, pair in enumerate(zip(made, self.job)) if pair[0] != pair[1]),
                    min(len(made), len(self.job)))
        self.assertGreaterEqual(same, least)


class Signals(Running):
    def cancelled(self, *signals, seed):
        port = self.printer("--speed", "30")
        process = self.start("part.gcode", "--port", port)
        lines = random.Random(seed).randrange(len(self.job) // 2)
        self.after(lines, process)
        for number in signals:
            process.send_signal(number)
        error = self.end(process, 11)[1]
        self.assert_begins_like_the_job(lines)
        self.assertLess(self.lines_made(), len(self.job) + 20)
        return error

    def test_an_interrupt_cancels_and_switches_off(self):
        for seed in range(3):
            with self.subTest(seed):
                error = self.cancelled(signal.SIGINT, seed=seed)
                self.assertEqual(0, self.printed()["fault_count"])
                self.assertIn("cancelling", error)
                self.assertIn("--resume-from part.gcode.journal", error)
                self.assertNotIn("M84", executed(self.at / "executed")[-1:])
                os.remove(self.at / "executed")
                os.remove(self.at / "part.gcode.journal")

    def test_told_to_end(self):
        for number in (signal.SIGTERM, signal.SIGHUP):
            with self.subTest(number):
                self.cancelled(number, seed=5)
                self.assertEqual(0, self.printed()["fault_count"])
                os.remove(self.at / "executed")
                os.remove(self.at / "part.gcode.journal")

    def test_an_emergency_stop(self):
        self.assertIn("emergency stop", self.cancelled(signal.SIGQUIT, seed=6))
        self.assertIn("halted", str(self.printed()["faults"]))

    def test_a_second_interrupt_stops_what_does_not_end(self):
        """The printer hears of the cancelling only when it is too late for it."""
        process = self.start("part.gcode", "--port", self.printer("--speed", "30"))
        self.after(20, process)
        self.process.send_signal(signal.SIGSTOP)
        process.send_signal(signal.SIGINT)
        time.sleep(0.2)
        process.send_signal(signal.SIGINT)
        time.sleep(0.2)
        self.process.send_signal(signal.SIGCONT)
        self.assertIn("emergency stop", self.end(process, 11)[1])
        self.assertIn("halted", str(self.printed()["faults"]))

    def test_interrupts_end_it_even_if_the_printer_is_dead(self):
        process = self.start("part.gcode", "--port", self.printer("--speed", "30"))
        self.after(20, process)
        self.process.send_signal(signal.SIGSTOP)
        for _ in range(3):
            process.send_signal(signal.SIGINT)
            time.sleep(0.05)
        self.end(process, 11)
        self.process.send_signal(signal.SIGCONT)

    def test_suspending_is_refused(self):
        process = self.start("part.gcode", "--port", self.printer("--speed", "30"))
        self.after(20, process)
        process.send_signal(signal.SIGTSTP)
        self.assertIn("can't be suspended", self.end(process, 0)[1])
        self.assertEqual(self.job, executed(self.at / "executed"))

    def test_before_anything_is_sent(self):
        for arguments, more in ((("-", "--port", "virtual"), {"stdin": subprocess.PIPE}),
                                (("part.gcode", "--port", "tty:/dev/none", "--wait", "500"), {})):
            process = self.start(*arguments, **more)
            time.sleep(0.3)
            while process.poll() is None:  # it may not have begun to listen
                try:
                    process.send_signal(signal.SIGTERM)
                    process.wait(0.5)
                except subprocess.TimeoutExpired:
                    pass
            self.assertIn(process.returncode, (11, -signal.SIGTERM))
            if process.stdin:
                process.stdin.close()

    def test_stopped_and_continued_from_outside(self):
        process = self.start("part.gcode", "--port", self.printer("--speed", "5"))
        self.after(20, process)
        process.send_signal(signal.SIGSTOP)
        time.sleep(0.5)
        process.send_signal(signal.SIGCONT)
        self.end(process, 0)
        self.assertEqual(self.job, executed(self.at / "executed"))


class Keys(Running):
    def sit_down(self, *arguments, speed="30"):
        """isoprint in the foreground of a terminal."""
        port = self.printer("--speed", speed)
        self.master, slave = os.openpty()
        self.before = termios.tcgetattr(slave)
        self.seen = b""

        def take_terminal():
            os.setsid()
            fcntl.ioctl(0, termios.TIOCSCTTY, 0)

        self.running = subprocess.Popen([PROGRAM, "part.gcode", "--port", port, *arguments],
                                        cwd=self.at, stdin=slave, stdout=slave, stderr=slave,
                                        preexec_fn=take_terminal, env=self.environment)
        self.slave = slave
        self.addCleanup(os.close, self.master)
        self.addCleanup(os.close, slave)
        self.addCleanup(self.running.wait)
        self.addCleanup(self.running.kill)
        os.set_blocking(self.master, False)

    def look(self):
        try:
            self.seen += os.read(self.master, 65536)
        except BlockingIOError:
            pass
        return self.seen

    def see(self, what):
        self.until(lambda: what in self.look() or self.running.poll() is not None, what)
        self.assertIn(what, self.look())
        self.seen = self.seen[self.seen.index(what) + len(what):]

    def press(self, keys):
        os.write(self.master, keys)

    def leave(self, code):
        self.until(lambda: self.look() is None or self.running.poll() is not None, "it stays")
        self.look()
        self.assertNotIn(b"Sanitizer", self.seen, self.seen.decode(errors="replace"))
        self.assertEqual(code, self.running.returncode, self.seen.decode(errors="replace"))
        self.assertEqual(self.before, termios.tcgetattr(self.slave), "the terminal is not as it was")

    def test_pause_and_resume(self):
        self.sit_down()
        self.see(b"layer 2/12")
        self.assertFalse(termios.tcgetattr(self.slave)[3] & (termios.ICANON | termios.ECHO))
        self.press(b"p")
        self.see(b"paused; r goes on")
        made = self.lines_made()
        time.sleep(0.5)
        self.assertLessEqual(self.lines_made(), made + 8, "it went on printing")
        self.press(b"\x1b[C\x1b[A")
        self.press(b"?")
        self.see(b"p pause, r resume")
        self.press(b"r")
        self.see(b"printed in")
        self.leave(0)
        made = [line for line in executed(self.at / "executed") if line in self.job]
        position = 0
        for line in self.job:  # all of them, in order, whatever stands between
            position = made.index(line, position) + 1
        self.assertEqual(0, self.printed()["fault_count"])

    def test_cancel_wants_two_keys(self):
        self.sit_down()
        self.see(b"layer 2/12")
        self.press(b"c")
        self.see(b"c again")
        self.press(b"c")
        self.see(b"cancelling")
        self.leave(11)
        self.assertEqual(0, self.printed()["fault_count"])

    def test_emergency_stop(self):
        self.sit_down()
        self.see(b"layer 2/12")
        self.press(b"!")
        self.leave(11)
        self.assertIn("halted", str(self.printed()["faults"]))

    def test_control_c_and_control_z(self):
        self.sit_down()
        self.see(b"layer 2/12")
        self.press(b"\x1a")
        self.see(b"can't be suspended")
        self.press(b"\x03")
        self.leave(11)
        self.assertEqual(0, self.printed()["fault_count"])

    def test_a_defect_gives_the_terminal_back(self):
        self.sit_down()
        self.see(b"layer 2/12")
        self.running.send_signal(signal.SIGABRT)
        self.leave(-signal.SIGABRT)

    def test_a_stopped_terminal_does_not_hold_the_printer_up(self):
        self.sit_down()
        self.see(b"layer 2/12")
        self.press(b"\x13")
        self.until(lambda: self.lines_made() >= len(self.job), "Ctrl-S stopped the printer")
        self.press(b"\x11")
        self.leave(0)

    def test_the_line_of_progress(self):
        self.sit_down()
        self.see(b"layer 3/12")
        self.see(b" left")
        fcntl.ioctl(self.master, termios.TIOCSWINSZ, b"\x18\x00\x14\x00\x00\x00\x00\x00")
        self.running.send_signal(signal.SIGWINCH)
        self.see(b"layer 6/")
        self.see(b"layer 11/")
        drawn = [part.split(b"\n")[0].rstrip(b"\r") for part in self.look().split(b"\r\x1b[K")[1:-1]]
        self.assertFalse([part for part in drawn if len(part) >= 20 and b"isoprint" not in part])
        self.leave(0)

    def test_an_earlier_journal_asks(self):
        (self.at / "empty").write_text("")
        self.sit_down("--journal", "none")
        self.see(b"printed in")
        self.leave(0)


class Resuming(Running):
    def assert_once_and_in_order(self):
        """Of the moves in a plane, each of which the file has but once."""
        moves = [line for line in self.job if re.match(r"G1 X\d+ Y\d+ F", line)]
        self.assertEqual(len(moves), len(set(moves)))
        self.assertEqual(moves, [line for line in executed(self.at / "executed") if line in set(moves)])

    def killed(self, seed):
        """Kill the host again and again; each next one goes on."""
        chance = random.Random(seed)
        port = self.printer("--speed", "30", "--no-reset")
        arguments = ["part.gcode", "--port", port]
        for _ in range(3):
            process = self.start(*arguments, "-q", "--no-reset")
            self.after(min(self.lines_made() + chance.randrange(20, 150), len(self.job) - 50), process)
            time.sleep(chance.random() * 0.05)
            process.kill()
            process.communicate()
            arguments = ["--resume-from", "part.gcode.journal"]
        self.run_it(*arguments, "-q")
        self.assert_once_and_in_order()
        self.assertFalse((self.at / "part.gcode.journal").exists())

    def test_a_killed_host_goes_on_exactly(self):
        for seed in range(2):
            with self.subTest(seed):
                self.killed(seed)
                os.remove(self.at / "executed")

    def test_a_pulled_plug(self):
        port = self.printer("--speed", "30", "--no-reset", "--do",
                            "at line 200 unplug", "--replug", "10")
        error = self.end(self.start("part.gcode", "--port", port, "--no-reset"), 10)[1]
        self.assertRegex(error, r"after line \d+, byte \d+, layer \d+ of the job")
        command = re.search(r"to go on with the job: isoprint (.*)", error)[1]

        def went_on():  # once it is there again; failing until then spoils nothing
            done = subprocess.run(["sh", "-c", f"'{PROGRAM}' {command} --wait 60"], cwd=self.at,
                                  capture_output=True, timeout=LONG, env=self.environment)
            self.assertIn(done.returncode, (0, 9, 10), done.stderr.decode())
            return done.returncode == 0

        self.until(went_on, "the plug is not put back")
        self.assert_once_and_in_order()

    def test_a_reset_printer(self):
        """All of the job is made, in order; what it may have made without our knowing, again."""
        port = self.printer("--speed", "30", "--do", "at line 300 reset")
        error = self.end(self.start("part.gcode", "--port", port), 10)[1]
        self.assertIn("reset", error)
        self.run_it("--resume-from", "part.gcode.journal", "-q")
        made = executed(self.at / "executed")
        position = 0
        for line in self.job:
            position = made.index(line, position) + 1
        self.assertLess(len(made), len(self.job) + 60)
        self.assert_only_z_is_not_homed()

    def assert_only_z_is_not_homed(self):
        """It can't be homed onto the part."""
        faults = [fault["text"] for fault in self.printed()["faults"] if fault["code"] != "not_homed"]
        self.assertEqual([], faults)

    def cancel_early(self, *more):
        process = self.start("part.gcode", "--port", self.printer("--speed", "30"), *more)
        self.after(60, process)
        process.send_signal(signal.SIGTERM)
        return self.end(process, 11)[1]

    def test_what_a_journal_does_not_fit(self):
        self.cancel_early()
        self.fails(2, "--yes", "part.gcode", "--port", "virtual")
        (self.at / "part.gcode").write_text(self.text + "G4 P1\n")
        self.fails(2, "has changed since", "--resume-from", "part.gcode.journal", "--port", "virtual")
        self.fails(3, "none.journal", "--resume-from", "none.journal")
        self.fails(3, "part.gcode", "--resume-from", "part.gcode")
        self.fails(2, "is no journal", "part.gcode", "--journal", "part.gcode", "--port", "virtual")
        (self.at / "part.gcode").write_text(self.text)
        self.virtual("part.gcode", "-q", "--yes")
        self.assertFalse((self.at / "part.gcode.journal").exists())

    def test_journals_elsewhere_or_none(self):
        self.assertIn("--resume-from other", self.cancel_early("--journal", "other"))
        os.remove(self.at / "other")
        os.remove(self.at / "executed")
        self.assertRegex(self.cancel_early("--journal", "none"), r"--resume-from \d+ ")
        self.assertFalse((self.at / "part.gcode.journal").exists())
        self.fails(7, "none/j", "part.gcode", "--journal", "none/j", "--port", "virtual")
        (self.at / "part.gcode.journal").mkdir()
        self.fails(7, "part.gcode.journal", "part.gcode", "--port", "virtual")

    def test_a_journal_replaces_no_device(self):
        os.mkfifo(self.at / "device")
        self.fails(7, "device", "part.gcode", "--journal", "device", "--port", "virtual")
        self.assertTrue((self.at / "device").is_fifo())

    def test_a_journal_that_can_not_be_kept_is_removed(self):
        """It would not know of later lines: going on from it would leave commands out."""
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (4000, 4000))
        port = self.printer("--speed", "instant")
        error = self.run_it("part.gcode", "--port", port, preexec_fn=limit).stderr.decode()
        self.assertIn("the journal is no longer kept", error)
        self.assertEqual(self.job, executed(self.at / "executed"))
        self.assertFalse((self.at / "part.gcode.journal").exists())

    def test_from_a_line(self):
        lines = self.text.splitlines()
        at = lines.index(";LAYER_CHANGE", 300) + 1
        self.run_it("part.gcode", "--resume-from", str(at), "--port", self.printer("--speed", "instant"),
                    "-q")
        rest = commands("\n".join(lines[at - 1:]))
        made = executed(self.at / "executed")
        self.assertEqual(rest, made[len(made) - len(rest):])
        self.assertNotIn("G28", made)
        self.assert_only_z_is_not_homed()
        self.fails(2, "no command from line 99999", "part.gcode", "--resume-from", "99999", "--port",
                   "virtual")

    def test_standard_input_goes_on_from_a_journal(self):
        port = self.printer("--speed", "30", "--no-reset")
        with open(self.at / "part.gcode") as text:
            process = self.start("-", "--port", port, "--journal", "j", "--no-reset", stdin=text)
        self.after(100, process)
        process.kill()
        process.communicate()
        self.run_it("-", "--resume-from", "j", "-q", input=self.text.encode(), stdin=None)
        self.assert_once_and_in_order()


class Memory(Bench):
    def test_it_does_not_grow_with_the_job(self):
        """50 MB from a pipe; the peak while all but the end is read."""
        process = self.start("-", "--port", "virtual", "--virtual", "speed=0,rate=0", "-q",
                             stdin=subprocess.PIPE)
        block = (b"; " + b"x" * 4000 + b"\nG1 X1 F6000\nG1 X2\n") * 250
        process.stdin.write(b"G28\n")
        for _ in range(50):
            process.stdin.write(block)
        process.stdin.flush()
        with open(f"/proc/{process.pid}/status") as status:
            peak = int(re.search(r"VmHWM:\s+(\d+) kB", status.read())[1])
        process.stdin.close()
        process.stdin = None
        self.end(process, 0)
        if not SANITIZED:
            self.assertLess(peak, 20 << 10)


if __name__ == "__main__":
    main()
