"""Boot the guest, let it go through scenarios, and keep what they left.

    boot.py RESULTS KERNELS ISOPRINT ISOPRINT-VIRTUAL SCENARIO...

Fetches the kernel into KERNELS unless it is there, makes the image, serves the far end of QEMU's own
USB serial adapter by a virtual printer on this side, runs QEMU without KVM, and unpacks what the
guest handed over into RESULTS, a folder made anew. Fails unless the guest's script came to its end.
check.py looks at the results.
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
    command = [
        "qemu-system-x86_64", "-nodefaults", "-no-reboot", "-display", "none", "-accel", "tcg",
        "-cpu", "max", "-smp", "1", "-m", "256", "-kernel", vmlinuz, "-initrd", image,
        "-append", f"console=ttyS0 quiet panic=-1 scenarios={','.join(scenarios)}",
        "-serial", f"file:{folder}/console.txt", "-serial", f"file:{folder}/results.tar.gz",
        "-device", "isa-debug-exit,iobase=0x501,iosize=1", "-device", "qemu-xhci",
        "-chardev", f"socket,id=adapter,path={socket}", "-device", "usb-serial,chardev=adapter"]
    begun = time.monotonic()
    try:
        code = subprocess.run(command, stdin=subprocess.DEVNULL, timeout=SECONDS).returncode
    except subprocess.TimeoutExpired:
        code = None
    print(f"QEMU ran {time.monotonic() - begun:.1f} s")
    return code


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
    if code == REACHED_END:
        subprocess.run(["tar", "-xzf", folder / "results.tar.gz", "-C", folder], check=True)
        print((folder / "times.txt").read_text(), end="")
        return 0
    print("the guest came to no end" if code is None else f"QEMU ended with {code}", "; its console:")
    print((folder / "console.txt").read_text(errors="replace")[-8000:])
    return 1


if __name__ == "__main__":
    sys.exit(main())
