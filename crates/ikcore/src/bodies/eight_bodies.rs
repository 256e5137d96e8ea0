//! The bodies of a robot at eight configurations at once, in single precision.

use super::body_groups::BodyGroups;
use super::carried_body::CarriedBody;
use crate::kinematics::eight_frames::EightStages;
use crate::math::Frame;
use crate::math::arithmetic::Arithmetic;
use crate::math::f32x8::F32x8;
use crate::math::real::{Eight, Real};
use crate::math::vec3::Vec3;
use crate::shape::{EightCapsules, Vectors, splat};

/// The bodies, each in the frame that carries it, and balls around those of one frame.
#[derive(Debug)]
pub(crate) struct EightBodies {
    stages: EightStages,
    bodies: Vec<EightBody>,
    balls: Vec<EightBody>,
}

/// A capsule in the frame that carries it; a sphere if `along` is `None`.
#[derive(Debug)]
struct EightBody {
    frame: usize,
    start: Vectors,
    along: Option<Vectors>,
    radius: F32x8,
}

/// Poses of all bodies at eight configurations; axes are computed when first asked for.
#[derive(Debug)]
pub(crate) struct EightPoses {
    pub frames: Vec<Frame<F32x8>>,
    axes: Vec<[Vectors; 2]>,
    /// The update at which each axis was computed.
    computed: Vec<u32>,
    now: u32,
}

impl EightBodies {
    /// The bodies `carried`, in `groups`, of an arm with these moving elements.
    pub fn new(stages: EightStages, carried: &[CarriedBody], groups: &BodyGroups) -> Self {
        let bodies = carried.iter().map(|body| {
            let [a, b] = body.ends;
            let along = (a != b).then(|| splat(&std::array::from_fn(|k| b[k] - a[k])));
            EightBody { frame: body.stages, start: splat(&a), along, radius: F32x8::splat(body.radius as f32) }
        });
        let balls = (0..groups.count()).map(|group| {
            let (center, radius) = groups.ball_in_frame(group);
            let radius = F32x8::splat(radius as f32);
            EightBody { frame: groups.frame_of(group), start: splat(&center), along: None, radius }
        });
        Self { stages, bodies: bodies.collect(), balls: balls.collect() }
    }

    /// Room for poses.
    pub fn buffer(&self) -> EightPoses {
        let count = self.bodies.len();
        let axes = vec![[[F32x8::ZERO; 3]; 2]; count];
        EightPoses { frames: self.stages.buffer(), axes, computed: vec![0; count], now: 0 }
    }

    /// Updates the poses to the configurations `qs`, one entry per joint.
    #[inline(always)]
    pub fn update<A: Arithmetic>(&self, qs: &[F32x8], poses: &mut EightPoses) {
        self.stages.write::<A>(qs, &mut poses.frames);
        poses.now += 1;
    }

    /// The ball around a group.
    #[inline(always)]
    pub fn ball<A: Arithmetic>(&self, group: usize, poses: &EightPoses) -> EightCapsules<A> {
        let ball = &self.balls[group];
        let start = at(&poses.frames[ball.frame], Vec3::of(&ball.start));
        EightCapsules { start, along: None, radius: Eight::of(ball.radius) }
    }

    /// The capsule around a body.
    #[inline(always)]
    pub fn body<A: Arithmetic>(&self, number: usize, poses: &mut EightPoses) -> EightCapsules<A> {
        let body = &self.bodies[number];
        let EightPoses { frames, axes, computed, now } = poses;
        if computed[number] != *now {
            let frame = &frames[body.frame];
            axes[number][0] = at(frame, Vec3::<Eight<A>>::of(&body.start)).stored();
            if let Some(along) = &body.along {
                axes[number][1] = turned(frame, Vec3::<Eight<A>>::of(along)).stored();
            }
            computed[number] = *now;
        }
        let [start, along] = &axes[number];
        let along = body.along.is_some().then(|| Vec3::of(along));
        EightCapsules { start: Vec3::of(start), along, radius: Eight::of(body.radius) }
    }
}

/// A point, given in `frame`.
#[inline(always)]
fn at<A: Arithmetic>(frame: &Frame<F32x8>, point: Vec3<Eight<A>>) -> Vec3<Eight<A>> {
    let [x, y, z] = &frame.axes;
    let [x, y, z, origin] = [Vec3::of(x), Vec3::of(y), Vec3::of(z), Vec3::of(&frame.origin)];
    x.mul_add(point.x, y.mul_add(point.y, z.mul_add(point.z, origin)))
}

/// A vector, given in `frame`.
#[inline(always)]
fn turned<A: Arithmetic>(frame: &Frame<F32x8>, vector: Vec3<Eight<A>>) -> Vec3<Eight<A>> {
    let [x, y, z] = &frame.axes;
    let [x, y, z] = [Vec3::of(x), Vec3::of(y), Vec3::of(z)];
    x.mul_add(vector.x, y.mul_add(vector.y, z * vector.z))
}
