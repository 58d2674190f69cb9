/*!
Records on the GPU: pages of slots, and the ring of buffers through which they get there.

A page is as large as a shader can see in one piece. Segments that are missing are brought by way of a
ring of staging buffers of a fixed size: a thread fills one while the device copies from another. So
memory beside the pages does not grow with what is brought, and there is no wait but for the slower of
the two.
*/

use crate::{
    Error, Gpu,
    kernel::{Work, buffer, storage},
    paint::Coat,
    residency::{Place, Residency, SEGMENT},
};
use puncta_core::{Record, Scene};
use std::{
    collections::VecDeque,
    ops::Range,
    sync::mpsc::{self, Receiver, Sender},
};

/// About how many bytes a staging buffer holds.
const STAGED: u64 = 4 << 20;

/// How many staging buffers there are.
const RING: usize = 3;

/// How many places of records a page has at most: chunks name them by 26 bits.
const PLACES_MAX: u64 = 1 << 26;

/// How the records of a scene lie on the GPU.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Layout {
    /// The 32-bit words of a record.
    pub(crate) words: u32,
    /// Whether ids lie beside the records, and room for colors. Otherwise an id is one of the words.
    pub(crate) has_ids: bool,
    /// How many records of the neighboring segments are repeated before and after those of a segment.
    pub(crate) before: u32,
    pub(crate) after: u32,
}

impl Layout {
    /// How many places of records a slot has.
    const fn places(self) -> u32 {
        self.before + SEGMENT + self.after
    }

    /// The bytes of the records in a slot.
    const fn slot_bytes(self) -> u64 {
        self.places() as u64 * self.words as u64 * 4
    }

    /// The bytes of the ids in a slot, if they lie beside the records.
    const fn id_bytes(self) -> u64 {
        if self.has_ids { self.places() as u64 * 4 } else { 0 }
    }

    const fn staged_bytes(self) -> u64 {
        self.slot_bytes() + self.id_bytes()
    }

    /// The bytes of a slot; where there are ids, there is room for colors.
    pub(crate) const fn bytes(self) -> u64 {
        self.slot_bytes() + 2 * self.id_bytes()
    }

    /// How many slots a staging buffer holds.
    fn staged(self) -> usize {
        usize::try_from(STAGED / self.staged_bytes()).unwrap_or(1).max(1)
    }
}

/// Writes the words of records and of what is repeated around them.
pub(crate) type Pack<'a> = &'a (dyn Fn(Range<usize>, &mut Vec<u32>) + Sync);

/// The records of some segments.
#[derive(Clone, Debug)]
pub(crate) struct Page {
    pub(crate) records: wgpu::Buffer,
    pub(crate) ids: Option<wgpu::Buffer>,
    /// Once something was shaded that needs them.
    pub(crate) colors: Option<wgpu::Buffer>,
}

/// What is on the GPU of a scene.
#[derive(Debug)]
pub(crate) struct Store {
    /// The versions of the columns that it was made of, and the number of records.
    key: (u64, u64, usize),
    pub(crate) layout: Layout,
    pub(crate) residency: Residency,
    pub(crate) coat: Coat,
    pages: Vec<Option<Page>>,
    /// How many slots a page has, and how many all have.
    page_slots: u32,
    slots: u32,
    /// The largest of the ids.
    pub(crate) id_max: u32,
    /// The bytes that were brought to the GPU since it was made.
    pub(crate) brought: u64,
}

/// Staging buffers, those that can be filled in a queue.
#[derive(Debug)]
pub(crate) struct Ring {
    free: VecDeque<wgpu::Buffer>,
    back: (Sender<wgpu::Buffer>, Receiver<wgpu::Buffer>),
    count: usize,
}

impl Default for Ring {
    fn default() -> Self {
        Self { free: VecDeque::new(), back: mpsc::channel(), count: 0 }
    }
}

/// What a scene's copy on the GPU is known by.
pub(crate) fn key<R: Record>(scene: &Scene<R>) -> (u64, u64, usize) {
    let ids = scene.attributes.ids.as_ref().map_or(0, puncta_core::Column::version);
    (scene.records.version(), ids, scene.records.len())
}

fn id_max<R: Record>(scene: &Scene<R>) -> u32 {
    let last = u32::try_from(scene.records.len()).unwrap_or(u32::MAX).saturating_sub(1);
    scene.attributes.ids.as_deref().map_or(last, |ids| ids.iter().copied().max().unwrap_or(0))
}

impl Store {
    /// A store for the records of a scene, of at most so many bytes.
    pub(crate) fn new<R: Record>(
        gpu: &Gpu,
        scene: &Scene<R>,
        (layout, bytes): (Layout, u64),
    ) -> Result<Self, Error> {
        let least = layout.bytes();
        if bytes < least {
            return Err(Error::Budget { bytes, least });
        }
        let segments = scene.records.len().div_ceil(SEGMENT as usize);
        let slots = (bytes / least).min(segments as u64).max(1);
        let page_slots = (gpu.binding_bytes_max() / layout.slot_bytes())
            .clamp(1, PLACES_MAX / u64::from(layout.places()));
        let slots = u32::try_from(slots).unwrap_or(u32::MAX);
        let page_slots = u32::try_from(page_slots).unwrap_or(1).min(slots);
        Ok(Self {
            key: key(scene),
            layout,
            residency: Residency::new(segments, slots as usize),
            coat: Coat::default(),
            pages: vec![None; slots.div_ceil(page_slots) as usize],
            page_slots,
            slots,
            id_max: id_max(scene),
            brought: 0,
        })
    }

    /// Whether this is a copy of the scene; records that were changed where they are will be brought
    /// again.
    pub(crate) fn follow<R: Record>(&mut self, scene: &Scene<R>) -> bool {
        let (known, now) = (self.key, key(scene));
        if known == now {
            return true;
        }
        let is_same = (known.1, known.2) == (now.1, now.2);
        let changes = is_same.then(|| scene.records.changes_since(known.0)).flatten();
        let Some(changes) = changes else { return false };
        for range in changes.into_iter().filter(|range| !range.is_empty()) {
            // Records are repeated around the segments beside theirs.
            let first = range.start.saturating_sub(self.layout.after as usize);
            let last = range.end - 1 + self.layout.before as usize;
            for segment in first / SEGMENT as usize..=last / SEGMENT as usize {
                self.residency.spoil(u32::try_from(segment).unwrap_or(u32::MAX));
            }
        }
        self.key = now;
        true
    }

    /// The bytes of all pages that were made.
    pub(crate) fn bytes(&self) -> u64 {
        let colors = |page: &Page| page.colors.as_ref().map_or(0, wgpu::Buffer::size);
        let ids = |page: &Page| page.ids.as_ref().map_or(0, wgpu::Buffer::size);
        let size = |page: &Page| page.records.size() + ids(page) + colors(page);
        self.pages.iter().flatten().map(size).sum()
    }

    /// The number of pages.
    pub(crate) fn pages(&self) -> usize {
        self.pages.len()
    }

    /// The page of a slot, and where the slot's records start in it.
    pub(crate) fn address(&self, slot: u32) -> (usize, u32) {
        let start = slot % self.page_slots * self.layout.places() + self.layout.before;
        ((slot / self.page_slots) as usize, start)
    }

    /// A page, which is made if need be.
    pub(crate) fn page(&mut self, gpu: &Gpu, page: usize) -> Result<Page, Error> {
        if let Some(Some(page)) = self.pages.get(page) {
            return Ok(page.clone());
        }
        let first = u32::try_from(page).unwrap_or(u32::MAX).saturating_mul(self.page_slots);
        let slots = u64::from(self.page_slots.min(self.slots.saturating_sub(first)));
        let ids = slots * self.layout.id_bytes();
        let made = Page {
            records: storage(gpu, "Page::records", slots * self.layout.slot_bytes())?,
            ids: if ids > 0 { Some(storage(gpu, "Page::ids", ids)?) } else { None },
            colors: None,
        };
        self.pages[page] = Some(made.clone());
        Ok(made)
    }

    /// The colors of a page, which has room for them from now on.
    pub(crate) fn colors(&mut self, gpu: &Gpu, page: usize) -> Result<wgpu::Buffer, Error> {
        let known = self.page(gpu, page)?;
        if let Some(colors) = known.colors {
            return Ok(colors);
        }
        let bytes = known.ids.as_ref().map_or(0, wgpu::Buffer::size);
        let colors = storage(gpu, "Page::colors", bytes)?;
        if let Some(Some(page)) = self.pages.get_mut(page) {
            page.colors = Some(colors.clone());
        }
        Ok(colors)
    }

    /// Gives a segment a slot during a round; what is missing is noted.
    pub(crate) fn take(
        &mut self,
        segment: u32,
        round: u64,
        missing: &mut Vec<(u32, u32)>,
    ) -> Option<u32> {
        match self.residency.take(segment, round) {
            Place::Resident(slot) => Some(slot),
            Place::Missing(slot) => {
                self.coat.wipe(slot);
                missing.push((segment, slot));
                Some(slot)
            }
            Place::Full => None,
        }
    }

    /// Brings segments to their slots.
    pub(crate) fn bring<R: Record>(
        &mut self,
        gpu: &Gpu,
        ring: &mut Ring,
        (scene, missing, pack): (&Scene<R>, &[(u32, u32)], Pack<'_>),
    ) -> Result<(), Error> {
        if missing.is_empty() {
            return Ok(());
        }
        let result = self.stream(gpu, ring, (scene, missing, pack));
        if result.is_err() {
            self.residency.drop_all();
            self.coat = Coat::default();
            *ring = Ring::default();
        }
        result
    }

    fn stream<R: Record>(
        &mut self,
        gpu: &Gpu,
        ring: &mut Ring,
        (scene, missing, pack): (&Scene<R>, &[(u32, u32)], Pack<'_>),
    ) -> Result<(), Error> {
        let ids = scene.attributes.ids.as_deref();
        let filler = Filler { count: scene.records.len(), pack, ids, layout: self.layout };
        let staged = self.layout.staged();
        let mut rest = missing.chunks(staged);
        std::thread::scope(|scope| {
            let (jobs, waiting) = mpsc::channel::<(wgpu::Buffer, &[(u32, u32)])>();
            let (done, filled) = mpsc::channel();
            scope.spawn(move || {
                for (staging, batch) in waiting {
                    let result = filler.fill(&staging, batch);
                    if done.send((staging, batch, result)).is_err() {
                        break;
                    }
                }
            });
            let mut under_way = 0;
            loop {
                while under_way < RING - 1 && rest.len() > 0 {
                    let bytes = staged as u64 * self.layout.staged_bytes();
                    let Some(staging) = ring.next(gpu, bytes)? else { break };
                    if let Some(batch) = rest.next() {
                        jobs.send((staging, batch)).ok();
                        under_way += 1;
                    }
                }
                let lost = |reason: String| Error::Lost { reason };
                if under_way == 0 {
                    let is_done = rest.len() == 0;
                    return if is_done { Ok(()) } else { Err(lost("no memory came back".into())) };
                }
                let (staging, batch, result) =
                    filled.recv().map_err(|error| lost(error.to_string()))?;
                under_way -= 1;
                result?;
                self.copy(gpu, &staging, batch)?;
                ring.give_back(gpu, staging)?;
            }
        })
    }

    /// Copies a staging buffer to the slots of its segments.
    fn copy(
        &mut self,
        gpu: &Gpu,
        staging: &wgpu::Buffer,
        batch: &[(u32, u32)],
    ) -> Result<(), Error> {
        staging.unmap();
        let mut work = Work::new(gpu, "Store::copy");
        for (place, (_, slot)) in (0_u64..).zip(batch) {
            let (page, first) = self.address(*slot);
            let page = self.page(gpu, page)?;
            let Layout { words, before, .. } = self.layout;
            let (slot_bytes, id_bytes) = (self.layout.slot_bytes(), self.layout.id_bytes());
            let from = place * self.layout.staged_bytes();
            let (first, record) = (u64::from(first - before), u64::from(words) * 4);
            let encoder = &mut work.encoder;
            encoder.copy_buffer_to_buffer(staging, from, &page.records, first * record, slot_bytes);
            if let Some(ids) = &page.ids {
                encoder.copy_buffer_to_buffer(staging, from + slot_bytes, ids, first * 4, id_bytes);
            }
        }
        self.brought += batch.len() as u64 * self.layout.staged_bytes();
        gpu.guard("bringing records", || work.submit())
    }
}

impl Ring {
    /// A buffer that can be filled; waits for one if there is none.
    fn next(&mut self, gpu: &Gpu, bytes: u64) -> Result<Option<wgpu::Buffer>, Error> {
        self.free.extend(self.back.1.try_iter());
        if let Some(free) = self.free.pop_front() {
            return Ok(Some(free));
        }
        if self.count < RING {
            self.count += 1;
            let usage = wgpu::BufferUsages::MAP_WRITE | wgpu::BufferUsages::COPY_SRC;
            let made = buffer(gpu, "Ring::staging", (bytes, usage))?;
            gpu.guard("staging", || made.map_async(wgpu::MapMode::Write, .., |_| {}))?;
            gpu.wait()?;
            return Ok(Some(made));
        }
        gpu.wait()?;
        self.free.extend(self.back.1.try_iter());
        Ok(self.free.pop_front())
    }

    /// Takes a buffer back that is being copied from: it can be filled once that is done.
    fn give_back(&self, gpu: &Gpu, staging: wgpu::Buffer) -> Result<(), Error> {
        let back = self.back.0.clone();
        let handle = staging.clone();
        gpu.guard("staging", || {
            staging.map_async(wgpu::MapMode::Write, .., move |result| {
                if result.is_ok() {
                    back.send(handle).ok();
                }
            });
        })
    }
}

/// Fills staging buffers with the records of a scene.
#[derive(Clone, Copy)]
struct Filler<'a> {
    count: usize,
    pack: Pack<'a>,
    ids: Option<&'a [u32]>,
    layout: Layout,
}

impl Filler<'_> {
    fn fill(&self, staging: &wgpu::Buffer, batch: &[(u32, u32)]) -> Result<(), Error> {
        let lost = |error: wgpu::MapRangeError| Error::Lost { reason: error.to_string() };
        let mut view = staging.get_mapped_range_mut(..).map_err(lost)?;
        let mut words = Vec::new();
        let size = |bytes: u64| usize::try_from(bytes).unwrap_or(0);
        let bytes = size(self.layout.staged_bytes());
        for (place, (segment, _)) in batch.iter().enumerate() {
            let first = *segment as usize * SEGMENT as usize;
            let last = (first + SEGMENT as usize).min(self.count);
            words.clear();
            (self.pack)(first..last, &mut words);
            // Slots are always filled: what is beyond the last record is not drawn.
            words.resize(size(self.layout.slot_bytes()) / 4, 0);
            if self.layout.has_ids {
                match self.ids {
                    Some(all) => words.extend_from_slice(&all[first..last]),
                    None => {
                        words.extend((first..last).map(|id| u32::try_from(id).unwrap_or(u32::MAX)));
                    }
                }
                words.resize(bytes / 4, 0);
            }
            let from = place * bytes;
            view.slice(from..from + bytes).copy_from_slice(bytemuck::cast_slice(&words));
        }
        Ok(())
    }
}
