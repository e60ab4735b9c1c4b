# SPDX-License-Identifier: Apache-2.0
"""Methods whose trials follow from the results of earlier ones.

Each is a generator: it gives the values of a round, and is sent the responses of its trials, in
their order. So the trials depend on the seed and on results alone, and `resume` walks the same way
again over the rows that are there.
"""
