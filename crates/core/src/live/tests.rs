//! Pictures in the background, with a renderer that does as it is told and tells what it does.

mod fake;

use super::*;
use fake::{
    BAD_BEGIN, BAD_DRAW, Call, Fake, FakeLive, Fault, PANIC_BEGIN, PANIC_DRAW, PANIC_STAGE,
    PANIC_TOLD, Told, content, spawn, view,
};
use proptest::prelude::*;
use std::sync::{
    Mutex,
    mpsc::{RecvTimeoutError, channel},
};

/// What is to be told, by the rules of the [module](super).
struct Twin {
    bricks: u64,
    has_memory: bool,
    has_drawn: bool,
    /// The view that is drawn, what is left of it, whether nothing was told of it, and whether it
    /// may be left.
    now: Option<(u32, u64, bool, bool)>,
    latest: Option<u32>,
}

impl Twin {
    /// The next thing told, if any.
    fn next(&mut self) -> Option<Told> {
        if let Some((_, left, _, may_leave)) = self.now
            && (left == 0 || (may_leave && self.latest.is_some()))
        {
            self.now = None;
        }
        let begun = || self.latest.take().map(|width| (width, self.bricks, true, false));
        let (width, left, is_first, _) = self.now.take().or_else(begun)?;
        let only_recalls = is_first && self.has_memory && self.has_drawn && left > 0;
        let left = if only_recalls { left } else { left.saturating_sub(1) };
        self.has_drawn |= self.bricks > 0;
        self.now = Some((width, left, false, !only_recalls));
        Some(Told { width, left: Ok(left), has_latency: is_first })
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// However many views come at each step: what is drawn is what the rules say, and the latest
    /// view is drawn to its end.
    #[test]
    fn the_latest_view_wins(
        looks in prop::collection::vec(prop_oneof![Just(0_u32), 0_u32..4], 0..30),
        bricks in 0_u32..6,
        has_memory in any::<bool>(),
    ) {
        let (fake, calls) = Fake::new();
        let (scene, list) = content(bricks);
        let (tell, told) = channel();
        let (go, may_go) = channel();
        let pipeline = Pipeline::new((), Fake { has_memory, ..fake });
        let live = Live::spawn(scene, list, pipeline, 1, move |step| {
            tell.send(Told::of(step)).ok();
            may_go.recv().ok();
        }).unwrap();
        let go = go; // It is dropped before the thread is waited for, also if this fails.
        let (mut twin, mut width, mut begun) = (
            Twin { bricks: bricks.into(), has_memory, has_drawn: false, now: None, latest: None },
            0,
            Vec::new(),
        );
        let mut looks = looks.into_iter();
        let mut look = |count: u32, twin: &mut Twin| for _ in 0..count {
            width += 1;
            live.look(view(width)).unwrap();
            twin.latest = Some(width);
        };
        while let Some(count) = looks.next() {
            // The thread sleeps. It would take the first of several views, or a later one.
            look(count.min(1), &mut twin);
            while let Some(expected) = twin.next() {
                // Long enough to say that it hangs.
                let step = told.recv_timeout(Duration::from_secs(60)).unwrap();
                prop_assert_eq!(&step, &expected);
                if step.has_latency {
                    begun.push(Call::Begin(step.width));
                }
                look(looks.next().unwrap_or(0), &mut twin);
                go.send(()).unwrap();
            }
            live.wait_idle().unwrap();
            prop_assert!(told.try_recv().is_err());
        }
        let calls = calls.try_iter().filter(|call| matches!(call, Call::Begin(_)));
        prop_assert_eq!(calls.collect::<Vec<_>>(), begun);
    }
}

#[test]
fn what_is_overtaken_is_never_begun() {
    let (fake, calls, gate) = Fake::gated();
    let (live, told) = spawn(fake, 3);
    let gate = gate; // It is dropped before the thread is waited for, also if a test fails.
    live.look(view(1)).unwrap();
    assert_eq!([calls.recv(), calls.recv()], [Ok(Call::Begin(1)), Ok(Call::Draw(1, 3))]);
    // It is in the midst of drawing.
    (2..=1000).for_each(|width| live.look(view(width)).unwrap());
    drop(gate);
    live.wait_idle().unwrap();
    let draw = Call::Draw(1000, 3);
    assert_eq!(calls.try_iter().collect::<Vec<_>>(), [Call::Begin(1000), draw, draw, draw]);
    let told: Vec<_> = told.try_iter().map(|step| (step.width, step.left.unwrap())).collect();
    assert_eq!(told, [(1, 2), (1000, 2), (1000, 1), (1000, 0)]);
}

#[test]
fn dropping_ends_it_at_the_next_step() {
    for has_successor in [false, true] {
        let (fake, calls, gate) = Fake::gated();
        let (live, told) = spawn(fake, 1000);
        let gate = gate;
        live.look(view(1)).unwrap();
        assert_eq!([calls.recv(), calls.recv()], [Ok(Call::Begin(1)), Ok(Call::Draw(1, 1000))]);
        if has_successor {
            live.look(view(2)).unwrap();
        }
        let desk = Arc::clone(&live.desk);
        let drop_it = thread::spawn(move || drop(live));
        while desk.call() != desk::Call::Stop {
            thread::yield_now();
        }
        drop(gate);
        drop_it.join().unwrap();
        assert_eq!(told.iter().count(), 1);
        assert_eq!(calls.iter().count(), 0);
    }
}

#[test]
fn dropping_it_within_a_step_does_not_wait_for_itself() {
    let (fake, calls) = Fake::new();
    let (scene, bricks) = content(1000);
    let slot: Arc<Mutex<Option<FakeLive>>> = Arc::default();
    let mine = Arc::clone(&slot);
    let (tell, told) = channel();
    let live = Live::spawn(scene, bricks, Pipeline::new((), fake), 1, move |_| {
        drop(mine.lock().unwrap().take());
        tell.send(()).ok();
    });
    let mut guard = slot.lock().unwrap();
    guard.insert(live.unwrap()).look(view(1)).unwrap();
    drop(guard);
    // The calls end with the thread that makes them.
    assert_eq!(calls.iter().collect::<Vec<_>>(), [Call::Begin(1), Call::Draw(1, 1000)]);
    assert_eq!(told.iter().count(), 1, "it has not panicked");
}

#[test]
fn without_a_view_nothing_is_drawn() {
    let (fake, calls) = Fake::new();
    let (live, told) = spawn(fake, 3);
    let (scene, bricks) = content(2);
    live.wait_idle().unwrap();
    live.show(scene, bricks).unwrap();
    live.wait_idle().unwrap();
    drop(live);
    assert_eq!((calls.iter().count(), told.iter().count()), (0, 0));
}

#[test]
fn errors_are_told_and_the_next_view_is_drawn() {
    let (fake, calls) = Fake::new();
    let (live, told) = spawn(fake, 2);
    let step = |width, left, has_latency| Told { width, left, has_latency };
    for (bad, fault) in [(BAD_BEGIN, Fault::Begin), (BAD_DRAW, Fault::Draw)] {
        live.look(view(bad)).unwrap();
        live.wait_idle().unwrap();
        assert_eq!(told.try_iter().collect::<Vec<_>>(), [step(bad, Err(fault), true)]);
        live.look(view(5)).unwrap();
        live.wait_idle().unwrap();
        let good = [step(5, Ok(1), true), step(5, Ok(0), false)];
        assert_eq!(told.try_iter().collect::<Vec<_>>(), good);
    }
    // Bricks of another scene, and then that scene.
    let ((_, bricks), (scene, _)) = (content(3), content(2));
    live.show(scene, Arc::clone(&bricks)).unwrap();
    live.wait_idle().unwrap();
    let fault = Fault::Core(Error::BrickRange { brick: 2, start: 2, end: 3, records: 2 });
    assert_eq!(told.try_iter().collect::<Vec<_>>(), [step(5, Err(fault), true)]);
    live.show(content(3).0, bricks).unwrap();
    live.wait_idle().unwrap();
    assert_eq!(told.try_iter().last(), Some(step(5, Ok(0), false)));
    assert_eq!(calls.try_iter().last(), Some(Call::Draw(5, 3)));
}

#[test]
fn after_a_panic_nobody_is_left_waiting() {
    let all = [
        (PANIC_BEGIN, "begin 7003"),
        (PANIC_DRAW, "draw"),
        (PANIC_STAGE, "stage"),
        (PANIC_TOLD, "told"),
    ];
    for (width, says) in all {
        let (fake, _calls) = Fake::new();
        let (live, told) = spawn(fake, 2);
        thread::scope(|scope| {
            live.look(view(width)).unwrap();
            let other = scope.spawn(|| live.wait_idle());
            let (here, there) = (live.wait_idle(), other.join().unwrap());
            assert_eq!(here, there);
            let Err(Error::DrawingPanicked { message }) = here else { panic!("{here:?}") };
            assert!(message.contains(says), "{message}");
        });
        let (scene, bricks) = content(1);
        let panicked = |result| matches!(result, Err(Error::DrawingPanicked { .. }));
        assert!(panicked(live.look(view(1))));
        assert!(panicked(live.show(scene.clone(), bricks.clone())));
        assert!(panicked(live.show_from(scene, bricks, view(1))));
        // What the thread held is gone, and dropping does not wait.
        assert_eq!(told.recv_timeout(Duration::from_secs(60)), Err(RecvTimeoutError::Disconnected));
        drop(live);
    }
}

#[test]
fn scenes_are_exchanged_at_the_next_step_and_let_go() {
    let (fake, calls, gate) = Fake::gated();
    let (scene, bricks) = content(3);
    let (old, old_bricks) = (Arc::downgrade(&scene), Arc::downgrade(&bricks));
    let live = Live::spawn(scene, bricks, Pipeline::new((), fake), 1, |_| ()).unwrap();
    let gate = gate;
    live.look(view(1)).unwrap();
    assert_eq!([calls.recv(), calls.recv()], [Ok(Call::Begin(1)), Ok(Call::Draw(1, 3))]);
    // What is overtaken before it is begun is let go at once, what is being drawn is not.
    let (scene, bricks) = content(7);
    let overtaken = Arc::downgrade(&scene);
    live.show(scene, bricks).unwrap();
    let (scene, bricks) = content(2);
    live.show_from(scene, bricks, view(2)).unwrap();
    assert!(overtaken.upgrade().is_none());
    assert!(old.upgrade().is_some() && old_bricks.upgrade().is_some());
    drop(gate);
    live.wait_idle().unwrap();
    let draw = Call::Draw(2, 2);
    assert_eq!(calls.try_iter().collect::<Vec<_>>(), [Call::Begin(2), draw, draw]);
    assert!(old.upgrade().is_none() && old_bricks.upgrade().is_none());
    // Without a new view, the one that there is.
    let (scene, bricks) = content(1);
    live.show(scene, bricks).unwrap();
    live.wait_idle().unwrap();
    assert_eq!(calls.try_iter().collect::<Vec<_>>(), [Call::Begin(2), Call::Draw(2, 1)]);
}

#[test]
fn the_renderer_can_be_used_and_replaced_within_a_step() {
    let (fake, calls) = Fake::new();
    let (scene, bricks) = content(1);
    let (tell, told) = channel();
    let live = Live::spawn(scene, bricks, Pipeline::new((), fake), 1, move |step| {
        if step.progress.is_err() {
            let calls = step.renderer.calls.clone();
            *step.renderer = Fake { calls, ..Fake::new().0 };
        }
        tell.send(step.picture().map(|picture| picture.width)).ok();
    });
    let live = live.unwrap();
    for width in [BAD_DRAW, 3] {
        live.look(view(width)).unwrap();
        live.wait_idle().unwrap();
    }
    assert_eq!(told.try_iter().collect::<Vec<_>>(), [Err(Fault::Draw), Ok(3)]);
    assert_eq!(calls.try_iter().count(), 4);
}

/// Where Linux tells what the calling thread does.
#[cfg(target_os = "linux")]
fn state() -> impl Fn() -> char {
    let thread =
        std::path::Path::new("/proc").join(std::fs::read_link("/proc/thread-self").unwrap());
    move || {
        let line = std::fs::read_to_string(thread.join("stat")).unwrap();
        line[line.rfind(')').unwrap()..].chars().nth(2).unwrap()
    }
}

#[cfg(target_os = "linux")]
#[test]
fn the_thread_sleeps_when_nothing_is_left() {
    let (fake, calls) = Fake::new();
    let (scene, bricks) = content(3);
    let (tell, told) = channel();
    let live = Live::spawn(scene, bricks, Pipeline::new((), fake), 1, move |_| {
        tell.send(state()).ok();
    });
    let live = live.unwrap();
    live.look(view(1)).unwrap();
    live.wait_idle().unwrap();
    assert_eq!(calls.try_iter().count(), 4);
    let state = told.try_iter().last().unwrap();
    // It may have to go to sleep yet. From then on it does not wake up.
    while state() != 'S' {
        thread::yield_now();
    }
    for _ in 0..200 {
        assert_eq!(state(), 'S');
        thread::sleep(Duration::from_micros(100));
    }
    assert_eq!(calls.try_iter().count(), 0);
}
