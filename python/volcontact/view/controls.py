# SPDX-License-Identifier: Apache-2.0
"""The panel of the page: what steers the stage, what is drawn, and when of it is shown."""

from __future__ import annotations

from typing import Any

from volcontact.view.stage import Stage

_FOLLOWS = 1e-3  # of what is recorded: a change of the time that the slider follows [-]


class Controls:
    """Buttons, boxes and sliders.

    Args:
        gui: of a viser server.
        stage: that they steer.

    Attributes:
        text: place for the numbers, at the end.
        clip_for: the client that wants a clip, until it has it; else None.
    """

    def __init__(self, gui: Any, stage: Stage) -> None:
        self._stage = stage
        self._scrubbed = False
        self.clip_for: Any = None
        self._pause = gui.add_button("Pause")
        self._step = gui.add_button("One step")
        self._reset = gui.add_button("Start again")
        self._contact = gui.add_dropdown(
            "Contact", ("volumetric", "native"), initial_value=stage.contact
        )
        self._speed = gui.add_slider("Speed", 0.01, 2.0, 0.01, min(stage.speed, 2.0))
        self._time = gui.add_slider("Time [s]", 0.0, 1.0, 0.001, 0.0)
        self._clip = gui.add_button("Save a clip")
        with gui.add_folder("Draw"):
            self.patches = gui.add_checkbox("patches", True)
            self.bodies = gui.add_checkbox("overlaps", True)
            self.thick = gui.add_checkbox("overlaps thick enough to see", True)
            self.forces = gui.add_checkbox("forces", True)
            self.numbers = gui.add_checkbox("numbers", False)
        self.text = gui.add_markdown("")
        self._add_callbacks()
        self.follow()

    @property
    def drawn(self) -> tuple[bool, ...]:
        """What shall be drawn."""
        boxes = (self.patches, self.bodies, self.thick, self.forces, self.numbers)
        return tuple(box.value for box in boxes)

    def follow(self) -> None:
        """Shows the state of the stage: it changes by itself, too."""
        stage, history = self._stage, self._stage.history
        self._pause.label = "Go on" if stage.paused else "Pause"
        end = max(history.end, history.begin + 1e-3)
        if self._time.max != end or self._time.min != history.begin:
            self._time.max, self._time.min = end, history.begin
        if self._scrubbed and stage.paused:
            return  # the slider is where somebody put it
        self._scrubbed = False
        if abs(self._time.value - stage.data.time) > _FOLLOWS * (end - history.begin):
            self._time.value = min(max(stage.data.time, history.begin), end)

    def say_clip(self, text: str) -> None:
        """What the button of the clip says; empty: what it does."""
        self._clip.label = text or "Save a clip"
        self._clip.disabled = bool(text)

    def _add_callbacks(self) -> None:
        self._pause.on_click(self._on_pause)
        self._step.on_click(self._on_step)
        self._reset.on_click(self._on_reset)
        self._contact.on_update(self._on_contact)
        self._speed.on_update(self._on_speed)
        self._time.on_update(self._on_time)
        self._clip.on_click(self._on_clip)

    def _on_pause(self, _: Any) -> None:
        self._stage.paused = not self._stage.paused
        self.follow()

    def _on_step(self, _: Any) -> None:
        self._stage.paused, self._scrubbed = True, False
        self._stage.step()

    def _on_reset(self, _: Any) -> None:
        self._scrubbed = False
        self._stage.reset()

    def _on_contact(self, _: Any) -> None:
        self._stage.set_contact("native" if self._contact.value == "native" else "volumetric")

    def _on_speed(self, _: Any) -> None:
        self._stage.speed = self._speed.value

    def _on_time(self, event: Any) -> None:
        if event.client is not None:  # not by `follow`
            self._scrubbed = True
            self._stage.show(self._time.value)

    def _on_clip(self, event: Any) -> None:
        self.clip_for = event.client
