"""README's tables of `make stability`, and how they are made of what it measures.
From the top of the repository: python3 tests/stability/test_stability.py"""

import os
import sys
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import stability  # noqa: E402


def made(without=None):
    rows = [{"shape": s, "number": n, "regime": r, "form": f, "rays": "1000000", "wrong": str(i),
             "worst error": "0.25", "mean error": "1.5e-07", "rebounds": "2000000", "self-hits": "3",
             "leaks": "0"}
            for s in stability.SHAPES for r in stability.regimes(s) for n in stability.NUMBERS
            for i, f in enumerate(stability.FORMS)]
    costs = {(s, n, f): 100 + 50 * i for s in stability.SHAPES for n in stability.NUMBERS
             for i, f in enumerate(stability.FORMS)}
    text = stability.text(stability.Results(rows, costs), 3000000, 7)
    lines = [line for line in text.splitlines() if without is None or not line.startswith(without)]
    return "<!-- report:stability -->\n" + "\n".join(lines) + "\n<!-- /report -->\n"


class Tables(unittest.TestCase):
    def test_whole(self):
        self.assertEqual(stability.problems(made()), [])

    def test_a_row_that_is_missing_is_named(self):
        for row in ["| disc, grazing | q32 |", "| patch, needle | 0", "| cone | "]:
            found = stability.problems(made(without=row))
            self.assertEqual(len(found), 1, found)
            self.assertIn(row.strip("| 0").split(" | ")[0], found[0])
        self.assertEqual(len(stability.problems("")), 1)

    # Seven shapes, three regimes each and a fourth for two of them, five number systems.
    def test_rows(self):
        lines = made().splitlines()
        self.assertEqual(sum(line.startswith("| ") and line.count("|") == 13 for line in lines), 1 + 23 * 5)
        self.assertEqual(sum(line.startswith("| ") and line.count("|") == 12 for line in lines), 2 + 23 + 7)

    def test_numbers(self):
        self.assertEqual(stability.per_million(0, 3), "0")
        self.assertEqual(stability.per_million(2, 4000000), "0.5")
        self.assertEqual(stability.per_million(5, 1000), "5 000")
        self.assertEqual(stability.small(0.00000012345), "1.2e-7")
        self.assertEqual(stability.small(0), "0")
        self.assertIn("| disc, grazing | q32 | 0 | 1.0 | 1.5e-7 | 1.5e-7 | 2.5e-1 | 2.5e-1 | 1.5 | 1.5 | 0 "
                      "| 0 |\n", made())


class Readme(unittest.TestCase):
    def test_tables_are_whole(self):
        self.assertEqual(stability.problems(stability.report.pages()), [])


if __name__ == "__main__":
    unittest.main()
