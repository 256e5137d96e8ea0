//! Wording of messages: numbers, lists and names of options.

/// Implements `name`, `Display` and `FromStr` for an option with these names; the error of `FromStr` lists them.
macro_rules! words {
    ($what:literal: $option:ident { $($variant:ident => $word:literal),+ $(,)? }) => {
        impl $option {
            /// Returns the name of this option.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $word,)+
                }
            }
        }

        impl std::fmt::Display for $option {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str(self.name())
            }
        }

        impl std::str::FromStr for $option {
            type Err = $crate::Error;

            fn from_str(name: &str) -> $crate::Result<Self> {
                match name {
                    $($word => Ok(Self::$variant),)+
                    _ => Err($crate::Error::unknown_option($what, name, &[$($word),+])),
                }
            }
        }
    };
}

pub(crate) use words;

/// Formats four significant digits, with an exponent only where it improves readability.
pub(crate) fn number(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 || (1e-3..1e4).contains(&size) {
        // Number of decimals for four significant digits.
        let decimals = if size == 0.0 { 0 } else { (3 - size.log10().floor() as i32).max(0) as usize };
        format!("{value:.decimals$}")
    } else {
        format!("{value:.3e}")
    }
}

/// Joins names as in a sentence: "a, b and c".
pub(crate) fn joined<'a>(names: impl Iterator<Item = &'a str>) -> String {
    let names: Vec<&str> = names.collect();
    match names.split_last() {
        None => String::new(),
        Some((last, [])) => (*last).into(),
        Some((last, others)) => format!("{} and {last}", others.join(", ")),
    }
}

/// Length of a list of names in a message: long enough for a known robot, short enough to read (characters).
const LIST_LENGTH: usize = 400;

/// Joins names with commas, up to a readable length; then appends the number of remaining names.
pub(crate) fn listed<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    let mut names = names.into_iter();
    let mut list = names.next().unwrap_or_default().to_owned();
    while let Some(name) = names.next() {
        if list.len() + name.len() > LIST_LENGTH {
            return format!("{list} and {} more", 1 + names.count());
        }
        list += ", ";
        list += name;
    }
    list
}

/// Names joints, as the subject of a sentence.
pub(crate) fn named_joints(joints: &[&str]) -> String {
    let quoted: Vec<String> = joints.iter().map(|joint| format!("'{joint}'")).collect();
    let many = if joints.len() == 1 { "joint" } else { "joints" };
    format!("{many} {}", listed(quoted.iter().map(String::as_str)))
}

/// Rounds a time (s) to 1e-9 s, which removes the rounding of sums of dt.
pub(crate) fn time(seconds: f64) -> f64 {
    (seconds * 1e9).round() / 1e9
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_list_ends_in_a_count() {
        let names: Vec<String> = (0..100_000).map(|i| format!("link_{i:06}")).collect();
        assert_eq!(listed([]), "");
        assert_eq!(listed(names[..3].iter().map(String::as_str)), "link_000000, link_000001, link_000002");
        let list = listed(names.iter().map(String::as_str));
        assert!(list.ends_with("link_000030 and 99969 more"), "{list}");
    }

    #[test]
    fn four_digits_whatever_the_size() {
        let shown = [1.0864, 0.0031416, 3195.2, 0.0, 1.7e-5, 123456.0, -0.25, f64::INFINITY].map(number);
        assert_eq!(shown, ["1.086", "0.003142", "3195", "0", "1.700e-5", "1.235e5", "-0.2500", "inf"]);
    }
}
