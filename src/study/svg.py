"""A small writer of SVG plots and pictures: what study.py's figures need and no more."""

import base64
import math
import struct
import zlib

FONT = "font-family='Helvetica, Arial, sans-serif'"
GREY = "#667"


def escape(text):
    return text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")


class Svg:
    def __init__(self, width, height):
        self.width, self.height = width, height
        self.parts = []

    def add(self, text):
        self.parts.append(text)

    def text(self, x, y, text, size=12, anchor="start", colour="#223", weight="normal", turn=0):
        around = f" transform='rotate({turn} {x:.1f} {y:.1f})'" if turn else ""
        self.add(f"<text x='{x:.1f}' y='{y:.1f}' font-size='{size}' text-anchor='{anchor}' fill='{colour}' "
                 f"font-weight='{weight}'{around}>{escape(text)}</text>")

    def line(self, points, colour="#223", width=1.0, dash=""):
        at = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
        self.add(f"<polyline points='{at}' fill='none' stroke='{colour}' stroke-width='{width}'"
                 + (f" stroke-dasharray='{dash}'" if dash else "") + "/>")

    def rect(self, x, y, width, height, fill="none", stroke="none"):
        self.add(f"<rect x='{x:.1f}' y='{y:.1f}' width='{width:.1f}' height='{height:.1f}' fill='{fill}' "
                 f"stroke='{stroke}'/>")

    def mark(self, x, y, shape, colour, pale=False, size=5.0):
        style = f"fill='{'white' if pale else colour}' stroke='{colour}' stroke-width='1.3'" \
            + (" opacity='0.5'" if pale else "")
        if shape == "circle":
            self.add(f"<circle cx='{x:.1f}' cy='{y:.1f}' r='{size}' {style}/>")
            return
        corners = {"square": [(-1, -1), (1, -1), (1, 1), (-1, 1)],
                   "triangle": [(0, -1.25), (1.2, 0.9), (-1.2, 0.9)],
                   "diamond": [(0, -1.35), (1.35, 0), (0, 1.35), (-1.35, 0)]}[shape]
        at = " ".join(f"{x + 0.9 * size * a:.1f},{y + 0.9 * size * b:.1f}" for a, b in corners)
        self.add(f"<polygon points='{at}' {style}/>")

    def image(self, x, y, width, height, data):
        self.add(f"<image x='{x:.1f}' y='{y:.1f}' width='{width}' height='{height}' "
                 f"style='image-rendering:pixelated' href='data:image/png;base64,"
                 f"{base64.b64encode(data).decode()}'/>")

    def write(self, path, title):
        head = (f"<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {self.width} {self.height}' "
                f"width='{self.width}' height='{self.height}' {FONT}>\n<title>{escape(title)}</title>\n"
                f"<rect width='{self.width}' height='{self.height}' fill='white'/>\n")
        with open(path, "w") as file:
            file.write(head + "\n".join(self.parts) + "\n</svg>\n")


def png(width, height, rgb):
    """A PNG of 3 bytes a pixel."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    rows = b"".join(b"\0" + rgb[3 * width * j:3 * width * (j + 1)] for j in range(height))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def short(value):
    """12500 as 12.5k."""
    for limit, letter in ((1e9, "G"), (1e6, "M"), (1e3, "k")):
        if value >= limit:
            return f"{value / limit:.3g}{letter}"
    return f"{value:.3g}"


class Axis:
    """Values low to high, seen from `start` to `end`."""

    def __init__(self, low, high, start, end, log=False):
        self.low, self.high, self.start, self.end, self.log = low, high, start, end, log

    def __call__(self, value):
        if self.log:
            part = math.log(value / self.low) / math.log(self.high / self.low)
        else:
            part = (value - self.low) / (self.high - self.low)
        return self.start + part * (self.end - self.start)

    def ticks(self):
        """(value, whether it has a label)"""
        if not self.log:
            step = 10 ** math.floor(math.log10((self.high - self.low) / 3))
            while (self.high - self.low) / step > 8:
                step *= 2 if f"{step:e}"[0] != "2" else 2.5
            first = math.ceil(self.low / step - 1e-9)
            return [(i * step, True) for i in range(first, math.floor(self.high / step + 1e-9) + 1)]
        out, decades = [], math.log10(self.high / self.low)
        for exponent in range(math.floor(math.log10(self.low)), math.ceil(math.log10(self.high)) + 1):
            for digit in range(1, 10):
                value = digit * 10.0 ** exponent
                if self.low * 0.999 <= value <= self.high * 1.001:
                    out.append((value, digit == 1 or decades < 2.2 and digit in (2, 5)))
        return out


class Plot:
    """A plot in a rectangle of an Svg: axes and grid first, then marks, and the labels where room is."""

    def __init__(self, svg, box, x, y, title, x_name, y_name):
        self.svg, (self.left, self.top, width, height) = svg, box
        self.right, self.bottom = self.left + width, self.top + height
        low, high, log = x
        self.x = Axis(low, high, self.left, self.right, log)
        low, high, log = y
        self.y = Axis(low, high, self.bottom, self.top, log)
        self.taken, self.labels = [], []
        svg.text((self.left + self.right) / 2, self.top - 10, title, 13, "middle", weight="bold")
        for value, named in self.x.ticks():
            at = self.x(value)
            svg.line([(at, self.top), (at, self.bottom)], "#ccd" if named else "#eef")
            if named and x_name is not None:
                svg.text(at, self.bottom + 15, short(value), 11, "middle", GREY)
        for value, named in self.y.ticks():
            at = self.y(value)
            svg.line([(self.left, at), (self.right, at)], "#ccd" if named else "#eef")
            if named and y_name is not None:
                svg.text(self.left - 6, at + 4, short(value), 11, "end", GREY)
        svg.rect(self.left, self.top, width, height, stroke="#889")
        svg.text((self.left + self.right) / 2, self.bottom + 32, x_name or "", 12, "middle")
        if y_name:
            svg.text(self.left - 38, (self.top + self.bottom) / 2, y_name, 12, "middle", turn=-90)

    def line(self, points, colour="#223", width=1.5, dash="", keep_clear=False):
        """With `keep_clear`, one of steps that labels do not cross."""
        at = [(self.x(a), self.y(b)) for a, b in points]
        self.svg.line(at, colour, width, dash)
        if keep_clear:
            for (x0, y0), (x1, y1) in zip(at, at[1:]):
                self.taken.append((min(x0, x1) - 1, min(y0, y1) - 1, max(x0, x1) + 1, max(y0, y1) + 1))

    def mark(self, a, b, shape, colour, label="", pale=False, size=5.0):
        x, y = self.x(a), self.y(b)
        self.svg.mark(x, y, shape, colour, pale, size)
        self.taken.append((x - size - 1, y - size - 1, x + size + 1, y + size + 1))
        if label:
            self.labels.append((x, y, label, colour, pale, size))

    def finish(self):
        """Places the labels beside their marks, over none and over no other label; solid marks first."""
        sides = [(1, 0), (-1, 0), (0, -1), (0, 1), (0.8, -0.8), (0.8, 0.8), (-0.8, -0.8), (-0.8, 0.8)]
        for x, y, label, colour, pale, size in sorted(self.labels, key=lambda l: l[4]):
            width, height, best = 6.1 * len(label), 11, None
            for far in (size + 3, size + 12, size + 22, size + 34):
                for dx, dy in sides:
                    left = x + dx * far - (width if dx < 0 else width / 2 if dx == 0 else 0)
                    top = y + dy * far - (height if dy < 0 else height / 2 if dy == 0 else 0)
                    box = (left, top, left + width, top + height)
                    if not (self.left <= box[0] and box[2] <= self.right and self.top <= box[1]
                            and box[3] <= self.bottom):
                        continue
                    if not any(box[0] < t[2] and t[0] < box[2] and box[1] < t[3] and t[1] < box[3]
                               for t in self.taken):
                        best = box, far
                        break
                if best:
                    break
            if best is None:
                continue
            box, far = best
            if far > size + 10:
                end = (min(max(x, box[0]), box[2]), min(max(y, box[1]), box[3]))
                self.svg.line([(x, y), end], "#bbc", 0.7)
            self.taken.append(box)
            self.svg.text(box[0], box[3] - 2, label, 11, colour="#99a" if pale else colour)
