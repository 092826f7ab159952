"""Boot the guest, let it go through scenarios, and keep what they left.

    boot.py RESULTS KERNELS ISOPRINT ISOPRINT-VIRTUAL SCENARIO...

Fetches the kernel into KERNELS unless it is there, makes the image, serves the far end of QEMU's own
USB serial adapter by a virtual printer on this side, runs QEMU without KVM, and unpacks what the
guest handed over into RESULTS, a folder made anew. check.py looks at the results, and fails for each
scenario that none came of; so this fails only if the guest came to no end and nobody else would tell.
"""
import pathlib
import shutil
import signal
import subprocess
import sys
import time

import job

HERE = pathlib.Path(__file__).resolve().parent
SECONDS = 220  # of the boot and all scenarios; they take a quarter of it on two idle cores
STILL = 60     # without a word on the console: its kernel has stopped, or waits for ever
REACHED_END = 0x10 * 2 + 1  # what isa-debug-exit makes of the 0x10 that init writes


def need_programs():
    for program, package in (("qemu-system-x86_64", "qemu-system-x86"), ("cpio", "cpio"),
                             ("/bin/busybox", "busybox-static")):
        if not shutil.which(program):
            sys.exit(f"{program} is missing: apt-get install {package}, or let ./dev test do it")


def make_image(folder, kernels, programs):
    kernel = subprocess.run([HERE / "fetch_kernel.sh", kernels], check=True, stdout=subprocess.PIPE,
                            text=True).stdout.strip()
    image = folder / "image.cpio.gz"
    files = {"job.gcode": job.text(), "rest.gcode": job.text(rest=True), "pulled.script": job.PULL}
    for name, text in files.items():
        (folder / name).write_text(text)
    subprocess.run([HERE / "make_image.sh", kernel, image, HERE / "init", HERE / "scenarios",
                    *(folder / name for name in files), *programs], check=True)
    (vmlinuz,) = (pathlib.Path(kernel) / "boot").glob("vmlinuz-*")
    return vmlinuz, image


def serve_printer(folder, printer):
    """A virtual printer for QEMU's adapter; returns its process once it listens."""
    path = folder / "adapter.sock"
    with open(folder / "adapter-printer.txt", "wb") as said:
        process = subprocess.Popen([printer, "--socket", path, "--speed", "50", "--rate", "0",
                                    "--executed", folder / "adapter-executed.txt"], stdout=said, stderr=said,
                                   stdin=subprocess.DEVNULL)
    for _ in range(100):
        if path.exists():
            return process, path
        if process.poll() is not None:
            break
        time.sleep(0.1)
    process.kill()
    sys.exit("the virtual printer did not listen:\n" + (folder / "adapter-printer.txt").read_text())


def run_qemu(folder, vmlinuz, image, socket, scenarios):
    # preempt=none, since vhci_hcd and one processor are a trap: usb_hcd_flush_endpoint() tries without
    # an end, with interrupts off, to give up a URB whose answer vhci_hcd's thread has half received.
    # That thread must not be made to wait there; we send answers in one piece, so that else it doesn't.
    command = [
        "qemu-system-x86_64", "-nodefaults", "-no-reboot", "-display", "none", "-accel", "tcg",
        "-cpu", "max", "-smp", "1", "-m", "256", "-kernel", vmlinuz, "-initrd", image,
        "-append", "console=ttyS0 quiet panic=-1 unknown_nmi_panic preempt=none "
                   f"scenarios={','.join(scenarios)}",
        "-serial", f"file:{folder}/console.txt", "-serial", f"file:{folder}/results.tar.gz",
        "-monitor", "stdio",
        "-device", "isa-debug-exit,iobase=0x501,iosize=1", "-device", "qemu-xhci",
        "-chardev", f"socket,id=adapter,path={socket}", "-device", "usb-serial,chardev=adapter"]
    begun = time.monotonic()
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL) as qemu:
        code = wait_for(qemu, folder / "console.txt", begun)
    print(f"QEMU ran {time.monotonic() - begun:.1f} s")
    return code


def wait_for(qemu, console, begun):
    """The code that QEMU ended with; None if it had to be ended."""
    size, heard = 0, begun
    while time.monotonic() < min(begun + SECONDS, heard + STILL):
        try:
            return qemu.wait(1)
        except subprocess.TimeoutExpired:
            pass
        if console.exists() and console.stat().st_size != size:
            size, heard = console.stat().st_size, time.monotonic()
    # Even with its interrupts off the kernel panics at this, and says on the console where it was.
    try:
        qemu.communicate(b"nmi\n", timeout=10)
    except subprocess.TimeoutExpired:
        qemu.kill()
    return None


def unpack(folder):
    """One archive a scenario, the last one perhaps cut off."""
    archives = folder / "results.tar.gz"
    done = subprocess.run(["tar", "-xz", "--ignore-zeros", "-f", archives, "-C", folder], check=False)
    return done.returncode == 0


def main():
    folder, kernels, *programs = map(pathlib.Path, sys.argv[1:5])
    scenarios = sys.argv[5:]
    need_programs()
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    vmlinuz, image = make_image(folder, kernels, programs)
    printer, socket = serve_printer(folder, programs[1])
    try:
        code = run_qemu(folder, vmlinuz, image, socket, scenarios)
    finally:
        printer.send_signal(signal.SIGTERM)
        try:
            printer.wait(20)
        except subprocess.TimeoutExpired:
            printer.kill()
    image.unlink()
    whole = unpack(folder) and code == REACHED_END
    print("" if whole else "the guest came to no end; ", "its console:", sep="")
    print((folder / "console.txt").read_text(errors="replace")[-8000:])
    there = sum((folder / name / "exit").exists() for name in scenarios)
    return 0 if whole or 0 < there < len(scenarios) else 1


if __name__ == "__main__":
    sys.exit(main())
