"""`beetle-ik ros` against the program of this folder: python exchange.py DDS_PEER.

700 trajectories, then 300 more while the node is ended and started again.
"""

import os
import subprocess
import sys
import tempfile
import threading
from pathlib import Path

DOMAIN = str(1 + os.getpid() % 100)
URDF = """<robot name="arm">
  <link name="base"/><link name="upper"/><link name="fore"/><link name="hand"/>
  <joint name="lift" type="prismatic"><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" velocity="1" effort="1"/></joint>
  <joint name="shoulder" type="revolute"><parent link="upper"/><child link="fore"/>
    <origin xyz="0.5 0 0"/><axis xyz="0 0 1"/>
    <limit lower="-2" upper="2" velocity="1" effort="1"/></joint>
  <joint name="elbow" type="revolute"><parent link="fore"/><child link="hand"/>
    <origin xyz="0.5 0 0"/><axis xyz="0 0 1"/>
    <limit lower="-2" upper="2" velocity="1" effort="1"/></joint>
</robot>"""


def node(lines: list[str]) -> subprocess.Popen[str]:
    """Starts the node, whose lines are kept. Its motions are short, so that many fit a test."""
    command = [sys.executable, "-m", "beetle_ik", "ros", "--domain", DOMAIN, "--robot-description"]
    started = subprocess.Popen(
        [*command, "--acceleration", "1000", "--jerk", "1000000"],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        env=os.environ | {"PYTHONUNBUFFERED": "1"},
    )
    assert started.stdout is not None
    threading.Thread(target=lambda: lines.extend(started.stdout or ()), daemon=True).start()
    return started


def main() -> None:
    """Exits with 1 if anything is missing."""
    program = sys.argv[1]
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "arm.urdf"
        file.write_text(URDF, encoding="utf-8")
        first: list[str] = []
        second: list[str] = []
        serving = node(first)
        for count in ("400", "300"):  # the peer starts again
            subprocess.run([program, DOMAIN, count, str(file)], check=True)
        peer = subprocess.Popen([program, DOMAIN, "300", str(file)])
        while sum(line.startswith("info: planned") for line in first) < 800 and peer.poll() is None:
            threading.Event().wait(0.01)
        serving.kill()
        serving.wait()
        serving = node(second)
        failed = peer.wait()
        serving.kill()
    answers = [line for line in first + second if line.startswith("error")]
    planned = sum(line.startswith("info: planned") for line in first + second)
    print(f"{planned} plans sent, {len(answers)} lines about messages that could not be used; the first of each:")
    print("".join(sorted(set(answers))[:8]), end="")
    assert not failed
    assert planned >= 1000
    assert "error: joint_states: 1 names, but 0 positions\n" in answers
    assert "error: joint_states: joint 'lift' is at nan\n" in answers


if __name__ == "__main__":
    main()
