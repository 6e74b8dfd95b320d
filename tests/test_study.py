"""make study, in its quick form, and the parts of it whose results are known without measuring.
From the top of the repository: python3 tests/test_study.py"""

import csv
import os
import re
import sys
import types
import unittest
import xml.etree.ElementTree

sys.dont_write_bytecode = True
sys.path.insert(0, "src/study")
import cycles  # noqa: E402
import bits  # noqa: E402
import figures  # noqa: E402
import ladder  # noqa: E402
import report  # noqa: E402
import settings  # noqa: E402
import study  # noqa: E402
from programs import make  # noqa: E402


def problems(text, reports):
    """What is missing or not known in the tables."""
    out = [f"report:{name} is empty" for name, content
           in re.findall(r"<!-- report:(\S+) -->(.*?)<!-- /report -->", text, re.S)
           if name not in reports and not content.strip()]
    for name, (_, needs) in reports.items():
        found = report.marker(name).search(text)
        if found is None:
            out.append(f"no '<!-- report:{name} -->' ... '<!-- /report -->' in {' or '.join(report.PAGES)}")
            continue
        out += [f"report:{name} says nothing of '{n}'; `make report` writes it again"
                for n in needs() if n not in found[0]]
    return out


class Parts(unittest.TestCase):
    def test_frontier(self):
        points = [(5, 30), (1, 10), (4, 10), (2, 20), (3, 15), (5, 31), (9, 31)]
        self.assertEqual(figures.frontier_of(points), [(1, 10), (2, 20), (5, 31)])

    def test_ladder_says_one_thing_more_in_each_step(self):
        steps = ladder.write("build/study/ladder")
        texts = []
        for _, path, _ in steps:
            with open(path) as file:
                texts.append(file.read().split())
        for (name, _, options), before, after in zip(steps[1:], texts, texts[1:]):
            words = dict((n, w) for n, w, _ in ladder.STEPS)[name].split()
            changed = len(after) - len(before)
            self.assertIn(changed, (len(words), 0), name)
            self.assertTrue(before != after or options, name)

    def test_bits_that_are_needed_and_what_they_predict(self):
        b = bits.Bits.__new__(bits.Bits)
        b.bits = [4, 6, 8]
        rows = [50, 61, 70], [61, 50, 70], [70, 61, 60], [1, 2, 3]
        self.assertEqual([b.needed(row, 60) for row in rows], [6, 8, 4, None])
        # Squares that make 0 dB each, of a shade or of an edge: three edges of 2, 3 and 6 are as far as one of 7. Each
        # bit fewer doubles what an edge is off by.
        one = 255 ** 2

        def predicted(pixels):
            alone = [[[one, one * 2, pixels], [one, one * 2, pixels], 0],
                     [[one * 2, 0, 0], [one * 9, one * 48, 16 * pixels], 4], [[0, one * 6, 0], [0, one * 6, 0], 0]]
            b.found = {"s": {"levels": 1, "larger": 4, "alone": {"n": alone},
                             "reached": {"n": [[one * 4, 0, 0], [0, one * 40, 9]]}}}
            return [round(v, 6) for v in b.predicted("s", "n")]
        self.assertEqual(predicted(1), [0, -10, -10])
        self.assertEqual(predicted(0.125), [0, -10, -10])  # 0.177 pixels, in the larger picture 0.7
        self.assertEqual(predicted(0.0625), [0, -10, -4.771213])  # 0.35: none

    def test_report_finds_stale_tables(self):
        reports = {"one": (None, lambda: ["a", "b"])}
        self.assertEqual(problems("<!-- report:one -->\na b\n<!-- /report -->", reports), [])
        self.assertEqual(len(problems("<!-- report:one -->\na\n<!-- /report -->", reports)), 1)
        self.assertEqual(len(problems("", reports)), 1)
        self.assertEqual(len(problems("<!-- report:one -->\na b\n<!-- /report -->\n"
                                             "<!-- report:two -->\n<!-- /report -->", reports)), 1)

    def test_labels_name_what_differs(self):
        self.assertEqual(settings.label(settings.DEFAULT), "q32")
        self.assertEqual(settings.label(("float", "4", 5, 0.0014)), "float 4×")
        self.assertEqual(settings.label(("q32", "a2,0.0625", 3, 0.0014)), "a2 depth 3")


class Cycles(unittest.TestCase):
    @staticmethod
    def saved(*lines, times=10):
        """Of instructions in a row, each run `times` times."""
        code = {4 * k: types.SimpleNamespace(name=line.split()[0], operands=line.partition(" ")[2], next=4 * k + 4,
                                             kind=cycles.elf_file.PLAIN) for k, line in enumerate(lines)}
        return cycles.dual_issue(types.SimpleNamespace(at=code.get), dict.fromkeys(code, times))

    def test_two_instructions_issue_at_once(self):
        self.assertEqual(self.saved("adds r0, r1, r2", "subs r3, r4, r5"), 10)
        self.assertEqual(self.saved("adds r0, r1, r2", "subs r3, r4, r5", "eors r6, r4"), 10)  # the third alone
        self.assertEqual(self.saved("adds r0, r1, r2", "subs r3, r0, r5"), 0)
        self.assertEqual(self.saved("umull r0, r1, r2, r3", "adds r4, r1, r5"), 0)
        self.assertEqual(self.saved("ldr r0, [r1]", "ldr r2, [r1, #4]"), 0)
        self.assertEqual(self.saved("ldr r0, [r1]", "adds r2, r0, r3"), -10)  # the load's result is late
        self.assertEqual(self.saved("str r0, [r1]", "adds r2, r0, r3"), 10)
        self.assertEqual(self.saved("push {r4, lr}", "adds r2, r0, r3"), 0)

    # As the manuals say it: on the M0 a push of N is 1 + N, a pop that returns 4 + N; on the M3 a taken branch is 1,
    # and 1 to 3 to refill the pipeline.
    def test_cycles_of_an_instruction(self):
        def cost(board, operands, kind):
            return cycles.cost(board, types.SimpleNamespace(operands=operands), kind)
        self.assertEqual(cost("microbit", "{r4, r5, lr}", "load or store several"), [4, 4, 4])
        self.assertEqual(cost("microbit", "{r4, r5, pc}", "return"), [7, 7, 7])
        self.assertEqual(cost("mps2_an385", "10", "branch, taken"), [2, 3, 4])
        self.assertEqual(cost("mps2_an385", "r0, r1, r2, r3", "long multiply"), [3, 4, 5])

    def test_memory_that_waits(self):
        result = {"cycles": 100, "jumps": 10, "words": 30}
        self.assertEqual([cycles.waiting(result, w) for w in (0, 2)], [100, 120])
        self.assertEqual(cycles.waiting(result, 2, prefetch=False), 180)


class Readme(unittest.TestCase):
    def test_tables_are_whole(self):
        self.assertEqual(problems(report.pages(), report.REPORTS), [])

    def test_figures_are_there(self):
        found = re.findall(r"\]\((?:src/study/)?(figures/[^)]*)\)", report.pages())
        self.assertTrue(found)
        for path in found:
            xml.etree.ElementTree.parse(f"src/study/{path}")


class Quick(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.status, cls.text = make("study", "QUICK=1")

    def test_runs(self):
        self.assertEqual(self.status, 0, self.text)

    def test_tables(self):
        with open("build/study/quick/boards.csv") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), len(study.BOARDS) * len(study.settings(quick=True)))
        self.assertEqual({r["board"] for r in rows}, set(study.BOARDS))
        for r in rows:
            for name in ("scene", "size", "compiler", "flags", "commit", "error size"):
                self.assertTrue(r[name], name)
            # No instruction of these cores takes less than a cycle.
            self.assertGreaterEqual(float(r["cycles/pixel"]), float(r["instructions/pixel"]))
        errors = {(r["samples"], r["number"]): float(r["total psnr"]) for r in rows}
        self.assertGreater(errors["4", "q32"], errors["1", "q32"])
        with open("build/study/quick/desktop.csv") as file:
            for r in csv.DictReader(file):
                if r["number"] == "double":
                    found = [float(r[name]) for name in ("arithmetic psnr", "arithmetic largest", "other objects")]
                    self.assertEqual(found, [99, 0, 0])

    def test_plots_are_xml(self):
        for name in ["m0", "m3", "m4f", "rv32", "bits", "samples", "panel", "steps"]:
            path = f"build/study/quick/{name}.svg"
            xml.etree.ElementTree.parse(path)
            self.assertLess(os.path.getsize(path), 300_000)


if __name__ == "__main__":
    unittest.main()
