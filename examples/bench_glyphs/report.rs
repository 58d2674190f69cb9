//! What was measured, as a table and as JSON.

use crate::{
    measure::Row,
    scene::Scene,
    table::{Table, best, cell, number, times},
};
use serde_json::{Value, json};

pub(crate) fn table(scene: &Scene, rows: &[Row]) -> String {
    let count = scene.content.len();
    let head = [
        "representation",
        "bytes a glyph",
        "fixed bytes",
        "scratch, MiB",
        "vertices a glyph",
        "frame",
        "best",
        "geometry only",
        "pixels that differ",
    ];
    let covered =
        rows.iter().find_map(|row| row.outcome.as_ref().ok()).map_or(0, |m| m.first.covered);
    let title = format!("{}: {count} glyphs, {covered} pixels covered", scene.name);
    let mut table = Table::new(&title, head);
    let mut lacks = Vec::new();
    for row in rows {
        match &row.outcome {
            Ok(measured) => {
                let first = &measured.first;
                let share = |value: u64| number(value as f64 / count.max(1) as f64);
                table.push(vec![
                    row.name.to_owned(),
                    share(first.footprint.glyphs),
                    first.footprint.fixed.to_string(),
                    number(first.footprint.scratch as f64 / f64::from(1 << 20)),
                    first.vertices.map_or_else(String::new, share),
                    cell(&measured.frames),
                    best(&measured.frames),
                    cell(&measured.away),
                    first.differing.to_string(),
                ]);
            }
            Err(reason) => lacks.push(format!("{} ({reason})", row.name)),
        }
    }
    if lacks.is_empty() {
        return table.to_string();
    }
    format!("{table}\nNot measured: {}.\n", lacks.join("; "))
}

pub(crate) fn json(scene: &Scene, rows: &[Row]) -> Value {
    let row = |row: &Row| match &row.outcome {
        Ok(measured) => {
            let first = &measured.first;
            json!({
                "representation": row.name,
                "glyph_bytes": first.footprint.glyphs,
                "fixed_bytes": first.footprint.fixed,
                "scratch_bytes": first.footprint.scratch,
                "vertices": first.vertices,
                "differing": first.differing,
                "covered": first.covered,
                "frame": times(&measured.frames),
                "geometry": times(&measured.away),
            })
        }
        Err(reason) => json!({ "representation": row.name, "cannot": reason }),
    };
    json!({
        "scene": scene.name,
        "glyphs": scene.content.len(),
        "rows": rows.iter().map(row).collect::<Vec<_>>(),
    })
}
