# SPDX-License-Identifier: Apache-2.0
"""modelDescription.xml of FMI 2.0 and FMI 3.0."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from xml.sax.saxutils import quoteattr

from volcontact.fmu.container import Container
from volcontact.fmu.units import exponents, quantity
from volcontact.fmu.variables import Group, scalars

_TYPES = {
    2: {"real": "Real", "integer": "Integer", "boolean": "Boolean"},
    3: {"real": "Float64", "integer": "Int32", "boolean": "Boolean"},
}


@dataclass(frozen=True)
class About:
    """What the head of the file says.

    Attributes:
        text: one sentence.
        container: what is in a unit of contact models; None of a whole scene, whose outputs depend
            on all inputs.
        step: time step of a whole scene [s].
        sources: names of the files in the folder `sources`.
    """

    name: str
    text: str
    identifier: str
    token: str
    kind: str
    version: str
    date: str
    container: Container | None = None
    step: float | None = None
    sources: tuple[str, ...] = ()

    @property
    def model_count(self) -> int:
        """How many contact models there are."""
        return len(self.container.models) if self.container else 0


def tag(element: str, inner: str | None = None, /, **attributes: object) -> str:
    """An element; None leaves an attribute out."""
    written = "".join(
        f" {key}={quoteattr(_text(value))}"
        for key, value in attributes.items()
        if value is not None
    )
    if inner is None:
        return f"<{element}{written}/>"
    return f"<{element}{written}>\n{inner}\n</{element}>"


def _text(value: object) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    return repr(value) if isinstance(value, float) else str(value)


def description(fmi: int, about: About, groups: list[Group], *, arrays: bool = True) -> str:
    """The whole file; `arrays`: whether FMI 3 has them."""
    if fmi == 3 and not arrays:
        groups = scalars(groups)
    writer = _Two(about, groups) if fmi == 2 else _Three(about, groups)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + writer.file() + "\n"


class _Writer:
    fmi = 0

    def __init__(self, about: About, groups: list[Group]) -> None:
        self.about, self.groups = about, groups
        self.states = [group for group in groups if group.is_state and about.kind != "cs"]
        self.rates = [group for group in groups if group.state in self.states and group.state]
        self.outputs = [group for group in groups if group.causality == "output"]

    def head(self) -> dict[str, object]:
        about = self.about
        return {
            "modelName": about.name,
            "description": about.text,
            "author": "volcontact",
            "version": about.version,
            "license": "Apache-2.0",
            "generationTool": f"volcontact {about.version}",
            "generationDateAndTime": about.date,
            "variableNamingConvention": "structured",
        }

    def units(self) -> str:
        names = sorted({group.unit for group in self.groups} - {"-"})
        return tag(
            "UnitDefinitions",
            "\n".join(tag("Unit", tag("BaseUnit", **exponents(name)), name=name) for name in names),
        )

    def declared(self, group: Group) -> tuple[str, dict[str, object]] | None:
        """Name and attributes of the type of a real group, where there is something to say."""
        if group.kind != "real" or (group.unit == "-" and group.nominal is None):
            return None
        what = quantity(group.unit)
        name = what or ("Number" if group.unit == "-" else group.unit)
        if group.nominal is not None:
            name += f" of about {group.nominal:g}"
        unit = None if group.unit == "-" else group.unit
        return name, {"quantity": what, "unit": unit, "nominal": group.nominal}

    def categories(self) -> str:
        texts = {
            "logStatusWarning": "what the scene warns of",
            "logStatusDiscard": "values that cannot be used now",
            "logStatusError": "wrong calls",
        }
        return tag(
            "LogCategories",
            "\n".join(tag("Category", name=name, description=text) for name, text in texts.items()),
        )

    def common(self, group: Group, start: str | None) -> dict[str, object]:
        """Attributes of a variable's type."""
        if group.kind == "boolean":
            return {"start": start}
        whole = group.kind == "integer"
        number = int if whole else float
        return {
            "min": None if group.low is None else number(group.low),
            "max": None if group.high is None else number(group.high),
            "start": start,
        }

    def start(self, group: Group, values: list[float]) -> str | None:
        if group.initial != "exact":
            return None
        if group.kind == "integer":
            values = [int(value) for value in values]
        return " ".join(_text(value) for value in values)

    def knowns(self, group: Group) -> list[Group]:
        """Inputs and states that a group depends on; of a scene that is not said."""
        if group.is_state:
            return [group] if group in self.states else []
        slots = {model: self._slots(model) for model in group.models}
        return [
            known
            for known in self.groups
            if (known.causality == "input" and known.index in group.needs)
            or (known in self.states and known.role == "state"
                and any(known.index in span for span in slots.values()))
        ]  # fmt: skip

    def _slots(self, model: int) -> range:
        models = self.about.model_count
        count = 1 + max(
            (group.index for group in self.groups if group.role == "site_active"), default=-1
        )
        each = count // models
        return range(model * each, (model + 1) * each)

    def kinds(self) -> tuple[bool, bool]:
        return self.about.kind != "cs", self.about.kind != "me"


class _Two(_Writer):
    fmi = 2

    def file(self) -> str:
        exchange, simulation = self.kinds()
        files = (
            tag("SourceFiles", "\n".join(tag("File", name=name) for name in self.about.sources))
            if self.about.sources
            else None
        )
        state = {"canGetAndSetFMUstate": True, "canSerializeFMUstate": True}
        parts = []
        if exchange:
            parts.append(tag("ModelExchange", files, modelIdentifier=self.about.identifier, **state,
                             providesDirectionalDerivative=True))  # fmt: skip
        if simulation:
            parts.append(tag("CoSimulation", files, modelIdentifier=self.about.identifier,
                             canHandleVariableCommunicationStepSize=True, **state))  # fmt: skip
        self.places = self._places()
        parts += [
            self.units(),
            self.categories(),
            tag("DefaultExperiment", startTime=0.0, stopTime=1.0, stepSize=self.about.step or 1e-3),
            tag("ModelVariables", "\n".join(self._variables())),
            tag("ModelStructure", "\n".join(self._structure())),
        ]  # fmt: skip
        indicators = 2 * self.about.model_count if exchange else None
        return tag("fmiModelDescription", "\n".join(parts), fmiVersion="2.0", **self.head(),
                   guid=self.about.token, numberOfEventIndicators=indicators)  # fmt: skip

    def _places(self) -> dict[int, int]:
        """Index of the first scalar of each group, from 1, by its value reference."""
        return {group.first: group.first + 1 for group in self.groups}

    def _variables(self) -> Iterator[str]:
        for group in self.groups:
            for i, name in enumerate(group.names()):
                yield self._variable(group, i, name)

    def _variable(self, group: Group, i: int, name: str) -> str:
        declared = self.declared(group)
        of = (declared[1] if declared else {}) | self.common(
            group, self.start(group, group.start[i : i + 1])
        )
        if group in self.rates and group.state is not None:
            of["derivative"] = self.places[group.state.first] + i
        return tag(
            "ScalarVariable",
            tag(_TYPES[2][group.kind], **of),
            name=name,
            valueReference=group.first + i,
            description=group.description,
            causality=group.causality,
            variability=group.variability,
            initial=None if group.causality == "input" else group.initial,
        )

    def _scalars(self, groups: list[Group]) -> list[tuple[Group, int]]:
        return [(group, i) for group in groups for i in range(group.count)]

    def _unknowns(self, name: str, groups: list[Group], *, known: bool = True) -> str:
        rows = []
        for group, i in self._scalars(groups):
            on: list[int] = []
            if known and group.is_state:
                on = [self.places[group.first] + i] if group in self.states else []
            elif known:
                on = [self.places[one.first] + k for one, k in self._scalars(self.knowns(group))]
            rows.append(tag(
                "Unknown",
                index=self.places[group.first] + i,
                dependencies=" ".join(map(str, on)) if known else None,
                dependenciesKind=" ".join("dependent" for _ in on) if known else None,
            ))  # fmt: skip
        return tag(name, "\n".join(rows))

    def _structure(self) -> Iterator[str]:
        yield self._unknowns("Outputs", self.outputs, known=self.about.container is not None)
        if self.rates:
            by_state = sorted(self.rates, key=lambda group: group.state.first if group.state else 0)
            yield self._unknowns("Derivatives", by_state)
        unknown = self.outputs + self.rates
        first = [g for g in self.groups if g in unknown and g.initial == "calculated"]
        yield self._unknowns("InitialUnknowns", first, known=False)


class _Three(_Writer):
    fmi = 3

    def file(self) -> str:
        exchange, simulation = self.kinds()
        state = {"canGetAndSetFMUState": True, "canSerializeFMUState": True}
        parts = []
        if exchange:
            parts.append(tag("ModelExchange", modelIdentifier=self.about.identifier, **state,
                             providesDirectionalDerivatives=True))  # fmt: skip
        if simulation:
            parts.append(tag("CoSimulation", modelIdentifier=self.about.identifier, **state,
                             canHandleVariableCommunicationStepSize=True,
                             providesIntermediateUpdate=True,
                             canReturnEarlyAfterIntermediateUpdate=True,
                             mightReturnEarlyFromDoStep=True, hasEventMode=True,
                             fixedInternalStepSize=self.about.step))  # fmt: skip
        parts += [
            self.units(),
            self._types(),
            self.categories(),
            tag("DefaultExperiment", startTime=0.0, stopTime=1.0, stepSize=self.about.step or 1e-3),
            tag("ModelVariables", "\n".join(map(self._variable, self.groups))),
            tag("ModelStructure", "\n".join(self._structure())),
        ]  # fmt: skip
        return tag("fmiModelDescription", "\n".join(parts), fmiVersion="3.0", **self.head(),
                   instantiationToken=self.about.token)  # fmt: skip

    def _types(self) -> str:
        """Units, quantities and nominal values, in types that the variables name."""
        types = dict(filter(None, map(self.declared, self.groups)))
        return tag(
            "TypeDefinitions",
            "\n".join(tag("Float64Type", name=name, **of) for name, of in sorted(types.items())),
        )

    def _variable(self, group: Group) -> str:
        of = self.common(group, self.start(group, group.start))
        if (declared := self.declared(group)) is not None:
            of["declaredType"] = declared[0]
        if group in self.rates and group.state is not None:
            of["derivative"] = group.state.first
        return tag(
            _TYPES[3][group.kind],
            tag("Dimension", start=group.count) if group.count > 1 else None,
            name=group.name,
            valueReference=group.first,
            description=group.description,
            causality=group.causality,
            variability=group.variability,
            initial=None if group.causality == "input" else group.initial,
            **of,
        )

    def _unknown(self, name: str, group: Group, *, known: bool = True) -> str:
        on = [one.first for one in self.knowns(group)]
        return tag(
            name,
            valueReference=group.first,
            dependencies=" ".join(map(str, on)) if known else None,
            dependenciesKind=" ".join("dependent" for _ in on) if known else None,
        )

    def _structure(self) -> Iterator[str]:
        for group in self.outputs:
            yield self._unknown("Output", group, known=self.about.container is not None)
        for group in sorted(self.rates, key=lambda group: group.state.first if group.state else 0):
            yield self._unknown("ContinuousStateDerivative", group)
        for group in self.groups:
            if (group in self.outputs or group in self.rates) and group.initial == "calculated":
                yield self._unknown("InitialUnknown", group, known=False)
        for group in self.groups:
            if group.role == "indicator":
                yield self._unknown("EventIndicator", group)
