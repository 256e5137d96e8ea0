//! Mesh files of any bytes are read or refused.
#![no_main]

use ikcore::load::parse_mesh;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    for name in ["a.stl", "a.obj", "a.dae"] {
        if let Ok(shape) = parse_mesh(name, bytes, [1.0; 3]) {
            assert!(shape.bounding_ball().radius >= 0.0);
        }
    }
});
