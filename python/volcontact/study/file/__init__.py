# SPDX-License-Identifier: Apache-2.0
"""The study file: read strictly, and what it says after every check."""
