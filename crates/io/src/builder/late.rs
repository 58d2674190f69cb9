/*!
Columns that come, or change, after the rows.

In files that have all positions first, a column has a value for each row of the file, and those of
skipped rows must be left out: [`Builder::keeps`] tells which. Radii go into the records one by one,
without a copy; rows whose radius cannot be used leave all columns at the end of that.
*/

use super::{Builder, Precision, is_radius, to_f32, to_id};
use crate::error::{Fault, Place, Problem};
use puncta_core::Scalar;

/// The radius of a row that is to be left out.
const UNUSABLE: f32 = -1.0;

impl Builder<'_> {
    /// How many rows are kept.
    pub(crate) fn kept(&self) -> usize {
        self.records.len()
    }

    /// Whether the row of this number is kept.
    pub(crate) fn keeps(&self, row: u64) -> bool {
        match (&self.ids, u32::try_from(row)) {
            (Some(ids), Ok(row)) => ids.binary_search(&row).is_ok(),
            (None, Ok(_)) => row < self.records.len() as u64,
            (_, Err(_)) => false,
        }
    }

    /// Makes all colors so far black, opaque ones.
    pub(crate) fn blacken(&mut self) {
        if let Some(survey) = &mut self.survey {
            survey.black = survey.count;
        }
        // Chunks have black ones from the start, for as long as they should be.
        if self.chunking.is_none() {
            self.colors.iter_mut().flatten().for_each(|color| *color = [0, 0, 0, 255]);
        }
    }

    /// Leaves out the colors, which tell nothing.
    pub(crate) fn drop_colors(&mut self) {
        self.colors = None;
        self.survey.iter_mut().for_each(|survey| survey.has_colors = false);
    }

    /// Leaves out the elements, which tell nothing.
    pub(crate) fn drop_elements(&mut self) {
        self.elements = None;
        self.survey.iter_mut().for_each(|survey| survey.has_elements = false);
    }

    /// Whether there are colors.
    pub(crate) fn has_colors(&self) -> bool {
        self.colors.is_some()
    }

    /// Adds a scalar with one value for each kept row. A second one of the same name is left out.
    pub(crate) fn add_scalar(&mut self, scalar: Scalar) {
        debug_assert_eq!(scalar.values.len(), self.records.len());
        if self.scalars.iter().any(|(_, other)| other.name == scalar.name) {
            self.warn(format!("a second scalar {} is left out", scalar.name));
            return;
        }
        self.scalars.push((self.scalars.len(), scalar));
    }

    /// Adds colors, one for each kept row.
    pub(crate) fn add_colors(&mut self, colors: Vec<[u8; 4]>) {
        debug_assert_eq!(colors.len(), self.records.len());
        self.colors = Some(colors);
    }

    /// Sets the radius of a kept row; `index` counts kept rows only. After the last one call
    /// [`Self::end_radii`].
    pub(crate) fn set_radius(
        &mut self,
        index: usize,
        radius: f64,
        place: Place,
    ) -> Result<(), Fault> {
        // A radius for all records is in place already.
        if self.options.radius.is_some() {
            return Ok(());
        }
        let scaled = radius * self.options.radius_scale;
        let is_usable = is_radius(scaled);
        if !is_usable {
            self.report_skip(Problem::Radius, place, || radius.to_string())?;
        }
        if let Some(record) = self.records.get_mut(index) {
            record.radius = if is_usable { to_f32(scaled) } else { UNUSABLE };
        }
        Ok(())
    }

    /// Leaves out the rows whose radius cannot be used, after all radii were set.
    pub(crate) fn end_radii(&mut self) {
        self.radius_missing = false;
        if !self.records.iter().any(|record| record.radius == UNUSABLE) {
            return;
        }
        if self.precision == Precision::Double {
            self.settle();
        }
        self.ids.get_or_insert_with(|| (0..self.records.len() as u64).map(to_id).collect());
        let records = std::mem::take(&mut self.records);
        let keep = |index: usize| records.get(index).is_some_and(|r| r.radius != UNUSABLE);
        self.ids.iter_mut().for_each(|ids| retain(ids, keep));
        self.colors.iter_mut().for_each(|colors| retain(colors, keep));
        self.elements.iter_mut().for_each(|elements| retain(elements, keep));
        self.scalars.iter_mut().for_each(|(_, scalar)| retain(scalar.values.to_mut(), keep));
        self.records = records;
        self.records.retain(|record| record.radius != UNUSABLE);
    }
}

/// Keeps the values at some indices.
fn retain<T>(values: &mut Vec<T>, keep: impl Fn(usize) -> bool) {
    let mut index = 0;
    values.retain(|_| {
        index += 1;
        keep(index - 1)
    });
}

#[cfg(test)]
mod tests {
    use crate::{
        ReadOptions,
        builder::{Builder, Columns, Precision, Row},
        error::Place,
    };
    use puncta_core::Scalar;

    #[test]
    fn late_columns_leave_out_what_is_skipped() {
        let options = ReadOptions::default().radius_scale(2.0);
        for precision in [Precision::Single, Precision::Double] {
            let mut builder = Builder::new(&options, precision, &Columns::default());
            for x in [0.0, f64::NAN, 2.0, 3.0, 4.0] {
                let row = Row { position: [x, 0.0, 0.0], ..Row::default() };
                builder.push(&row, Place::Byte(1)).unwrap();
            }
            assert_eq!(builder.kept(), 4);
            let keeps: Vec<bool> = (0..7).map(|row| builder.keeps(row)).collect();
            assert_eq!(keeps, [true, false, true, true, true, false, false]);
            builder.add_colors([0, 2, 3, 4].map(|i| [i; 4]).to_vec());
            for (index, radius) in [0.5, 1.0, -1.0, 0.25].into_iter().enumerate() {
                builder.set_radius(index, radius, Place::Byte(9)).unwrap();
            }
            builder.end_radii();
            assert!(!builder.keeps(3));
            builder.add_scalar(Scalar { name: "a".into(), values: vec![10.0, 12.0, 14.0].into() });
            builder.add_scalar(Scalar { name: "a".into(), values: vec![0.0; 3].into() });
            let (scene, report) = builder.finish().unwrap();
            scene.validate().unwrap();
            let xs: Vec<f64> = (0..3).map(|i| scene.position(i).x).collect();
            assert_eq!(xs, [0.0, 2.0, 4.0]);
            let radii: Vec<f32> = scene.records.iter().map(|sphere| sphere.radius).collect();
            assert_eq!(radii, [1.0, 2.0, 0.5]);
            assert_eq!(scene.attributes.ids, Some([0, 2, 4].into()));
            assert_eq!(scene.attributes.colors, Some([[0; 4], [2; 4], [4; 4]].into()));
            assert_eq!(scene.attributes.scalars.len(), 1);
            assert_eq!(report.skipped_count(), 2);
            assert_eq!(report.skipped[1].value, "-1");
            assert_eq!(report.warnings, ["a second scalar a is left out"]);
        }
    }
}
