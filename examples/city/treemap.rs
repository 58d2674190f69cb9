/*!
Squarified treemaps: a rectangle cut into rectangles of given areas that are as square as can be.

After Bruls, Huizing and van Wijk, *Squarified Treemaps*, 2000. Rectangles are laid in rows along the
shorter side of what is left; a row takes one more as long as that makes its worst one squarer.
*/

/// A rectangle, from its lower left corner.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Rect {
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) width: f64,
    pub(crate) height: f64,
}

impl Rect {
    /// What is left inside of a margin; of no size if there is nothing left.
    pub(crate) fn inset(self, margin: f64) -> Self {
        let shrink = |side: f64| (side - 2.0 * margin).max(0.0);
        let (width, height) = (shrink(self.width), shrink(self.height));
        let x = self.x + (self.width - width) * 0.5;
        Self { x, y: self.y + (self.height - height) * 0.5, width, height }
    }

    /// The length of the shorter side.
    pub(crate) fn shorter(self) -> f64 {
        self.width.min(self.height)
    }
}

/// Cuts a rectangle into one for each size, of an area in proportion to it.
///
/// Sizes should come with the largest first. What is not positive gets a rectangle without an area.
pub(crate) fn squarify(sizes: &[f64], within: Rect) -> Vec<Rect> {
    let sizes: Vec<f64> =
        sizes.iter().map(|&size| if size.is_finite() { size.max(0.0) } else { 0.0 }).collect();
    // What is left of the sizes from each on. Summed from the end, where the small ones are: what is left
    // after the large ones were taken away would be right to few digits.
    let mut left = vec![0.0; sizes.len() + 1];
    for index in (0..sizes.len()).rev() {
        left[index] = left[index + 1] + sizes[index];
    }
    let (mut rest, mut rects) = (within, Vec::with_capacity(sizes.len()));
    while rects.len() < sizes.len() {
        let first = rects.len();
        let sizes = &sizes[first..];
        if left[first] <= 0.0 {
            rects.extend(sizes.iter().map(|_| Rect { width: 0.0, height: 0.0, ..rest }));
            break;
        }
        let scale = rest.width * rest.height / left[first];
        let count = row(sizes, rest.shorter(), scale);
        rest = lay(&sizes[..count], left[first + count], rest, &mut rects);
    }
    rects
}

/// How many rectangles the next row takes.
fn row(sizes: &[f64], side: f64, scale: f64) -> usize {
    let (mut sum, mut largest, mut smallest) = (0.0, 0.0_f64, f64::INFINITY);
    let mut worst = f64::INFINITY;
    for (count, &size) in sizes.iter().enumerate() {
        sum += size;
        (largest, smallest) = (largest.max(size), smallest.min(size));
        // The longer side of a rectangle of this row, by the shorter one.
        let square = side * side / (sum * scale);
        let next = (square * largest / sum).max(sum / (square * smallest));
        // Written so that a row goes on where nothing can be told.
        if count > 0 && next > worst {
            return count;
        }
        worst = next;
    }
    sizes.len()
}

/// Lays a row into a rectangle, and returns what is left for the other sizes, of this sum.
fn lay(sizes: &[f64], left: f64, rest: Rect, rects: &mut Vec<Rect>) -> Rect {
    let Rect { x, y, width, height } = rest;
    let (sum, mut before) = (sizes.iter().sum::<f64>(), 0.0);
    let (share, after) = (sum / (sum + left), left / (sum + left));
    let is_column = width >= height;
    for &size in sizes {
        let (from, part) = if sum > 0.0 { (before / sum, size / sum) } else { (0.0, 0.0) };
        before += size;
        rects.push(if is_column {
            Rect { x, y: y + height * from, width: width * share, height: height * part }
        } else {
            Rect { x: x + width * from, y, width: width * part, height: height * share }
        });
    }
    if is_column {
        Rect { x: x + width * share, width: width * after, ..rest }
    } else {
        Rect { y: y + height * share, height: height * after, ..rest }
    }
}
