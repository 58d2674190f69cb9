/*!
A feed: a reader on a thread of its own, which hands over chunks one by one.

A reader pushes rows, and whoever uses a source pulls them: the thread lets both go their way. The
reader is at most two chunks ahead. What goes wrong, a panic too, arrives behind all chunks before
it. When a feed is dropped, the reader meets an error at its next read or chunk and ends.
*/

use crate::{
    builder::Outlet,
    error::{ErrorKind, Fault},
};
use puncta_core::Scene;
use std::{
    sync::{
        Arc,
        mpsc::{self, Receiver},
    },
    thread::{self, JoinHandle},
};

/// How many chunks wait to be taken, besides the one in the making.
const WAITING: usize = 1;

/// Chunks from a reader on another thread.
#[derive(Debug)]
pub(crate) struct Feed {
    chunks: Option<Receiver<Scene>>,
    /// What the reader looks at to see whether this feed still lives.
    wanted: Option<Arc<()>>,
    reader: Option<JoinHandle<Result<(), Fault>>>,
}

impl Feed {
    /// Starts a reader that puts chunks into the outlet it is given.
    pub(crate) fn start(
        read: impl FnOnce(Outlet) -> Result<(), Fault> + Send + 'static,
    ) -> Result<Self, Fault> {
        let (sender, chunks) = mpsc::sync_channel(WAITING);
        let wanted = Arc::new(());
        let outlet = Outlet { sender, wanted: Arc::downgrade(&wanted) };
        let reader =
            thread::Builder::new().name("puncta-io".to_owned()).spawn(move || read(outlet))?;
        Ok(Self { chunks: Some(chunks), wanted: Some(wanted), reader: Some(reader) })
    }

    /// The next chunk; `None` at the end, and behind an error.
    pub(crate) fn next(&mut self) -> Result<Option<Scene>, Fault> {
        let chunk = self.chunks.as_ref().and_then(|chunks| chunks.recv().ok());
        if chunk.is_some() {
            return Ok(chunk);
        }
        // The reader has let go of the outlet, so it has come to its end.
        self.chunks = None;
        match self.reader.take().map(JoinHandle::join) {
            None => Ok(None),
            Some(Ok(result)) => result.map(|()| None),
            Some(Err(panic)) => {
                let text = panic.downcast_ref::<&str>().copied();
                let text = text.or_else(|| panic.downcast_ref::<String>().map(String::as_str));
                let text = text.unwrap_or("unknown panic");
                Err(ErrorKind::Decoder(format!("the reader failed: {text}")).into())
            }
        }
    }
}

impl Drop for Feed {
    fn drop(&mut self) {
        self.chunks = None;
        self.wanted = None;
        // How the reader ends does not matter any more, only that it does.
        self.reader.take().into_iter().for_each(|reader| drop(reader.join()));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use puncta_core::Sphere;

    fn chunk(records: usize) -> Scene {
        Scene::new(vec![Sphere::default(); records])
    }

    #[test]
    fn what_goes_wrong_comes_behind_the_chunks_before_it() {
        let panics: fn(Outlet) -> Result<(), Fault> = |outlet| {
            (1..=5).for_each(|records| outlet.sender.send(chunk(records)).unwrap());
            panic!("the {}th chunk", 6)
        };
        let fails: fn(Outlet) -> Result<(), Fault> = |outlet| {
            (1..=5).for_each(|records| outlet.sender.send(chunk(records)).unwrap());
            Err(ErrorKind::Empty.into())
        };
        for (read, text) in
            [(panics, "the reader failed: the 6th chunk"), (fails, "the file is empty")]
        {
            let mut feed = Feed::start(read).unwrap();
            for records in 1..=5 {
                assert_eq!(feed.next().unwrap().unwrap().records.len(), records);
            }
            assert_eq!(feed.next().unwrap_err().kind.to_string(), text);
            assert!(feed.next().unwrap().is_none());
        }
    }

    #[test]
    fn a_reader_ends_with_its_feed() {
        let alive = Arc::new(());
        let held = Arc::clone(&alive);
        let mut feed = Feed::start(move |outlet| {
            while outlet.sender.send(chunk(1)).is_ok() {}
            assert_eq!(outlet.wanted.strong_count(), 0);
            drop(held);
            Ok(())
        })
        .unwrap();
        assert!(feed.next().unwrap().is_some());
        drop(feed);
        assert_eq!(Arc::strong_count(&alive), 1);
    }
}
