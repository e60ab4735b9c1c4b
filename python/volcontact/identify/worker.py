# SPDX-License-Identifier: Apache-2.0
"""A process that runs trials for an identification; `pool.py` talks to it through pipes."""

from __future__ import annotations

import os
import sys
import threading
import time
import traceback

from volcontact.identify.bench import Bench
from volcontact.identify.settings import StudyError
from volcontact.identify.tasks import Task, run_task
from volcontact.study.child import _read, _write


def main() -> None:
    """The program."""
    requests, answers = sys.stdin.buffer, os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    threading.Thread(target=_end_with_parent, args=(os.getppid(),), daemon=True).start()
    bench: Bench | None = None
    while True:
        try:
            request = _read(requests)
        except EOFError:
            return
        try:
            if not isinstance(request, Task):
                bench = Bench(*request)
                _write(answers, ("ready", bench.deviations))
            else:
                assert bench is not None
                _write(answers, ("done", run_task(bench, request)))
        except StudyError as error:
            _write(answers, ("wrong", str(error)))
        except (ValueError, RuntimeError) as error:
            _write(answers, ("wrong", f"{type(error).__name__}: {error}"))
        except Exception:
            _write(answers, ("broken", traceback.format_exc()))


def _end_with_parent(parent: int) -> None:
    while os.getppid() == parent:
        time.sleep(0.5)
    os._exit(1)


if __name__ == "__main__":
    main()
