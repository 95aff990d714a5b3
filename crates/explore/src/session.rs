//! One page: receives its messages and sends answers. The latest message of a kind wins; work for an older one stops before its next run.

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

/// Delays after sending the motion: before the first response curve, so that the page can draw, and before slower work, until sliders rest.
const DRAW_DELAY: Duration = Duration::from_millis(12);
const IDLE_DELAY: Duration = Duration::from_millis(60);

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
    /// The study in use; replaced when the page chooses another structure or forcing.
    start: Mutex<Arc<Start>>,
    /// The same structure with its own forcing.
    original: Mutex<Arc<Start>>,
    send: &'a (dyn Fn(Answer) -> bool + Sync),
    mail: Mutex<Mail>,
    wake: Condvar,
    /// Counts messages that make the current display stale, and those that make a tuning stale.
    display_count: AtomicU64,
    tuning_count: AtomicU64,
}

/// What the page has been sent and need not be sent again.
#[derive(Default)]
struct Sent {
    bare: Option<(Study, Measure)>,
    response: Option<(Study, Measure)>,
    kind: Option<(Study, bool)>,
    spread: Option<(Study, [f64; 2])>,
    branches: Option<Study>,
}

/// Serves a page until `next` has no more messages. `send` returns false once the page is closed.
pub fn serve(
    start: &Start,
    send: &(dyn Fn(Answer) -> bool + Sync),
    mut next: impl FnMut() -> Option<String>,
) {
    let (mail, wake, display_count, tuning_count) = Default::default();
    let [current, original] = [(), ()].map(|()| Mutex::new(Arc::new(start.clone())));
    let session = Session { start: current, original, send, mail, wake, display_count, tuning_count };
    session.send(start.hello());
    std::thread::scope(|scope| {
        scope.spawn(|| session.run_display());
        scope.spawn(|| session.run_tuning());
        while let Some(text) = next() {
            match read(&text) {
                Ok(message) => session.receive(message),
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

    /// Starts again with another structure; drops all requests for the previous one.
    fn restart(&self, structure: &BTreeMap<String, Value>) {
        match Start::own(structure) {
            Err(refused) => self.send(Answer::from(refused).with("own", true)),
            Ok(start) => {
                *locked(&self.original) = Arc::new(start.clone());
                self.switch_to(start);
            }
        }
    }

    /// Switches to a pulse or a record, or back to the study's own forcing.
    fn force(&self, forcing: Option<Map<String, Value>>, text: Option<&str>) {
        let original = Arc::clone(&locked(&self.original));
        let start = match forcing {
            None => Ok((*original).clone()),
            Some(forcing) => original.under(forcing, text),
        };
        match start {
            Err(refused) => self.send(Answer::from(refused).with("force", true)),
            Ok(start) => self.switch_to(start),
        }
    }

    /// Switches to another study and drops all requests for the previous one.
    fn switch_to(&self, start: Start) {
        let hello = start.hello();
        *locked(&self.start) = Arc::new(start);
        let mut mail = self.mail();
        *mail = Mail { ended: mail.ended, ..Mail::default() };
        drop(mail);
        self.display_count.fetch_add(1, SeqCst);
        self.tuning_count.fetch_add(1, SeqCst);
        self.send(hello);
    }

    fn send(&self, answer: Answer) {
        if !(self.send)(answer) {
            self.end();
        }
    }

    fn end(&self) {
        self.mail().ended = true;
        self.display_count.fetch_add(1, SeqCst);
        self.tuning_count.fetch_add(1, SeqCst);
        self.wake.notify_all();
    }

    /// Stores a message, replacing an older one of its kind.
    fn receive(&self, message: Message) {
        match message {
            Message::Look { id, place, span, columns, branches, quantity } => {
                let mut mail = self.mail();
                mail.look = Some(Look { id, place, span, columns, branches, quantity });
                self.display_count.fetch_add(1, SeqCst);
            }
            Message::Pin { slot, place, quantity } => {
                let mut mail = self.mail();
                mail.pins[slot.min(1)] = Some(Pin { place, quantity });
                self.display_count.fetch_add(1, SeqCst);
            }
            Message::Tune { place } => {
                let mut mail = self.mail();
                mail.tune = Some(place);
                self.tuning_count.fetch_add(1, SeqCst);
            }
            Message::Own { structure } => self.restart(&structure),
            Message::Force { forcing, text } => self.force(forcing, text.as_deref()),
            Message::Stop {} => {
                self.tuning_count.fetch_add(1, SeqCst);
            }
            Message::Write(write) => {
                let mut mail = self.mail();
                mail.write = Some(write);
                self.display_count.fetch_add(1, SeqCst);
            }
        }
        self.wake.notify_all();
    }

    /// Waits until `found` finds work in the mail; none when the session ends.
    fn wait<T>(&self, found: impl Fn(&mut Mail) -> Option<T>) -> Option<T> {
        let mut mail = self.mail();
        loop {
            if mail.ended {
                return None;
            }
            if let Some(work) = found(&mut mail) {
                return Some(work);
            }
            mail = self.wake.wait(mail).unwrap_or_else(PoisonError::into_inner);
        }
    }

    fn run_display(&self) {
        enum Work {
            Look(Look),
            Pin(usize, Pin),
            Write(Write),
        }
        // The counter is read and increased only while the mail is locked, so a later message always makes this work stale.
        let work = |mail: &mut Mail| {
            let pin = |mail: &mut Mail| {
                (0..2).find_map(|slot| mail.pins[slot].take().map(|pin| Work::Pin(slot, pin)))
            };
            let write = mail.write.take().map(Work::Write);
            let work = write.or_else(|| mail.look.take().map(Work::Look)).or_else(|| pin(mail))?;
            Some((work, self.display_count.load(SeqCst)))
        };
        let mut already_sent = Sent::default();
        loop {
            let Some((work, count)) = self.wait(work) else { return };
            let is_stale = || self.display_count.load(SeqCst) != count;
            match work {
                // Cancelled only when the page closes: moving a slider must not cancel a file to be saved.
                Work::Write(write) => {
                    let written = texts::written(&self.start(), &write, &|| self.mail().ended);
                    self.send(written.unwrap_or_else(Answer::from));
                }
                Work::Look(look) => {
                    if self.look(&look, &mut already_sent, &is_stale).is_err() {
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

    /// Sends the motion at once, then what takes longer.
    fn look(
        &self,
        request: &Look,
        already_sent: &mut Sent,
        is_stale: &(dyn Fn() -> bool + Sync),
    ) -> Result<(), Stale> {
        let Look { id, place, span, columns, branches: wants_branches, quantity } = request;
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
        let response_key = (design.clone(), quantity);
        // From here on the page may hold parts of this design, so results of another one no longer count as sent.
        already_sent.response.take_if(|of| *of != response_key);
        already_sent.branches.take_if(|of| *of != design);
        if *wants_branches && already_sent.branches.is_none() {
            send(branches::progress(0))?;
        }
        self.pause(DRAW_DELAY, is_stale)?;
        let curve = Curve::of(&study, quantity);
        let without = (at_no_frequency(&bare(&study)), quantity);
        // A transient forcing has no response over frequencies.
        let over_band = !study.scene.forcing.is_transient();
        if over_band && already_sent.bare.as_ref() != Some(&without) {
            let curve = Curve::of(&without.0, quantity);
            if curve.is_there() {
                send(curve.answer("none", CURVES[1], is_stale)?)?;
            }
            already_sent.bare = Some(without);
        }
        if over_band && already_sent.response.is_none() {
            send(curve.answer("now", CURVES[0], is_stale)?)?;
        }
        self.pause(IDLE_DELAY, is_stale)?;
        let irregular = match &already_sent.kind {
            Some((of, irregular)) if *of == study => *irregular,
            _ => {
                let (answer, irregular) = kind(&study);
                send(answer)?;
                already_sent.kind = Some((study.clone(), irregular));
                irregular
            }
        };
        if already_sent.response.is_none() {
            send(worst(&study, "now", is_stale)?)?;
            if over_band {
                send(curve.answer("now", CURVES[1], is_stale)?.with("fine", true))?;
            }
            already_sent.response = Some(response_key);
        }
        if irregular && already_sent.spread.as_ref() != Some(&(study.clone(), span)) {
            send(spread(&study, span, *columns, is_stale)?)?;
            already_sent.spread = Some((study.clone(), span));
        }
        send(Answer::new("done"))?;
        if *wants_branches && already_sent.branches.is_none() {
            let report = |answer| {
                let _ = send(answer); // a stale search ends by itself
            };
            send(branches::follow(&study, &report, is_stale)?)?;
            already_sent.branches = Some(design);
        }
        Ok(())
    }

    /// Waits, unless the work becomes stale: while a slider moves, the cores compute the motion, not results that will be stale at once.
    fn pause(&self, time: Duration, is_stale: &dyn Fn() -> bool) -> Result<(), Stale> {
        drop(self.wake.wait_timeout_while(self.mail(), time, |_| !is_stale()));
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

    fn run_tuning(&self) {
        loop {
            let tune = |mail: &mut Mail| Some((mail.tune.take()?, self.tuning_count.load(SeqCst)));
            let Some((place, count)) = self.wait(tune) else { return };
            let is_stale = || self.tuning_count.load(SeqCst) != count;
            if let Err(refused) = tuning::tune(&self.start(), &place, &|answer| self.send(answer), &is_stale)
            {
                self.send(Answer::from(refused).with("tuning", true));
            }
        }
    }
}

/// The study with its frequency set to zero, since its response curve does not depend on it.
fn at_no_frequency(study: &Study) -> Study {
    let mut study = study.clone();
    study.scene.forcing.frequency = NonNegative::default();
    study
}
