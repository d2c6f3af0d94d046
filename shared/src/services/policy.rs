//! The two services between coordinator and policy server. They exist only in runs with a policy.

use super::{EventListener, EventNotifier, Maker, Receiver, Role, Sender, ServiceError};
use crate::messages::{Observation, PolicyAnswer};
use crate::runtime_dir::RuntimeDir;
use std::time::Duration;

const OBSERVATIONS: &str = "vodca/policy/observations";
const ANSWERS: &str = "vodca/policy/answers";
const ASK_BELL: &str = "vodca/policy/ask";
const ANSWER_BELL: &str = "vodca/policy/answer";

/// The coordinator's end: asks and hears answers.
#[derive(Debug)]
pub struct PolicyAsker {
    questions: Sender<Observation>,
    notifier: EventNotifier,
    answers: Receiver<PolicyAnswer>,
    listener: EventListener,
}

impl PolicyAsker {
    /// Makes the services of a run.
    pub fn create(place: &RuntimeDir) -> Result<Self, ServiceError> {
        let services = PolicyServices::new(place, Role::Create)?;
        Ok(Self {
            questions: Sender::new(&services.observations, place)?,
            notifier: EventNotifier::new(&services.ask_bell, place)?,
            answers: Receiver::new(&services.answers, place)?,
            listener: EventListener::new(&services.answer_bell, place)?,
        })
    }

    /// Publishes an observation and wakes the server.
    pub fn ask(&self, observation: Observation) -> Result<(), ServiceError> {
        self.questions.send(observation)?;
        self.notifier.ring()
    }

    /// The next unread answer; `None`: nothing there.
    pub fn receive(&self) -> Result<Option<PolicyAnswer>, ServiceError> {
        Ok(self.answers.receive()?.map(|answer| *answer))
    }

    /// Waits until something may have been answered, a signal came, or `limit` has passed.
    pub fn wait(&self, limit: Duration) -> Result<(), ServiceError> {
        self.listener.wait(limit)
    }
}

/// The policy server's end: hears observations and answers.
#[derive(Debug)]
pub struct PolicyPort {
    questions: Receiver<Observation>,
    listener: EventListener,
    answers: Sender<PolicyAnswer>,
    notifier: EventNotifier,
}

impl PolicyPort {
    /// Opens the services that the coordinator made.
    pub fn open(place: &RuntimeDir) -> Result<Self, ServiceError> {
        let services = PolicyServices::new(place, Role::Open)?;
        Ok(Self {
            questions: Receiver::new(&services.observations, place)?,
            listener: EventListener::new(&services.ask_bell, place)?,
            answers: Sender::new(&services.answers, place)?,
            notifier: EventNotifier::new(&services.answer_bell, place)?,
        })
    }

    /// The newest unread observation: an older one is too late for anybody.
    pub fn newest(&self) -> Result<Option<Observation>, ServiceError> {
        let mut newest = None;
        while let Some(observation) = self.questions.receive()? {
            newest = Some(*observation);
        }
        Ok(newest)
    }

    /// Publishes an answer and wakes the coordinator.
    pub fn answer(&self, answer: PolicyAnswer) -> Result<(), ServiceError> {
        self.answers.send(answer)?;
        self.notifier.ring()
    }

    /// Waits until something may have been asked, a signal came, or `limit` has passed.
    pub fn wait(&self, limit: Duration) -> Result<(), ServiceError> {
        self.listener.wait(limit)
    }
}

struct PolicyServices {
    observations: super::Channel<Observation>,
    answers: super::Channel<PolicyAnswer>,
    ask_bell: super::Alarm,
    answer_bell: super::Alarm,
}

impl PolicyServices {
    fn new(place: &RuntimeDir, role: Role) -> Result<Self, ServiceError> {
        // One coordinator and one server; a server killed and started again takes another of the
        // few places, because nobody cleans up during a run.
        let maker = Maker::new(place, 1, role)?;
        Ok(Self {
            observations: maker.channel(OBSERVATIONS, maker.few, maker.few)?,
            answers: maker.channel(ANSWERS, maker.few, maker.few)?,
            ask_bell: maker.notifier(ASK_BELL, maker.few, maker.few)?,
            answer_bell: maker.notifier(ANSWER_BELL, maker.few, maker.few)?,
        })
    }
}
