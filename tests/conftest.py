# SPDX-License-Identifier: Apache-2.0
"""Files with the longest tests are begun first: one that is begun last keeps one core waiting."""

# A test in them takes half a minute or more: it compiles, reads all types, or starts a simulator.
BEGUN_FIRST = (
    "test_fmu_sources.py",
    "test_public_names.py",
    "test_adaptor_build.py",
    "test_own_laws.py",
    "test_host_examples.py",
)


def pytest_collection_modifyitems(items):
    """The order within a file, and of all others, stays."""
    place = {name: number for number, name in enumerate(BEGUN_FIRST)}
    items.sort(key=lambda item: place.get(item.path.name, len(place)))
