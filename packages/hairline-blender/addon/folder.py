# SPDX-License-Identifier: GPL-3.0-or-later
"""The folder for the files of a scene: a temporary one for pictures and viewports, the artist's one for exports."""

import hashlib
import os
import re
import shutil


class Folder:
    """Writes files under unique names.

    `is_kept`: files from elsewhere are copied, so that the folder is complete. `by_content`: names are hashes of the content, so that the renderer
    recognises unchanged files.
    """

    def __init__(self, path, is_kept, prefix="", by_content=False):
        self.path, self._is_kept, self._prefix, self._by_content = path, is_kept, prefix, by_content
        self._names = {}
        self._files = {}
        self.written = set()

    def add(self, wanted, parts):
        """Writes a file and returns its name in the scene."""
        stem, ending = os.path.splitext(self._prefix + re.sub(r"[^\w. -]", "_", wanted))
        stem = stem[:80]
        if self._by_content:
            digest = hashlib.blake2b(digest_size=16)
            for part in parts:
                digest.update(part)
            name = f"{stem} {digest.hexdigest()}{ending}"
        else:
            number = self._names[stem + ending] = self._names.get(stem + ending, 0) + 1
            name = f"{stem}{ending}" if number == 1 else f"{stem}~{number}{ending}"
        path = os.path.join(self.path, name)
        if not (self._by_content and os.path.exists(path)):
            with open(path, "wb") as file:
                file.writelines(parts)
        self.written.add(name)
        return name

    def add_file(self, path):
        """The name in the scene of an existing file."""
        if not self._is_kept:
            return path
        if path not in self._files:
            name = self._prefix + os.path.basename(path)
            copy = os.path.join(self.path, name)
            if os.path.abspath(path) != os.path.abspath(copy):
                shutil.copyfile(path, copy)
            self._files[path] = name
        return self._files[path]

    def forget_all_but(self, kept):
        """Removes all files but those in these sets of names."""
        for name in set(os.listdir(self.path)) - set().union(*kept):
            os.remove(os.path.join(self.path, name))
