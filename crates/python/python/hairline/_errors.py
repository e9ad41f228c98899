"""Exceptions and warnings."""

from __future__ import annotations


class Error(Exception):
    """What Hairline raises: :class:`SceneError` or :class:`WorkError`."""


class SceneError(Error, ValueError):
    """A scene or an argument is wrong. The same call will fail again.

    It reads ``file:line: key: what was found; what would be right``, without what is not known.
    """

    file: str | None
    """The file with the mistake, if there is one."""
    line: int | None
    """The line in it, counted from 1."""
    key: str
    """The way to the value: ``light[1].radius_m``. Tables of one name are counted from 0."""
    found: str
    """What was found there."""
    right: str
    """What would be right."""

    def __init__(
        self,
        message: str,
        file: str | None = None,
        line: int | None = None,
        key: str = "",
        found: str = "",
        right: str = "",
    ) -> None:
        super().__init__(message)
        self.file, self.line, self.key, self.found, self.right = file, line, key, found, right

    def __reduce__(self) -> tuple[type[SceneError], tuple[object, ...]]:
        arguments = (str(self), self.file, self.line, self.key, self.found, self.right)
        return type(self), arguments


class WorkError(Error, RuntimeError):
    """The work failed: no device, no room, a file that cannot be read or written."""


class InterruptedWarning(UserWarning):
    """Ctrl-C ended the work, and a part of the picture was returned."""


def argument_error(key: str, found: str, right: str) -> SceneError:
    return SceneError(f"{key}: {found}; {right}", key=key, found=found, right=right)
