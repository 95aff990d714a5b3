//! One page: its messages come in, answers go out. The latest message of a kind wins; work for an older one ends at its next run.

use crate::kind::{kind, spread};
use crate::limits::shown;
use crate::motion::look;
use crate::protocol::{Answer, Message, Place, Write, read};
use crate::refused::Refused;
use crate::response::{CURVES, Curve, Stale, bare, worst};
use crate::start::Start;
use crate::{branches, texts, tuning};
use retune_model::{Measure, NonNegative};
use retune_study::Study;
use serde_json::{Map, Value};
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicU64, Ordering::SeqCst};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// How long the page is given to draw a motion before its response is computed, and how long a slider rests before what takes longer.
const DRAWN: Duration = Duration::from_millis(12);
const RESTED: Duration = Duration::from_millis(60);

struct Look {
    id: u64,
    place: Place,
    span: Option<[f64; 2]>,
    columns: usize,
    branches: bool,
    quantity: Option<Measure>,
}

struct Pin {
    place: Place,
    quantity: Option<Measure>,
}

#[derive(Default)]
struct Mail {
    look: Option<Look>,
    pins: [Option<Pin>; 2],
    tune: Option<Place>,
    write: Option<Write>,
    ended: bool,
}

/// A page.
pub struct Session<'a> {
    /// What it starts from, until the page begins with another structure.
    start: Mutex<Arc<Start>>,
    /// The same under its own forcing.
    own: Mutex<Arc<Start>>,
    send: &'a (dyn Fn(Answer) -> bool + Sync),
    mail: Mutex<Mail>,
    bell: Condvar,
    /// Counts messages that outdate what is being shown, and those that outdate a tuning.
    shown: AtomicU64,
    tuned: AtomicU64,
}

/// What the page has been sent, and need not be sent again.
#[derive(Default)]
struct Known {
    bare: Option<(Study, Measure)>,
    response: Option<(Study, Measure)>,
    kind: Option<(Study, bool)>,
    spread: Option<(Study, [f64; 2])>,
    branches: Option<Study>,
}

/// Serves a page until `next` has no more messages. `send` is false once the page has gone.
pub fn serve(
    start: &Start,
    send: &(dyn Fn(Answer) -> bool + Sync),
    mut next: impl FnMut() -> Option<String>,
) {
    let (mail, bell, shown, tuned) = Default::default();
    let [begun, own] = [(), ()].map(|()| Mutex::new(Arc::new(start.clone())));
    let session = Session { start: begun, own, send, mail, bell, shown, tuned };
    session.send(start.hello());
    std::thread::scope(|scope| {
        scope.spawn(|| session.shows());
        scope.spawn(|| session.tunes());
        while let Some(text) = next() {
            match read(&text) {
                Ok(message) => session.take(message),
                Err(refused) => session.send(refused.into()),
            }
            if session.mail().ended {
                break;
            }
        }
        session.end();
    });
}

fn locked<T>(of: &Mutex<T>) -> MutexGuard<'_, T> {
    of.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Session<'_> {
    fn mail(&self) -> MutexGuard<'_, Mail> {
        locked(&self.mail)
    }

    fn start(&self) -> Arc<Start> {
        Arc::clone(&locked(&self.start))
    }

    /// Begins anew with another structure: what was asked of the one before is dropped.
    fn begin(&self, structure: &BTreeMap<String, Value>) {
        match Start::own(structure) {
            Err(refused) => self.send(Answer::from(refused).with("own", true)),
            Ok(start) => {
                *locked(&self.own) = Arc::new(start.clone());
                self.go_on(start);
            }
        }
    }

    /// Goes on under a pulse or a record, or again under what the study has.
    fn force(&self, forcing: Option<Map<String, Value>>, text: Option<&str>) {
        let own = Arc::clone(&locked(&self.own));
        let start = match forcing {
            None => Ok((*own).clone()),
            Some(forcing) => own.under(forcing, text),
        };
        match start {
            Err(refused) => self.send(Answer::from(refused).with("force", true)),
            Ok(start) => self.go_on(start),
        }
    }

    /// What was asked of the study before is dropped.
    fn go_on(&self, start: Start) {
        let hello = start.hello();
        *locked(&self.start) = Arc::new(start);
        let mut mail = self.mail();
        *mail = Mail { ended: mail.ended, ..Mail::default() };
        drop(mail);
        self.shown.fetch_add(1, SeqCst);
        self.tuned.fetch_add(1, SeqCst);
        self.send(hello);
    }

    fn send(&self, answer: Answer) {
        if !(self.send)(answer) {
            self.end();
        }
    }

    fn end(&self) {
        self.mail().ended = true;
        self.shown.fetch_add(1, SeqCst);
        self.tuned.fetch_add(1, SeqCst);
        self.bell.notify_all();
    }

    /// Puts a message in the place of an older one of its kind.
    fn take(&self, message: Message) {
        match message {
            Message::Look { id, place, span, columns, branches, quantity } => {
                let mut mail = self.mail();
                mail.look = Some(Look { id, place, span, columns, branches, quantity });
                self.shown.fetch_add(1, SeqCst);
            }
            Message::Pin { slot, place, quantity } => {
                let mut mail = self.mail();
                mail.pins[slot.min(1)] = Some(Pin { place, quantity });
                self.shown.fetch_add(1, SeqCst);
            }
            Message::Tune { place } => {
                let mut mail = self.mail();
                mail.tune = Some(place);
                self.tuned.fetch_add(1, SeqCst);
            }
            Message::Own { structure } => self.begin(&structure),
            Message::Force { forcing, text } => self.force(forcing, text.as_deref()),
            Message::Stop {} => {
                self.tuned.fetch_add(1, SeqCst);
            }
            Message::Write(write) => {
                let mut mail = self.mail();
                mail.write = Some(write);
                self.shown.fetch_add(1, SeqCst);
            }
        }
        self.bell.notify_all();
    }

    /// Waits until `found` finds something in the mail; none at the end.
    fn wait<T>(&self, found: impl Fn(&mut Mail) -> Option<T>) -> Option<T> {
        let mut mail = self.mail();
        loop {
            if mail.ended {
                return None;
            }
            if let Some(work) = found(&mut mail) {
                return Some(work);
            }
            mail = self.bell.wait(mail).unwrap_or_else(PoisonError::into_inner);
        }
    }

    fn shows(&self) {
        enum Work {
            Look(Look),
            Pin(usize, Pin),
            Write(Write),
        }
        // Messages are counted while the mail is held, and so is the count read that tells whether there was another since.
        let work = |mail: &mut Mail| {
            let pin = |mail: &mut Mail| {
                (0..2).find_map(|slot| mail.pins[slot].take().map(|pin| Work::Pin(slot, pin)))
            };
            let write = mail.write.take().map(Work::Write);
            let work = write.or_else(|| mail.look.take().map(Work::Look)).or_else(|| pin(mail))?;
            Some((work, self.shown.load(SeqCst)))
        };
        let mut known = Known::default();
        loop {
            let Some((work, count)) = self.wait(work) else { return };
            let is_stale = || self.shown.load(SeqCst) != count;
            match work {
                // Only with its page: a slider that moves on does not end what is to be saved.
                Work::Write(write) => {
                    let written = texts::written(&self.start(), &write, &|| self.mail().ended);
                    self.send(written.unwrap_or_else(Answer::from));
                }
                Work::Look(look) => {
                    if self.look(&look, &mut known, &is_stale).is_err() {
                        self.mail().look.get_or_insert(look);
                    }
                }
                Work::Pin(slot, pin) => {
                    if self.pin(slot, &pin, &is_stale).is_err() {
                        self.mail().pins[slot].get_or_insert(pin);
                    }
                }
            }
        }
    }

    /// The motion at once, then what takes longer.
    fn look(
        &self,
        asked: &Look,
        known: &mut Known,
        is_stale: &(dyn Fn() -> bool + Sync),
    ) -> Result<(), Stale> {
        let Look { id, place, span, columns, branches: follows, quantity } = asked;
        let send = |answer: Answer| match is_stale() {
            true => Err(Stale),
            false => {
                self.send(answer.with("id", id));
                Ok(())
            }
        };
        let found = self.start().at(place).and_then(|study| {
            let span = shown(&study, *span)?;
            Ok((look(&study, span, *columns)?, span, study))
        });
        let (motion, span, study) = match found {
            Ok(found) => found,
            Err(refused) => return send(refused.into()),
        };
        send(motion)?;
        let design = at_no_frequency(&study);
        let quantity = quantity.unwrap_or_else(|| study.quantity());
        let drawn = (design.clone(), quantity);
        // What the page will be sent of this design replaces what it has of another, in part or as a whole.
        known.response.take_if(|of| *of != drawn);
        known.branches.take_if(|of| *of != design);
        if *follows && known.branches.is_none() {
            send(branches::progress(0))?;
        }
        self.rest(DRAWN, is_stale)?;
        let curve = Curve::of(&study, quantity);
        let without = (at_no_frequency(&bare(&study)), quantity);
        // A motion without a frequency has no response over frequencies.
        let over_band = !study.scene.forcing.is_transient();
        if over_band && known.bare.as_ref() != Some(&without) {
            let curve = Curve::of(&without.0, quantity);
            if curve.is_there() {
                send(curve.answer("none", CURVES[1], is_stale)?)?;
            }
            known.bare = Some(without);
        }
        if over_band && known.response.is_none() {
            send(curve.answer("now", CURVES[0], is_stale)?)?;
        }
        self.rest(RESTED, is_stale)?;
        let irregular = match &known.kind {
            Some((of, irregular)) if *of == study => *irregular,
            _ => {
                let (answer, irregular) = kind(&study);
                send(answer)?;
                known.kind = Some((study.clone(), irregular));
                irregular
            }
        };
        if known.response.is_none() {
            send(worst(&study, "now", is_stale)?)?;
            if over_band {
                send(curve.answer("now", CURVES[1], is_stale)?.with("fine", true))?;
            }
            known.response = Some(drawn);
        }
        if irregular && known.spread.as_ref() != Some(&(study.clone(), span)) {
            send(spread(&study, span, *columns, is_stale)?)?;
            known.spread = Some((study.clone(), span));
        }
        send(Answer::new("done"))?;
        if *follows && known.branches.is_none() {
            let tell = |answer| {
                let _ = send(answer); // a search that is stale ends by itself
            };
            send(branches::follow(&study, &tell, is_stale)?)?;
            known.branches = Some(design);
        }
        Ok(())
    }

    /// Waits a moment: while a hand still moves, the processors belong to what it sees move, not to work that the next place outdates.
    fn rest(&self, time: Duration, is_stale: &dyn Fn() -> bool) -> Result<(), Stale> {
        drop(self.bell.wait_timeout_while(self.mail(), time, |_| !is_stale()));
        if is_stale() { Err(Stale) } else { Ok(()) }
    }

    fn pin(&self, slot: usize, pin: &Pin, is_stale: &(dyn Fn() -> bool + Sync)) -> Result<(), Stale> {
        let whose = ["A", "B"][slot];
        let answer = Answer::new("pinned").with("whose", whose);
        let found =
            self.start().at(&pin.place).and_then(|study| Ok((look(&study, shown(&study, None)?, 1)?, study)));
        let study = match found {
            Ok((run, study)) => {
                self.send(answer.with("figures", run.get("figures")).with("text", run.get("text")));
                study
            }
            Err(Refused { problem, .. }) => {
                self.send(answer.with("problem", problem));
                return Ok(());
            }
        };
        let curve = Curve::of(&study, pin.quantity.unwrap_or_else(|| study.quantity()));
        if !study.scene.forcing.is_transient() {
            self.send(curve.answer(whose, CURVES[1], is_stale)?.with("fine", true));
        }
        self.send(kind(&study).0.with("whose", whose));
        self.send(worst(&study, whose, is_stale)?);
        Ok(())
    }

    fn tunes(&self) {
        loop {
            let tune = |mail: &mut Mail| Some((mail.tune.take()?, self.tuned.load(SeqCst)));
            let Some((place, count)) = self.wait(tune) else { return };
            let is_stale = || self.tuned.load(SeqCst) != count;
            if let Err(refused) = tuning::tune(&self.start(), &place, &|answer| self.send(answer), &is_stale)
            {
                self.send(Answer::from(refused).with("tuning", true));
            }
        }
    }
}

/// The study with the frequency that its response does not depend on taken out.
fn at_no_frequency(study: &Study) -> Study {
    let mut study = study.clone();
    study.scene.forcing.frequency = NonNegative::default();
    study
}
