"""Made by keywords.py; do not edit."""

from typing import Literal, TypedDict


class Parameters(TypedDict, total=False):
    """Every parameter as a keyword."""

    model_sample_time: float
    """length of a tick; a plan of N steps looks N h ahead (a number above 0, at most 10, s)."""
    model_max_speed: float
    """bound on the input, per axis (a number above 0, at most 100, m/s)."""
    model_min_separation: float
    """centre distance that is kept; discs have half of it as radius; cell.separation follows it unless it is set itself (a number above 0, at most 100, m)."""
    mpc_state_weight: float
    """larger: faster to the reference (a number above 0, at most 1000000, 1/m^2)."""
    mpc_input_weight: float
    """larger: smoother and slower; 1 is worse in dense scenes (a number above 0, at most 1000000, s^2/m^2)."""
    mpc_reference: Literal["set_point", "straight", "route"]
    """straight: no 45 degree start, no slow tail, and a free optimum without a QP; route: the same round obstacles and standing robots, deepest set-points first (set_point, straight, route)."""
    vodca_rows: Literal["first", "each", "nearby"]
    """first: one row as printed; each: one per conflicting hazard; nearby: all near ones at the first conflict (first, each, nearby)."""
    vodca_row_step: Literal["conflict", "before_conflict"]
    """prediction step on which a row acts (conflict, before_conflict)."""
    vodca_beyond_horizon: Literal["clamp", "skip", "limit"]
    """a conflict beyond the new horizon: row at its end, no row, or not looked for (clamp, skip, limit)."""
    vodca_first_compared_step: int
    """2 ignores conflicts that already exist (a whole number in 1..=2, step)."""
    vodca_tie: Literal["nearest", "index"]
    """which hazard `first` takes among equals (nearest, index)."""
    vodca_nearby_factor: float
    """reach of `nearby` as a multiple of model.min_separation (a number in 1..=100)."""
    vodca_turn: float
    """normals turned left: robots pass on the right; smaller: shorter dense paths, more segregation stalls (a number in -1.5..=1.5, rad)."""
    vodca_turn_lasting: float
    """vodca.turn after a long conflict: what small angles leave stuck, large ones resolve (a number in -1.5..=1.5, rad)."""
    vodca_lasting_memory: float
    """share of the newest tick in the memory of how long a conflict has lasted; smaller: the turn grows later (a number above 0, at most 1)."""
    vodca_patience: float
    """a robot whose conflict has lasted for this share of its memory lets everybody pass who has farther to go, wherever it is; 1 is off: some knots of robots near their set-points are never left (a number in 0..=1)."""
    vodca_back_off: float
    """a robot without patience whose conflict has lasted for this share walks off in a random direction now and then; 1 is off: robots that all wait for another one wait for ever; smaller: dense crowds dissolve later (a number in 0..=1)."""
    vodca_softness: Literal["hard", "soft"]
    """soft: rows have slack from the start, the QP is always feasible (hard, soft)."""
    vodca_infeasible: Literal["relax", "hold"]
    """hard rows without a solution: solve again with slack, or stand still (a trap) (relax, hold)."""
    vodca_slack_linear: float
    """exact penalty: with 1e3 rows that could hold are violated in 17 % of problems, with 1e4 never; smaller: shorter dense paths (the cells keep the separation), slower past obstacles (a number in 0..=1000000000, 1/m)."""
    vodca_slack_quadratic: float
    """curvature of the penalty; keeps the QP strictly convex in the slack (a number above 0, at most 1000000000, 1/m^2)."""
    aim_angle: float
    """right turn of the aim that a conflict asks for, and the least that traffic ahead asks for (a number in 0..=1.5, rad)."""
    aim_memory: float
    """share of the newest tick; 1 forgets at once and chatters (a number above 0, at most 1)."""
    aim_fade_start: float
    """nearer to the set-point than this nothing is turned (a number in 0..=1000, m)."""
    aim_fade_end: float
    """farther from the set-point than this the turn is full (a number above 0, at most 1000, m)."""
    aim_look_ahead: int
    """whoever a straight walk will meet within this many steps is traffic ahead, whatever the horizons; 0 is off (a whole number in 0..=1000, step)."""
    aim_most: float
    """largest right turn that traffic ahead asks for; smaller: crowded centres jam, larger: wide ways through boxes (a number in 0..=1.5, rad)."""
    aim_price: float
    """a turn is taken where it spares more meetings than this times its size, if everybody takes it; smaller: quicker through crowded centres, longer paths in boxes (a number in 0..=1000000, 1/rad)."""
    give_way_radius: float
    """robots this near their set-point give way; 0 is off (a number in 0..=1000, m)."""
    give_way_clearance: float
    """added to min_separation while giving way (a number in 0..=100, m)."""
    cell_enabled: bool
    """the guarantee of separation; off: only the rows of vodca (true or false)."""
    cell_separation: float
    """separation guaranteed; left out, it is model.min_separation wherever that one is set; measurement noise of at most E per position needs min_separation + 3 E (a number above 0, at most 100, m)."""
    cell_escape: float
    """move away demanded where the distance is below cell.separation (a number in 0..=10, m/tick)."""
    cell_noise_bound: float
    """measuring errors of at most this leave cell.separation: cells keep 3 E more and demand E more escape (a number in 0..=10, m)."""
    horizon_jitter: int
    """each horizon moves by a seeded draw of at most this, those of a script excepted; breaks limit cycles of fixed horizons (a whole number in 0..=48, step)."""
    episode_arrival_tolerance: float
    """a robot nearer to its set-point than this has arrived (a number above 0, at most 100, m)."""
    episode_collision_factor: float
    """share of min_separation below which two discs count as collided (a number in 0..=1)."""
    controller_kind: Literal["vodca", "orca"]
    """vodca: the MPC; orca: the baseline without plans and without guarantee (vodca, orca)."""
    orca_time_horizon: float
    """longer: earlier and wider avoidance, deadlocks in dense scenes (a number above 0, at most 100, s)."""
    orca_neighbour_distance: float
    """robots farther away are not seen (a number above 0, at most 1000, m)."""
    orca_max_neighbours: int
    """at most so many robots are seen, the nearest first (a whole number in 0..=200, robot)."""
    orca_aim: float
    """every robot aims this far to the right of its set-point (a number in 0..=1.5, rad)."""
    orca_fade: float
    """nearer to the set-point than this the aim fades linearly to none; longer: shorter paths (a number above 0, at most 1000, m)."""
    orca_push: float
    """seeded push of the wanted velocity, uniform over a disc, every tick; 0.3 breaks the deadlock of exact rings (a number in 0..=10, m/s)."""
    disturbance_noise: float
    """largest error of a measured position, uniform over a disc (a number in 0..=10, m)."""
    disturbance_plan_delay: int
    """plans arrive late; positions do not (a whole number in 0..=100, tick)."""
    disturbance_plan_loss: float
    """share of plans that get lost; positions do not (a number in 0..=1)."""
    disturbance_position_loss: float
    """share of messages that get lost whole (a number in 0..=1)."""
