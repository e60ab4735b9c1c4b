# SPDX-License-Identifier: Apache-2.0
"""From errors to parameters: fits, searches and chains, and how well parameters are then known."""
