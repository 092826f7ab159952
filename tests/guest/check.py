"""Judge what one scenario of the guest left.

    check.py RESULTS NAME

Every judgement stands on exit codes, on the lines that the printer says it executed against those of
the job, on what sysfs said of the drivers, and on the control requests that the guest's kernel
itself wrote down. On failure all of it is shown.
"""
import pathlib
import re
import sys

import job

JOB = list(job.lines())
RESTING_JOB = list(job.lines(rest=True))
# Lines of the job that no host sends by itself, to bring the printer back to where it was.
BEADS = [line for line in JOB if "X" in line and "E" in line]

PLANNER_MOST = 40  # moves and lines that a board may hold when it is reset
# What a printer at 250000 bits/s can't do without, and Linux' own drivers send too: (type, request,
# value, data); data "" where each chip has its own way.
CODING_250000 = "90d00300000008"
ESSENTIAL = {
    "cdc_acm": [("21", "20", "0000", CODING_250000), ("21", "22", "0003", "")],
    "gadget": [("21", "20", "0000", CODING_250000), ("21", "22", "0003", "")],
    "ch340": [("40", "9a", "1312", ""), ("40", "9a", "2518", ""), ("40", "a4", "ff9f", "")],
    "ftdi": [("40", "03", "000c", ""), ("40", "04", "0008", "")],
    "qemu_ftdi": [("40", "03", "000c", ""), ("40", "04", "0008", "")],
    "cp2102": [("41", "1e", "0000", "90d00300"), ("41", "03", "0800", ""), ("41", "00", "0001", "")],
    "pl2303hx": [("21", "20", "0000", ""), ("21", "22", "0003", "")],
    "pl2303hxn": [("21", "20", "0000", CODING_250000), ("21", "22", "0003", "")],
}
# What Linux never sends: the line's end as the character at which an FTDI chip hands over what it has.
EVENT_CHARACTER = ("40", "06", "010a", "")
OURS_ALONE = {"ftdi": {EVENT_CHARACTER}, "qemu_ftdi": {EVENT_CHARACTER}}
DRIVER = {"cdc_acm": "cdc_acm", "gadget": "cdc_acm", "ch340": "ch341", "ftdi": "ftdi_sio",
          "qemu_ftdi": "ftdi_sio", "cp2102": "cp210x", "pl2303hx": "pl2303", "pl2303hxn": "pl2303"}
# Of the kernel's log: a defect of the kernel's or ours, or usbfs that had to guess what we meant.
COMPLAINTS = re.compile(r"\b(BUG|Oops|WARNING|Call Trace|did not claim interface|reset .* USB device)\b")


def plain(line):
    """A command as the job has it: isoprint may write zeros before a number, so that a flipped bit can't
    make of two commands one that passes."""
    return re.sub(r"^([A-Z])0+(?=\d)", r"\1", line.strip())


class Scenario:
    def __init__(self, results, name):
        self.results, self.name, self.folder, self.wrong = results, name, results / name, []

    def text(self, name):
        path = self.folder / name
        return path.read_text(errors="replace") if path.exists() else ""

    def expect(self, what, seen, wanted):
        if seen != wanted:
            self.wrong.append(f"{what}: {seen!r}, not {wanted!r}")

    def expect_exit(self, name, wanted):
        self.expect(f"exit code of {name}", self.text(f"{name}.exit").strip(), str(wanted))

    def executed(self, wanted):
        """Which of the wanted lines were executed, in that order."""
        known = set(wanted)
        place = "adapter-executed.txt" if self.name == "qemu_ftdi" else "executed.txt"
        path = (self.results if self.name == "qemu_ftdi" else self.folder) / place
        lines = path.read_text(errors="replace").splitlines() if path.exists() else []
        return [text for text in map(plain, lines) if text in known]

    def expect_executed(self, wanted):
        seen = self.executed(wanted)
        if seen == wanted:
            return
        at = next((i for i, pair in enumerate(zip(seen, wanted)) if pair[0] != pair[1]),
                  min(len(seen), len(wanted)))
        self.wrong.append(f"executed {len(seen)} lines of the job, not {len(wanted)}; the first that "
                          f"differs is {at}: {seen[at:at + 3]}, not {wanted[at:at + 3]}")

    def requests(self, name):
        """Class and vendor requests to the device (not to hubs): {(type, request, value, data)}."""
        found = set()
        for line in self.text(f"{name}.requests").splitlines():
            words = line.split()
            kind, request, value = words[5:8]
            if int(kind, 16) & 0x60 and kind not in ("23", "a3", "a0", "20"):
                data = "".join(words[words.index("=") + 1:]) if "=" in words else ""
                found.add((kind, request, value, data))
        return found


def check_print(scenario):
    """Through libusb and then through the kernel's driver, each exactly once; nothing is left behind."""
    scenario.expect_exit("usb", 0)
    scenario.expect_exit("tty", 0)
    scenario.expect_executed(JOB + JOB)
    if scenario.name != "qemu_ftdi":
        scenario.expect_exit("printer", 0)
    before, after = scenario.text("drivers_before.txt"), scenario.text("drivers_after.txt")
    bound = {line.split()[1] for line in before.splitlines()}
    scenario.expect("drivers at first", bound, {DRIVER[scenario.name]})
    scenario.expect("drivers afterwards", after, before)
    ours, theirs = scenario.requests("usb"), scenario.requests("tty") | scenario.requests("probe")
    for request in ESSENTIAL[scenario.name]:
        if request[:3] not in {one[:3] for one in ours} or (request[3] and request not in ours):
            scenario.wrong.append(f"isoprint never sent {request}")
        if request[:3] not in {one[:3] for one in theirs} or (request[3] and request not in theirs):
            scenario.wrong.append(f"Linux never sent {request}: the check itself is wrong")
    alone = ours - theirs - OURS_ALONE.get(scenario.name, set())
    scenario.expect("requests that Linux does not send", sorted(alone), [])


def check_taken_up(scenario):
    """Broken off with the code that says so, then taken up exactly where it broke off."""
    scenario.expect_exit("broken", 10)
    scenario.expect_exit("rest", 0)
    scenario.expect_exit("printer", 0)
    scenario.expect_executed(BEADS)


def check_taken_up_after_reset(scenario):
    """What the planner had when the board started anew is lost or was made: that is made again."""
    scenario.expect_exit("broken", 10)
    scenario.expect_exit("rest", 0)
    done = scenario.executed(BEADS)
    again = len(done) - len(BEADS)
    scenario.expect("few enough lines made again", 0 <= again <= PLANNER_MOST, True)
    least = [i for i in range(len(done)) if done[i:] == BEADS[i - again:] and done[:i] == BEADS[:i]]
    scenario.expect("the job's lines in order, none left out", least != [], True)


def check_listed(scenario):
    for name in ("list", "auto"):
        scenario.expect_exit(name, 0)
    for text in ("usb:2341:0042:VP0001", "usb:1a86:7523:VP0001", '"cdc-acm"', '"ch341"'):
        scenario.expect(f"{text} is listed", text in scenario.text("list.txt"), True)
    scenario.expect("the printer was asked", "M115" in scenario.text("executed.txt"), True)
    scenario.expect("the other was asked", "M115" in scenario.text("other.txt"), False)


def check_taken(scenario):
    scenario.expect_exit("first", 0)
    for name, holder in (("second", "isoprint (process"), ("third", ""), ("fourth", "cat (process")):
        scenario.expect_exit(name, 9)
        scenario.expect(f"{name} says who has it", holder in scenario.text(f"{name}.txt"), True)
    scenario.expect_executed(RESTING_JOB)
    scenario.expect("others' commands", "M112" in scenario.text("executed.txt"), False)
    scenario.expect_exit("printer", 0)


def check_denied(scenario):
    for name in ("usb", "tty"):
        scenario.expect_exit(name, 9)
        scenario.expect("the advice", "udev rules" in scenario.text(f"{name}.txt"), True)
    scenario.expect("executed", scenario.text("executed.txt"), "")


def check_killed(scenario):
    scenario.expect_exit("rest", 0)
    scenario.expect_exit("printer", 0)
    scenario.expect_executed(BEADS)


def check_kernel(scenario):
    lines = scenario.text("kernel.txt").splitlines()
    scenario.expect("complaints of the kernel", [x for x in lines if COMPLAINTS.search(x)], [])


CHECKS = {"pulled": check_taken_up, "pulled_and_reset": check_taken_up_after_reset,
          "deauthorised": check_taken_up, "killed": check_killed, "listed": check_listed,
          "taken": check_taken, "denied": check_denied, **dict.fromkeys(DRIVER, check_print)}


def main():
    results, name = pathlib.Path(sys.argv[1]), sys.argv[2]
    scenario = Scenario(results, name)
    if not (scenario.folder / "exit").exists():
        print(f"{name}: the guest stopped in it, or never got there; its console:")
        print((results / "console.txt").read_text(errors="replace")[-8000:])
        return 1
    scenario.expect("exit code of the scenario", scenario.text("exit").strip(), "0")
    CHECKS[name](scenario)
    check_kernel(scenario)
    for line in scenario.wrong:
        print(f"{name}: {line}")
    if scenario.wrong:
        for path in sorted(scenario.folder.glob("*")):
            print(f"---- {path.name}")
            print(path.read_text(errors="replace")[-6000:])
    return 1 if scenario.wrong else 0


if __name__ == "__main__":
    sys.exit(main())
