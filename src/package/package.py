"""make package: a folder that is a package of CMake, PlatformIO, ESP-IDF, Zephyr and Arduino at once, from the headers,
the command and the files beside this script; and, beside it, the header alone.

    package.py FOLDER"""

import glob
import os
import re
import shutil
import subprocess
import sys

FILES = "src/package/files"
OWN = re.compile(r'^#include "([^" ]+)"\n', re.M)


def single(path, seen):
    """A header with those that it includes in their place, each once."""
    seen.add(path)
    with open(path) as file:
        text = file.read()

    def body(match):
        other = os.path.normpath(os.path.join(os.path.dirname(path), match[1]))
        return "" if other in seen else single(other, seen).replace("#pragma once\n\n", "", 1)
    return OWN.sub(body, text)


def version(header):
    """1.2.3 of QRAY_VERSION, which is 10203."""
    number = int(re.search(r"^#define QRAY_VERSION (\d+)", header, re.M)[1])
    return f"{number // 10000}.{number // 100 % 100}.{number % 100}"


def write(path, text):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w") as file:
        file.write(text)


def main(folder):
    header = single("include/qray/qray.hpp", set())
    out = folder + "/qray"  # ESP-IDF and Arduino know it by this name
    shutil.rmtree(folder, ignore_errors=True)
    for path in glob.glob(FILES + "/**", recursive=True):
        if os.path.isfile(path):
            with open(path) as file:
                write(out + path.removeprefix(FILES), file.read().replace("@VERSION@", version(header)))
    write(out + "/src/qray/qray.hpp", header)
    write(folder + "/qray.hpp", header)
    shutil.copytree("src/package/c", out + "/c")
    os.makedirs(out + "/bin")
    shutil.copy("build/qray", out + "/bin")
    shutil.copy("src/package/README.md", out)
    # One program for all, beside its scene; or beside that as a header, where a build system has no rule for it.
    for example in ("cmake", "zephyr/src", "esp-idf/main", "platformio/src"):
        os.makedirs(f"{out}/examples/{example}", exist_ok=True)
        shutil.copy("src/package/main.cpp", f"{out}/examples/{example}")
        shutil.copy("scenes/balls.nff", f"{out}/examples/{example}")
    for example in ("Picture", "Text", "platformio/src"):
        subprocess.run(["build/qray", "compile", "scenes/balls.nff", "-s", "64x48", "-q",
                        "-o", f"{out}/examples/{example}/balls.hpp"], check=True)
    print(f"qray {version(header)}: {folder}/qray.hpp, and {out} for CMake, PlatformIO, ESP-IDF, Zephyr and Arduino")


if __name__ == "__main__":
    main(sys.argv[1])
