# SPDX-License-Identifier: Apache-2.0
"""Runs of a scene: what drives them, what is watched in each step, what they leave."""
