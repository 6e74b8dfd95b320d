"""Pictures of build/qray against those of an independent renderer in long double (tests/oracle), on every scene of
scenes/ and of tests/scenes/, in every number system but q16. After `make test-programs`.

Ends with a line `N passed, N failed`; exit status 1 if any failed."""

import concurrent.futures
import glob
import os
import re
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(ROOT, "src", "study"))
import pictures  # noqa: E402

QRAY = os.path.join(ROOT, "build", "qray")
ORACLE = os.path.join(ROOT, "build", "oracle")

# A picture may be off by more than one level in this share of its pixels, in %, and has at least so many dB.
WITHIN = {"double": (0.02, 90), "float": (0.5, 48), "q32": (0.15, 0), "q24": (1.5, 38)}
Q32_MOST = 75  # dB, on three scenes in four

# Scenes on which q32 is not as close as float, and why. No pixel may be off by more than a level.
FLOAT_IS_CLOSER = {
    "lights_inside": "7 of 76800 bytes are one off, where the light lies between two levels",
    "seethrough_shadows": "1 of 76800 bytes is one off",
}

DENSE = [["-r", "9"], ["-a", "4,0.02"]]  # many samples a pixel, of a quarter of the pixels
OPTIONS = [["-d", "1"], ["-d", "12", "--cutoff", "0"], ["--cutoff", "0.1"], ["-r", "4"], ["-a", "2"], *DENSE]
SAMPLED_SCENES = ["scenes/soft.nff", "scenes/images.nff"]  # with 4 samples, and adaptively
OPTION_SCENES = ["scenes/showcase.nff", "scenes/glass.nff", "tests/scenes/touching.nff"]

results = []


def check(name, fault):
    """fault: what is wrong, or nothing."""
    results.append(not fault)
    if fault:
        print(f"{name}: FAILED: {fault}", flush=True)


def size(scene):
    """160 wide, in the scene's own proportion; its own size for the scenes of the tests."""
    with open(scene, encoding="utf-8") as file:
        text = re.sub(r"#[^\n]*", " ", file.read())
    width, height = (int(float(n)) for n in re.search(r"\bresolution\s+(\S+)\s+(\S+)", text).groups())
    if "/tests/" in scene:
        return width, height
    return 160, max(1, round(160 * height / width))


def compare(a, b):
    """(share of pixels off by more than a level in %, dB: 99 where no byte differs)"""
    a, b = pictures.read(a), pictures.read(b)
    if a.shape != b.shape:
        raise ValueError(f"pictures of {a.shape} and {b.shape}")
    off = abs(a - b)
    return 100 * float((off.max(2) > 1).mean()), pictures.decibels(float((off ** 2).mean()))


def draw(program, scene, out, options):
    extra = ["-q"] if program == QRAY else []
    result = subprocess.run([program, *extra, *options, scene, "-o", out], stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT, text=True)
    if result.returncode != 0:
        raise ValueError(f"{os.path.basename(program)} {' '.join(options)} {scene}: {result.stdout.strip()}")


def closeness(folder, scene, options, numbers):
    """{number system: (share, dB)}"""
    stem = os.path.join(folder, re.sub(r"\W+", "_", scene + " ".join(options)))
    dimensions = ["-s", "%dx%d" % tuple(n // 2 if options in DENSE else n for n in size(scene))]
    draw(ORACLE, scene, stem + ".ppm", dimensions + options)
    found = {}
    for number in numbers:
        out = f"{stem}.{number}.ppm"
        draw(QRAY, scene, out, dimensions + options + ["-n", number])
        found[number] = compare(stem + ".ppm", out)
        os.remove(out)
    os.remove(stem + ".ppm")
    return found


def check_thresholds(name, found):
    for number, (share, decibels) in found.items():
        most, least = WITHIN[number]
        fault = []
        if share > most:
            fault.append(f"{share:.3f} % of pixels off by more than a level, allowed are {most} %")
        if decibels < least:
            fault.append(f"{decibels:.1f} dB, needed are {least}")
        check(f"{name} in {number}", "; ".join(fault))


def test_scene(folder, scene):
    name = os.path.basename(scene)[:-4]
    try:
        found = closeness(folder, scene, [], WITHIN)
    except (ValueError, OSError) as error:
        check(name, str(error))
        return None
    check_thresholds(name, found)
    share, decibels = found["q32"]
    if name in FLOAT_IS_CLOSER:
        check(f"{name}: q32 is off by a level at most", f"{share:.3f} % by more" if share > 0 else "")
    else:
        check(f"{name}: q32 is as close as float",
              "" if decibels >= found["float"][1] else "%.1f dB against %.1f" % (decibels, found["float"][1]))
    return decibels


def test_options(folder, scene, options):
    try:
        found = closeness(folder, os.path.join(ROOT, scene), options, WITHIN)
        check_thresholds(" ".join([os.path.basename(scene), *options]), found)
    except (ValueError, OSError) as error:
        check(scene, str(error))


def main():
    scenes = sorted(path for folder in ("scenes", "tests/scenes") for path in glob.glob(f"{ROOT}/{folder}/*.nff")
                    if "\nradiosity " not in open(path).read())  # which tests/test_radiosity.cpp has
    check("there are scenes to compare", "" if len(scenes) >= 20 else f"only {len(scenes)}")
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(2) as pool:
        jobs = [pool.submit(test_scene, folder, scene) for scene in scenes]
        others = [pool.submit(test_options, folder, scene, options) for scene in OPTION_SCENES for options in OPTIONS]
        others += [pool.submit(test_options, folder, scene, options) for scene in SAMPLED_SCENES
                   for options in (["-r", "4"], ["-a", "2"])]
        decibels = [job.result() for job in jobs]
        for job in others:
            job.result()
    close = sum(d is not None and d >= Q32_MOST for d in decibels)
    check(f"q32 reaches {Q32_MOST} dB on three scenes in four",
          "" if 4 * close >= 3 * len(decibels) else f"on {close} of {len(decibels)}")
    failed = results.count(False)
    print(f"{len(results) - failed} passed, {failed} failed")
    return failed != 0


sys.exit(main())
