"""The examples of README.md and the recipes of src/package/README.md compile without a warning, and draw the picture.
From the top of the repository: python3 tests/test_recipes.py"""

import os
import re
import subprocess
import unittest

from test_compile import FLAGS

FOLDER = "build/recipes"
# What the recipes leave to their reader; the picture in each of its ways must be that of its rows.
YOURS = """
#include <assert.h>
#include <string.h>
#include <thread>

static uint8_t expected[scene::height * stride], seen[scene::height * stride];
static uint16_t colours[scene::height][scene::width];
static const uint8_t* sent;
static uint32_t sent_row, presses, fills;

void my_wait()
{
    if (sent != nullptr)
        memcpy(seen + sent_row++ * stride, sent, stride);
    sent = nullptr;
}
void my_send(const uint8_t* bytes, uint32_t size)
{
    assert(size == stride && sent == nullptr);
    sent = bytes;
}
bool my_button() { return ++presses == 5; }
void my_show(uint32_t y, const uint8_t* bytes, uint32_t size) { memcpy(seen + y * stride, bytes, size); }
bool my_fill(uint32_t x, uint32_t y, uint32_t width, uint32_t height, uint16_t colour)
{
    for (uint32_t j = y; j < y + height; j++)
        for (uint32_t i = x; i < x + width; i++)
            colours[j][i] = colour;
    return ++fills != 0;
}
void my_window(uint32_t x, uint32_t y, uint32_t width, uint32_t height, const uint8_t* bytes)
{
    for (uint32_t j = 0; j < height; j++)
        memcpy(seen + (y + j) * stride + x * Format::bytes, bytes + j * width * Format::bytes, width * Format::bytes);
}
static void expect_rows(uint32_t rows)
{
    assert(memcmp(seen, expected, rows * stride) == 0);
    for (uint32_t k = rows * stride; k < sizeof seen; k++)
        assert(seen[k] == 0xcd);
    memset(seen, 0xcd, sizeof seen);
}

int main()
{
    memset(seen, 0xcd, sizeof seen);
    for (uint32_t y = 0; y < scene::height; y++)
        qray::render_row<Format>(scene::scene, y, expected + y * stride);
    draw_pages();
    for (uint32_t y = 0; y < scene::height; y++) {
        uint8_t row[qray::row_bytes<qray::Mono>(scene::width)];
        qray::render_row<qray::Dithered<qray::Mono>>(scene::scene, y, row);
        for (uint32_t x = 0; x < scene::width; x++)
            assert((my_pages[y / 8][x] >> y % 8 & 1) == (row[x / 8] >> (7 - x % 8) & 1));
    }
    std::thread other([] { draw_on(1, seen); });
    draw_on(0, seen);
    other.join();
    expect_rows(scene::height);
    draw_by_dma();
    expect_rows(scene::height);
    assert(!draw_until_pressed());
    expect_rows(5);
    uint32_t next = 0;
    assert(!draw_some_rows(next, 7) && next == 7 && !draw_some_rows(next, 1) && draw_some_rows(next, 1000));
    expect_rows(scene::height);
    assert(draw_coarse_to_fine() && fills == scene::width * scene::height);
    for (uint32_t y = 0; y < scene::height; y++)
        for (uint32_t x = 0; x < scene::width; x++)
            assert(colours[y][x] == qray::rgb565(qray::render_pixel(scene::scene, x, y)));
    draw_tiles();
    expect_rows(scene::height);
}
"""


def blocks(page):
    with open(page) as file:
        return re.findall(r"^```cpp\n(.*?)^```$", file.read(), re.M | re.S)


class Recipes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        os.makedirs(FOLDER, exist_ok=True)
        subprocess.run(["build/qray", "compile", "scenes/balls.nff", "-s", "45x37", "-o", f"{FOLDER}/balls.hpp"],
                       check=True)

    def run_program(self, name, text):
        with open(f"{FOLDER}/{name}.cpp", "w") as file:
            file.write(text)
        built = subprocess.run(["g++", *FLAGS, f"{FOLDER}/{name}.cpp", "-pthread", "-o", f"{FOLDER}/{name}"],
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.assertEqual(built.returncode, 0, built.stdout)
        ran = subprocess.run([f"{FOLDER}/{name}"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.assertEqual((ran.returncode, ran.stdout), (0, ""))

    def test_examples(self):
        found = [block for block in blocks("README.md") if "int main" in block]
        self.assertGreater(len(found), 0)
        for k, block in enumerate(found):
            self.run_program(f"example{k}", block)

    def test_recipes(self):
        self.run_program("recipes", "\n".join(blocks("src/package/README.md")) + YOURS)


if __name__ == "__main__":
    unittest.main()
