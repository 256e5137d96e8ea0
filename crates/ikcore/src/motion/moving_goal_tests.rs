//! Tests of the moving goal: of its fit to samples, and of its motion between them.

use super::Braking;
use super::goal_scales::Scales;
use super::joint_state::JointState;
use super::moving_goal::{GoalSample, MovingGoal};
use crate::objective::Point;
use crate::rng::{self, LazyRng};

fn scales() -> Scales {
    let braking = Braking { acceleration: 2e-5, jerk: f64::INFINITY };
    Scales::new(&[braking], std::iter::once(3e-3))
}

fn normal(draws: &mut LazyRng) -> f64 {
    (0..12).map(|_| draws.uniform_in(-0.5, 0.5)).sum()
}

/// Moves `goal` on by a tick, in which this sample may arrive.
fn tick(goal: &mut MovingGoal, sample: Option<f64>, scales: &Scales) {
    goal.begin_tick();
    let time = goal.now;
    goal.end_tick(sample.as_ref().map(|q| GoalSample { q: std::slice::from_ref(q), time }), scales);
}

/// The largest error of the goal in the second half of `ticks`, when every `every`-th tick has a sample of `age`.
fn error(path: impl Fn(f64) -> f64, noise: f64, ticks: usize, [every, age]: [usize; 2]) -> f64 {
    let (scales, mut draws) = (scales(), rng::stream(1, 0));
    let mut goal: Option<MovingGoal> = None;
    let mut worst = 0.0_f64;
    for tick in 1..=ticks {
        let now = tick as f64;
        if let Some(goal) = &mut goal {
            goal.begin_tick();
        }
        let time = now - age as f64;
        let value = (tick % every == 0).then(|| path(time) + noise * normal(&mut draws));
        if value.is_some() {
            goal.get_or_insert_with(|| MovingGoal::of_arm(&[0.0], &JointState::at_rest(1), now, time));
        }
        if let Some(goal) = &mut goal {
            goal.end_tick(value.as_ref().map(|q| GoalSample { q: std::slice::from_ref(q), time }), &scales);
        }
        if let Some(goal) = goal.as_ref().filter(|_| tick > ticks / 2) {
            worst = worst.max((goal.q()[0] - path(now)).abs());
        }
    }
    worst
}

#[test]
fn without_noise_the_goal_is_the_sample() {
    assert!(error(|time| 0.2 * (0.002 * time).sin(), 0.0, 2000, [1, 0]) < 1e-15);
}

#[test]
fn noise_is_averaged() {
    let noise = 1e-3;
    let worst = error(|_| 0.4, noise, 3000, [1, 0]);
    assert!(worst < noise, "{worst}");
}

#[test]
fn rare_and_late_samples_of_a_parabola_are_extrapolated() {
    let worst = error(|time| 1e-3 * time - 4e-7 * time * time, 0.0, 2000, [8, 25]);
    assert!(worst < 1e-9, "{worst}");
}

/// The largest error of the goal and the longest way of `path` between two samples, `kept` of which come, one in three ticks.
fn error_with_losses(path: impl Fn(f64) -> f64, noise: f64, kept: impl Fn(usize) -> bool) -> [f64; 2] {
    let (scales, mut draws) = (scales(), rng::stream(2, 0));
    let mut goal = MovingGoal::of_arm(&[path(0.0)], &JointState::at_rest(1), 0.0, 1.0);
    let (mut worst, mut longest, mut last) = (0.0_f64, 0.0_f64, 0.0);
    for i in 1..=3000 {
        let now = i as f64;
        let value = path(now) + noise * normal(&mut draws);
        let comes = i % 3 == 0 && (i < 300 || kept(i / 3));
        tick(&mut goal, comes.then_some(value), &scales);
        last = if comes { now } else { last };
        if i > 300 {
            worst = worst.max((goal.q()[0] - path(now)).abs());
            longest = longest.max((path(last) - path(now)).abs());
        }
    }
    [worst, longest]
}

#[test]
fn the_velocity_of_a_parabola_is_exact_whatever_samples_are_lost() {
    let path = |time: f64| 1e-3 * time - 1e-7 * time * time;
    let scales = scales();
    let mut goal = MovingGoal::of_arm(&[0.0], &JointState::at_rest(1), 0.0, 1.0);
    for i in 1..600 {
        let now = f64::from(i);
        let comes = i < 30 || i * i % 11 < 3 || i % 23 == 0;
        tick(&mut goal, comes.then(|| path(now)), &scales);
        if comes {
            let error = goal.step()[0] - (path(now) - path(now - 1.0));
            assert!(i < 10 || error.abs() < 1e-12, "{error} in tick {i}");
        }
    }
}

#[test]
fn lost_samples_hardly_lengthen_the_interval_and_a_slower_rate_does() {
    let scales = scales();
    let mut goal = MovingGoal::of_arm(&[0.0], &JointState::at_rest(1), 0.0, 1.0);
    let mut sampled = |every: usize, ticks: usize| {
        (1..=ticks).for_each(|i| tick(&mut goal, (i % every == 0).then_some(0.1), &scales));
        goal.interval
    };
    assert_eq!(sampled(3, 60), 3.0);
    let after_gap = sampled(30, 30);
    assert!((3.0..=3.6).contains(&after_gap), "{after_gap}");
    let slower = sampled(30, 900);
    assert!((slower - 30.0).abs() < 1.0, "{slower}");
}

#[test]
fn lost_samples_of_a_noisy_goal_cost_no_more_than_the_gap() {
    let path = |time: f64| 0.2 * (0.008 * time).sin();
    for noise in [0.0, 1e-3, 4e-3] {
        let [without, _] = error_with_losses(path, noise, |_| true);
        for burst in [1, 3, 10] {
            let [worst, gap] = error_with_losses(path, noise, |sample| sample / burst % 4 != 0);
            assert!(worst < 1.1 * (without + gap), "{worst} with losses of {burst}, {without} without, gap {gap}");
        }
    }
}

#[test]
fn what_came_before_the_remembered_samples_is_among_them_also_after_a_gap() {
    let path = |time: f64| 1e-6 * time * time;
    let scales = scales();
    let mut goal = MovingGoal::of_arm(&[0.0], &JointState::at_rest(1), 0.0, 1.0);
    let (mut samples, mut before) = (vec![], Point::new());
    for i in 1..=400 {
        let now = f64::from(i);
        // A gap of ten intervals lets the mean interval grow.
        let comes = i % 8 == 0 && !(200..280).contains(&i);
        tick(&mut goal, comes.then(|| path(now)), &scales);
        if comes {
            samples.push(path(now));
            goal.remembered_from(&scales, &mut before);
            let oldest = samples[samples.len().saturating_sub(3)];
            assert!(i < 24 || (oldest..=path(now)).contains(&before[0]), "{} in tick {i}", before[0]);
        }
    }
}

#[test]
fn a_goal_whose_noise_is_not_known_yet_does_not_run_away_in_a_gap() {
    let (noise, mut squares) = (0.01, 0.0_f64);
    for seed in 0..200 {
        let mut worst = 0.0_f64;
        let (scales, mut draws) = (scales(), rng::stream(seed, 0));
        let mut goal = MovingGoal::of_arm(&[0.0], &JointState::at_rest(1), 0.0, 1.0);
        for i in 1..=400 {
            let comes = i % 10 == 0 && i <= 80;
            tick(&mut goal, comes.then(|| noise * normal(&mut draws)), &scales);
            worst = worst.max(goal.q()[0].abs());
        }
        squares += worst * worst / 200.0;
    }
    assert!(squares.sqrt() < 5.0 * noise, "{}", squares.sqrt());
}

#[test]
fn a_jump_is_taken_over_at_once() {
    let scales = scales();
    let mut goal = MovingGoal::of_arm(&[0.1], &JointState::at_rest(1), 0.0, 1.0);
    for i in 1..40 {
        let q = if i < 30 { 0.1 } else { 0.4 };
        tick(&mut goal, Some(q), &scales);
        assert!((goal.q()[0] - q).abs() < 1e-15 && goal.step()[0].abs() < 1e-15, "tick {i}");
    }
}

#[test]
fn a_goal_without_samples_comes_to_rest() {
    let scales = scales();
    let mut goal = MovingGoal::of_arm(&[0.0], &JointState::at_rest(1), 0.0, 1.0);
    for i in 1..=10 {
        tick(&mut goal, Some(1e-3 * f64::from(i)), &scales);
    }
    let mut steps = vec![];
    for _ in 0..400 {
        tick(&mut goal, None, &scales);
        steps.push(goal.step()[0]);
    }
    assert!(steps[0] > 0.9e-3 && steps[399] == 0.0);
    assert!(steps.windows(2).all(|two| two[1] <= two[0] + 1e-15 && two[0] - two[1] <= 1.1e-5));
}
