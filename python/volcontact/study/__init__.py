# SPDX-License-Identifier: Apache-2.0
"""Studies: thousands of trials of a scene, over what varies. See docs/studies.md."""

from __future__ import annotations

import dataclasses
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

from volcontact.study.file.settings import Settings, StudyError

if TYPE_CHECKING:
    import numpy as np
    import pyarrow as pa

    from volcontact.study.driver import Progress

__all__ = ["Study", "StudyError"]


class Study:
    """A scene, what varies, how it is sampled, what is recorded, and what success means.

        study = vc.Study("mjcf_models/studies/peg_in_hole_misalignment/study.toml")
        study.check()
        study.run("results", engine="processes", trials=1000)
        rows = study.rows("results")

    Args:
        path: of the study file.
        trials: instead of those of the file.
        seed: instead of that of the file.

    Raises:
        FileNotFoundError: there is no such file.
        StudyError: a line of it is wrong; the message says which, and how to put it right.
    """

    def __init__(
        self, path: str | os.PathLike[str], *, trials: int | None = None, seed: int | None = None
    ) -> None:
        from volcontact.study.file.reading import read_study

        settings = read_study(path)
        sample = settings.sample
        if trials is not None:
            if not trials >= 1:
                raise StudyError(f"trials = {trials}: must be at least 1")
            sample = dataclasses.replace(sample, trials=trials)
        if seed is not None:
            if not 0 <= seed < 2**63:
                raise StudyError(f"seed = {seed}: must be from 0 to 2^63 - 1")
            sample = dataclasses.replace(sample, seed=seed)
        self._settings = dataclasses.replace(settings, sample=sample)

    @property
    def settings(self) -> Settings:
        """What the file says, after the checks."""
        return self._settings

    def check(self) -> dict[str, np.ndarray]:
        """Checks the study against its scene, and draws inputs, without running a trial.

        Returns:
            Values of the inputs of the first 1000 trials, by column.

        Raises:
            StudyError: something is not there, or a value cannot be.
        """
        import numpy as np

        from volcontact.study.driver import check_trials
        from volcontact.study.plans import Plan

        check_trials(self._settings)
        first = next(iter(Plan(self._settings).rounds()))
        return first.values(np.arange(min(first.count, 1000)))

    def run(
        self,
        out: str | os.PathLike[str],
        *,
        engine: str = "processes",
        workers: int | None = None,
        address: str | None = None,
        progress: Progress | None = None,
    ) -> None:
        """Runs all trials into a new folder.

        Args:
            out: the folder.
            engine: `serial`, `processes`, `ray` or `dask`; the results are the same bits.
            workers: trials at a time; None takes all cores, or the whole cluster.
            address: of a running Ray or Dask cluster.
            progress: called with trials done, trials in all, and trials by outcome.

        Raises:
            StudyError: the study cannot be run, or the folder cannot be written to.
        """
        from volcontact.study.driver import run_study
        from volcontact.study.replay import record_trajectories

        run_study(
            self._settings,
            Path(out),
            engine=engine,
            workers=workers,
            address=address,
            progress=progress,
        )
        record_trajectories(Path(out))

    @staticmethod
    def resume(out: str | os.PathLike[str], **how: Any) -> None:
        """Runs the trials of a folder that have no row yet; keywords as of `run`.

        Raises:
            StudyError: no folder of a study, or its scene has changed since.
        """
        from volcontact.study.driver import resume_study
        from volcontact.study.replay import record_trajectories

        resume_study(Path(out), **how)
        record_trajectories(Path(out))

    @staticmethod
    def rows(out: str | os.PathLike[str]) -> pa.Table:
        """All rows of a folder so far, ordered by trial, as a table of pyarrow."""
        from volcontact.study.results import Folder

        return Folder(out).read()

    @staticmethod
    def replay(out: str | os.PathLike[str], trial: int) -> dict[str, Any]:
        """Runs one trial again, to the same bits.

        Returns:
            Its row.

        Raises:
            StudyError: the folder has no such trial, or its scene has changed since.
        """
        from volcontact.study.replay import replay_trial

        return replay_trial(Path(out), trial).row
