# SPDX-License-Identifier: Apache-2.0
"""Other libraries on the same solids and poses: see peers_benchmark.py."""
