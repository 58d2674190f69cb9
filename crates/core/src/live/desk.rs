/*!
The desk between those who want pictures and the thread that draws them.

There is room for one view and one content on it: what is put down replaces what lay there. So the
thread always takes what is latest, and views that come faster than it can draw cost nothing but the
moment in which they lie on the desk. Whoever has nothing to do sleeps on a condition variable.
*/

use crate::{Error, Scene, View};
use std::{
    sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError},
    time::Instant,
};

/// A scene and its bricks.
pub(super) struct Shown<R, G> {
    pub(super) scene: Arc<Scene<R>>,
    pub(super) bricks: Arc<G>,
}

/// A picture to draw.
pub(super) struct Task<R, G> {
    pub(super) content: Shown<R, G>,
    pub(super) view: View,
    /// When it was asked for.
    pub(super) asked: Instant,
}

/// What the drawing thread has to know between two steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Call {
    /// Nobody wants anything else.
    GoOn,
    /// Another picture is wanted.
    Turn,
    /// Nothing is wanted any more.
    Stop,
}

pub(super) struct Desk<R, G> {
    state: Mutex<State<R, G>>,
    /// There is something new for the drawing thread.
    called: Condvar,
    /// The drawing thread has nothing to do, or has ended.
    idle: Condvar,
}

struct State<R, G> {
    content: Shown<R, G>,
    /// The latest view, which may be drawn already.
    view: Option<View>,
    /// When a picture was asked for that is not begun.
    asked: Option<Instant>,
    is_drawing: bool,
    is_stopping: bool,
    /// What the drawing thread panicked with.
    panic: Option<String>,
}

impl<R, G> Desk<R, G> {
    pub(super) fn new(content: Shown<R, G>) -> Self {
        let state = State {
            content,
            view: None,
            asked: None,
            is_drawing: false,
            is_stopping: false,
            panic: None,
        };
        Self { state: Mutex::new(state), called: Condvar::new(), idle: Condvar::new() }
    }

    /// Asks for a picture: with another content, from another view, or both.
    pub(super) fn ask(
        &self,
        mut content: Option<Shown<R, G>>,
        view: Option<View>,
    ) -> Result<(), Error> {
        let now = Instant::now();
        let mut state = self.lock();
        state.alive()?;
        if let Some(content) = &mut content {
            std::mem::swap(&mut state.content, content);
        }
        if view.is_some() {
            state.view = view;
        }
        if state.view.is_some() {
            state.asked = Some(now);
        }
        drop(state);
        self.called.notify_one();
        // The content from before goes only now. It may be large, and nobody shall wait for that.
        drop(content);
        Ok(())
    }

    /// Waits for the next picture to draw; `None` when there will be no more.
    pub(super) fn take(&self) -> Option<Task<R, G>> {
        let mut state = self.lock();
        loop {
            if state.is_stopping {
                return None;
            }
            if let Some(task) = state.task() {
                state.is_drawing = true;
                return Some(task);
            }
            state.is_drawing = false;
            self.idle.notify_all();
            state = self.called.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }

    pub(super) fn call(&self) -> Call {
        let state = self.lock();
        match (state.is_stopping, state.asked) {
            (true, _) => Call::Stop,
            (false, Some(_)) => Call::Turn,
            (false, None) => Call::GoOn,
        }
    }

    /// Asks the drawing thread to end.
    pub(super) fn stop(&self) {
        self.lock().is_stopping = true;
        self.called.notify_one();
    }

    /// Notes what the drawing thread panicked with.
    pub(super) fn fail(&self, panic: String) {
        self.lock().panic = Some(panic);
        self.idle.notify_all();
    }

    /// Waits until the drawing thread has nothing to do.
    pub(super) fn wait_idle(&self) -> Result<(), Error> {
        let mut state = self.lock();
        loop {
            state.alive()?;
            if !state.is_drawing && state.asked.is_none() {
                return Ok(());
            }
            state = self.idle.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// Nothing that could panic half way is done while this is held, so poison would say nothing.
    fn lock(&self) -> MutexGuard<'_, State<R, G>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl<R, G> State<R, G> {
    fn alive(&self) -> Result<(), Error> {
        let panicked = |message: &String| Error::DrawingPanicked { message: message.clone() };
        self.panic.as_ref().map_or(Ok(()), |message| Err(panicked(message)))
    }

    /// The picture that is asked for.
    fn task(&mut self) -> Option<Task<R, G>> {
        let (asked, view) = (self.asked.take()?, self.view.clone()?);
        Some(Task { content: self.content.clone(), view, asked })
    }
}

impl<R, G> Clone for Shown<R, G> {
    fn clone(&self) -> Self {
        Self { scene: Arc::clone(&self.scene), bricks: Arc::clone(&self.bricks) }
    }
}
