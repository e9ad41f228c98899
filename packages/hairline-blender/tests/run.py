# SPDX-License-Identifier: GPL-3.0-or-later
"""Installs the extension's zip into a fresh Blender (the module `bpy`) and runs the tests there: `python run.py ZIP [arguments of pytest]`.
`python run.py ZIP --pictures FOLDER` makes the pictures of docs/blender.md.

`python run.py packages/hairline-blender/addon` takes the add-on from its folder, with the package `hairline` of the environment.
"""

import os
import sys
import tempfile
import traceback
from pathlib import Path

HERE = Path(__file__).resolve().parent


def installed(source, user):
    """The add-on's module, enabled."""
    # Before Blender starts: where it keeps what is installed.
    os.environ["BLENDER_USER_RESOURCES"] = user
    import bpy

    if source.is_dir():
        sys.path.insert(0, str(source.parent))
        module = __import__(source.name)
        module.register()
        return module
    bpy.ops.extensions.package_install_files(filepath=str(source), repo="user_default", enable_on_install=True)
    name = "bl_ext.user_default.hairline"
    if name not in bpy.context.preferences.addons:
        raise SystemExit(f"{source}: the extension was not installed")
    return sys.modules[name]


def main():
    source, arguments = Path(sys.argv[1]).resolve(), sys.argv[2:]
    with tempfile.TemporaryDirectory() as user:
        addon = installed(source, user)
        import bpy
        import hairline
        import pytest

        print(f"Blender {bpy.app.version_string}, hairline {hairline.__version__} of {Path(hairline.__file__).parent}")
        sys.modules["addon_under_test"] = addon
        sys.path.insert(0, str(HERE))
        if arguments[:1] == ["--pictures"]:
            import pictures

            return pictures.make(Path(arguments[1]))
        if not any(Path(argument.split("::")[0]).exists() for argument in arguments):
            arguments.append(str(HERE))
        return pytest.main(["-q", "-p", "no:cacheprovider", "-rs", *arguments])


if __name__ == "__main__":
    try:
        code = int(main())
    except SystemExit as end:
        code = end.code if isinstance(end.code, int) else print(end.code, file=sys.stderr) or 1
    except BaseException:
        traceback.print_exc()
        code = 1
    sys.stdout.flush()
    sys.stderr.flush()
    # The module does not end by itself after a render.
    os._exit(code)
