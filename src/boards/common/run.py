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


def run_semihosting(command, image, picture, seconds):
    """Runs to the firmware's own exit; returns its `name: value` lines."""
    name = picture.replace(",", ",,")
    command = command + ["-nographic", "-monitor", "none", "-serial", "none", "-icount", "shift=0",
                         "-semihosting-config", f"enable=on,target=native,arg={name}", "-kernel", image]
    try:
        result = subprocess.run(command, capture_output=True, text=True, timeout=seconds,
                                stdin=subprocess.DEVNULL, errors="replace")
    except subprocess.TimeoutExpired:
        fail(f"{image}: no end after {seconds} seconds")
    output = result.stdout + result.stderr
    values = dict(re.findall(r"^(\w+): (\d+)$", output, re.M))
    if result.returncode != 0:
        sys.stderr.write(output)
        fail(f"{image}: exit status {result.returncode}")
    return values


def run_uart(command, image, picture, seconds):
    """Captures the serial port until the picture is whole, as a board has no way to end the emulator."""
    command = command + ["-display", "none", "-monitor", "none", "-serial", f"file:{picture}",
                         "-kernel", image]
    process = subprocess.Popen(command, stdin=subprocess.DEVNULL)
    end = time.monotonic() + seconds
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
            time.sleep(0.1 if whole else 0.02)
    finally:
        process.kill()
        process.wait()


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
        part = args.picture + ".part"
        if os.path.exists(part):
            os.remove(part)
        command = shlex.split(args.qemu)
        values = {}
        if args.uart:
            run_uart(command, args.image, part, args.seconds)
        else:
            values = run_semihosting(command, args.image, part, args.seconds)
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
            counted = args.picture + ".rays"
            report["rays"] = int(run_semihosting(command, args.rays, counted, args.seconds)["rays"])
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
