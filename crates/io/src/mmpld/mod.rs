/*!
MMPLD: the particle lists of MegaMol, versions 1.0 to 1.3.

A file has a header with two boxes, a seek table, and frames; a frame has lists, and a list has a
header that says how its particles are stored: five kinds of positions times eight kinds of colors.
Source: the specification of version 1.3 (2018), and reader and writer of MegaMol where it is
silent. All numbers are little endian and nothing is aligned.

All lists of the chosen frame become one scene. Colors become sRGB bytes; a global color is that of
each particle of its list, and the alpha of a global color is not used, as in MegaMol. Lists whose
global color is white have no colors as long as no other list has some. Intensities become the
scalar `intensity`; their particles are white where other lists have colors. A color with a NaN in
it becomes white, and one outside of 0..1 is clamped; both are counted in a warning. Particles with
a radius that is not positive are skipped, whether it is their own or that of their list. Time
stamps, the range of intensities and cluster blocks (1.1) are passed over.

# Hazards

* Files may be written otherwise than the format says: see [`layout`] for how that is found.
* The boxes in real files can be zero or wrong. They serve for nothing but `SHORT_XYZ`, whose
  positions are multiples of 1/65535 of a box that the format does not name: this reader takes the
  box of the list, else that of the file, and warns.
* A version of 0 marks a file whose writing was not finished.
* The seek table is checked as a whole, whichever frame is read: a table that is wrong somewhere
  cannot be trusted elsewhere. Bytes behind the last frame are ignored, as the format says.
*/

mod header;
mod layout;
mod list;
mod particles;
#[cfg(test)]
mod tests;
mod write;

pub(crate) use write::write;

use crate::{
    ReadOptions,
    builder::{Builder, Columns, Precision, Report},
    error::{Fault, Problem},
    input::Input,
};
use header::FileHeader;
use layout::{Layout, Stamp};
use list::{Form, ListHeader, Vertex};
use particles::Particles;
use puncta_core::Scene;

/// The name of the scalar that intensities become.
const INTENSITY: &str = "intensity";

/// Reads a frame.
pub(crate) fn read(input: &mut Input<'_>, options: &ReadOptions) -> Result<(Scene, Report), Fault> {
    let file = FileHeader::read(input, options.frame)?;
    let layout = Layout::find(input, &file)?;
    let content = layout.content;
    let precision = if content.doubles { Precision::Double } else { Precision::Single };
    let columns = Columns {
        color: content.colors,
        element: false,
        scalars: if content.intensities { vec![INTENSITY.to_owned()] } else { Vec::new() },
    };
    let mut builder = Builder::new(options, precision, &columns);
    if input.remaining().is_some() {
        builder.reserve(content.records)?;
    }
    warn(&mut builder, &file, &layout);
    read_lists(input, &file, &layout, &mut builder)?;
    builder.finish()
}

fn read_lists(
    input: &mut Input<'_>,
    file: &FileHeader,
    layout: &Layout,
    builder: &mut Builder<'_>,
) -> Result<(), Fault> {
    let mut particles = Particles::new(file.bounds);
    let mut deviating = layout.deviating.iter().copied().peekable();
    input.jump(layout.lists_at, "the first list")?;
    for index in 0..layout.lists {
        let form =
            if deviating.next_if_eq(&index).is_some() { Form::Deviating } else { Form::Specified };
        let list = ListHeader::read(input, file, form)?;
        if list.types.vertex == Vertex::None {
            let lost = (list.place, list.count);
            builder.skip_many(Problem::Position, lost, || "none".to_owned())?;
        }
        particles.read(input, &list, builder)?;
        let bytes = list.cluster_bytes(input, file, form)?;
        input.skip(bytes, "a cluster block")?;
    }
    particles.warn(builder);
    Ok(())
}

/// Tells where the file is not as it should be.
fn warn(builder: &mut Builder<'_>, file: &FileHeader, layout: &Layout) {
    let (frame, version) = (file.frame, file.version);
    if layout.stamp == Stamp::Missing {
        builder.warn(format!("frame {frame} has no time stamp, which version {version} asks for"));
    }
    if !layout.deviating.is_empty() {
        let lists = layout.deviating.len();
        builder.warn(format!(
            "{lists} lists of frame {frame} are written in a way that is known to be wrong, \
             but fits"
        ));
    }
    if layout.trailing > 0 {
        let (trailing, bytes) = (layout.trailing, file.end - file.start);
        builder.warn(format!(
            "{trailing} of the {bytes} bytes of frame {frame} follow its last list; trailing bytes \
             inside a frame are ignored"
        ));
    }
}
