//! The other side of `beetle-ik ros`, on RustDDS: `dds_peer DOMAIN COUNT URDF`.
//!
//! Publishes a description, joint states in an order of their own and goals, checks COUNT trajectories, and sends messages
//! that cannot be used in between. Every line it prints is a result; it exits with 1 at the first thing that is wrong.

use std::time::{Duration, Instant};

use rustdds::no_key::{DataReader, DataWriter};
use rustdds::policy::{Durability, History, Reliability};
use rustdds::{
    CDRDeserializerAdapter, CDRSerializerAdapter, DomainParticipant, QosPolicies, QosPolicyBuilder, TopicKind,
};
use serde::{de::DeserializeOwned, Deserialize, Serialize};

#[derive(Serialize, Deserialize, Clone, Debug, Default)]
struct Time {
    sec: i32,
    nanosec: u32,
}

#[derive(Serialize, Deserialize, Clone, Debug, Default)]
struct Header {
    stamp: Time,
    frame_id: String,
}

#[derive(Serialize, Deserialize, Clone, Debug, Default)]
struct Text {
    data: String,
}

#[derive(Serialize, Deserialize, Clone, Debug, Default)]
struct JointState {
    header: Header,
    name: Vec<String>,
    position: Vec<f64>,
    velocity: Vec<f64>,
    effort: Vec<f64>,
}

#[derive(Serialize, Deserialize, Clone, Debug, Default)]
struct PoseStamped {
    header: Header,
    position: [f64; 3],
    orientation: [f64; 4],
}

#[derive(Serialize, Deserialize, Clone, Debug, Default)]
struct Point {
    positions: Vec<f64>,
    velocities: Vec<f64>,
    accelerations: Vec<f64>,
    effort: Vec<f64>,
    time_from_start: Time,
}

#[derive(Serialize, Deserialize, Clone, Debug, Default)]
struct JointTrajectory {
    header: Header,
    joint_names: Vec<String>,
    points: Vec<Point>,
}

/// The qualities of service of ROS 2: reliable or not, transient local or volatile.
fn quality(reliable: bool, latched: bool, depth: i32) -> QosPolicies {
    let blocked = rustdds::Duration::from_millis(100);
    QosPolicyBuilder::new()
        .reliability(if reliable {
            Reliability::Reliable { max_blocking_time: blocked }
        } else {
            Reliability::BestEffort
        })
        .durability(if latched { Durability::TransientLocal } else { Durability::Volatile })
        .history(History::KeepLast { depth })
        .build()
}

struct Graph {
    participant: DomainParticipant,
}

impl Graph {
    fn writer<T: Serialize>(
        &self,
        topic: &str,
        kind: &str,
        qos: &QosPolicies,
    ) -> DataWriter<T, CDRSerializerAdapter<T>> {
        let topic =
            self.participant.create_topic(format!("rt/{topic}"), kind.into(), qos, TopicKind::NoKey).expect("a topic");
        let publisher = self.participant.create_publisher(qos).expect("a publisher");
        publisher.create_datawriter_no_key(&topic, None).expect("a writer")
    }

    fn reader<T: DeserializeOwned + 'static>(
        &self,
        topic: &str,
        kind: &str,
        qos: &QosPolicies,
    ) -> DataReader<T, CDRDeserializerAdapter<T>> {
        let topic =
            self.participant.create_topic(format!("rt/{topic}"), kind.into(), qos, TopicKind::NoKey).expect("a topic");
        let subscriber = self.participant.create_subscriber(qos).expect("a subscriber");
        subscriber.create_datareader_no_key(&topic, None).expect("a reader")
    }
}

const JOINTS: [&str; 3] = ["lift", "shoulder", "elbow"];

/// The pose of the tip of the arm of tests/python/test_door_ros.py: a lift and two links of half a metre.
fn pose(q: &[f64]) -> PoseStamped {
    let (one, both) = (q[1], q[1] + q[2]);
    PoseStamped {
        header: Header { frame_id: "base".into(), ..Header::default() },
        position: [0.5 + 0.5 * one.cos(), 0.5 * one.sin(), q[0]],
        orientation: [0.0, 0.0, (0.5 * both).sin(), (0.5 * both).cos()],
    }
}

fn state(q: &[f64]) -> JointState {
    JointState {
        name: ["finger", "elbow", "lift", "shoulder"].map(String::from).to_vec(),
        position: vec![0.02, q[2], q[0], q[1]],
        ..JointState::default()
    }
}

/// What is wrong with a trajectory from `from` to `to`.
fn complaint(sent: &JointTrajectory, from: &[f64], to: &[f64]) -> Option<String> {
    let near = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(x, y)| (x - y).abs() < 1e-5);
    let times: Vec<f64> = sent
        .points
        .iter()
        .map(|p| f64::from(p.time_from_start.sec) + 1e-9 * f64::from(p.time_from_start.nanosec))
        .collect();
    match () {
        () if sent.joint_names != JOINTS => Some(format!("joints {:?}", sent.joint_names)),
        () if sent.points.len() < 2 => Some(format!("{} points", sent.points.len())),
        () if !near(&sent.points[0].positions, from) => {
            Some(format!("begins at {:?}, not {from:?}", sent.points[0].positions))
        }
        () if !near(&sent.points[sent.points.len() - 1].positions, to) => Some("ends elsewhere".into()),
        () if times[0] != 0.0 || times.windows(2).any(|pair| pair[1] <= pair[0]) => Some("times do not grow".into()),
        () => None,
    }
}

fn main() {
    let mut arguments = std::env::args().skip(1);
    let domain: u16 = arguments.next().and_then(|text| text.parse().ok()).expect("DOMAIN");
    let count: usize = arguments.next().and_then(|text| text.parse().ok()).expect("COUNT");
    let urdf = std::fs::read_to_string(arguments.next().expect("URDF")).expect("a file");

    let graph = Graph { participant: DomainParticipant::new(domain).expect("a participant") };
    let (standard, fresh) = (quality(true, false, 10), quality(false, false, 5));
    let (state_type, pose_type) = ("sensor_msgs::msg::dds_::JointState_", "geometry_msgs::msg::dds_::PoseStamped_");
    let description =
        graph.writer::<Text>("robot_description", "std_msgs::msg::dds_::String_", &quality(true, true, 1));
    let states = graph.writer::<JointState>("joint_states", state_type, &fresh);
    let damaged = graph.writer::<Text>("joint_states", state_type, &fresh); // bytes of another type
    let goals = graph.writer::<PoseStamped>("beetle/goal_pose", pose_type, &standard);
    let mut commands = graph.reader::<JointTrajectory>(
        "joint_trajectory_controller/joint_trajectory",
        "trajectory_msgs::msg::dds_::JointTrajectory_",
        &standard,
    );
    description.write(Text { data: urdf }, None).expect("written");

    let began = Instant::now();
    let mut here = [0.1, 0.4, -0.7];
    for k in 0..count {
        let there =
            [0.1 + 0.01 * (0.7 * k as f64).sin(), 0.4 + 0.02 * (k as f64).sin(), -0.7 + 0.02 * (1.3 * k as f64).cos()];
        if k % 10 == 5 {
            let unequal = JointState { name: vec!["lift".into()], ..JointState::default() };
            let undefined = JointState { name: vec!["lift".into()], position: vec![f64::NAN], ..JointState::default() };
            for wrong in [unequal, undefined] {
                states.write(wrong, None).expect("written");
            }
            damaged.write(Text { data: "no joint state".into() }, None).expect("written");
        }
        let mut asked = None::<Instant>;
        loop {
            if asked.map_or(true, |at| at.elapsed() > Duration::from_millis(50)) {
                states.write(state(&here), None).expect("written");
                std::thread::sleep(Duration::from_millis(2)); // the state before the goal
                goals.write(pose(&there), None).expect("written");
                asked = Some(Instant::now());
            }
            if let Ok(Some(sample)) = commands.take_next_sample() {
                if let Some(wrong) = complaint(sample.value(), &here, &there) {
                    println!("trajectory {k}: {wrong}");
                    std::process::exit(1);
                }
                break;
            }
            if began.elapsed() > Duration::from_secs(600) {
                println!("trajectory {k}: nothing came");
                std::process::exit(1);
            }
            std::thread::sleep(Duration::from_micros(500));
        }
        here = there;
    }
    println!("{count} trajectories in {:.1} s", began.elapsed().as_secs_f64());
}
