# SPDX-License-Identifier: Apache-2.0
"""The files of a run or a comparison: what a new one in the same folder replaces."""

REPORT, SUMMARY, FILM = "report.html", "summary.json", "run.mp4"
TRAJECTORY, SITES = "trajectory.parquet", "sites.parquet"
FRAMES, FIGURES = "frames", "figures"

# Whatever of them an earlier run has left, that the new one has not, goes.
ALL = (
    REPORT,
    SUMMARY,
    FILM,
    TRAJECTORY,
    "trajectory.csv",
    SITES,
    "sites.csv",
    f"{FRAMES}/frame_[0-9][0-9][0-9][0-9].png",
    f"{FIGURES}/*.svg",
    f"{FIGURES}/*.png",
)
