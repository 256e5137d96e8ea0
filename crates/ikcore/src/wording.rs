//! Numbers in messages, and names of options.

/// Implements `name`, `Display` and `FromStr` for an option with these names; the error of `FromStr` lists them.
macro_rules! words {
    ($what:literal: $option:ident { $($variant:ident => $word:literal),+ $(,)? }) => {
        impl $option {
            /// The name of this option.
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
        // Decimals for four significant digits.
        let decimals = if size == 0.0 { 0 } else { (3 - size.log10().floor() as i32).max(0) as usize };
        format!("{value:.decimals$}")
    } else {
        format!("{value:.3e}")
    }
}

/// A time (s), rounded to 1e-9 s to remove the rounding of sums of dt.
pub(crate) fn time(seconds: f64) -> f64 {
    (seconds * 1e9).round() / 1e9
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_digits_whatever_the_size() {
        let shown = [1.0864, 0.0031416, 3195.2, 0.0, 1.7e-5, 123456.0, -0.25, f64::INFINITY].map(number);
        assert_eq!(shown, ["1.086", "0.003142", "3195", "0", "1.700e-5", "1.235e5", "-0.2500", "inf"]);
    }
}
