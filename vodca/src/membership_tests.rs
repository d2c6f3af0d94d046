use super::*;
use proptest::prelude::*;

fn driving(robots: usize) -> Membership {
    let mut team = Membership::new(robots);
    (0..robots).for_each(|robot| assert!(team.join(robot, 1, 0)));
    team
}

/// One whole tick in which only `who` answers in time.
fn tick(team: &mut Membership, number: u64, who: impl Fn(usize) -> bool) {
    team.begin(number);
    for robot in 0..team.members().len() {
        let life = team.members()[robot].life;
        if who(robot) {
            team.hear(robot, life, Some(number));
        } else {
            team.miss(robot);
        }
    }
    team.end();
}

#[test]
fn a_late_robot_is_not_waited_for_and_comes_back_with_the_tick_after_it_spoke() {
    let mut team = driving(2);
    tick(&mut team, 0, |_| true);
    tick(&mut team, 1, |robot| robot == 0);
    assert_eq!(team.members()[1], Member { state: State::Late, life: 1, since: 1 });
    team.begin(2);
    assert_eq!(team.missing(), 1);
    assert_eq!(team.hear(1, 1, Some(1)), Verdict::SignOfLife, "the answer to tick 1 comes too late to count");
    assert_eq!(team.hear(0, 1, Some(2)), Verdict::Counts);
    team.end();
    assert_eq!(team.state(1), State::Back);
    team.begin(3);
    assert_eq!((team.missing(), team.hear(1, 1, Some(3))), (2, Verdict::Counts));
    team.end();
    assert_eq!(team.state(1), State::Driving);
}

#[test]
fn a_lost_robot_comes_back_as_a_later_life_only() {
    let mut team = driving(1);
    team.begin(0);
    assert!(team.lose(0, 0) && !team.lose(0, 0));
    assert_eq!(team.missing(), 0);
    team.end();
    assert!(!team.join(0, 1, 1), "a ghost");
    assert!(team.join(0, 2, 1) && !team.join(0, 3, 1), "one process per robot");
    team.begin(1);
    assert_eq!(team.hear(0, 1, Some(1)), Verdict::Nothing, "a ghost");
    assert_eq!(team.hear(0, 2, Some(0)), Verdict::Nothing, "a foreign tick");
    assert_eq!(team.hear(0, 2, Some(1)), Verdict::Counts);
    assert_eq!(team.hear(0, 2, Some(1)), Verdict::Nothing, "twice");
}

#[test]
fn numbers_lead_back() {
    State::ALL.iter().for_each(|state| assert_eq!(State::from_number(state.number()), Some(*state)));
    assert_eq!(State::from_number(5), None);
}

/// Something that happens to a robot: a message (life, tick), a miss, its end, a new process.
#[derive(Clone, Copy, Debug)]
enum Event {
    Says(u32, Option<u64>),
    Misses,
    Ends,
    Joins(u32),
    NextTick,
}

fn event() -> impl Strategy<Value = Event> {
    prop_oneof![
        (0u32..5, proptest::option::of(0u64..12)).prop_map(|(life, tick)| Event::Says(life, tick)),
        Just(Event::Misses),
        Just(Event::Ends),
        (0u32..5).prop_map(Event::Joins),
        Just(Event::NextTick),
    ]
}

proptest! {
    #[test]
    fn whatever_happens_only_this_tick_and_this_life_count_and_once(
        events in prop::collection::vec((0usize..3, event()), 0..200),
    ) {
        let mut team = driving(3);
        let (mut now, mut counted) = (0, [false; 3]);
        team.begin(0);
        for (robot, event) in events {
            let before = team.members()[robot];
            match event {
                Event::Says(life, tick) => {
                    if team.hear(robot, life, tick) == Verdict::Counts {
                        prop_assert!(before.state.takes_part() && life == before.life && tick == Some(now));
                        prop_assert!(!std::mem::replace(&mut counted[robot], true), "twice");
                    }
                }
                Event::Misses => {
                    prop_assert!(!(team.miss(robot) && counted[robot]), "who has answered does not miss");
                }
                Event::Ends => {
                    team.lose(robot, now);
                    prop_assert_eq!(team.state(robot), State::Lost);
                }
                Event::Joins(life) => {
                    let admitted = team.join(robot, life, now + 1);
                    prop_assert_eq!(admitted, before.state == State::Lost && life > before.life);
                }
                Event::NextTick => {
                    team.end();
                    now += 1;
                    counted = [false; 3];
                    team.begin(now);
                    let waited_for = team.members().iter().filter(|member| member.state.takes_part()).count();
                    prop_assert_eq!(team.missing(), waited_for);
                }
            }
            let after = team.members()[robot];
            prop_assert!(after.life >= before.life, "lives only go on");
            prop_assert!(after.life == before.life || before.state == State::Lost);
            prop_assert!(team.missing() <= 3);
        }
    }
}
