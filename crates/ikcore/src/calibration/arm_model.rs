//! The arm as a function of joint angles and parameters, with exact derivatives by the geometry of the chain: each corrected
//! transform moves the tip as a screw, and so does each joint (Mooring, Roth and Driels, Fundamentals of Manipulator Calibration,
//! 1991).

use nalgebra::Vector3;

use super::estimate::Estimate;
use super::parameters::{FitParameter, FittedParts, Part, Place, of_correction, usual};
use crate::error::Result;
use crate::math::{Pose, pose};
use crate::robot::{Element, Robot};

/// One factor of the tip pose.
#[derive(Debug, Clone)]
enum Stage {
    Constant(Pose),
    /// A transform, and the first parameter of its correction.
    Corrected {
        nominal: Pose,
        number: usize,
        first: usize,
    },
    Moving {
        axis: Vector3<f64>,
        turns: bool,
        joint: usize,
        scale: f64,
        offset: f64,
    },
    RotationVector {
        joint: usize,
    },
}

/// Number of directions of the poses at both ends that measurements determine.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct FreeEnds {
    /// Directions of the base: 6, or 0 where it has no effect.
    pub base: usize,
    /// Directions of the tool: 6, or 3 where only a point is measured.
    pub tool: usize,
}

/// Transforms beside the robot's own: the first frame is that of the measurements, the last one what is measured.
#[derive(Debug, Clone)]
pub(super) struct CameraFrames {
    /// Pose of the robot's frame in that of the measurements, and its name.
    pub before: (Pose, &'static str),
    /// Pose of what is measured in the frame of the tip, and its name.
    pub after: (Pose, &'static str),
}

/// Chain whose transforms have corrections, and the list of all parameters.
#[derive(Debug, Clone)]
pub(super) struct ArmModel {
    stages: Vec<Stage>,
    /// Elements of the robot, with room for a correction before each joint.
    elements: Vec<Element>,
    /// Element of each correction of a link.
    corrected: Vec<(usize, usize)>,
    /// Corrections of base and tool.
    ends: [Option<usize>; 2],
    /// Parameter of each joint's zero.
    zeros: Vec<Option<usize>>,
    outside: Option<CameraFrames>,
    corrections: usize,
    pub parameters: Vec<FitParameter>,
}

/// Frames and axes of one configuration, from which the derivatives follow.
#[derive(Debug, Clone, Default)]
pub(super) struct Marks {
    corrections: Vec<(usize, usize, Pose)>,
    /// Parameter, direction and point of the axis, and whether it turns.
    joints: Vec<(usize, Vector3<f64>, Vector3<f64>, bool)>,
}

impl ArmModel {
    /// `outside` replaces base and tool as the ends that are fitted.
    pub fn new(robot: &Robot, parts: &FittedParts, free: FreeEnds, outside: Option<CameraFrames>) -> Self {
        let mut model = Self {
            stages: vec![],
            elements: vec![],
            corrected: vec![],
            ends: [None; 2],
            zeros: vec![None; robot.dof()],
            outside,
            corrections: 0,
            parameters: vec![],
        };
        model.push_start(robot, parts, free);
        model.push_elements(robot, parts.has(Part::Links));
        model.push_end(robot, parts, free);
        if parts.has(Part::Offsets) {
            model.free_zeros(robot);
        }
        model
    }

    fn push_start(&mut self, robot: &Robot, parts: &FittedParts, free: FreeEnds) {
        let own = *robot.base();
        let (nominal, name) = self.outside.as_ref().map_or((own, "base"), |outside| outside.before);
        let directions = if parts.has(Part::Base) { free.base } else { 0 };
        self.ends[0] = self.push_corrected(nominal, name, directions, [usual::PLACEMENT; 2]);
        if self.outside.is_some() {
            self.stages.push(Stage::Constant(own));
        }
    }

    fn push_end(&mut self, robot: &Robot, parts: &FittedParts, free: FreeEnds) {
        let own = *robot.tool();
        let (nominal, name) = self.outside.as_ref().map_or((own, "tool"), |outside| outside.after);
        if self.outside.is_some() {
            self.stages.push(Stage::Constant(own));
        }
        let directions = if parts.has(Part::Tool) { free.tool } else { 0 };
        self.ends[1] = self.push_corrected(nominal, name, directions, [usual::PLACEMENT; 2]);
    }

    /// Appends a transform with a correction, if any direction of it is free.
    fn push_corrected(&mut self, nominal: Pose, name: &str, directions: usize, usual: [f64; 2]) -> Option<usize> {
        if directions == 0 {
            self.stages.push(Stage::Constant(nominal));
            return None;
        }
        let (number, first) = (self.corrections, self.parameters.len());
        self.stages.push(Stage::Corrected { nominal, number, first });
        self.parameters.extend(of_correction(name, number, directions, usual));
        self.corrections += 1;
        Some(number)
    }

    /// Appends the robot's own elements. Between two joints the last transform gets a correction.
    fn push_elements(&mut self, robot: &Robot, links: bool) {
        let given = robot.elements();
        let joint_after = |from: usize| given[from..].iter().position(Element::moves).map(|ahead| &given[from + ahead]);
        let has_room = |from: usize| {
            let gap = given[from..].iter().take_while(|element| !element.moves());
            gap.filter(|element| matches!(element, Element::Fixed(_))).count()
        };
        let mut moved = false;
        let mut names = Vec::new();
        for (at, element) in given.iter().enumerate() {
            // A joint right behind another one gets a transform between them.
            let follows_joint = at > 0 && given[at - 1].moves();
            if links && follows_joint && has_room(at) == 0 && joint_after(at).is_some() {
                self.push_link(Pose::identity(), robot, joint_after(at), &mut names);
            }
            match element {
                Element::Link(_) => self.elements.push(element.clone()),
                Element::Fixed(transform) if links && moved && has_room(at + 1) == 0 && joint_after(at).is_some() => {
                    self.push_link(*transform, robot, joint_after(at), &mut names);
                }
                Element::Fixed(transform) => {
                    self.stages.push(Stage::Constant(*transform));
                    self.elements.push(element.clone());
                }
                Element::Moving { axis, turns, joint, scale, offset } => {
                    let (axis, turns, joint, scale, offset) = (*axis, *turns, *joint, *scale, *offset);
                    self.stages.push(Stage::Moving { axis, turns, joint, scale, offset });
                    self.elements.push(element.clone());
                }
                // `calibrate` takes no robot that has one.
                Element::Curved { .. } => self.elements.push(element.clone()),
                Element::RotationVector { joint } => {
                    self.stages.push(Stage::RotationVector { joint: *joint });
                    self.elements.push(element.clone());
                }
            }
            moved |= element.moves();
        }
    }

    /// Appends the transform before joint `next`, with a correction.
    fn push_link(&mut self, transform: Pose, robot: &Robot, next: Option<&Element>, names: &mut Vec<String>) {
        let joint = next.and_then(Element::first_driver).unwrap_or_default();
        let name = format!("link {}", robot.joints()[joint].name);
        names.push(name.clone());
        let again = names.iter().filter(|taken| **taken == name).count();
        let name = if again > 1 { format!("{name} ({again})") } else { name };
        let element = self.elements.len();
        self.elements.push(Element::Fixed(transform));
        let number = self.push_corrected(transform, &name, 6, [usual::LINK_LENGTH, usual::LINK_ANGLE]);
        self.corrected.extend(number.map(|number| (element, number)));
    }

    /// Makes the zero of each joint a parameter, except those of a rotation vector.
    fn free_zeros(&mut self, robot: &Robot) {
        for (number, joint) in robot.joints().iter().enumerate() {
            let drives = |stage: &Stage| matches!(stage, Stage::Moving { joint, .. } if *joint == number);
            if !self.stages.iter().any(drives) {
                continue;
            }
            self.zeros[number] = Some(self.parameters.len());
            let is_angle = joint.kind.turns();
            self.parameters.push(FitParameter {
                name: format!("offset {}", joint.name),
                is_angle,
                usual: if is_angle { usual::ANGLE_OFFSET } else { usual::SLIDE_OFFSET },
                place: Place::Offset(number),
            });
        }
    }

    /// The estimate that leaves the robot as it is.
    pub fn corrections(&self) -> Vec<Pose> {
        vec![Pose::identity(); self.corrections]
    }

    /// Pose of what is measured at `q`, in the frame of the measurements; `marks` are those of its derivatives.
    pub fn tip(&self, estimate: &Estimate, q: &[f64], marks: &mut Marks) -> Pose {
        marks.corrections.clear();
        marks.joints.clear();
        let mut reached = Pose::identity();
        for stage in &self.stages {
            match stage {
                Stage::Constant(transform) => reached *= transform,
                Stage::Corrected { nominal, number, first } => {
                    reached = reached * nominal * estimate.corrections[*number];
                    marks.corrections.push((*number, *first, reached));
                }
                Stage::Moving { axis, turns, joint, scale, offset } => {
                    let value = scale * (q[*joint] + estimate.offsets[*joint]) + offset;
                    if let Some(parameter) = self.zeros[*joint] {
                        let direction = *scale * (reached.rotation * axis);
                        marks.joints.push((parameter, direction, reached.translation.vector, *turns));
                    }
                    reached *= if *turns {
                        pose::rotation(*axis, value)
                    } else {
                        let slide = value * axis;
                        pose::translation(slide.x, slide.y, slide.z)
                    };
                }
                Stage::RotationVector { joint } => {
                    reached *= pose::from_rotation_vector([q[*joint], q[joint + 1], q[joint + 2]], [0.0; 3]);
                }
            }
        }
        reached
    }

    /// Writes the derivative of the tip by each parameter: linear (m), then angular (rad), in the frame of the measurements.
    /// Without columns it writes nothing.
    pub fn derivatives(&self, tip: &Pose, marks: &Marks, columns: &mut [[f64; 6]]) {
        if columns.is_empty() {
            return;
        }
        columns.fill([0.0; 6]);
        let tip = tip.translation.vector;
        for (number, first, frame) in &marks.corrections {
            let arm = tip - frame.translation.vector;
            let axes = frame.rotation.matrix();
            for (column, parameter) in columns[*first..].iter_mut().zip(&self.parameters[*first..]) {
                let Place::Correction { number: of, direction } = parameter.place else { break };
                if of != *number {
                    break;
                }
                let axis: Vector3<f64> = axes.column(direction % 3).into();
                *column = screw(&axis, &arm, direction > 2);
            }
        }
        for (parameter, axis, point, turns) in &marks.joints {
            // A joint may drive several elements.
            let added = screw(axis, &(tip - point), *turns);
            columns[*parameter].iter_mut().zip(added).for_each(|(entry, part)| *entry += part);
        }
    }

    /// The robot that has these parameters.
    ///
    /// # Errors
    /// As [`Robot::with_geometry`].
    pub fn robot(&self, robot: &Robot, estimate: &Estimate) -> Result<Robot> {
        let mut elements = self.elements.clone();
        for (element, number) in &self.corrected {
            if let Element::Fixed(transform) = &mut elements[*element] {
                *transform *= estimate.corrections[*number];
            }
        }
        for element in &mut elements {
            if let Element::Moving { joint, scale, offset, .. } = element {
                *offset += *scale * estimate.offsets[*joint];
            }
        }
        let [base, tool] = self.own_ends(robot, estimate);
        robot.with_geometry(elements, base, tool)
    }

    /// Base and tool of the robot.
    fn own_ends(&self, robot: &Robot, estimate: &Estimate) -> [Pose; 2] {
        if self.outside.is_some() {
            return [*robot.base(), *robot.tool()];
        }
        self.corrected_ends([robot.base(), robot.tool()], estimate)
    }

    /// The poses outside of the robot, corrected.
    pub fn outside(&self, estimate: &Estimate) -> Option<[Pose; 2]> {
        let CameraFrames { before, after } = self.outside.as_ref()?;
        Some(self.corrected_ends([&before.0, &after.0], estimate))
    }

    fn corrected_ends(&self, [first, last]: [&Pose; 2], estimate: &Estimate) -> [Pose; 2] {
        let of = |end: usize| self.ends[end].map_or(Pose::identity(), |number| estimate.corrections[number]);
        [first * of(0), last * of(1)]
    }

    /// Copy whose ends begin at these poses.
    pub fn with_ends(&self, estimate: &Estimate, poses: [Option<Pose>; 2]) -> Estimate {
        let mut next = estimate.clone();
        let nominal = [self.stage_of(self.ends[0]), self.stage_of(self.ends[1])];
        for ((end, nominal), pose) in self.ends.iter().zip(nominal).zip(poses) {
            if let (Some(number), Some(nominal), Some(pose)) = (end, nominal, pose) {
                next.corrections[*number] = nominal.inverse() * pose;
            }
        }
        next
    }

    fn stage_of(&self, number: Option<usize>) -> Option<Pose> {
        let number = number?;
        self.stages.iter().find_map(|stage| match stage {
            Stage::Corrected { nominal, number: of, .. } if *of == number => Some(*nominal),
            _ => None,
        })
    }

    /// Whether a parameter belongs to base or tool, or is a landmark.
    pub fn is_placement(&self, parameter: &FitParameter) -> bool {
        match parameter.place {
            Place::Offset(_) => false,
            Place::Correction { number, .. } => self.ends.contains(&Some(number)),
            Place::Landmark(_) => true,
        }
    }
}

/// Motion of a point by a turn about or a slide along `axis`; `arm` leads from the axis to the point.
fn screw(axis: &Vector3<f64>, arm: &Vector3<f64>, turns: bool) -> [f64; 6] {
    if turns {
        let linear = axis.cross(arm);
        [linear.x, linear.y, linear.z, axis.x, axis.y, axis.z]
    } else {
        [axis.x, axis.y, axis.z, 0.0, 0.0, 0.0]
    }
}
