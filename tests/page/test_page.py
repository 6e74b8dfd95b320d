"""The page (make page) in headless Chromium: its pictures are the command's, byte for byte; its figures those that
follow from them; errors, dials, the link and the frontier do what they say; the console stays empty."""

import base64
import json
import math
import os
import re
import shutil
import subprocess
import tempfile
import time
import unittest

PAGE = os.path.abspath("build/page/index.html")
BROWSER, DRIVER = shutil.which("chromium"), shutil.which("chromedriver")
try:
    from selenium import webdriver
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
    from selenium.webdriver.support.select import Select
    MISSING = None if BROWSER and DRIVER else "no chromium and chromium-driver"
except ImportError:
    MISSING = "no python3-selenium"
if MISSING is None and not os.path.exists(PAGE):
    MISSING = "no page: it needs Debian's lld, libc++-14-dev-wasm32 and wasi-libc"

SIZE = "80x60"
NUMBERS = json.loads(subprocess.run(["build/qray", "--describe"], stdout=subprocess.PIPE, check=True).stdout)["numbers"]

# Light between surfaces; quick, as there is little to compute.
with open("tests/room.nff", encoding="utf-8") as file:
    ROOM = file.read()


def picture(text, *options):
    """The command's picture of a scene text, without its header."""
    ppm = subprocess.run([os.path.abspath("build/qray"), "-", "-q", "-o", "-", "-s", SIZE, *options],
                         input=text.encode(), cwd="scenes", stdout=subprocess.PIPE, check=True).stdout
    return ppm.split(b"\n", 3)[3]


def psnr(a, b):
    squares = sum((p - q) ** 2 for p, q in zip(a, b))
    return 10 * math.log10(255 ** 2 * len(a) / squares)


def scene(name):
    with open(f"scenes/{name}.nff", encoding="utf-8") as file:
        return file.read()


@unittest.skipIf(MISSING, f"{MISSING}; `make deps` installs what is needed")
class PageTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        options = webdriver.ChromeOptions()
        options.binary_location = BROWSER
        for switch in ("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
                       "--window-size=1280,900"):
            options.add_argument(switch)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        cls.driver = webdriver.Chrome(service=webdriver.chrome.service.Service(DRIVER), options=options)

    @classmethod
    def tearDownClass(cls):
        cls.driver.quit()

    def setUp(self):
        self.driver.get("about:blank")
        self.driver.get(f'file://{PAGE}#{{"scene":"showcase","size":"{SIZE}"}}')
        self.wait("done")

    def tearDown(self):
        messages = self.driver.get_log("browser")
        self.assertEqual(messages, [])

    def script(self, text, *arguments):
        return self.driver.execute_script(text, *arguments)

    def wait(self, state, of="document.body.dataset.state"):
        end = time.monotonic() + 60
        while self.script(f"return {of}") != state:
            self.assertLess(time.monotonic(), end, f"{of} is {self.script(f'return {of}')}, not {state}")
            time.sleep(0.01)

    def element(self, css):
        return self.driver.find_element(By.CSS_SELECTOR, css)

    def choose(self, element, value, state="done"):
        Select(self.element(f"#{element}")).select_by_value(value)
        self.wait(state)

    def number(self, side, number):
        self.script("arguments[0].click()", self.element(f"input[name=number-{side}][value={number}]"))
        self.wait("done")

    def text(self, text, state="done"):
        self.script("const t = document.getElementById('text'); t.value = arguments[0]; "
                    "t.dispatchEvent(new Event('input'))", text)
        self.wait(state)

    def bytes(self, side):
        return base64.b64decode(self.script(f"return btoa(String.fromCharCode(...sides['AB'.indexOf('{side}')].rgb))"))

    def explained(self, *arguments):
        return subprocess.run([os.path.abspath("build/qray"), "explain", "-q", "-s", SIZE, "showcase.nff", *arguments],
                              cwd="scenes", stdout=subprocess.PIPE, check=True).stdout.decode()

    def figure(self, name):
        return self.script("return [...document.querySelectorAll('#figures dt')].find("
                           "e => e.textContent === arguments[0]).nextSibling.textContent", name)

    def screenshot(self, name, width):
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                                    {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": width < 500})
        image = self.driver.execute_cdp_cmd("Page.captureScreenshot", {"captureBeyondViewport": True})
        with open(f"build/page/{name}.png", "wb") as file:
            file.write(base64.b64decode(image["data"]))
        widest = self.script("return document.documentElement.scrollWidth")
        self.driver.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
        self.assertLessEqual(widest, width)

    def test_it_is_one_small_file(self):
        self.assertLess(os.path.getsize(PAGE), 1_500_000)
        with open(PAGE, encoding="utf-8") as file:
            page = file.read()
        code = re.sub(r'<script type="application/json".*?</script>', "", page, flags=re.S)
        code = code.replace("http://www.w3.org/2000/svg", "")
        self.assertEqual(re.findall(r"\b(?:https?:)?//[a-z][^\s'\"]*", code), [])
        self.assertEqual(self.script("return performance.getEntriesByType('resource').filter("
                                     "e => !/^(data|blob):/.test(e.name)).length"), 0)

    def test_it_is_quick(self):
        times = []
        for _ in range(3): # the machine may be busy
            self.driver.get("about:blank")
            self.driver.get(f'file://{PAGE}#{{"scene":"showcase","size":"320x240"}}')
            self.wait("done")
            times.append(self.script("return [performance.getEntriesByType('navigation')[0].loadEventEnd, "
                                     "sides[1].ms]"))
        opening, drawing = map(min, zip(*times))
        self.assertEqual(self.script("return shown.sides[1].number"), "q32")
        self.assertLess(opening, 1000)
        self.assertLess(drawing, 3000)

    def test_pictures_are_those_of_the_command(self):
        for name in ("showcase", "knot", "images", "room"):
            if name == "room":
                self.text(ROOM)
            else:
                self.choose("load", name)
            for i, number in enumerate(NUMBERS):
                with self.subTest(scene=name, number=number):
                    side = "AB"[i % 2]
                    self.number(side, number)
                    self.assertEqual(self.bytes(side), picture(ROOM if name == "room" else scene(name), "-n", number))

    def test_dials(self):
        self.choose("load", "soft")
        one = self.bytes("B")
        slider = self.element("#samples-B")
        slider.send_keys(Keys.ARROW_RIGHT)
        self.wait("done")
        four = picture(scene("soft"), "-r", "4")
        self.assertNotEqual(self.bytes("B"), one)
        self.assertEqual(self.bytes("B"), four)
        self.element("#levels-A").send_keys(Keys.ARROW_RIGHT, Keys.ARROW_RIGHT)
        self.wait("done")
        adaptive = picture(scene("soft"), "-n", "q16", "-a", "2")
        self.assertEqual(self.bytes("A"), adaptive)
        self.assertEqual(self.figure("PSNR"), f"{psnr(adaptive, four):.1f} dB")
        self.assertGreater(float(self.figure("FLIP, mean")), 0)
        self.assertFalse(self.element("#samples-A").is_displayed())
        self.assertTrue(self.element("#threshold-A").is_displayed())
        self.assertTrue(self.element("#depth-A").is_displayed())
        # Equal pictures are said to be equal.
        self.number("B", "q16")
        for key in ("ARROW_LEFT", "ARROW_LEFT"):
            self.element("#levels-A").send_keys(getattr(Keys, key))
        self.element("#samples-A").send_keys(Keys.ARROW_RIGHT)
        self.wait("done")
        self.assertEqual(self.figure("PSNR"), "equal")
        self.number("B", "q32")
        # The panel's places stand in the text.
        self.element("#places").send_keys(Keys.HOME)
        self.wait("done")
        self.assertIn("\npanel 1 ", self.script("return shown.text"))
        self.assertEqual(self.bytes("B"), picture(scene("soft").replace("\npanel 3 ", "\npanel 1 "), "-r", "4"))
        # Where nothing is mirrored, there is no depth to choose; nor places without a panel.
        self.choose("load", "phong")
        self.assertFalse(self.element("#depth-B").is_displayed())
        self.assertFalse(self.element("#places").is_displayed())

    def test_an_error_of_the_text(self):
        wrong = scene("balls").replace("\ns ", "\ns x ", 1)
        with tempfile.TemporaryDirectory() as folder:
            with open(f"{folder}/scene.nff", "w", encoding="utf-8") as file:
                file.write(wrong)
            said = subprocess.run([os.path.abspath("build/qray"), "scene.nff"], cwd=folder, stderr=subprocess.PIPE,
                                  check=False).stderr.decode().rstrip()
        self.assertRegex(said, r"^scene\.nff:\d+:3: expected x of the centre of a sphere, found 'x'")
        self.text(wrong, "error")
        message = self.element("#message")
        self.assertEqual(message.text, said)
        # Its place is a button that leads there.
        message.find_element(By.TAG_NAME, "button").click()
        self.assertEqual(self.script("const t = document.activeElement; "
                                     "return t.value.slice(t.selectionStart, t.selectionEnd)"), "x")
        self.driver.switch_to.active_element.send_keys(Keys.DELETE, Keys.DELETE)
        self.wait("done")
        self.assertEqual(self.bytes("B"), picture(scene("balls")))

    def test_why_a_pixel_has_its_colour(self):
        self.number("B", "double")
        self.element("summary").click()
        x, y = self.script("return chosen_pixel")
        self.assertEqual(self.script("return compared.map[80 * chosen_pixel[1] + chosen_pixel[0]] "
                                     "=== compared.most"), True)
        self.element("#map").send_keys(Keys.ARROW_RIGHT, Keys.ARROW_DOWN)
        place = f"{x + 1},{y + 1}"
        self.wait(place, "document.getElementById('explain').dataset.pixel")
        said = self.explained("-n", "q16,double", place)
        self.assertEqual(self.script("return document.getElementById('explain').textContent"), said)
        # A line of the text is a button that leads there.
        button = self.element("#explain button")
        line = int(button.text.split()[1])
        button.click()
        self.assertEqual(self.script("const t = document.activeElement; "
                                     "return t.value.slice(t.selectionStart, t.selectionEnd)"),
                         scene("showcase").split("\n")[line - 1])
        # Other dials part too: each tree is the command's, in order, and what only one has is marked.
        for number, dials, marks in (("double", ["-r", "4"], ("q16", "double")), ("q16", ["-r", "4"], "AB"),
                                     ("q32", ["-d", "1"], ("q16", "q32")), ("q16", ["-d", "1"], "AB")):
            with self.subTest(number=number, dials=dials):
                self.script("Object.assign(shown.sides[1], drawing, arguments[0]); sides[1].draw()",
                            {"number": number, {"-r": "samples", "-d": "depth"}[dials[0]]: int(dials[1])})
                self.wait("done")
                self.wait(True, "document.getElementById('explain').dataset.settings === JSON.stringify(shown.sides)")
                text = self.script("return document.getElementById('explain').textContent")
                one, two = self.explained("-n", "q16", place), self.explained("-n", number, *dials, place)
                heads = [f"{mark}: {own.splitlines()[1]}" if marks == "AB" else own.splitlines()[1]
                         for mark, own in zip(marks, (one, two))]
                self.assertEqual([line.removeprefix("! ") for line in text.splitlines()[1:3]], heads)
                marked = [mark.text.rstrip() for mark in self.driver.find_elements(By.CSS_SELECTOR, "#explain mark")]
                self.assertEqual(marked, [line for line in text.splitlines() if "! " in line])
                if dials[0] == "-r":
                    self.assertIn(f"\n! {marks[0]} has 1 sample, {marks[1]} 4, of which 0 are at the same places.\n",
                                  text)
                    for mark, own in zip(marks, (one, two)):
                        self.assertEqual(re.findall(rf"! only in {mark}: (sample at.*|\w+ ray.*)", text),
                                         re.findall(r"(sample at.*|\w+ ray, .*)", own))
                elif self.script("return sides[1].rays < sides[0].rays"):
                    deeper = [r for r in re.findall(r"\w+ ray, .*", one) if ", depth 1," not in r]
                    self.assertEqual(re.findall(rf"! only in {marks[0]}: (\w+ ray, .*)", text), deeper)
        # Two pictures that are drawn alike have one explanation.
        self.script("Object.assign(shown.sides[1], drawing, {number: 'q16'}); sides[1].draw()")
        self.wait("done")
        self.wait(True, "document.getElementById('explain').dataset.settings === JSON.stringify(shown.sides)")
        self.assertEqual(self.script("return document.getElementById('explain').textContent"),
                         self.explained("-n", "q16", place))

    def test_a_change_ends_what_is_being_drawn(self):
        self.script("shown.sides[1].samples = 4096; sides[1].draw()")
        self.wait(True, "sides[1].progress.value > 0")
        self.script("shown.sides[1].samples = 1")
        self.text(scene("glass"))
        self.assertEqual(self.bytes("B"), picture(scene("glass")))

    def test_a_number_system_that_the_scene_does_not_fit(self):
        text = scene("balls") + "far 1e9\nplane 0 -50 0  0 1 0\n"
        said = subprocess.run(["build/qray", "-", "-o", "-", "-n", "q16"], input=text.encode(), stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, check=False).stderr.decode()
        self.assertIn("q16 has lengths in steps of", said)
        self.text(text, "error")
        self.assertIn(self.script("return sides[0].facts.textContent"), said)
        self.assertEqual(self.bytes("B"), picture(text))

    def test_the_link_holds_all(self):
        text = scene("glass") + "# ö & <b> 'mine'\n"
        self.text(text)
        self.number("A", "double")
        self.choose("board", "rv32_virt")
        self.wait(True, "decodeURIComponent(location.hash).includes('rv32_virt')")
        link, before = self.driver.current_url, self.bytes("A")
        self.driver.get("about:blank")
        self.driver.get(link)
        self.wait("done")
        self.assertEqual(self.script("return [shown.text, shown.board, shown.size, shown.sides[0].number]"),
                         [text, "rv32_virt", SIZE, "double"])
        self.assertEqual(self.bytes("A"), before)

    def test_the_frontier(self):
        self.wait("done", "document.body.dataset.frontier")
        points = self.script("return [...document.querySelectorAll('#points button')].map(e => e.textContent)")
        self.assertGreaterEqual(len(points), 3)
        self.screenshot("desktop", 1280)
        self.screenshot("phone", 390)
        number = re.match("|".join(NUMBERS), points[1])[0]
        self.assertIn(number, NUMBERS)
        told = float(re.search(r"([\d.]+) dB", points[1])[1])
        self.script("document.querySelectorAll('#points button')[1].click()")
        self.wait("done")
        a, b = (self.script(f"return shown.sides[{i}]") for i in (0, 1))
        self.assertEqual((b["number"], b["samples"], b["depth"]), ("double", 64, 8))
        sampling = ["-a", str(a["levels"])] if a["levels"] else ["-r", str(a["samples"])]
        drawn = picture(scene("showcase"), "-n", number, *sampling)
        self.assertEqual(self.bytes("A"), drawn)
        exact = picture(scene("showcase"), "-n", "double", "-r", "64", "-d", "8", "--cutoff", "0")
        self.assertEqual(self.figure("PSNR"), f"{psnr(drawn, exact):.1f} dB")
        # So small a picture is surveyed whole.
        self.assertEqual(told, float(f"{psnr(drawn, exact):.1f}"))
        made = {"-a": f" ADAPTIVE={a['levels']}",
                "-r": f" SAMPLES={a['samples']}" if a["samples"] != 1 else ""}[sampling[0]]
        self.assertEqual(self.element("#run").text,
                         f"make run SCENE=scenes/showcase.nff NUMBER={number} BOARD=microbit SIZE={SIZE}{made}")

    def rays(self, name, size, settings):
        """Of the command, with the settings of a point."""
        sampling = ["-a", str(settings["levels"])] if settings["levels"] else ["-r", str(settings["samples"])]
        said = subprocess.run(["build/qray", "-q", "--stats", "-n", settings["number"], *sampling, "-s", size, "-o",
                               "/dev/null", f"scenes/{name}.nff"], stderr=subprocess.PIPE, check=True).stderr.decode()
        return int(re.search(r"^rays: (\d+)$", said, re.M)[1])

    def test_the_rays_of_the_frontier(self):
        # A small picture's are counted for each point,
        self.wait("microbit", "document.body.dataset.counted")
        found = self.script("return found")
        self.assertEqual(len(found), 5 * len(NUMBERS))
        for p in found:
            self.assertEqual(p["rays"], self.rays("showcase", SIZE, p["settings"]), p)
        # a larger one's for what is worth choosing; those of scattered pixels are close.
        self.choose("size", "160x120")
        self.choose("load", "floor")
        self.wait("microbit", "document.body.dataset.counted")
        points = self.script("return points_of('microbit')")
        self.assertGreaterEqual(len([p for p in points if p["best"]]), 3)
        for p in points:
            counted = self.rays("floor", "160x120", p["settings"])
            if p["best"]:
                self.assertEqual(p["rays"], counted, p)
            self.assertLess(abs(p["rays"] / counted - 1), 0.05, p)
        self.assertNotIn("≈", self.element("#points").text)

    def test_each_board_has_its_clock(self):
        clock = self.element("#clock")
        for board, mhz in (("microbit", "48"), ("mps2_an385", "32"), ("mps2_an386", "64"), ("mps2_an500", "300"),
                           ("rv32_virt", "50")):
            self.choose("board", board)
            self.assertEqual(clock.get_attribute("value"), mhz)
        clock.send_keys(Keys.CONTROL, "a") # in one go: the page puts the part's clock where there is none
        clock.send_keys("8", Keys.ENTER)
        self.assertIn("at 8 MHz,", self.element("#source").text)
        self.choose("board", "microbit")
        self.assertEqual(clock.get_attribute("value"), "48")

    def test_hostile_links(self):
        for link, line in (
                ('{"sides":[{"samples":1e9}]}',
                 "The link has samples 1000000000 for picture A; expected a square from 1 to 4096."),
                ('{"sides":[{},{"samples":2}]}',
                 "The link has samples 2 for picture B; expected a square from 1 to 4096."),
                ('{"sides":[{"cutoff":null}]}',
                 "The link has cutoff null for picture A; expected a number from 0 to 1."),
                ('{"sides":[{"depth":-1}]}',
                 "The link has depth -1 for picture A; expected a whole number from 1 to 64."),
                ('{"sides":[{"levels":"2"}]}',
                 'The link has levels "2" for picture A; expected a whole number from 0 to 6.'),
                ('{"clock":1e999}', "The link has clock null; expected MHz from 0.001 to 100000."),
                ('{"board":"__proto__"}', 'The link has board "__proto__"; expected one of microbit, mps2_an385, '
                                          'mps2_an386, mps2_an500, rv32_virt.'),
                ('{"sides":[{"depth":NaN}]}', "The link is none of this page."),
                ("null", "The link is none of this page."),
                ('{"text":""}', "scene.nff:1:1: the file ends without a view; expected 'v'"),
                ('{"size":"scene","text":"v from 0 0 5 at 0 0 0 up 0 1 0 angle 40 hither 1 resolution 32768 32768"}',
                 "32768 x 32768 pixels; this page draws at most 4194304")):
            with self.subTest(link=link):
                self.driver.get("about:blank")
                self.driver.get(f"file://{PAGE}#{link}")
                self.wait("error" if '"text"' in link else "done")
                self.assertEqual(self.element("#message").text, line)
                self.text(scene("phong"))
                self.assertNotIn("link", self.element("#message").text)
                self.assertEqual(self.script("return sides.map(side => side.failed)"), [False, False])

    # A pixel of 4,096 samples: thousands of trees.
    def test_a_long_explanation_is_cut_off(self):
        self.text(scene("balls").replace("resolution 320 240", "resolution 4 3"))
        self.script("shown.sides[1].samples = 4096")
        self.choose("size", "scene")
        self.element("summary").click()
        self.wait(True, "document.getElementById('explain').dataset.pixel !== undefined")
        text = self.script("return document.getElementById('explain').textContent")
        self.assertLess(len(text), 151000)
        self.assertIn("\n… and much more", text)


if __name__ == "__main__":
    unittest.main()
