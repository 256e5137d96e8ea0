//! Dynamics of a robot: its bodies folded over fixed and held joints, and the torques of one configuration.

use std::sync::Arc;

use super::joint::Joint;
use super::masses::{InertiaFault, LinkInertia, Masses};
use super::model::Robot;
use crate::dynamics::{Dynamics, Inertia, JointDrive, MassMoments, MovingBody};
use crate::error::{Error, Result, require_finite};
use crate::math::Frame;
use crate::message::{Message, Setting, message};

impl Robot {
    /// Rigid bodies of the robot, one for each frame of its tree.
    ///
    /// # Errors
    /// [`Error::NoDynamics`] if a link has an impossible inertia, if no link has a mass, or if a joint moves none.
    pub fn dynamics(&self) -> Result<&Dynamics> {
        let found = self.found_dynamics().get_or_init(|| Arc::new(self.folded_dynamics()));
        (**found).as_ref().map_err(Clone::clone)
    }

    /// Inertias of the links that have one, without payloads.
    pub fn inertias(&self) -> &[LinkInertia] {
        &self.parts().masses.links
    }

    /// Payloads, each in the frame of the link that carries it.
    pub fn payloads(&self) -> &[LinkInertia] {
        &self.parts().masses.payloads
    }

    /// Acceleration of free fall in the frame of the robot's base (m/s^2).
    pub fn gravity(&self) -> [f64; 3] {
        self.parts().masses.gravity
    }

    /// Copy of the robot with these inertias of links; those of other links stay.
    ///
    /// # Errors
    /// [`Error::UnknownLink`]; [`Error::ImpossibleInertia`].
    pub fn with_inertias<'a>(&self, inertias: impl IntoIterator<Item = (&'a str, Inertia)>) -> Result<Self> {
        let mut masses = (*self.parts().masses).clone();
        for (link, inertia) in inertias {
            self.link_number(link)?;
            inertia.require_possible(&format!("inertia of link '{link}'"))?;
            masses.faults.retain(|fault| fault.owner != link);
            put(&mut masses.links, link, inertia);
        }
        Ok(self.with_masses(masses))
    }

    /// Copy of the robot that carries a payload, in place of one that the same link carries already; a mass of zero takes it
    /// off. The inertia is in the frame of `link`; without a link, in the frame of the tip, tool included.
    ///
    /// # Errors
    /// [`Error::UnknownLink`]; [`Error::ImpossibleInertia`]; [`Error::SeveralTips`] without a link.
    pub fn with_payload(&self, link: Option<&str>, inertia: Inertia) -> Result<Self> {
        inertia.require_possible("payload")?;
        let (link, inertia) = match link {
            Some(link) => (link, inertia),
            None => {
                self.require_tip_of_payload()?;
                let tip = self.link_names().last().unwrap_or_default();
                (tip, MassMoments::of(&inertia).moved(&Frame::from(self.tool())).inertia())
            }
        };
        self.link_number(link)?;
        let mut masses = (*self.parts().masses).clone();
        masses.payloads.retain(|payload| payload.link != link);
        if inertia.mass > 0.0 {
            masses.payloads.push(LinkInertia { link: link.into(), inertia });
        }
        Ok(self.with_masses(masses))
    }

    /// Checks that there is one tip that can carry a payload.
    fn require_tip_of_payload(&self) -> Result<()> {
        let remedy = message!["give the one that carries the payload as ", Setting::CarryingLink];
        match self.require_one_tip("with_payload") {
            Err(Error::SeveralTips { call, tips, .. }) => Err(Error::SeveralTips { call, tips, remedy }),
            other => other,
        }
    }

    /// Copy of the robot under this acceleration of free fall, in the frame of the robot's base (m/s^2).
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn with_gravity(&self, gravity: [f64; 3]) -> Result<Self> {
        require_finite("gravity", &gravity, |i| format!("entry {i}"))?;
        Ok(self.with_masses(Masses { gravity, ..(*self.parts().masses).clone() }))
    }

    /// Copy of the robot with masses, payloads and gravity of another with the same links.
    pub(crate) fn with_masses_of(&self, other: &Self) -> Self {
        self.with_masses((*other.parts().masses).clone())
    }

    /// Checks that this robot is `other` but for masses, payloads and gravity.
    ///
    /// # Errors
    /// [`Error::Contradiction`] names both.
    pub(crate) fn require_masses_alone_differ(&self, other: &Self) -> Result<()> {
        if self.with_masses_of(other) == *other {
            return Ok(());
        }
        let problem = format!(
            "robot '{}' differs from robot '{}' in more than masses, payloads and gravity, which alone may change while it is \
             tracked: begin anew with the other robot",
            self.name(),
            other.name()
        );
        Err(Error::Contradiction { problem: problem.into() })
    }

    fn folded_dynamics(&self) -> Result<Dynamics> {
        let none = |problem: Message| Error::NoDynamics { robot: self.name().into(), problem };
        let masses = &self.parts().masses;
        let numbers = self.link_numbers();
        let elements: Vec<_> = self.moving_elements().collect();
        let mut moments = vec![MassMoments::NONE; elements.len() + 1];
        for InertiaFault { owner, problem, point } in &masses.faults {
            let number = numbers.get(owner.as_str());
            let stands_still = number.is_some_and(|number| self.carrier_of_link_number(*number).0 == 0);
            match point {
                Some(point) if stands_still => {
                    let (_, offset) = self.carrier_of_link(owner).unwrap_or((0, Frame::IDENTITY));
                    moments[0].add(&MassMoments::of(point).moved(&offset));
                }
                _ => return Err(none(problem.as_str().into())),
            }
        }
        let mut add = |LinkInertia { link, inertia }: &LinkInertia| {
            let (frame, offset) = self.carrier_of_link_number(numbers[link.as_str()]);
            moments[frame].add(&MassMoments::of(inertia).moved(&offset));
        };
        masses.links.iter().for_each(&mut add);
        masses.payloads.iter().for_each(&mut add);
        // The masses that an arm carries say nothing of its own.
        let has_mass = |of: &[LinkInertia]| of.iter().any(|link| link.inertia.mass > 0.0);
        if !has_mass(&masses.links) && masses.faults.is_empty() {
            return Err(none(message!["no link has a mass: give ", Setting::Inertias]));
        }
        let bodies = elements.iter().zip(&moments[1..]).map(|((parent, _, motion), moments)| MovingBody {
            parent: *parent,
            motion: *motion,
            moments: *moments,
        });
        let bodies: Vec<MovingBody> = bodies.collect();
        let drive =
            |joint: &Joint| JointDrive { damping: joint.damping, friction: joint.friction, armature: joint.armature };
        let drives: Vec<JointDrive> = self.joints().iter().map(drive).collect();
        let dynamics =
            Dynamics::new(moments[0], bodies, masses.gravity, drives, (self.chain().vector.clone(), self.curves()));
        match dynamics.joint_without_mass() {
            None => Ok(dynamics),
            Some(joint) => {
                let name = &self.joints()[joint].name;
                Err(none(message![format!("joint '{name}' moves no mass: give "), Setting::Inertias]))
            }
        }
    }
}

/// Replaces the inertia of a link, or adds it.
fn put(inertias: &mut Vec<LinkInertia>, link: &str, inertia: Inertia) {
    match inertias.iter_mut().find(|known| known.link == link) {
        Some(known) => known.inertia = inertia,
        None => inertias.push(LinkInertia { link: link.into(), inertia }),
    }
}
