//! The golden files' switches as parameters.

use serde::Deserialize;
use vodca::params::{BeyondHorizon, Infeasible, Params, Reference, RowChoice, RowStep, Softness, Tie};

/// Switches of the paper's family; names are the files'.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PaperSwitches {
    place: String,
    over: String,
    rows: String,
    tie: String,
    kcmin: usize,
    infeas: String,
    exch: String,
    cold: String,
    odca_f: f64,
    dtol: f64,
    soft: String,
    rho1: f64,
    rho2: f64,
    bias: f64,
    shield: String,
    rshield: f64,
    rmin: Option<f64>,
    h: Option<f64>,
    q: Option<f64>,
    w: Option<f64>,
    umax: Option<f64>,
}

/// Switches of the safe profile; names are the files'.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SafeSwitches {
    h: f64,
    q: f64,
    w: f64,
    umax: f64,
    rv: f64,
    rs: f64,
    rho1: f64,
    rho2: f64,
    theta: f64,
    phi: f64,
    lp: f64,
    fade0: f64,
    fade1: f64,
    ry: f64,
    ryc: f64,
    kappa: f64,
    hard: u8,
    straight: u8,
    #[serde(rename = "yield")]
    give_way: u8,
}

/// Either family.
#[derive(Clone, Debug, Deserialize)]
#[serde(untagged)]
pub enum Switches {
    /// single_step and closed_loop files.
    Paper(Box<PaperSwitches>),
    /// safe_closed_loop files.
    Safe(Box<SafeSwitches>),
}

impl Switches {
    /// The parameters they stand for.
    pub fn params(&self) -> Result<Params, String> {
        match self {
            Switches::Paper(switches) => switches.params(),
            Switches::Safe(switches) => switches.params(),
        }
    }
}

fn choose<T: Copy>(name: &str, value: &str, allowed: &[(&str, T)]) -> Result<T, String> {
    let names: Vec<_> = allowed.iter().map(|(name, _)| *name).collect();
    let found = allowed.iter().find(|(allowed, _)| *allowed == value).map(|(_, choice)| *choice);
    found.ok_or_else(|| format!("switch {name} = {value:?} is not supported; allowed: {}", names.join(", ")))
}

impl PaperSwitches {
    fn params(&self) -> Result<Params, String> {
        choose("exch", &self.exch, &[("jacobi", ())])?;
        choose("cold", &self.cold, &[("none", ())])?;
        if self.dtol != 0.0 {
            return Err(format!("switch dtol = {} is not supported; allowed: 0", self.dtol));
        }
        let mut params = Params::paper();
        let model = &mut params.model;
        model.min_separation = self.rmin.unwrap_or(model.min_separation);
        model.sample_time = self.h.unwrap_or(model.sample_time);
        model.max_speed = self.umax.unwrap_or(model.max_speed);
        params.mpc.state_weight = self.q.unwrap_or(params.mpc.state_weight);
        params.mpc.input_weight = self.w.unwrap_or(params.mpc.input_weight);
        let vodca = &mut params.vodca;
        let steps = [("kc", RowStep::Conflict), ("kc-1", RowStep::BeforeConflict)];
        vodca.row_step = choose("place", &self.place, &steps)?;
        let over = [("clamp", BeyondHorizon::Clamp), ("skip", BeyondHorizon::Skip), ("limit", BeyondHorizon::Limit)];
        vodca.beyond_horizon = choose("over", &self.over, &over)?;
        let rows = [("first", RowChoice::First), ("each", RowChoice::Each), ("odca", RowChoice::Nearby)];
        vodca.rows = choose("rows", &self.rows, &rows)?;
        vodca.tie = choose("tie", &self.tie, &[("nearest", Tie::Nearest), ("index", Tie::Index)])?;
        vodca.first_compared_step = self.kcmin;
        vodca.infeasible = choose("infeas", &self.infeas, &[("hold", Infeasible::Hold), ("relax", Infeasible::Relax)])?;
        vodca.softness = choose("soft", &self.soft, &[("hard", Softness::Hard), ("soft", Softness::Soft)])?;
        vodca.nearby_factor = self.odca_f;
        vodca.turn = self.bias;
        vodca.turn_lasting = self.bias;
        vodca.slack_linear = self.rho1;
        vodca.slack_quadratic = self.rho2;
        params.cell.enabled = choose("shield", &self.shield, &[("none", false), ("bvc", true)])?;
        params.cell.separation = self.rshield;
        Ok(params)
    }
}

impl SafeSwitches {
    fn params(&self) -> Result<Params, String> {
        if self.rv != 1.5 || self.straight != 1 {
            return Err(format!("rv = {}, straight = {} are not supported; allowed: 1.5, 1", self.rv, self.straight));
        }
        let mut params = Params::safe();
        params.mpc.reference = Reference::Straight;
        params.model.sample_time = self.h;
        params.model.max_speed = self.umax;
        params.model.min_separation = self.rv;
        params.mpc.state_weight = self.q;
        params.mpc.input_weight = self.w;
        params.vodca.turn = self.theta;
        params.vodca.turn_lasting = self.theta;
        params.vodca.slack_linear = self.rho1;
        params.vodca.slack_quadratic = self.rho2;
        params.aim.angle = self.phi;
        params.aim.memory = self.lp;
        params.aim.fade_start = self.fade0;
        params.aim.fade_end = self.fade1;
        params.aim.look_ahead = 0;
        params.vodca.patience = 1.0;
        params.give_way.radius = if self.give_way == 1 { self.ry } else { 0.0 };
        params.give_way.clearance = self.ryc;
        params.cell.enabled = self.hard == 1;
        params.cell.separation = self.rs;
        params.cell.escape = self.kappa;
        params.horizon.jitter = 0;
        Ok(params)
    }
}
