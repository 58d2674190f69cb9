/*!
The writer: version 1.3, one frame.

Where all world positions are `f32`, they are written as such, with their radii, in one list, in
order. Otherwise they must be double, and these have one radius for each list: there is a list for
each radius, so at most [`RADII_MAX`] radii, and the order of records is lost between lists.

A list has one kind of color, and these are taken in this order: the colors of the scene, its scalar
`intensity`, or white. Double positions go with colors of 16 bits or intensities of 64 bits only, as
the format demands. Ids, elements and other scalars have no place in the format and are left out.

The version is written last: 0 marks a file whose writing was not finished.
*/

use super::{
    INTENSITY,
    header::{HEADER_BYTES, MAGIC},
    list::{Color, Types, Vertex},
};
use crate::{
    builder::to_f32,
    color::WHITE,
    error::{ErrorKind, Fault},
};
use puncta_core::{Bounds, Scene, Sphere};
use std::{
    collections::BTreeMap,
    io::{self, BufWriter, Seek, SeekFrom, Write},
    ops::Range,
};

/// How many lists a file gets at most.
const RADII_MAX: usize = 256;

/// Writes a scene to a stream that stands at its start.
pub(crate) fn write(
    out: &mut (impl Write + Seek + ?Sized),
    scene: &Scene<Sphere>,
) -> Result<(), Fault> {
    scene.validate().map_err(|error| ErrorKind::Decoder(error.to_string()))?;
    let writer = Writer::new(scene)?;
    let mut out = BufWriter::with_capacity(1 << 16, out);
    let start = out.stream_position()?;
    out.write_all(MAGIC)?;
    out.write_all(&0_u16.to_le_bytes())?;
    out.write_all(&1_u32.to_le_bytes())?;
    let bounds = writer.bounds(0..scene.records.len());
    let radii = scene.records.iter().map(|record| record.radius).filter(|r| r.is_finite());
    let radius = radii.fold(0.0, f32::max);
    write_floats(&mut out, &outward(bounds, radius))?;
    write_floats(&mut out, &outward(grown(&outward(bounds, radius), radius), radius))?;
    out.write_all(&(HEADER_BYTES + 16).to_le_bytes())?;
    out.write_all(&0_u64.to_le_bytes())?;
    write_floats(&mut out, &[0.0])?;
    writer.write_frame(&mut out)?;
    let end = out.stream_position()?;
    out.seek(SeekFrom::Start(start + HEADER_BYTES + 8))?;
    out.write_all(&(end - start).to_le_bytes())?;
    out.seek(SeekFrom::Start(start + 6))?;
    out.write_all(&103_u16.to_le_bytes())?;
    out.seek(SeekFrom::Start(end))?;
    Ok(out.flush()?)
}

/// The radius of a list, and where its records are in the order of the file.
type List = (f32, Range<usize>);

/// How a scene is written.
struct Writer<'s> {
    scene: &'s Scene<Sphere>,
    types: Types,
    intensities: Option<&'s [f32]>,
    /// The records in the order of the file, if that is not the one of the scene.
    order: Vec<u32>,
    lists: Vec<List>,
}

impl<'s> Writer<'s> {
    fn new(scene: &'s Scene<Sphere>) -> Result<Self, Fault> {
        let intensities = scene.scalar(INTENSITY).map(|scalar| scalar.values.as_slice());
        let intensities = intensities.filter(|_| scene.attributes.colors.is_none());
        let is_single = |index: usize| {
            let is_single = |x: f64| x.is_nan() || f64::from(to_f32(x)) == x;
            scene.position(index).to_array().into_iter().all(is_single)
        };
        let records = scene.records.len();
        let (vertex, color, order, lists);
        if (0..records).all(is_single) {
            vertex = Vertex::FloatXyzr;
            color = match &scene.attributes.colors {
                Some(_) => Color::ByteRgba,
                None if intensities.is_some() => Color::FloatI,
                None => Color::None,
            };
            (order, lists) = (Vec::new(), vec![(0.0, 0..records)]);
        } else {
            vertex = Vertex::DoubleXyz;
            color = if intensities.is_some() { Color::DoubleI } else { Color::ShortRgba };
            (order, lists) = group(&scene.records)?;
        }
        Ok(Self { scene, types: Types { vertex, color }, intensities, order, lists })
    }

    /// The index in the scene of a record of the file.
    fn index(&self, place: usize) -> usize {
        self.order.get(place).map_or(place, |&index| index as usize)
    }

    /// The box around positions, radii not included; those that are not finite are left out.
    fn bounds(&self, places: Range<usize>) -> Bounds {
        let mut bounds = Bounds::EMPTY;
        let positions = places.map(|place| self.scene.position(self.index(place)));
        positions.filter(|position| position.is_finite()).for_each(|position| bounds.add(position));
        bounds
    }

    /// Writes what follows the time stamp.
    fn write_frame(&self, out: &mut impl Write) -> Result<(), Fault> {
        let lists = u32::try_from(self.lists.len()).unwrap_or(u32::MAX);
        out.write_all(&lists.to_le_bytes())?;
        for (radius, places) in &self.lists {
            out.write_all(&[self.types.vertex as u8, self.types.color as u8])?;
            if self.types.vertex == Vertex::DoubleXyz {
                write_floats(out, &[*radius])?;
            }
            match self.intensities {
                Some(intensities) => write_floats(out, &range(intensities))?,
                None if self.types.color == Color::None => out.write_all(&WHITE)?,
                None => {}
            }
            out.write_all(&(places.len() as u64).to_le_bytes())?;
            write_floats(out, &outward(self.bounds(places.clone()), *radius))?;
            for place in places.clone() {
                self.write_record(out, self.index(place))?;
            }
        }
        Ok(())
    }

    fn write_record(&self, out: &mut impl Write, index: usize) -> io::Result<()> {
        let position = self.scene.position(index).to_array();
        if self.types.vertex == Vertex::DoubleXyz {
            position.iter().try_for_each(|x| out.write_all(&x.to_le_bytes()))?;
        } else {
            let [x, y, z] = position.map(to_f32);
            write_floats(out, &[x, y, z, self.scene.records[index].radius])?;
        }
        let intensity = || self.intensities.map_or(f32::NAN, |intensities| intensities[index]);
        let color = || self.scene.attributes.colors.as_ref().map_or(WHITE, |colors| colors[index]);
        match self.types.color {
            Color::FloatI => write_floats(out, &[intensity()]),
            Color::DoubleI => out.write_all(&f64::from(intensity()).to_le_bytes()),
            Color::ByteRgba => out.write_all(&color()),
            Color::ShortRgba => {
                let words = color().map(|byte| u16::from(byte) * 257);
                words.iter().try_for_each(|word| out.write_all(&word.to_le_bytes()))
            }
            _ => Ok(()),
        }
    }
}

/// Sorts records by radius; each radius makes a list.
fn group(records: &[Sphere]) -> Result<(Vec<u32>, Vec<List>), Fault> {
    let mut counts: BTreeMap<u32, usize> = BTreeMap::new();
    for record in records {
        *counts.entry(record.radius.to_bits()).or_default() += 1;
        if counts.len() > RADII_MAX {
            let what = format!(
                "the positions need 64 bits, and then MMPLD has one radius for each list: there \
                 must be at most {RADII_MAX} radii"
            );
            let value = "more".to_owned();
            return Err(ErrorKind::Invalid { what, value }.into());
        }
    }
    let (mut lists, mut start) = (Vec::new(), 0);
    let mut next = BTreeMap::new();
    for (&radius, &count) in &counts {
        lists.push((f32::from_bits(radius), start..start + count));
        next.insert(radius, start);
        start += count;
    }
    let mut order = vec![0; records.len()];
    for (index, record) in (0_u32..).zip(records) {
        if let Some(place) = next.get_mut(&record.radius.to_bits()) {
            order[*place] = index;
            *place += 1;
        }
    }
    Ok((order, lists))
}

/// The least and the largest intensity that is finite.
fn range(intensities: &[f32]) -> [f32; 2] {
    let finite = intensities.iter().copied().filter(|intensity| intensity.is_finite());
    let wider = |[least, largest]: [f32; 2], x: f32| [least.min(x), largest.max(x)];
    let range = finite.fold([f32::INFINITY, f32::NEG_INFINITY], wider);
    if range[0] <= range[1] { range } else { [0.0, 1.0] }
}

/// A box of `f32` that holds `bounds` and has an extent on each axis, as the format demands.
fn outward(bounds: Bounds, radius: f32) -> [f32; 6] {
    let mut sides = [0.0; 6];
    let (min, max) = if bounds.is_empty() {
        ([0.0; 3], [0.0; 3])
    } else {
        (bounds.min.to_array(), bounds.max.to_array())
    };
    let pad = if radius > 0.0 { f64::from(radius) } else { 1.0 };
    for axis in 0..3 {
        let (mut least, mut largest) = (below(min[axis]), above(max[axis]));
        if least >= largest {
            (least, largest) = (below(min[axis] - pad), above(max[axis] + pad));
        }
        if least >= largest {
            (least, largest) = (least.next_down(), largest.next_up());
        }
        (sides[axis], sides[axis + 3]) = (least, largest);
    }
    sides
}

/// A box that is larger by `radius` on each side.
fn grown(sides: &[f32; 6], radius: f32) -> Bounds {
    let [x, y, z, right, top, front] = sides.map(f64::from);
    let radius = f64::from(radius);
    Bounds {
        min: [x - radius, y - radius, z - radius].into(),
        max: [right + radius, top + radius, front + radius].into(),
    }
}

/// The largest `f32` that is not above `x`.
fn below(x: f64) -> f32 {
    let near = to_f32(x);
    let below = if f64::from(near) > x { near.next_down() } else { near };
    below.max(f32::MIN)
}

/// The least `f32` that is not below `x`.
fn above(x: f64) -> f32 {
    -below(-x)
}

fn write_floats(out: &mut impl Write, floats: &[f32]) -> io::Result<()> {
    floats.iter().try_for_each(|float| out.write_all(&float.to_le_bytes()))
}
