//! `PSO`.

use ikcore::solver::Pso;
use ikcore::solver::{ParticleAcceptance, PsoForm, Walls};
use pyo3::prelude::*;

use super::schedule::{limited, schedule, scheduled, show_schedule};
use crate::error::raise;
use crate::hash::content_hash;
use crate::options::{NewArguments, Shown, keywords};

/// Particle swarm optimisation: needs only values.
///
/// Defaults: `PSO(population=40, form='constriction', c1=2.05, c2=2.05, velocity_limit=0.5, accept='always',
/// walls='absorbing', max_generations=None, stall_generations=50)`.
///
/// Args:
///     population: number of particles.
///     form: "constriction": a factor that follows from c1 + c2 > 4 scales the whole velocity (Clerc and Kennedy 2002);
///         "inertia": a weight scales the old velocity (Shi and Eberhart 1998).
///     inertia: weight of the old velocity, only with form "inertia"; None: 0.729.
///     c1: attraction to the particle's own best point; None: 2.05 with constriction, 1.49445 with inertia.
///     c2: attraction to the swarm's best point; None: the same default as c1.
///     velocity_limit: largest velocity per generation, as a fraction of the box's width; `inf`: no limit.
///     accept: "always": a particle keeps its new position (as published); "improving": it returns to its best position if
///         that is better.
///     walls: "absorbing": a coordinate that would leave the box stops at the wall with zero velocity; "random": it is drawn
///         again inside the box and keeps its velocity (compared by Helwig, Branke and Mostaghim 2013).
///     max_generations: largest number of generations; None: as many as the budget allows.
///     stall_generations: the search ends after this many generations in a row improve the best value by less than a
///         millionth; None: never.
#[pyclass(name = "PSO", module = "beetle_ik", frozen, eq, from_py_object)]
#[derive(Debug, Clone, PartialEq)]
pub struct PyPso(pub Pso);

scheduled!(PyPso);

#[pymethods]
impl PyPso {
    #[new]
    #[pyo3(signature = (*, population=Pso::default().schedule.population.value(), form="constriction", inertia=None, c1=None,
                        c2=None, velocity_limit=Pso::default().velocity_limit, accept="always",
                        walls="absorbing", max_generations=limited(Pso::default().schedule.max_generations).value(),
                        stall_generations=limited(Pso::default().schedule.stall_generations).value()))]
    #[allow(clippy::too_many_arguments)]
    fn new(
        population: i128,
        #[pyo3(from_py_with = crate::convert::text)] form: &str,
        inertia: Option<f64>,
        c1: Option<f64>,
        c2: Option<f64>,
        velocity_limit: f64,
        #[pyo3(from_py_with = crate::convert::text)] accept: &str,
        #[pyo3(from_py_with = crate::convert::text)] walls: &str,
        max_generations: Option<i128>,
        stall_generations: Option<i128>,
    ) -> PyResult<Self> {
        let standard = Pso::of(PsoForm::named(form, inertia).map_err(raise)?);
        let solver = Pso {
            schedule: schedule(population, max_generations, stall_generations)?,
            c1: c1.unwrap_or(standard.c1),
            c2: c2.unwrap_or(standard.c2),
            velocity_limit,
            accept: accept.parse::<ParticleAcceptance>().map_err(raise)?,
            walls: walls.parse::<Walls>().map_err(raise)?,
            ..standard
        };
        solver.validate().map_err(raise)?;
        Ok(Self(solver))
    }

    /// Form of the velocity update: "constriction" or "inertia".
    #[getter]
    fn form(&self) -> String {
        self.0.form.to_string()
    }

    /// Weight of the old velocity; None with constriction.
    #[getter]
    fn inertia(&self) -> Option<f64> {
        match self.0.form {
            PsoForm::Inertia(weight) => Some(weight),
            PsoForm::Constriction => None,
        }
    }

    /// Attraction to the particle's own best point.
    #[getter]
    fn c1(&self) -> f64 {
        self.0.c1
    }

    /// Attraction to the swarm's best point.
    #[getter]
    fn c2(&self) -> f64 {
        self.0.c2
    }

    /// Largest velocity per generation, as a fraction of the box's width.
    #[getter]
    fn velocity_limit(&self) -> f64 {
        self.0.velocity_limit
    }

    /// Rule for accepting a position: "always" or "improving".
    #[getter]
    fn accept(&self) -> String {
        self.0.accept.to_string()
    }

    /// Behaviour at the walls of the box: "absorbing" or "random".
    #[getter]
    fn walls(&self) -> String {
        self.0.walls.to_string()
    }

    fn __repr__(&self) -> String {
        let Pso { schedule, form, c1, c2, velocity_limit, accept, walls } = &self.0;
        let inertia = self.inertia().map_or_else(String::new, |weight| format!("inertia={}, ", weight.text()));
        let [c1, c2, velocity_limit] = [c1, c2, velocity_limit].map(f64::text);
        format!(
            "PSO(population={}, form='{form}', {inertia}c1={c1}, c2={c2}, velocity_limit={velocity_limit}, accept='{accept}', walls='{walls}', {})",
            schedule.population,
            show_schedule(schedule)
        )
    }

    fn __hash__(&self) -> u64 {
        content_hash(self)
    }

    fn __getnewargs_ex__<'py>(slf: &Bound<'py, Self>) -> PyResult<NewArguments<'py>> {
        let own = ["form", "inertia", "c1", "c2", "velocity_limit", "accept", "walls"];
        keywords(slf, &[&["population", "max_generations", "stall_generations"], &own[..]].concat())
    }
}
