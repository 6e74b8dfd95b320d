"""Runs a firmware in QEMU and reports, one `name: value` a line, what it measured and what its file holds.

    run.py --tools PREFIX --tick T [--qemu COMMAND --picture OUT.ppm [--rays COUNTED.elf] [--uart]] FILE.elf

Without --qemu it reports sizes and the stack's bound only. A picture appears under its name only when whole.
"""

import argparse
import os
import re
import shlex
import subprocess
import sys
import time

sys.dont_write_bytecode = True
import elf as elf_file  # noqa: E402


def fail(text):
    raise SystemExit(f"run: {text}")


def header_end(data):
    """(width, height, bytes of the header) of a binary PPM's beginning, or None."""
    match = re.match(rb"P6\n(\d+) (\d+)\n255\n", data)
    return (int(match[1]), int(match[2]), match.end()) if match else None


def expect_whole(path, what):
    with open(path, "rb") as file:
        data = file.read()
    found = header_end(data)
    if found is None or len(data) != found[2] + 3 * found[0] * found[1]:
        fail(f"{what}: the picture is not whole: {len(data)} bytes")
    return found[0], found[1]


class Progress:
    """How much of a picture is in its file, and the time left, in a line on a terminal that is wiped at the end."""

    def __init__(self, what):
        self.what, self.shown, self.width = what, sys.stderr.isatty(), 0
        self.start = time.monotonic()

    def update(self, picture):
        past = time.monotonic() - self.start
        if not self.shown or past < 0.5 or not os.path.exists(picture):
            return
        with open(picture, "rb") as file:
            found = header_end(file.read(40))
        done = os.path.getsize(picture) - found[2] if found else 0
        if done <= 0:
            return
        total = 3 * found[0] * found[1]
        left = round(past * (total - done) / done)
        text = f"{self.what}: {100 * done // total} %, {left} s left"
        if left >= 60:
            text = f"{self.what}: {100 * done // total} %, {left // 60} min {left % 60} s left"
        sys.stderr.write("\r" + text.ljust(self.width))
        sys.stderr.flush()
        self.width = len(text)

    def wipe(self):
        if self.width:
            sys.stderr.write("\r" + " " * self.width + "\r")
            sys.stderr.flush()


def run_semihosting(command, image, picture, seconds, what):
    """Runs to the firmware's own exit; returns its `name: value` lines."""
    name = picture.replace(",", ",,")
    command = command + ["-nographic", "-monitor", "none", "-serial", "none", "-icount", "shift=0",
                         "-semihosting-config", f"enable=on,target=native,arg={name}", "-kernel", image]
    progress, end = Progress(what), time.monotonic() + seconds
    process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                               text=True, errors="replace")
    output = None
    try:
        while output is None:
            try:
                output, _ = process.communicate(timeout=0.2)
            except subprocess.TimeoutExpired:
                if time.monotonic() > end:
                    fail(f"{image}: no end after {seconds:.0f} seconds")
                progress.update(picture)
    finally:
        process.kill()
        process.wait()
        progress.wipe()
    values = dict(re.findall(r"^(\w+): (\d+)$", output, re.M))
    if process.returncode != 0:
        sys.stderr.write(output)
        fail(f"{image}: exit status {process.returncode}")
    return values


def run_uart(command, image, picture, seconds, what):
    """Captures the serial port until the picture is whole, as a board has no way to end the emulator."""
    command = command + ["-display", "none", "-monitor", "none", "-serial", f"file:{picture}",
                         "-kernel", image]
    process = subprocess.Popen(command, stdin=subprocess.DEVNULL)
    progress, end = Progress(what), time.monotonic() + seconds
    size, whole = 0, False
    try:
        while True:
            ended, last = process.poll(), size
            data = b""
            if os.path.exists(picture):
                with open(picture, "rb") as file:
                    data = file.read()
            size = len(data)
            message = re.search(rb"qray: [^\n]*\n", data)
            if message:
                fail(f"{image}: {message[0].decode(errors='replace').strip()}")
            found = header_end(data)
            if whole and size == last:  # and nothing has followed it
                return
            whole = found is not None and size >= found[2] + 3 * found[0] * found[1]
            if ended is not None:
                fail(f"{image}: the emulator ended with status {ended}")
            if time.monotonic() > end:
                fail(f"{image}: no whole picture after {seconds} seconds")
            progress.update(picture)
            time.sleep(0.1 if whole else 0.02)
    finally:
        process.kill()
        process.wait()
        progress.wipe()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("image")
    parser.add_argument("--tools", required=True)
    parser.add_argument("--tick", type=float, required=True)
    parser.add_argument("--qemu")
    parser.add_argument("--picture")
    parser.add_argument("--rays")
    parser.add_argument("--uart", action="store_true")
    parser.add_argument("--unbounded", action="store_true", help="run even if the stack has no bound")
    parser.add_argument("--seconds", type=float, default=600)
    args = parser.parse_args()

    image = elf_file.Elf(args.image)
    sizes = image.sizes()
    program = elf_file.Program(image, args.tools)
    bound, _ = program.bound(program.entry("start"))
    if program.problems and not args.unbounded:
        fail("the stack has no bound: " + "; ".join(program.problems))
    free = image.symbol("stack_top") - image.symbol("static_end")
    if bound > free:
        fail(f"{args.image}: the stack may take {bound} bytes, and {free} bytes of RAM are free")

    report = {"flash": sizes["flash"], "ram": sizes["ram"]}
    if args.qemu:
        part, counted = args.picture + ".part", args.picture + ".rays"
        for old in (part, counted):
            if os.path.exists(old):
                os.remove(old)
        command = shlex.split(args.qemu)
        values = {}
        if args.uart:
            run_uart(command, args.image, part, args.seconds, "drawing")
        else:
            values = run_semihosting(command, args.image, part, args.seconds, "drawing")
        width, height = expect_whole(part, args.image)
        pixels = width * height
        if "stack" in values:
            report["stack"] = int(values["stack"])
            if report["stack"] > bound + 112 * int(int(values["ticks"]) >= 1 << 24):
                fail(f"{args.image}: {report['stack']} bytes of stack, above the bound of {bound}")
    report["stack_bound"] = bound
    report["flash_total"], report["ram_total"] = sizes["flash_total"], sizes["ram_total"]
    if args.qemu:
        report["pixels"] = pixels
        if args.rays:
            counts = run_semihosting(command, args.rays, counted, args.seconds, "counting rays")
            report["rays"] = int(counts["rays"])
            with open(part, "rb") as one, open(counted, "rb") as other:
                if one.read() != other.read():
                    fail(f"{args.rays}: counting rays changed the picture")
            os.remove(counted)
        if "ticks" in values:
            instructions = int(values["ticks"]) * args.tick
            report["instructions"] = round(instructions)
            report["instructions/pixel"] = f"{instructions / pixels:.1f}"
            if args.rays:
                report["instructions/ray"] = f"{instructions / report['rays']:.1f}"
        os.replace(part, args.picture)
        report["picture"] = args.picture
    for name, value in report.items():
        print(f"{name}: {value}")


if __name__ == "__main__":
    main()
