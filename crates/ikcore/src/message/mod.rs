//! Messages for people: the outcome of a call, and advice.
//!
//! The core speaks of robots. Options that a sentence names are [`Setting`]s in it, with plain words, so that each interface puts its
//! own spelling in their place.

mod setting;

use std::fmt;
use std::ops::Deref;

pub use setting::Setting;

/// Sentence, or a part of one. Its text has the plain words of its settings.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Message {
    plain: String,
    /// Settings in it, each with the byte at which its plain words begin.
    settings: Vec<(usize, Setting)>,
}

impl Message {
    /// Returns the sentence with these words in place of the plain ones of each setting.
    pub fn worded(&self, words: impl Fn(&Setting) -> String) -> String {
        let (mut text, mut done) = (String::new(), 0);
        for (begin, setting) in &self.settings {
            text += &self.plain[done..*begin];
            text += &words(setting);
            done = begin + setting.to_string().len();
        }
        text + &self.plain[done..]
    }

    /// Returns the sentence in plain words.
    pub fn as_str(&self) -> &str {
        &self.plain
    }

    /// Appends a part.
    pub(crate) fn push(&mut self, part: impl Into<Self>) {
        let part = part.into();
        let begin = self.plain.len();
        self.plain += &part.plain;
        self.settings.extend(part.settings.into_iter().map(|(at, setting)| (begin + at, setting)));
    }

    /// Joins parts by a separator.
    pub(crate) fn joined(parts: impl IntoIterator<Item = Self>, separator: &str) -> Self {
        let mut whole = Self::default();
        for (i, part) in parts.into_iter().enumerate() {
            whole.push(if i == 0 { "" } else { separator });
            whole.push(part);
        }
        whole
    }
}

/// Joins parts, each a text, a [`Setting`] or a [`Message`].
macro_rules! message {
    ($($part:expr),+ $(,)?) => {{
        let mut message = $crate::message::Message::default();
        $(message.push($part);)+
        message
    }};
}

pub(crate) use message;

impl Deref for Message {
    type Target = str;

    fn deref(&self) -> &str {
        &self.plain
    }
}

impl fmt::Display for Message {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&self.plain)
    }
}

impl From<&str> for Message {
    fn from(text: &str) -> Self {
        Self::from(text.to_owned())
    }
}

impl From<&Self> for Message {
    fn from(message: &Self) -> Self {
        message.clone()
    }
}

impl From<&String> for Message {
    fn from(text: &String) -> Self {
        Self::from(text.clone())
    }
}

impl From<String> for Message {
    fn from(plain: String) -> Self {
        Self { plain, settings: vec![] }
    }
}

impl From<Setting> for Message {
    fn from(named: Setting) -> Self {
        Self { plain: named.to_string(), settings: vec![(0, named)] }
    }
}

impl PartialEq<str> for Message {
    fn eq(&self, text: &str) -> bool {
        self.plain == text
    }
}

impl PartialEq<&str> for Message {
    fn eq(&self, text: &&str) -> bool {
        self.plain == *text
    }
}

impl PartialEq<String> for Message {
    fn eq(&self, text: &String) -> bool {
        self.plain == *text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_interface_spells_the_settings_in_its_own_words() {
        let give = message!["give ", Setting::Limit("jerk"), " or "];
        let whole = message![give, Setting::Ease, format!(" at {} s", 1)];
        assert_eq!(whole, "give a jerk limit or an eased start at 1 s");
        let worded =
            whole.worded(|setting| if *setting == Setting::Ease { "ease=True".into() } else { setting.to_string() });
        assert_eq!(worded, "give a jerk limit or ease=True at 1 s");
        assert_eq!(
            Message::joined([worded.into(), Setting::Ease.into()], "; ").worded(|_| "-".into()).matches("; -").count(),
            1
        );
    }
}
