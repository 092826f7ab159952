"""isoprint against far ends that are no printers, or hostile ones.

    test_hostile.py ISOPRINT [-v] [NAME...]

Each far end is a line of Python behind a socket, from the first byte or (..._later) once the job runs.
Whatever it does, isoprint must not crash, grow, press the emergency stop of its own accord, pass
control bytes on to the terminal, or outlive three interrupts.
"""
import concurrent.futures
import os
import random
import re
import select
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time

JOB = "".join(f"G1 X{i % 200} E0.01\n" for i in range(3000))
LATE = 3  # s until each interrupt
PATIENCE = 30  # s that the end may take after the third, on a busy machine
MOST = 20000 if os.environ.get("ISOPRINT_SANITIZED") != "1" else 400000  # KiB of memory
CODES = {0, 8, 9, 10, 11}


class Peer(threading.Thread):
    """Serves one host by a function of (line, send); `idle` is called when nothing came for 10 ms."""

    def __init__(self, path, answer, idle=None):
        super().__init__(daemon=True)
        self.answer, self.idle, self.lines = answer, idle, []
        self.listener = socket.socket(socket.AF_UNIX)
        self.listener.bind(path)
        self.listener.listen(1)
        self.start()

    def run(self):
        try:
            self.serve(self.listener.accept()[0])
        except OSError:
            pass

    def serve(self, host):
        held = b""
        host.settimeout(20)
        while True:
            if self.idle and not select.select([host], [], [], 0.01)[0]:
                self.idle(host.sendall)
                continue
            got = host.recv(4096)
            if not got:
                return
            *lines, held = (held + got).split(b"\n")
            for line in lines:
                self.lines.append(line)
                self.answer(line, host.sendall)


def number_of(line):
    found = re.match(rb"N(\d+)", line)
    return int(found[1]) if found else 0


def friendly(line, send):
    """As a Marlin would, as far as the handshake goes."""
    if b"M115" in line:
        send(b"FIRMWARE_NAME:Marlin 2.1 (test)\nCap:EMERGENCY_PARSER:1\nok\n")
    elif b"M105" in line:
        send(b"ok T:20.0 /0.0 B:20.0 /0.0 @:0 B@:0\n")
    elif echo := re.search(rb"M0*118 (\w+)", line):
        send(echo[1] + b"\nok\n")
    else:
        send(b"ok\n")


def after_greeting(answer):
    """Friendly until the first moves of the job, then `answer`."""
    seen = []

    def both(line, send):
        seen.append(b"G1" in line)
        (answer if sum(seen) > 20 else friendly)(line, send)
    return both


def memory_of(process):
    """KiB at most so far; what a parent's copy used before does not count, as it does in ru_maxrss."""
    try:
        with open(f"/proc/{process.pid}/status") as status:
            return int(re.search(r"VmHWM:\s+(\d+)", status.read())[1])
    except (OSError, TypeError):
        return 0


def finish(process):
    """Wait; interrupt it three times; kill it. Returns its exit code, memory, and signals it took."""
    memory = 0
    for signals, wait in enumerate((LATE, LATE, LATE, PATIENCE)):
        end = time.monotonic() + wait
        while time.monotonic() < end:
            memory = max(memory, memory_of(process))
            if process.poll() is not None:
                return process.returncode, memory, signals
            time.sleep(0.02)
        process.send_signal(signal.SIGINT if signals < 3 else signal.SIGKILL)
    return process.wait(PATIENCE), memory, 4


def meet(name):
    """Print to such a peer; returns what is wrong with how that went."""
    answer, idle = CASES[name]
    with tempfile.TemporaryDirectory() as folder:
        job, path = os.path.join(folder, "job.gcode"), os.path.join(folder, "peer")
        with open(job, "w") as file:
            file.write(JOB)
        peer = Peer(path, answer, idle)
        with open(os.path.join(folder, "said"), "w+b") as said:
            began = time.monotonic()
            code, memory, signals = finish(subprocess.Popen(
                [PROGRAM, job, "--port", f"socket:{path}", "--journal", "none"], stdin=subprocess.DEVNULL,
                stdout=said, stderr=said))
            said.seek(0)
            text = said.read()
    wrong = []
    if code not in CODES:
        wrong.append(f"it ended with {code}")
    if signals > 3:
        wrong.append("three interrupts did not end it")
    if memory > MOST:
        wrong.append(f"it used {memory} KiB")
    if re.search(rb"[\x00-\x08\x0b-\x1f\x7f]", text):
        wrong.append("control bytes reach the terminal")
    if signals < 2 and any(b"M112" in line for line in peer.lines):
        wrong.append("an emergency stop nobody asked for")
    if not text.startswith(b"isoprint: "):
        wrong.append("no word of what happened")
    if VERBOSE:
        print(f"{name}: {code} after {signals} signals, {time.monotonic() - began:.1f} s, "
              f"{len(peer.lines)} lines, {memory} KiB: {text.decode(errors='replace')[-230:]!r}", flush=True)
    return wrong


dice = random.Random(1)
NOISE = dice.randbytes(1 << 20)
ABSURD = (b"Resend: -1\n", b"Resend: 99999999999999999999\n", b"rs N4294967295\n", b"Resend:\n",
          b"Resend: 0x10\n")
PROMPT = b"//action:prompt_begin \x1b[2J\x07?\n//action:prompt_button a\n//action:prompt_show\n"


def with_each_answer(text):
    return lambda line, send: friendly(line, lambda answer: send(text + answer))


KINDS = {
    "rubbish": lambda line, send: send(NOISE),
    "rubbish_then_ok": lambda line, send: send(NOISE[:5000] + b"\nok\n"),
    "zeros": lambda line, send: send(bytes(10000) + b"\nok\n"),
    "endless_line": lambda line, send: send(b"ok " * 30000),
    "starts_again_at_every_line": lambda line, send: send(b"start\nok\n"),
    "wants_line_1_again": lambda line, send: send(b"Resend: 1\nok\n"),
    "wants_this_line_again": lambda line, send: send(b"Resend: %d\nok\n" % number_of(line)),
    "wants_line_to_come": lambda line, send: send(b"Resend: %d\nok\n" % (number_of(line) + 5)),
    "wants_absurd_lines": lambda line, send: send(dice.choice(ABSURD) + b"ok\n"),
    "claims_absurd_room": lambda line, send: send(b"ok N%d P99999999999 B99999999999\n"
                                                  % number_of(line)),
    "claims_negative_room": lambda line, send: send(b"ok N%d P-5 B-7\n" % number_of(line)),
    "ten_oks_a_line": with_each_answer(b"ok\n" * 9),
    "no_echo_no_temperatures": lambda line, send: send(b"ok\n"),
    "unknown_commands_all": lambda line, send: send(b'echo:Unknown command: "%s"\nok\n' % line),
    "error_at_every_line": lambda line, send: send(b"Error:something is wrong\nok\n"),
    "pauses_and_resumes": with_each_answer(b"//action:pause\n//action:resume\n"),
    "cancels_itself": with_each_answer(b"//action:cancel\n"),
    "asks_its_user": with_each_answer(PROMPT),
    "busy_for_ever": lambda line, send: send(b"echo:busy: processing\n"),
    "silent": lambda line, send: None,
    "nan_temperatures": lambda line, send: send(b"ok T:nan /inf B:-1e999 /1e999 @:0\n"),
    "half_an_ok": lambda line, send: send(b"o"),
    "escape_sequences": with_each_answer(b"echo:\x1b]0;x\x07\x1b[31m\r\n"),
}
CASES = {}
for name, answer in KINDS.items():
    CASES[name] = answer, None
    CASES[name + "_later"] = after_greeting(answer), None
CASES |= {
    "oks_unasked": (friendly, lambda send: send(b"ok\n" * 200)),
    "busy_unasked": (lambda line, send: None, lambda send: send(b"echo:busy: processing\n")),
    "wait_unasked": (lambda line, send: None, lambda send: send(b"wait\n")),
    "temperatures_unasked": (after_greeting(lambda line, send: None),
                             lambda send: send(b" T:20.0 /0.0 B:20.0 /0.0\n")),
    "noise_unasked": (friendly, lambda send: send(NOISE[:4000])),
}

if __name__ == "__main__":
    VERBOSE = "-v" in sys.argv
    PROGRAM, *names = [word for word in sys.argv[1:] if word != "-v"]
    names = names or list(CASES)
    with concurrent.futures.ThreadPoolExecutor(16) as pool:
        results = dict(zip(names, pool.map(meet, names)))
    for name, wrong in results.items():
        for line in wrong:
            print(f"WRONG {name}: {line}")
    print(f"{len(names)} far ends, {sum(map(bool, results.values()))} failed")
    sys.exit(any(results.values()))
