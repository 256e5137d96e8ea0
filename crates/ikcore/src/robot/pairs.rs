//! Pairs of links that are tested against each other.

use super::model::Robot;
use super::pair_rule::PairRule;
use super::pair_sampling;
use super::stance::Stance;
use crate::error::{Error, Result};

impl Robot {
    /// Pairs of links that are tested against each other, in the order of the links.
    ///
    /// Links that are fixed to each other never are. Without an SRDF and without
    /// [`with_collision_pairs`](Self::with_collision_pairs) neither are neighbours in the tree of links with bodies, links that
    /// touch with all joints in the middle of their ranges or in nearly all of 1,000 random configurations, and links that
    /// come nowhere near each other in 10,000. The same robot gets the same pairs. Found at the first call.
    pub fn collision_pairs(&self) -> Vec<[&str; 2]> {
        let names: Vec<&str> = self.all_link_names().collect();
        self.tested_links().iter().map(|pair| pair.map(|link| names[link])).collect()
    }

    /// Copy of the robot with these pairs of links tested against each other, and no others.
    ///
    /// # Errors
    /// [`Error::UnknownLink`], [`Error::Contradiction`] for a pair of a link with itself.
    pub fn with_collision_pairs(&self, pairs: Vec<[String; 2]>) -> Result<Self> {
        for [one, other] in &pairs {
            self.link_number(one)?;
            self.link_number(other)?;
            if one == other {
                return Err(Error::Contradiction {
                    problem: format!("link '{one}' cannot be tested against itself").into(),
                });
            }
        }
        Ok(self.with_pair_rule(PairRule::Given(pairs)))
    }

    /// Copy of the robot with all pairs of links tested against each other but these, and those that always touch.
    pub(crate) fn with_disabled_pairs(&self, pairs: Vec<[String; 2]>) -> Self {
        self.with_pair_rule(PairRule::AllBut(pairs))
    }

    /// Named configurations, from an SRDF.
    pub fn stances(&self) -> &[Stance] {
        &self.parts().stances
    }

    /// Pairs of bodies, as indices into [`bodies`](Self::bodies), that are tested against each other.
    pub(crate) fn tested_bodies(&self) -> Vec<[usize; 2]> {
        let links = self.links_of_bodies();
        let mut on_link: Vec<Vec<usize>> = vec![vec![]; self.tree().links.len()];
        links.iter().enumerate().for_each(|(body, link)| on_link[*link].push(body));
        let pairs = self.tested_links().iter().flat_map(|[one, other]| {
            let others = &on_link[*other];
            on_link[*one].iter().flat_map(move |a| others.iter().map(move |b| [*a, *b]))
        });
        pairs.collect()
    }

    /// Number of the link of each body.
    pub(super) fn links_of_bodies(&self) -> Vec<usize> {
        let numbers = self.link_numbers();
        self.bodies().iter().filter_map(|body| numbers.get(body.link.as_str()).copied()).collect()
    }

    /// The pairs as numbers of links.
    fn tested_links(&self) -> &[[usize; 2]] {
        self.found_pairs().get_or_init(|| {
            let numbers = self.link_numbers();
            let of = |pairs: &[[String; 2]]| {
                let known = pairs.iter().filter_map(|[one, other]| {
                    let (one, other) = (*numbers.get(one.as_str())?, *numbers.get(other.as_str())?);
                    Some([one.min(other), one.max(other)])
                });
                known.collect::<Vec<_>>()
            };
            let mut tested = match &self.parts().pairs {
                PairRule::Given(pairs) => of(pairs),
                PairRule::AllBut(pairs) => pair_sampling::all_but(self, &of(pairs)),
                PairRule::Sampled => pair_sampling::that_can_touch(self),
            };
            let may_touch = of(&self.parts().may_touch);
            tested.retain(|pair| !may_touch.contains(pair));
            tested
        })
    }
}
