"""Runs the tests given: programs of GoogleTest, and scripts. The last line says `N passed, N failed`; exit status
1 if any failed.

A script counts as its tests if it ends with such a line or with unittest's, else as one test by its exit status."""

import concurrent.futures
import os
import re
import subprocess
import sys
import time

LIMIT = 900  # seconds for one program


def command(path):
    if path.endswith(".py"):
        return [sys.executable, "-B", path]
    if path.endswith(".sh"):
        return ["bash", path]
    return [os.path.abspath(path), "--gtest_brief=1"]


def number(pattern, text):
    found = re.findall(pattern, text, re.M)
    return int(found[-1]) if found else 0


def count(path, text, status):
    """(passed, failed, skipped)"""
    own = re.findall(r"^(\d+) passed, (\d+) failed$", text, re.M)
    ran = number(r"^Ran (\d+) tests? in", text)
    if not path.endswith((".py", ".sh")):
        passed, failed = number(r"^\[  PASSED  \] (\d+) test", text), number(r"^\[  FAILED  \] (\d+) test", text)
        skipped = number(r"^\[  SKIPPED \] (\d+) test", text)
    elif own:
        passed, failed, skipped = int(own[-1][0]), int(own[-1][1]), 0
    elif ran:
        # Each failed subtest is a failure, though its test is counted once.
        failed = number(r"failures=(\d+)", text) + number(r"errors=(\d+)", text)
        skipped = number(r"skipped=(\d+)", text)
        passed = max(ran - failed - skipped, 0)
    else:
        passed, failed, skipped = int(status == 0), int(status != 0), 0
    if failed == 0 and (status != 0 or passed + skipped == 0):
        failed = 1
    return passed, failed, skipped


def run(path):
    environment = {k: v for k, v in os.environ.items() if k not in ("MAKEFLAGS", "MAKELEVEL", "MFLAGS")}
    environment.setdefault("UBSAN_OPTIONS", "print_stacktrace=1")
    start = time.monotonic()
    if not os.path.exists(path):
        return path, "it was not built", -1, 0
    try:
        result = subprocess.run(command(path), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT, env=environment, timeout=LIMIT)
        text, status = result.stdout.decode(errors="replace"), result.returncode
    except subprocess.TimeoutExpired as late:
        text, status = (late.stdout or b"").decode(errors="replace") + f"\nnot done after {LIMIT} s", -1
    return path, text, status, time.monotonic() - start


def main():
    passed = failed = 0
    with concurrent.futures.ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        for done in concurrent.futures.as_completed([pool.submit(run, path) for path in sys.argv[1:]]):
            path, text, status, seconds = done.result()
            good, bad, skipped = count(path, text, status)
            passed += good
            failed += bad
            note = f", {bad} FAILED" if bad else ""
            note += f", {skipped} skipped" if skipped else ""
            if bad:
                print(text.rstrip())
            print(f"{path}: {good} passed{note} ({seconds:.1f} s)", flush=True)
            if bad and status != 0:
                print(f"{path}: exit status {status}", flush=True)
    print(f"{passed} passed, {failed} failed")
    return failed != 0 or passed == 0


sys.exit(main())
