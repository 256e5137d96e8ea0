//! Serialization of values to bytes, for storage and for copying between processes: a version, a checksum, then the value.
//! The checksum detects damaged bytes.

use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::error::{Error, Result};

/// Format version, raised with each change of a stored type. Releases 0.1 wrote 1; 0.2 and later write this one.
const FORMAT: u8 = 3;

/// Returns `value` as bytes; `what` names it in errors.
///
/// # Errors
/// [`Error::Corrupt`] if the encoder fails.
pub fn to_bytes<T: Serialize>(what: &str, value: &T) -> Result<Vec<u8>> {
    let payload = postcard::to_allocvec(value).map_err(|problem| corrupt(what, problem.to_string()))?;
    let mut bytes = vec![FORMAT];
    bytes.extend(checksum(&payload).to_le_bytes());
    bytes.extend(payload);
    Ok(bytes)
}

/// Returns the value stored by [`to_bytes`], bit-identical; `what` names it in errors.
///
/// # Errors
/// [`Error::Corrupt`] for bytes of another version, of another type, or damaged.
pub fn from_bytes<T: DeserializeOwned>(what: &str, bytes: &[u8]) -> Result<T> {
    let (format, rest) = bytes.split_first().ok_or_else(|| corrupt(what, "no bytes".into()))?;
    if *format != FORMAT {
        let writer = if *format < FORMAT { "an earlier" } else { "a later" };
        let problem = format!(
            "it was stored in format {format} by {writer} version of beetle-ik, and this one reads format {FORMAT}: make it anew"
        );
        return Err(corrupt(what, problem));
    }
    match rest.split_first_chunk() {
        Some((stored, payload)) if u64::from_le_bytes(*stored) == checksum(payload) => {
            postcard::from_bytes(payload).map_err(|problem| corrupt(what, reason(problem)))
        }
        _ => Err(corrupt(what, "the bytes were damaged: their checksum differs".into())),
    }
}

/// Returns the reason why the payload is unreadable. The decoder drops the message of a type that rejects its own values.
fn reason(problem: postcard::Error) -> String {
    match problem {
        postcard::Error::SerdeDeCustom => "its values contradict each other".into(),
        problem => problem.to_string(),
    }
}

fn corrupt(what: &str, problem: String) -> Error {
    Error::Corrupt { what: what.into(), problem }
}

/// Computes the 64-bit FNV-1a hash (Fowler, Noll and Vo): detects accidents, not manipulation.
fn checksum(bytes: &[u8]) -> u64 {
    const OFFSET: u64 = 0xcbf2_9ce4_8422_2325;
    const PRIME: u64 = 0x0000_0100_0000_01b3;
    bytes.iter().fold(OFFSET, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(PRIME))
}
