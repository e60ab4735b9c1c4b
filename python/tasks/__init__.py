# SPDX-License-Identifier: Apache-2.0
"""What the commands of `./run` do; `noxfile.py` lists them."""
