//! Stored robots of any bytes, with the checksum that belongs to them, are refused or have poses.
#![no_main]

use ikcore::robot::Robot;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|payload: &[u8]| {
    // FNV-1a with 64 bits.
    let hash = |hash: u64, byte: &u8| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
    let checksum = payload.iter().fold(0xcbf2_9ce4_8422_2325, hash);
    let bytes = [&[3], &checksum.to_le_bytes()[..], payload].concat();
    if let Ok(robot) = Robot::from_bytes(&bytes) {
        let _ = robot.fk(&vec![0.0; robot.dof()]);
    }
});
