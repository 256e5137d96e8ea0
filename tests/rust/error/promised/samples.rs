//! Robots, limits and sessions that mistakes are made with.

use super::*;

pub fn plane() -> Plane {
    Plane::xy([0.0; 3]).unwrap()
}

pub fn two() -> Robot {
    Robot::planar(&[1.0, 1.0]).unwrap()
}

pub fn arms() -> Robot {
    Robot::from_urdf_with(
        &two_arms(),
        &ikcore::load::UrdfOptions { tips: vec!["left_tool".into(), "right_tool".into()], ..Default::default() },
    )
    .unwrap()
}

pub fn constant(field: Field, value: f64) -> Limits {
    Limits::none_for(2).replace(field, vec![Profile::Constant(value)]).unwrap()
}

pub fn crossed() -> Limits {
    constant(Field::Lower, 1.0).replace(Field::Upper, vec![Profile::Constant(0.0)]).unwrap()
}

pub fn wide() -> Limits {
    constant(Field::Lower, -1000.0).replace(Field::Upper, vec![Profile::Constant(1000.0)]).unwrap()
}

pub fn at(q: &[f64]) -> Endpoint {
    Endpoint::Configuration(q.to_vec())
}

pub fn varying(field: Field) -> Limits {
    let sinusoid = Sinusoid { mean: 2.0, amplitude: 1.0, angular_frequency: 1.0, phase: 0.0 };
    Limits::none_for(2).replace(field, vec![Profile::Sinusoid(sinusoid)]).unwrap()
}

pub fn state(q: &[f64]) -> ArmState {
    ArmState { q: q.to_vec(), qd: vec![0.0; q.len()], qdd: vec![0.0; q.len()] }
}

pub fn moving(q: &[f64], qd: &[f64]) -> ArmState {
    ArmState { qd: qd.to_vec(), ..state(q) }
}

pub fn rated() -> Limits {
    constant(Field::Velocity, 1.0).replace(Field::Acceleration, vec![Profile::Constant(2.0)]).unwrap()
}

pub fn names(count: usize) -> Vec<String> {
    (0..count).map(|i| format!("joint_{}", i + 1)).collect()
}

pub fn twisted() -> Matrix3<f64> {
    Matrix3::identity() * 2.0
}

/// One joint about z.
pub fn hinge(joint: Joint) -> Result<Robot> {
    let mut chain = ChainBuilder::new("door", "frame");
    let index = chain.add_joint(joint);
    chain.moving(index, JointKind::Revolute, Vector3::z(), Drive::DIRECT);
    chain.link("leaf");
    chain.build()
}

/// A joint that follows another one by a polynomial.
pub fn bent() -> Robot {
    let xml = "<robot name='bent'><link name='base'/><link name='arm'/><link name='hand'/>\
        <joint name='turn' type='revolute'><parent link='base'/><child link='arm'/><limit lower='-1' upper='1'/></joint>\
        <joint name='bend' type='continuous'><parent link='arm'/><child link='hand'/>\
        <mimic joint='turn' polynomial='0 0.5 0.2'/></joint></robot>";
    Robot::from_urdf(xml, None, None).unwrap()
}

pub fn leaf() -> Joint {
    Joint::new("hinge", JointKind::Revolute)
}

pub fn reference(rows: usize) -> Reference {
    Reference::new(0.1, (0..rows).map(|i| [1.5, 0.01 * i as f64, 0.0]).collect(), None).unwrap()
}

pub fn between(ends: &[Endpoint], start: &[f64]) -> Result<Plan> {
    let options = PointToPointOptions { limits: Some(rated()), ..Default::default() };
    plan_point_to_point(&two(), &Endpoint::Configuration(start.to_vec()), ends, &options, &mut Unattended)
}

pub fn far() -> Endpoint {
    Endpoint::Targets { tips: vec![], targets: [Target::Position([9.0, 0.0, 0.0])].into_iter().collect() }
}

pub fn along(points: &[[f64; 3]]) -> Result<Plan> {
    let path = TipPath::through(&Waypoints::new(points.to_vec(), None)?)?;
    plan_along_path(&two(), &path, &AlongPathOptions { limits: Some(rated()), ..Default::default() }, &mut Unattended)
}

/// A program of one line of a UR5e by this way (m), from a posture in front of it.
pub fn program(way: [f64; 3]) -> Result<Plan> {
    let (arm, start) = (robot("ur5e"), [0.0, -1.5, 1.8, -1.9, -1.57, 0.3]);
    let tip = arm.fk(&start)?;
    let goal = pose::from_parts((tip.translation.vector + Vector3::from(way)).into(), *tip.rotation.matrix());
    let limits = Limits::of(&arm).replace(Field::Acceleration, vec![Profile::Constant(5.0); 6])?;
    let narrow = limits.replace(Field::Upper, vec![Profile::Constant(1.9); 6])?;
    let options = MovesOptions { limits: Some(narrow), ..MovesOptions::default() };
    let line = Move { name: Some("out".into()), ..Move::new(MoveKind::Line { pose: goal, speed: None }) };
    let moves = if way == [0.0; 3] { vec![] } else { vec![line] };
    plan_moves(&arm, &moves, &start, &options, &mut Unattended)
}

pub fn session() -> Session {
    Session::new(&two(), &[0.5, 0.5], 0.1, &TrackOptions { limits: jumping(&two()), ..Default::default() }).unwrap()
}

pub fn eased_session() -> Session {
    let limits = rated().replace(Field::Upper, vec![Profile::Constant(0.6)]).unwrap();
    Session::new(&two(), &[0.5, 0.5], 0.1, &TrackOptions { limits: Some(limits), ..Default::default() }).unwrap()
}

pub fn control() -> ControlSession {
    ControlSession::new(&Controller::default(), &[0.0; 2], 0.1, Limits::none_for(2), Tolerance::default(), 0).unwrap()
}

pub fn commanded() -> ControlSession {
    let mut session = control();
    session.command(&[1.0, 0.0, 0.0].into()).unwrap();
    session
}

pub struct Broken;

impl Plant for Broken {
    fn measure(&mut self, _: &[f64]) -> std::result::Result<TipPose, Fault> {
        Err(Fault("does not answer".into()))
    }
}

pub fn solid() -> Robot {
    two().with_capsules_along_links(0.05).unwrap()
}

pub fn ball(x: f64) -> Shape {
    Shape::sphere([x, 0.0, 0.0], 0.1).unwrap()
}

/// A cloud of one point.
pub fn seen() -> Obstacle {
    Shape::point_cloud(vec![[3.0, 0.0, 0.0]], 0.1).unwrap().into()
}

pub fn line() -> StraightLine {
    StraightLine { distance: 0.1, direction: None, frame: LineFrame::Tip, touch: vec![] }
}

/// A curve of a user.
#[derive(Debug)]
pub struct Own;

impl Curve for Own {
    fn duration(&self) -> f64 {
        1.0
    }

    fn position(&self, _: f64) -> [f64; 3] {
        [0.0; 3]
    }

    fn velocity(&self, _: f64) -> [f64; 3] {
        [0.0; 3]
    }
}

pub struct Unwritable;

impl serde::Serialize for Unwritable {
    fn serialize<S: serde::Serializer>(&self, _: S) -> std::result::Result<S::Ok, S::Error> {
        Err(serde::ser::Error::custom("no"))
    }
}

/// Bytes as they are.
pub struct Raw(Vec<u8>);

impl serde::Serialize for Raw {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        let mut bytes = serializer.serialize_tuple(self.0.len())?;
        self.0.iter().try_for_each(|byte| bytes.serialize_element(byte))?;
        bytes.end()
    }
}

/// Bytes before those of a stored value: the format and a checksum.
pub const HEADER: usize = 9;

/// A stored circle with one of its numbers replaced.
pub fn spoiled_circle(number: f64, instead: f64) -> Result<Path> {
    let circle = Circle::new(Plane::xy([0.1234, 0.0, 0.0]).unwrap(), 0.7317, 1.7).unwrap();
    let turned =
        Path::new(circle).with_orientation(*Rotation3::from_axis_angle(&Vector3::z_axis(), 0.5).matrix()).unwrap();
    let mut payload = turned.to_bytes().unwrap().split_off(HEADER);
    let at = payload.windows(8).position(|window| window == number.to_le_bytes()).expect("the number");
    payload[at..at + 8].copy_from_slice(&instead.to_le_bytes());
    Path::from_bytes(&stored::to_bytes("path", &Raw(payload)).unwrap())
}

pub fn lost() -> Pose {
    pose::translation(NAN, 0.0, 0.0)
}

pub fn scaled() -> Pose {
    Pose::from_parts(Vector3::zeros().into(), Rotation3::from_matrix_unchecked(twisted()))
}

pub fn table() -> DhTable {
    DhTable::new(Dh::Standard, vec![0.1], vec![0.0], vec![0.0])
}

pub fn nameless() -> Robot {
    let mut chain = ChainBuilder::new("nameless", "base");
    for name in ["one", "two"] {
        let index = chain.add_joint(Joint::new(name, JointKind::Revolute));
        chain.moving(index, JointKind::Revolute, Vector3::z(), Drive::DIRECT);
        chain.fixed(pose::translation(1.0, 0.0, 0.0));
    }
    chain.link("tip");
    chain.build().unwrap()
}

pub fn adrift() -> Result<Robot> {
    let mut chain = ChainBuilder::new("adrift", "base");
    chain.fixed(lost());
    let index = chain.add_joint(leaf());
    chain.moving(index, JointKind::Revolute, Vector3::z(), Drive::DIRECT);
    chain.build()
}

pub fn huge_cover() -> Result<Cover> {
    let far = 1e200;
    let corners = vec![[0.0; 3], [far, 0.0, 0.0], [0.0, far, 0.0], [0.0, 0.0, far]];
    let shape = Shape::mesh(corners, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]).unwrap();
    let Geometry::Mesh(mesh) = shape.geometry() else { panic!("no mesh") };
    mesh.cover(4)
}

pub fn held() -> Robot {
    let joint = |name: &str, child: &str| {
        format!(
            r#"<link name="{child}"/><joint name="{name}" type="revolute"><parent link="base"/><child link="{child}"/>
            <limit lower="-1" upper="1" velocity="1" effort="1"/></joint>"#
        )
    };
    let urdf =
        format!(r#"<robot name="held"><link name="base"/>{}{}</robot>"#, joint("j", "arm"), joint("side", "flap"));
    Robot::from_urdf(&urdf, None, Some("arm")).unwrap()
}

pub fn on_wheels(far: f64) -> BaseLimits {
    BaseLimits { lower: vec![-far; 3], upper: vec![far; 3], velocity: vec![1.0; 3], acceleration: vec![1.0; 3] }
}

pub fn antennae() -> Znnbas {
    Znnbas { antenna: Antenna::Constant(vec![0.1; 3]), ..Znnbas::default() }
}

pub fn answered() -> ControlSession {
    let mut session = commanded();
    session.observe(&[1.0, 0.0, 0.0].into()).unwrap();
    session
}

pub fn posed() -> ControlSession {
    let mut session = control();
    session.command(&TipPose::from(&Pose::identity())).unwrap();
    session
}

pub fn turning() -> Session {
    let task = Task::new(TaskKind::Orientation, None, None, None).unwrap();
    Session::new(
        &two(),
        &[0.5, 0.5],
        0.1,
        &TrackOptions { task: Some(task), limits: jumping(&two()), ..TrackOptions::default() },
    )
    .unwrap()
}

pub fn stamped(stamp: f64) -> Arrival {
    Arrival { stamp: Some(stamp), ..Target::Position([1.5, 0.5, 0.0]).into() }
}

/// Targets of both tips and of the pair, which contradict each other.
pub fn twice() -> Result<Solution> {
    let arms = arms();
    let tips = [Subject::Tip(0), Subject::Tip(0)].map(|subject| NamedTask {
        subject,
        task: None,
        tolerance: Tolerance::default(),
    });
    let targets = [Target::Position([0.5, 0.0, 0.5]), Target::Position([0.5, 0.0, 0.6])];
    solve_tips(&arms, &targets, &SolveOptions { tips: tips.to_vec(), ..SolveOptions::default() }, &mut Unattended)
}
