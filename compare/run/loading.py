"""Engines by name. Their modules are imported in another process, because an import may end its process."""

from __future__ import annotations

from collections.abc import Iterable

from compare.engines import Engine, engines, is_registered, known_name, told_apart
from compare.run.workers import Failure, Workers


def loaded(names: Iterable[str], workers: Workers) -> tuple[Engine, ...]:
    """Return the engines of the given names, as ``compare.engines.engines`` does, by one of the ``workers``.

    Raises ``ValueError`` for a name that is unknown or that the process could not load.
    """
    names = [known_name(name) for name in dict.fromkeys(names)]
    if all(map(is_registered, names)):
        return engines(names)
    return told_apart(names, [_loaded(name, workers) for name in names])


def _loaded(name: str, workers: Workers) -> Engine:
    found = workers.ask(_described, name)
    if isinstance(found, str):
        raise ValueError(found)
    if isinstance(found, Failure):
        raise ValueError(f"engine {name!r} can't be loaded: {found}")
    engine: Engine = found
    return engine


def _described(name: str) -> Engine | str:
    """Return the engine, which holds nothing of the module that it is from, or why there is none."""
    try:
        return engines([name])[0]
    except ValueError as error:
        return str(error)
