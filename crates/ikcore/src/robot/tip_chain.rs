//! The chains of a robot with several tips, folded from its first chain and from the branches.

use std::collections::HashSet;
use std::sync::Arc;

use super::description::{Description, Element, require_supported};
use super::parts::Parts;
use crate::error::{Error, Result};
use crate::kinematics::Reach;
use crate::kinematics::chain::{Chain, Transmission};
use crate::kinematics::kernels::Kernels;
use crate::math::Pose;

/// A chain with its kernels.
#[derive(Debug, Clone)]
pub(crate) struct CompiledChain {
    pub chain: Arc<Chain>,
    pub kernels: Kernels,
}

impl CompiledChain {
    fn new(chain: Chain) -> Self {
        Self { kernels: Kernels::for_chain(&chain), chain: Arc::new(chain) }
    }
}

/// The chain from the base to one of several tips; its motions count the joints of the whole robot.
#[derive(Debug, Clone)]
pub(crate) struct TipChain {
    /// Number of the tip's link.
    pub link: usize,
    /// Numbers of the links from the base to it.
    pub links: Vec<usize>,
    pub whole: CompiledChain,
    /// The chain up to the last element that moves another tip too.
    pub stem: CompiledChain,
    /// Elements after the stem, which move this tip alone.
    pub own: Vec<Element>,
    /// The reach of the stretched links, without prismatic motion.
    pub reach_of_links: Reach,
}

/// The chains to all tips of a robot with several; none for a robot with one.
#[derive(Debug, Clone, Default)]
pub(crate) struct TipChains {
    pub chains: Vec<TipChain>,
    /// The motions of all elements that move a tip.
    pub motions: Vec<Transmission>,
}

impl TipChains {
    /// The chains of a valid robot.
    pub fn of(parts: &Parts) -> Self {
        if parts.tips.is_empty() {
            return Self::default();
        }
        let ways: Vec<Way> = links_of_tips(parts).map(|link| Way::to(parts, link)).collect();
        let joints: Vec<HashSet<usize>> = ways.iter().map(|way| way.joints().collect()).collect();
        let chains = ways.iter().enumerate().map(|(tip, way)| {
            let others = || joints.iter().enumerate().filter(|(other, _)| *other != tip);
            let is_shared = |joint: &usize| others().any(|(_, joints)| joints.contains(joint));
            let last = way.elements.iter().rposition(|element| element.drivers().any(|joint| is_shared(&joint)));
            let (stem, own) = way.elements.split_at(last.map_or(0, |last| last + 1));
            // The base and the tool of the robot with one tip; those of several have none.
            let whole = CompiledChain::new(folded(parts, &way.elements));
            let reach_of_links = Reach::of_links(&whole.chain);
            TipChain {
                link: way.link,
                links: way.links.clone(),
                whole,
                stem: CompiledChain::new(folded(parts, stem)),
                own: own.to_vec(),
                reach_of_links,
            }
        });
        let chains: Vec<TipChain> = chains.collect();
        let mut motions: Vec<Transmission> = vec![];
        for chain in &chains {
            let stages = &chain.whole.chain.motions[..chain.whole.chain.moving];
            motions.extend(stages.iter().filter(|motion| !motions.contains(motion)).copied().collect::<Vec<_>>());
        }
        Self { chains, motions }
    }

    /// Checks the tips of `parts`, whose links are valid: that each has a chain, and that joints move it relative to the others.
    pub fn validate(parts: &Parts) -> Result<()> {
        let name = &parts.description.name;
        let invalid = |problem: String| Error::InvalidRobot { robot: name.clone(), problem: problem.into() };
        let beside = |tip: &String| parts.off_chain.links.iter().any(|link| link.name == *tip);
        if let Some(tip) = parts.tips.iter().find(|tip| !beside(tip)) {
            let problem = match parts.description.link_names().any(|link| link == tip) {
                true => format!("tip '{tip}' lies on the chain to tip '{}': take one of them", first_tip(parts)),
                false => format!("tip '{tip}' is no link of the robot"),
            };
            return Err(invalid(problem));
        }
        let ways: Vec<Way> = links_of_tips(parts).map(|link| Way::to(parts, link)).collect();
        for (i, way) in ways.iter().enumerate() {
            require_supported(name, way.joints().count())?;
            for other in &ways[..i] {
                let (one, other) = if way.links.contains(&other.link) { (other, way) } else { (way, other) };
                if one.link == other.link {
                    return Err(invalid(format!("tip '{}' is given twice", one.name)));
                }
                if other.links.contains(&one.link) {
                    let problem =
                        format!("tip '{}' lies on the chain to tip '{}': take one of them", one.name, other.name);
                    return Err(invalid(problem));
                }
                if one.moves_with(other) {
                    let problem =
                        format!("no joint moves tip '{}' relative to tip '{}': take one of them", one.name, other.name);
                    return Err(invalid(problem));
                }
            }
        }
        Ok(())
    }
}

/// Name of the link at the end of the first chain.
pub(super) fn first_tip(parts: &Parts) -> &str {
    parts.description.link_names().last().unwrap_or_default()
}

/// Numbers of the links of all tips; unknown names are left out.
fn links_of_tips(parts: &Parts) -> impl Iterator<Item = usize> {
    let on_chain = parts.description.link_names().count();
    let further = move |tip: &String| {
        let beside = parts.off_chain.links.iter().position(|link| link.name == *tip)?;
        Some(on_chain + beside)
    };
    std::iter::once(on_chain.saturating_sub(1)).chain(parts.tips.iter().filter_map(further))
}

/// The way from the base to a link.
struct Way {
    name: String,
    link: usize,
    /// Numbers of the links on it, the first of all and `link` included.
    links: Vec<usize>,
    /// Its elements; held joints are constant.
    elements: Vec<Element>,
}

impl Way {
    fn to(parts: &Parts, link: usize) -> Self {
        let Parts { description, off_chain, .. } = parts;
        let on_chain = description.link_names().count();
        let (mut at, mut beside) = (link, vec![]);
        while let Some(number) = at.checked_sub(on_chain) {
            beside.push(number);
            at = off_chain.links[number].parent;
        }
        beside.reverse();
        let named = description.elements.iter().enumerate().filter(|(_, element)| matches!(element, Element::Link(_)));
        let end = named.map(|(place, _)| place).nth(at).map_or(0, |place| place + 1);
        let mut elements = description.elements[..end].to_vec();
        for number in &beside {
            let link = &off_chain.links[*number];
            elements.extend(link.elements.iter().map(|element| off_chain.settled(element, description.joints.len())));
            elements.push(Element::Link(link.name.clone()));
        }
        let name = match beside.last() {
            Some(number) => off_chain.links[*number].name.clone(),
            None => description.link_names().nth(at).unwrap_or_default().to_owned(),
        };
        Self { name, link, links: (0..=at).chain(beside.iter().map(|number| on_chain + number)).collect(), elements }
    }

    /// The joints of its moving elements.
    fn joints(&self) -> impl Iterator<Item = usize> {
        self.elements.iter().flat_map(Element::drivers)
    }

    /// Whether nothing moves between the ends of both.
    fn moves_with(&self, other: &Self) -> bool {
        let shared = self.elements.iter().zip(&other.elements).take_while(|(one, other)| one == other).count();
        let is_fixed = |way: &Self| way.elements[shared..].iter().all(|element| element.drivers().is_empty());
        is_fixed(self) && is_fixed(other)
    }
}

fn folded(parts: &Parts, elements: &[Element]) -> Chain {
    let (joints, elements) = (parts.description.joints.clone(), elements.to_vec());
    Description { name: String::new(), joints, elements }.folded(&parts.base, &Pose::identity())
}
