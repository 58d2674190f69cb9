//! The comment of extended XYZ: pairs of keys and values, and the columns among them.

use crate::{
    ReadOptions,
    error::{Fault, Place, quote},
    table::{Role, Table},
    text::{number, whole},
};

/// What a comment tells.
#[derive(Debug, Default, PartialEq, Eq)]
pub(super) struct Told {
    /// The columns of the rows, if the comment is that of extended XYZ.
    pub(super) table: Option<Table>,
    /// What is wrong with the lattice of another one.
    pub(super) warning: Option<String>,
}

/// Reads a comment. A lattice is checked on the way: where there are properties it must be right.
pub(super) fn told(comment: &[u8], place: Place, options: &ReadOptions) -> Result<Told, Fault> {
    let mut words = Words { rest: comment, unclosed: 0 };
    let (mut table, mut lattice) = (None, Ok(()));
    while let Some((key, value)) = words.pair() {
        let Some(value) = value else { continue };
        if key.eq_ignore_ascii_case(b"lattice") {
            lattice = lattice.and_then(|()| check_lattice(value, place));
        } else if key.eq_ignore_ascii_case(b"properties") && table.is_none() {
            table = Some(read(value, place, options)?);
        }
    }
    match lattice {
        Err(fault) if table.is_some() => Err(fault),
        Err(fault) => Ok(Told { table, warning: Some(format!("{place}: {}", fault.kind)) }),
        Ok(()) => Ok(Told { table, warning: None }),
    }
}

/// Whether a property of this name is something else than a scalar.
pub(super) fn has_role(name: &str) -> bool {
    Meaning::of(name) != Meaning::Scalar
}

/// What a property is by its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Meaning {
    Position,
    Element,
    Radius,
    Color,
    Scalar,
}

impl Meaning {
    fn of(name: &str) -> Self {
        match name.to_ascii_lowercase().as_str() {
            _ if name == "Z" => Self::Element,
            "pos" | "position" | "positions" => Self::Position,
            "species" | "element" | "elements" | "symbol" | "symbols" | "numbers"
            | "atomic_number" | "atomic_numbers" => Self::Element,
            "radius" | "radii" => Self::Radius,
            "color" | "colour" | "colors" | "colours" => Self::Color,
            _ => Self::Scalar,
        }
    }
}

/// How many quotes and brackets without an end are looked at: each takes a look at all that
/// follows, so a line full of them would take a time that grows with its square.
const UNCLOSED_MAX: u32 = 16;

/// The words of a comment.
struct Words<'a> {
    rest: &'a [u8],
    /// How many quotes and brackets had no end.
    unclosed: u32,
}

impl<'a> Words<'a> {
    /// Takes the next key, and its value if it has one.
    fn pair(&mut self) -> Option<(&'a [u8], Option<&'a [u8]>)> {
        self.rest = self.rest.trim_ascii_start();
        if self.rest.is_empty() {
            return None;
        }
        let key = self.word(|byte| byte == b'=' || byte.is_ascii_whitespace());
        let Some(value) = self.rest.trim_ascii_start().strip_prefix(b"=") else {
            return Some((key, None));
        };
        self.rest = value.trim_ascii_start();
        Some((key, Some(self.word(|byte| byte.is_ascii_whitespace()))))
    }

    /// Takes a word: what is in quotes or brackets, or all up to where `ends` holds. A quote or
    /// bracket without an end is a character as any other.
    fn word(&mut self, ends: impl Fn(u8) -> bool) -> &'a [u8] {
        let rest = self.rest;
        if self.unclosed < UNCLOSED_MAX {
            if let Some(closed) = quoted(rest) {
                if let Some((word, after)) = closed {
                    self.rest = after;
                    return word;
                }
                self.unclosed += 1;
            } else {
                let mut depth = 0_u32;
                let end = rest.iter().position(|&byte| {
                    match byte {
                        b'[' => depth = depth.saturating_add(1),
                        b']' => depth = depth.saturating_sub(1),
                        _ => {}
                    }
                    depth == 0 && ends(byte)
                });
                if depth == 0 {
                    return self.take(end);
                }
                self.unclosed += 1;
            }
        }
        self.take(rest.iter().position(|&byte| ends(byte)))
    }

    /// Takes what is before this index, or all.
    fn take(&mut self, end: Option<usize>) -> &'a [u8] {
        let (word, after) = self.rest.split_at(end.unwrap_or(self.rest.len()));
        self.rest = after;
        word
    }
}

/// What is in the quotes or braces at the start, and what follows: `Some(None)` if they have no
/// end, `None` if there are none.
fn quoted(text: &[u8]) -> Option<Option<(&[u8], &[u8])>> {
    let (&open, inner) = text.split_first()?;
    let close = match open {
        b'"' | b'\'' => open,
        b'{' => b'}',
        _ => return None,
    };
    let mut escaped = false;
    let end = inner.iter().position(|&byte| {
        let closes = byte == close && !escaped;
        escaped = byte == b'\\' && !escaped;
        closes
    });
    Some(end.map(|end| {
        let (word, after) = inner.split_at(end);
        (word, after.get(1..).unwrap_or_default())
    }))
}

/// Checks that a lattice is three vectors.
fn check_lattice(value: &[u8], place: Place) -> Result<(), Fault> {
    let separates = |byte: &u8| byte.is_ascii_whitespace() || matches!(byte, b',' | b'[' | b']');
    let mut count = 0;
    for text in value.split(separates).filter(|text| !text.is_empty()) {
        if !number(text).is_some_and(f64::is_finite) {
            return Err(Fault::invalid(place, "Lattice must have nine numbers", quote(text)));
        }
        count += 1;
    }
    if count == 9 {
        return Ok(());
    }
    Err(Fault::invalid(place, "Lattice must have nine numbers", count))
}

/// The table that the value of `Properties` tells of.
fn read(value: &[u8], place: Place, options: &ReadOptions) -> Result<Table, Fault> {
    let mut table = Table::default();
    let mut fields = value.split(|&byte| byte == b':');
    let mut columns: u64 = 0;
    while let Some(name) = fields.next() {
        let (Some(kind), Some(count)) = (fields.next(), fields.next()) else {
            let what = "Properties must be a name, a type and a number of columns in turn";
            return Err(Fault::invalid(place, what, quote(value)));
        };
        let name = String::from_utf8_lossy(name.trim_ascii());
        if !matches!(kind, b"S" | b"R" | b"I" | b"L") {
            let what = format!("the type of the property {name} must be S, R, I or L");
            return Err(Fault::invalid(place, what, quote(kind)));
        }
        let Some(count) = whole(count.trim_ascii()).filter(|&count| count > 0) else {
            let what = format!("the number of columns of the property {name} must be 1 or more");
            return Err(Fault::invalid(place, what, quote(count)));
        };
        columns = columns.saturating_add(count);
        Table::check(columns, place)?;
        add(&mut table, &name, (kind, count), options);
    }
    if table.has(Role::Axis(0)) {
        return Ok(table);
    }
    Err(Fault::invalid(place, "Properties must have pos:R:3", quote(value)))
}

/// Adds the columns of a property.
fn add(table: &mut Table, name: &str, (kind, count): (&[u8], u64), options: &ReadOptions) {
    let is_number = matches!(kind, b"R" | b"I");
    let is_new = |role| !table.has(role);
    match (Meaning::of(name), count) {
        (Meaning::Position, 3) if is_number && is_new(Role::Axis(0)) => {
            (0..3).for_each(|axis| table.push(Role::Axis(axis)));
        }
        (Meaning::Element, 1) if matches!(kind, b"S" | b"I") && is_new(Role::Element) => {
            table.push(Role::Element);
        }
        (Meaning::Radius, 1) if is_number && is_new(Role::Radius) => table.push(Role::Radius),
        (Meaning::Color, 3 | 4) if is_number && is_new(Role::Color(0)) => {
            let role = if kind == b"R" { Role::Color } else { Role::ColorByte };
            (0..4).zip(0..count).for_each(|(channel, _)| table.push(role(channel)));
        }
        _ if kind == b"S" => (0..count).for_each(|_| table.push(Role::Ignored)),
        _ => {
            let role = if kind == b"L" { Role::Logical } else { Role::Scalar };
            for index in 0..count {
                let name = match (count, index) {
                    (1, _) => name.to_owned(),
                    (3, 0) => format!("{name}_x"),
                    (3, 1) => format!("{name}_y"),
                    (3, _) => format!("{name}_z"),
                    _ => format!("{name}_{index}"),
                };
                table.push_scalar(name, options, role);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn roles(comment: &str) -> Result<(Vec<Role>, Vec<String>), String> {
        let told = told(comment.as_bytes(), Place::Line(2), &ReadOptions::default());
        let told = told.map_err(|fault| fault.in_file("a.xyz").to_string())?;
        Ok(told.table.map(|table| (table.roles, table.names)).unwrap_or_default())
    }

    #[test]
    fn columns_have_roles_in_any_order() {
        let text = "Properties=force:R:3:Z:I:1:tag:S:2:pos:R:3:ok:L:1:colour:R:3:q:R:2:radius:R:1";
        let (roles, names) = roles(text).unwrap();
        use Role::{Axis, Color, Element, Ignored, Logical, Radius, Scalar};
        let expected = [
            [Scalar(0), Scalar(1), Scalar(2), Element, Ignored, Ignored, Axis(0)],
            [Axis(1), Axis(2), Logical(3), Color(0), Color(1), Color(2), Scalar(4)],
        ];
        assert_eq!(roles[..14], expected.concat());
        assert_eq!(roles[14..], [Scalar(5), Radius]);
        assert_eq!(names, ["force_x", "force_y", "force_z", "ok", "q_0", "q_1"]);
    }

    #[test]
    fn values_may_be_quoted() {
        for comment in [
            r#"Lattice="1 0 0 0 1 0 0 0 1" Properties="pos:R:3" pbc="T T T""#,
            "title='a \\' Properties=x' Properties='pos:R:3'",
            "Lattice=[[1, 0, 0], [0, 1, 0], [0, 0, 1]] Properties = pos:R:3 energy=-1.5",
            "flag \"a key\"=1 properties=pos:I:3",
            "cell={1 2 3} PROPERTIES=pos:R:3",
        ] {
            assert_eq!(roles(comment).unwrap().0.len(), 3, "{comment}");
        }
        for comment in [
            "",
            "water",
            "a=b",
            "Properties",
            "Lattice of iron",
            "=",
            "\"",
            "[",
            "x=\"Properties=pos:R:3",
        ] {
            assert_eq!(roles(comment), Ok(Default::default()), "{comment}");
        }
    }

    #[test]
    fn quotes_and_brackets_without_an_end_do_not_swallow_the_rest() {
        let many = "'a [b c= {d ".repeat(100);
        for start in
            ["title=\"a b ", "'tis ", "{ a ", "x=[1 2 ", "'tis x=[1 y={2 \"", "a[=1 ", &many]
        {
            let comment = format!("{start} Properties=pos:R:3");
            assert_eq!(roles(&comment).unwrap().0.len(), 3, "{comment}");
        }
        let comment = "x=[1 'a Lattice=\"1 0 0 0 1 0 0 0 1\" y=[1 2] Properties=\"pos:R:3\"";
        assert_eq!(roles(comment).unwrap().0.len(), 3);
    }

    #[test]
    fn a_line_of_quotes_without_an_end_takes_no_time() {
        for text in ["'a \\\"[ ", "[ ", "{ ", "a=[ "] {
            let comment = text.repeat((1 << 20) / text.len());
            let start = std::time::Instant::now();
            assert_eq!(roles(&comment), Ok(Default::default()));
            assert!(start.elapsed().as_secs() < 5, "{text}");
        }
    }

    #[test]
    fn a_word_like_lattice_in_another_comment_is_no_error() {
        for (value, wrong) in [("5.43", "1"), ("\"1 2 b\"", "\"b\""), ("", "0")] {
            let comment = format!("lattice={value}");
            let told = told(comment.as_bytes(), Place::Line(2), &ReadOptions::default()).unwrap();
            let warning = format!("line 2: Lattice must have nine numbers, not {wrong}");
            assert_eq!(told, Told { table: None, warning: Some(warning) });
        }
    }

    #[test]
    fn wrong_headers_are_told() {
        let lattice = "Lattice must have nine numbers, not";
        let columns = "the number of columns of the property pos must be 1 or more, not";
        for (comment, error) in [
            ("Lattice=\"1 2 3\" Properties=pos:R:3", format!("{lattice} 3")),
            ("Properties=pos:R:3 Lattice='1 0 0 0 1 0 0 0 b'", format!("{lattice} \"b\"")),
            ("Lattice=[1 0 0 0 1 0 0 0 inf] Properties=pos:R:3", format!("{lattice} \"inf\"")),
            ("Properties=pos:R:3 Lattice=", format!("{lattice} 0")),
            ("Lattice=\"1 0 Properties=pos:R:3", format!("{lattice} \"\\\"1\"")),
            ("Properties=pos:R:0", format!("{columns} \"0\"")),
            ("Properties=pos:R:-3", format!("{columns} \"-3\"")),
            ("Properties=pos:R:3:q:R:9999", "there must be at most 4096 columns, not 10002".into()),
            (
                "Properties=pos:R:3:q:R:18446744073709551615",
                "there must be at most 4096 columns, not 18446744073709551615".into(),
            ),
            (
                "Properties=pos:F:3",
                "the type of the property pos must be S, R, I or L, not \"F\"".into(),
            ),
            (
                "Properties=pos:R",
                "Properties must be a name, a type and a number of columns in turn, not \"pos:R\""
                    .into(),
            ),
            ("Properties=pos:R:2", "Properties must have pos:R:3, not \"pos:R:2\"".into()),
            ("Properties=a:R:1", "Properties must have pos:R:3, not \"a:R:1\"".into()),
        ] {
            assert_eq!(roles(comment), Err(format!("a.xyz, line 2: {error}")), "{comment}");
        }
    }
}
