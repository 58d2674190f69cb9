/*!
The layout of a frame: where its lists are, and in which way they deviate from the format.

Many files lack the time stamp that their version 1.3 asks for, and some lists are longer or shorter
than they should be (see `Types::has_other_form`). Nothing in a file says so. But the lists
of a frame fill it from start to end, so this module reads the headers of all lists in each possible
way, the specified one first, and takes the first that ends at the last byte of the frame. If there
is none, the specified way is taken: either it ends early, which is worth a warning, or what is
wrong with it is the error.

A wrong way soon meets a type that does not exist or a number of particles that does not fit. A file
made to be ambiguous throughout is given up after [`DETOURS`] more headers than it has lists.

Headers lie behind particles, so they are read before the particles are. That is no matter in a
file, which can seek. A compressed file cannot: a little of the frame is held in memory, and this
is enough for one list, whose header tells its end, or for small frames. Otherwise the whole frame
is held, decompressed: never more than there is, but some twice of what reading a file takes.
*/

use super::{
    header::FileHeader,
    list::{Form, ListHeader, Types, Vertex, fit},
};
use crate::{error::Fault, input::Input};

/// How many bytes of a frame of a compressed file are held at first.
const HELD: u64 = 1 << 16;

/// How many headers may be read in vain.
const DETOURS: u64 = 1 << 16;

/// How many ways are kept in mind; there are no more where files are what they seem to be.
const BRANCHES_MAX: usize = 1 << 16;

/// Whether a frame starts with a time stamp.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Stamp {
    /// As its version says.
    Specified,
    /// Not, though its version says so.
    Missing,
}

/// What the lists of a frame have.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Content {
    pub(super) records: u64,
    /// Positions that are not `f32`.
    pub(super) doubles: bool,
    pub(super) colors: bool,
    pub(super) intensities: bool,
}

impl Content {
    fn add(&mut self, list: &ListHeader) {
        if list.records() > 0 {
            self.records = self.records.saturating_add(list.records());
            self.doubles |= matches!(list.types.vertex, Vertex::DoubleXyz | Vertex::ShortXyz);
            self.intensities |= list.types.color.is_intensity();
            self.colors |=
                !list.types.color.is_intensity() && list.global_color() != Some([255; 4]);
        }
    }
}

/// How to read a frame.
#[derive(Clone, Debug)]
pub(super) struct Layout {
    pub(super) stamp: Stamp,
    /// How many lists there are.
    pub(super) lists: u32,
    /// Where the first list starts.
    pub(super) lists_at: u64,
    /// The indices, ascending, of lists that deviate from the format.
    pub(super) deviating: Vec<u32>,
    /// What the lists have.
    pub(super) content: Content,
    /// How many bytes of the frame follow the last list.
    pub(super) trailing: u64,
}

/// Why a layout was not found.
enum Stop {
    /// More of the frame must be held.
    NotHeld,
    /// The frame does not have this layout.
    Fault(Fault),
}

impl From<Fault> for Stop {
    fn from(fault: Fault) -> Self {
        Self::Fault(fault)
    }
}

impl Layout {
    /// Finds the layout of the frame.
    pub(super) fn find(input: &mut Input<'_>, file: &FileHeader) -> Result<Self, Fault> {
        input.jump(file.start, "the frame")?;
        let bytes = file.end - file.start;
        let wanted = if input.must_hold() { bytes.min(HELD) } else { bytes };
        let held = input.hold(wanted)?;
        // Where a stream ends early, reading shall go on and meet the end.
        let held_end = if held == wanted && wanted < bytes { file.start + held } else { file.end };
        match search(input, file, held_end) {
            Ok(layout) => return Ok(layout),
            Err(Stop::Fault(fault)) => return Err(fault),
            Err(Stop::NotHeld) => {}
        }
        input.jump(file.start, "the frame")?;
        input.hold(bytes)?;
        search(input, file, file.end).map_err(|stop| match stop {
            Stop::Fault(fault) => fault,
            Stop::NotHeld => Fault::invalid(input.at_byte(), "the frame must be held", held),
        })
    }
}

/// Finds the layout of a frame of which the bytes up to `held_end` can be read twice.
fn search(input: &mut Input<'_>, file: &FileHeader, held_end: u64) -> Result<Layout, Stop> {
    let specified = Search::new(input, file, held_end).run(Stamp::Specified);
    let is_exact =
        |found: &Result<Layout, Stop>| found.as_ref().is_ok_and(|layout| layout.trailing == 0);
    if is_exact(&specified) || matches!(specified, Err(Stop::NotHeld)) || file.version < 102 {
        return specified;
    }
    let stampless = Search::new(input, file, held_end).run(Stamp::Missing);
    if is_exact(&stampless) || matches!(stampless, Err(Stop::NotHeld)) {
        return stampless;
    }
    specified
}

/// A list that is to be read, and what was found before it.
struct Branch {
    list: u32,
    at: u64,
    form: Form,
    /// How many deviating lists there are before it.
    deviating: usize,
    content: Content,
}

/// A search for the form of each list.
struct Search<'s, 'i> {
    input: &'s mut Input<'i>,
    file: &'s FileHeader,
    held_end: u64,
    headers_left: u64,
    deviating: Vec<u32>,
    /// Other ways that were not taken so far.
    branches: Vec<Branch>,
}

impl<'s, 'i> Search<'s, 'i> {
    fn new(input: &'s mut Input<'i>, file: &'s FileHeader, held_end: u64) -> Self {
        let (deviating, branches) = (Vec::new(), Vec::new());
        Self { input, file, held_end, headers_left: DETOURS, deviating, branches }
    }

    fn run(mut self, stamp: Stamp) -> Result<Layout, Stop> {
        let has_stamp = stamp == Stamp::Specified && self.file.version >= 102;
        self.move_to(self.file.start, 8)?;
        let skipped = if has_stamp { 4 } else { 0 };
        fit(self.input, skipped + 4, self.file, "the head of the frame")?;
        self.input.skip(skipped, "the time stamp")?;
        let lists = u32::from_le_bytes(self.input.array("the number of lists")?);
        self.headers_left += u64::from(lists);
        let (lists_at, content) = (self.input.byte(), Content::default());
        let form = Form::Specified;
        self.branches.push(Branch { list: 0, at: lists_at, form, deviating: 0, content });

        let mut first = None;
        while let Some(branch) = self.branches.pop() {
            match self.follow(branch, lists) {
                Err(Stop::NotHeld) => return Err(Stop::NotHeld),
                Err(Stop::Fault(fault)) => {
                    first.get_or_insert(Err(fault));
                }
                Ok((end, content)) => {
                    let trailing = self.file.end.saturating_sub(end);
                    if trailing > 0 && first.is_some() {
                        continue;
                    }
                    let deviating = self.deviating.clone();
                    let layout = Layout { stamp, lists, lists_at, deviating, content, trailing };
                    if trailing == 0 {
                        return Ok(layout);
                    }
                    first = Some(Ok(layout));
                }
            }
            if self.headers_left == 0 {
                break;
            }
        }
        // There was at least one branch, so there is a first result.
        let none = || Fault::invalid(self.input.at_byte(), "the frame must have a layout", "none");
        Ok(first.unwrap_or_else(|| Err(none()))?)
    }

    /// Follows one way to its end.
    fn follow(&mut self, branch: Branch, lists: u32) -> Result<(u64, Content), Stop> {
        let Branch { list, mut at, mut form, deviating, mut content } = branch;
        self.deviating.truncate(deviating);
        for list in list..lists {
            self.headers_left = self.headers_left.saturating_sub(1);
            if self.headers_left == 0 {
                let what = "the lists must be readable in one way";
                return Err(Fault::invalid(self.input.at_byte(), what, "many").into());
            }
            self.move_to(at, ListHeader::BYTES_MAX)?;
            let types = Types::read(self.input, self.file)?;
            let can_branch = form == Form::Specified && self.branches.len() < BRANCHES_MAX;
            if can_branch && types.has_other_form(self.file) {
                let (form, deviating) = (Form::Deviating, self.deviating.len());
                self.branches.push(Branch { list, at, form, deviating, content });
            }
            let header = ListHeader::read_rest(self.input, self.file, types, form)?;
            if form == Form::Deviating {
                self.deviating.push(list);
            }
            content.add(&header);
            at = self.input.byte() + header.bytes().unwrap_or(0);
            if self.file.version == 101 {
                self.move_to(at, 12)?;
                at = header.cluster_bytes(self.input, self.file, form)? + self.input.byte();
            }
            form = Form::Specified;
        }
        Ok((at, content))
    }

    /// Moves to a place from which up to `bytes` bytes will be read.
    fn move_to(&mut self, at: u64, bytes: u64) -> Result<(), Stop> {
        if at.saturating_add(bytes) > self.held_end && self.held_end < self.file.end {
            return Err(Stop::NotHeld);
        }
        Ok(self.input.jump(at, "a list")?)
    }
}
