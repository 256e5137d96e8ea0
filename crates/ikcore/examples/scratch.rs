use ikcore::limits::*;
use ikcore::math::pose;
use ikcore::nalgebra::Vector3;
use ikcore::path::Reference;
use ikcore::robot::*;
use ikcore::solver::*;
use ikcore::task::*;
use ikcore::tracking::*;
use std::time::Instant;
fn iiwa() -> Robot {
    let mut b = ChainBuilder::new("iiwa", "base");
    let ax = [Vector3::z(), Vector3::y(), Vector3::z(), -Vector3::y(), Vector3::z(), Vector3::y(), Vector3::z()];
    let off = [0., 0.36, 0., 0.42, 0., 0.40, 0.];
    let l = [170., 120., 170., 120., 170., 120., 175.0f64];
    for i in 0..7 {
        let j = b.add_joint(
            Joint::new(format!("j{i}"), JointKind::Revolute).with_range(-l[i].to_radians(), l[i].to_radians()),
        );
        b.fixed(pose::translation(0., 0., off[i]));
        b.moving(j, JointKind::Revolute, ax[i], Drive::DIRECT);
    }
    b.fixed(pose::translation(0., 0., 0.126));
    b.link("tip");
    b.build().unwrap()
}
fn five() -> Robot {
    let mut b = ChainBuilder::new("five", "base");
    for i in 0..5 {
        let j = b.add_joint(Joint::new(format!("j{i}"), JointKind::Revolute).with_range(-3.2, 3.2));
        b.moving(j, JointKind::Revolute, Vector3::z(), Drive::DIRECT);
        b.fixed(pose::translation(1.0, 0., 0.0));
    }
    b.link("tip");
    b.build().unwrap()
}
fn circle(c: [f64; 3], d: f64) -> Reference {
    Reference {
        d: 0.2,
        p: (0..=150)
            .map(|i| {
                let u = 2.0 * std::f64::consts::PI * i as f64 / 150.0;
                [c[0] + d / 2.0 * u.cos(), c[1] + d / 2.0 * u.sin(), c[2]]
            })
            .collect(),
    }
}
fn main() {
    let e7 = [0.5449219327, 0.1036664288, 0.0969337234, -0.8713896072, 0.1027968992, 0.6179441060, 0.0];
    let s7: Vec<f64> = e7.iter().map(|v| v + 0.1).collect();
    let e5 = [0.6697427192, -0.3400667941, -0.2474717864, -0.2588906663, 0.3263813181];
    let s5: Vec<f64> = e5.iter().zip([0.05, 0.05, 0.05, -0.05, 0.05]).map(|(a, b)| a + b).collect();
    let r7 = iiwa();
    let r5 = five();
    let p7 = circle([0.3, 0.3, 1.0], 0.2);
    let p5 = circle([4., 1., 0.], 1.4);
    let bas =
        |v, c1, n| AnySolver::Single(Algorithm::Bas(Bas { variant: v, c1, c2: 1.0, explorations: n, max_passes: 200 }));
    let lm = AnySolver::Single(Algorithm::LevenbergMarquardt(LevenbergMarquardt::default()));
    for (name, r, p, s, h, solver, band) in [
        ("iiwa chain mm", &r7, &p7, &s7, 2.0, bas(Variant::Chain, 1.0, 30), 1e-3),
        ("iiwa star20 mm", &r7, &p7, &s7, 2.0, bas(Variant::Star, 3.0, 20), 1e-3),
        ("iiwa chain 2.2e-5", &r7, &p7, &s7, 2.0, bas(Variant::Chain, 1.0, 30), 2.2e-5),
        ("iiwa star 1.7e-5", &r7, &p7, &s7, 2.0, bas(Variant::Star, 3.0, 50), 1.7e-5),
        ("iiwa greedy 1e-9", &r7, &p7, &s7, 2.0, bas(Variant::Greedy, 3.0, 5), 1e-9),
        ("5 star 4e-5", &r5, &p5, &s5, 0.2, bas(Variant::Star, 1.0, 50), 4e-5),
        ("5 chain 5e-5", &r5, &p5, &s5, 0.2, bas(Variant::Chain, 0.3, 30), 5e-5),
        ("iiwa lm 1e-9", &r7, &p7, &s7, 2.0, lm.clone(), 1e-9),
        ("5 lm 1e-9", &r5, &p5, &s5, 0.2, lm.clone(), 1e-9),
    ] {
        let mut t = vec![];
        let mut ev = 0;
        let mut err = 0.0;
        let mut capped = 0;
        let mut worst = 0.0f64;
        let mut viol = 0.0f64;
        let mut join = 0;
        for seed in 0..20 {
            let lim = Limits::of(r)
                .replace(
                    Field::Velocity,
                    vec![Profile::Sinusoid(Sinusoid { mean: h, amplitude: 0.004, angular_frequency: 1.0, phase: 0.0 })],
                )
                .unwrap();
            let o = TrackOptions {
                solver: solver.clone(),
                tolerance: Tolerance { position: band, rotation: 1e-6 },
                limits: Some(lim),
                seed,
                ..Default::default()
            };
            let t0 = Instant::now();
            let rec = track(r, p, Some(s), &o, &mut Unattended).unwrap();
            t.push(t0.elapsed().as_secs_f64() * 1e3);
            ev = ev.max(rec.evaluations());
            err += rec.position_error[76..].iter().sum::<f64>() / 75.0 / 20.0;
            worst = worst.max(rec.position_error[76..].iter().cloned().fold(0.0, f64::max));
            viol = viol.max(rec.max_violation);
            capped += rec.step_status.iter().filter(|s| **s == Status::Capped).count();
            join = join.max(rec.joined().unwrap_or(999));
        }
        t.sort_by(f64::total_cmp);
        println!(
            "{name:20} {:.3} ms  fk {ev} mean {err:.2e} worst {worst:.2e} capped {capped} viol {viol:.1e} join {join}",
            t[10]
        );
    }
}
