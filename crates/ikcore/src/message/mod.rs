//! Messages for people: the outcome of a call, and advice.
//!
//! The core speaks of robots. Options that a sentence names are [`Setting`]s in it, with plain words, so that each interface puts its
//! own spelling in their place.

mod setting;

use std::fmt;
use std::ops::Deref;

pub use setting::Setting;

/// Returns a name after its indefinite article: a Box, an Ellipsoid.
pub(crate) fn with_article(name: &str) -> String {
    let vowel = name.starts_with(|first: char| "aeioAEIO".contains(first));
    format!("{} {name}", if vowel { "an" } else { "a" })
}

/// Sentence, or a part of one. Its text has the plain words of its settings.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Message(Box<Content>);

/// Text, and the settings in it, each with the byte at which its plain words begin. In a box, which keeps errors small.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
struct Content {
    plain: String,
    settings: Vec<(usize, Setting)>,
}

impl Message {
    /// Returns the sentence with these words in place of the plain ones of each setting.
    pub fn worded(&self, words: impl Fn(&Setting) -> String) -> String {
        let Content { plain, settings } = &*self.0;
        let (mut text, mut done) = (String::new(), 0);
        for (begin, setting) in settings {
            text += &plain[done..*begin];
            text += &words(setting);
            done = begin + setting.to_string().len();
        }
        text + &plain[done..]
    }

    /// Returns the sentence in plain words.
    pub fn as_str(&self) -> &str {
        &self.0.plain
    }

    /// Appends a part.
    pub(crate) fn push(&mut self, part: impl Into<Self>) {
        let part = *part.into().0;
        let begin = self.0.plain.len();
        self.0.plain += &part.plain;
        self.0.settings.extend(part.settings.into_iter().map(|(at, setting)| (begin + at, setting)));
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
        &self.0.plain
    }
}

impl fmt::Display for Message {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self)
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
        Self(Box::new(Content { plain, settings: vec![] }))
    }
}

impl From<Setting> for Message {
    fn from(named: Setting) -> Self {
        Self(Box::new(Content { plain: named.to_string(), settings: vec![(0, named)] }))
    }
}

impl PartialEq<str> for Message {
    fn eq(&self, text: &str) -> bool {
        self.0.plain == text
    }
}

impl PartialEq<&str> for Message {
    fn eq(&self, text: &&str) -> bool {
        self.0.plain == *text
    }
}

impl PartialEq<String> for Message {
    fn eq(&self, text: &String) -> bool {
        self.0.plain == *text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn articles_follow_the_first_letter() {
        let written = ["Box", "Ellipsoid", "octree", "union", ""].map(with_article);
        assert_eq!(written, ["a Box", "an Ellipsoid", "an octree", "a union", "a "]);
    }

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
