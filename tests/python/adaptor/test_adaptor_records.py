# SPDX-License-Identifier: Apache-2.0
"""The records that Python reads are those of the C header, field by field and byte by byte."""

import ctypes
import ctypes.util
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from volcontact import _adaptor

HEADER = Path(__file__).parents[3] / "plugin" / "adaptor" / "volcontact_mujoco.h"
RECORDS = {
    "volcontact_site": _adaptor.SITE_DTYPE,
    "volcontact_contact": _adaptor.CONTACT_DTYPE,
    "volcontact_energy": np.dtype(_adaptor.RawEnergy),
    "volcontact_surface_size": np.dtype(_adaptor.RawSurfaceSize),
}
PROGRAM = """
#include <stddef.h>
#include <stdio.h>
%s
int main(void) {
  %s
  return 0;
}
"""


def declaration(record):
    """The struct of the header, as it stands there."""
    found = re.search(rf"typedef struct {record}_ {{.*?}} {record};", HEADER.read_text(), re.DOTALL)
    assert found, record
    return found[0]


def fields_of(record):
    """Names, types and lengths of its fields, in their order."""
    body = re.sub(r"//[^\n]*", "", declaration(record)).partition("{")[2].rpartition("}")[0]
    fields = re.findall(r"(int|long long|double) (\w+)(?:\[(\d+)\])?;", body)
    assert len(fields) == body.count(";")
    types = {"int": "i4", "long long": "i8", "double": "f8"}
    return [(name, types[kind], int(n or 1)) for kind, name, n in fields]


@pytest.mark.parametrize("record", RECORDS)
def test_fields_are_those_of_the_header(record):
    dtype = RECORDS[record]
    ours = []
    for name in dtype.names:
        field = dtype[name]
        ours.append((name, field.base.str[1:], int(np.prod(field.shape, dtype=int))))
    assert ours == fields_of(record)


@pytest.mark.parametrize("record", RECORDS)
def test_places_are_those_of_a_c_compiler(record, tmp_path):
    compiler = shutil.which("cc") or shutil.which("gcc") or shutil.which("clang")
    if compiler is None:
        pytest.skip("there is no C compiler here")
    names = RECORDS[record].names
    prints = [f'printf("%zu ", offsetof({record}, {name}));' for name in names]
    prints.append(f'printf("%zu", sizeof({record}));')
    source = tmp_path / "places.c"
    source.write_text(PROGRAM % (declaration(record), "\n  ".join(prints)))
    subprocess.run([compiler, source, "-o", tmp_path / "places"], check=True)
    told = subprocess.run([tmp_path / "places"], capture_output=True, text=True, check=True).stdout
    fields = RECORDS[record].fields
    ours = [fields[name][1] for name in names] + [RECORDS[record].itemsize]
    assert [int(word) for word in told.split()] == ours


def test_the_library_has_records_of_the_same_length():
    library = _adaptor.adaptor()
    for name, size in _adaptor.record_sizes().items():
        assert library.call("record_size", name.encode()) == size > 0
    assert library.call("record_size", b"volcontact_nothing") == 0


def test_a_library_of_other_records_is_refused(monkeypatch):
    path = _adaptor.adaptor().path
    longer = np.dtype([*_adaptor.SITE_DTYPE.descr, ("more", "f8")])
    monkeypatch.setattr(_adaptor, "SITE_DTYPE", longer)
    with pytest.raises(RuntimeError, match=r"volcontact_site has \d+ bytes and .*build it again"):
        _adaptor.Adaptor(path)


def test_a_library_without_our_functions_is_refused():
    with pytest.raises(RuntimeError, match="it lacks volcontact_"):
        _adaptor.Adaptor(Path(ctypes.util.find_library("m") or "libm.so.6"))
