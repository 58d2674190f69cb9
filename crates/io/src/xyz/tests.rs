//! Tests of the reader.

mod extended;

use crate::{Error, Loaded, Problem, ReadOptions, Scalars, elements::Radii};
use glam::DVec3;

fn load(options: &ReadOptions, text: &str) -> Result<Loaded, Error> {
    options.read_bytes("a.xyz", text.as_bytes())
}

fn read(text: &str) -> Loaded {
    load(&ReadOptions::default(), text).unwrap()
}

fn fail(text: &str) -> String {
    load(&ReadOptions::default(), text).unwrap_err().to_string()
}

fn xs(loaded: &Loaded) -> Vec<f64> {
    (0..loaded.scene.records.len()).map(|index| loaded.scene.position(index).x).collect()
}

fn radii(loaded: &Loaded) -> Vec<f32> {
    loaded.scene.records.iter().map(|record| record.radius).collect()
}

fn scalar(loaded: &Loaded, name: &str) -> Vec<f32> {
    loaded.scene.scalar(name).unwrap().values.to_vec()
}

const TWO: &str = "2\nfirst\nO 0 0 0\nH 1 0 0\n1\nsecond\nC 5 0 0\n";

mod plain {
    use super::*;

    #[test]
    fn atoms_have_elements_and_their_radii() {
        let loaded = read("4\n\n  CA  0 0 0\r\n13C\t1 -2.5e0 3\nh2 2 0 0\n92 3 0 0");
        assert_eq!(loaded.scene.attributes.elements, Some([20, 6, 1, 92].into()));
        assert_eq!(radii(&loaded), [2.31, 1.7, 1.2, 2.71]);
        assert_eq!(loaded.scene.position(1), DVec3::new(1.0, -2.5, 3.0));
        assert_eq!(loaded.report, Default::default());
        let options = ReadOptions::default().radii(Radii::Covalent).radius_scale(2.0);
        assert_eq!(radii(&load(&options, "1\n\nO 0 0 0").unwrap()), [1.32]);
    }

    #[test]
    fn names_that_are_no_elements_have_an_estimated_radius() {
        let loaded = read("2\n\nA 0 0 0\nQ 2 0 0\n");
        assert_eq!(loaded.scene.attributes.elements, None);
        assert_eq!(radii(&loaded), [1.8; 2]);
        assert!(loaded.report.warnings[0].starts_with("the file gives no radius"));
    }

    #[test]
    fn a_name_that_is_no_element_among_others_is_told() {
        let loaded = read("3\n\nC 0 0 0\nQ 2 0 0\nX 3 0 0");
        assert_eq!(loaded.scene.attributes.elements, Some([6, 0, 0].into()));
        assert_eq!(radii(&loaded), [1.7; 3]);
        let warning =
            "the element of 2 atoms is not known and was given the radius 1.7; the first: line 4";
        assert_eq!(loaded.report.warnings, [warning]);
        let loaded = load(&ReadOptions::default().radius(0.5), "2\n\nC 0 0 0\nQ 2 0 0\n").unwrap();
        assert_eq!(
            loaded.report.warnings,
            ["the element of 1 atoms is not known; the first: line 4"]
        );
    }

    #[test]
    fn further_columns_are_scalars_if_they_are_numbers() {
        let loaded = read("2\n\nC 0 0 0 0.1 up -7\nC 1 0 0 0.2 down nan\n");
        assert_eq!(scalar(&loaded, "column_5"), [0.1, 0.2]);
        assert_eq!(scalar(&loaded, "column_7")[0], -7.0);
        assert!(scalar(&loaded, "column_7")[1].is_nan());
        assert_eq!(loaded.scene.attributes.scalars.len(), 2);
    }

    #[test]
    fn only_wanted_columns_are_kept() {
        let wanted = Scalars::Named(vec!["column_6".into()]);
        let options = ReadOptions::default().scalars(wanted);
        let loaded = load(&options, "1\n\nC 0 0 0 5 6 7\n").unwrap();
        assert_eq!(loaded.scene.attributes.scalars.len(), 1);
        assert_eq!(scalar(&loaded, "column_6"), [6.0]);
    }

    #[test]
    fn lines_that_cannot_be_used_are_counted() {
        let loaded = read("7\n\nC\nC 0 0 0\nC 1 0\n\nC 2 0 0 0\nC 3 x.5 0\nC 4 0 nan\n\n");
        assert_eq!(xs(&loaded), [0.0]);
        assert_eq!(loaded.scene.attributes.ids, Some([1].into()));
        let skipped: Vec<_> = loaded
            .report
            .skipped
            .iter()
            .map(|s| (s.problem, s.count, s.first.to_string(), s.value.as_str()))
            .collect();
        let expected = [
            (Problem::Columns, 4, "line 3".to_owned(), "\"C\""),
            (Problem::Number, 1, "line 8".to_owned(), "\"x.5\""),
            (Problem::Position, 1, "line 9".to_owned(), "(4, 0, NaN)"),
        ];
        assert_eq!(skipped, expected);
    }

    #[test]
    fn strict_reading_ends_at_the_first_bad_line() {
        let options = ReadOptions::default().strict(true);
        for (text, error) in [
            ("2\n\nC\nC 0 0 0\n", "line 3: a wrong number of columns: \"C\""),
            ("2\n\nC 0 0 0\nC 0 b 0\n", "line 4: not a number: \"b\""),
            ("1\n\nC\n", "line 3: a wrong number of columns: \"C\""),
        ] {
            let found = load(&options, text).unwrap_err().to_string();
            assert_eq!(found, format!("a.xyz, {error}"));
        }
    }

    #[test]
    fn rows_may_have_no_name() {
        let loaded = read("2\npoints\n0 0 0\n3 0 0\n");
        assert_eq!((xs(&loaded), &loaded.scene.attributes.elements), (vec![0.0, 3.0], &None));
        let loaded = read("2\npoints\n0.5 0 0 9\n3 0 0 8\n");
        assert_eq!((xs(&loaded), scalar(&loaded, "column_4")), (vec![0.5, 3.0], vec![9.0, 8.0]));
    }

    #[test]
    fn rows_that_start_with_a_whole_number_may_have_no_name() {
        let rows = "0 0 0 1.5\n0.5 0 0 2.5\n0.25 3 4 3.5";
        for comment in ["lattice sites x y z s\n", ""] {
            let loaded = read(&format!("3\n{comment}{rows}"));
            assert_eq!(xs(&loaded), [0.0, 0.5, 0.25], "{comment}");
            assert_eq!(loaded.scene.position(2), DVec3::new(0.25, 3.0, 4.0));
            assert_eq!(scalar(&loaded, "column_4"), [1.5, 2.5, 3.5]);
        }
        for x in ["-1", "+1", "1e0", "1.", ".5"] {
            let text = format!("3\n\n0 1 0 7\n2 1 0 8\n{x} 1 0 9\n3\n\n0 1 2 3\n");
            assert_eq!(xs(&read(&text))[..2], [0.0, 2.0], "{x}");
        }
        // The rows of another frame tell nothing of this one.
        let typed = read("2\n\n500 1 0 0\n1 2 0 0\n2\n\n0.5 3 0 0\n1 2 0 0\n");
        assert_eq!((xs(&typed), typed.report.skipped), (vec![1.0, 2.0], vec![]));
    }

    #[test]
    fn names_that_are_whole_numbers_must_be_so_in_all_rows() {
        let types = read("4\n\n500 1 0 0 7\n800 2 0 0 8\n1 3 0 0 9\nO 4 0 0 9\n");
        assert_eq!((xs(&types), types.report.skipped), (vec![1.0, 2.0, 3.0, 4.0], vec![]));
        // The row that contradicts is too far away to be looked at.
        let rows = "1 2 3 4\n".repeat(20_000);
        let late = read(&format!("20001\n\n{rows}0.5 2 3 4\n"));
        assert_eq!(late.scene.records.len(), 20_000);
        let [skipped] = &late.report.skipped[..] else { panic!("one problem") };
        let found = (skipped.problem, skipped.count, skipped.first.to_string(), &*skipped.value);
        assert_eq!(found, (Problem::Number, 1, "line 20003".to_owned(), "\"0.5\""));
    }

    #[test]
    fn a_comment_of_numbers_does_not_tell_what_rows_are() {
        let loaded = read("2\n1.5 2 3 4\n1 10 0 0\n2 20 0 0\n");
        assert_eq!((xs(&loaded), loaded.report.skipped), (vec![10.0, 20.0], vec![]));
    }

    #[test]
    fn a_mark_of_utf_8_does_no_harm() {
        assert_eq!(xs(&read("\u{feff}1\n\nC 7 0 0\n")), [7.0]);
    }
}

mod frames {
    use super::*;

    #[test]
    fn frames_are_found_by_index() {
        let second = load(&ReadOptions::default().frame(1), TWO).unwrap();
        assert_eq!(xs(&second), [5.0]);
        assert_eq!(xs(&read(TWO)), [0.0, 1.0]);
        let spaced = TWO.replace("1\nsec", "\n\n 1 \nsec");
        assert_eq!(xs(&load(&ReadOptions::default().frame(1), &spaced).unwrap()), [5.0]);
    }

    #[test]
    fn a_missing_frame_names_how_many_there_are() {
        let error = load(&ReadOptions::default().frame(2), TWO).unwrap_err().to_string();
        assert_eq!(error, "a.xyz: there is no frame 2: the file has 2, counted from 0");
        let error = load(&ReadOptions::default().frame(1), "1 2 3\n").unwrap_err().to_string();
        assert_eq!(error, "a.xyz: there is no frame 1: the file has 1, counted from 0");
        assert_eq!(fail("\n\n"), "a.xyz: there is no frame 0: the file has 0, counted from 0");
    }

    #[test]
    fn wrong_counts_are_told() {
        for count in ["-3", "2.5", "99999999999999999999"] {
            let error =
                format!("line 1: the number of atoms must be a whole number, not \"{count}\"");
            assert_eq!(fail(&format!("{count}\n\nC 0 0 0\n")), format!("a.xyz, {error}"));
        }
        let few = "the frame must have 3 atoms, as it says, not";
        assert_eq!(fail("3\n\nC 0 0 0\n"), format!("a.xyz, line 4: {few} 1"));
        assert_eq!(fail("3\n"), format!("a.xyz, line 2: {few} 0"));
        assert_eq!(fail("3\nC 0 0 0\nC 1 0 0"), format!("a.xyz, line 4: {few} 2"));
        assert_eq!(fail("3\nC 0 0 0"), format!("a.xyz, line 3: {few} 1"));
        let huge = format!("{}\n\nC 0 0 0\n", u64::MAX);
        assert_eq!(
            fail(&huge),
            format!("a.xyz, line 4: {few} 1").replace('3', &u64::MAX.to_string())
        );
        assert_eq!(fail("0\n\n"), "a.xyz: there is nothing to draw: 0 records were skipped");
    }

    #[test]
    fn more_atoms_than_the_count_are_told() {
        let loaded = read("1\n\nC 0 0 0\nC 1 0 0\n");
        assert_eq!(xs(&loaded), [0.0]);
        let warning = "line 4, after the frame, was not read: it starts no frame, \"C 1 0 0\"";
        assert_eq!(loaded.report.warnings, [warning]);
    }

    #[test]
    fn the_comment_may_be_missing() {
        for (text, expected) in [
            ("1\nC 4 0 0", [4.0].as_slice()),
            ("3\nC 4 0 0\nO 5 0 0\nN 6 0 0\n", &[4.0, 5.0, 6.0]),
            ("2\nC 4 0 0\nO 5 0 0\n2\nC 0 0 0\nC 1 0 0\n", &[4.0, 5.0]),
            ("2\n4 0 0\n5 0 0\n\n", &[4.0, 5.0]),
        ] {
            let loaded = read(text);
            assert_eq!(xs(&loaded), expected, "{text}");
            assert_eq!(loaded.scene.attributes.ids, None);
            let warning = "the frame has no comment: its second line was taken for an atom";
            assert!(loaded.report.warnings.iter().any(|found| found == warning), "{text}");
        }
        let three = read("3\nC 4 0 0 1\nO 5 0 0 2\nN 6 0 0 3\n");
        assert_eq!(three.scene.attributes.elements, Some([6, 8, 7].into()));
        assert_eq!(radii(&three), [1.7, 1.52, 1.55]);
        assert_eq!(scalar(&three, "column_5"), [1.0, 2.0, 3.0]);
    }

    #[test]
    fn ids_are_right_where_the_comment_is_missing() {
        let loaded = read("3\nC 4 0 0\nO 5 0 0\nN 6 nan 0\n");
        assert_eq!(
            (xs(&loaded), &loaded.scene.attributes.ids),
            (vec![4.0, 5.0], &Some([0, 1].into()))
        );
        let loaded = read("3\nC 4 0 1e999\nO 5 0 0\nN 6 0 0\n");
        assert_eq!(
            (xs(&loaded), &loaded.scene.attributes.ids),
            (vec![5.0, 6.0], &Some([1, 2].into()))
        );
    }

    #[test]
    fn a_comment_that_looks_like_an_atom_is_a_comment() {
        for (text, expected) in [
            ("1\nbox 9 9 9\nC 4 0 0\n", [4.0].as_slice()),
            ("2\n9 9 9\nC 4 0 0\nC 5 0 0\n", &[4.0, 5.0]),
            ("2\n9 9 9\n4 0 0\n5 0 0\n", &[4.0, 5.0]),
            ("2\nbox 9 9 9\nC 4 0 0\nC 5 0 0\n1\n\nC 0 0 0\n", &[4.0, 5.0]),
            ("2\nbox 9 9 9\nC 4 0 0\nC x 0 0\n", &[4.0]),
        ] {
            let loaded = read(text);
            assert_eq!(xs(&loaded), expected, "{text}");
            assert!(!loaded.report.warnings.iter().any(|text| text.contains("comment")), "{text}");
        }
    }

    #[test]
    fn frames_without_comment_can_be_passed_over() {
        let options = ReadOptions::default().frame(2);
        let text = "1\nC 4 0 0\n2\nbox 9 9 9\nC 4 0 0\nC 5 0 0\n1\n\nC 8 0 0\n";
        assert_eq!(xs(&load(&options, text).unwrap()), [8.0]);
    }
}

mod points {
    use super::*;

    #[test]
    fn rows_need_no_count() {
        let loaded = read("# x y z\n0.5 0 0\n\n// more\n1 2 3\n4 5\n6 7 8\n");
        assert_eq!(xs(&loaded), [0.5, 1.0, 6.0]);
        assert_eq!(loaded.scene.attributes.ids, Some([0, 1, 3].into()));
        assert_eq!(loaded.report.skipped[0].value, "\"4 5\"");
    }

    #[test]
    fn further_columns_are_scalars_and_no_colors() {
        let loaded = read("1 2 3 255 0 0\n4 5 6 0 255 0\n");
        assert_eq!(loaded.scene.attributes.colors, None);
        assert_eq!(scalar(&loaded, "column_4"), [255.0, 0.0]);
        assert_eq!(xs(&loaded), [1.0, 4.0]);
    }

    #[test]
    fn rows_may_have_names() {
        let loaded = read("C 1 2 3\nO 4 5 6\n");
        assert_eq!(loaded.scene.attributes.elements, Some([6, 8].into()));
    }

    #[test]
    fn other_text_is_refused() {
        let error = "a.xyz, line 1: the first line must be the number of atoms, or a row of \
                     coordinates, not \"3 atoms\"";
        assert_eq!(fail("3 atoms\n\nC 1 2 3\n"), error);
        for line in ["x,y,z", "0.0,1.0,2.0", "many"] {
            let error = fail(&format!("{line}\n1,2,3\n"));
            assert_eq!(
                error,
                "a.xyz, line 1: the first line must be the number of atoms, or a \
                 row of coordinates, not \"?\""
                    .replace('?', line)
            );
        }
        let later = load(&ReadOptions::default().frame(1), "1\n\nC 0 0 0\nmany\n").unwrap_err();
        let text = "a.xyz, line 4: the number of atoms must be a whole number, not \"many\"";
        assert_eq!(later.to_string(), text);
    }

    #[test]
    fn columns_without_end_are_refused() {
        let error = fail(&"1 ".repeat(5000));
        assert_eq!(error, "a.xyz, line 1: there must be at most 4096 columns, not 5000");
    }
}

#[test]
#[expect(clippy::print_stdout, reason = "a test that is skipped says so")]
fn the_glass_is_read() {
    let Some(data) = std::env::var_os("PUNCTA_DATA") else {
        println!("skipped: PUNCTA_DATA is not set");
        return;
    };
    let path = std::path::Path::new(&data).join("ges2.xyz");
    let first = ReadOptions::default().read(&path).unwrap();
    assert_eq!(first.scene.records.len(), 258);
    assert_eq!(first.report, Default::default());
    let elements = first.scene.attributes.elements.unwrap();
    assert_eq!((elements[0], elements[257]), (32, 16));
    let frames = std::fs::read_to_string(&path).unwrap().lines().count() as u64 / 260;
    let last = ReadOptions::default().frame(frames - 1).read(&path).unwrap();
    assert_eq!(last.scene.records.len(), 258);
    let error = ReadOptions::default().frame(frames).read(&path).unwrap_err().to_string();
    assert!(
        error.ends_with(&format!(
            "there is no frame {frames}: the file has {frames}, counted from 0"
        ))
    );
}
