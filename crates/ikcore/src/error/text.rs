//! Numbers, texts and names of a caller as messages quote them.

/// Length up to which a message repeats a text (characters).
const ECHO_LENGTH: usize = 200;

/// Writes a number as it was given; a huge one with an exponent, not with hundreds of zeros.
pub(crate) fn given(value: f64) -> String {
    const HUGE: f64 = 1e21;
    if value.is_finite() && value.abs() >= HUGE { format!("{value:e}") } else { value.to_string() }
}

/// Cuts a given text to a readable length for a message.
pub(crate) fn shortened(text: &str) -> String {
    match text.char_indices().nth(ECHO_LENGTH) {
        None => text.into(),
        Some((end, _)) => format!("{}...", &text[..end]),
    }
}

/// Returns ` (did you mean 'x'?)` for the candidate nearest to `name`, or an empty text if none is near.
pub(crate) fn suggestion<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> String {
    let wanted = name.to_lowercase();
    candidates
        .into_iter()
        .map(|candidate| (strsim::jaro_winkler(&wanted, &candidate.to_lowercase()), candidate))
        .filter(|(similarity, _)| *similarity > 0.75)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, candidate)| format!(" (did you mean '{candidate}'?)"))
        .unwrap_or_default()
}
