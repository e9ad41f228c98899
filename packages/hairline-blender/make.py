# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the extension's zip of `addon` and a wheel, and tests it in Blender as a module. `cargo xtask blender` calls it with a wheel that it has built."""

import argparse
import os
import re
import subprocess
import sys
import time
import venv
import zipfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
# The first time that a zip can tell, in seconds.
FIRST = 315_532_800
LICENCES = ("LICENSE-MIT", "LICENSE-APACHE")
# Version of Python that Blender as a module needs.
PYTHON = (3, 11)


def zipped(wheel, output):
    """Writes the zip and returns its path."""
    manifest = (HERE / "addon/blender_manifest.toml").read_text()
    version = re.search(r'^version = "(.+)"', manifest, re.M)[1]
    manifest = manifest.replace("wheels = []", f'wheels = ["./wheels/{wheel.name}"]')
    path = output / f"hairline-blender-{version}-linux-x64.zip"
    files = {"blender_manifest.toml": manifest.encode(), f"wheels/{wheel.name}": wheel.read_bytes(), "LICENSE": (HERE / "LICENSE").read_bytes()}
    files |= {f"wheels/{name}": (HERE.parents[1] / name).read_bytes() for name in LICENCES}
    files |= {file.name: file.read_bytes() for file in sorted((HERE / "addon").glob("*.py"))}
    # The same bytes whenever it is made.
    date = time.gmtime(int(os.environ.get("SOURCE_DATE_EPOCH", FIRST)))[:6]
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            entry = zipfile.ZipInfo(name, date)
            entry.external_attr = 0o644 << 16
            archive.writestr(entry, content, zipfile.ZIP_DEFLATED)
    return path


def environment(blender, folder):
    """Interpreter of an environment with this version of Blender. Prints the reason and returns None if it cannot be installed."""
    if sys.version_info[:2] != PYTHON:
        print(f"skipped: found Python {sys.version.split()[0]}; Blender {blender} as a module needs {PYTHON[0]}.{PYTHON[1]}: --python")
        return None
    home = folder / f"blender-{blender.replace('*', 'x')}"
    python = home / "bin/python"
    if not python.exists():
        venv.create(home, with_pip=True)
    packages = [f"bpy=={blender}", "pytest", "OpenEXR"]
    done = subprocess.run([python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", *packages], capture_output=True, text=True)
    if done.returncode:
        print(f"skipped: Blender {blender} as a module cannot be installed: {done.stderr.strip().splitlines()[-1]}")
        return None
    return python


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("wheel", type=Path)
    parser.add_argument("--output", type=Path, required=True, help="the folder for the zip and for environments of tests")
    parser.add_argument("--test", action="store_true")
    parser.add_argument("--blender", action="append", help="versions to test with, as pip takes them; 4.5.* and 5.0.1 by default")
    parser.add_argument("--pictures", type=Path, help="a folder for the pictures of the documents")
    args = parser.parse_args()
    path = zipped(args.wheel, args.output)
    print(f"{path}: {path.stat().st_size / 1e6:.1f} MB")
    for blender in (args.blender or ["4.5.*", "5.0.1"]) if args.test or args.pictures else ():
        python = environment(blender, args.output)
        if python is None:
            continue
        if args.test:
            subprocess.run([python, HERE / "tests/run.py", path], check=True)
        if args.pictures:
            subprocess.run([python, HERE / "tests/run.py", path, "--pictures", args.pictures], check=True)
            break


if __name__ == "__main__":
    main()
