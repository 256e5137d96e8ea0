"""Platforms promised in docs/stability.md."""

import os
import re
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest

from beetle_ik import _core

ROOT = Path(__file__).parents[2]
FREE_THREADED = bool(sysconfig.get_config_var("Py_GIL_DISABLED"))


def test_the_module_declares_that_it_needs_the_lock() -> None:
    # The stable ABI has no slot for it: on other builds of Python only the source can tell.
    source = (ROOT / "crates" / "ikpy-bind" / "src" / "lib.rs").read_text(encoding="utf-8")
    assert re.findall(r"#\[pymodule.*\]", source) == ["#[pymodule(gil_used = true)]"]


@pytest.mark.skipif(not FREE_THREADED, reason="asks for a free-threaded Python")
def test_free_threaded_python_turns_its_lock_on() -> None:
    program = "import sys, beetle_ik; print(sys._is_gil_enabled())"
    environment = {name: value for name, value in os.environ.items() if name != "PYTHON_GIL"}
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, env=environment, check=True)
    assert done.stdout == "True\n"
    assert "beetle_ik._core" in done.stderr


def test_the_kernels_say_which_instructions_they_use() -> None:
    assert _core._instructions in {"AVX2 and FMA", "NEON", "baseline"}


@pytest.mark.parametrize(
    ("condition", "said"), [('target_pointer_width = "64"', "64-bit"), ('target_endian = "little"', "little-endian")]
)
def test_processors_that_are_not_supported_are_refused_by_name(condition: str, said: str) -> None:
    source = (ROOT / "crates" / "ikcore" / "src" / "lib.rs").read_text(encoding="utf-8")
    refusal = re.search(rf'#\[cfg\(not\({re.escape(condition)}\)\)\]\ncompile_error!\("(.*)"\);', source)
    assert refusal is not None
    assert refusal[1].startswith(f"ikcore needs a {said} processor: ")
