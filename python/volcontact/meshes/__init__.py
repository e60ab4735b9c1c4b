# SPDX-License-Identifier: Apache-2.0
"""Mesh files: reading, judging, repairing and writing them. Nothing here steps a simulation."""
