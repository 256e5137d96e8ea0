//! Drawn tests repeat: cargo gives them their seed.

use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;

#[test]
fn drawn_cases_are_the_same_in_every_run() {
    let draw = || -> Vec<u64> {
        let mut runner = TestRunner::new(ProptestConfig::default());
        (0..9).map(|_| any::<u64>().new_tree(&mut runner).unwrap().current()).collect()
    };
    assert_eq!(draw(), draw(), "cargo sets PROPTEST_RNG_SEED as .cargo/config.toml says");
}
