//! A URDF with a calibrated geometry: what changed, and nothing else.

use ikcore::calibration::{CalibrationOptions, Measured, Part, calibrate};
use ikcore::math::pose;
use ikcore::rng::stream;
use ikcore::robot::Robot;

/// An arm whose tip is on another branch than its base, with comments, an origin over two lines, and joints without one.
const TEXT: &str = "\n<?xml version=\"1.0\"?>\r\n<!-- keep me -->\n<robot name='arm'>\n  <link name=\"root\"/><link name=\"a\"/>\n\
  <link name='b'/><link name=\"c\"/><link name=\"d\"/>\n\
  <joint name=\"one\" type=\"revolute\">\n    <!-- turns back -->\n    <parent link=\"root\"/><child link=\"a\"/>\n    <axis xyz=\"0 0 2\"/>\n    <limit lower=\"-2\" upper=\"2\"/>\n  </joint>\n\
  <joint name=\"two\" type=\"revolute\"><origin\n  rpy=\"0.1 0 0.3\"\n  xyz=\"0.1 0.2 0.3\"></origin><parent link=\"root\"/><child link=\"b\"/><axis xyz=\"0 1 0\"/><limit lower=\"-2\" upper=\"2\"/></joint>\n\
  <joint name=\"stay\" type=\"fixed\"><parent link=\"b\"/><child link=\"c\"/></joint>\n\
  <joint name=\"three\" type=\"revolute\"><parent link=\"c\"/><child link=\"d\"/><origin xyz=\"0.3 0 0.1\"/><axis xyz=\"1 0 0\"/><limit lower=\"-2\" upper=\"2\"/></joint>\n\
</robot>\n<!-- the end -->";

#[test]
fn only_origins_of_changed_joints_differ() {
    let model = Robot::from_urdf(TEXT, Some("a"), Some("d")).unwrap();
    let tool = pose::translation(0.1, 0.2, 0.05);
    let model = model.with_tool(tool).unwrap();
    let arm = model.with_errors(2e-3, 0.01, &mut stream(1, 0)).unwrap();
    let qs = model.random_configurations(30, &mut stream(2, 0)).unwrap();
    let measured = Measured::Poses(qs.chunks(3).map(|q| arm.fk(q).unwrap()).collect());
    let options = CalibrationOptions { fit: vec![Part::Offsets, Part::Links], ..CalibrationOptions::default() };
    let found = calibrate(&model, &qs, &measured, &options).unwrap().robot;
    let written = found.urdf_with_geometry(TEXT).unwrap();
    let again = Robot::from_urdf(&written, Some("a"), Some("d")).unwrap().with_tool(tool).unwrap();
    for q in qs.chunks(3) {
        let change = found.fk(q).unwrap().to_homogeneous() - again.fk(q).unwrap().to_homogeneous();
        assert!(change.norm() < 1e-12);
    }
    let without_origins = |text: &str| {
        let mut rest = text.to_owned();
        while let Some(start) = rest.find("<origin") {
            let end = start + rest[start..].find('>').unwrap() + 1;
            rest.replace_range(start..end, "");
        }
        rest.replace("</origin>", "").split_whitespace().collect::<Vec<_>>().join(" ")
    };
    assert_eq!(without_origins(&written), without_origins(TEXT));
    assert!(written.starts_with("\n<?xml version=\"1.0\"?>\r\n<!-- keep me -->\n<robot name='arm'>\n"));
    assert!(written.contains("<joint name=\"stay\" type=\"fixed\"><parent"), "{written}");
}

#[test]
fn a_robot_as_it_was_gives_the_same_bytes() {
    let model = Robot::from_urdf(TEXT, Some("a"), Some("d")).unwrap();
    assert_eq!(model.urdf_with_geometry(TEXT).unwrap(), TEXT);
}

#[test]
fn the_text_of_another_robot_is_refused() {
    let error = Robot::from_urdf(TEXT, Some("root"), Some("a")).unwrap();
    let other = TEXT.replace("0 0 2", "0 1 2");
    assert_eq!(
        error.urdf_with_geometry(&other).unwrap_err().to_string(),
        "URDF: its chain of joints is not that of robot 'arm': give the file that the robot was loaded from"
    );
}
