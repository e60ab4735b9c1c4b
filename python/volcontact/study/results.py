# SPDX-License-Identifier: Apache-2.0
"""The folder of a study: rows in Parquet parts, where they come from, and who writes them."""

from __future__ import annotations

import fcntl
import hashlib
import json
import os
import platform
import sys
import time
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

import volcontact
from volcontact._files import appearing
from volcontact.study.file.settings import Settings, StudyError

STUDY, PROVENANCE, TRIALS = "study.toml", "provenance.json", "trials"
LOCK, MARKER = ".lock", ".trial"  # held by the driver; the trial that a serial one runs
_KINDS = {
    "int": pa.int64(),
    "float": pa.float64(),
    "bool": pa.bool_(),
    "text": pa.dictionary(pa.int32(), pa.string()),
}


def schema_of(columns: dict[str, str]) -> pa.Schema:
    """The schema of the rows."""
    return pa.schema([pa.field(name, _KINDS[kind]) for name, kind in columns.items()])


class Folder:
    """The results of a study.

    Args:
        path: of the folder.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = Path(path)
        self.trials = self.path / TRIALS
        self._lock: Any = None

    def create(self, provenance: dict[str, Any], study: str) -> None:
        """Makes the folder of a new study.

        Raises:
            StudyError: there are results in it, or it cannot be written to.
        """
        if (self.path / PROVENANCE).exists():
            raise StudyError(
                f"{self.path}: has the results of a study; go on with "
                f"`volcontact study resume {self.path}`, or give another folder"
            )
        try:
            self.trials.mkdir(parents=True, exist_ok=True)
            if any(self.trials.iterdir()):
                raise StudyError(f"{self.trials}: is not empty; give another folder")
            with appearing(self.path / STUDY) as file:
                file.write_text(study, encoding="utf-8")
            self.write_provenance(provenance)
        except OSError as error:
            raise StudyError(
                f"{self.path}: cannot be written to ({error.strerror}); give another folder "
                "with --out"
            ) from error

    def write_provenance(self, content: dict[str, Any]) -> None:
        """Writes where the results come from."""
        with appearing(self.path / PROVENANCE) as file:
            file.write_text(json.dumps(content, indent=2) + "\n", encoding="utf-8")

    def provenance(self) -> dict[str, Any]:
        """Where the results come from.

        Raises:
            StudyError: this is no folder of a study.
        """
        try:
            text = (self.path / PROVENANCE).read_text(encoding="utf-8")
        except OSError as error:
            raise StudyError(
                f"{self.path}: is no folder of a study ({PROVENANCE} is missing)"
            ) from (error)
        found: dict[str, Any] = json.loads(text)
        return found

    def lock(self) -> None:
        """Takes the folder for one driver.

        Raises:
            StudyError: another one writes to it.
        """
        file = (self.path / LOCK).open("a")
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            file.close()
            raise StudyError(f"{self.path}: another run writes to this folder") from error
        self._lock = file

    def unlock(self) -> None:
        """Gives the folder free."""
        if self._lock is not None:
            self._lock.close()
            self._lock = None

    def is_running(self) -> bool:
        """Whether a driver writes to it."""
        try:
            with (self.path / LOCK).open("a") as file:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            return True
        return False

    def parts(self) -> list[Path]:
        """All parts, the oldest first."""
        return sorted(self.trials.glob("part-*.parquet"))

    def add(self, rows: list[dict[str, Any]], schema: pa.Schema) -> None:
        """Adds a part, which is there whole or not at all."""
        if not rows:
            return
        ordered = sorted(rows, key=lambda row: int(row["trial"]))
        table = pa.Table.from_pylist(ordered, schema=schema)
        last = self.parts()
        number = int(last[-1].stem.removeprefix("part-")) + 1 if last else 0
        with appearing(self.path / ".next") as file:
            # Floats by their bytes, and no statistics: half the size of small parts.
            floats = [field.name for field in schema if pa.types.is_floating(field.type)]
            texts = [field.name for field in schema if pa.types.is_dictionary(field.type)]
            pq.write_table(
                table,
                file,
                compression="zstd",
                use_dictionary=texts,
                use_byte_stream_split=floats,
                write_statistics=False,
                store_schema=False,
            )
        os.replace(self.path / ".next", self.trials / f"part-{number:06d}.parquet")

    def read(self, columns: Iterable[str] | None = None) -> pa.Table:
        """All rows so far, ordered by trial."""
        wanted = None if columns is None else list(columns)
        tables = [pq.read_table(part, columns=wanted) for part in self.parts()]
        if not tables:
            raise StudyError(f"{self.path}: has no trials yet")
        table = pa.concat_tables(tables)
        return table.sort_by("trial") if "trial" in table.column_names else table

    def done(self, total: int) -> np.ndarray:
        """Which trials have a row, shape (total,)."""
        found = np.zeros(total, bool)
        for part in self.parts():
            numbers = pq.read_table(part, columns=["trial"])["trial"].to_numpy()
            if found[numbers].any() or len(np.unique(numbers)) != len(numbers):
                raise StudyError(f"{part.name}: has trials that another part has")
            found[numbers] = True
        return found

    def counts(self) -> dict[str, int]:
        """Trials by outcome."""
        found: dict[str, int] = {}
        for part in self.parts():
            for entry in pq.read_table(part, columns=["outcome"])["outcome"].value_counts():
                word = str(entry["values"])
                found[word] = found.get(word, 0) + int(entry["counts"].as_py())
        return found

    def tidy(self) -> None:
        """Removes what a driver that was killed had not finished."""
        for file in [*self.path.glob(".volcontact-*"), *self.path.glob(".next")]:
            file.unlink(missing_ok=True)


def provenance_of(settings: Settings, trials: int, out: Path) -> dict[str, Any]:
    """Where the results of a study come from: what decides their bits, and where it ran.

    Args:
        settings: of the study.
        trials: of its plan.
        out: folder of the results.
    """
    return {
        "name": settings.name,
        "study_sha256": _sha256(settings.text.encode()),
        "folder": str(settings.folder),
        "folder_from_results": os.path.relpath(settings.folder, Path(out).resolve()),
        "model_sha256": model_hash(settings),
        "functions_sha256": _sha256(settings.python.read_bytes()) if settings.python else None,
        "method": settings.sample.method,
        "trials": trials,
        "asked_trials": settings.sample.trials,
        "seed": settings.sample.seed,
        "versions": {
            "volcontact": volcontact.__version__,
            "mujoco": mujoco.mj_versionString(),
            "numpy": np.__version__,
            "scipy": __import__("scipy").__version__,
            "python": platform.python_version(),
        },
        "machine": {"system": platform.platform(), "processor": _processor()},
        "sessions": [],
    }


def model_hash(settings: Settings) -> str | None:
    """A digest of the scene as MuJoCo compiles it, with its meshes."""
    if settings.scene is None:
        return None
    from volcontact.study.mjcf import Document

    model = mujoco.MjModel.from_xml_string(Document(settings.scene).text())
    buffer = np.zeros(mujoco.mj_sizeModel(model), np.uint8)
    mujoco.mj_saveModel(model, None, buffer)
    return _sha256(buffer.tobytes())


def session(engine: str, workers: int) -> dict[str, Any]:
    """One run of a driver, for the provenance."""
    return {"engine": engine, "workers": workers, "begin": time.time(), "pid": os.getpid()}


def _sha256(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


def _processor() -> str:
    if sys.platform == "linux":
        for line in Path("/proc/cpuinfo").read_text().splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor()
