"""The progress bar: one line on a terminal, nothing elsewhere."""

import os
import re
import struct
import subprocess
import sys

import pytest

PROGRAM = """
from contextlib import closing
from beetle_ik.calls.progress import Bar
with closing(Bar()) as bar:
    for done in range(1, 51):
        bar.show("working", done, 50)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="pseudo-terminals are of POSIX")
@pytest.mark.parametrize("columns", [0, 30, 120])
def test_the_bar_is_one_line_on_a_terminal(columns: int) -> None:
    import fcntl
    import pty
    import termios

    ours, theirs = pty.openpty()
    fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
    subprocess.run([sys.executable, "-c", PROGRAM], check=True, stderr=theirs)
    os.close(theirs)
    drawn = os.read(ours, 100_000).decode()
    os.close(ours)
    assert drawn.endswith("\r\n")
    lines = drawn.removesuffix("\r\n").split("\r")
    assert lines[0] == ""
    assert {len(line) for line in lines[1:]} == {(columns or 80) - 1}
    last = re.sub(r"\d:\d\d:\d\d", "TIME", lines[-1].rstrip())
    assert ("#" * 40 + " 100% 50/50 TIME working").startswith(last)
    assert "\n" not in drawn[:-2]


def test_nothing_is_drawn_into_a_pipe() -> None:
    done = subprocess.run([sys.executable, "-c", PROGRAM], check=True, capture_output=True, text=True)
    assert (done.stdout, done.stderr) == ("", "")
