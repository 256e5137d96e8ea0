"""Trajectories to files and back."""

import io
import zipfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

import beetle_ik as bik

TIME = np.array([0.0, 0.5, 1.25, 2.0])
JOINTS = ["shoulder", "elbow, left"]


def smooth_samples() -> list[np.ndarray]:
    """Positions, velocities and accelerations of a smooth motion at `TIME`, (3, 4, 2)."""
    phase = np.outer(TIME, [1.0, 2.0]) + 0.3
    rate = np.array([1.0, 2.0])
    return [np.sin(phase), rate * np.cos(phase), -(rate**2) * np.sin(phase)]


@pytest.mark.parametrize("derivatives", [1, 2, 3])
def test_csv_keeps_what_determines_the_pieces(tmp_path: Path, derivatives: int) -> None:
    q, *others = smooth_samples()[:derivatives]
    written = bik.Trajectory.from_samples(TIME, q, **dict(zip(("qd", "qdd"), others, strict=False)), joint_names=JOINTS)
    written.to_csv(tmp_path / "motion.csv")
    read = bik.Trajectory.from_csv(tmp_path / "motion.csv")
    assert read.joint_names == JOINTS
    np.testing.assert_array_equal(read.time, written.time)
    np.testing.assert_allclose(read.coefficients, written.coefficients, rtol=0, atol=1e-13)


def test_csv_of_even_samples_for_controllers(tmp_path: Path) -> None:
    written = bik.time_optimal([[0.0, 0.0], [1.0, 2.0], [1.5, 1.0]], bik.Limits(acceleration=5.0))
    written.to_csv(tmp_path / "motion.csv", dt=1e-3)
    read = bik.Trajectory.from_csv(tmp_path / "motion.csv")
    time, q, qd, _ = written.sample(1e-3)
    np.testing.assert_array_equal(read.time, time)
    np.testing.assert_array_equal(read.q, q)
    np.testing.assert_allclose(read.qd, qd, atol=1e-12)
    with pytest.raises(bik.InvalidInputError, match=r"^dt must be positive and finite, got 0$"):
        written.to_csv(tmp_path / "motion.csv", dt=0.0)


def test_a_missing_folder_is_named(tracked: bik.TrackResult, tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match=r"No such folder: '.*missing'$"):
        tracked.trajectory.to_csv(tmp_path / "missing" / "motion.csv")


def test_csv_names_its_columns(tmp_path: Path) -> None:
    bik.Trajectory.from_samples(TIME, smooth_samples()[0], joint_names=JOINTS).to_csv(tmp_path / "motion.csv")
    assert (tmp_path / "motion.csv").read_text().splitlines()[0] == 'time,q:shoulder,"q:elbow, left"'


def test_csv_columns_may_be_plain_joint_names(tmp_path: Path) -> None:
    file = tmp_path / "motion.csv"
    file.write_text("time,b,a,qd:a,qd:b\n0,1,2,0,0\n1,3,4,5,6\n")
    read = bik.Trajectory.from_csv(file)
    assert read.joint_names == ["b", "a"]
    np.testing.assert_array_equal(read.q, [[1.0, 2.0], [3.0, 4.0]])
    np.testing.assert_allclose(read.qd, [[0.0, 0.0], [6.0, 5.0]], atol=1e-12)


def test_plain_columns_are_ignored_next_to_prefixed_ones(tmp_path: Path) -> None:
    file = tmp_path / "motion.csv"
    file.write_text("time,q:a,temperature\n0,1,20\n1,2,21\n")
    assert bik.Trajectory.from_csv(file).joint_names == ["a"]


def test_csv_in_another_encoding_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "motion.csv"
    file.write_bytes("time,gelenk_für_arm\n0,1\n".encode("latin-1"))
    with pytest.raises(bik.InvalidInputError, match="line 1: byte 0xfc is not UTF-8; save the file as CSV"):
        bik.Trajectory.from_csv(file)


def test_npz_keeps_every_bit(tmp_path: Path, tracked: bik.TrackResult) -> None:
    tracked.trajectory.to_npz(tmp_path / "motion.npz")
    read = bik.Trajectory.from_npz(tmp_path / "motion.npz")
    assert read.joint_names == tracked.trajectory.joint_names
    np.testing.assert_array_equal(read.time, tracked.trajectory.time)
    np.testing.assert_array_equal(read.coefficients, tracked.trajectory.coefficients)


@pytest.mark.parametrize(("name", "written"), [("motion", "motion.npz"), ("motion.dat", "motion.dat")])
def test_npz_without_ending_is_found_by_its_name(
    tmp_path: Path, tracked: bik.TrackResult, name: str, written: str
) -> None:
    tracked.trajectory.to_npz(tmp_path / name)
    assert [file.name for file in tmp_path.iterdir()] == [written]
    assert bik.Trajectory.from_npz(tmp_path / name) == tracked.trajectory
    with np.load(tmp_path / written) as arrays:
        np.testing.assert_array_equal(arrays["time"], tracked.trajectory.time)


def test_an_npz_file_that_is_missing_is_named_as_given(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError) as caught:
        bik.Trajectory.from_npz(tmp_path / "motion")
    assert caught.value.filename == str(tmp_path / "motion")


def test_a_tracked_path_survives_csv(tmp_path: Path, tracked: bik.TrackResult) -> None:
    tracked.trajectory.to_csv(tmp_path / "motion.csv")
    read = bik.Trajectory.from_csv(tmp_path / "motion.csv")
    np.testing.assert_array_equal(read.q, tracked.q)


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("t,q:a\n0,1\n", ", line 1: column 'time' is missing; columns found: t, q:a"),
        (
            "time,qd:a\n0,1\n",
            ", line 1: no joint positions: expected a column for each joint, named 'q:joint' or 'joint'; "
            "columns found: time, qd:a",
        ),
        ("time,a,b,qd:a\n0,1,2,3\n", ", line 1: column 'qd:b' is missing, though 'qd:a' is there"),
        ("time,q:a,q:b,qd:a\n0,1,2,3\n", ", line 1: column 'qd:b' is missing, though 'qd:a' is there"),
    ],
)
def test_csv_without_a_trajectory_is_refused(tmp_path: Path, text: str, problem: str) -> None:
    file = tmp_path / "motion.csv"
    file.write_text(text)
    with pytest.raises(bik.InvalidInputError) as caught:
        bik.Trajectory.from_csv(file)
    assert str(caught.value) == f"{file}{problem}"


def test_npz_without_a_trajectory_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "other.npz"
    np.savez(file, time=TIME, data=TIME)
    with pytest.raises(bik.InvalidInputError) as caught:
        bik.Trajectory.from_npz(file)
    assert str(caught.value) == (f"{file}: not a trajectory: 'coefficients' is missing; the file holds: time, data")


def test_npz_with_a_single_joint_name_is_refused(tmp_path: Path, tracked: bik.TrackResult) -> None:
    file = tmp_path / "other.npz"
    np.savez(file, time=TIME, coefficients=tracked.trajectory.coefficients, joint_names="a")
    with pytest.raises(bik.InvalidInputError) as caught:
        bik.Trajectory.from_npz(file)
    assert str(caught.value) == (f"{file}: not a trajectory: 'joint_names' must be a list of text, got shape () of <U1")


@pytest.mark.parametrize("content", [b"", b"plain text", b"PK\x03\x04 but no archive", b"\x93NUMPY"])
def test_a_file_that_is_not_npz_is_refused(tmp_path: Path, content: bytes) -> None:
    file = tmp_path / "other.npz"
    file.write_bytes(content)
    with pytest.raises(bik.InvalidInputError) as caught:
        bik.Trajectory.from_npz(file)
    assert str(caught.value) == f"{file}: not an npz file"


def test_an_array_with_the_end_of_an_archive_behind_it_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "array.npz"
    end = io.BytesIO()
    zipfile.ZipFile(end, "w").close()
    with file.open("wb") as stream:
        np.save(stream, np.zeros(3))
        stream.write(end.getvalue())
    with pytest.raises(bik.InvalidInputError) as caught:
        bik.Trajectory.from_npz(file)
    assert str(caught.value) == f"{file}: damaged npz file: it holds a single array"


def test_an_array_larger_than_the_memory_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "huge.npz"
    header = io.BytesIO()
    np.lib.format.write_array_header_1_0(header, {"descr": "<f8", "fortran_order": False, "shape": (10**12,)})
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr("time.npy", header.getvalue())
    with pytest.raises(bik.InvalidInputError, match=r"huge\.npz: damaged npz file: "):
        bik.Trajectory.from_npz(file)


@pytest.mark.filterwarnings("ignore")
def test_every_damaged_npz_is_refused_or_read(tmp_path: Path) -> None:
    motion = bik.Trajectory.from_samples(TIME, np.zeros((len(TIME), 1)), joint_names=["a"])
    whole = tmp_path / "motion.npz"
    motion.to_npz(whole)
    content, file = whole.read_bytes(), tmp_path / "damaged.npz"
    refused = 0
    for place in range(0, len(content), 3):
        file.write_bytes(content[:place] + bytes([content[place] ^ 0xFF]) + content[place + 1 :])
        try:
            bik.Trajectory.from_npz(file)
        except bik.InvalidInputError:
            refused += 1
    assert refused > 0


def test_the_unfinished_file_follows_no_link(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    victim = tmp_path / "victim"
    victim.write_text("precious")
    monkeypatch.setattr("os.urandom", bytes)
    (tmp_path / f".beetle-ik-{'00' * 8}.part").symlink_to(victim)
    with pytest.raises(FileExistsError):
        bik.Trajectory.from_samples(TIME, np.zeros((len(TIME), 1))).to_npz(tmp_path / "motion.npz")
    assert victim.read_text() == "precious"


def test_threads_may_write_one_file(tmp_path: Path) -> None:
    motions = [bik.Trajectory.from_samples(TIME, np.full((len(TIME), 3), float(i))) for i in range(8)]
    file = tmp_path / "motion.npz"
    with ThreadPoolExecutor(8) as pool:
        assert len(list(pool.map(lambda motion: motion.to_npz(file), motions * 20))) == 160
    assert bik.Trajectory.from_npz(file) in motions
    assert [entry.name for entry in tmp_path.iterdir()] == ["motion.npz"]


def test_damaged_npz_is_refused(tmp_path: Path, tracked: bik.TrackResult) -> None:
    file = tmp_path / "motion.npz"
    tracked.trajectory.to_npz(file)
    content = bytearray(file.read_bytes())
    content[200] ^= 0xFF
    file.write_bytes(content)
    with pytest.raises(bik.InvalidInputError, match="damaged npz file: "):
        bik.Trajectory.from_npz(file)
