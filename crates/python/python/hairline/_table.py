"""A table of a scene.

A value is checked when it is set, by the code that reads scene files. ``None`` takes a key away.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from functools import lru_cache
from inspect import Parameter, Signature
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any, ClassVar, Sequence, Union

from . import _hairline as core
from ._arrays import ArrayLike
from ._errors import SceneError, argument_error

if TYPE_CHECKING:
    from typing_extensions import Self, dataclass_transform
else:

    def dataclass_transform(**_: Any) -> Any:
        return lambda of: of


Vector = Union[Sequence[float], ArrayLike]
"""Three numbers. What is read back is a tuple."""
Sizes = Union[float, Mapping[str, float]]
"""A number, or ``{"mean": .., "spread": ..}``."""
Path = Union[str, "os.PathLike[str]"]

# Keys around a table while it is checked alone.
_FRAME: dict[str, Any] = {
    "camera": {"position_m": [0.0, 0.0, 1.0], "target_m": [0.0, 0.0, 0.0]},
    "object": [{"name": "object", "mesh": "object.glb"}],
}


def _default() -> Any:
    """Stands for a default, which the compiled part knows."""


def _frozen(value: Any) -> Any:
    return tuple(map(_frozen, value)) if isinstance(value, list) else value


@lru_cache(maxsize=1)
def _notes() -> dict[str, dict[str, str]]:
    """What is written below each key, of each class."""
    import ast

    notes: dict[str, dict[str, str]] = {}
    try:
        body = ast.parse(FilePath(__file__).with_name("_keys.py").read_text(encoding="utf-8")).body
    except OSError:  # pragma: no cover
        return notes
    for kind in body:
        if isinstance(kind, ast.ClassDef):
            for key, note in zip(kind.body, kind.body[1:]):
                if (
                    isinstance(key, ast.AnnAssign)
                    and isinstance(note, ast.Expr)
                    and isinstance(note.value, ast.Constant)
                ):
                    notes.setdefault(kind.name, {})[ast.unparse(key.target)] = str(note.value.value)
    return notes


class _Documented(type):
    """Tells the keys of a table where ``help`` and notebooks ask for its documentation."""

    @property
    def __doc__(cls) -> str:  # type: ignore[override]
        notes = [(key, note) for kind in cls.__mro__ for key, note in _notes().get(kind.__name__, {}).items()]
        lines = [next((str(of.__dict__["__doc__"]) for of in cls.__mro__ if of.__dict__.get("__doc__")), "")]
        lines += [f"{key}\n    {note}" for key, note in notes]
        return "\n\n".join(lines)


@dataclass_transform(kw_only_default=True)
class Table(metaclass=_Documented):
    """A table of a scene. Its attributes are its keys."""

    _section: ClassVar[str]
    _is_one_of_many: ClassVar[bool] = True
    _fixed: ClassVar[dict[str, Any]] = {}
    # Defaults of keys that are left out because they go without saying.
    _absent: ClassVar[dict[str, Any]] = {}
    # Value of a table that is left out of a scene because it is empty.
    _nothing: ClassVar[dict[str, Any]] = {}
    _keys: ClassVar[frozenset[str]] = frozenset()
    __signature__: ClassVar[Signature] = Signature()

    def __init_subclass__(cls) -> None:
        own = [key for key in cls.__dict__.get("__annotations__", {}) if not key.startswith("_")]
        named = [Parameter(key, Parameter.KEYWORD_ONLY, default=None if key in cls.__dict__ else Parameter.empty) for key in own]
        cls.__signature__ = Signature([*named, *cls.__signature__.parameters.values()])
        for key in set(own) & set(cls.__dict__):
            delattr(cls, key)
        cls._keys = cls._keys | set(own)

    def __init__(self, *unnamed: Any, **keys: Any) -> None:
        name = type(self).__name__
        if unnamed:
            raise TypeError(f"{name} takes its keys by their names, as in {name}({next(iter(self.__signature__.parameters))}=...)")
        object.__setattr__(self, "_table", {})
        Table.update(self, **keys)

    @classmethod
    def _of(cls, table: Mapping[str, Any]) -> Self:
        """Of a table that was checked."""
        made = cls.__new__(cls)
        object.__setattr__(made, "_table", dict(table))
        return made

    def _put(self, table: dict[str, Any]) -> None:
        object.__setattr__(self, "_table", self._checked(table))

    def _checked(self, table: dict[str, Any]) -> dict[str, Any]:
        section = self._section
        try:
            whole = core.check({**_FRAME, section: [table] if self._is_one_of_many else table}, alone=True)
        except SceneError as error:
            # There is only one, and nobody has counted it.
            right = str(error).replace(f"{section}[0]", section)
            key = error.key.replace(f"{section}[0]", section)
            raise SceneError(right, key=key, found=error.found, right=error.right) from None
        checked: dict[str, Any] = whole[section][0] if self._is_one_of_many else whole.get(section, self._nothing)
        return checked

    def update(self, **keys: Any) -> None:
        """Sets several keys at once: those that only fit together."""
        for key, right in self._fixed.items():
            if keys.get(key, right) != right:
                raise argument_error(f"{self._section}.{key}", f"found {keys[key]!r}", f"a {type(self).__name__} has {right!r} always")
        self._put({**self._table, **keys, **self._fixed})

    def to_dict(self) -> dict[str, Any]:
        """A copy as a dict of plain values."""
        return dict(self._table)

    def __getattr__(self, key: str) -> Any:
        if key in self._keys:
            table: dict[str, Any] = self._table
            return _frozen(table[key]) if key in table else self._absent.get(key)
        raise AttributeError(f"{type(self).__name__} has no attribute {key!r}")

    def __setattr__(self, key: str, value: Any) -> None:
        self.update(**{key: value})

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Table) and self._section == other._section and self._table == other._table

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        keys = ", ".join(f"{key}={_frozen(value)!r}" for key, value in self._table.items())
        return f"{type(self).__name__}({keys})"

    def __dir__(self) -> Iterable[str]:
        return [*super().__dir__(), *self._keys]

    # Without these `__getattr__` would be asked for them before there is a table.
    def __getstate__(self) -> dict[str, Any]:
        return self._table  # type: ignore[no-any-return]

    def __setstate__(self, table: dict[str, Any]) -> None:
        object.__setattr__(self, "_table", table)
