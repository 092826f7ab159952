"""Print jobs with isoprint on isoprint-virtual while everything goes wrong at random moments.

    torture_print.py ISOPRINT ISOPRINT-VIRTUAL [--seed N]... [--first N] [--cases N] [--seconds S]
                     [--usb] [--keep DIR] [-v] [-j N]

A seed chooses the job, the line, the printer, its faults and its script, and for each run of isoprint
what happens to it: signals, keys, a killed printer, a pipe that stalls, a full disk, a file that
changes. What broke off is gone on with, by the command that isoprint names, until the job is done.
Checked of each run: an exit code that the disturbances explain; an end in time; no crash, no report
of a sanitizer; lines of stdout and stderr that are whole and clean; a terminal as it was; a journal
where one is due; less than 20 MB. Of the whole: what the printer executed is the file, each command
once and in order, but for what a reset may repeat; heaters off where the link allowed it.
"""
import argparse
import concurrent.futures
import fcntl
import json
import os
import random
import re
import resource
import select
import shlex
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import termios
import time

LIMIT = 240  # s; no run of isoprint may take longer, however slow the machine
RSS = 20 << 10  # KiB
RUNS = 8  # of isoprint; in the last ones nothing is done to it
SANITIZER = "verify_asan_link_order=0:detect_leaks=0"  # umockdev's library comes first
CHIPS = ("cdc-acm", "ch340", "ch340-limited", "ftdi", "ftdi-h", "cp2102", "pl2303hx", "pl2303hxn")
HOST = re.compile(r"^M(27|31|105|108|110|113|114|115|118|154|155|400|876) ")
RESTORING = re.compile(r"^(G(0|1|4|20|21|28|90|91|92)|M(17|18|82|83|84|104|106|107|109|117|140|190|"
                       r"204|211|220|221|413)|T\d) ")
# Steps of scripts: what they are, and what has to be expected of it.
HARMLESS = ("at line {} busy 1", "at line {} throttle 0.01; at line {later} throttle 0",
            "at line {} silent 0.5", "at line {} mute 0.5", "at ok {} lose ok 2", "at ok {} double ok",
            "at ok {} late ok 1", "at line {} reject 2", "at line {} resend 3",
            'at line {} answer "Resend: 2"', 'at line {} answer "ok"', "at line {} flip line 2",
            "at line {} cut line", "at line {} lose answer 2", "at line {} ok first",
            'at line {} answer "\\xff\\x80 garbage"', 'every 0.5 seconds answer "wait"',
            "at line {} demand checksums")
RESETS = ("at line {} reset", "at time {time} reset", "at byte {byte} reset")
HALTS = ('at line {} halt "Thermal Runaway, system stopped! Heater_ID: 0"',
         "at line {} heater nozzle dead", "at line {} thermistor nozzle open")
UNPLUGS = ("at line {} unplug", "at byte {byte} unplug", "at line {} unplug for 0.2")
SILENCES = ("at line {} silent 100000", "at line {} mute 100000")


def plain(line):
    """The command word without leading zeros, a blank, the rest without blanks."""
    parts = re.match(r"\s*([A-Za-z])0*(\d+(?:\.\d+)?)?(.*)", line, re.S)
    if not parts:
        return "".join(line.split())
    return f"{parts[1]}{parts[2] or ''} {''.join(parts[3].split())}"


# ---- jobs ----

def make_commands(chance, count, hot):
    """Commands that are all different, so that each can be told from any other."""
    lines = ["M140 S41", "G28", "M109 S201" if hot else "M104 S201", "G90", "M83"]
    for i in range(count):
        kind = chance.random()
        if i % 40 == 0:
            lines.append(f";LAYER_CHANGE {i // 40}")
            lines.append(f"G1 Z{0.2 + i * 0.004:.3f} F{1000 + i}")
        x, y = 20 + (i * 7) % 180 + chance.random(), 20 + (i * 11) % 160 + chance.random()
        if kind < 0.8:
            push = f" E{0.01 + i * 1e-5:.5f}" if hot else ""
            lines.append(f"G1 X{x:.3f} Y{y:.3f}{push} F{1200 + i}")
        elif kind < 0.88:
            lines.append(f"M117 at {i} of {count}")
        elif kind < 0.92:
            lines.append(f"G4 P{1 + i}")
        elif kind < 0.96:
            lines.append(f"M73 P{100 * i // count} R{count - i} ; {i}")
        else:
            lines.append(f"; only a comment, {'x' * chance.choice((1, 80, 5000))}")
    return lines + ["M104 S0", "M140 S0", "M107", "M84"]


def make_job(chance):
    """(bytes, the exit codes that it allows, how it is called)"""
    kind = chance.choices(("plain", "crlf", "no newline", "mixed ends", "numbered", "huge", "empty",
                           "comments", "nul comment", "nul", "long line", "forbidden"),
                          (50, 5, 5, 3, 4, 3, 1, 1, 2, 3, 3, 3))[0]
    lines = make_commands(chance, chance.choice((5, 60, 150, 400)), chance.random() < 0.3)
    codes, at = {0}, chance.randrange(6, len(lines))
    if kind == "empty":
        return b"", {3}, kind
    if kind == "comments":
        return b"; one\n\n;two" * 1000, {3}, kind
    if kind == "nul":
        lines.insert(at, "G1 X1\0 Y2")
        codes = {3}
    elif kind == "nul comment":
        lines.insert(at, "; \0\1\xff")
    elif kind == "long line":
        lines.insert(at, "G1 X" + "1" * chance.choice((95, 200, 5000, 100000)))
        codes = {3, 8}
    elif kind == "forbidden":
        lines.insert(at, chance.choice(("M112", "M110 N7", "M28 a.g", "M29", "M410", "M999")))
        codes = {8}
    elif kind == "numbered":
        lines = [line if line[0] in ";" else f"N{i} {line}*{i % 100}" for i, line in enumerate(lines)]
    elif kind == "huge":
        lines[at:at] = [";" + "-" * 65535] * 760
    end = "\r\n" if kind == "crlf" else "\n"
    text = end.join(lines) + (end if kind != "no newline" else "")
    if kind == "mixed ends":
        text = "".join(line + chance.choice(("\n", "\r", "\r\n", "\n\n ")) for line in lines)
    return text.encode("latin-1"), codes, kind


def commands_of(data):
    """What of a file is to be executed."""
    found = []
    for line in re.split(r"[\r\n]+", data.decode("latin-1")):
        bare = re.sub(r"^N\d+ (.*?)(\*\d+)?$", r"\1", line.split(";")[0].strip())
        if bare:
            found.append(plain(bare))
    return found


# ---- the printer ----

class Printer:
    """One that may be killed and started again, with what all of them executed in one list."""

    def __init__(self, program, folder, where, chip, options):
        self.program, self.folder, self.where, self.chip = program, folder, where, chip
        self.options, self.made, self.process = options, [], None
        self.generation, self.summaries = 0, []
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.tcp = free.getsockname()[1]
        self.start()

    def path(self, name):
        return os.path.join(self.folder, f"{name}{self.generation}")

    def start(self, script=None):
        self.generation += 1
        ready = self.path("ready")
        place = {"pty": ["--pty", "printer"], "socket": ["--socket", "printer"],
                 "tcp": ["--tcp", f"127.0.0.1:{self.tcp}"], "usb": ["--usb", self.chip]}[self.where]
        hold = ["--", "sh", "-c", f"env -0 >{ready}.new; mv {ready}.new {ready}; exec sleep 9999"]
        more = ["--do", script] if script else []
        environment = {**os.environ, "ASAN_OPTIONS": SANITIZER}
        environment.pop("ISOPRINT_PORT", None)
        with open(self.path("summary"), "wb") as out, open(self.path("said"), "wb") as said:
            self.process = subprocess.Popen(
                [self.program, *place, "--executed", self.path("executed"), "--json", *self.options,
                 *more, *hold], cwd=self.folder, stdout=out, stderr=said, stdin=subprocess.DEVNULL,
                env=environment, start_new_session=True)
        wait_until(lambda: os.path.exists(ready) or self.process.poll() is not None)
        if not os.path.exists(ready):
            with open(self.path("said")) as said:
                raise Broken(f"the printer does not start: {said.read()[-500:]}")
        with open(ready, "rb") as file:
            self.environment = dict(entry.split(b"=", 1) for entry in file.read().split(b"\0")
                                    if b"=" in entry)
        self.port = self.environment.pop(b"ISOPRINT_PORT").decode()
        self.held = int(subprocess.run(["pgrep", "-P", str(self.process.pid)],
                                       capture_output=True).stdout.split()[0])

    def lines(self):
        """Of this generation, as far as they are whole."""
        try:
            with open(self.path("executed"), "rb") as file:
                return file.read().decode("latin-1").split("\n")[:-1]
        except FileNotFoundError:
            return []

    def count(self):
        return len(self.lines())

    def all_lines(self):
        return self.made + self.lines()

    def end(self, brutal=False):
        """Its summary; None if it was killed."""
        self.process.send_signal(signal.SIGCONT)
        if brutal:
            self.process.kill()
        else:
            self.process.terminate()
        try:
            self.process.wait(60)
        except subprocess.TimeoutExpired as late:
            self.process.kill()
            self.process.wait()
            raise Broken("the printer does not end") from late
        if brutal:
            try:
                os.kill(self.held, signal.SIGKILL)
            except ProcessLookupError:
                pass
            shutil.rmtree(self.environment.get(b"UMOCKDEV_DIR", b"/none"), ignore_errors=True)
        self.made += self.lines()
        if brutal:
            return None
        with open(self.path("said"), errors="replace") as file:
            said = file.read()
        if "Sanitizer" in said or "runtime error" in said or \
                self.process.returncode not in (0, 8, 143):
            raise Broken(f"the printer ended with {self.process.returncode}: {said[-2000:]}")
        with open(self.path("summary")) as file:
            return json.loads(file.read())

    def restart(self):
        self.end(brutal=True)
        self.start()


class Broken(Exception):
    pass


def wait_until(condition, seconds=60):
    end = time.monotonic() + seconds
    while not condition() and time.monotonic() < end:
        time.sleep(0.005)


# ---- a run of isoprint ----

class Run:
    """One process, what is done to it, and what it says."""

    def __init__(self, case, arguments, actions, feed, terminal, stdout, limits):
        self.case, self.arguments, self.actions, self.feed = case, arguments, list(actions), feed
        self.seen, self.peak, self.done = b"", 0, []
        self.fed, self.feed_at, self.eof_sent = 0, 0.0, False
        self.paused_at = None
        number = case.runs = case.runs + 1
        self.out_path = os.path.join(case.folder, f"stdout{number}")
        self.err_path = os.path.join(case.folder, f"stderr{number}")
        self.stdout_kind, self.master, self.slave, self.unread = stdout, None, None, None
        environment = {**case.printer.environment, b"LC_ALL": b"C"}
        with open(self.out_path, "wb") as out, open(self.err_path, "wb") as err:
            out_file, err_file, in_file = out, err, subprocess.DEVNULL
            if stdout == "full":
                out_file = full = open("/dev/full", "wb")
            elif stdout == "unread":
                self.unread, out_file = os.pipe()
            if terminal:
                self.master, self.slave = os.openpty()
                in_file = err_file = self.slave
                self.modes = termios.tcgetattr(self.slave)
                os.set_blocking(self.master, False)
            if feed:
                in_file = subprocess.PIPE

            def prepare():
                if terminal and not feed:
                    fcntl.ioctl(0, termios.TIOCSCTTY, 0)
                if limits:
                    resource.setrlimit(resource.RLIMIT_FSIZE, (limits, limits))

            self.process = subprocess.Popen([case.program, *arguments], cwd=case.folder, stdin=in_file,
                                            stdout=out_file, stderr=err_file, env=environment,
                                            start_new_session=True, preexec_fn=prepare)
            if stdout == "full":
                full.close()
            elif stdout == "unread":
                os.close(out_file)
        if feed:
            os.set_blocking(self.process.stdin.fileno(), False)
        self.started = time.monotonic()

    def send(self, number):
        self.done.append(number.name)
        self.process.send_signal(number)

    def key(self, keys):
        if self.master is not None:
            self.done.append(f"key {keys!r}")
            os.write(self.master, keys)

    def measure(self):
        try:
            with open(f"/proc/{self.process.pid}/status") as file:
                found = re.search(r"VmHWM:\s+(\d+)", file.read())
            with open(f"/proc/{self.process.pid}/comm") as file:
                if found and file.read().startswith("isoprint"):
                    self.peak = max(self.peak, int(found[1]))
        except (FileNotFoundError, ProcessLookupError):
            pass

    def look(self):
        try:
            while self.master is not None and (piece := os.read(self.master, 65536)):
                self.seen += piece
        except OSError:
            pass

    def pour(self):
        """Some more of the job into the pipe."""
        data, manner = self.feed
        pipe = self.process.stdin
        if pipe.closed or time.monotonic() < self.feed_at:
            return
        size = 1 if manner == "bytes" else 30 if manner == "stalls" else 1 << 20
        for _ in range(64 if manner == "bytes" else 1):
            try:
                self.fed += os.write(pipe.fileno(), data[self.fed:self.fed + size]) if \
                    self.fed < len(data) else 0
            except BlockingIOError:
                return
            except BrokenPipeError:
                self.fed = len(data)
        if self.fed >= len(data):
            pipe.close()
        elif manner == "stalls" and self.case.timing.random() < 0.03:
            self.feed_at = time.monotonic() + self.case.timing.random() * 0.7

    def act(self, before):
        while self.actions:
            moment, action = self.actions[0]
            made = self.case.printer.count() - before
            if moment[0] == "lines" and made < moment[1] and made >= 0:
                return
            if moment[0] == "seconds" and time.monotonic() - self.started < moment[1]:
                return
            self.actions.pop(0)
            action(self)

    def follow(self):
        before = self.case.printer.count()
        while self.process.poll() is None:
            self.measure()
            self.look()
            if self.feed:
                self.pour()
            self.act(before)
            if time.monotonic() - self.started > LIMIT:
                self.process.send_signal(signal.SIGABRT)
                time.sleep(0.5)
                self.process.kill()
                self.process.wait()
                raise Broken(f"still runs after {LIMIT} s (done to it: {self.done})")
            time.sleep(0.004)
        if self.feed and not self.process.stdin.closed:
            self.process.stdin.close()
        self.look()
        self.check_terminal()
        with open(self.err_path, "rb") as file:
            self.errors = file.read() or self.seen
        with open(self.out_path, "rb") as file:
            self.output = file.read()
        return self.process.returncode

    def check_terminal(self):
        if self.master is None:
            return
        killed = self.process.returncode == -signal.SIGKILL
        same = killed or termios.tcgetattr(self.slave) == self.modes
        os.close(self.master)
        os.close(self.slave)
        if not same:
            raise Broken(f"the terminal is not as it was (done to it: {self.done})")


# ---- what is said ----

def check_errors(run, code):
    text = run.errors.decode("utf-8")  # raises, if it is none
    if "Sanitizer" in text or "runtime error:" in text:
        return f"a sanitizer says: {text[-3000:]}"
    if run.master is not None:
        text = text.replace("\r\x1b[K", "\r").replace("\r\n", "\n")
        if re.search(r"[^\x20-\x7e\n\r\t\x80-\U0010ffff]", re.sub(r"\^[C\\Z]|\x07", "", text)):
            return f"stderr holds control characters: {text[-300:]!r}"
        return None
    lines = text.split("\n")
    if lines.pop() and code != -signal.SIGKILL:
        return f"the last line of stderr is cut: {text[-200:]!r}"
    for line in lines:
        if line.startswith("ERROR: libumockdev-preload: ") and "printer killed" in run.done:
            continue
        if not line.startswith("isoprint: ") or re.search(r"[\x00-\x1f\x7f]", line):
            return f"a line of stderr that is none: {line!r}"
    if code > 0 and not lines:
        return f"ended with {code} without a word"
    return None


def check_output(run, code, uses_json):
    if run.stdout_kind or code < 0:
        return None
    if not uses_json:
        return f"stdout: {run.output[:200]!r}" if run.output else None
    events = []
    for line in run.output.decode("utf-8").split("\n")[:-1]:
        try:
            events.append(json.loads(line))
        except ValueError:
            return f"no JSON: {line[:300]!r}"
    if run.output[-1:] != b"\n" or not events or events[-1]["event"] != "end":
        return f"the last event is no end: {run.output[-200:]!r}"
    run.end = events[-1]
    if events[-1]["status"] != code and code != 7:
        return f"ended with {code}, told of {events[-1]['status']}"
    return None


def check_log(path, code):
    try:
        with open(path, "rb") as file:
            text = file.read().decode("ascii")
    except FileNotFoundError:
        return None
    lines = text.split("\n")
    if lines.pop() and code >= 0:
        return f"the last line of the log is cut: {text[-100:]!r}"
    for line in lines:
        if not re.fullmatch(r" *\d+\.\d{6} [<>#] [\x20-\x7e]*", line):
            return f"a line of the log that is none: {line!r}"
    return None


# ---- what was executed ----

def compare_whole(job, made):
    """Nothing happened: the file, and what hosts say of themselves."""
    rest = [line for line in made if not HOST.match(line)]
    if rest == job:
        return None
    at = next((i for i, pair in enumerate(zip(rest, job)) if pair[0] != pair[1]),
              min(len(rest), len(job)))
    return f"command {at}: {rest[at:at + 3]} instead of {job[at:at + 3]} ({len(rest)}, {len(job)})"


def telling(job):
    """Commands that only the file can have brought."""
    return [line for line in job if re.match(r"G1 X.*Y|M117|G4 P", line)]


def compare_once(job, made, whole):
    wanted = telling(job)
    known = set(wanted)
    found = [line for line in made if line in known]
    if found != wanted[:len(found)] or (whole and len(found) < len(wanted)):
        at = next((i for i, pair in enumerate(zip(found, wanted)) if pair[0] != pair[1]),
                  min(len(found), len(wanted)))
        return f"executed {found[at:at + 4]} instead of {wanted[at:at + 4]} at {at}"
    return compare_order(job, made) if whole else None


def compare_order(job, made):
    """All of the job, in order, whatever stands between; and that is a host's."""
    at, extra = 0, []
    for line in made:
        if at < len(job) and line == job[at]:
            at += 1
        else:
            extra.append(line)
    if at < len(job):
        return f"{job[at]} (command {at} of {len(job)}) is missing"
    strange = [line for line in extra if not HOST.match(line) and not RESTORING.match(line)]
    return f"what is that? {strange[:5]}" if strange else None


def compare_repeating(job, made, whole):
    """After a reset it may go back, but never leave anything out. Of moves alone: one that a reset
    threw out of the planner is not told of, while a text behind it already was."""
    wanted = [line for line in telling(job) if line.startswith("G1")]
    place = {line: i for i, line in enumerate(wanted)}
    next_one = furthest = 0
    for line in made:
        at = place.get(line)
        if at is None:
            continue
        if at > next_one and at > furthest:
            return f"{wanted[min(furthest, at)]} is left out before {line} (at {at})"
        if at > next_one:
            return f"{wanted[next_one]} is left out while going on before {line}"
        next_one = at + 1
        furthest = max(furthest, next_one)
    if whole and next_one != len(wanted):
        return f"the end is missing from {wanted[next_one:next_one + 2]} on ({len(wanted)})"
    return None


# ---- a case ----

class Case:
    def __init__(self, seed, program, printer, folder, usb):
        self.chance, self.seed, self.program, self.folder = random.Random(seed), seed, program, folder
        self.timing = random.Random(seed + 1)
        chance = self.chance
        self.runs, self.notes = 0, []
        self.allowed = {0}
        self.data, self.job_codes, self.job_kind = make_job(chance)
        self.job = commands_of(self.data)
        where = chance.choices(("pty", "socket", "tcp", "usb"), (40, 25, 10, 25 if usb else 0))[0]
        self.write("part.gcode", self.data)
        self.strict, self.noisy, self.dead = True, False, False
        self.needs_power = False  # switched off and on, to go on: it is halted
        options = self.choose_printer(where)
        self.script = self.choose_script()
        chip = chance.choice(CHIPS)
        self.printer = Printer(printer, folder, where, chip, options)
        self.notes.append(f"{self.job_kind} {len(self.job)} {where} {chip if where == 'usb' else ''} "
                          f"{' '.join(options)}")

    def write(self, name, data):
        with open(os.path.join(self.folder, name), "wb") as file:
            file.write(data)

    def choose_printer(self, where):
        chance = self.chance
        self.instant = chance.random() < 0.4
        self.speed = "instant" if self.instant else chance.choice(("50", "200", "1000"))
        self.rate = chance.choice((115200, 115200, 230400, 0))
        options = ["--speed", self.speed, "--rate", str(self.rate), "--boot-seconds",
                   chance.choice(("0.1", "1")), "--seed", str(self.seed % 1000)]
        if chance.random() < 0.4:
            options += ["--receive-bytes", chance.choice(("64", "128", "1024")), "--command-slots",
                        chance.choice(("1", "4", "16"))]
        if chance.random() < 0.2:
            options.append("--no-emergency-parser")
        if chance.random() < 0.3:
            options.append("--advanced-ok")
        self.resets_on_open = where in ("pty", "usb") and chance.random() < 0.5
        if not self.resets_on_open:
            options.append("--no-reset")
        if chance.random() < 0.3:
            self.noisy = True
            for fault, most in (("flip-in", 0.02), ("flip-out", 0.01), ("lose-ok", 0.01),
                                ("double-ok", 0.01), ("late-ok", 0.01), ("split", 0.2),
                                ("merge", 0.1), ("lose-bytes-in", 0.01)):
                if chance.random() < 0.4:
                    options += ["--" + fault, f"{chance.random() * most:.4f}"]
        options += self.choose_script()
        return options

    def choose_script(self):
        chance = self.chance
        kind = chance.choices(("", "harmless", "reset", "halt", "unplug", "silent"),
                              (45, 20, 8, 8, 14, 3))[0]
        if hasattr(self, "script_kind"):
            return self.script_kind
        self.script_kind = kind
        if not kind:
            return []
        count = max(2, len(self.job))
        line = chance.randrange(1, count + 12)
        fill = {"later": line + 10, "time": round(chance.random() * 60, 2),
                "byte": chance.randrange(1, count * 30)}
        steps = {"harmless": HARMLESS, "reset": RESETS, "halt": HALTS, "unplug": UNPLUGS,
                 "silent": SILENCES}[kind]
        step = chance.choice(steps).format(line, **fill)
        self.notes.append(step)
        if kind != "harmless":
            self.strict = self.strict and kind == "unplug"
        more = ["--do", step]
        if kind == "unplug":
            more += ["--replug", chance.choice(("0.1", "0.5"))]
        return more

    # -- what is done to a run

    def signal_of(self, number):
        def act(run):
            self.allowed.add(11)
            if number == signal.SIGQUIT:
                self.needs_power = True
            if number == signal.SIGKILL:
                self.allowed.add(-number)
                self.needs_power |= self.printer.where == "usb"  # umockdev keeps what it claimed
            if time.monotonic() - run.started < 2:
                self.allowed.add(-number)  # before they were caught
            run.send(number)
        return act

    def several_interrupts(self, run):
        self.allowed |= {11, -signal.SIGINT}
        self.heat_known, self.needs_power = False, True
        for _ in range(self.chance.choice((2, 3, 4))):
            run.send(signal.SIGINT)
            time.sleep(self.timing.random() * 0.05)

    def stop_host(self, run):
        run.send(signal.SIGSTOP)
        time.sleep(self.timing.choice((0.05, 0.5, 3)))
        run.send(signal.SIGCONT)

    def stop_printer(self, run):
        run.done.append("printer stopped")
        self.printer.process.send_signal(signal.SIGSTOP)
        time.sleep(self.timing.choice((0.05, 0.5, 2)))
        self.printer.process.send_signal(signal.SIGCONT)

    def kill_printer(self, run):
        run.done.append("printer killed")
        self.allowed |= {10, 9}
        if self.printer.where == "usb":
            self.allowed.add(-signal.SIGABRT)  # umockdev's library ends the program then
        self.strict = self.heat_known = False
        self.printer.end(brutal=True)
        self.dead = True

    def pause(self, run):
        run.key(b"p")
        run.paused_at = time.monotonic()
        run.actions.insert(0, (("seconds", run.paused_at - run.started + self.timing.random() * 1.5),
                               lambda run: run.key(self.chance.choice((b"r", b"\x1b[Br", b"rr?")))))
        run.actions.insert(1, (("seconds", run.paused_at - run.started + 4),
                               self.resume_until_done))

    def resume_until_done(self, run):
        """A pause that came late is resumed late, too."""
        run.key(b"r")
        run.actions.insert(0, (("seconds", time.monotonic() - run.started + 2),
                               self.resume_until_done))

    def cancel(self, run):
        if run.master is not None:
            self.allowed.add(11)
        run.key(b"c")
        time.sleep(self.timing.random() * 0.1)
        run.key(b"c")

    def emergency(self, run):
        if run.master is not None:
            self.allowed.add(11)
            self.needs_power = True
        run.key(b"!")

    def odd_keys(self, run):
        run.key(self.timing.choice((b"?", b"\x1b[A", b"c", b"\x13\x11", b"zzzz", b"\n", b"\x00",
                                    b"\x1a", bytes(range(32, 64)).replace(b"!", b"").replace(b"c", b""))))

    def truncate_job(self, run):
        self.allowed |= {3, 8, 2}
        self.changed = True
        run.done.append("job truncated")
        with open(os.path.join(self.folder, "part.gcode"), "r+b") as file:
            file.truncate(self.chance.randrange(len(self.data) + 1))

    def change_job(self, run):
        self.allowed |= {3, 8, 2}
        self.changed = True
        run.done.append("job changed")
        with open(os.path.join(self.folder, "part.gcode"), "r+b") as file:
            file.seek(self.chance.randrange(len(self.data) + 1))
            file.write(self.timing.choice((b"\nG4 P1\n", b"\0\0", b"M112\n", b"\n" * 300, b";" * 90)))

    def remove_job(self, run):
        run.done.append("job removed")
        path = os.path.join(self.folder, "part.gcode")
        os.rename(path, path + ".kept")
        self.write("part.gcode.tmp", self.data)
        os.rename(path + ".tmp", path)

    def choose_actions(self, calm):
        chance = self.chance
        count = 0 if calm else chance.choices((0, 1, 2, 3), (30, 45, 15, 10))[0]
        choices = [(self.signal_of(signal.SIGINT), 3), (self.signal_of(signal.SIGTERM), 3),
                   (self.signal_of(signal.SIGHUP), 2), (self.signal_of(signal.SIGQUIT), 2),
                   (self.signal_of(signal.SIGKILL), 10), (self.stop_host, 4), (self.stop_printer, 3),
                   (self.kill_printer, 4), (self.pause, 8), (self.cancel, 3), (self.emergency, 2),
                   (self.odd_keys, 4), (self.several_interrupts, 2), (self.truncate_job, 1),
                   (self.change_job, 1), (self.remove_job, 1)]
        actions = []
        for _ in range(count):
            action = chance.choices(*zip(*choices))[0]
            lines = ("lines", chance.randrange(len(self.job) + 15))
            actions.append((lines if chance.random() < 0.8 else
                            ("seconds", chance.random() * 3), action))
        return sorted(actions, key=lambda entry: (entry[0][0] == "seconds", entry[0][1]))

    # -- the runs

    def first_arguments(self):
        chance = self.chance
        how = chance.choices(("file", "pipe", "bytes", "stalls", "early", "fifo"),
                             (70, 8, 5, 7, 4, 0))[0]
        if len(self.data) > 1 << 20 and how in ("bytes", "stalls"):
            how = "pipe"
        feed = None
        if how == "early":
            self.data = self.data[:chance.randrange(1, len(self.data) + 1)] if self.data else b""
            self.job = commands_of(self.data)
            self.job_codes |= {0, 3}
        if how != "file":
            feed = (self.data, how)
        arguments = ["part.gcode" if not feed else "-", "--port", self.printer.port]
        self.baud = ["--baud", str(self.rate)] if self.rate else []
        arguments += self.baud
        journal = chance.choices(("", "journal", "none", "/none/journal", "/dev/full", "link"),
                                 (70, 10, 5, 2, 2, 2))[0]
        if journal == "link":
            os.symlink("/dev/full", os.path.join(self.folder, "link"))
        if journal:
            arguments += ["--journal", journal]
        if journal in ("/none/journal", "/dev/full", "link"):
            self.allowed |= {7, 2}
        self.journal = journal or ("part.gcode.journal" if not feed else None)
        return arguments, feed

    def told(self, number):
        """Where it tells: (arguments, kind of stdout)"""
        chance = self.chance
        arguments, stdout = [], None
        self.log = None
        if chance.random() < 0.5:
            self.log = chance.choices((f"log{number}", "/dev/full"), (10, 1))[0]
            arguments += ["--log", self.log]
            if self.log == "/dev/full":
                self.allowed.add(7)
        self.json = chance.random() < 0.5
        if self.json:
            arguments.append("--json")
            stdout = chance.choices((None, "full", "unread"), (20, 1, 2))[0]
            if stdout:
                self.allowed.add(7)
        if chance.random() < 0.3:
            arguments.append("-q")
        return arguments, stdout

    def one_run(self, arguments, feed, calm):
        number = self.runs + 1
        self.heat_known = True
        more, stdout = self.told(number)
        actions = self.choose_actions(calm)
        terminal = not feed and self.chance.random() < 0.35
        limits = self.chance.choice((1000, 5000, 20000)) if self.chance.random() < 0.03 and not calm \
            else 0
        if limits:
            self.allowed.add(7)
            self.dropped_journal = True
        run = Run(self, arguments + more, actions, feed, terminal, stdout, limits)
        code = run.follow()
        self.notes.append(f"{' '.join(arguments + more)}{' tty' if terminal else ''}"
                          f"{f' limit {limits}' if limits else ''} -> {code} "
                          f"{', '.join(run.done)} [{time.monotonic() - run.started:.1f} s, "
                          f"{run.peak} KiB, {self.printer.count() if not self.dead else '-'} made]")
        message = run.errors.decode(errors="replace").strip().split("\n")[-2:]
        if code:
            self.notes.append("   " + " / ".join(message)[-400:])
        for found in (check_errors(run, code), check_output(run, code, self.json),
                      check_log(os.path.join(self.folder, f"log{number}"), code)
                      if not limits else None):
            if found:
                raise Broken(found)
        sanitized = os.environ.get("ISOPRINT_SANITIZED") == "1"
        if run.peak > RSS and not sanitized:
            raise Broken(f"took {run.peak} KiB")
        return run, code

    def check_code(self, code):
        if self.script_kind == "reset":
            self.allowed |= {10}
        if self.script_kind == "halt":
            self.allowed |= {8, 10, 9}
        if self.script_kind == "unplug":
            self.allowed |= {10, 9}
        if self.script_kind == "silent":
            self.allowed |= {10, 9}
        if code not in self.allowed | self.job_codes:
            raise Broken(f"ended with {code}; to be expected: {sorted(self.allowed | self.job_codes)}")

    def next_arguments(self, run, code):
        """How to go on, or None."""
        text = run.errors.decode(errors="replace")
        found = re.search(r"to go on with the job: isoprint (.*?)\r?$", text, re.M)
        journal = self.journal and os.path.join(self.folder, self.journal)
        if found:
            words = shlex.split(found[1])
            at = words.index("--resume-from") + 1
            if not words[at].isdigit() and not os.path.exists(os.path.join(self.folder, words[at])):
                raise Broken(f"there is no {words[at]} to go on from")
            if words[at].isdigit():
                self.strict = False
            return words
        if code < 0 and journal and os.path.isfile(journal):
            with open(journal, "rb") as file:
                begun = file.read().count(b"\n") > 1
            if begun and "-" not in self.first[:1]:
                return ["--resume-from", self.journal]
            if begun:
                return ["-", "--resume-from", self.journal]
        return None

    def run_all(self):
        arguments, feed = self.first_arguments()
        self.first = arguments
        self.changed = self.dropped_journal = False
        code = None
        for turn in range(RUNS):
            self.allowed = {0} if turn == 0 else {0}
            if "/none/journal" in arguments or "/dev/full" in arguments or "link" in arguments:
                self.allowed |= {7, 2}
            if self.changed:
                self.allowed |= {2, 3, 8}
            if turn > 0 and (self.needs_power or self.script_kind == "halt") and not self.dead:
                self.printer.end(brutal=True)
                self.dead = True
            if self.dead:
                self.strict = self.strict and False
                self.printer.start()
                self.dead = self.needs_power = False
            before = len(self.printer.all_lines())
            run, code = self.one_run(arguments, feed, turn > RUNS - 4)
            self.check_code(code)
            if code in (0, 2, 3) or (code == 7 and self.is_whole()) or \
                    (code == 7 and turn > 0 and len(self.printer.all_lines()) == before):
                break
            if self.chance.random() < 0.15 and turn < RUNS - 2:
                break
            following = self.next_arguments(run, code)
            if following is None:
                if len(self.printer.all_lines()) > before and not self.dead:
                    self.strict = False
                if self.journal in ("none", None) or code == 8 or self.changed or \
                        self.dropped_journal or self.job_kind in ("nul", "long line", "forbidden"):
                    break
                following = list(self.first) + (["--yes"] if "--yes" not in self.first else [])
                if self.runs > 1 or self.printer.all_lines():
                    self.strict = None  # begun anew: nothing can be compared
            feed = (self.data, "pipe") if following[0] == "-" else None
            arguments = following + ["--wait", "20"]
            if self.baud and "--baud" not in arguments:
                arguments += self.baud
        self.conclude(run, code)

    def is_whole(self):
        made = [plain(line) for line in self.printer.all_lines()]
        return compare_repeating(self.job, made, True) is None

    def conclude(self, run, code):
        if code == 0 and not self.changed and self.journal not in (None, "none") and \
                os.path.exists(os.path.join(self.folder, self.journal)):
            raise Broken(f"{self.journal} is left after a success")
        ended_by_user = code == 11 and self.heat_known
        confirmed = getattr(run, "end", {}).get("heaters_off", False)
        made = self.printer.all_lines() if self.dead else None
        summary = None if self.dead else self.printer.end()
        made = [plain(line) for line in self.printer.made]
        if self.noisy:  # a line without its first bytes is no command, and harmless
            made = [line for line in made if re.match(r"[GMT]\d", line)]
        self.printer = None
        if summary:
            faults = [fault["code"] for fault in summary["faults"]]
            hot = "heater_left_on" in faults
            whole_job = bool(self.job) and self.job[-1] == "M84 " and not self.changed
            if hot and (confirmed or (code == 0 and whole_job)):
                raise Broken(f"heaters are on, although {code} and confirmed: {confirmed}")
            if hot and ended_by_user and not self.script_kind and not self.noisy and made:
                raise Broken("heaters are on after a cancelled job")
            if summary["undetectable"]:
                self.notes.append("undetectable damage")
                return
        if self.changed or self.strict is None or self.job_codes == {3} and not made:
            return
        bad = self.job_kind in ("nul", "long line", "forbidden")
        job = self.job
        whole = code == 0
        if bad:
            if code == 0:
                raise Broken("a job that is none was printed")
            return
        undisturbed = self.runs == 1 and code == 0 and not self.script_kind and \
            not any("key" in step for step in run.done)
        if undisturbed:
            found = compare_whole(job, made)
        elif self.strict and not self.resets_on_open:
            found = compare_once(job, made, whole)
        else:
            found = compare_repeating(job, made, whole)
        if found:
            raise Broken(found)


def check_case(seed, program, printer, keep, usb):
    """(seed, seconds, notes, what is wrong)"""
    started = time.monotonic()
    folder = tempfile.mkdtemp(prefix=f"print-{seed}-", dir=keep)
    case, wrong, notes = None, None, []
    try:
        case = Case(seed, program, printer, folder, usb)
        case.run_all()
    except Broken as broken:
        wrong = str(broken)
    except Exception as other:  # of this program, or of what it was told
        wrong = f"{type(other).__name__}: {other} (line {other.__traceback__.tb_lineno})"
        raise
    finally:
        if case:
            notes = case.notes
            if getattr(case, "printer", None) and not case.dead:
                try:
                    case.printer.end(brutal=True)
                except Exception:
                    pass
        if not wrong or not keep:
            shutil.rmtree(folder, ignore_errors=True)
    return seed, time.monotonic() - started, notes, wrong


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("printer")
    parser.add_argument("--seed", type=int, action="append", help="only this one")
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--cases", type=int, default=20)
    parser.add_argument("--seconds", type=float, help="as many cases as begin within")
    parser.add_argument("--usb", action="store_true", help="also devices by umockdev")
    parser.add_argument("--keep", help="folder for what is left of cases that fail")
    parser.add_argument("-v", "--verbose", action="store_true")
    parser.add_argument("-j", "--jobs", type=int, default=2)
    given = parser.parse_args()
    if given.keep:
        os.makedirs(given.keep, exist_ok=True)
    program, printer = os.path.abspath(given.program), os.path.abspath(given.printer)
    seeds = iter(given.seed or (range(given.first, given.first + given.cases) if not given.seconds
                                else range(given.first, given.first + (1 << 30))))
    end = time.monotonic() + (given.seconds or 1e9)
    failed = count = 0
    with concurrent.futures.ProcessPoolExecutor(given.jobs) as pool:
        running = set()
        exhausted = False
        while running or not exhausted:
            while len(running) < given.jobs and not exhausted:
                seed = next(seeds, None) if time.monotonic() < end else None
                exhausted = seed is None
                if not exhausted:
                    running.add(pool.submit(check_case, seed, program, printer, given.keep,
                                            given.usb))
            done, running = concurrent.futures.wait(
                running, return_when=concurrent.futures.FIRST_COMPLETED)
            for job in done:
                seed, seconds, notes, wrong = job.result()
                count += 1
                failed += bool(wrong)
                if given.verbose or wrong:
                    print(f"{seed}: {seconds:.1f} s\n   " + "\n   ".join(notes), flush=True)
                if wrong:
                    print(f"FAILED; again with --seed {seed}: {wrong}", flush=True)
    print(f"{count} cases, {failed} failed")
    return failed > 0


if __name__ == "__main__":
    sys.exit(main())
