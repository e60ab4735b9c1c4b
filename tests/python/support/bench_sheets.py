# SPDX-License-Identifier: Apache-2.0
"""The bench tests of mjcf_models/identification: simulated, and with noise."""

import importlib.util
from pathlib import Path

import numpy as np

from volcontact.identify.direct import ESTIMATORS
from volcontact.identify.direct.layouts import LAYOUTS
from volcontact.identify.direct.sheets import Sheet, parse_sheet

FOLDER = Path(__file__).parents[3] / "mjcf_models" / "identification"


def simulations():
    """The module that simulates the scenes."""
    spec = importlib.util.spec_from_file_location("make_sheets", FOLDER / "make_sheets.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def kept_sheet(test, name="sheet.csv"):
    """The sheet in the folder of a scene."""
    return parse_sheet((FOLDER / test / name).read_text(), LAYOUTS[test], name)


def repeated(sheet, times):
    """The rows several times, for repetitions that differ by their noise."""
    columns = {name: np.tile(column, times) for name, column in sheet.columns.items()}
    return Sheet(sheet.test, sheet.source, columns, {}, sheet.constants)


def noisy(sheet, noise, seed):
    """The same with normal noise on some columns [SI]."""
    random = np.random.default_rng((seed, len(sheet.test)))
    columns = dict(sheet.columns)
    for name, sigma in noise.items():
        columns[name] = columns[name] + sigma * random.standard_normal(len(columns[name]))
    return Sheet(sheet.test, sheet.source, columns, sheet.labels, sheet.constants)


def read(sheet):
    """What the estimator of its test says."""
    return ESTIMATORS[sheet.test](sheet)
