# SPDX-License-Identifier: GPL-3.0-or-later
"""The folder that a scene's files are written to: one of its own for a picture, or one that the artist chose for an export."""

import os
import re
import shutil


class Folder:
    """Names files so that no two are one. `is_kept`: files that lie elsewhere are copied, so that the folder can be taken along."""

    def __init__(self, path, is_kept, prefix=""):
        self.path, self._is_kept, self._prefix = path, is_kept, prefix
        self._names = {}
        self._files = {}

    def path_for(self, wanted):
        """A name of its own for a file, and its path."""
        stem, ending = os.path.splitext(self._prefix + re.sub(r"[^\w. -]", "_", wanted))
        stem = stem[:80]
        number = self._names[stem + ending] = self._names.get(stem + ending, 0) + 1
        name = f"{stem}{ending}" if number == 1 else f"{stem}~{number}{ending}"
        return name, os.path.join(self.path, name)

    def add_bytes(self, wanted, data):
        """Writes a file; its name in the scene."""
        name, path = self.path_for(wanted)
        with open(path, "wb") as file:
            file.write(data)
        return name

    def add_file(self, path):
        """The name in the scene of a file that is there."""
        if not self._is_kept:
            return path
        if path not in self._files:
            name, copy = self.path_for(os.path.basename(path))
            if os.path.abspath(path) != os.path.abspath(copy):
                shutil.copyfile(path, copy)
            self._files[path] = name
        return self._files[path]
