"""What the tracer's headers promise about themselves: what they include and from which floor, that each compiles
alone, what words are not in them, and what the object code of a render asks of its surroundings: nothing; and how long
lines and files are everywhere.

Ends with a line `N passed, N failed`; exit status 1 if any failed."""

import concurrent.futures
import functools
import glob
import os
import platform
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
HEADERS = os.path.join(ROOT, "include", "qray")
WARNINGS = ["-Wall", "-Wextra", "-Wconversion", "-Wsign-conversion", "-Wshadow", "-Wdouble-promotion", "-Werror"]
FLAGS = ["-std=c++20", *WARNINGS, "-ffp-contract=off", "-fno-exceptions", "-fno-rtti",
         "-I" + os.path.join(ROOT, "include")]
COMPILERS = ["g++", "clang++"]

# A folder is a floor: no header includes one of a higher floor, nor of another folder of its own.
FLOORS = ["number", "vector", "shape texture light surface", "scene", "trace", "picture"]
FLOOR = {folder: floor for floor, folders in enumerate(FLOORS) for folder in folders.split()}
TOP = "qray"  # the one header that stands in no folder

LANED = {"number/lanes", "vector/vec_lanes"}
# Where these hold anything, on the processors that have such registers.
LANES = ["-mavx2", "-mfma", "-mbmi", "-mbmi2", "-mlzcnt"] if platform.machine() == "x86_64" else []

SYSTEMS = ["q16", "q24", "q32", "Float", "Double"]
# Where floating point may be spoken of: number systems that are it, square roots for them, bytes from their samples,
# and the tree, which q32 only uses where there is a floating-point unit, and vectors in such a unit's registers.
FLOATING = {"number/root", "number/floating", "scene/tree", "scene/outline", "picture/sampler",
            "number/lanes", "vector/vec_lanes"}
# Beside the compiler's own integer and floating helpers, which have reserved names.
ALLOWED = re.compile(r"memcpy|memset|memmove|_GLOBAL_OFFSET_TABLE_"
                     r"|__(mul|div|udiv|mod|umod|divmod|udivmod|ash[lr]|lshr|clz|ctz|popcount|fix|float)"
                     r"\w*[sdt][ifx]\w*\d?$")

# Of files of which no line is wider than a window.
ENDINGS = (".hpp", ".cpp", ".h", ".py", ".mk", ".ld", ".css", ".html", ".js")

results = []


def check(name, faults):
    """faults: a list of what is wrong."""
    results.append(not faults)
    if faults:
        print(f"{name}: FAILED")
        for fault in faults[:20]:
            print("    " + fault.rstrip().replace("\n", "\n    "))


@functools.cache
def names():
    """Of all headers: folder/name."""
    return sorted(os.path.relpath(path, HEADERS)[:-4] for path in glob.glob(f"{HEADERS}/**/*.hpp", recursive=True))


def may_include(name, other):
    """Does DESIGN let the one header include the other?"""
    here, there = os.path.dirname(name), os.path.dirname(other)
    return name == TOP or here == there or FLOOR.get(there, 99) < FLOOR.get(here, -1)


def source(name):
    with open(os.path.join(HEADERS, name + ".hpp"), encoding="utf-8") as file:
        return file.read()


def code(name):
    """The text with comments and strings blanked, lines kept."""
    def blank(match):
        return re.sub(r"[^\n]", " ", match.group())
    return re.sub(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', blank, source(name), flags=re.S)


def run(*command):
    return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, cwd=ROOT)


@functools.cache
def includes(name):
    """(system headers, own headers); a name with a space is a message to those whose compiler is too old"""
    found = re.findall(r'^[ \t]*#[ \t]*include[ \t]*(<[^> ]*>|"[^" ]*")', source(name), re.M)
    own = [os.path.normpath(os.path.join(os.path.dirname(name), i[1:-5])) for i in found if i.startswith('"')]
    return [i for i in found if i.startswith("<")], own


def test_includes():
    check("only <stdint.h> and <stddef.h> are included",
          [f"{n}.hpp includes {i}" for n in names() for i in includes(n)[0] if i not in ("<stdint.h>", "<stddef.h>")])
    check("own headers that are included exist",
          [f"{n}.hpp includes {i}" for n in names() for i in includes(n)[1] if i not in names()])
    check("number/ and vector/ alone ask whether vectors lie in registers",
          [f"{n}.hpp" for n in names() if FLOOR.get(os.path.dirname(n), 99) > 1 and "in_lanes" in code(n)])
    check("every folder has its floor", [f"{n}.hpp is in no floor of this test's table" for n in names()
                                         if n != TOP and os.path.dirname(n) not in FLOOR])
    check("no header includes one of a higher floor",
          [f"{n}.hpp includes {i}.hpp" for n in names() for i in includes(n)[1] if not may_include(n, i)])
    faults = []
    for n in names():
        above, seen = list(includes(n)[1]), set()
        while above:
            i = above.pop()
            if i == n:
                faults.append(f"{n}.hpp includes itself, by way of others")
                break
            if i in names() and i not in seen:
                seen.add(i)
                above += includes(i)[1]
    check("no header includes itself", faults)


def test_lengths():
    """No line is wider than a window, and no file longer than one reads in one go."""
    counts, wide = {}, []
    for folder, _, files in (step for top in ("include", "src", "tests") for step in os.walk(os.path.join(ROOT, top))):
        for path in (os.path.join(folder, f) for f in files if f.endswith(ENDINGS)):
            with open(path, encoding="utf-8") as file:
                lines = file.read().split("\n")
            name = os.path.relpath(path, ROOT)
            wide += [f"{name}:{i}: {len(line)} columns" for i, line in enumerate(lines, 1) if len(line) > 120]
            if name.endswith(".hpp"):
                counts[name] = len(lines) - 1, 400
    for name, most in [("Makefile", 149), ("README.md", 250)]:
        with open(os.path.join(ROOT, name), encoding="utf-8") as file:
            counts[name] = file.read().count("\n"), most
    check("no line has more than 120 columns", wide)
    check("no header has more than 400 lines, nor the Makefile 149, nor README.md 250",
          [f"{name}: {count} lines; at most {most}" for name, (count, most) in counts.items() if count > most])


def test_compile_alone(folder):
    """With g++: what a header forgets to include, no compiler finds; clang++ compiles them together, see below."""
    def compile_one(name):
        path = os.path.join(folder, f"{name.replace('/', '_')}.cpp")
        with open(path, "w", encoding="utf-8") as file:
            file.write(f'#include <qray/{name}.hpp>\n#include <qray/{name}.hpp>\n')
        result = run("g++", *FLAGS, "-fsyntax-only", path)
        if result.returncode == 0 and name in LANED:
            result = run("g++", *FLAGS, *LANES, "-fsyntax-only", path)
        return [] if result.returncode == 0 else [result.stdout[:600]]
    for compiler in COMPILERS:
        if shutil.which(compiler) is None:
            check(f"{compiler} is there", [f"{compiler} was not found; `make deps` installs it"])
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        for name, faults in zip(names(), pool.map(compile_one, names())):
            check(f"{name}.hpp compiles alone", faults)


def test_standard(folder):
    """An older standard is told apart by one line that names the flag, and by no others but the compiler's end."""
    path = os.path.join(folder, "standard.cpp")
    with open(path, "w", encoding="utf-8") as file:
        file.write("#include <qray/qray.hpp>\nqray::Pixel pixel;\n")
    for compiler in filter(shutil.which, COMPILERS):
        for standard in ["gnu++98", "c++11", "gnu++17", "c++20", "gnu++20"]:
            result = run(compiler, "-std=" + standard, "-I" + os.path.join(ROOT, "include"), "-fsyntax-only", path)
            lines = re.findall(r"error: .*", result.stdout)
            good = not lines if "20" in standard else len(lines) == 2 and all("-std=c++20" in line for line in lines)
            check(f"{compiler} says what {standard} lacks", [] if good else [result.stdout[:2000]])


def lines_with(pattern, only=None):
    faults = []
    for name in names():
        if only is not None and name not in only:
            continue
        for number, line in enumerate(code(name).split("\n"), 1):
            if re.search(pattern, line):
                faults.append(f"{name}.hpp:{number}: {line.strip()}")
    return faults


def test_words():
    for word in ["virtual", "new", "delete", "throw", "try", "catch", "dynamic_cast", "typeid", "thread_local",
                 "mutable", "extern", "alloca", "__builtin_alloca", "malloc", "const_cast", "goto", "std"]:
        check(f"no header says `{word}`", lines_with(rf"\b{word}\b"))
    for word in ["reinterpret_cast", "union"]:
        check(f"no header says `{word}` but those of vector registers",
              lines_with(rf"\b{word}\b", set(names()) - LANED))
    # A function (it has an argument list) or a constant; static_assert and static_cast are words of their own.
    faults = []
    for name in names():
        text = code(name)
        for match in re.finditer(r"\bstatic\b([^;{}=]*)", text):
            around = text[max(0, text.rfind("\n", 0, match.start())):match.end()]
            if "constexpr" not in around and "(" not in match.group(1):
                faults.append(f"{name}.hpp: {around.strip()}")
    check("everything static is a function or a constant", faults)
    check("everything inline at namespace scope is a function, or a constant",
          lines_with(r"^inline (?!constexpr)[^(]*(=|;|\{\s*$)"))
    literal = r"\b(float|double)\b|(?<![\w.])(\d+\.\d*|\.\d+|\d+)(e[+-]?\d+)?f\b|(?<![\w.])\d+\.\d+|0x[0-9a-fA-F.]+p"
    check("floating point is left to those who need it", lines_with(literal, set(names()) - FLOATING))


def kernel(folder, system, effects="qray::everything(64)"):
    """A translation unit that draws any scene in one number system."""
    path = os.path.join(folder, f"kernel_{system}.cpp")
    with open(path, "w", encoding="utf-8") as file:
        file.write(f"""#include <qray/qray.hpp>
using N = qray::{system};
constexpr qray::Effects effects = {effects};
using Sink = bool (*)(void*, uint32_t, const uint8_t*, uint32_t);
bool draw(const qray::Scene<N, effects>& scene, uint8_t* buffer, uint32_t rows)
{{
    uint32_t sum = 0;
    const auto sink = [&sum](uint32_t, uint32_t, const uint8_t* bytes, uint32_t size) {{
        for (uint32_t i = 0; i < size; i++)
            sum += bytes[i];
        return sum != 0;
    }};
    const auto go_on = [](uint32_t, uint32_t, const uint8_t*, uint32_t) {{ return true; }};
    const bool done = qray::render<qray::Rgb888>(scene, buffer, rows, sink);
    return qray::render<qray::Rgb565Little>(scene, buffer, rows, go_on) && done;
}}
""")
    return path


def mutable(path):
    """Objects in sections that can be written."""
    found = re.findall(r"^\S+ .{7} (\S+)\s+[0-9a-f]+ (?:\.hidden )?(\S+)$", run("objdump", "-t", path).stdout, re.M)
    return [f"{name} in {section}" for section, name in found
            if name != section and re.match(r"\*COM\*|\.bss|\.tbss|\.tdata|\.data(?!\.rel\.ro)", section)]


def calls(path):
    """{function: functions that it calls} of a .ci file: edge: {{ sourcename: "a" targetname: "b" ... }}"""
    with open(path, encoding="utf-8") as file:
        text = file.read()
    graph = {}
    for source_name, target in re.findall(r'edge: \{ sourcename: "([^"]*)" targetname: "([^"]*)"', text):
        graph.setdefault(source_name, set()).add(target)
    return graph


def cycles(graph):
    """Functions that reach themselves."""
    found = []
    for start in graph:
        reached, above = set(), list(graph[start])
        while above:
            at = above.pop()
            if at not in reached:
                reached.add(at)
                above += graph.get(at, ())
        if start in reached:
            found.append(start)
    return found


def test_object(folder, system):
    path = kernel(folder, system)
    ways = [("-O0", []), ("-O2", [])] + ([("-O2 in lanes", LANES)] if LANES and system in ("q32", "Float") else [])
    for level, more in ways:
        out = os.path.join(folder, f"{system}{level.replace(' ', '_')}.o")
        result = run("g++", *FLAGS, level[:3], *more, "-fcallgraph-info", "-c", path, "-o", out)
        if result.returncode != 0:
            check(f"a render in {system} compiles with g++ {level}", [result.stdout[:2000]])
            continue
        check(f"a render in {system} compiles with g++ {level}", [])
        symbols = [line.split()[-2:] for line in run("nm", out).stdout.splitlines()]
        undefined = [name for kind, name in symbols if kind in "Uwv" and not ALLOWED.match(name)]
        check(f"a render in {system}, {level}, refers to nothing outside of itself", undefined)
        check(f"a render in {system}, {level}, has no mutable data", mutable(out))
        check(f"a render in {system}, {level}, has no guards, virtual tables or type information",
              [name for kind, name in symbols if re.match(r"_ZGV|_ZT[VISTC]|__cxa|_Unwind|__gxx", name)])
        sections = run("objdump", "-h", out).stdout
        check(f"a render in {system}, {level}, runs nothing before main",
              re.findall(r"\.(?:pre)?init_array\S*|\.ctors\S*|\.fini_array\S*|\.tdata\S*|\.tbss\S*", sections))
        graph = calls(out[:-2] + ".ci")
        check(f"a render in {system}, {level}, has a call graph", [] if len(graph) > 1 else ["it is empty"])
        check(f"a render in {system}, {level}, does not recurse", cycles(graph))
        check(f"a render in {system}, {level}, calls nothing by pointer",
              [f"{a} calls {b}" for a, targets in graph.items() for b in targets if b == "__indirect_call"])
    if shutil.which("clang++"):
        result = run("clang++", *FLAGS, "-fsyntax-only", path)
        check(f"a render in {system} compiles with clang++", [] if result.returncode == 0 else [result.stdout[:2000]])


def test_integers_alone(folder):
    """Without the tree fixed point takes no floating-point register: the compiler is forbidden to use one."""
    for system in ["q16", "q24", "q32"]:
        path = kernel(folder, system, "[] { auto e = qray::everything(64); e.tree = false; return e; }()")
        result = run("g++", *FLAGS, "-O0", "-mgeneral-regs-only", "-c", path, "-o", os.path.join(folder, "integers.o"))
        check(f"a render in {system} without a tree has no floating point",
              [] if result.returncode == 0 else [result.stdout[:2000]])


def test_the_test(folder):
    """What this script looks for is found where it is."""
    path = os.path.join(folder, "bad.cpp")
    with open(path, "w", encoding="utf-8") as file:
        file.write("""#include <stdlib.h>
int f(int);
__attribute__((noinline)) int g(int n) { return n < 1 ? 0 : 1 + f(n / 2); }
__attribute__((noinline)) int f(int n) { return n < 1 ? 0 : 2 * g(n - 1); }
int counter = 3;
int* h(int (*p)(int)) { static int* const kept = static_cast<int*>(malloc(8)); counter += p(3); return kept; }
""")
    out = os.path.join(folder, "bad.o")
    run("g++", "-std=c++20", "-O1", "-fno-optimize-sibling-calls", "-fcallgraph-info", "-c", path, "-o", out)
    symbols = [line.split()[-2:] for line in run("nm", out).stdout.splitlines()]
    undefined = [name for kind, name in symbols if kind in "U" and not ALLOWED.match(name)]
    graph = calls(out[:-2] + ".ci")
    check("an allocation is seen", [] if "malloc" in undefined else [str(undefined)])
    check("a mutable global is seen", [] if any("counter" in name for name in mutable(out)) else [str(mutable(out))])
    check("a guard is seen", [] if any(n.startswith("_ZGV") for _, n in symbols) else [str(symbols)])
    check("a recursion is seen", [] if len(cycles(graph)) == 2 else [str(graph)])
    check("a call by pointer is seen", [] if any("__indirect_call" in t for t in graph.values()) else [str(graph)])


def main():
    with tempfile.TemporaryDirectory() as folder:
        test_the_test(folder)
        test_lengths()
        test_includes()
        test_words()
        test_standard(folder)
        test_compile_alone(folder)
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            jobs = [pool.submit(test_object, folder, system) for system in SYSTEMS]
            for job in jobs:
                job.result()
        test_integers_alone(folder)
    failed = results.count(False)
    print(f"{len(results) - failed} passed, {failed} failed")
    return failed != 0


sys.exit(main())
