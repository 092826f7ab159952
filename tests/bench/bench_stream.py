"""How quickly isoprint streams, beside Printrun's printcore.

    bench_stream.py BUILD [--lines N] [--gigabytes N] [--only NAME]

BUILD is a folder that `./dev bench` built: isoprint, isoprint-virtual with its umockdev
module, instant-printer, wire-share, usb-limit.
Everything that is compared comes from this one run:

    pty     lines a second and CPU a line, over a pseudo terminal whose far end answers at once
    usb     lines a second over the stand-in for USB, and the most that its transport carries
    wire    share of a wire at 250000 baud, and native USB, on the virtual clock
    memory  the greatest memory in use while a gigabyte of G-code comes through a pipe
"""
import argparse
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time

GOALS = {"speed": 5, "cpu": 0.1, "wire": 0.95, "memory": 20e6}
# What else a machine does only adds to a cost; and on two cores it is by chance whether the two ends
# run on one of them or have to wake each other.
ROUNDS = 5
verdicts = []


def job(lines):
    return [f"G1 X{100 + i % 97 * 0.5:.3f} Y{50 + i % 89 * 0.7:.3f} E{i % 1000 * 0.01234:.5f}"
            for i in range(lines)]


def verdict(what, value, goal, good):
    verdicts.append(good)
    print(f"  {'good' if good else 'SHORT'}: {what} {value}, goal {goal}")


def memory_of(process):
    """Bytes at most so far. Of ru_maxrss a part is this program's own, from before the exec()."""
    try:
        text = pathlib.Path(f"/proc/{process}/status").read_text()
        return int(re.search(r"VmHWM:\s+(\d+)", text)[1]) * 1024
    except (OSError, TypeError):
        return 0


def spend(command, **options):
    """Run; returns (exit code, what it said, CPU seconds, greatest memory in bytes)."""
    memory = 0
    with tempfile.TemporaryFile() as said:
        process = subprocess.Popen(command, stdout=said, stderr=subprocess.STDOUT, **options)
        while True:
            done, status, usage = os.wait4(process.pid, os.WNOHANG)
            if done:
                break
            memory = max(memory, memory_of(process.pid))
            time.sleep(0.05)
        process.returncode = os.waitstatus_to_exitcode(status)
        said.seek(max(0, said.seek(0, 2) - 4000))
        text = said.read().decode(errors="replace")
    return process.returncode, text, usage.ru_utime + usage.ru_stime, memory


def instant_printer(build, folder):
    link = folder / "tty"
    process = subprocess.Popen([build / "tests/bench/instant-printer", link], stdout=subprocess.PIPE)
    while not link.exists():
        time.sleep(0.01)
    return process, link


def tally(process):
    process.send_signal(signal.SIGTERM)
    return json.loads(process.communicate()[0])


def with_printcore(build, folder, lines):
    """(lines/s, CPU a line): only of the print, without imports and reading the job."""
    sys.path.insert(0, "/usr/lib/python3/dist-packages")
    from printrun import gcoder, printcore
    process, link = instant_printer(build, folder)
    core = printcore.printcore(str(link), 250000)
    while not core.online:
        time.sleep(0.02)
    code = gcoder.LightGCode(job(lines))
    begun = time.process_time()
    core.startprint(code)
    while core.printing:
        time.sleep(0.05)
    spent = time.process_time() - begun
    core.disconnect()
    seen = tally(process)
    if seen["moves"] != lines:
        sys.exit(f"printcore printed {seen['moves']} of {lines} lines")
    return seen["moves"] / seen["seconds"], spent / lines


def with_isoprint(build, folder, lines):
    """The same of the whole process, with its start, greeting and end."""
    process, link = instant_printer(build, folder)
    gcode = folder / "job.gcode"
    gcode.write_text("\n".join(job(lines)) + "\n")
    code, said, spent, _ = spend([build / "firmware-io/cli/isoprint", gcode, "--port", f"tty:{link}",
                                  "--baud", "250000", "--journal", "none", "--quiet"],
                                 stdin=subprocess.DEVNULL)
    seen = tally(process)
    if code or seen["moves"] != lines:
        sys.exit(f"isoprint ended with {code} after {seen['moves']} of {lines} lines:\n{said}")
    return seen["moves"] / seen["seconds"], spent / lines


def bench_pty(build, folder, arguments):
    print("over a pseudo terminal whose far end answers at once: the best of five rounds, and the median")
    rounds = {"printcore": [], "isoprint": []}
    for _ in range(ROUNDS):
        rounds["printcore"].append(with_printcore(build, folder, arguments.lines // 80))
        rounds["isoprint"].append(with_isoprint(build, folder, arguments.lines // 4))
    best = {}
    for name, results in rounds.items():
        speeds, costs = sorted(speed for speed, _ in results), sorted(cpu for _, cpu in results)
        best[name] = speeds[-1], costs[0]
        print(f"  {name:10} {speeds[-1]:9.0f} lines/s  {costs[0] * 1e6:7.2f} us of CPU a line"
              f"  (median {speeds[ROUNDS // 2]:.0f} lines/s, {costs[ROUNDS // 2] * 1e6:.2f} us)")
    speed, cpu = (ours / theirs for ours, theirs in zip(best["isoprint"], best["printcore"]))
    verdict("times printcore's lines/s:", f"{speed:.1f}", GOALS["speed"], speed >= GOALS["speed"])
    verdict("of printcore's CPU a line:", f"{cpu:.4f}", GOALS["cpu"], cpu <= GOALS["cpu"])


def bench_wire(build, folder, arguments):
    print("on the virtual clock, moves of 0.1 mm")
    made = subprocess.run([build / "tests/bench/wire-share"], stdout=subprocess.PIPE, check=True)
    for name, row in json.loads(made.stdout).items():
        share = f", {row['share'] * 100:.1f} % of the wire" if "share" in row else ""
        print(f"  {name} at {row['speed']:g} mm/s: {row['lines_a_second']:.0f} lines/s{share}, enough "
              f"for {row['lines_a_second'] * 0.1:.0f} mm/s; planner empty {row['starved']} times, "
              f"{row['overruns']} bytes overrun, {row['resends']} resends")
        if "tells" in name:
            verdict("share of the wire:", f"{row['share']:.4f}", GOALS["wire"],
                    row["share"] >= GOALS["wire"])
        if name == "native":
            verdict("times the planner ran empty over native USB:", row["starved"], 0,
                    row["starved"] == 0)


def pour(pipe, size):
    """About `size` bytes of G-code as slicers write it; returns how many lines."""
    lines, block, poured = 0, "".join(line + "\n" for line in job(20000)).encode(), 0
    while poured < size:
        pipe.write(b"; layer\n" + block)
        poured += len(block) + 8
        lines += 20001
    pipe.close()
    return lines, poured


def bench_memory(build, folder, arguments):
    size = arguments.gigabytes * 1e9
    print(f"{arguments.gigabytes:g} GB of G-code from standard input")
    process, link = instant_printer(build, folder)
    reading, writing = os.pipe()
    begun = time.monotonic()
    child = os.fork()
    if child == 0:
        os.close(reading)
        with os.fdopen(writing, "wb", 1 << 20) as pipe:
            pour(pipe, size)
        os._exit(0)
    os.close(writing)
    with os.fdopen(reading, "rb") as pipe:
        code, said, spent, memory = spend(
            [build / "firmware-io/cli/isoprint", "-", "--port", f"tty:{link}", "--baud", "250000",
             "--journal", "none", "--window", "64:65536", "--quiet"], stdin=pipe)
    os.waitpid(child, 0)
    seen = tally(process)
    if code:
        sys.exit(f"isoprint ended with {code} after {seen['moves']} lines:\n{said}")
    print(f"  {seen['bytes'] / 1e9:.2f} GB over the wire in {time.monotonic() - begun:.0f} s, "
          f"{seen['lines']} lines, {spent:.0f} s of CPU")
    verdict("MB in use at most:", f"{memory / 1e6:.1f}", GOALS["memory"] / 1e6,
            memory < GOALS["memory"])


def on_usb(build, command):
    """Run a command that sees the virtual printer as a USB device which works in no time."""
    programs = build / "firmware-io/cli"
    return subprocess.run([programs / "isoprint-virtual", "--usb", "cdc-acm", "--rate", "0", "--no-reset",
                           "--speed", "instant", "--line-seconds", "0", "--boot-seconds", "0", "--quiet",
                           "--"] + command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          stdin=subprocess.DEVNULL, text=True)


def bench_usb(build, folder, arguments):
    print("over the stand-in for USB, one line at a time")
    lines = arguments.lines // 10
    gcode = folder / "usb.gcode"
    gcode.write_text("G28\n" + "G1 X100.000 Y100.000 F9000 E0.00000\n" * lines)
    limit = on_usb(build, [build / "tests/bench/usb-limit", str(lines)])
    ours = on_usb(build, [build / "firmware-io/cli/isoprint", gcode, "--port", "usb:2341:0042", "--json",
                          "--journal", "none", "--no-reset"])
    if limit.returncode or ours.returncode:
        sys.exit(f"usb-limit: {limit.stdout[-2000:]}\nisoprint: {ours.stdout[-2000:]}")
    most = float(limit.stdout.split()[-1])
    times = [json.loads(line) for line in ours.stdout.splitlines() if line.startswith("{")]
    states = {row["state"]: row["time"] for row in times if row["event"] == "state"}
    speed = lines / (states["finishing"] - states["printing"])
    print(f"  isoprint {speed:.0f} lines/s; the stand-in's own limit: {most:.0f} lines/s")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--lines", type=int, default=200000)
    parser.add_argument("--gigabytes", type=float, default=1)
    benches = {"pty": bench_pty, "usb": bench_usb, "wire": bench_wire, "memory": bench_memory}
    parser.add_argument("--only", choices=benches)
    arguments = parser.parse_args()
    sys.stdout.reconfigure(line_buffering=True)
    with tempfile.TemporaryDirectory() as folder:
        for name, bench in benches.items():
            if arguments.only in (None, name):
                bench(arguments.build.resolve(), pathlib.Path(folder), arguments)
    return 0 if all(verdicts) else 1


if __name__ == "__main__":
    sys.exit(main())
