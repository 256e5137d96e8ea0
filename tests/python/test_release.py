"""Checks before a release: the wheel, the source distribution, licences of the linked crates."""

import shutil
import subprocess
import sys
import tarfile
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from types import ModuleType
from zipfile import ZipFile

import pytest

ROOT = Path(__file__).parents[2]
LICENCES = ["LICENSE-MIT", "LICENSE-APACHE", "LICENSES-THIRD-PARTY.txt"]
IN_WHEEL = ["beetle_ik/py.typed", "beetle_ik/_core.pyi", "beetle_ik/_core.abi3.so"]
IN_SOURCES = ["Cargo.lock", "README.md", "docs/index.md", "tests/python/test_solve.py", *LICENCES]


@pytest.fixture(scope="module")
def tool() -> ModuleType:
    spec = spec_from_file_location("check_wheel", ROOT / "tools" / "check_wheel.py")
    assert spec is not None
    assert spec.loader is not None
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def built(folder: Path, tag: str, *, without: str = "", needs: str = "numpy>=1.26") -> None:
    """Writes a wheel and a source distribution with empty files."""
    info = "beetle_ik-0.2.0.dist-info"
    names = [*IN_WHEEL, *(f"{info}/licenses/{name}" for name in LICENCES)]
    with ZipFile(folder / f"beetle_ik-0.2.0-cp311-abi3-{tag}.whl", "w") as wheel:
        for name in names:
            if name != without:
                wheel.writestr(name, "")
        extra = 'Requires-Dist: typer>=0.15 ; extra == "cli"'
        wheel.writestr(f"{info}/METADATA", f"Metadata-Version: 2.4\nRequires-Dist: {needs}\n{extra}\n\nText\n")
    with tarfile.open(folder / "beetle_ik-0.2.0.tar.gz", "w:gz") as sources:
        for name in IN_SOURCES:
            if name != without:
                sources.addfile(tarfile.TarInfo(f"beetle_ik-0.2.0/{name}"))


@pytest.mark.parametrize("tag", ["manylinux_2_17_x86_64", "manylinux_2_28_x86_64", "win_amd64", "musllinux_1_2_x86_64"])
def test_a_wheel_in_order_can_be_published(tool: ModuleType, tag: str, tmp_path: Path) -> None:
    built(tmp_path, tag)
    assert tool.problems(tmp_path) == []


def test_a_wheel_for_too_new_a_system_is_refused(tool: ModuleType, tmp_path: Path) -> None:
    built(tmp_path, "manylinux_2_35_x86_64")
    name = "beetle_ik-0.2.0-cp311-abi3-manylinux_2_35_x86_64.whl"
    assert tool.problems(tmp_path) == [f"{name} needs glibc 2.35; stability.md promises 2.28."]


def test_what_is_missing_is_named(tool: ModuleType, tmp_path: Path) -> None:
    built(tmp_path, "win_amd64", without="Cargo.lock", needs="rich>=13")
    wheel = "beetle_ik-0.2.0-cp311-abi3-win_amd64.whl"
    assert tool.problems(tmp_path) == [
        "beetle_ik-0.2.0.tar.gz has no Cargo.lock.",
        f"{wheel} needs rich>=13, but should need numpy alone.",
    ]
    built(tmp_path, "win_amd64", without="beetle_ik/_core.abi3.so")
    assert tool.problems(tmp_path) == [f"{wheel} has no compiled module."]
    licence = "beetle_ik-0.2.0.dist-info/licenses/LICENSES-THIRD-PARTY.txt"
    built(tmp_path, "win_amd64", without=licence)
    assert tool.problems(tmp_path) == [f"{wheel} has no {licence}."]
    (tmp_path / wheel).unlink()
    assert tool.problems(tmp_path) == [f"{tmp_path} must have one wheel and one source distribution."]


@pytest.mark.skipif(shutil.which("cargo") is None, reason="cargo is not installed")
def test_licences_of_what_is_built_in_are_up_to_date() -> None:
    command = [sys.executable, str(ROOT / "tools" / "third_party.py"), "--check"]
    done = subprocess.run(command, check=False, capture_output=True, text=True)
    if "error: " in done.stderr:
        pytest.skip("cargo has no sources of the crates here")
    assert (done.returncode, done.stderr) == (0, "")
