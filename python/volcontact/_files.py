# SPDX-License-Identifier: Apache-2.0
"""Files that appear whole or not at all, whatever ends the program that writes them."""

from __future__ import annotations

import contextlib
import os
import shutil
import signal
import tempfile
import threading
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from types import FrameType

_PREFIX = ".volcontact-"  # of what is not ready yet
ENDING_SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


@contextlib.contextmanager
def appearing(path: str | os.PathLike[str]) -> Iterator[Path]:
    """A file to write, which takes the place of `path` when all has gone well.

    Yields:
        Path of an empty file beside it, with the same suffix.

    Raises:
        OSError: the folder cannot be written to; at once.
    """
    target = Path(path)
    # One that is no regular file, as /dev/stdout, is not to be replaced.
    if target.exists() and not target.is_file():
        yield target
        return
    handle, name = tempfile.mkstemp(dir=target.parent, prefix=_PREFIX, suffix=target.suffix)
    os.close(handle)
    part = Path(name)
    try:
        part.chmod(0o666 & ~_umask())
        yield part
        _flush_to_disk(part)
        part.replace(target)
    except BaseException:
        with contextlib.suppress(OSError):
            part.unlink()
        raise


@contextlib.contextmanager
def appearing_in(folder: str | os.PathLike[str], replaces: Iterable[str] = ()) -> Iterator[Path]:
    """A folder to write into, whose files appear in `folder` all at the same time.

    Until then, and when anything goes wrong, `folder` stays as it was. All other files in it stay.

    Args:
        folder: made when missing.
        replaces: patterns of files in it that go when the new ones come.

    Yields:
        Path of the folder to write into.

    Raises:
        OSError: the folder cannot be made or written to; at once.
    """
    place = Path(folder)
    missing = [path for path in (place, *place.parents) if not path.exists()]
    place.mkdir(parents=True, exist_ok=True)
    try:
        part = Path(tempfile.mkdtemp(dir=place, prefix=_PREFIX))
        try:
            new, old = part / "new", part / "old"
            new.mkdir()
            yield new
            _exchange(new, old, place, tuple(replaces))
        finally:
            shutil.rmtree(part, ignore_errors=True)
    except BaseException:
        for path in missing:  # the innermost first
            with contextlib.suppress(OSError):
                path.rmdir()
        raise


def _exchange(new: Path, old: Path, place: Path, replaces: tuple[str, ...]) -> None:
    """Moves the old files out and the new ones in; what fails half-way is taken back."""
    coming = sorted(path.relative_to(new) for path in new.rglob("*") if path.is_file())
    found = (path for pattern in replaces for path in place.glob(pattern))
    going = {path.relative_to(place) for path in (*found, *map(place.joinpath, coming))}
    moves = [(place / name, old / name) for name in sorted(going) if (place / name).is_file()]
    moves += [(new / name, place / name) for name in coming]
    for name in coming:
        _flush_to_disk(new / name)
    done: list[tuple[Path, Path]] = []
    with _held_signals():
        try:
            for source, target in moves:
                target.parent.mkdir(parents=True, exist_ok=True)
                source.replace(target)
                done.append((source, target))
        except BaseException:
            for source, target in reversed(done):
                target.replace(source)
            raise


def _flush_to_disk(path: Path) -> None:
    """Waits until the file is there; a disk that is full says so here at the latest."""
    handle = os.open(path, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask


@contextlib.contextmanager
def _held_signals() -> Iterator[None]:
    """Within it signals that end the program wait until its end."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    waiting: list[tuple[int, FrameType | None]] = []
    before: dict[int, Callable[[int, FrameType | None], object] | int | None] = {}
    for number in ENDING_SIGNALS:
        before[number] = signal.getsignal(number)
        if before[number] not in (signal.SIG_IGN, None):
            signal.signal(number, lambda *arguments: waiting.append(arguments))
    try:
        yield
    finally:
        for held, handler in before.items():
            if handler not in (signal.SIG_IGN, None):
                signal.signal(held, handler)
        for came, _ in waiting[:1]:
            signal.raise_signal(came)
