//! Joint values by name, as messages and tables carry them.

use super::model::Robot;
use crate::error::{Error, Result, shortened, suggestion};
use crate::message::{Setting, message};
use crate::wording::{joined, listed};

impl Robot {
    /// Returns the configurations (m, n) of `values` (m, k), whose columns have these joint `names`: row-major, in the order of q (rad,
    /// m). With `degrees`, values of joints that turn are in degrees.
    ///
    /// # Errors
    /// As [`order_of`](Self::order_of); [`Error::WrongLength`], [`Error::NotFinite`].
    pub fn q_from(&self, names: &[String], values: &[f64], degrees: bool, ignore_extra: bool) -> Result<Vec<f64>> {
        let order = self.order_of(names, ignore_extra)?;
        if names.is_empty() || !values.len().is_multiple_of(names.len()) {
            let expected = format!("{} numbers, one per name", names.len());
            return Err(Error::WrongLength { what: "values".into(), expected, got: values.len() });
        }
        let mut qs = Vec::with_capacity(values.len() / names.len() * self.dof());
        for row in values.chunks_exact(names.len()) {
            let joint = |(joint, place): (&super::Joint, &usize)| {
                let value = row[*place];
                if degrees && joint.kind.turns() { value.to_radians() } else { value }
            };
            let begin = qs.len();
            qs.extend(self.joints().iter().zip(&order).map(joint));
            self.check("values", &qs[begin..])?;
        }
        Ok(qs)
    }

    /// Returns for each joint of q its index in `names`.
    ///
    /// # Errors
    /// [`Error::UnknownJoint`] for a name of no joint of q, unless extra ones are ignored; [`Error::Contradiction`] for a joint that is
    /// missing or there twice.
    pub fn order_of(&self, names: &[String], ignore_extra: bool) -> Result<Vec<usize>> {
        let joints = || self.joints().iter().map(|joint| joint.name.as_str());
        if !ignore_extra && let Some(unknown) = names.iter().find(|name| !joints().any(|joint| joint == *name)) {
            return Err(self.unknown_joint(unknown));
        }
        let mut order = vec![];
        let mut missing = vec![];
        for joint in joints() {
            let mut places = (0..names.len()).filter(|place| names[*place] == joint);
            match (places.next(), places.next()) {
                (Some(place), None) => order.push(place),
                (Some(_), Some(_)) => {
                    return Err(Error::Contradiction {
                        problem: format!("names: joint '{joint}' is there twice").into(),
                    });
                }
                (None, _) => missing.push(joint),
            }
        }
        match &missing[..] {
            [] => Ok(order),
            [first, ..] => {
                let others = names.iter().map(String::as_str).filter(|name| !joints().any(|joint| joint == *name));
                let near = suggestion(first, others);
                let (quoted, given) = (quoted(&missing), listed(names.iter().map(String::as_str)));
                let plural = if missing.len() == 1 { "" } else { "s" };
                let problem =
                    format!("names: joint{plural} {quoted} of robot '{}' missing{near}; given: {given}", self.name());
                Err(Error::Contradiction { problem: problem.into() })
            }
        }
    }

    fn unknown_joint(&self, name: &str) -> Error {
        let held = self.held_joints().iter().any(|held| held.joint.name == name);
        let joints = || self.joints().iter().map(|joint| joint.name.as_str());
        let problem = if held { " (it is held, beside the chain)".into() } else { suggestion(name, joints()) };
        let remedy = message![Setting::IgnoreExtra, " leaves out values of other joints"];
        Error::UnknownJoint {
            robot: self.name().into(),
            name: shortened(name),
            problem,
            joints: listed(joints()),
            remedy,
        }
    }
}

fn quoted(names: &[&str]) -> String {
    let quoted: Vec<String> = names.iter().map(|name| format!("'{name}'")).collect();
    joined(quoted.iter().map(String::as_str))
}
