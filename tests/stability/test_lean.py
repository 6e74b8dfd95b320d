"""README's table of `make robustness`, how it is made of what is measured, and that lean forms can still be put
in the place of robust ones. From the top of the repository: python3 tests/stability/test_lean.py"""

import os
import sys
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import lean  # noqa: E402


def made():
    cost = {form: 100.0 + 10 * i for i, form in enumerate(reversed(lean.FORMS))}
    found = {form: {"runs": {b: cost[form] for b in lean.BOARDS}, "off": int(form == "textbook"),
                    "fails": [] if "robust" in form else ["ACase"]} for form in lean.FORMS}
    return lean.text(found, "scenes/a.nff", "8x6")


class Table(unittest.TestCase):
    def test_whole(self):
        text = f"<!-- report:robustness -->\n{made()}<!-- /report -->\n"
        self.assertEqual(lean.problems(text), [])
        for form in lean.FORMS:
            self.assertEqual(len(lean.problems(text.replace(f"| {form} |", "| |"))), 1, form)
        self.assertEqual(len(lean.problems("")), 1)

    # 160 against 100 of the textbook, against 110 of what draws the same bytes, and against the 130 of the
    # leanest whose name has "robust" in it.
    def test_percents(self):
        text = " ".join(made().split())
        self.assertIn("+60 % (M0), +60 % (M3) and +60 % (RV32) beside the textbook's", text)
        self.assertIn("+23 % (M0), +23 % (M3) and +23 % (RV32) beside the leanest that hold", text)
        self.assertIn("+45 % (M0), +45 % (M3) and +45 % (RV32) beside the leanest that draw", text)
        self.assertIn("fails in ACase.", text)

    def test_readme(self):
        self.assertEqual(lean.problems(lean.report.pages()), [])


class Headers(unittest.TestCase):
    def test_every_form_can_be_made(self):
        for form in lean.FORMS:
            folder = lean.include(form)
            with open("include/qray/number/q32.hpp") as one, open(f"{folder}/qray/number/q32.hpp") as other:
                self.assertEqual(one.read() == other.read(), {"step", "unit"} <= lean.FORMS[form], form)
            with open("include/qray/shape/sphere.hpp") as one, open(f"{folder}/qray/shape/sphere.hpp") as other:
                self.assertEqual(one.read() == other.read(), "sphere" in lean.FORMS[form], form)

    def test_what_is_not_there_is_named(self):
        with self.assertRaisesRegex(SystemExit, "0 places like 'nowhere'"):
            lean.change(f"{lean.include('textbook')}/qray/shape/sphere.hpp", [("nowhere", "")])


if __name__ == "__main__":
    unittest.main()
