"""The live bar on a terminal, also on one that says that it has no columns."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

pytestmark = pytest.mark.skipif(os.name != "posix", reason="terminals as in POSIX")
_WAITS = """
import time
from slidercrank.optimise.front.progress import Progress, progress_bar
with progress_bar() as tell:
    tell(Progress("exploring", 2, 9, 0, 17, 0.25, 0.0))
    time.sleep(1.4)
"""


@pytest.mark.parametrize("size", [(0, 0), (24, 100)])
def test_the_clock_of_the_bar_goes_on_while_nothing_is_told(size: tuple[int, int]) -> None:
    import fcntl
    import pty
    import struct
    import termios

    ours, theirs = pty.openpty()
    fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", *size, 0, 0))
    os.set_blocking(ours, False)  # of a bar that shows nothing there is nothing to read
    subprocess.run([sys.executable, "-c", _WAITS], stderr=theirs, check=True)
    shown = os.read(ours, 10_000).decode()
    os.close(theirs)
    os.close(ours)
    assert "exploring 2/9" in shown
    assert "17 feasible" in shown
    assert "00:01" in shown
