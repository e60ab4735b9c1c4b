# SPDX-License-Identifier: Apache-2.0
"""`python -m volcontact.cli` is the program `volcontact`."""

import sys

from volcontact.cli import main

sys.exit(main())
