"""Runs a firmware in QEMU and reports, one `name: value` a line, what it measured and what its file holds.

    run.py --tools PREFIX --tick T [--qemu COMMAND --picture OUT.ppm [--rays N] [--uart]] FILE.elf

Without --qemu it reports sizes and the stack's bound only. A picture appears under its name only when whole.
"""

import argparse
import math
import os
import re
import shlex
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True
import elf as elf_file  # noqa: E402


def fail(text):
    raise SystemExit(f"run: {text}")


frames = 1  # pictures, one behind another


def parts_of(path):
    """(bytes, bytes of the whole, pixels) of a binary PPM that may still grow."""
    if not os.path.exists(path):
        return 0, math.inf, 0
    with open(path, "rb") as file:
        head = re.match(rb"P6\n(\d+) (\d+)\n255\n", file.read(40))
    pixels = int(head[1]) * int(head[2]) if head else 0
    return os.path.getsize(path), frames * (head.end() + 3 * pixels) if head else math.inf, frames * pixels


class Progress:
    """How much of a picture is there, and the time left, in a line on a terminal that is wiped at the end."""

    def __init__(self):
        self.shown, self.width, self.start = sys.stderr.isatty(), 0, time.monotonic()

    def update(self, there, whole):
        past = time.monotonic() - self.start
        if not self.shown or past < 0.5 or there == 0 or whole == math.inf:
            return
        minutes, seconds = divmod(round(past * (whole - there) / there), 60)
        left = f"{minutes} min {seconds} s" if minutes else f"{seconds} s"
        text = f"drawing: {100 * there // whole} %, {left} left"
        print("\r" + text.ljust(self.width), end="", file=sys.stderr, flush=True)
        self.width = len(text)

    def wipe(self):
        if self.width:
            print("\r" + " " * self.width + "\r", end="", file=sys.stderr, flush=True)


def emulate(command, image, picture, seconds, is_over=lambda there, whole: False):
    """Runs to the emulator's end, or until the picture is_over; returns its status, or None, and what it said."""
    progress, end = Progress(), time.monotonic() + seconds
    with tempfile.TemporaryFile() as output:
        process = subprocess.Popen(command + ["-monitor", "none", "-kernel", image], stdin=subprocess.DEVNULL,
                                   stdout=output, stderr=subprocess.STDOUT)
        try:
            while process.poll() is None:
                there, whole, _ = parts_of(picture)
                if is_over(there, whole):
                    return None, ""
                if time.monotonic() > end:
                    fail(f"{image}: no whole picture after {seconds:.0f} seconds")
                progress.update(there, whole)
                time.sleep(0.02)
        finally:
            process.kill()
            process.wait()
            progress.wipe()
        output.seek(0)
        return process.returncode, output.read().decode(errors="replace")


def run_semihosting(command, image, picture, seconds):
    """Runs to the firmware's own exit; returns its `name: value` lines."""
    name = picture.replace(",", ",,")
    status, said = emulate(command + ["-nographic", "-serial", "none", "-icount", "shift=0", "-semihosting-config",
                                      f"enable=on,target=native,arg={name}"], image, picture, seconds)
    if status != 0:
        sys.stderr.write(said)
        fail(f"{image}: exit status {status}")
    found = re.findall(r"^(\w+): 0x([0-9a-f]+)(?: 0x([0-9a-f]+))?$", said, re.M)
    return {name: int(high + low, 16) for name, high, low in found}


def run_uart(command, image, picture, seconds):
    """Captures the serial port until the picture is whole, as a board has no way to end the emulator."""
    def message():
        if os.path.exists(picture):
            with open(picture, "rb") as file:
                return re.search(rb"qray: ([^\n]*)\n", file.read())

    def is_over(there, whole):
        if there < whole:
            return message()
        time.sleep(0.1)
        return os.path.getsize(picture) == there  # nothing has followed it

    status, _ = emulate(command + ["-display", "none", "-serial", f"file:{picture}"], image, picture, seconds, is_over)
    if message():
        fail(f"{image}: qray: {message()[1].decode(errors='replace')}")
    if status is not None:
        fail(f"{image}: the emulator ended with status {status}")
    return {}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("image")
    parser.add_argument("--tools", required=True)
    parser.add_argument("--tick", type=float, required=True)
    parser.add_argument("--qemu")
    parser.add_argument("--picture")
    parser.add_argument("--rays", type=int)
    parser.add_argument("--frames", type=int, default=1)
    parser.add_argument("--uart", action="store_true")
    parser.add_argument("--unbounded", action="store_true", help="run even if the stack has no bound")
    parser.add_argument("--seconds", type=float, default=600)
    args = parser.parse_args()
    global frames
    frames = args.frames

    image = elf_file.Elf(args.image)
    sizes = image.sizes()
    program = elf_file.Program(image, args.tools)
    bound, _ = program.bound(image.symbol("start"))
    if program.problems and not args.unbounded:
        fail("the stack has no bound: " + "; ".join(program.problems))
    free = image.symbol("stack_top") - image.symbol("static_end")
    if bound > free:
        fail(f"{args.image}: the stack may take {bound} bytes, and {free} bytes of RAM are free")

    report = {"flash": sizes["flash"], "ram": sizes["ram"]}
    if args.qemu:
        part = args.picture + ".part"
        if os.path.exists(part):
            os.remove(part)
        run = run_uart if args.uart else run_semihosting
        values = run(shlex.split(args.qemu), args.image, part, args.seconds)
        there, whole, pixels = parts_of(part)
        if there != whole:
            fail(f"{args.image}: the picture is not whole: {there} bytes")
        if "stack" in values:
            report["stack"] = values["stack"]
            if values["stack"] > bound + 112 * (values["ticks"] >= 1 << 24):
                fail(f"{args.image}: {report['stack']} bytes of stack, above the bound of {bound}")
    report["stack_bound"] = bound
    report["flash_total"], report["ram_total"] = sizes["flash_total"], sizes["ram_total"]
    report["must fit"] = "flash, and ram + stack_bound; the totals have what only QEMU needs, too"
    if args.qemu:
        report["pixels"] = pixels
        if args.rays:
            report["rays"] = args.rays
        if "ticks" in values:
            instructions = values["ticks"] * args.tick
            report["instructions"] = round(instructions)
            if frames > 1:
                report["instructions/frame"] = round(instructions / frames)
            report["instructions/pixel"] = f"{instructions / pixels:.1f}"
            if args.rays:
                report["instructions/ray"] = f"{instructions / args.rays:.1f}"
        os.replace(part, args.picture)
        report["picture"] = args.picture
    for name, value in report.items():
        print(f"{name}: {value}")


if __name__ == "__main__":
    main()
