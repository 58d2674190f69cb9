//! The reader: finds the model, then cuts its lines.

use super::element;
use crate::{
    ReadOptions,
    atoms::Atoms,
    builder::{Columns, Report, Row},
    error::{ErrorKind, Fault, Problem, quote},
    input::Input,
    text::{Lines, number, number_f32},
};
use puncta_core::Scene;
use std::ops::Range;

/// The scalars, and the bytes of a line that hold them.
const SCALARS: [(&str, Range<usize>); 3] =
    [("occupancy", 54..60), ("b_factor", 60..66), ("residue", 22..RESIDUE_END)];

/// The byte behind the number of a residue.
const RESIDUE_END: usize = 26;

/// What a line is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Atom,
    Model,
    End,
    Other,
}

impl Kind {
    fn of(line: &[u8]) -> Self {
        let is = |name: &[u8]| line.get(..name.len()).is_some_and(|l| l.eq_ignore_ascii_case(name));
        // A name ends at a blank, or at a digit where a long number runs into it.
        let ends = |length: usize| {
            line.get(length).is_none_or(|byte| byte.is_ascii_whitespace() || byte.is_ascii_digit())
        };
        match line.first() {
            Some(b'A' | b'a') if is(b"ATOM") && ends(4) => Self::Atom,
            Some(b'H' | b'h') if is(b"HETATM") => Self::Atom,
            Some(b'M' | b'm') if is(b"MODEL") && ends(5) => Self::Model,
            Some(b'E' | b'e') if (is(b"ENDMDL") && ends(6)) || (is(b"END") && ends(3)) => Self::End,
            _ => Self::Other,
        }
    }
}

/// Reads a model.
pub(crate) fn read(input: &mut Input<'_>, options: &ReadOptions) -> Result<(Scene, Report), Fault> {
    let mut lines = Lines::new(input);
    let scalars = SCALARS.map(|(name, _)| name.to_owned()).to_vec();
    let columns = Columns { color: false, element: true, scalars };
    let mut rows = Rows { atoms: Atoms::new(options, &columns), has_odd_scalars: false };
    let (mut frames, mut is_open): (u64, bool) = (0, false);
    while lines.advance()? {
        let kind = Kind::of(lines.text());
        let begins = kind == Kind::Model || (kind == Kind::Atom && !is_open);
        let is_wanted = is_open && frames == options.frame.saturating_add(1);
        if is_wanted && (begins || kind == Kind::End) {
            return rows.finish();
        }
        if begins {
            frames += 1;
        }
        is_open = begins || (is_open && kind != Kind::End);
        if kind == Kind::Atom && frames.checked_sub(1) == Some(options.frame) {
            rows.push(&lines)?;
        }
    }
    if is_open && frames.checked_sub(1) == Some(options.frame) {
        return rows.finish();
    }
    Err(ErrorKind::NoSuchFrame { frame: options.frame, frames }.into())
}

/// The atoms of a model, on their way into a scene.
struct Rows<'o> {
    atoms: Atoms<'o>,
    /// Whether a scalar was not blank, but no number either.
    has_odd_scalars: bool,
}

impl Rows<'_> {
    /// Adds the atom of the line that was read last.
    fn push(&mut self, lines: &Lines<'_, '_>) -> Result<(), Fault> {
        let (line, place) = (lines.text(), lines.place());
        let position = match position(line) {
            Ok(position) => position,
            Err(problem) => return self.atoms.skip(problem, place, || quote(coordinates(line))),
        };
        let scalars = SCALARS.map(|(_, range)| {
            let is_whole = is_whole(line, &range);
            let text = field(line, range).trim_ascii();
            let value = number_f32(text).filter(|_| is_whole);
            self.has_odd_scalars |= value.is_none() && !text.is_empty();
            value.unwrap_or(f32::NAN)
        });
        let element = element::find(field(line, 12..16), field(line, 76..78));
        let row = Row { position, element, scalars: &scalars, ..Row::default() };
        self.atoms.push(row, place)
    }

    fn finish(mut self) -> Result<(Scene, Report), Fault> {
        if self.has_odd_scalars {
            self.atoms.warn("values of occupancy, b_factor or residue that are no numbers are NaN");
        }
        self.atoms.finish()
    }
}

/// The bytes of a field, or those of them that the line has.
fn field(line: &[u8], range: Range<usize>) -> &[u8] {
    line.get(range.start..range.end.min(line.len())).unwrap_or_default()
}

/// The part of a line that holds the coordinates, for messages.
fn coordinates(line: &[u8]) -> &[u8] {
    line.get(30..).map_or(line, |_| field(line, 30..54))
}

/// The position of an atom.
fn position(line: &[u8]) -> Result<[f64; 3], Problem> {
    let mut position = [0.0; 3];
    for (axis, coordinate) in position.iter_mut().enumerate() {
        let start = 30 + 8 * axis;
        let text = field(line, start..start + 8);
        if text.trim_ascii().is_empty() {
            return Err(Problem::Columns);
        }
        // Blanks between the fields tell that no number was cut; else the point must.
        let point = text.iter().position(|&byte| byte == b'.');
        if point != Some(4) && (touches(line, start) || touches(line, start + 8)) {
            return Err(Problem::Columns);
        }
        *coordinate = number(text.trim_ascii()).ok_or(Problem::Number)?;
    }
    Ok(position)
}

/// Whether all of a number is in the field of a scalar.
fn is_whole(line: &[u8], range: &Range<usize>) -> bool {
    if range.end == RESIDUE_END {
        // A letter that distinguishes residues may follow, and a chain stands before.
        return !line.get(RESIDUE_END).is_some_and(u8::is_ascii_digit);
    }
    let point = field(line, range.clone()).iter().position(|&byte| byte == b'.');
    point == Some(3) || !(touches(line, range.start) || touches(line, range.end))
}

/// Whether there is something both before and after the start of a field.
fn touches(line: &[u8], start: usize) -> bool {
    let is_filled = |index: usize| line.get(index).is_some_and(|byte| !byte.is_ascii_whitespace());
    start.checked_sub(1).is_some_and(is_filled) && is_filled(start)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Error, Format, Loaded};

    /// A line as the format has it.
    fn atom(name: &str, residue: &str, coordinates: &str, rest: &str) -> String {
        format!("ATOM      1 {name:4} ALA A{residue:>4}    {coordinates:24}{rest}\n")
    }

    const ORIGIN: &str = "   0.000   0.000   0.000";

    fn load(options: &ReadOptions, text: &str) -> Result<Loaded, Error> {
        options.read_bytes("a.pdb", text.as_bytes())
    }

    fn read(text: &str) -> Loaded {
        load(&ReadOptions::default(), text).unwrap()
    }

    fn positions(loaded: &Loaded) -> Vec<[f64; 3]> {
        let scene = &loaded.scene;
        (0..scene.records.len()).map(|index| scene.position(index).to_array()).collect()
    }

    #[test]
    fn the_example_of_the_format_is_read() {
        let text = "\
HEADER    EXAMPLE
ATOM     32  N  AARG A  -3      11.281  86.699  94.383  0.50 35.88           N  \r
ANISOU   32  N  AARG A  -3     3406   4568   5659    606   1104    532       N  \r
ATOM     33  N  BARG A  -3      11.296  86.721  94.521  0.50 35.60           N
TER      34      ARG A  -3
HETATM 1357 MG    MG   168       4.669  34.118  19.123  1.00  3.16          MG2+
HETATM99999  O   HOH A9999    -999.999-999.999-999.999
END
";
        let loaded = read(text);
        assert_eq!(loaded.format, Format::Pdb);
        let expected = [
            [11.281, 86.699, 94.383],
            [11.296, 86.721, 94.521],
            [4.669, 34.118, 19.123],
            [-999.999; 3],
        ];
        for (found, expected) in positions(&loaded).iter().zip(expected) {
            assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-4), "{found:?}");
        }
        assert_eq!(loaded.scene.attributes.elements, Some([7, 7, 12, 8].into()));
        assert_eq!(loaded.scene.records[2].radius, 1.73);
        let scalar = |name: &str| loaded.scene.scalar(name).unwrap().values.clone();
        assert_eq!(scalar("residue"), [-3.0, -3.0, 168.0, 9999.0]);
        assert_eq!(scalar("occupancy")[..3], [0.5, 0.5, 1.0]);
        assert_eq!(scalar("b_factor")[..3], [35.88, 35.6, 3.16]);
        assert!(scalar("occupancy")[3].is_nan() && scalar("b_factor")[3].is_nan());
        assert_eq!(loaded.report, Report::default());
    }

    #[test]
    fn models_are_frames() {
        let one = |x: u8| atom(" CA ", "1", &format!("{x:8}.000   0.000   0.000")[4..], "");
        let text = format!(
            "TITLE     t\nMODEL        1\n{}{}TER\nENDMDL\nMODEL        2\nENDMDL\n\
             MODEL 3\n{}MODEL 4\n{}ENDMDL\nCONECT\nEND\n",
            one(1),
            one(2),
            one(3),
            one(4)
        );
        let load = |frame| load(&ReadOptions::default().frame(frame), &text);
        let xs = |frame| positions(&load(frame).unwrap()).iter().map(|p| p[0]).collect::<Vec<_>>();
        assert_eq!((xs(0), xs(2), xs(3)), (vec![1.0, 2.0], vec![3.0], vec![4.0]));
        let error = |frame| load(frame).unwrap_err().to_string();
        assert_eq!(error(1), "a.pdb: there is nothing to draw: 0 records were skipped");
        assert_eq!(error(4), "a.pdb: there is no frame 4: the file has 4, counted from 0");
        assert_eq!(error(u64::MAX).len(), error(4).len() + 19);
    }

    #[test]
    fn frames_may_be_parted_by_end_alone() {
        let line = atom(" CA ", "1", ORIGIN, "");
        let text = format!("{line}END\n{line}{line}END\n");
        let count = |text: &str, frame| {
            load(&ReadOptions::default().frame(frame), text).map(|l| l.scene.records.len()).ok()
        };
        assert_eq!([0, 1, 2].map(|frame| count(&text, frame)), [Some(1), Some(2), None]);
        assert_eq!(count(&line.repeat(3), 0), Some(3));
        let error = load(&ReadOptions::default(), "REMARK\n").unwrap_err().to_string();
        assert_eq!(error, "a.pdb: there is no frame 0: the file has 0, counted from 0");
    }

    #[test]
    fn numbers_that_do_not_fit_are_never_read_as_others() {
        for coordinates in [
            "12345.67812345.67812345.678",
            "12345.678  10.000  10.000",
            "-1234.567-1234.567-1234.567",
            "  10.00012345.678  10.000",
            "  10.000  10.00012345.678",
            "  10.000  10.000-1000.123  1.00",
            "********  10.000  10.000",
            "  10.000  10.000",
            "  10.000  10.000        ",
            "  10.000          10.000",
            "  1.0 2   10.000  10.000",
            "",
        ] {
            let text = atom(" CA ", "1", ORIGIN, "") + &atom(" CA ", "1", coordinates, "");
            let loaded = read(&text);
            assert_eq!(loaded.scene.records.len(), 1, "{coordinates}");
            assert_eq!(loaded.report.skipped[0].first.to_string(), "line 2");
        }
        // A number that runs into the field from the left.
        let line =
            atom(" CA ", "1", ORIGIN, "") + &atom(" CA ", "1   ", "10.000  10.000  10.000", "");
        let line = line.replace("    10.000  ", "  -10.000  ");
        assert_eq!(read(&line).scene.records.len(), 1);
    }

    #[test]
    fn numbers_that_fit_may_touch_or_have_any_form() {
        for (coordinates, expected) in [
            ("-123.456-234.567-345.678", [-123.456, -234.567, -345.678]),
            ("1234.5671234.5671234.567", [1234.567; 3]),
            (" 1.5      2       -3e0  ", [1.5, 2.0, -3.0]),
            (" 1.23456 2.34567 3.45678", [1.23456, 2.34567, 3.45678]),
            ("   1.000   2.000   3.0", [1.0, 2.0, 3.0]),
        ] {
            for rest in ["", "100.00100.00"] {
                // An occupancy that touches z needs z in the form of the format.
                if rest.is_empty() || coordinates.ends_with(".678") || coordinates.ends_with(".567")
                {
                    let loaded = read(&atom(" CA ", "1", coordinates, rest));
                    let found = positions(&loaded)[0];
                    let close = found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-4);
                    assert!(close, "{coordinates}: {found:?}");
                }
            }
        }
    }

    #[test]
    fn odd_scalars_are_told() {
        let loaded = read(&atom(" CA ", "A000", ORIGIN, "  1.00******"));
        assert!(loaded.scene.scalar("residue").unwrap().values[0].is_nan());
        assert!(loaded.scene.scalar("b_factor").unwrap().values[0].is_nan());
        let warning = "values of occupancy, b_factor or residue that are no numbers are NaN";
        assert_eq!(loaded.report.warnings, [warning]);
    }

    #[test]
    fn scalars_that_do_not_fit_are_never_read_as_others() {
        let scalars = |line: &str| {
            let loaded = read(line);
            let value = |name: &str| loaded.scene.scalar(name).unwrap().values[0];
            let is_told = !loaded.report.warnings.is_empty();
            let found = ["occupancy", "b_factor", "residue"].map(value);
            (found.map(|value| (!value.is_nan()).then_some(value)), is_told)
        };
        let line = |residue: &str, rest: &str| {
            atom(" CA ", "1", ORIGIN, rest).replace("A   1    ", &format!("A{residue:8}"))
        };
        for (residue, rest, expected) in [
            ("9999", "  1.00  0.50", [Some(1.0), Some(0.5), Some(9999.0)]),
            ("10000", "  1.00  0.50", [Some(1.0), Some(0.5), None]),
            ("1000B", "100.00100.00", [Some(100.0), Some(100.0), Some(1000.0)]),
            ("   1", "  1.001000.00", [Some(1.0), None, Some(1.0)]),
            ("   1", "1000.00  1.00", [None, None, Some(1.0)]),
            ("   1", "  1.00123.4567", [Some(1.0), Some(123.45), Some(1.0)]),
            ("   1", "  1.00 23.456", [Some(1.0), Some(23.45), Some(1.0)]),
            ("   1", "  1    2    C", [Some(1.0), Some(2.0), Some(1.0)]),
        ] {
            let is_told = expected.contains(&None);
            assert_eq!(scalars(&line(residue, rest)), (expected, is_told), "{residue} {rest}");
        }
    }

    #[test]
    fn small_letters_and_long_serial_numbers_do_no_harm() {
        let text = "atom      1  ca  ala a   1       0.000   0.000   0.000\r\n\
                    ATOM  ***** CA   CA  A   2       1.000   0.000   0.000\n\
                    ATOM 100000  N   ALA A   3       2.000   0.000   0.000\n\
                    HETATM100001 O   HOH A   4       3.000   0.000   0.000\n\
                    ATOM  A0000 1HB  ALA A   5       4.000   0.000   0.000\n\
                    ATOMS are no atoms\nendmdl\n";
        let loaded = read(text);
        assert_eq!(loaded.scene.attributes.elements, Some([6, 20, 7, 8, 1].into()));
        assert_eq!(loaded.scene.records.len(), 5);
    }

    #[test]
    fn strict_reading_names_the_line() {
        let options = ReadOptions::default().strict(true);
        let text = atom(" CA ", "1", "  10.000     nan  10.000", "");
        let error = load(&options, &text).unwrap_err().to_string();
        assert_eq!(error, "a.pdb, line 1: a position that cannot be stored: (10, NaN, 10)");
        let text = atom(" CA ", "1", "  10.000  1O.000  10.000", "");
        let error = load(&options, &text).unwrap_err().to_string();
        let value = "\"  10.000  1O.000  10.000\"";
        assert_eq!(error, format!("a.pdb, line 1: not a number: {value}"));
    }

    #[test]
    #[expect(clippy::print_stdout, reason = "a test that is skipped says so")]
    fn the_membrane_is_read() {
        let Some(data) = std::env::var_os("PUNCTA_DATA") else {
            println!("skipped: PUNCTA_DATA is not set");
            return;
        };
        let path = std::path::Path::new(&data).join("bace_membrane.pdb");
        let loaded = ReadOptions::default().read(path).unwrap();
        assert_eq!(loaded.scene.records.len(), 52_661);
        assert_eq!(loaded.report, Report::default());
    }
}
