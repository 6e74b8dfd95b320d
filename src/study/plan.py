"""make plan SCENE=... BOARD=... [SIZE=WxH CUTOFF=W] [MHZ=F WAITS=W SECONDS=S | ERROR=35dB]: which setting is worth
choosing.

Nothing is known of other scenes. The desktop draws pixels scattered over the whole picture (scattered.hpp) with every
setting, and better ones. Firmware of this very scene draws a small picture in QEMU, and what that takes is scaled by
the rays of both: first in each number system, then with each setting that may be worth choosing. Flash, RAM and stack
are those of firmware that is built for the whole picture. What was measured is kept in build/plan under a hash of all
that goes into it."""

import concurrent.futures
import math
import os
import re
import subprocess
import sys
import tempfile
import time

import numpy

sys.dont_write_bytecode = True
import cycles  # noqa: E402
import pictures  # noqa: E402
import runs  # noqa: E402
from settings import DEFAULT, Setting, options  # noqa: E402

FOLDER = "build/plan"
SAMPLES = ["1", "4", "9", "16", "a2,0.0625", "a3,0.03125"]
DEPTHS = [5, 3, 2, 1]
BETTER = Setting("double", "64", 8, DEFAULT.cutoff)  # what the others are compared with
DRAWING = 10  # seconds for pixels
BUILDING = 48  # seconds after which no firmware is begun
FIRST_PIXELS, WANTED_PIXELS = 1000, 24000  # to begin with, and at least where there is time
CERTAIN = 0.1  # dB of standard error that is enough
CERTAIN_RAYS = 0.01  # and of rays, as a share
DOUBT = 3  # standard errors within which dB may be otherwise;
UNSEEN = 32  # and one pixel more than was drawn may be off by so many levels
LOOKING = 6  # seconds for a whole picture to compare others with
INSTRUCTIONS = 2e8  # of a firmware run, about
GUESS = 2e4  # instructions a ray, before one is known
LEAST_GAIN = 0.5  # dB; less is not worth a row
SURE = 0.8  # of a setting's cost, which is known roughly at first, is surely less
start = time.monotonic()


def fail(text, status=2):
    print(f"plan: {text}", file=sys.stderr)
    raise SystemExit(status)


def say(text):
    print(f"{time.monotonic() - start:4.0f} s  {text}", file=sys.stderr, flush=True)


def positive(name, text, unit=""):
    try:
        value = float(text.removesuffix(unit))
    except ValueError:
        value = 0
    if not 0 < value < math.inf:
        of = f", of levels of 255, or of decibels with {unit}" if unit else ""
        fail(f"{name}={text}: expected a number above 0{of}")
    return value


class Question:
    def __init__(self, words):
        given = dict(w.split("=", 1) for w in words)
        self.scene, self.board = given.get("SCENE", ""), given.get("BOARD", "")
        boards = runs.boards()
        if self.board not in boards:
            fail(f"BOARD={self.board}: expected one of {', '.join(boards)}")
        if not self.scene:
            fail("no scene: SCENE=scenes/x.nff")
        self.mhz, self.seconds = (positive(k, given[k]) if given.get(k) else None for k in ("MHZ", "SECONDS"))
        waits = given.get("WAITS") or "0"
        if not re.fullmatch("[0-9]|1[0-5]", waits):
            fail(f"WAITS={waits}: expected wait states of the flash, 0 to 15")
        self.waits = int(waits)
        error = given.get("ERROR")
        self.decibels = error and (positive("ERROR", error, "dB") if error.endswith("dB")
                                   else 20 * math.log10(255 / positive("ERROR", error, "dB")))
        if self.seconds and not self.mhz:
            fail("SECONDS needs the board's clock: MHZ=48")
        self.size, self.cutoff = given.get("SIZE") or "-", given.get("CUTOFF") or str(DEFAULT.cutoff)
        self.compile("double", fail)

    def compile(self, number, refuse=lambda text, status: text):
        """What `qray compile` says, to `refuse`; None where the scene fits the number system."""
        size = [] if self.size == "-" else ["-s", self.size]
        done = subprocess.run(["build/qray", "compile", self.scene, "-q", "-n", number, "--cutoff", self.cutoff, *size,
                               "-o", "/dev/null"], capture_output=True, text=True)
        return refuse(done.stderr.strip().removeprefix("qray: "), done.returncode) if done.returncode else None


class Pixels:
    """What the desktop finds: {setting: what measure.cpp says of each comb of pixels}."""

    def __init__(self, question):
        own = (f"src/study/{name}" for name in ("measure.cpp", "scattered.hpp"))
        key = runs.hash_of(runs.tree_hash("include", "src/scene", *own), runs.text_of("build/obj/flags"),
                           runs.scene_text(question.scene), question.size)
        self.path = f"{FOLDER}/{key}.pixels.json"
        self.question, self.seen = question, {}
        self.head, known = runs.kept(self.path) or (None, [])
        self.known = {Setting(*s): of for s, of in known}
        if self.head is None:
            self.measure([], 0, 1)

    def measure(self, settings, first, last):
        """Combs first to last - 1."""
        self.head, *found = runs.measure(first, last, self.question.scene, self.question.size, BETTER, *settings)
        return dict(zip(settings, found))

    def draw(self, settings, count):
        """From now on, judges by so many combs, and by these settings."""
        self.count = count = min(count, self.head["combs"])
        short = {}
        for s in settings:
            short.setdefault(len(self.known.get(s, ())), []).append(s)
        for first, those in short.items():
            if first >= count:
                continue
            with concurrent.futures.ThreadPoolExecutor(runs.JOBS) as pool:
                middle = (first + count + 1) // 2
                parts = list(pool.map(lambda r: self.measure(those, *r), [(first, middle), (middle, count)]))
            for s in those:
                self.known[s] = self.known.get(s, []) + parts[0][s] + parts[1][s]
        runs.keep(self.path, [self.head, list(self.known.items())])

    def rays(self, setting):
        """Of the whole picture."""
        if setting in self.seen:
            return self.seen[setting]["rays"]
        of = self.known[setting][:self.count]
        return sum(rays for rays, *_ in of) / len(of) / self.head["length"] * self.head["width"] * self.head["height"]

    def squares(self, setting):
        """The mean square of each comb, in levels."""
        return numpy.array([of[1] for of in self.known[setting][:self.count]]) / self.head["length"] / 3

    def margin(self, squares):
        """By how much the mean of what so many pixels say may be off; the whole picture leaves no doubt."""
        n, whole = len(squares), self.head["combs"]
        if n == whole:
            return 0
        deviations = DOUBT * squares.std(ddof=1) / math.sqrt(n)
        return math.sqrt(1 - n / whole) * (deviations + UNSEEN ** 2 / (n * self.head["length"]))

    def decibels(self, setting, doubt=0):
        """As measured, or as they are at least (doubt=1) or at most (doubt=-1)."""
        of = self.squares(setting)
        mean = of.mean() + (doubt and doubt * self.margin(of))
        return pictures.decibels(max(0, mean))

    def gain(self, setting, over):
        """Decibels at most. Of the same pixels, what both have wrong leaves no doubt."""
        own, other = self.squares(setting), self.squares(over)
        return pictures.decibels(own.mean()) - pictures.decibels(other.mean() + self.margin(own - other))

    def look(self, settings):
        """Draws whole pictures, for their rays and for what an eye sees: {setting: {rays, flip, seen}}, without the
        last two where that takes too long."""
        kept = self.path.replace(".pixels.", ".seen.")
        self.seen = {Setting(*s): of for s, of in runs.kept(kept) or []}
        todo = [s for s in settings if s not in self.seen]
        if not todo:
            return
        size, scene = "{width}x{height}".format(**self.head), self.question.scene
        with tempfile.TemporaryDirectory() as folder:
            paths = {s: f"{folder}/{i}.ppm" for i, s in enumerate([*todo, BETTER])}
            said = [pictures.draw(scene, size, s, to=paths[s]) for s in todo]
            self.seen.update((s, {"rays": of["rays"]}) for s, of in zip(todo, said))
            rays = max(s["rays"] / s["camera_rays"] for s in said) * int(BETTER.samples)
            if rays * self.head["width"] * self.head["height"] / min(s["rays/second"] for s in said) <= LOOKING:
                pictures.draw(scene, size, BETTER, to=paths[BETTER])
                for s, of in zip(todo, pictures.flip(paths[BETTER], *(paths[s] for s in todo))):
                    self.seen[s].update(of)
        runs.keep(kept, list(self.seen.items()))

    def is_certain(self, setting):
        """Are rays and dB known as well as is wanted?"""
        of = numpy.array(self.known[setting][:self.count], float)
        mean = of.mean(0)
        rays, squares, _ = of.std(0) / math.sqrt(len(of)) / numpy.where(mean > 0, mean, 1)
        return rays < CERTAIN_RAYS and squares * 10 / math.log(10) < CERTAIN


def kind_of(setting):
    """Settings of a kind differ in numbers only, from which compilers may make other code."""
    way = "1" if setting.samples == "1" else "adaptive" if setting.samples[0] == "a" else "grid"
    return setting.number, way, setting.depth == 1


class Plan:
    def __init__(self, question):
        self.question, self.inputs = question, runs.Inputs()
        self.refused = {n: why for n in runs.numbers() if (why := question.compile(n))}
        self.settings = [Setting(n, s, d, question.cutoff) for n in runs.numbers() if n not in self.refused
                         for s in SAMPLES for d in DEPTHS]
        self.pixels = Pixels(question)
        # Double is never cheaper than float.
        pairs = [(s, s._replace(number="double")) for s in self.settings
                 if s.number == "float" and s.samples in "14" and s.depth == 5]
        self.count = math.ceil(FIRST_PIXELS / self.pixels.head["length"])
        count = self.count
        while pairs and "double" not in self.refused and count <= 8 * self.count:
            self.pixels.draw([s for pair in pairs for s in pair], count)
            if any(self.pixels.gain(double, single) >= LEAST_GAIN for single, double in pairs):
                count *= 2
                continue
            self.refused["double"] = "it is not more accurate than float"
            self.settings = [s for s in self.settings if s.number != "double"]
        self.size = "{width}x{height}".format(**self.pixels.head)
        self.per_ray, self.cycles = {}, {}  # by setting and by kind, instructions; by number, cycles of one
        self.built = {}  # by setting: flash, ram, stack_bound; or what was refused

    def run(self, setting, size, **more):
        return runs.Run(self.question.board, self.question.scene, setting.number, size, **more, **options(setting))

    def perform(self, todo):
        """[(setting, run), ...], two at a time while there is time; those that were."""
        done = []

        def one(pair):
            if time.monotonic() - start < BUILDING or pair[1].is_known(self.inputs):
                pair[1].perform(self.inputs)
                done.append(pair)
        with concurrent.futures.ThreadPoolExecutor(runs.JOBS) as pool:
            list(pool.map(one, todo))
        return done

    def small(self, setting):
        """The size of a picture that is drawn soon."""
        share = INSTRUCTIONS / self.ray(setting) / self.pixels.rays(setting)
        return self.size if share >= 1 else "x".join(str(max(1, round(self.pixels.head[k] * math.sqrt(share))))
                                                     for k in ("width", "height"))

    def ray(self, setting):
        """Instructions of a ray, or of one like it before they are known."""
        like = (setting, kind_of(setting), (setting.number, "1", False))
        return next((self.per_ray[k] for k in like if k in self.per_ray), GUESS)

    def learn(self, setting, run):
        """From a run: what a ray takes."""
        if "refused" not in run.result:
            self.per_ray[setting] = run.result["instructions"] / run.result["rays"]
            self.per_ray.setdefault(kind_of(setting), self.per_ray[setting])

    def is_measured(self, setting):
        return setting in self.built and setting in self.per_ray

    def instructions(self, setting):
        """Of the whole picture."""
        return self.ray(setting) * self.pixels.rays(setting)

    def cost(self, setting):
        """Instructions, or cycles where they are known."""
        return self.instructions(setting) * self.cycles.get(setting.number, 1)

    def able(self):
        return [s for s in self.settings if s.number not in self.refused and "refused" not in self.built.get(s, {})]

    def frontier(self):
        """Settings that no other is as accurate as and cheaper than. The cheapest first."""
        found = {s: (self.cost(s), self.pixels.decibels(s)) for s in self.able()}
        out, best, asked = [], -1, self.question.decibels or 0
        for s in sorted(found, key=lambda s: (found[s][0], -found[s][1])):
            if found[s][1] > best + LEAST_GAIN or found[s][1] >= asked > best:
                out.append(s)
                best = max(best, found[s][1])
        return out

    def promising(self):
        """Those that may be of the frontier, as far as so few pixels and costs of other settings tell."""
        cost, asked = {s: self.cost(s) for s in self.able()}, self.question.decibels or 0
        least = {s: self.pixels.decibels(s, 1) for s in cost}

        def may_be(setting):
            cheaper = [o for o in cost if cost[o] <= SURE * cost[setting]]
            return (max((least[o] for o in cheaper), default=-1) < asked <= self.pixels.decibels(setting, -1)
                    or all(self.pixels.gain(setting, o) >= LEAST_GAIN for o in cheaper))
        return [s for s in cost if may_be(s)]

    def measure(self):
        comb = self.pixels.head["length"]
        say(f"drawing pixels of {self.size} with {len(self.settings)} settings")
        count = self.count
        self.pixels.draw(self.settings, count)
        # Fewer levels than the rays have are a setting of their own only if they change something.
        known = {s: self.pixels.known[s][:count] for s in self.settings}
        self.settings = [s for s in self.settings if s.depth == 5 or known[s] != known[s._replace(depth=5)]]
        first = [next(s for s in self.settings if s.number == n)
                 for n in runs.numbers() if n not in self.refused]
        say(f"building {len(first)} number systems for {self.question.board}")
        for s, run in self.perform([(s, self.run(s, size=self.small(s))) for s in first]):
            self.learn(s, run)
            if "refused" in run.result:
                self.refused[s.number] = run.result["refused"]
        for s in first:
            if s not in self.per_ray:
                self.refused.setdefault(s.number, "there was no time to build it")
        if self.question.mhz and self.question.board in cycles.TIMINGS:
            calls = {s.number for s in self.promising()}
            todo = [(s, self.run(s, size="8x6", profile=True)) for s in first if s.number in calls]
            for s, run in self.perform(todo):
                if "refused" not in run.result:
                    taken = cycles.waiting(run.result, self.question.waits)
                    self.cycles[s.number] = taken / run.result["instructions"]
            self.cycles = {n: self.cycles.get(n, max(self.cycles.values(), default=1)) for n, *_ in first}
        begin, last = time.monotonic(), 0
        while self.pixels.count < self.pixels.head["combs"] and time.monotonic() + 2 * last - begin < DRAWING:
            self.settings = self.promising()
            if count * comb >= WANTED_PIXELS and all(self.pixels.is_certain(s) for s in self.settings):
                break
            count *= 2
            say(f"drawing {min(count, self.pixels.head['combs']) * comb} pixels with {len(self.settings)} settings")
            last = time.monotonic()
            self.pixels.draw(self.settings, count)
            last = time.monotonic() - last
        self.pixels.look(self.promising())
        while True:
            todo = self.by_interest([s for s in self.frontier() if not self.is_measured(s)])
            if not todo or time.monotonic() - start > BUILDING:
                break
            say(f"building {len(todo)} settings for {self.question.board}")
            pairs = [(s, self.run(s, size=size, build_only=size != small)) for s in todo
                     for small in [self.small(s)] for size in sorted({self.size, small})]
            done = self.perform(pairs)
            for s, run in done:
                if run.size == self.size or "refused" in run.result:
                    self.built[s] = run.result
                if not run.build_only:
                    self.learn(s, run)
            if not done:
                break

    def by_interest(self, settings):
        """Those next to what was asked for first, as time may end."""
        q = self.question
        if q.decibels:
            return sorted(settings, key=lambda s: abs(self.pixels.decibels(s) - q.decibels))
        if q.seconds:
            return sorted(settings, key=lambda s: abs(math.log(self.seconds(s) / q.seconds)))
        return settings

    def seconds(self, setting):
        return self.cost(setting) / (self.question.mhz * 1e6)

    def within(self, setting):
        q = self.question
        return (not q.seconds or self.seconds(setting) <= q.seconds) and (
            not q.decibels or self.pixels.decibels(setting) >= q.decibels)

    def command(self, setting, size=None):
        words = {"BOARD": self.question.board, "SCENE": self.question.scene, "NUMBER": setting.number,
                 "SIZE": size or self.size, **options(setting)}
        return "make run " + " ".join(f"{k}={v}" for k, v in words.items())


def table(plan, frontier, chosen):
    q, head = plan.question, plan.pixels.head
    print(f"{q.scene} on {q.board}, {plan.size} pixels")
    for n, why in plan.refused.items():
        print(f"without {n}: {why}")
    if not frontier:
        return
    dear = [n for n in runs.numbers() if n not in plan.refused and n not in {s.number for s in frontier}]
    if dear:
        print(f"without {', '.join(dear)}: other number systems have what is as accurate, to {LEAST_GAIN} dB, for less")
    drawn, whole = plan.pixels.count * head["length"], head["width"] * head["height"]
    doubt = max(abs(plan.pixels.decibels(s, d) - plan.pixels.decibels(s)) for s in frontier for d in (-1, 1))
    print(f"dB: against `build/qray {q.scene} {' '.join(pictures.words(BETTER))} -s {plan.size}`, by "
          + (f"{drawn} of its {whole} pixels, of which all may say {doubt:.1f} dB more or less" if drawn < whole
             else "all its pixels") + "; 99 is no difference")
    print("FLIP, seen: its mean, and the share of pixels where an eye sees a difference, against that picture"
          + ("" if any("flip" in of for of in plan.pixels.seen.values()) else ", which would take too long to draw"))
    if q.mhz:
        known = ", ".join(f"{n} {c:.2f}" for n, c in plan.cycles.items() if n in [s.number for s in frontier])
        known = known and f"by the core's timings ({known}), "
        known += f"{q.waits or 'no'} wait state" + "s" * (q.waits != 1) if known else ""
        print(f"seconds: at {q.mhz:g} MHz, cycles an instruction {known or 'unknown for this core, taken as 1'}")
    print(f"  {'number':7}{'samples':>18}{'depth':>6}{'instructions':>16}{'seconds' * bool(q.mhz):>10}{'dB':>7}"
          f"{'FLIP':>7}{'seen':>7}{'flash':>8}{'RAM':>7}{'stack':>7}")
    rough = False
    for s in frontier:
        built = plan.is_measured(s) and plan.built[s]
        rough |= not built
        sizes = [f"{built[k]}" for k in ("flash", "ram", "stack_bound")] if built else ["~"] * 3
        seconds = f"{plan.seconds(s):.3g}" if q.mhz else ""
        samples, seen = s.samples.replace("a", "adaptive "), plan.pixels.seen.get(s)
        eye = [f"{seen['flip']:.4f}", f"{seen['seen']:.1%}"] if seen and "flip" in seen else ["-"] * 2
        print(f"{'*' if s == chosen else ' '} {s.number:7}{samples:>18}{s.depth:>6}{'' if built else '~':>2}"
              f"{plan.instructions(s):14.0f}{seconds:>10}{plan.pixels.decibels(s):7.1f}"
              f"{eye[0]:>7}{eye[1]:>7}{sizes[0]:>8}{sizes[1]:>7}{sizes[2]:>7}")
    if chosen:
        within = f" within {q.seconds:g} s" if q.seconds else ""
        print("*: the " + (f"cheapest that has {q.decibels:.1f} dB" if q.decibels else "most accurate") + within)
    if rough:
        print("~: there was no time to build it; asked again, it will be")


def smaller(plan, setting):
    """The SIZE of a picture that takes no longer than was asked for, or None."""
    share = plan.question.seconds / plan.seconds(setting)
    while True:
        width, height = (int(plan.pixels.head[k] * math.sqrt(share)) for k in ("width", "height"))
        if width * height == 0:
            return None
        rays = pictures.draw(plan.question.scene, f"{width}x{height}", setting)["rays"]
        if rays * plan.seconds(setting) < 0.98 * plan.question.seconds * plan.pixels.rays(setting):
            return f"{width}x{height}"
        share *= 0.97


def what_would_have_to_give(plan, frontier):
    """Lines for where nothing is within what was asked for."""
    q = plan.question
    if not frontier:
        return nothing_fits(plan)
    able = [s for s in frontier if plan.pixels.decibels(s) >= (q.decibels or 0)]
    if not able:
        best = frontier[-1]
        return [f"nothing has {q.decibels:.1f} dB; the most accurate has {plan.pixels.decibels(best):.1f} dB:",
                plan.command(best)]
    seconds, size = plan.seconds(able[0]), smaller(plan, able[0])
    out = [f"{q.decibels:.1f} dB take {seconds:.3g} s" if q.decibels
           else f"nothing takes {q.seconds:g} s or less; the cheapest takes {seconds:.3g} s"]
    out[0] += f"; {q.mhz * seconds / q.seconds:.3g} MHz would do"
    if size:
        out[0] += ", or a smaller picture" + " (of other dB)" * bool(q.decibels) + ":"
        out.append(plan.command(able[0], size))
    quick = [s for s in frontier if plan.seconds(s) <= q.seconds]
    if quick:
        out += [f"or be content with {plan.pixels.decibels(quick[-1]):.1f} dB:", plan.command(quick[-1])]
    return out


def nothing_fits(plan):
    """The largest picture with the fewest rays that the board's memory holds."""
    w, h = plan.pixels.head["width"], plan.pixels.head["height"]
    why = next((b["refused"] for b in plan.built.values()), None) or next(reversed(plan.refused.values()))
    out = [f"no setting fits {plan.question.board}: {why}"]
    numbers = [n for n in runs.numbers() if any(s.number == n for s in plan.settings)]
    for step in range(16):
        size = f"{max(1, int(w * 0.8 ** step))}x{max(1, int(h * 0.8 ** step))}"
        for n in numbers:
            for depth in (5, 1):
                setting = Setting(n, "1", depth, plan.question.cutoff)
                run = plan.run(setting, size=size, build_only=True)
                run.perform(plan.inputs)
                if "refused" not in run.result:
                    return out + ["with a smaller picture or less depth it does:", plan.command(setting, size)]
                if step and run.result["refused"].startswith("flash"):
                    numbers = [m for m in numbers if m != n]
                    break
        if not numbers or time.monotonic() - start > BUILDING:
            break
    return out + ["no smaller picture helps: it takes fewer objects, or a larger board"]


def main():
    question = Question(sys.argv[1:])
    os.makedirs(FOLDER, exist_ok=True)
    runs.CACHE = FOLDER
    plan = Plan(question)
    plan.measure()
    frontier = plan.frontier()
    able = [s for s in frontier if plan.within(s)]
    wanted = question.seconds or question.decibels
    chosen = (able[0] if question.decibels else able[-1]) if wanted and able else None
    table(plan, frontier, chosen)
    if chosen:
        print(f"\n{plan.command(chosen)}")
    elif frontier and not wanted:
        print(f"\nfor example: {plan.command(frontier[-1])}\nMHZ= and SECONDS=, or ERROR=35dB, choose")
    else:
        sys.stdout.flush()
        first, *rest = what_would_have_to_give(plan, frontier)
        print("\n".join([f"plan: {first}"] + rest), file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
