"""Firmware runs: one `make run` each, at most two at a time, remembered in build/study/cache under a hash of
all that goes into it, so that what was measured once is not measured again until something changes."""

import concurrent.futures
import glob
import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
import threading
import time

import cycles
from pictures import words
from programs import fail, make, message_of, output_of, values
from settings import BOARDS, board_facts, boards, numbers  # noqa: F401

CACHE = "build/study/cache"
JOBS = min(2, len(os.sched_getaffinity(0)))
OPTIONS = ("SAMPLES", "ADAPTIVE", "DEPTH", "CUTOFF", "LIGHT_BITS", "ANIMATION", "FRAMES", "WITHIN")


def tree_hash(*folders):
    """Of the programs in these folders and files."""
    digest = hashlib.sha256()
    for folder in folders:
        inside = sorted(glob.glob(folder + "/**", recursive=True))
        for path in [folder] if os.path.isfile(folder) else inside:
            if path.endswith((".hpp", ".cpp", ".py", ".mk", ".ld")):
                with open(path, "rb") as file:
                    digest.update(path.encode() + b"\0" + file.read() + b"\0")
    return digest.hexdigest()


def keep(path, what):
    """Writes JSON that appears only whole, whoever else writes it."""
    part = f"{path}.{os.getpid()}.{threading.get_ident()}"
    with open(part, "w") as file:
        json.dump(what, file)
    os.replace(part, path)


def kept(path):
    """What was kept there, or None."""
    if os.path.exists(path):
        with open(path) as file:
            return json.load(file)


def hash_of(*what):
    return hashlib.sha256(json.dumps(what).encode()).hexdigest()[:24]


def text_of(path):
    with open(path, errors="surrogateescape") as file:
        return file.read()


def scene_text(path):
    """With the meshes beside it."""
    return "".join(map(text_of, [path, *sorted(glob.glob(os.path.join(os.path.dirname(path), "*.obj")))]))


def measure(first, last, scene, size, *settings):
    """What measure.cpp says of combs first to last - 1, compared with the first setting's."""
    own = [[*words(s), *([] if size == "-" else ["-s", size]), scene, ","] for s in settings]
    out = output_of("build/study/measure", f"{first}-{last}", *sum(own, [])[:-1])
    return [json.loads(line) for line in out.splitlines()]


class Inputs:
    """What every run depends on, read once."""

    def __init__(self):
        self.sources = tree_hash("include", "src/scene", "src/boards", "src/firmware")
        self.tracing = tree_hash("src/study/cycles.py")
        self.compilers = {}

    def compiler(self, board):
        tools = board_facts(board)["tools"]
        if tools not in self.compilers:
            if shutil.which(tools + "g++") is None:
                fail(f"BOARD={board} needs {tools}g++; `make deps` installs it")
            self.compilers[tools] = output_of(tools + "g++", "--version").splitlines()[0]
        return self.compilers[tools]


# Runs that should have worked, as (what, message); their results hold "refused", as of a scene that does not
# fit.
failures = []


class Run:
    """A firmware and what running it measures; `profile` runs it traced instead, `build_only` not at all."""

    def __init__(self, board, scene, number, size, profile=False, build_only=False, **options):
        self.board, self.scene, self.number, self.size = board, scene, number, size
        self.profile, self.build_only = profile, build_only
        self.options = {k: str(v) for k, v in options.items() if v is not None}
        assert all(k in OPTIONS for k in self.options)
        self.result = None

    def describe(self):
        name = os.path.basename(self.scene).removesuffix(".nff")
        options = "".join(f" {k.lower()} {v}" for k, v in self.options.items())
        board = BOARDS.get(self.board, self.board)
        return f"{board} {self.number} {name} {self.size}{options}{' profile' * self.profile}"

    def key(self, inputs):
        return hash_of(inputs.sources, inputs.compiler(self.board), self.board, scene_text(self.scene), self.number,
                       self.size, self.profile and inputs.tracing, self.build_only,
                       sorted(self.options.items()))

    def command(self, name):
        target = "size" if self.profile or self.build_only else "run"
        return [target, f"BOARD={self.board}", f"SCENE={self.scene}", f"NUMBER={self.number}", f"SIZE={self.size}",
                f"NAME={name}", *(f"{k}={v}" for k, v in self.options.items()), *(["FW_EXTRA=-g"] * self.profile)]

    def is_known(self, inputs):
        return os.path.exists(f"{CACHE}/{self.key(inputs)}.json")

    def perform(self, inputs):
        key = self.key(inputs)
        path = f"{CACHE}/{key}.json"
        self.result = kept(path)
        if self.result is not None:
            return
        name = f"study-{key}"
        self.result = cycles.measure(self, name) if self.profile else self.measure(self.command(name))
        if "refused" in self.result and not self.does_not_fit():
            failures.append((self.describe(), self.result["refused"]))
            return
        for left in glob.glob(f"build/{self.board}/{name}-{self.number}*"):
            shutil.rmtree(left) if os.path.isdir(left) else os.remove(left)
        keep(path, self.result)

    def does_not_fit(self):
        """The scene into the number system, or its firmware into the board."""
        check = ["build/qray", "compile", self.scene, "-q", "-n", self.number, "-o", "/dev/null"]
        too_large = re.search("will not fit|overflowed|too small|bytes of RAM are free", self.result["refused"])
        return subprocess.run(check, capture_output=True).returncode == 1 or too_large is not None

    def measure(self, command):
        status, said = make(*command)
        if status != 0:
            return {"refused": message_of(said)}
        return {k: int(v) if v == int(v) else v for k, v in values(said).items()}


def perform(runs, inputs=None):
    """Measures all, two at a time; shows progress and the time left."""
    os.makedirs(CACHE, exist_ok=True)
    inputs = inputs or Inputs()
    start, done = time.monotonic(), 0
    todo = [r for r in runs if not r.is_known(inputs)]
    for run in runs:
        if run not in todo:
            run.perform(inputs)
    if todo:
        print(f"{len(todo)} firmware runs, {len(runs) - len(todo)} more known", file=sys.stderr, flush=True)
    with concurrent.futures.ThreadPoolExecutor(JOBS) as pool:
        waiting = {pool.submit(run.perform, inputs): run for run in todo}
        try:
            for future in concurrent.futures.as_completed(waiting):
                future.result()
                done += 1
                left = (time.monotonic() - start) / done * (len(todo) - done)
                print(f"{done:4}/{len(todo)}  {left:5.0f} s left  {waiting[future].describe()}",
                      file=sys.stderr, flush=True)
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise
    for what, message in failures:
        print(f"failed: {what}: {message}", file=sys.stderr)
    return runs
