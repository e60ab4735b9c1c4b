# SPDX-License-Identifier: Apache-2.0
"""What messages and tables call things, and what they say of wrong arguments."""
