//! Damaged files of `tests/corpus`, which are read or rejected without panics: valid ones changed in a few places.

use std::path::{Path, PathBuf};

use ikcore::load::parse_mesh;
use ikcore::robot::Robot;
use proptest::prelude::*;
use proptest::sample::Index;

use crate::common::drawn;

const NUMBERS: [&str; 16] = [
    "0",
    "-0.0",
    "1e308",
    "-1.7976931348623157e308",
    "5e-324",
    "1e400",
    "nan",
    "inf",
    "-1",
    "4294967296",
    "1e16",
    "",
    "0x10",
    "1,5",
    "--1",
    "99999999999999999999999999999999",
];

/// Change of a file. Positions are relative to its length.
#[derive(Debug, Clone)]
enum Damage {
    /// Replacement of the number at or after a position.
    Number(Index, usize),
    Cut(Index),
    Drop(Index, usize),
    Repeat(Index, usize, usize),
    Overwrite(Index, Vec<u8>),
    Move(Index, usize, Index),
}

fn damage() -> impl Strategy<Value = Vec<Damage>> {
    let length = 0..60_usize;
    let one = prop_oneof![
        6 => (any::<Index>(), 0..NUMBERS.len()).prop_map(|(place, number)| Damage::Number(place, number)),
        1 => any::<Index>().prop_map(Damage::Cut),
        2 => (any::<Index>(), length.clone()).prop_map(|(place, length)| Damage::Drop(place, length)),
        2 => (any::<Index>(), length.clone(), 1..40_usize).prop_map(|(place, length, times)| Damage::Repeat(place, length, times)),
        2 => (any::<Index>(), prop::collection::vec(any::<u8>(), 1..5)).prop_map(|(place, bytes)| Damage::Overwrite(place, bytes)),
        2 => (any::<Index>(), length, any::<Index>()).prop_map(|(place, length, to)| Damage::Move(place, length, to)),
    ];
    prop::collection::vec(one, 1..6)
}

fn damaged(mut file: Vec<u8>, changes: &[Damage]) -> Vec<u8> {
    for change in changes {
        let size = file.len() + 1;
        let end = |start: usize, length: usize| (start + length).min(size - 1);
        match change {
            Damage::Number(place, number) => replace_number(&mut file, place.index(size), NUMBERS[*number]),
            Damage::Cut(place) => file.truncate(place.index(size)),
            Damage::Drop(place, length) => drop(file.drain(place.index(size)..end(place.index(size), *length))),
            Damage::Repeat(place, length, times) => {
                let range = place.index(size)..end(place.index(size), *length);
                let piece = file[range.clone()].repeat(*times);
                file.splice(range.end..range.end, piece);
            }
            Damage::Overwrite(place, bytes) => {
                let range = place.index(size)..end(place.index(size), bytes.len());
                file.splice(range, bytes.iter().copied());
            }
            Damage::Move(place, length, to) => {
                let piece: Vec<u8> = file.drain(place.index(size)..end(place.index(size), *length)).collect();
                let to = to.index(file.len() + 1);
                file.splice(to..to, piece);
            }
        }
    }
    file
}

/// Replaces the first number that begins at `from` or later.
fn replace_number(file: &mut Vec<u8>, from: usize, number: &str) {
    let digit = |byte: &u8| byte.is_ascii_digit() || *byte == b'-' || *byte == b'.';
    let Some(start) = (from..file.len()).find(|i| file[*i].is_ascii_digit()) else { return };
    let end = start + file[start..].iter().take_while(|byte| digit(byte)).count();
    file.splice(start..end, number.bytes());
}

fn corpus(file: &str) -> Vec<u8> {
    let path: PathBuf = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/corpus").join(file);
    std::fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn text(file: &str, changes: &[Damage]) -> String {
    String::from_utf8_lossy(&damaged(corpus(file), changes)).into_owned()
}

/// Uses a robot that was read.
fn use_of(robot: &Robot) {
    let q: Vec<f64> = robot.joints().iter().map(|joint| 0.0_f64.clamp(joint.lower, joint.upper)).collect();
    let pose = robot.fk(&q).unwrap();
    assert!(pose.to_homogeneous().iter().all(|entry| !entry.is_nan()), "{pose}");
    let bytes = robot.to_bytes().unwrap();
    assert!(Robot::from_bytes(&bytes).unwrap() == *robot);
}

proptest! {
    #![proptest_config(drawn(400))]

    #[test]
    fn damaged_urdfs_are_read_or_refused(changes in damage(), pair in any::<bool>()) {
        let file = if pair { "urdf/pair.urdf" } else { "urdf/arm.urdf" };
        match Robot::from_urdf(&text(file, &changes), None, Some(if pair { "b" } else { "tool" })) {
            Ok(robot) => use_of(&robot),
            Err(error) => prop_assert!(!error.to_string().is_empty()),
        }
    }

    #[test]
    fn damaged_srdfs_are_read_or_refused(changes in damage()) {
        let robot = Robot::from_urdf(&text("urdf/arm.urdf", &[]), None, Some("tool")).unwrap();
        match robot.with_srdf(&text("srdf/arm.srdf", &changes)) {
            Ok(robot) => use_of(&robot),
            Err(error) => prop_assert!(!error.to_string().is_empty()),
        }
    }

    #[test]
    fn damaged_meshes_are_read_or_refused(changes in damage(), which in 0..4_usize, scale in prop_oneof![Just(1.0), Just(-2.0), Just(1e-3)]) {
        let file = ["tetrahedron.stl", "binary.stl", "tetrahedron.obj", "tetrahedron.dae"][which];
        match parse_mesh(file, &damaged(corpus(&format!("mesh/{file}")), &changes), [scale; 3]) {
            Ok(shape) => prop_assert!(shape.bounding_ball().radius >= 0.0),
            Err(error) => prop_assert!(error.to_string().starts_with(&format!("cannot read '{file}': ")), "{error}"),
        }
    }

    #[test]
    fn stored_robots_with_changed_bytes_are_refused_or_used(changes in damage()) {
        let whole = corpus("stored/robot.bin");
        let payload = damaged(whole[9..].to_vec(), &changes);
        let bytes: Vec<u8> = whole[..1].iter().copied().chain(checksum(&payload).to_le_bytes()).chain(payload).collect();
        match Robot::from_bytes(&bytes) {
            Ok(robot) => drop(robot.fk(&vec![0.0; robot.dof()])),
            Err(error) => prop_assert!(!error.to_string().is_empty()),
        }
    }
}

/// Checksum of stored bytes: FNV-1a with 64 bits.
fn checksum(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash: u64, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3))
}
